"""Integrability: the growth of brackets decides, and a relation that is shown is proven."""

from fractions import Fraction

import pytest
import sympy as sp
from linkages import (
    HOLONOMIC,
    RATES,
    TIME,
    R,
    dphi,
    dpsi,
    dtheta,
    dx,
    dy,
    dz,
    lecture,
    machine,
    phi,
    psi,
    radius,
    rolling,
    symbol,
    theta,
    x,
    y,
    z,
)

from eomgen.algebra.closed import ClosedForm, to_sympy
from eomgen.analysis import antiderivative, brackets, integrability, linkage, virtual
from eomgen.model import Prescribed

ONES = {"x": R(1), "y": R(1), "theta": R(1)}
w, dw, ddw = (symbol(n) for n in ("w", "w'", "w''"))
SHAKEN = (Prescribed("w", w, dw, ddw, sp.sin(3 * TIME)),)


def one(coordinates, *rates, **known):
    """The decision on one nonholonomic constraint `c`."""
    return integrability.decide(scene(coordinates, *rates, **known))


def scene(coordinates, *rates, **known):
    places = {n: v for n, v in ONES.items() if n in coordinates.split()}
    return machine(coordinates, {"c": (RATES, *rates)}, {"R": 1}, initial=places, **known)


def equals(form, expected):
    """Whether a form is a formula up to a constant factor, by the canonical form itself."""
    algebra = ClosedForm(form.ring)
    other = algebra.of(expected)
    ratio = next(Fraction(form.terms[k]) / other.terms[k] for k in form.terms if k in other.terms)
    return algebra.is_zero(form - other * ratio)


def test_the_upright_disc_cannot_be_integrated() -> None:
    found = integrability.decide(lecture(10))
    assert found.growth == (2, 3, 4)
    assert found.hidden == 0
    assert [v.growth for v in found.verdicts] == [(3, 4), (3, 4)]
    assert not any(v.is_integrable or v.is_integrable_alone or v.hidden for v in found.verdicts)
    assert found.combinations == ()


def test_the_tilting_disc() -> None:
    """Contact point x, y, heading psi, lean theta, spin phi: 2 + 3 directions fill all 5."""
    rows = (dx - radius * dphi * sp.cos(psi), dy - radius * dphi * sp.sin(psi))
    found = one("x y psi theta phi", *rows)
    assert (found.growth, found.hidden) == ((3, 4, 5), 0)


def test_the_tilting_disc_by_its_centre() -> None:
    """Velocity of the contact point from the centre's: the height is a hidden relation.

    v = x' + w cross r with w = psi' e_z + theta' e_1 + phi' e_2, r = -R e_3, e_3 up in the disc.
    """
    e1 = sp.Matrix([sp.cos(psi), sp.sin(psi), 0])
    side = sp.Matrix([-sp.sin(psi), sp.cos(psi), 0])
    up = sp.Matrix([0, 0, 1])
    axle = sp.cos(theta) * side + sp.sin(theta) * up
    radial = -sp.sin(theta) * side + sp.cos(theta) * up
    spin = dpsi * up + dtheta * e1 + dphi * axle
    contact = sp.Matrix([dx, dy, dz]) + spin.cross(-radius * radial)
    known = {"initial": {"theta": R(1, 3), "z": R(1)}}
    rows = {"rolling": (RATES, *(sp.expand(c) for c in contact))}
    found = integrability.decide(machine("x y z psi theta phi", rows, {"R": 1}, **known))
    assert (found.growth, found.hidden) == ((3, 4, 5), 1)
    height = found.verdict("rolling.z")
    assert height.is_integrable_alone
    assert height.hidden
    assert equals(height.hidden.relation, z - radius * sp.cos(theta))
    assert not found.verdict("rolling.x").is_integrable


@pytest.mark.parametrize(
    ("coordinates", "rate", "relation"),
    [
        ("x phi", dx - radius * dphi, x - radius * phi),
        ("x y", y * dx + x * dy, x * y),
        ("x y", dx * y - x * dy, y / x),
        ("x theta", dx * sp.sin(theta) + x * dtheta * sp.cos(theta), x * sp.sin(theta)),
        ("x theta", dx - dtheta * sp.cos(2 * theta), x - sp.sin(2 * theta) / 2),
        ("x theta", dx - theta * dtheta * sp.cos(theta), x - theta * sp.sin(theta) - sp.cos(theta)),
        (
            "x theta",
            dx - theta**2 * dtheta * sp.sin(theta),
            x + theta**2 * sp.cos(theta) - 2 * theta * sp.sin(theta) - 2 * sp.cos(theta),
        ),
        ("x theta", dx + x * dtheta * sp.tan(theta), x / sp.cos(theta)),
        ("x y", x * dx + y**2 * (x**2 + 1) * dy, sp.log(x**2 + 1) / 2 + y**3 / 3),
        ("x y", dx * sp.exp(2 * y) + 2 * x * dy * sp.exp(2 * y), x * sp.exp(2 * y)),
        ("x y", dx + x * dy, x * sp.exp(y)),
        ("x y", x * dx / sp.sqrt(x**2 + 1) - dy, sp.sqrt(x**2 + 1) - y),
        ("x y z", x * dx + y * dy + z * dz, x**2 + y**2 + z**2),
        ("x y", dx - 2 * TIME * dy - 2 * y, x - 2 * TIME * y),
        ("x y", dx - 3, x - 3 * TIME),
        ("x", dx - sp.cos(2 * TIME), x - sp.sin(2 * TIME) / 2),
    ],
)
def test_a_disguised_holonomic_constraint_is_found(coordinates, rate, relation) -> None:
    found = one(coordinates, rate)
    (verdict,) = found.verdicts
    assert verdict.is_integrable_alone
    assert found.hidden == 1
    assert verdict.hidden
    assert equals(verdict.hidden.relation, relation), to_sympy(verdict.hidden.relation)


def test_what_is_shown_is_proven() -> None:
    """D phi/dt = factor * row, decided in the canonical form."""
    given = scene("x theta", dx * sp.sin(theta) + 2 * x * dtheta * sp.cos(theta))
    hidden = integrability.decide(given).verdicts[0].hidden
    assert hidden
    algebra, (row,) = virtual.closed_rows(linkage.of(given).model)
    moving = {c.symbol: algebra.of(c.rate) for c in given.model.coordinates}
    relation, factor = (algebra.of(to_sympy(f)) for f in (hidden.relation, hidden.factor))
    assert algebra.is_zero(algebra.along(relation, moving) - factor * row.rate)
    assert not algebra.is_zero(algebra.along(relation, moving) - 2 * factor * row.rate)


@pytest.mark.parametrize(
    ("coordinates", "rate", "growth"),
    [
        ("x y theta", dx * sp.sin(theta) - dy * sp.cos(theta), (2, 3)),  # Chaplygin's sleigh
        ("x y theta", dy - x * dtheta, (2, 3)),  # Heisenberg
        ("x y theta", dx - 2 * TIME * dy - y, (3, 4)),  # in space and time
        ("x y z theta", dz - x * dy + theta * dx, (3, 4)),
    ],
)
def test_what_cannot_be_integrated(coordinates, rate, growth) -> None:
    found = one(coordinates, rate)
    assert (found.growth, found.hidden) == (growth, 0)
    (verdict,) = found.verdicts
    assert not verdict.is_integrable
    assert verdict.hidden is None


@pytest.mark.parametrize(("spins", "growth"), [(True, (3, 5)), (False, (2, 3, 5))])
def test_the_rolling_ball(spins, growth) -> None:
    """Euler angles psi, theta, phi about z, x, z; without spin: Cartan's (2, 3, 5)."""
    across = dtheta * sp.cos(psi) + dphi * sp.sin(theta) * sp.sin(psi)
    along = dtheta * sp.sin(psi) - dphi * sp.sin(theta) * sp.cos(psi)
    rows = [dx - radius * along, dy + radius * across]
    rows += [] if spins else [dpsi + dphi * sp.cos(theta)]
    found = one("x y psi theta phi", *rows)
    assert (found.growth, found.hidden) == (growth, 0)


def test_growth_that_takes_several_brackets() -> None:
    """Engel's distribution: z' = y x', y' = theta x'."""
    assert one("x y z theta", dz - y * dx, dy - theta * dx).growth == (2, 3, 4)


def test_a_relation_without_a_known_formula_is_said_to_exist() -> None:
    square = x**2 + y**2 + 1
    (verdict,) = one("x y theta", dx * square - dy * square**2 * sp.exp(x * y)).verdicts
    assert verdict.is_integrable
    assert verdict.hidden is None


def test_prescribed_motions_are_integrated_as_symbols_where_they_can() -> None:
    (follows,) = one("x", dx - dw, prescribed=SHAKEN).verdicts
    assert follows.hidden
    assert equals(follows.hidden.relation, x - w)
    (speed,) = one("x", dx - w, prescribed=SHAKEN).verdicts
    assert speed.hidden
    assert equals(speed.hidden.relation, x + sp.cos(3 * TIME) / 3)


def test_rows_that_integrate_only_together() -> None:
    found = one("x y theta phi", *rolling, dtheta)
    first, second, heading = found.verdicts
    assert found.hidden == 3
    assert not first.is_integrable_alone
    assert first.is_integrable
    assert first.hidden
    assert equals(first.hidden.relation, x - radius * phi * sp.cos(theta))
    assert first.hidden.constants == ("theta",)
    assert heading.is_integrable_alone
    assert heading.hidden
    assert heading.hidden.constants == ()
    assert second.growth == (3, 4)


def test_a_combination_with_constant_shares_is_found() -> None:
    rows = {"a": (RATES, dx - y * dtheta), "b": (RATES, dz - 2 * dx + 2 * y * dtheta + dy)}
    found = integrability.decide(machine("x y z theta", rows))
    assert found.hidden == 1
    assert not any(v.is_integrable for v in found.verdicts)
    (combination,) = found.combinations
    shares = dict(combination.shares)
    assert shares["b"] * 2 == shares["a"]
    assert equals(combination.relation, y + z)


def test_a_sum_that_needs_a_factor_is_found() -> None:
    first = dx - y * dtheta
    rows = {"a": (RATES, first), "b": (RATES, z * dy - y * dz - first)}
    ones = {"y": R(1), "z": R(1)}
    found = integrability.decide(machine("x y z theta", rows, initial=ones))
    assert found.hidden == 1
    assert not any(v.is_integrable for v in found.verdicts)
    (combination,) = found.combinations
    assert combination.shares == (("a", 1), ("b", 1))
    assert equals(combination.relation, z / y)


def test_an_exact_sum_of_rows_is_found() -> None:
    rows = {"a": (RATES, dx - y * dtheta), "b": (RATES, dx + y * dtheta - 2 * dy)}
    found = integrability.decide(machine("x y theta", rows, initial={"y": R(1)}))
    assert found.hidden == 2
    assert all(v.is_integrable and not v.is_integrable_alone for v in found.verdicts)
    (combination,) = found.combinations
    assert combination.shares == (("a", 1), ("b", 1))
    assert equals(combination.relation, x - y)


def test_a_one_form_that_is_not_exact_has_no_potential() -> None:
    algebra = ClosedForm()
    forms = [(x, algebra.of(y)), (y, algebra.number(0))]
    assert not antiderivative.is_exact(algebra, forms)
    assert antiderivative.potential(algebra, forms) is None


def test_a_row_is_integrated_where_the_positions_allow() -> None:
    """With the heading held by a position constraint the sleigh slides on a line."""
    rows = {
        "heading": (HOLONOMIC, theta - 1),
        "blade": (RATES, dx * sp.sin(theta) - dy * sp.cos(theta)),
    }
    found = integrability.decide(machine("x y theta", rows))
    assert (found.growth, found.hidden) == ((1,), 1)
    (verdict,) = found.verdicts
    assert verdict.hidden
    assert equals(verdict.hidden.relation, x * sp.sin(theta) - y * sp.cos(theta))


def test_positions_alone_hide_nothing() -> None:
    found = integrability.decide(lecture(9))
    assert (found.hidden, found.verdicts, found.with_time) == (0, (), True)


def test_brackets_of_a_position_constraint_close_everywhere() -> None:
    """Frobenius: the sphere that turns, over space and time, where round-off must not count."""
    from eomgen.analysis import admissible

    rows = linkage.of(lecture(9))
    states = [s.state for s in admissible.draw(lecture(9), 3)]
    given = brackets.covectors(rows)
    assert brackets.growth(rows, given, (0, 1), states).dimensions == (2,)


def test_the_bracket_has_its_sign() -> None:
    """[d/dx, x d/dy] = d/dy."""
    rows = linkage.of(machine("x y", {"c": (HOLONOMIC, x - y)}))
    zero, at = rows.zero, rows.kinematics.algebra.of
    found = brackets.bracket(rows, (x, y), (zero + 1, zero), (zero, at(x)))
    assert found.value == (zero, zero + 1)


@pytest.mark.parametrize(
    "formula",
    [
        x**3 * y,
        1 / x,
        1 / x**3,
        sp.cos(2 * x + y) * y,
        x**3 * sp.sin(radius * x),
        sp.exp(-2 * x) * y**2,
        1 / (x + y),
        x / (x**2 + y**2) ** 2,
        sp.sin(x) / sp.cos(x) ** 3,
        x * sp.sqrt(x**2 + y),
        x / sp.sqrt(x**2 + y),
        sp.cos(x) / sp.sin(x),
        sp.Integer(5),
        y,
    ],
)
def test_the_derivative_of_the_antiderivative(formula) -> None:
    algebra = ClosedForm()
    form = algebra.of(formula)
    found = antiderivative.of(algebra, form, x)
    assert found is not None
    assert algebra.is_zero(antiderivative.slope(algebra, found, x) - form)


@pytest.mark.parametrize("formula", [sp.exp(x**2), sp.sin(x**2), sp.sin(x) / x, sp.log(x)])
def test_no_antiderivative_is_invented(formula) -> None:
    algebra = ClosedForm()
    assert antiderivative.of(algebra, algebra.of(formula), x) is None
