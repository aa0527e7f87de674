import pytest
import sympy as sp
from bad_specs import BASE, LINE
from spec_samples import FOUR_BAR, LINKED, ROLLING_DISC, ROPE

from eomgen import spec
from eomgen.errors import SpecError
from eomgen.model import TIME


def read(text):
    return spec.read(text, "x.yaml")


def real(*names):
    return [sp.Symbol(n, real=True) for n in names]


def codes(text):
    try:
        read(text)
    except SpecError as error:
        return [fault.code for fault in error.faults]
    return []


def only_constraint(text):
    (constraint,) = read(text).constraints
    return constraint


def residual(relation, kind="holonomic", base=BASE):
    """The one residual of the plane pendulum with one constraint."""
    (found,) = only_constraint(f'{base}constraints: {{c: {{{kind}: "{relation}"}}}}\n').residuals
    return found


def test_points_set_equal_keep_their_names():
    loop = only_constraint(FOUR_BAR)
    assert (loop.name, loop.kind, loop.text) == ("loop", "holonomic", "C = Cr")
    assert (loop.points, loop.residuals, loop.reaction) == (("C", "Cr"), (), "pin_C")


def test_bodies_may_be_set_equal_to_points():
    constraint = only_constraint(FOUR_BAR.replace("C = Cr", "coupler=(Cr)"))
    assert constraint.points == ("coupler", "Cr")
    constraint = only_constraint(LINE + "points: {A: 0}\nconstraints: [{holonomic: b = A}]\n")
    assert constraint.points == ("b", "A")


def test_four_bar_says_what_is_free_and_where_to_look():
    model = read(FOUR_BAR)
    assert [c.role for c in model.coordinates] == ["free", "linked", "linked"]
    assert model.initial == {"q1": sp.pi / 3, "q1'": 2}
    assert model.guess == {"q2": sp.pi / 9, "q3": 4 * sp.pi / 9}
    assert model.expect.dof == 1


def test_rolling_is_a_relation_of_rates():
    radius, theta, x_rate, y_rate, phi_rate = real("R", "theta", "x'", "y'", "phi'")
    one, other = read(ROLLING_DISC).constraints
    assert one.kind == other.kind == "nonholonomic"
    assert one.residuals == (x_rate - radius * phi_rate * sp.cos(theta),)
    assert other.residuals == (y_rate - radius * phi_rate * sp.sin(theta),)
    assert one.text == "x' - R*phi'*cos(theta) = 0"


def test_rope_is_one_sided():
    x, y, length, e = real("x", "y", "l", "e")
    taut = only_constraint(ROPE)
    assert taut.kind == "unilateral"
    assert taut.residuals == (length - sp.sqrt(x**2 + y**2),)
    assert (taut.restitution, taut.friction) == (e, None)


def test_gap_is_positive_on_the_open_side_whichever_way_it_is_written():
    (phi,) = real("phi")
    assert residual("phi >= 1", "unilateral") == phi - 1
    assert residual("1 <= phi", "unilateral") == phi - 1
    assert residual("phi <= 1", "unilateral") == 1 - phi
    assert residual("1 >= phi", "unilateral") == 1 - phi


def test_residual_is_left_minus_right():
    phi, m, g = real("phi", "m", "g")
    assert residual("m*g*phi = m*g*sin(phi)") == m * g * phi - m * g * sp.sin(phi)


def test_every_option_is_read():
    x, y, mu, omega, w_rate = real("x", "y", "mu", "Omega", "w'")
    loop, track, spin, floor, ceiling = read(LINKED).constraints
    assert (loop.description.latex, loop.description.about) == (r"\Phi_1", "the beam's end")
    assert track.residuals == (y - x * sp.tan(omega * TIME),)
    assert spin.residuals[0].diff(w_rate) == -1
    assert (floor.friction, ceiling.friction) == (mu / 2, None)
    assert ceiling.restitution == sp.Rational(1, 2)
    assert [c.reaction for c in (loop, track, spin, floor, ceiling)] == [
        "pin", "normal", None, None, "push",
    ]  # fmt: skip
    assert [c.name for c in read(LINKED).constraints] == [
        "loop", "track", "spin", "floor", "ceiling",
    ]  # fmt: skip


def test_list_of_constraints_is_counted():
    text = BASE + "constraints: [{holonomic: phi = 1}, {unilateral: phi >= 0}]\n"
    assert [c.name for c in read(text).constraints] == ["constraint 1", "constraint 2"]


def test_text_is_on_one_line():
    text = BASE + "constraints:\n  c:\n    holonomic: phi\n      =   1\n"
    assert only_constraint(text).text == "phi = 1"


@pytest.mark.parametrize(
    "relation",
    [
        "phi' = 0",
        "l*phi' + w' = 0",
        "l*phi'*cos(phi)^2/(2 + sin(t*sqrt(g/l))) = sqrt(g*l)",
        "(phi' + sqrt(g/l))^2 - phi'^2 = 0",
        "abs(phi)*phi' = max(phi, 0)*phi'*2",
        "2*der(phi) = sqrt(g/l)*phi",
    ],
)
def test_linear_relations_of_rates(relation):
    base = BASE + "prescribed: {w: l*sin(t*sqrt(g/l))}\n"
    (rate,) = real("phi'")
    found = residual(relation, "nonholonomic", base)
    assert found.has(rate)
    assert not found.diff(rate).has(rate)


@pytest.mark.parametrize(
    "relation", ["phi'^2 = g/l", "sqrt(phi') = 0", "1/phi' = sqrt(l/g)", "phi'*sign(phi') = 0"]
)
def test_relations_that_are_not_linear(relation):
    assert "E511" in codes(BASE + f'constraints: [{{nonholonomic: "{relation}"}}]\n')


@pytest.mark.parametrize(
    ("changes", "fixed"),
    [
        ({}, True),
        ({"A: [0, 0]": "A: [q1*a, 0]"}, False),
        ({"A: [0, 0]": "A: Cr - Cr + [0, e]"}, True),
        ({"A: [0, 0]": "A: (Cr + D)/2"}, False),
        ({"A: [0, 0]": "A: cos(q1)*D"}, False),
        ({"A: [0, 0]": "A: {on: crank, at: [0, 0]}", "rod: [A, B]": "at: B"}, False),
        ({"A: [0, 0]": "A: {on: crank, at: [0, 0]}", "rod: [A, B]": "at: D, angle: q2"}, False),
        ({"A: [0, 0]": "A: {on: crank, at: [0, 0]}", "rod: [A, B]": "at: D, angle: 1"}, True),
        ({"A: [0, 0]": "A: [a*t*sqrt(g/a), 0]"}, True),
    ],
)
def test_places_that_no_coordinate_moves_are_refused(changes, fixed):
    text = FOUR_BAR.replace("C = Cr", "A = D")
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    if "rod: [A, B]" in changes:
        text = text.replace("B: A + a", "B: D + a")
    assert codes(text) == (["E510"] if fixed else [])


@pytest.mark.parametrize("ends", ["A = D", "P = D", "crank = D", "Q = D"])
def test_a_place_that_cannot_be_read_is_one_fault(ends):
    text = FOUR_BAR.replace("C = Cr", ends).replace("A: [0, 0]", "A: [0]\n  P: A + [a, 0]")
    text = text.replace("  P:", "  Q: {on: crank, at: [a, 0]}\n  P:")
    assert codes(text.replace("[A, B]", "[A, D]")) == ["E501"]
    unused = text.replace("A: [0]", "A: [0, 0]").replace("mass: rho*a", "mass: rho*aa")
    found = ["E510", "E301"] if ends in ("A = D", "P = D") else ["E301"]
    assert sorted(codes(unused)) == sorted(found)


def test_dimension_of_a_parameter_follows_from_a_constraint():
    text = BASE + "constraints: [{holonomic: a*phi = l}]\n"
    model = read(text.replace("l: 1 m", "l: 1 m, a: {about: x}"))
    found = {p.name: p.description.dimension for p in model.parameters}
    assert found["a"] == found["l"]


def test_roles_are_optional():
    text = FOUR_BAR.replace(", role: linked", "").replace(", role: free", "")
    assert {c.role for c in read(text).coordinates} == {"free"}
    assert read(ROLLING_DISC.replace("about: heading", "role: free")).coordinates
    assert read(BASE.replace("phi: rad", "phi: {role: free}")).coordinates[0].role == "free"


def test_what_is_wrong_in_a_constraint_is_told_once():
    # neither the linked coordinates nor the guess complain of a missing constraint
    assert codes(FOUR_BAR.replace("constraints:", "constrants:")) == ["E104"]
    assert codes(FOUR_BAR.replace("holonomic", "holonmic")) == ["E104"]
    assert codes(FOUR_BAR.replace("C = Cr", "C = Crr")) == ["E301"]
    text = FOUR_BAR.replace("C = Cr, reaction: pin_C", "C - Cr, reaction: a, restitution: 1")
    assert codes(text) == ["E205", "E303", "E112"]


def test_guess_beside_any_constraint():
    assert read(ROPE + "initial: {x: 0, guess: {y: -1 m, y': 0}}\n").guess == {"y": -1, "y'": 0}


def test_every_option_of_one_constraint_is_checked():
    text = ROPE.replace("restitution: e", "restitution: 2, friction: -1, reaction: t")
    assert codes(text) == ["E512", "E512", "E304"]


@pytest.mark.parametrize("value", ["0", "1", "0.5", "e", "1 - e", "sqrt(e)"])
def test_restitution_within_its_bounds(value):
    text = ROPE.replace("restitution: e", f"restitution: {value}")
    assert not codes(text.replace("e: 0", "e: 1"))


def test_options_without_a_value_are_not_compared():
    text = ROPE.replace("e: 0", "e: {about: unknown}").replace("on: e", "on: e*5, friction: -e")
    assert only_constraint(text).friction == -real("e")[0]


def test_names_of_constraints_are_no_names_of_formulas():
    assert read(FOUR_BAR.replace("loop:", "crank:").replace("pin_C", "loop")).constraints
    assert codes(FOUR_BAR + "outputs: {f: loop}\n") == ["E301"]
    with pytest.raises(SpecError, match="'pin_C' is a reaction and may not stand in an output"):
        read(FOUR_BAR + "outputs: {f: pin_C}\n")
    with pytest.raises(SpecError, match="'f' is an output and may not stand in a claim"):
        read(FOUR_BAR.replace("dof: 1", "equations: [f = 0]") + "outputs: {f: q1}\n")


def test_deep_and_long_relations_end():
    rates = " + ".join(f"sin(x{i}')" for i in range(99))
    many = ", ".join(f"x{i}: " for i in range(99))
    text = (
        f"eom: 1\nsystem: T\nspace: plane\ncoordinates: {{{many}}}\nconstraints: [{{nonholonomic: "
    )
    assert codes(f"{text}{rates} = 0}}]\n") == ["E511"]
    tower = "x0'" + "^x1" * 40
    assert codes(f"{text}{tower} = 0}}]\n") == ["E511"]
    assert not codes(f"{text}{rates.replace('sin', '')} = 0}}]\n")
