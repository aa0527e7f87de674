"""Rows 6, 7, 16, 17, 18 and 20: systems without constraints, long runs, time and angles."""

import numpy as np
import pytest
from laboratory import (
    DOUBLE_PENDULUM,
    METHODS,
    OSCILLATOR,
    derived,
    drift,
    energies,
    engine,
    failed,
    run,
    start,
    stepped,
)
from scipy.spatial.transform import Rotation
from small_scenes import FREE_BODY

from eomgen import stepping
from eomgen.errors import UsageError
from eomgen.numerics.records import Grid


def pendulum(real="double"):
    return engine(stepped(DOUBLE_PENDULUM), real)


def swinging(angle=0.3):
    return start(stepped(DOUBLE_PENDULUM), a=angle, b=angle)


def relative_gain(method, step, span):
    """The energy at the end against that above rest at the start."""
    scene, rest = pendulum(), -3 * 9.81
    found = energies(scene, run(scene, method, swinging(), step, round(span / step)))
    return (found[-1] - found[0]) / (found[0] - rest)


@pytest.mark.parametrize(
    ("step", "semi", "verlet", "rk4", "midpoint"),
    [
        (1e-2, 0.274, 0.288, 1.6e-6, 3e-6),
        pytest.param(1e-3, 0.0356, 0.0345, 1.6e-11, 3e-8, marks=pytest.mark.slow),
    ],
)
def test_rows_6_and_7_only_canonical_methods_keep_the_energy(step, semi, verlet, rk4, midpoint):
    """M(q): the symplectic pair drifts with order 1; RK4 and the midpoint of (q, p) do not."""
    assert relative_gain("semi-euler", step, 1000) == pytest.approx(semi, rel=0.02)
    assert relative_gain("verlet", step, 1000) == pytest.approx(verlet, rel=0.02)
    scene, count = pendulum(), round(1000 / step)
    assert drift(scene, run(scene, "rk4", swinging(), step, count, 100)) < rk4
    rows = run(scene, "midpoint", swinging(), step, count, 100)
    assert drift(scene, rows) < midpoint
    errors = np.abs(energies(scene, rows) - energies(scene, rows)[0])
    tenth = len(errors) // 10
    assert errors[-tenth:].max() < 1.05 * errors[:tenth].max()  # a band, no drift


def test_row_6_verlet_is_not_offered_where_it_is_not_symplectic():
    with pytest.raises(UsageError, match="E-SYM: verlet is not symplectic"):
        stepping.of(derived(DOUBLE_PENDULUM), ("verlet",))


def past_the_pole(miss, step):
    """Attitude errors after 3 s of turning with 1 rad/s about an axis `miss` off y, and a length.

    Errors: by three angles, infinite where a step could not be made, and by a quaternion [rad].
    """
    axis = np.array([-np.sin(miss), np.cos(miss), 0.0])
    steps = stepped(FREE_BODY)
    state = start(steps, **{"pitch'": axis[1], "roll'": axis[0]})
    count = round(3 / step)
    rows = run(engine(steps), "rk4", state, step, count)
    exact = Rotation.from_rotvec(axis * step * count)
    by_angles = (Rotation.from_euler("ZYX", rows.states[-1, :3]) * exact.inv()).magnitude()
    found, length = by_quaternion(axis, step, count)
    by_angles = np.inf if rows.stopped else by_angles
    return by_angles, (found * exact.inv()).magnitude(), length


QUATERNION = """\
eom: 1
system: Free body by a quaternion
space: solid
gravity: 0
parameters: {m: 1 kg, J: 1 kg*m^2}
coordinates: {e: quaternion}
bodies:
  ball: {mass: m, frame: {turn: {quaternion: e}}, com: [0, 0, 0], inertia: [J, J, J]}
initial:
  {e: [1, 0, 0, 0], omega_e_x: 0 rad/s, omega_e_y: 1 rad/s, omega_e_z: 0 rad/s}
"""


def by_quaternion(axis, step, count):
    """The attitude by the quaternion that we ship, and how far its length ever went from 1."""
    steps = stepped(QUATERNION)
    state = start(steps, omega_e_x=axis[0], omega_e_y=axis[1])
    rows = run(engine(steps), "rk4", state, step, count, 1)
    lengths = np.linalg.norm(rows.states[:, :4], axis=1)
    w, x, y, z = rows.states[-1, :4]
    return Rotation.from_quat([x, y, z, w]), np.abs(lengths - 1).max()


@pytest.mark.parametrize(("miss", "step"), [(1e-3, 1e-2), (1e-4, 1e-2), (1e-4, 1e-3)])
def test_row_16_three_angles_fail_near_the_pole_and_a_quaternion_does_not(miss, step):
    angles, quaternion, length = past_the_pole(miss, step)
    assert angles > 1e-4
    assert quaternion < 1e-10
    assert length < 1e-13


def test_row_16_a_small_step_helps_where_the_pole_is_missed_by_enough():
    assert past_the_pole(1e-3, 1e-4)[0] < 1e-5
    assert past_the_pole(1e-3, 1e-3)[0] > 1e-2


def test_row_17_an_exact_hit_passes_by_symmetry():
    """Yaw and roll stay zero, so no formula sees the pole: no test of anything."""
    assert past_the_pole(0.0, 1e-2)[0] < 1e-10


TIMED = """\
eom: 1
system: Force that tells the time
space: line
gravity: 0
parameters: {m: 1, r: 1000}
coordinates: {x: 1}
bodies:
  mass: {mass: m, at: "[x]"}
forces: [{on: mass, force: m*r*t}]
initial: {x: 0, x': 0}
"""


def told_time(count, step=1e-3):
    """The time that step `count` of the C takes itself to be at, in float."""
    scene = engine(stepped(TIMED), "float", r=1 / step)
    march = scene.march(METHODS["semi-euler"], None, np.zeros(2))
    rows = march.advance(Grid(0.0, step, count + 1, 1), count, 1)
    return rows.states[-1][1]


def summed(count):
    """t += h in float, in pieces."""
    t, step, piece = np.float32(0), np.float32(1e-3), 1_000_000
    for _ in range(count // piece):
        steps = np.full(piece + 1, step, np.float32)
        steps[0] = t
        t = np.cumsum(steps, dtype=np.float32)[-1]
    return float(t)


@pytest.mark.parametrize(("count", "error"), [(1_000_000, 0.009), (10_000_000, 0.022)])
def test_row_18_time_that_is_summed_in_float_is_off(count, error):
    exact = count * 1e-3
    assert abs(summed(count) / exact - 1) == pytest.approx(error, rel=0.1)
    assert told_time(count) == pytest.approx(exact, rel=2.4e-7)


@pytest.mark.slow
def test_row_18_summed_time_stands_still():
    assert summed(50_000_000) == 32768
    assert told_time(50_000_000) == pytest.approx(50_000, rel=2.4e-7)


def parted(angle, span, shift=1e-9):
    """The distance of two runs that start `shift` apart, over that, at every 0.1 s."""
    scene, near = pendulum(), swinging(angle)
    near[0] += shift
    rows = [run(scene, "rk4", y, 1e-3, round(span * 1e3), 100) for y in (swinging(angle), near)]
    return rows[0].times, np.abs(rows[0].states - rows[1].states).max(axis=1) / shift


def test_row_20_chaos_forbids_comparison_point_by_point_and_not_of_energy():
    times, apart = parted(2.0, 12.0)
    rate = np.polyfit(times[20:], np.log(apart[20:]), 1)[0]
    assert 0.8 < rate < 2.0
    scene = pendulum()
    # 1e-12 apart at the start, another number at the end, the same energy
    near = swinging(2.0)
    near[0] += 1e-12
    ends = [run(scene, "rk4", y, 1e-3, 40_000) for y in (swinging(2.0), near)]
    assert np.abs(ends[0].states[-1] - ends[1].states[-1]).max() > 0.1
    assert all(drift(scene, rows) < 1e-6 for rows in ends)
    for angle in (0.3, 1.0):
        times, apart = parted(angle, 40.0)
        half = len(times) // 2
        # parts with time and not with its exponential
        assert apart[half:].max() < 5 * apart[:half].max()


def test_what_fails_is_seen_to_fail():
    """The measure itself: a run that leaves is told from one that stays."""
    scene = engine(stepped(OSCILLATOR))
    assert failed(run(scene, "rk4", [1.0, 0.0], 3.0, 500))
    assert not failed(run(scene, "rk4", [1.0, 0.0], 1.0, 500))
