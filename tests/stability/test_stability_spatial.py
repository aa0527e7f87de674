"""Every method on a spatial arm with skew axes and full inertia, without damper and motors."""

import numpy as np
import pytest
from laboratory import METHODS, drift, engine, failed, run, start, stepped
from scipy.integrate import solve_ivp

from eomgen import compile_steps, stepping
from eomgen.stability.theory import Linear, largest_step

# energy error over 100 s at h = 0.01, 0.005, 0.001, against the largest kinetic energy
DRIFTS = {
    "semi-euler": (0.53, 0.077, 0.039),
    "semi-euler-damped": (0.53, 0.077, 0.039),  # of an undamped arm: the same method
    "verlet": (0.52, 0.051, 0.034),
    "rk4": (1.6e-4, 5.0e-6, 1.6e-9),
    "dopri5": (6.1e-6, 1.9e-7, 6.1e-11),
    "rosenbrock2": (3.9e-3, 5.1e-4, 5.7e-6),
    "midpoint": (8.5e-5, 2.1e-5, 8.6e-7),
}


def arm(**parameters):
    return engine(stepped("skew_arm"), **({"b": 0.0} | parameters))


@pytest.mark.parametrize("method", DRIFTS)
def test_energy_drift_is_as_measured(method):
    scene = arm()
    for step, wanted in zip((1e-2, 5e-3, 1e-3), DRIFTS[method], strict=True):
        rows = run(scene, method, start(stepped("skew_arm")), step, round(100 / step), 10)
        assert not failed(rows)
        assert drift(scene, rows) == pytest.approx(wanted, rel=0.3)


def test_midpoint_keeps_a_band():
    scene = arm()
    rows = run(scene, "midpoint", start(stepped("skew_arm")), 2e-3, 100_000, 10)
    found = scene.sweep("energy_flow", rows.times, rows.states)[:, 0]
    errors = np.abs(found - found[0])
    assert errors[-1000:].max() < 1.1 * errors[:1000].max()


@pytest.mark.parametrize("method", DRIFTS)
def test_the_order_is_that_of_the_table(method):
    """With damper and a motor: position-form Verlet has order 1 where forces depend on rates."""
    steps = stepped("skew_arm")
    scene = engine(steps, inputs=(0.5, -0.25))
    slope = scene.function("state_derivative")
    exact = solve_ivp(slope, (0, 1), start(steps), "DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    counts = (50, 100, 200) if METHODS[method].order > 3 else (200, 400, 800)
    errors = [
        np.abs(run(scene, method, start(steps), 1 / n, n).states[-1] - exact).max() for n in counts
    ]
    order = np.log2(errors[0] / errors[-1]) / 2
    assert order == pytest.approx(1 if method == "verlet" else METHODS[method].order, abs=0.3)


@pytest.mark.parametrize("method", ["semi-euler", "semi-euler-damped", "rk4", "dopri5"])
def test_at_rest_the_largest_step_is_where_the_run_says(method):
    """Hanging still, with the damper: 2 % above the limit of the eigenvalues it leaves."""
    steps = stepped("skew_arm")
    scene = engine(steps, b=1.0)
    rest = hanging(scene)
    matrix = scene.function("state_jacobian")(0.0, rest)
    brake = scene.function("damping_jacobian")(0.0, rest)
    limit = largest_step(METHODS[method], Linear(matrix, 2, brake))
    assert 0 < limit < 10
    near = rest + np.array([1e-6, -1e-6, 0, 0])
    low, high = (run(scene, method, near, share * limit, 5000) for share in (0.98, 1.02))
    assert np.abs(low.states[-1] - rest).max() < 1e-5
    assert failed(high) or np.abs(high.states[-1] - rest).max() > 1e-2


def hanging(scene):
    """The stable equilibrium, by letting the arm come to rest with more friction."""
    slope = scene.function("state_derivative")
    state = start(stepped("skew_arm"))
    for _ in range(60):
        step = np.linalg.solve(scene.function("state_jacobian")(0.0, state), -slope(0.0, state))
        state = state + np.clip(step, -0.3, 0.3)
        state[2:] = 0
    assert np.abs(slope(0.0, state)).max() < 1e-10
    values = np.linalg.eigvals(scene.function("state_jacobian")(0.0, state))
    assert values.real.max() < 0
    return state


def test_verlet_is_refused_and_the_damped_step_offered():
    from laboratory import derived

    scene = stepping.scene_of(derived("skew_arm"))
    assert "E-SYM" in compile_steps.refusal(scene, METHODS["verlet"])
    assert compile_steps.offers(scene, METHODS["semi-euler-damped"])
