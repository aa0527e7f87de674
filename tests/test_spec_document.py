import random
from contextlib import nullcontext
from hashlib import sha256

import pytest
import sympy as sp
from bad_specs import BASE, LINE, SOLID
from spec_samples import CONSTRAINED, EVERYTHING, FREE, LINKED, SLIDER_PENDULUM, TWO_LINK_ARM

from eomgen import spec
from eomgen.errors import SpecError
from eomgen.model import Frame, Place, Simulation, Turn
from eomgen.spec.inertias import check_possible
from eomgen.spec.language import CONSTRAINT, LANGUAGE
from eomgen.spec.ledger import Mistake
from eomgen.spec.reader import Point

ZERO, ONE = sp.S.Zero, sp.S.One


def read(text, file="x.yaml"):
    return spec.read(text, file)


def real(*names):
    return [sp.Symbol(n, real=True) for n in names]


@pytest.mark.parametrize("name", FREE)
def test_free_systems_are_read(name):
    model = read(FREE[name], f"specs/{name}.yaml")
    assert model.name == name
    assert model.with_units
    assert model.digest == sha256(FREE[name].encode()).hexdigest()


@pytest.mark.parametrize("name", CONSTRAINED)
def test_constrained_systems_are_read(name):
    model = read(CONSTRAINED[name], f"specs/{name}.yaml")
    assert model.name == name
    assert model.with_units
    assert len(model.constraints) == CONSTRAINED[name].count("holonomic:") + CONSTRAINED[
        name
    ].count("unilateral:")


def test_slider_pendulum_is_what_it_says():
    model = read(SLIDER_PENDULUM)
    s, phi, length, force, k = real("s", "phi", "l", "F", "k")
    slider, bob = model.bodies
    assert model.title["es"] == "Masa deslizante con p\u00e9ndulo"
    assert model.points[0].place == Place((s, ZERO))
    swing = (length * sp.sin(phi), -length * sp.cos(phi))
    assert model.points[1].place == Place(swing, ((ONE, "A"),))
    assert bob.frame == Frame(Place((ZERO, ZERO), ((ONE, "B"),)))
    assert bob.com == Place((ZERO, ZERO), on="bob")
    assert (slider.inertia, bob.mass) == ((), sp.Symbol("m_B", real=True))
    assert (model.springs[0].along, model.springs[0].stiffness) == (s, k)
    assert model.forces[0].components == (force, ZERO)
    assert model.initial == {"s": sp.Rational(1, 10), "phi": sp.pi / 9}
    assert model.parameters[5].description.latex == "c'"
    assert [p.name for p in model.parameters] == ["m_A", "m_B", "l", "k", "c", "d", "g"]
    assert model.expect.dof == 2


def test_two_link_arm_hangs_one_frame_on_the_other():
    model = read(TWO_LINK_ARM)
    w, l1, s2, q2 = real("w", "l1", "s2", "q2")
    upper, fore = model.bodies
    assert upper.frame.origin == Place((ZERO, w))
    assert fore.frame == Frame(Place((l1, ZERO), on="upper"), (Turn((ZERO, ZERO, ONE), q2),))
    assert fore.com == Place((s2, ZERO), on="fore")
    assert (model.moments[1].on, model.moments[1].source) == ("fore", "upper")
    assert model.parameters[8].value == sp.Rational(1, 200)
    assert model.parameters[8].description.unit == "mm"


def test_samples_use_every_key():
    used = {line.split(":")[0] for line in EVERYTHING.splitlines() if line[0].isalpha()}
    assert used == set(LANGUAGE.keys) - {"constraints"}
    assert all(getattr(read(EVERYTHING), key) for key in used - {"eom", "system", "simulate"})
    assert read(EVERYTHING).simulation == Simulation("rk4", sp.Rational(1, 1000), "minimal")
    assert all(f"{key}: " in LINKED for key in CONSTRAINT.keys)
    assert read(LINKED).constraints
    assert read(LINKED).guess


def test_derived_parameters_keep_their_formula_and_values_are_exact():
    model = read(EVERYTHING)
    found = {p.name: p for p in model.parameters}
    mass, length = sp.Symbol("m", positive=True), sp.Symbol("l", real=True)
    assert found["m"].symbol == mass
    assert found["J"].formula == mass * length**2 / 12
    assert found["J"].value is None
    assert found["rate"].value == sp.pi
    assert (found["h"].value, found["h"].formula) == (None, None)


def test_constant_formula_is_a_value():
    model = read(BASE.replace("l: 1 m", "l: 1 m, a: pi/2, b: {value: 2*pi, unit: mm}"))
    values = {p.name: p.value for p in model.parameters}
    assert (values["a"], values["b"]) == (sp.pi / 2, sp.pi / 500)


def test_rod_lies_between_its_points():
    rod = next(b for b in read(EVERYTHING).bodies if b.name == "rod")
    half = sp.Rational(1, 2)
    assert rod.frame == Frame(Place((ZERO, ZERO), ((ONE, "A"),)), along=("A", "B"))
    assert rod.com == Place((ZERO, ZERO), ((half, "A"), (half, "B")))


def test_places_are_affine():
    model = read(EVERYTHING)
    (w,) = real("w")
    half = sp.Rational(1, 2)
    assert model.points[0].place == Place((ZERO, -w), ((half, "A"), (half, "B")))
    text = BASE + "inputs: {F: N}\nforces: [{on: P, force: '(F*[1, 0] - [0, F])/2*3'}]\n"
    (force,) = real("F")
    assert read(text).forces[0].components == (3 * force / 2, -3 * force / 2)
    text = BASE.replace("at: P", "at: 'P - (P - [l, 0])'")
    (length,) = real("l")
    assert read(text).bodies[0].frame.origin == Place((length, ZERO))


def test_local_elongation_is_no_coordinate():
    model = read(EVERYTHING)
    torsion = model.springs[2]
    assert torsion.law.has(torsion.elongation)
    assert torsion.elongation not in {c.symbol for c in model.coordinates}
    assert not torsion.law.has(model.coordinates[0].symbol)


def test_speed_in_a_formula_stands_for_its_own_formula():
    model = read(EVERYTHING)
    phi_rate, w_rate, length = real("phi'", "w'", "l")
    speed = next(o for o in model.outputs if o.name == "speed").formula
    assert speed == length * (phi_rate - w_rate / length)
    text = BASE + "speeds: {u: phi'*cos(phi)}\noutputs: {a: u'}\n"
    phi, rate, acceleration = real("phi", "phi'", "phi''")
    expected = acceleration * sp.cos(phi) - rate**2 * sp.sin(phi)
    assert read(text).outputs[0].formula - expected == 0


def test_rate_of_a_speed_knows_time_and_prescribed_motion():
    text = BASE + "prescribed: {w: sin(sqrt(g/l)*t)}\nspeeds: {u: w*phi'*t}\noutputs: {a: u'}\n"
    w, w_rate, rate, acceleration = real("w", "w'", "phi'", "phi''")
    t = sp.Symbol("t", real=True)
    expected = w_rate * rate * t + w * acceleration * t + w * rate
    assert sp.expand(read(text).outputs[0].formula - expected) == 0


def test_angle_in_degrees_may_stand_where_a_formula_does():
    model = read(BASE.replace("at: P", "at: P, angle: 30 deg"))
    assert model.bodies[0].frame.turns[0].angle == sp.pi / 6


def test_number_before_a_name_is_not_taken_for_a_unit():
    with pytest.raises(SpecError) as caught:
        read(BASE.replace("mass: m", "mass: 2 m"))
    assert caught.value.faults[0].message == "missing operator before 'm'"


@pytest.mark.parametrize(
    ("old", "new", "hint"),
    [
        ("mass: m", "mass: 2 m", "a unit stands behind a number alone: 2 kg, 2 m^-1"),
        ("m: 2 kg", "m: 2 1/m", "a unit stands behind a number alone: 2 kg, 2 m^-1"),
        ("mass: m", 'mass: "0,5"', "decimals take a point: 9.81"),
        ("m: 2 kg", "m: 0,2 kg", "decimals take a point"),
    ],
)
def test_numbers_as_others_write_them_are_answered_with_ours(old, new, hint):
    with pytest.raises(SpecError) as caught:
        read(BASE.replace(old, new))
    assert caught.value.faults[0].hint.endswith(hint)


def test_turns_are_read_left_to_right():
    turned = SOLID.replace("at: P", "at: P, turn: [[-x, phi], [[1, 2, 2], 2*phi], [z, pi/2]]")
    (phi,) = real("phi")
    integers = [tuple(map(sp.Integer, axis)) for axis in ((-1, 0, 0), (1, 2, 2), (0, 0, 1))]
    angles = (phi, 2 * phi, sp.pi / 2)
    expected = tuple(Turn(axis, angle) for axis, angle in zip(integers, angles, strict=True))
    assert read(turned).bodies[0].frame.turns == expected


@pytest.mark.parametrize(
    ("inertia", "entries"),
    [
        ("[1, 2, 3]", "100020003"),
        ("[6, 7, 8, 1, 2, 0]", "612170208"),
        ("[[6, 1, 2], [1, 7, 0], [2, 0, 8]]", "612170208"),
    ],
)
def test_inertia_has_nine_entries(inertia, entries):
    text = SOLID.replace("at: P", f"at: P, inertia: {inertia}").replace(" kg", "")
    text = text.replace("1 m,", "1,").replace(" m/s^2", "")
    assert read(text).bodies[0].inertia == tuple(map(sp.Integer, map(int, entries)))


def test_flat_plate_is_a_possible_body_and_less_is_not():
    units = SOLID.replace(" kg", "").replace("1 m,", "1,").replace(" m/s^2", "")
    assert read(units.replace("at: P", "at: P, inertia: [1, 2, 3]")).bodies
    for impossible in ("[1, 2, 4]", "[1, 1, 1, 2, 0, 0]", "[1, 2, 3, 0, 1/10, 0]"):
        with pytest.raises(SpecError) as caught:
            read(units.replace("at: P", f"at: P, inertia: {impossible}"))
        assert [f.code for f in caught.value.faults] == ["E505"]


@pytest.mark.parametrize("unit", [sp.S.One, sp.pi, sp.Rational(1, 7)])
def test_an_inertia_is_possible_where_its_second_moments_are_semidefinite(unit):
    chance, seen = random.Random(4), set()
    for _ in range(60):
        xx, yy, zz = (chance.randint(2, 9) for _ in range(3))
        xy, xz, yz = (chance.randint(-2, 2) for _ in range(3))
        tensor = sp.Matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        moments = sp.eye(3) * tensor.trace() / 2 - tensor
        possible = moments.is_positive_semidefinite
        with nullcontext() if possible else pytest.raises(Mistake, match="belongs to no body"):
            check_possible([unit * entry for entry in tensor], Point(1, 1), "the inertia of 'b'")
        seen.add(possible)
    assert seen == {True, False}


def test_scalar_is_a_vector_in_a_line():
    (x,) = real("x")
    assert read(LINE).bodies[0].frame.origin == Place((x,))
    text = LINE.replace("at: x", "at: A + 2*x") + "points: {A: '[x]'}\n"
    assert read(text).bodies[0].frame.origin == Place((2 * x,), ((ONE, "A"),))


def test_energy_alone_is_a_model():
    text = "eom: 1\nsystem: Orbit\nspace: plane\ncoordinates: {r: m, theta: rad}\n"
    text += "parameters: {m: 1 kg, mu: 3 m^3/s^2}\n"
    text += "energy: {kinetic: m*(r'^2 + r^2*theta'^2)/2, potential: -mu*m/r}\n"
    model = read(text)
    assert not model.bodies
    assert model.gravity == (ZERO, ZERO)
    assert model.energy.potential.free_symbols == set(real("r", "mu", "m"))


def test_names_may_be_what_other_programs_reserve():
    names = ("I", "N", "S", "E", "beta", "gamma", "lambda", "int", "x", "y", "z", "\u03b8", "v")
    listed = ", ".join(f"{n}: 1" for n in names)
    model = read(BASE.replace("g: 9.81 m/s^2", f"g: 9.81 m/s^2, {listed}"))
    assert [p.name for p in model.parameters][3:] == list(names)
    assert [str(p.symbol) for p in model.parameters][3:] == list(names)


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("specs/two-link arm.v2.yaml", "two_link_arm_v2"),
        ("-", "test"),
        ("<stdin>", "stdin"),
        ("3body.yaml", "model_3body"),
        ("\u00fc.yaml", "test"),
    ],
)
def test_name_is_an_identifier(file, name):
    assert read(BASE, file).name == name


def test_order_is_that_of_the_file():
    shuffled = BASE.replace("m: 2 kg, l: 1 m, g: 9.81 m/s^2", "g: 9.81 m/s^2, m: 2 kg, l: 1 m")
    assert [p.name for p in read(shuffled).parameters] == ["g", "m", "l"]


def test_text_and_bytes_give_the_same_model():
    assert read(SLIDER_PENDULUM) == read(SLIDER_PENDULUM.encode())
    assert read(BASE.replace("\n", "\r\n")).bodies == read(BASE).bodies
