"""Rows 21 and 24: stiff dampers and forces that jump."""

import re

import numpy as np
import pytest
from laboratory import METHODS, SHIPPED, engine, failed, run, start, stepped
from scipy.integrate import solve_ivp

from eomgen.stability.theory import Linear, largest_step


def governor():
    steps = stepped("flyball_governor")
    return engine(steps), start(steps)


def test_row_21_explicit_steps_are_limited_by_the_damper():
    scene, state = governor()
    matrix = scene.function("state_jacobian")(0.0, state)
    fastest = np.abs(np.linalg.eigvals(matrix)).max()
    limit = largest_step(METHODS["rk4"], Linear(matrix, 4))
    assert limit == pytest.approx(2.785 / fastest, rel=1e-3)
    assert failed(run(scene, "rk4", state, 1.1 * limit, 2000))
    assert not failed(run(scene, "rk4", state, 0.9 * limit, 2000))


def test_row_21_implicit_methods_take_steps_a_thousand_times_larger():
    scene, state = governor()
    found = run(scene, "rosenbrock2", state, 1e-2, 100)
    assert not failed(found)
    slope, jacobian = scene.function("state_derivative"), scene.function("state_jacobian")
    radau = solve_ivp(slope, (0, 1), state, "Radau", jac=jacobian, rtol=1e-8, atol=1e-10)
    assert radau.success
    assert radau.t.size < 500
    np.testing.assert_allclose(found.states[-1], radau.y[:, -1], atol=2e-2)


JUMP = """\
eom: 1
system: Mass between two constant forces
space: line
gravity: 0
parameters: {m: 1, F: 1, s: 1}
coordinates: {x: 1}
bodies:
  mass: {mass: m, at: "[x]"}
forces: [{on: mass, force: SIDE}]
initial: {x: 1, x': 0}
"""


def side(text):
    return JUMP.replace("SIDE", text)


def jump_errors(counts):
    """x'' = -3 F x - F sign(x) from 1, at rest: the force jumps by 2 where x passes zero."""
    steps = stepped(side("-3*F*x - F*sign(x)"))
    scene = engine(steps)
    ends = [run(scene, "rk4", start(steps), 2 / n, n).states[-1] for n in counts]
    return [np.abs(end - after(2.0)).max() for end in ends]


def after(t):
    """The exact state: a harmonic motion about -1/3 until x = 0, then one about +1/3."""
    w = np.sqrt(3)
    event = np.arccos(1 / 4) / w  # 4/3 cos(w t) = 1/3
    speed = -4 / 3 * w * np.sin(w * event)
    s = w * (t - event)
    return np.array([
        1 / 3 - np.cos(s) / 3 + speed / w * np.sin(s),
        w / 3 * np.sin(s) + speed * np.cos(s),
    ])  # fmt: skip


def located(count):
    """The same run in two smooth pieces, the step cut at the event by bisection."""
    steps = stepped(side("-3*F*x - F*s"))
    sides = {sign: engine(steps, s=float(sign)) for sign in (1, -1)}
    h, t, y = 2 / count, 0.0, start(steps)
    while run(sides[1], "rk4", y, h, 1).states[-1, 0] > 0:
        t, y = t + h, run(sides[1], "rk4", y, h, 1).states[-1]
    low, high = 0.0, h
    while high - low > 1e-15:
        middle = (low + high) / 2
        reached = run(sides[1], "rk4", y, middle, 1).states[-1, 0]
        low, high = (middle, high) if reached > 0 else (low, middle)
    y, t = run(sides[1], "rk4", y, high, 1).states[-1], t + high
    rest = int((2 - t) / h) + 1
    return run(sides[-1], "rk4", y, (2 - t) / rest, rest).states[-1]


def test_row_24_a_force_that_jumps_costs_the_order_and_an_event_gives_it_back():
    counts = (50, 70, 100, 140, 200, 280, 400, 560, 800)
    errors = jump_errors(counts)
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert 0.5 < order < 1.6
    cut = [np.abs(located(n) - after(2.0)).max() for n in (25, 50, 100)]
    assert np.log2(cut[0] / cut[-1]) / 2 > 3.5
    assert cut[-1] < min(errors) / 100


def test_row_24_an_impact_is_located_by_what_we_ship(call, tmp_path):
    """A ball let fall from 1 m meets the floor after sqrt(2 (1 - r)/g)."""
    said = call("simulate", SHIPPED["bouncing_ball"], "--t-end", "1", "-o", tmp_path / "b.csv")
    assert said.code == 0
    time = float(re.search(r"([\d.]+) s  floor: impact", said.errors)[1])
    assert time == pytest.approx(np.sqrt(2 * 0.97 / 9.81), abs=1e-10)
