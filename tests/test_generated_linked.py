"""The Python of linked scenes in motion: on its constraints, true to its energy."""

from functools import cache

import numpy as np
import pytest
from reference import LINKED_CASES, stem, wanted
from scenes import LINKED, model_of, study_of
from scipy.integrate import solve_ivp

pytestmark = pytest.mark.slow

# [s], else 0.5: the squeezer is fast, the others come near a singular position later
SHORT = {"andrews_squeezer": 0.005, "parallelogram": 0.1, "slider_crank_equal": 0.1}
RESIDUALS = ("constraint_residuals", "constraint_rates")
BILATERAL = [  # a rough guide has a motion in each mode only
    n
    for n in LINKED
    if any(c.kind != "unilateral" for c in model_of(n).constraints) and not model_of(n).guides
]
WITH_MULTIPLIERS = [  # in their usual formulation, or on request; the list is tested
    "andrews_squeezer", "ball_on_turntable", "bead_on_fixed_hoop", "bead_on_turning_hoop",
    "block_on_incline", "chaplygin_sleigh", "dumbbell", "four_bar", "mass_on_sphere",
    "massless_coupler", "parallelogram", "rolling_disc_tilting", "rolling_disc_upright",
    "sleigh_speeds", "slider_crank", "slider_crank_equal", "snakeboard", "bricard-multiplier",
]  # fmt: skip
REDUCED = [case for case in LINKED_CASES if wanted(case) in ("minimal", "nullspace")]
MOVED_BY_CONSTRAINTS = {"ball_on_turntable", "bead_on_turning_hoop"}
DRIVES = {"andrews_squeezer": ("mom", "beta")}  # a constant moment and the angle that it turns


def test_the_list_of_scenes_with_multipliers_is_complete():
    found = [
        case
        for case in LINKED_CASES
        if stem(case) in BILATERAL
        and "multiplier" in (wanted(case), study_of(stem(case)).links.chosen.name)
        and wanted(case) in ("auto", "multiplier")
    ]
    assert found == WITH_MULTIPLIERS


def power(case, found, t, state, inputs):
    """Lambda J q': what the constraints do on the motion."""
    machine = study_of(stem(case)).machine
    kept = [i for i, row in enumerate(machine.rows) if row.name in machine.kept]
    rates = state[len(found.COORDINATES) :]
    slopes = found.constraint_jacobian(t, state, inputs)[kept]
    return found.multipliers(t, state, inputs) @ (slopes @ rates)


@cache
def motion(case, found):
    """The motion from the initial state without inputs, and the work of the constraints on it."""
    inputs = np.zeros(len(found.INPUTS))

    def derivative(t, y):
        state = y[:-1]
        return [*found.state_derivative(t, state, inputs), power(case, found, t, state, inputs)]

    path = solve_ivp(
        derivative,
        (0.0, SHORT.get(stem(case), 0.5)),
        [*found.INITIAL_STATE, 0.0],
        method="DOP853",
        rtol=1e-10,
        atol=1e-12,
    )
    assert path.success
    assert np.ptp(path.y[:-1], axis=1).max() > 1e-4  # it does move
    return path.t, path.y[:-1], path.y[-1], inputs


def largest_residual(found, t, state, inputs):
    return max(np.abs(getattr(found, name)(t, state, inputs)).max(initial=0) for name in RESIDUALS)


@pytest.mark.parametrize("case", WITH_MULTIPLIERS)
def test_the_initial_state_is_on_the_constraints(case, module):
    found = module(case)
    inputs = np.zeros(len(found.INPUTS))
    assert largest_residual(found, 0.0, found.INITIAL_STATE, inputs) < 1e-13


@pytest.mark.parametrize("case", WITH_MULTIPLIERS)
def test_the_motion_stays_on_the_constraints_and_projection_brings_it_back(case, module):
    found = module(case)
    times, states, _, inputs = motion(case, found)
    for t, state in zip(times, states.T, strict=True):
        assert largest_residual(found, t, state, inputs) < 1e-7
    n, t, end = len(found.COORDINATES), times[-1], states[:, -1]
    away = end + 1e-4 * np.cos(np.arange(2 * n))  # off the constraints
    assert largest_residual(found, t, away, inputs) > 1e-6
    for _ in range(3):
        away[:n] = found.project_positions(t, away, inputs)
    away[n:] = found.project_rates(t, away, inputs)
    assert largest_residual(found, t, away, inputs) < 1e-12
    # no further than it was moved, and Newton's method rests where it has come to
    assert np.abs(away - end).max() < 1e-2
    np.testing.assert_allclose(found.project_positions(t, away, inputs), away[:n], atol=1e-12)
    np.testing.assert_allclose(found.project_rates(t, away, inputs), away[n:], atol=1e-10)


@pytest.mark.parametrize("case", WITH_MULTIPLIERS)
def test_energy_changes_by_the_work_of_the_constraints_alone(case, module):
    found = module(case)
    times, states, work, inputs = motion(case, found)
    kinetic, potential = found.energy(times, states, inputs)
    size = np.abs([kinetic, potential]).max()
    for moment, angle in (DRIVES[stem(case)],) if stem(case) in DRIVES else ():
        turned = states[found.COORDINATES.index(angle)] - states[found.COORDINATES.index(angle), 0]
        potential = potential - found.DEFAULTS[moment] * turned
    assert np.ptp(kinetic + potential - work) < 1e-8 * size
    if stem(case) in MOVED_BY_CONSTRAINTS:
        assert np.ptp(work) > 1e-4 * size
    else:
        assert np.ptp(kinetic + potential) < 1e-8 * size


@pytest.mark.parametrize("case", REDUCED)
def test_the_reduced_motion_is_the_one_with_multipliers(case, module):
    """Coordinates of both programs after a short time from the same state."""
    found, name = module(case), stem(case)
    full = module(name)
    times, states, _, inputs = motion(name, full)
    names = [*full.COORDINATES, *full.SPEEDS]
    path = solve_ivp(
        found.state_derivative,
        (0.0, times[-1]),
        found.INITIAL_STATE,
        method="DOP853",
        rtol=1e-10,
        atol=1e-12,
        args=(inputs,),
    )
    assert path.success
    wanted_end = [states[names.index(n), -1] for n in (*found.COORDINATES, *found.SPEEDS)]
    np.testing.assert_allclose(path.y[:, -1], wanted_end, rtol=1e-6, atol=1e-7)
    if hasattr(found, "all_coordinates"):
        for function, part in (("all_coordinates", full.COORDINATES), ("all_rates", full.SPEEDS)):
            got = getattr(found, function)(times[-1], path.y[:, -1], inputs)
            places = [states[names.index(n), -1] for n in part]
            np.testing.assert_allclose(got, places, rtol=1e-6, atol=1e-6)
