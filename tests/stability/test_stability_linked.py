"""Rows 8 to 15, 19, 22 and 23: constraints that drift, are stabilised, lose rank or hold."""

from fractions import Fraction as F

import numpy as np
import pytest
from laboratory import (
    CRANK_ROCKER,
    FOUR_BAR,
    SHIPPED,
    TURNING,
    derived,
    drift,
    engine,
    failed,
    insisting,
    residual,
    run,
    start,
    stepped,
    studied,
)
from measures import best_in_float, crank, exact_parallelogram
from references import Loop, Lost, Penalty, closed, reduced_run

from eomgen import study
from eomgen.errors import UsageError
from eomgen.numerics.records import RESIDUAL, SINGULAR, STOPPED, UNPROJECTED


def bare(text=CRANK_ROCKER, formulation="multiplier", baumgarte=F(0)):
    return stepped(text, formulation, baumgarte, bare=True)


def residuals_of(steps, spans, method="rk4"):
    """The residual at the end of each span, h = 1e-3."""
    scene = engine(steps)
    rows = run(scene, method, start(steps), 1e-3, round(spans[-1] * 1000), 1000)
    found = residual(scene, rows)
    return [found[round(span)] for span in spans], found.max()


def test_row_8_drift_of_index_1_grows_with_the_square_of_time():
    at, _ = residuals_of(bare(), (10, 100, 1000))
    assert at[1] / at[0] == pytest.approx(100, rel=0.2)
    assert at[2] / at[1] == pytest.approx(100, rel=0.2)
    assert at[2] == pytest.approx(3e-4, rel=0.1)


def test_row_8_nullspace_drifts_slowly_and_projection_not_at_all():
    at, worst = residuals_of(bare(formulation="nullspace"), (10, 100, 1000))
    assert at[1] / at[0] < 12
    assert at[2] / at[1] < 12
    assert worst < 1e-8
    for formulation in ("nullspace", "multiplier"):
        assert residuals_of(stepped(CRANK_ROCKER, formulation), (10, 100, 1000))[1] < 1e-14


def test_row_9_semi_euler_on_bare_index_1_falls_apart():
    steps = bare()
    rows = run(engine(steps), "semi-euler", start(steps), 1e-3, 300_000)
    assert rows.stopped & STOPPED
    assert rows.steps < 300_000


@pytest.mark.parametrize(("formulation", "step"), [("nullspace", 1e-3), ("multiplier", 2.5e-4)])
def test_row_9_projected_semi_euler_holds_together(formulation, step):
    steps = stepped(CRANK_ROCKER, formulation)
    scene = engine(steps)
    rows = run(scene, "semi-euler", start(steps), step, round(300 / step), 4000)
    assert not failed(rows)
    assert residual(scene, rows).max() < 1e-6


def test_row_9_projection_does_not_keep_the_energy():
    """At h = 1e-3 the projected multiplier form gains energy until it runs away before 300 s."""
    steps = stepped(CRANK_ROCKER, "multiplier")
    scene = engine(steps)
    rows = run(scene, "semi-euler", start(steps), 1e-3, 60_000, 1000)
    assert 0.1 < drift(scene, rows) < 0.5
    assert failed(run(scene, "semi-euler", start(steps), 1e-3, 300_000))


@pytest.mark.parametrize("step", [F(1, 100), F(1, 1000), F(1, 10_000)])
def test_row_10_baumgarte_beyond_the_limit_of_semi_euler(step):
    """Critical damping of rate alpha: 1 is above 0.828, 0.2 below."""
    for share, is_failure in ((F(1), True), (F(1, 5), False)):
        steps = bare(baumgarte=share / step)
        rows = run(engine(steps), "semi-euler", start(steps), float(step), int(10 / step))
        assert failed(rows) == is_failure


def rate_errors(baumgarte, counts=(2500, 5000, 10_000)):
    """Errors of the crank speed over 10 s; `baumgarte`: the step -> alpha."""
    reference = crank("nullspace", 40_000)
    errors = []
    for count in counts:
        steps = bare(baumgarte=baumgarte(F(10, count)))
        rows = run(engine(steps), "rk4", start(steps), 10 / count, count, count // 100)
        errors.append(np.abs(rows.states[:, 3] - reference[:, 1]).max())
    return errors


def test_row_11_alpha_of_one_over_h_costs_rk4_its_order():
    errors = rate_errors(lambda step: 1 / step)
    assert np.log2(errors[0] / errors[-1]) / 2 <= 1.5
    mild = rate_errors(lambda step: F(10), (2000, 4000, 8000))
    assert np.log2(mild[0] / mild[-1]) / 2 >= 3.5
    assert mild[-1] < errors[-1]


STEPS = (2e-2, 1e-2, 5e-3, 1e-3, 1e-4)


@pytest.mark.parametrize("step", [*STEPS[:4], 2e-4])
def test_row_12_multipliers_pass_the_singular_position(step):
    steps = stepped("parallelogram", "multiplier")
    scene = engine(steps)
    rows = run(scene, "rk4", start(steps), step, round(10 / step), 10)
    assert rows.states[-1, 0] == pytest.approx(exact_parallelogram()[0], abs=1e-4)
    assert drift(scene, rows) < 1e-6
    assert rows.tally[UNPROJECTED][0] > 0  # the guard was needed
    assert residual(scene, rows).max() < 1e-11


def test_row_12_a_stage_at_the_singular_position_is_told():
    """With h = 1e-4 a stage is at q1 = 6e-8: S has no digits there, and the step says so."""
    steps = stepped("parallelogram", "multiplier")
    scene = engine(steps)
    rows = run(scene, "rk4", start(steps), 1e-4, 7084)
    assert RESIDUAL not in rows.tally
    hit = rows.states[-1] + 0.5e-4 * scene.function("state_derivative")(0.7084, rows.states[-1])
    assert abs(hit[0]) < 1e-7
    assert scene.function("constraint_margin")(0.0, hit)[0] < 1e-13
    assert RESIDUAL in run(scene, "rk4", start(steps), 1e-4, 7090).tally


@pytest.mark.parametrize("step", STEPS)
def test_row_12_bare_index_1_does_not(step):
    steps = bare("parallelogram")
    scene = engine(steps)
    rows = run(scene, "rk4", start(steps), step, round(10 / step), 10)
    assert failed(rows) or abs(rows.states[-1, 0] - exact_parallelogram()[0]) > 0.1


def branch(scene, step, way):
    """The full state after 10 s in a reduced form of the parallelogram, and its energy error."""
    loop, y = Loop(scene), start(bare("parallelogram"))
    last = [y[1:3]]

    def newton(q1):
        places = loop.newton(q1, last[0])
        last[0] = places[1:]
        return places

    places = newton if way == "newton" else lambda q1: closed(q1, (1, 1, 1, 1), way)
    end = reduced_run(loop, places, [y[0], y[3]], step, round(10 / step))
    both = scene.sweep("energy_flow", np.zeros(2), np.array([y, end]))[:, 0]
    return end, abs(both[1] - both[0])


@pytest.mark.parametrize("step", [2e-2, 1e-2, pytest.param(5e-3, marks=pytest.mark.slow)])
@pytest.mark.parametrize("way", ["newton", 1, -1])
def test_row_12_partitioning_and_elimination_lose_the_branch_in_silence(step, way):
    scene = engine(bare("parallelogram"))
    try:
        end, error = branch(scene, step, way)
    except (Lost, np.linalg.LinAlgError):
        return
    assert np.abs(scene.function("constraint_residuals")(0.0, end)).max() < 1e-12
    assert abs(end[0] - exact_parallelogram()[0]) > 1e-2
    assert error > 1e-3  # only the energy tells


@pytest.mark.parametrize("formulation", ["nullspace", "minimal"])
def test_row_12_and_15_what_would_fail_there_is_refused(formulation):
    for scene, why in (("parallelogram", "rank|dead point"), ("slider_crank_equal", "W-DEAD|rank")):
        with pytest.raises(UsageError, match=why):
            derived(scene, formulation)


@pytest.mark.parametrize("step", [*STEPS[:4], pytest.param(STEPS[4], marks=pytest.mark.slow)])
def test_row_12_nullspace_passes_but_for_the_smallest_step(step):
    """The guard carries it through, until a step lands so near that its pivot is rounding."""
    steps = insisting("parallelogram", "nullspace")
    scene = engine(steps)
    rows = run(scene, "rk4", start(steps), step, round(10 / step), 10)
    if step == STEPS[-1]:
        assert failed(rows) or drift(scene, rows) > 1e-3  # that is why it is refused
        assert rows.stopped & STOPPED or RESIDUAL in rows.tally  # and said
        return
    assert rows.states[-1, 0] == pytest.approx(exact_parallelogram()[0], abs=1e-4)
    assert drift(scene, rows) < 1e-6
    assert rows.tally[UNPROJECTED][0] > 0


UNEQUAL = {
    "longer rocker": ("1", "1", "1.000001", "1"),
    "shorter rocker": ("1", "1", "0.999999", "1"),
    "longer coupler": ("1", "1.000001", "1", "1"),
    "longer ground": ("1", "1", "1", "1.000001"),
}


@pytest.mark.parametrize(
    "formulation", ["multiplier", pytest.param("nullspace", marks=pytest.mark.slow)]
)
@pytest.mark.parametrize(
    "which", [pytest.param(n, marks=pytest.mark.slow if "rocker" not in n else ()) for n in UNEQUAL]
)
def test_row_12_links_unequal_by_1e_6_never_fail_in_silence(which, formulation):
    """A bar off by 1e-6 closes the passage: the others meet it as they would meet a stop."""
    steps = stepped(FOUR_BAR.format(*UNEQUAL[which], TURNING), formulation)
    scene = engine(steps)
    for step in STEPS[:4]:
        rows = run(scene, "rk4", start(steps), step, round(10 / step), 10)
        assert rows.stopped & STOPPED or rows.tally.get(UNPROJECTED, (0, 0))[0] > 0
        assert failed(rows) or drift(scene, rows) > 1e-3 or RESIDUAL in rows.tally


def redundant(seed):
    """M, J whose last row follows from the others but for rounding, and a load."""
    random = np.random.default_rng(seed)
    half, rows = random.normal(size=(6, 6)), random.normal(size=(2, 6))
    return half @ half.T + np.eye(6), np.vstack([rows, 0.3 * rows[0] + 0.7 * rows[1]]), half[0]


def regularised(mass, j, load):
    """S + 100 eps trace/m on the diagonal, and one refinement."""
    inverse, m = np.linalg.inv(mass), len(j)
    s, right = j @ inverse @ j.T, -j @ inverse @ load
    shifted = s + 100 * np.finfo(float).eps * np.trace(s) / m * np.eye(m)
    shares = np.linalg.solve(shifted, right)
    shares += np.linalg.solve(shifted, right - s @ shares)
    return inverse @ (load + j.T @ shares)


def test_row_13_lu_takes_a_redundant_row_without_a_word():
    """Rows that disagree by 1e-9, as rounding of a long run makes them: forces of 1e5 and more."""
    largest = 0.0
    for seed in range(20):
        mass, j, load = redundant(seed)
        kkt = np.block([[mass, j.T], [j, np.zeros((3, 3))]])
        found = np.linalg.solve(kkt, np.array([*load, 0, 0, 1e-9]))
        largest = max(largest, np.abs(found[6:]).max())
        exact = _accelerations(mass, j[:-1], load)
        np.testing.assert_allclose(regularised(mass, j, load), exact, atol=1e-10)
    assert largest > 1e5


def _accelerations(mass, j, load):
    inverse = np.linalg.inv(mass)
    s = j @ inverse @ j.T
    return inverse @ (load - j.T @ np.linalg.solve(s, j @ inverse @ load))


@pytest.mark.parametrize(
    "formulation",
    ["multiplier", *(pytest.param(n, marks=pytest.mark.slow) for n in ("nullspace", "minimal"))],
)
def test_row_13_the_tool_drops_what_follows_from_other_rows(formulation):
    twice = CRANK_ROCKER.replace("constraints:\n", "constraints:\n  again: {holonomic: Cr = C}\n")
    ours, plain = stepped(twice, formulation), stepped(CRANK_ROCKER, formulation)
    assert len(studied(twice).links.scene.machine.kept) == 2
    assert len(studied(twice).links.scene.machine.rows) == 4
    state = start(plain)
    found = [engine(s).function("accelerations")(0.0, state) for s in (ours, plain)]
    np.testing.assert_allclose(found[0], found[1], rtol=1e-12)
    ends = [run(engine(s), "rk4", start(s), 1e-3, 5000).states[-1] for s in (ours, plain)]
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-9)


MASSLESS = """\
eom: 1
system: Link without inertia
space: plane
gravity: [0, -g]
parameters: {m: 1 kg, l: 1 m, g: 9.81 m/s^2}
coordinates: {a: rad, b: rad}
points: {A: "l*[sin(a), -cos(a)]", B: "l*[sin(b), -cos(b)]"}
bodies:
  bob: {mass: m, at: A}
"""


def test_row_14_a_motion_without_inertia_is_named():
    with pytest.raises(UsageError, match=r"E-MASS: .* the motion .*b"):
        study.of_text(MASSLESS, "massless.yaml")


def test_row_14_a_pivot_of_zero_stops_the_step():
    steps = stepped(CRANK_ROCKER, "multiplier")
    scene = engine(steps, m=0.0)
    rows = run(scene, "rk4", start(steps), 1e-3, 10)
    assert rows.stopped & SINGULAR


def test_row_14_inertia_that_constraints_forbid_to_move_is_no_obstacle():
    """M is singular and M + w J'J is not: the multiplier form and the null space agree."""
    ends = {}
    for formulation in ("multiplier", "nullspace"):
        steps = stepped("massless_coupler", formulation)
        scene = engine(steps)
        rows = run(scene, "rk4", start(steps), 1e-3, 2000, 10)
        assert not failed(rows)
        assert drift(scene, rows) < 1e-8
        ends[formulation] = rows.states[-1, : len(steps.program.coordinates)]
    np.testing.assert_allclose(ends["multiplier"], ends["nullspace"], atol=1e-8)


def dead_point(steps):
    """Where the crank of equal arms ends after 2 s, by RK4 at two steps."""
    scene, ends = engine(steps), []
    for step in (1e-3, 5e-4):
        rows = run(scene, "rk4", start(steps), step, round(2 / step), 10)
        assert not failed(rows)
        assert drift(scene, rows) < 1e-6
        assert rows.tally[UNPROJECTED][0] > 0
        ends.append(rows.states[-1])
        assert abs(ends[-1][0]) > np.pi / 2  # it went through
    assert ends[0][0] == pytest.approx(ends[1][0], abs=2e-6)
    return ends[-1][:3]


def test_row_15_the_dead_point_is_passed_with_multipliers_and_would_be_with_nullspace():
    multiplier = dead_point(stepped("slider_crank_equal", "multiplier"))
    nullspace = dead_point(insisting("slider_crank_equal", "nullspace"))
    np.testing.assert_allclose(nullspace, multiplier, atol=1e-7)


def test_row_15_no_choice_of_pivots_helps_at_that_dead_point():
    """With r = l the rank itself falls: every pair of dependent rates is singular there."""
    scene = engine(stepped("slider_crank_equal", "multiplier"))
    there = np.array([np.pi / 2, np.pi / 2, 0.0, 0.0, 0.0, 0.0])
    assert np.abs(scene.function("constraint_residuals")(0.0, there)).max() < 1e-15
    j = scene.function("constraint_jacobian")(0.0, there)
    assert max(abs(np.linalg.det(j[:, pair])) for pair in ([0, 1], [0, 2], [1, 2])) < 1e-15


ROCKER_FREE = (
    CRANK_ROCKER.replace("q1: {unit: rad, role: free}", "q1: {unit: rad, role: linked}")
    .replace("q3: {unit: rad, role: linked}", "q3: {unit: rad, role: free}")
)  # fmt: skip


def test_row_15_at_a_dead_point_of_full_rank_other_pivots_help():
    """The rocker cannot stay independent: it is said, and with the crank instead it works."""
    with pytest.raises(UsageError, match=r"W-PIVOT: q1, q2 .* `role: free`.* multiplier"):
        derived(ROCKER_FREE, "nullspace")
    ends = [
        run(engine(s), "rk4", start(s), 1e-3, 10_000).states[-1, :3]
        for s in (stepped(CRANK_ROCKER, "nullspace"), stepped(ROCKER_FREE, "multiplier"))
    ]
    assert abs(ends[0][0] - 0.5) > 1  # past the extreme positions of the rocker
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-7)


@pytest.mark.slow
def test_row_19_float_has_a_best_step_and_compensation_takes_it_away():
    errors = best_in_float("minimal", compensated=False)
    best = min(errors, key=errors.get)
    assert max(error for step, error in errors.items() if step < best) > 3 * errors[best]
    kept = best_in_float("minimal", compensated=True)
    assert kept[1e-5] < 1e-6  # the angle itself is known to 5e-7
    # a projection rounds its result: compensation cannot take that away
    assert best_in_float("nullspace", compensated=True)[1e-5] > 10 * kept[1e-5]


def test_row_22_a_penalty_that_does_not_follow_the_step_is_lost():
    steps = bare()
    scene, h = engine(steps), 2e-4
    with pytest.raises(Lost):
        Penalty(scene, 1e7).run(start(steps), h, 5000)
    end = Penalty(scene, 1e4 * 4 / h**2).run(start(steps), h, 500)
    exact = run(scene, "rk4", start(steps), 1e-4, 1000).states[-1]
    np.testing.assert_allclose(end, exact, atol=1e-5)


def test_row_23_a_start_off_the_constraints_is_refused_or_moved_with_words(call, tmp_path):
    state = tmp_path / "state.json"
    state.write_text(
        '{"t": 0, "coordinates": {"q1": 1.0, "q2": 0.36, "q3": 1.4}, '
        '"rates": {"q1": 0, "q2": 0, "q3": 0}, "inputs": {"tau": 0}}'
    )
    said = call("evaluate", SHIPPED["four_bar"], "--state", state)
    assert said.code != 0
    assert "--project" in said.errors
    said = call("simulate", SHIPPED["four_bar"], "--state", state, "--t-end", "0.1", "-o", "-",
                "--method", "rk4", "--step", "1e-3")  # fmt: skip
    assert said.code == 0
    assert "moved" in said.errors
