"""Admissible states: what is known stays, the rest closes, and what does not close is an error."""

import pytest
import sympy as sp
from linkages import (
    GAP,
    HOLONOMIC,
    LECTURE,
    RATES,
    SQUEEZER,
    TIME,
    R,
    degrees,
    dx,
    dy,
    four_bar,
    lecture,
    machine,
    radius,
    rolling,
    sphere,
    squeezer,
    symbol,
    x,
    y,
    z,
)

from eomgen.analysis import admissible, linkage, neighbourhood
from eomgen.analysis.linkage import PRECISE
from eomgen.errors import UsageError

CRANK = {"a": degrees(30), "a'": sp.Integer(2)}
GUESS = {"b": degrees(20), "c": degrees(80)}


def crank_rocker(**known):
    return four_bar(R(2, 5), 1, R(9, 10), 1, **{"initial": CRANK, "guess": GUESS, **known})


def residuals(scene, state):
    """Every phi and every rate at a state, in 50 digits."""
    rows = linkage.of(scene)
    nodes = [r.residual for r in rows.holonomic] + [r.rate for r in rows.rows]
    return linkage.values(rows, nodes, state, PRECISE)


def assert_admissible(scene, state, tolerance=1e-40):
    assert all(abs(r) < tolerance for r in residuals(scene, state))


def test_a_wrong_state_has_residuals() -> None:
    scene = crank_rocker()
    found = admissible.positions(scene).state
    bent = linkage.State(found.time, (*found.coordinates[:2], 1), found.rates, found.parameters)
    assert max(abs(r) for r in residuals(scene, bent)) > 1e-3


def test_the_four_bar_closes_from_a_guess_and_the_crank_stays() -> None:
    scene = crank_rocker()
    found = admissible.positions(scene)
    assert_admissible(scene, found.state)
    assert found.distance == 0
    assert float(found.state.coordinates[0]) == pytest.approx(float(sp.pi / 6), abs=1e-15)
    assert found.state.rates[0] == 2
    assert [m.name for m in found.moves] == ["b", "c", "b'", "c'"]
    # the diagonal from the crank's end to the ground joint, by the law of cosines
    a, b, c = (float(v) for v in found.state.coordinates)
    assert float(sp.cos(b - c)) == pytest.approx(
        (1 + 0.81 - (1 + 0.16 - 0.8 * float(sp.cos(a)))) / 1.8, abs=1e-14
    )


def test_the_other_assembly_mode_is_the_mirror_image() -> None:
    scene = crank_rocker()
    found = admissible.positions(scene)
    (other,) = found.others
    state = found.state
    rest = (0,) * 3
    assert_admissible(scene, linkage.State(state.time, other, rest, state.parameters))
    # both modes are mirror images about the diagonal: b - c changes its sign
    _, b, c = state.coordinates
    turn = 2 * PRECISE.functions["pi"]()
    total = ((b - c) + (other[1] - other[2])) / turn
    assert abs(total - round(total)) < 1e-40
    assert any("another assembly mode" in line for line in admissible.describe(scene, found))


def test_known_values_that_cannot_hold_move_least_and_are_named() -> None:
    scene = machine(
        "x y",
        {"circle": (HOLONOMIC, x**2 + y**2 - 1)},
        initial={"x": R(3), "y": R(4)},
    )
    found = admissible.positions(scene)
    assert [float(v) for v in found.state.coordinates] == pytest.approx([0.6, 0.8])
    assert float(found.distance) == pytest.approx(3.2)
    assert all(m.known for m in found.moves)
    assert admissible.describe(scene, found)[0] == "known values moved: x 3 -> 0.6, y 4 -> 0.8"


def test_only_the_rest_moves_where_it_can_close() -> None:
    scene = machine(
        "x y", {"circle": (HOLONOMIC, x**2 + y**2 - 1)}, initial={"x": R(3, 5)}, guess={"y": R(1)}
    )
    found = admissible.positions(scene)
    assert found.state.coordinates[0] == PRECISE.number(3) / 5
    assert abs(found.state.coordinates[1] - PRECISE.number(4) / 5) < 1e-40
    assert found.distance == 0
    assert [[float(v) for v in o] for o in found.others] == [pytest.approx([0.6, -0.8])]


def test_a_free_mechanism_has_no_isolated_other_modes() -> None:
    assert admissible.positions(machine("x y", {"c": (HOLONOMIC, x**2 + y**2 - 1)})).others == ()


def test_one_of_a_continuum_is_no_assembly_mode() -> None:
    rows = {"c": (HOLONOMIC, y * (y - 1)), "d": (HOLONOMIC, y * (z - 2))}
    known = {"initial": {"x": R(0)}, "guess": {"y": R(9, 10), "z": R(19, 10)}}
    found = admissible.positions(machine("x y z", rows, **known))
    assert [float(v) for v in found.state.coordinates] == [0, 1, 2]
    assert found.others == ()


def test_a_double_solution_is_alone_too() -> None:
    """y = 0 is a double root of y^2 (y - x), as at a dead point, but no continuum."""
    known = {"initial": {"x": R(1)}, "guess": {"y": R(0)}}
    found = admissible.positions(machine("x y", {"c": (HOLONOMIC, y**2 * (y - x))}, **known))
    assert [float(v) for v in found.state.coordinates] == [1, 0]
    assert [[float(v) for v in o] for o in found.others] == [[1, 1]]


def test_rates_are_the_least_change_that_satisfies_all_rows() -> None:
    scene = machine("x y", {"c": (RATES, dx + dy - 2)})
    rates = admissible.positions(scene).state.rates
    assert [float(v) for v in rates] == pytest.approx([1, 1], abs=1e-15)
    assert abs(sum(rates) - 2) < 1e-40
    known = machine("x y", {"c": (RATES, dx + dy - 2)}, initial={"x'": R(5)})
    rates = admissible.positions(known).state.rates
    assert rates[0] == 5
    assert abs(rates[1] + 3) < 1e-40


def test_contradictory_rows_are_named_with_their_residuals() -> None:
    rows = {
        "sum": (HOLONOMIC, x + y - 1),
        "free": (HOLONOMIC, z - x**2),
        "more": (HOLONOMIC, x + y - 2),
    }
    with pytest.raises(UsageError) as error:
        admissible.positions(machine("x y z", rows))
    assert "sum (residual 0.5), more (residual 0.5)" in str(error.value)
    assert "free" not in str(error.value)


@pytest.mark.parametrize("residual", [x**2 + 1, sp.sqrt(x) + 1, sp.cos(x) - 2])
def test_a_row_that_no_state_satisfies_is_an_error(residual) -> None:
    with pytest.raises(UsageError, match="lonely"):
        admissible.positions(machine("x y", {"lonely": (HOLONOMIC, residual)}))


def test_contradictory_rates_are_an_error() -> None:
    with pytest.raises(UsageError, match=r"one .*two"):
        admissible.positions(machine("x y", {"one": (RATES, dx - 1), "two": (RATES, dx - 2)}))


def test_redundant_rows_do_no_harm() -> None:
    rows = {"c1": (HOLONOMIC, x + y**2 - 2), "c2": (HOLONOMIC, 3 * x + 3 * y**2 - 6)}
    scene = machine("x y", rows, initial={"x": R(1)}, guess={"y": R(1)})
    assert_admissible(scene, admissible.positions(scene).state)


def test_a_constraint_may_not_depend_on_an_input() -> None:
    from eomgen.model import Input

    force = symbol("F")
    scene = machine("x", {"c": (HOLONOMIC, x - force)}, inputs=(Input("F", force),))
    with pytest.raises(UsageError, match="constraint c depends on the input F"):
        admissible.positions(scene)


def test_a_violated_gap_is_an_error() -> None:
    scene = machine("x", {"stop": (GAP, x - 1)}, initial={"x": R(1, 2)})
    with pytest.raises(UsageError, match=r"stop: its gap is -0\.5"):
        admissible.positions(scene)


@pytest.mark.parametrize("row", LECTURE)
def test_random_states_of_the_lecture_are_admissible_and_different(row) -> None:
    drawn = admissible.draw(lecture(row), 6, seed=3)
    assert len({s.state.coordinates for s in drawn}) == 6
    for found in drawn:
        assert_admissible(lecture(row), found.state)
    again = admissible.draw(lecture(row), 6, seed=3)
    assert [s.state for s in again] == [s.state for s in drawn]


def test_random_states_stay_inside_the_range() -> None:
    scene = crank_rocker(range={"a": (degrees(40), degrees(50)), "b": (degrees(0), degrees(90))})
    for found in admissible.draw(scene, 5):
        a, b, _ = (float(v) for v in found.state.coordinates)
        assert 40 <= a * 180 / 3.141592653589793 <= 50
        assert 0 <= b <= 1.5708


def test_a_range_that_no_state_reaches_is_an_error() -> None:
    with pytest.raises(UsageError, match="inside `range`"):
        admissible.draw(crank_rocker(range={"c": (degrees(-5), degrees(5))}), 3)


def test_random_states_keep_off_the_wrong_side_of_a_gap() -> None:
    rows = linkage.of(lecture(7))
    for found in admissible.draw(lecture(7), 8):
        (gap,) = linkage.values(rows, [g for _, g in rows.gaps], found.state, PRECISE)
        assert gap >= 0


def test_a_time_dependent_row_holds_at_each_time() -> None:
    scene = machine("x", {"c": (HOLONOMIC, x - TIME**2)})
    for found in admissible.draw(scene, 3):
        state = found.state
        assert abs(state.coordinates[0] - state.time**2) < 1e-40
        assert abs(state.rates[0] - 2 * state.time) < 1e-40
    assert abs(admissible.positions(scene, time=2).state.coordinates[0] - 4) < 1e-40


def test_quasi_velocities_do_not_matter() -> None:
    from eomgen.model import Speed

    speed = Speed("u", symbol("u"), symbol("u'"), dx * 2)
    with_speed = machine("x", {"c": (RATES, symbol("u") - 6)}, speeds=(speed,))
    assert abs(admissible.positions(with_speed).state.rates[0] - 3) < 1e-40


def test_open_parameters_stand_in_and_are_named() -> None:
    from linkages import scene

    from eomgen import compile
    from eomgen.model import Parameter

    model = scene("x y z", {"sphere": (HOLONOMIC, sphere)})
    parameters = (Parameter("R", radius, positive=True),)
    model = type(model)(**{**vars(model), "parameters": parameters})
    found = admissible.positions(compile.machine_of(model))
    assert found.stand_ins == ("R",)
    assert any("R" in line for line in admissible.describe(compile.machine_of(model), found))


def test_the_rolling_disc_moves_along_its_heading() -> None:
    scene = machine(
        "x y theta phi",
        {"rolling": (RATES, *rolling)},
        {"R": R(1, 2)},
        initial={"theta": degrees(60), "phi'": sp.Integer(4), "theta'": sp.Integer(1)},
    )
    rates = admissible.positions(scene).state.rates
    assert [float(v) for v in rates] == pytest.approx([1.0, 3**0.5, 1.0, 4.0], abs=1e-15)


def test_the_squeezer_closes_at_the_published_angles() -> None:
    found = admissible.positions(squeezer()).state.coordinates
    for value, published in zip(found, SQUEEZER.values(), strict=True):
        assert abs(value - PRECISE.number(published)) < 1e-15


def test_angles_are_shown_between_minus_pi_and_pi() -> None:
    turn = 2 * PRECISE.functions["pi"]()
    assert neighbourhood.principal([turn + 1, turn + 1], [True, False])[1] == turn + 1
    shown = neighbourhood.principal([v + turn for v in (1, 3, -3)] + [-turn / 2], [True] * 4)
    assert [float(v) for v in shown] == pytest.approx([1, 3, -3, float(turn / 2)])


def test_lengths_are_not_angles() -> None:
    scene = machine("x theta", {"c": (HOLONOMIC, x - sp.sin(symbol("theta")))})
    state = admissible.positions(scene).state
    assert neighbourhood.periodic(linkage.of(scene), state) == (False, True)
