"""The step functions in C: they are the method, they have its order, they keep what it keeps."""

import ctypes

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from stepped import SCENES, engine_c, engine_python, methods_of, run, start, steps_of
from tools import tool

from eomgen import stepping, study
from eomgen.errors import UsageError
from eomgen.integrators.methods import METHODS
from eomgen.numerics import integrate, steps_python
from eomgen.numerics.engine_c import EngineC
from eomgen.numerics.engine_python import EnginePython
from eomgen.numerics.records import NOT_FINITE, RESIDUAL, SINGULAR, STOPPED, Arguments, Grid
from eomgen.wanted import Wanted

QUICK = ("skew_arm", "four_bar")
SCENE = [pytest.param(n, marks=() if n in QUICK else pytest.mark.slow) for n in SCENES]
# which methods a scene has is known here without deriving it; a test below holds it to that
PLAIN = tuple(m for m in METHODS if m not in ("verlet", "semi-euler-damped"))
OFFERED = dict.fromkeys(SCENES, PLAIN)
OFFERED["sprung_pair"] = tuple(m for m in METHODS if m != "semi-euler-damped")
OFFERED["skew_arm"] = tuple(m for m in METHODS if m != "verlet")
EVERY = [
    pytest.param(name, method, marks=() if name in QUICK else pytest.mark.slow)
    for name in SCENES
    for method in OFFERED[name]
]


def exact(name, span):
    """The state at the end by DOP853 at a tight tolerance, off no constraint by more than that."""
    engine = engine_c(name)
    slope = engine.function("state_derivative")
    found = solve_ivp(
        slope, (0, span), start(engine.steps), "DOP853", rtol=1e-13, atol=1e-13, max_step=0.01
    )
    return found.y[:, -1]


@pytest.mark.slow
def test_every_scene_has_what_it_can_have():
    assert {name: tuple(methods_of(name)) for name in SCENES} == OFFERED
    assert steps_of("double_pendulum").is_canonical
    assert not steps_of("four_bar").is_canonical
    assert steps_of("satellite").has("rates")


@pytest.mark.parametrize(("name", "method"), EVERY)
def test_c_is_the_method_as_numpy_has_it(name, method):
    ours = run(engine_c(name), method, 0.2, 20, "energy_flow", every=5)
    theirs = run(engine_python(name), method, 0.2, 20, "energy_flow", every=5)
    np.testing.assert_allclose(ours.states, theirs.states, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(ours.works, theirs.works, rtol=1e-12, atol=1e-13)
    assert ours.times.tolist() == theirs.times.tolist()
    assert (ours.tally, ours.stopped, ours.steps) == (theirs.tally, 0, 20)


@pytest.mark.parametrize(("name", "method"), EVERY)
def test_halving_the_step_shows_the_order(name, method):
    wanted = exact(name, 0.5)
    size = np.abs(wanted).max()
    errors = [
        np.abs(run(engine_c(name), method, 0.5, n).states[-1] - wanted).max() / size
        for n in (40, 80, 160, 320, 640)
    ]
    # finer than this it is the rounding that is seen, and the reference
    resolved = [e for e in errors if e > 5e-11]
    if len(resolved) < 2:
        assert (name, METHODS[method].order > 3) == ("satellite", True)
        assert errors[-1] < 1e-13
        return
    slope = -np.polyfit(range(len(resolved)), np.log2(resolved), 1)[0]
    # projections cancel part of the error of a linked scene: the slope may be above the order
    assert METHODS[method].order - 0.4 < slope < METHODS[method].order + 0.8
    assert errors[-1] < 1e-2


@pytest.mark.parametrize("name", SCENE)
def test_rk4_with_small_steps_is_dop853(name):
    found = run(engine_c(name), "rk4", 0.5, 4000).states[-1]
    np.testing.assert_allclose(found, exact(name, 0.5), rtol=1e-9, atol=1e-10)


def energy_errors(name, method, step, span):
    engine = engine_c(name)
    count = round(span / step)
    found = run(engine, method, span, count, every=max(1, count // 400))
    energy = engine.sweep("energy_flow", found.times, found.states)[:, 0]
    return np.abs(energy - energy[0])


@pytest.mark.slow
def test_canonical_midpoint_keeps_the_energy_bounded_where_semi_euler_drifts():
    """NUMERICS: M(q) makes semi-implicit Euler drift; midpoint in (q, p) stays in a band."""
    drift = energy_errors("double_pendulum", "semi-euler", 0.005, 60.0)
    band = energy_errors("double_pendulum", "midpoint", 0.005, 60.0)
    assert band[-100:].max() < 1.5 * band[:100].max() < 0.01
    assert drift[-100:].max() > 5 * band.max()


@pytest.mark.slow
def test_verlet_keeps_the_energy_in_a_band_of_order_2():
    coarse = energy_errors("sprung_pair", "verlet", 0.01, 100.0)
    fine = energy_errors("sprung_pair", "verlet", 0.005, 100.0)
    assert coarse[-100:].max() < 1.5 * coarse[:100].max()
    assert coarse.max() / fine.max() == pytest.approx(4, rel=0.25)


def test_the_work_of_dampers_and_inputs_balances_the_energy():
    engine = engine_c("skew_arm")
    errors = []
    for count in (500, 1000):
        found = run(engine, "rk4", 2.0, count, "energy_flow", every=50)
        energy = engine.sweep("energy_flow", found.times, found.states)[:, 0]
        assert abs(found.works[-1]) > 0.5
        errors.append(np.abs(energy - energy[0] - found.works).max())
    assert errors[1] < 1e-7
    assert errors[0] / errors[1] > 8


@pytest.mark.parametrize(
    "formulation", ["multiplier", pytest.param("nullspace", marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("method", ["semi-euler", "rk4", "dopri5", "rosenbrock2", "midpoint"])
def test_projection_keeps_the_constraints_at_round_off(method, formulation):
    engine = engine_c("four_bar", formulation)
    found = run(engine, method, 5.0, 5000, every=50)
    assert found.stopped == 0
    for name, limit in (("constraint_residuals", 1e-9), ("constraint_rates", 1e-12)):
        worst = np.abs(engine.sweep(name, found.times, found.states)).max()
        assert worst < (limit if METHODS[method].order == 1 else 3e-14)


@pytest.mark.slow
def test_without_the_projection_the_constraints_drift():
    """The same steps over a program without projection functions: what the test above would see."""
    from dataclasses import replace

    steps = steps_of("four_bar")
    names = ("project_positions", "project_rates", "constraint_margin")
    functions = tuple(f for f in steps.program.functions if f.name not in names)
    bare = replace(steps, program=replace(steps.program, functions=functions))
    inputs, parameters = (0.1,), engine_c("four_bar").parameters[:-1].tolist()
    engine = EngineC(bare, Arguments(inputs, tuple(parameters)))
    found = run(engine, "rk4", 5.0, 5000)
    assert np.abs(engine.sweep("constraint_residuals", found.times, found.states)).max() > 1e-10


def test_the_same_run_gives_the_same_bits():
    runs = [run(engine_c("four_bar"), "midpoint", 1.0, 200, every=10) for _ in range(2)]
    assert runs[0].states.tobytes() == runs[1].states.tobytes()
    whole = run(engine_c("skew_arm"), "rk4", 1.0, 200, every=1)
    grid = Grid(0.0, 1.0 / 200, 200, 1)
    march = engine_c("skew_arm").march(METHODS["rk4"], None, start(steps_of("skew_arm")))
    parts = [march.advance(grid, first, 50) for first in range(0, 200, 50)]
    assert integrate.joined(parts).states.tobytes() == whole.states[1:].tobytes()


@pytest.mark.parametrize(
    ("name", "made", "more"),
    [
        ("skew_arm", engine_c, {}),
        ("skew_arm", engine_python, {}),
        ("double_pendulum", engine_c, {"real": "float", "compensated": True}),
    ],
)
def test_what_is_repeated_ends_where_it_ends_once(name, made, more):
    engine, grid = made(name, **more), Grid(0.0, 0.01, 20, 20)
    method, first = METHODS["rk4"], start(engine.steps)
    ends = [engine.repeat(method, first, grid, times) for times in (1, 3)]
    assert ends[0].tobytes() == ends[1].tobytes()
    once = integrate.run(engine, method, first, grid).states[-1]
    assert ends[0].tobytes() == once.tobytes()
    assert not np.array_equal(once, first)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["skew_arm", "four_bar"])
def test_float_follows_double(name):
    double = run(engine_c(name), "rk4", 0.5, 500).states[-1]
    single = run(engine_c(name, real="float"), "rk4", 0.5, 500).states[-1]
    np.testing.assert_allclose(single, double, rtol=2e-3, atol=2e-4)


@pytest.mark.slow
def test_a_compensated_sum_keeps_what_float_loses():
    wanted = run(engine_c("double_pendulum"), "rk4", 2.0, 2000).states[-1]
    errors = [
        np.abs(run(engine_c("double_pendulum", real="float", compensated=kind), "rk4", 2.0, 200_000)
               .states[-1] - wanted).max()
        for kind in (False, True)
    ]  # fmt: skip
    assert errors[1] < 5e-6
    assert errors[0] > 10 * errors[1]


def called(engine, method, state, h=0.01, t=0.0):
    """The bits of one step and the state after it."""
    step = engine.symbol(f"step_{method}")
    step.restype = ctypes.c_uint
    step.argtypes = [engine.kind, engine.kind, *[ctypes.c_void_p] * 3]
    state = np.array(state, engine.kind)
    places = (state.ctypes.data, engine.inputs.ctypes.data, engine.parameters.ctypes.data)
    return step(t, h, *places), state


@pytest.mark.slow
@pytest.mark.parametrize("method", ["semi_euler", "rk4", "rosenbrock2", "midpoint"])
def test_a_step_that_cannot_be_made_leaves_the_state(method):
    steps = steps_of("skew_arm")
    parameters = dict(zip((p.name for p in steps.program.parameters), given(), strict=True))
    massless = [0.0 if n[0] in "mAB" else v for n, v in parameters.items()]
    engine = EngineC(steps, Arguments((0.0, 0.0), tuple(massless)))
    before = start(steps)
    bits, after = called(engine, method, before)
    assert bits & STOPPED == SINGULAR
    assert after.tolist() == before.tolist()
    huge = np.array([0.1, 0.2, 1e200, 1e200])
    bits, after = called(engine_c("skew_arm"), method, huge)
    assert bits & NOT_FINITE or bits & STOPPED
    assert after.tolist() == huge.tolist()


def given():
    return [float(p.value) for p in steps_of("skew_arm").program.parameters]


def test_a_residual_after_the_projection_is_told():
    bits, _ = called(engine_c("four_bar"), "semi_euler", start(steps_of("four_bar")), h=0.2)
    assert bits & RESIDUAL
    bits, _ = called(engine_c("four_bar"), "rk4", start(steps_of("four_bar")), h=1e-3)
    assert bits == 0


@pytest.mark.slow
def test_rosenbrock_is_stable_where_explicit_methods_are_not():
    """Row 3 of the stability matrix: lambda h = 1e6 on a damped, stiff leg."""
    engine = engine_c("quarter_car")
    stiff = Arguments((), tuple(1e7 if p.name == "c_s" else float(p.value)
                                for p in engine.steps.program.parameters))  # fmt: skip
    made = EngineC(engine.steps, stiff)
    slow = run(made, "rosenbrock2", 1.0, 100)
    assert slow.stopped == 0
    assert np.abs(slow.states[-1]).max() < 1
    wild = run(made, "rk4", 1.0, 100)
    assert wild.stopped & NOT_FINITE or np.abs(wild.states[-1]).max() > 1e6


@pytest.mark.slow
def test_time_is_counted_and_not_summed():
    """5e5 steps of 1e-3 in float: t += h would be off by a percent; a prescribed road sees it."""
    engine = engine_c("quarter_car", real="float")
    march = engine.march(METHODS["rk4"], None, start(engine.steps))
    rows = march.advance(Grid(0.0, 1e-3, 2_000_000, 1), 1_000_000, 1)
    double = engine_c("quarter_car").march(METHODS["rk4"], None, start(engine.steps))
    other = double.advance(Grid(0.0, 1e-3, 2_000_000, 1), 1_000_000, 1)
    assert rows.times.tolist() == [1000.001]
    np.testing.assert_allclose(rows.states, other.states, rtol=1e-3, atol=1e-5)


DAMPED_FOUR_BAR = """\
eom: 1
system: Four-bar linkage with a stiff damper
space: plane
gravity: [0, -g]
parameters:
  {a: 0.4 m, b: 1 m, c: 0.9 m, e: 1 m, m: 1 kg, g: 9.81 m/s^2, d: 2 N*m*s}
coordinates:
  q1: {unit: rad, role: free}
  q2: {unit: rad, role: linked}
  q3: {unit: rad, role: linked}
points:
  A: [0, 0]
  D: [e, 0]
  B: A + a*[cos(q1), sin(q1)]
  C: B + b*[cos(q2), sin(q2)]
  Cr: D + c*[cos(q3), sin(q3)]
bodies:
  crank: {rod: [A, B], mass: m}
  coupler: {rod: [B, C], mass: m}
  rocker: {rod: [D, Cr], mass: m}
dampers:
  - {along: q2 - q1, damping: d}
  - {along: q3, damping: d}
constraints:
  loop: {holonomic: C = Cr, reaction: pin}
initial: {q1: 0.5 rad, q1': 0 rad/s, guess: {q2: 40 deg, q3: 80 deg, q2': 0 rad/s, q3': 0 rad/s}}
"""


def damped_steps(formulation):
    found = study.of_text(DAMPED_FOUR_BAR, "scene.yaml", Wanted(formulation))
    return stepping.of(found, ("semi-euler", "semi-euler-damped"))


def damped(formulation):
    """The steps, the engine of C, its arguments, and the start, which is at rest."""
    tool("cc")
    steps = damped_steps(formulation)
    given = Arguments((), tuple(float(p.value) for p in steps.program.parameters))
    state = start(steps)
    state[len(steps.program.coordinates) :] = 0
    return steps, EngineC(steps, given), given, state


def damped_change(engine, state, h):
    """(M + h D) du - J' l = h (Q - bias), J du = 0 (gamma is zero at rest), D by differences."""
    u = len(engine.steps.program.speeds)
    names = ("mass_matrix", "bias", "generalized_forces")
    mass, bias, force = (engine.function(name)(0.0, state) for name in names)
    moved = [state + np.eye(len(state))[i - u] for i in range(u)]
    d = -np.array([engine.function("generalized_forces")(0.0, y) - force for y in moved]).T
    left, right = mass + h * d, h * (force - bias)
    if engine.steps.has("multipliers"):
        j = engine.function("constraint_jacobian")(0.0, state)
        left = np.block([[left, -j.T], [j, np.zeros((len(j),) * 2)]])
        right = np.concatenate([right, np.zeros(len(j))])
    return np.linalg.solve(left, right)[:u]


FORMULATIONS = ("multiplier", "nullspace", "minimal")


@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_the_implicit_damping_is_that_of_the_equations(formulation):
    steps, engine, _, state = damped(formulation)
    h, n, u = 0.02, len(steps.program.coordinates), len(steps.program.speeds)
    change = damped_change(engine, state, h)
    free = h * engine.function("accelerations")(0.0, state)
    assert np.abs(change - free).max() > 0.1 * np.abs(change).max()  # it matters
    bits, after = called(engine, "semi_euler_damped", state, h)
    assert bits & STOPPED == 0
    rates = engine.function("state_derivative")(0.0, [*state[:n], *change])[:n]
    wanted = state + np.concatenate([h * rates, change])
    wanted, _ = steps_python.admissible(steps, engine.function, h, wanted)
    np.testing.assert_allclose(after, wanted, atol=1e-12)
    assert u == len(change)


@pytest.mark.parametrize("formulation", FORMULATIONS)
def test_the_damped_step_of_c_is_that_of_numpy(formulation):
    steps, engine, given, state = damped(formulation)
    both = [
        integrate.run(e, METHODS["semi-euler-damped"], state, Grid(0.0, 0.02, 20)).states
        for e in (engine, EnginePython(steps, given))
    ]
    np.testing.assert_allclose(both[0], both[1], rtol=1e-11, atol=1e-12)


def damped_chain(count):
    """Masses in a row, each damped to the one before."""
    names = [f"x_{i}" for i in range(1, count + 1)]
    gaps = [names[0], *(f"{b} - {a}" for a, b in zip(names, names[1:], strict=False))]
    return "\n".join([
        "eom: 1", "system: Damped chain", "space: line", "gravity: 0",
        "parameters: {m: 1 kg, k: 30 N/m, d: 50 N*s/m}",
        "coordinates: {" + ", ".join(f"{n}: m" for n in names) + "}",
        "bodies:", *(f'  b{i}: {{mass: m, at: "[{n}]"}}' for i, n in enumerate(names)),
        "springs:", *(f"  - {{along: {g}, stiffness: k}}" for g in gaps),
        "dampers:", *(f"  - {{along: {g}, damping: d}}" for g in gaps),
        "initial: {" + ", ".join(f"{n}: 0.1 m, {n}': 0 m/s" for n in names) + "}",
    ])  # fmt: skip


def test_a_long_chain_is_damped_by_a_loop():
    """Beyond the size up to which M is factored unrolled."""
    tool("cc")
    steps = stepping.of(study.of_text(damped_chain(14), "chain.yaml"), ("semi-euler-damped",))
    given = Arguments((), tuple(float(p.value) for p in steps.program.parameters))
    engine, state = EngineC(steps, given), start(steps)
    change = damped_change(engine, state, 0.02)
    _, after = called(engine, "semi_euler_damped", state, 0.02)
    np.testing.assert_allclose(after[14:], change, rtol=1e-10)
    assert np.abs(change).max() > 0.01


def test_damping_is_no_obstacle_to_the_step_where_it_is_implicit():
    """A rate of 8000/s in the dampers of a linkage: at h = 0.01 the explicit step is lost."""
    tool("cc")
    steps = damped_steps("nullspace")
    values = {p.name: float(p.value) for p in steps.program.parameters} | {"d": 2000.0}
    engine = EngineC(steps, Arguments((), tuple(values.values())))
    ends = {
        name: integrate.run(engine, METHODS[name], start(steps), Grid(0.0, 0.01, 500))
        for name in ("semi-euler", "semi-euler-damped")
    }
    assert ends["semi-euler"].stopped or np.abs(ends["semi-euler"].states[-1]).max() > 1e3
    assert not ends["semi-euler-damped"].stopped
    assert np.abs(ends["semi-euler-damped"].states[-1][3:]).max() < 1


def test_forces_that_drive_are_not_called_damping():
    text = DAMPED_FOUR_BAR.replace("d: 2 N*m*s", "d: -2 N*m*s")
    with pytest.raises(UsageError, match=r"E-DAMP: .*\(they drive some motion instead"):
        stepping.of(study.of_text(text, "scene.yaml"), ("semi-euler-damped",))
