"""Turns by unit quaternions: the same motion as by angles, and no pole."""

import random

import mpmath
import numpy as np
import pytest
from scenes import derivation_of, machine_of, model_of, program_of
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from eomgen import compile, interpreter
from eomgen.algebra import normal
from eomgen.checks import gimbal
from eomgen.errors import SpecError
from eomgen.mechanics import motions
from eomgen.spec import read

SPECS = ("tumbling_body", "ball_joints")
ANGLES = """eom: 1
system: Two bodies, each turned by three angles about skew axes
space: solid
gravity: [0, 0, -g]
parameters: {m_1: 1.5, m_2: 0.8, g: 9.81, l: 0.4, d: 0.05, A: 0.01, B: 0.014, C: 0.006, D: 0.001}
coordinates: {a: , b: , c: , k: , m: , n: }
bodies:
  upper:
    mass: m_1
    inertia: [A, B, C, D, 0, 0]
    frame: {at: [0, 0, 0], turn: [[z, a], [[1, 2, 2], b], [x, c]]}
    com: [d, 0, -l/2]
  lower:
    mass: m_2
    inertia: [A, A, C, 0, D, 0]
    frame: {on: upper, at: [0, 0, -l], turn: [[y, k], [z, m], [[0, 3, 4], n]]}
    com: [0, d, -l/2]
"""
AXES = {"upper": ([0, 0, 1], [1 / 3, 2 / 3, 2 / 3], [1, 0, 0]),
        "lower": ([0, 1, 0], [0, 0, 1], [0, 0.6, 0.8])}  # fmt: skip


def call(program, name, state, inputs=()):
    given = {
        "time": [0.0],
        "state": list(state),
        "inputs": list(inputs),
        "parameters": [float(p.value) for p in program.parameters],
    }
    return np.array(interpreter.run(program.function(name), given, interpreter.FLOAT), dtype=float)


def turned(axes, angles):
    """The rotation of three body-fixed turns."""
    result = Rotation.identity()
    for axis, angle in zip(axes, angles, strict=True):
        result = result * Rotation.from_rotvec(np.array(axis) * angle)
    return result


def spin(axes, angles, rates):
    """The angular velocity in the axes after three body-fixed turns."""
    result = np.zeros(3)
    for axis, angle, rate in zip(axes, angles, rates, strict=True):
        step = Rotation.from_rotvec(np.array(axis) * angle)
        result = step.inv().apply(result) + np.array(axis) * rate
    return result


def parts(rotation):
    """e_0, e_1, e_2, e_3: SciPy puts the scalar part last."""
    x, y, z, w = rotation.as_quat()
    return [w, x, y, z]


def test_the_energies_and_accelerations_are_those_of_angles():
    chance = random.Random(7)
    by_angles = compile.program(compile.machine_of(read(ANGLES, "angles.yaml")))
    by_quaternions = program_of("ball_joints")
    for _ in range(10):
        angles = [chance.uniform(-1, 1) for _ in range(6)]
        rates = [chance.uniform(-2, 2) for _ in range(6)]

        def converted(q, u):
            halves = [
                (AXES[b], q[i : i + 3], u[i : i + 3]) for b, i in (("upper", 0), ("lower", 3))
            ]
            places = [p for axes, q, _ in halves for p in parts(turned(axes, q))]
            return [*places, *(w for half in halves for w in spin(*half))]

        state = converted(angles, rates)
        np.testing.assert_allclose(
            call(by_quaternions, "energy", state),
            call(by_angles, "energy", [*angles, *rates]),
            rtol=1e-12,
        )
        # u' of the quaternions against the change of the angular velocity along the angles' motion
        found = call(by_quaternions, "accelerations", state)
        moving = call(by_angles, "state_derivative", [*angles, *rates])
        step = 1e-5

        def at(h, start=(*angles, *rates), moving=moving):
            shifted = np.array(start) + h * moving
            return np.array(converted(shifted[:6], shifted[6:])[8:])

        slope = (8 * (at(step) - at(-step)) - (at(2 * step) - at(-2 * step))) / (12 * step)
        np.testing.assert_allclose(found, slope, rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("name", SPECS)
def test_a_turn_has_no_pole(name):
    """M is regular whatever the attitude: its eigenvalues do not depend on the first quaternion."""
    program, chance = program_of(name), random.Random(3)
    model = model_of(name)
    own = motions.plain(model)
    values = []
    for _ in range(20):
        first = parts(Rotation.random(random_state=chance.randrange(1000)))
        rest = [1.0, 0.0, 0.0, 0.0] * (len(model.quaternions) - 1)
        state = [*[0.1] * len(own), *first, *rest, *[0.0] * len(model.speeds)]
        matrix = call(program, "mass_matrix", state, [0.0] * len(model.inputs))
        size = len(model.speeds)
        values.append(np.linalg.eigvalsh(matrix.reshape(size, size)))
    np.testing.assert_allclose(values, [values[0]] * 20, rtol=1e-9)


@pytest.mark.parametrize("name", SPECS)
def test_the_length_of_a_quaternion_is_kept(name):
    """e . e' = 0, identically."""
    derivation = derivation_of(name)
    rates = dict(
        zip((c.symbol for c in derivation.model.coordinates), derivation.rates, strict=True)
    )
    for q in derivation.model.quaternions:
        ring = rates[q.symbols[0]].ring
        terms = (normal.of_atom(ring, s) * rates[s] for s in q.symbols)
        assert not normal.total(ring, terms).terms


def test_projection_normalises():
    program = program_of("tumbling_body")
    state = [1.0, 2.0, 3.0, 0.9, 0.1, -0.2, 0.3, *[0.0] * 6]
    found = call(program, "project_positions", state, [0.0, 0.0])
    np.testing.assert_allclose(found[:3], [1.0, 2.0, 3.0])
    np.testing.assert_allclose(np.linalg.norm(found[3:]), 1.0, rtol=1e-15)
    np.testing.assert_allclose(found[3:] / found[3], np.array(state[3:7]) / 0.9, rtol=1e-15)


def test_angular_momentum_is_kept_in_the_world_and_energy_too():
    """A torque-free tumble through every attitude."""
    program = program_of("tumbling_body")

    def rate(t, state):
        return call(program, "state_derivative", state, [0.0, 0.0])

    start = [0, 0, 1, 1, 0, 0, 0, 1, 0, 4, 0.1, 9, 0.2]
    found = solve_ivp(rate, (0, 3), start, rtol=1e-11, atol=1e-12)
    inertia = np.array([[0.02, 0, 0.003], [0, 0.03, 0], [0.003, 0, 0.044]])
    momenta = [Rotation.from_quat([*s[4:7], s[3]]).apply(inertia @ s[10:]) for s in found.y.T]
    np.testing.assert_allclose(momenta, [momenta[0]] * len(momenta), atol=1e-9)
    energies = [call(program, "energy", s, [0.0, 0.0]).sum() for s in found.y.T]
    assert np.ptp(energies) < 1e-8 * abs(energies[0])
    assert np.ptp(np.linalg.norm(found.y[3:7], axis=0)) < 1e-9
    assert np.abs(found.y[4:7]).max() > 0.9  # it did tumble


def test_initial_values_become_rates():
    model = model_of("ball_joints")
    assert [model.initial[f"e_{i}"] for i in range(4)] == pytest.approx([0.8, 0.6, 0, 0])
    # e' = e (0, w) / 2 with w = (0, 1, 1/2)
    expected = [0, 0, (0.8 - 0.3) / 2, (0.4 + 0.6) / 2]
    assert [float(model.initial[f"e_{i}'"]) for i in range(4)] == pytest.approx(expected)
    speeds = program_of("ball_joints").speeds
    assert [float(s.value) for s in speeds] == pytest.approx([0, 1, 0.5, 0, 0, 2])


BASE = """eom: 1
system: Test
space: solid
gravity: 0
parameters: {m: 1, A: 1}
coordinates: {e: quaternion, x: , y: , z: }
bodies: {b: {mass: m, inertia: [A, A, A], at: [x, y, z], turn: {quaternion: e}}}
"""
WRONG = {
    "no_quaternion": (BASE.replace("{quaternion: e}", "{quaternion: x}"), "7:77 E515"),
    "unknown": (BASE.replace("{quaternion: e}", "{quaternion: f}"), "7:77 E515"),
    "in_a_formula": (BASE.replace("[x, y, z]", "[x, y, e]"), "7:54 E302"),
    "rate_in_a_formula": (BASE + "outputs: {o: e_0'}\n", "8:14 E302"),
    "name_taken": (BASE.replace("A: 1", "A: 1, e_1: 2"), "6:15 E303"),
    "length": (BASE + "initial: {e: [1, 1, 0, 0]}\n", "8:11 E515"),
    "three_parts": (BASE + "initial: {e: [1, 0, 0]}\n", "8:14 E109"),
    "value_of_four": (BASE + "initial: {x: [1, 0, 0, 0]}\n", "8:11 E515"),
    "speeds_for_its_parts": (BASE + "speeds: {u: x', v: y', w: z', k: x' + y'}\n", "8:10 E506"),
    "beside_constraints": (BASE + "constraints: {c: {holonomic: x = 0}}\n", "6:15 E602"),
}


@pytest.mark.parametrize("name", WRONG)
def test_mistakes_have_a_place(name):
    text, fault = WRONG[name]
    with pytest.raises(SpecError) as error:
        read(text, "test.yaml")
    found = [f"{f.location.line}:{f.location.column} {f.code}" for f in error.value.faults]
    assert found == [fault]


def test_declared_speeds_beside_a_quaternion():
    plain = compile.program(compile.machine_of(read(BASE, "plain.yaml")))
    text = BASE + "speeds: {u: x' + y', v: y' - z', w: z'}\n"
    model = read(text, "test.yaml")
    assert [s.name for s in model.speeds] == ["u", "v", "w", "omega_e_x", "omega_e_y", "omega_e_z"]
    program = compile.program(compile.machine_of(model))
    # x', y', z' = 1, 2, 3 are u, v, w = 3, -1, 3
    place = [0.5, 0.5, 0.5, 0.5, 0.1, 0.2, 0.3]
    np.testing.assert_allclose(
        call(program, "energy", [*place, 3, -1, 3, 0.1, 0.2, 0.3]),
        call(plain, "energy", [*place, 1, 2, 3, 0.1, 0.2, 0.3]),
    )


def test_the_rates_are_those_of_the_literature():
    """e(t) = (cos wt/2, a sin wt/2) for a steady turn about a fixed axis a."""
    with mpmath.workdps(30):
        axis, speed, t = (
            [mpmath.mpf(x) / 3 for x in (1, 2, 2)],
            mpmath.mpf(7) / 5,
            mpmath.mpf(1) / 3,
        )
        e = [mpmath.cos(speed * t / 2), *(a * mpmath.sin(speed * t / 2) for a in axis)]
        rates = [
            -mpmath.sin(speed * t / 2) * speed / 2,
            *(a * mpmath.cos(speed * t / 2) * speed / 2 for a in axis),
        ]
    program = program_of("tumbling_body")
    state = [0, 0, 0, *e, 0, 0, 0, *(a * speed for a in axis)]
    found = call(program, "state_derivative", [float(x) for x in state], [0, 0])
    np.testing.assert_allclose(found[3:7], [float(r) for r in rates], rtol=1e-14)


def test_angles_that_meet_a_pole_are_named():
    (line,) = gimbal.warnings(read(ANGLES + "range: {b: [-10 deg, 10 deg]}\n", "a.yaml"))
    assert line.startswith("W-GIMBAL: the turns of 'lower' are singular at m = ")
    assert gimbal.warnings(model_of("heavy_top")) == ()
    text = "\n".join(
        ["eom: 1", "system: T", "space: solid", "gravity: 0", "coordinates: {a: , b: , c: }",
         "bodies: {k: {mass: 1, inertia: [1, 2, 2], at: [0, 0, 0],",
         "  turn: [[z, a], [y, b], [x, c]]}}", "range: {b: [-80 deg, 86 deg]}", ""]
    )  # fmt: skip
    (line,) = gimbal.warnings(read(text, "t.yaml"))
    assert "b = 90 deg (its range)" in line
    assert gimbal.warnings(read(text.replace("86", "84"), "t.yaml")) == ()
    assert machine_of("rigid_body") is not None
