"""Coulomb friction: sticking and sliding against hand results and the balance of forces."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import sympy as sp
from test_contacts import BODY, Scene, integrate

from eomgen import compile_contacts
from eomgen.algebra.arithmetic import EXACT, evaluate
from eomgen.algebra.graph import Graph
from eomgen.algebra.ldl import SingularMassMatrix
from eomgen.errors import UsageError
from eomgen.mechanics import contacts_motion

INCLINE = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, g: 9.81 m/s^2, mu: 0.3, theta: 20 deg}
coordinates: {x: m, y: m}
inputs: {F: N}
bodies: {block: {mass: m, at: "[x, y]"}}
forces: [{on: block, force: "[-F*sin(theta), F*cos(theta)]"}]
constraints: {incline: {holonomic: y - x*tan(theta) = 0}}
"""
ON_TOP = INCLINE.replace("holonomic: y - x*tan(theta) = 0", "unilateral: y >= x*tan(theta)")
BODY_FLOOR = BODY.replace("restitution: e}", "restitution: e, friction: mu}").replace(
    "e: 0.3,", "e: 0.3, mu: 0.4,"
)
# a rod whose end touches, free (one-sided) or guided on a rail (two-sided)
ROD = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 0.7 m, g: 9.81 m/s^2, mu: 0.5}
coordinates: {x: m, y: m, phi: rad}
inputs: {F: N}
points: {P: "[x, y] - l*[cos(phi), sin(phi)]"}
bodies: {rod: {mass: m, at: "[x, y]", angle: phi, inertia: m*l^2/3}}
forces: [{on: rod, force: "[0, F]"}]
constraints: {floor: {unilateral: y - l*sin(phi) >= 0, friction: mu}}
"""
RAIL = ROD.replace("unilateral: y - l*sin(phi) >= 0, friction: mu", "holonomic: y = l*sin(phi)")
SPHERE = """space: solid
gravity: [0, 0, -g]
parameters: {m: 2 kg, R: 1.5 m, g: 9.81 m/s^2, mu: 0.4}
coordinates: {x: m, y: m, z: m}
bodies: {mass: {mass: m, at: "[x, y, z]"}}
constraints: {sphere: {unilateral: x^2 + y^2 + z^2 >= R^2, friction: mu}}
"""
SCENES = {"incline": INCLINE, "on top": ON_TOP, "rod": ROD, "rail": RAIL, "sphere": SPHERE,
          "body": BODY_FLOOR}  # fmt: skip


def rubbing(*names):
    """Gives friction mu to constraints, which the language allows to one-sided ones only."""

    def change(model):
        (mu,) = (p.symbol for p in model.parameters if p.name == "mu")
        changed = (replace(c, friction=mu) if c.name in names else c for c in model.constraints)
        return replace(model, constraints=tuple(changed))

    return change


@cache
def scene(name):
    return Scene(SCENES[name], rubbing("incline", "floor"))


ANGLES = [(theta, mu) for theta in (0.1, 0.4, 0.9) for mu in (0.05, 0.3, np.tan(0.4), 0.8, 1.5)]
UP, DOWN = "slip_plus", "slip_minus"  # along the tangent, against it
GRAVITY, MASS = 9.81, 2.0


def on_incline(theta, along=0.0, speed=0.0):
    unit = np.array([np.cos(theta), np.sin(theta)])
    return [*(along * unit), *(speed * unit)]


@pytest.mark.parametrize("name", ["incline", "on top"])
@pytest.mark.parametrize(("theta", "mu"), ANGLES)
def test_a_block_sticks_where_the_incline_is_not_too_steep(name, theta, mu) -> None:
    found, at = scene(name), on_incline(theta, 0.7)
    values = {"theta": theta, "mu": mu}
    assert found.call("accelerations_stick", at, **values) == pytest.approx([0, 0], abs=1e-14)
    reserve = found.call("events_stick", at, **values)[-1]
    weight = MASS * GRAVITY
    expected = weight * (mu * np.cos(theta) - np.sin(theta))
    assert reserve == pytest.approx(expected, rel=1e-12, abs=1e-13 * weight)
    if abs(np.tan(theta) - mu) > 1e-9:
        assert (reserve >= 0) == (np.tan(theta) <= mu)


@pytest.mark.parametrize("name", ["incline", "on top"])
@pytest.mark.parametrize(("theta", "mu"), ANGLES)
@pytest.mark.parametrize(("mode", "sign"), [(DOWN, 1), (UP, -1)])
def test_a_block_slides_with_g_sin_less_mu_cos(name, theta, mu, mode, sign) -> None:
    """Down: g (sin - mu cos) along the incline; up: g (sin + mu cos), braking."""
    found, at = scene(name), on_incline(theta, 0.7, -sign * 1.3)
    values = {"theta": theta, "mu": mu}
    down = GRAVITY * (np.sin(theta) - sign * mu * np.cos(theta))
    expected = -down * np.array([np.cos(theta), np.sin(theta)])
    accelerations = found.call(f"accelerations_{mode}", at, **values)
    assert accelerations == pytest.approx(expected, rel=1e-12, abs=1e-13)
    assert found.call(f"events_{mode}", at, **values)[-1] == pytest.approx(1.3)
    pressed = found.call(f"contact_forces_{mode}", at, **values)[0] / np.cos(theta)
    assert pressed == pytest.approx(MASS * GRAVITY * np.cos(theta))


@pytest.mark.parametrize("lift", [10.0, 50.0])
def test_a_guide_rubs_on_either_side(lift) -> None:
    """A push off the incline beyond m g cos lifts the block against the upper side of its guide."""
    found, theta = scene("incline"), 0.4
    force = lift - MASS * GRAVITY * np.cos(theta)  # off the incline
    values = {"theta": theta, "mu": 0.3, "inputs": [lift]}
    at = on_incline(theta, 0.7, -1.3)
    drag = 0.3 * abs(force) / MASS
    expected = (drag - GRAVITY * np.sin(theta)) * np.array([np.cos(theta), np.sin(theta)])
    assert found.call("accelerations_slip_minus", at, **values) == pytest.approx(expected)
    assert np.sign(found.call("contact_forces_slip_minus", at, **values)[0]) == -np.sign(force)
    reserve = found.call("events_stick", at, **values)
    expected = 0.3 * abs(force) - MASS * GRAVITY * np.sin(theta)
    assert reserve == pytest.approx([expected], rel=1e-12)


def rod_states(count=6):
    """The end rests on the floor; it slides to either side."""
    chance = np.random.default_rng(3)
    for _ in range(count):
        phi, spin, speed = chance.uniform([0.3, -2, -2], [2.8, 2, 2])
        y, up = 0.7 * np.sin(phi), 0.7 * spin * np.cos(phi)
        yield np.array([0.4, y, phi, speed - 0.7 * spin * np.sin(phi), up, spin])


@pytest.mark.parametrize("push", [-30.0, 0.0, 60.0])
@pytest.mark.parametrize("name", ["rod", "rail"])
@pytest.mark.parametrize("state", list(rod_states()))
def test_a_sliding_end_has_the_forces_of_newton_and_euler(name, state, push) -> None:
    """m x'' = F_t, m y'' = N - m g + F, J phi'' = moment of both; |F_t| = mu |N| against slip."""
    found, phi = scene(name), state[2]
    slip = state[3] + 0.7 * state[5] * np.sin(phi)
    mode = UP if slip > 0 else DOWN
    given = {"inputs": [push], "mu": 0.2}
    ax, ay, spin = found.call(f"accelerations_{mode}", state, **given)
    drag, force = MASS * ax, MASS * (ay + GRAVITY) - push
    assert found.call(f"contact_forces_{mode}", state, **given)[0] == pytest.approx(force)
    size = abs(force) if name == "rail" else force
    assert drag == pytest.approx(-0.2 * np.sign(slip) * size, rel=1e-11)
    moment = -0.7 * np.cos(phi) * force + 0.7 * np.sin(phi) * drag
    assert MASS * 0.7**2 / 3 * spin == pytest.approx(moment, rel=1e-11)
    # y'' = d^2/dt^2 (l sin(phi))
    end = 0.7 * (np.cos(phi) * spin - np.sin(phi) * state[5] ** 2)
    assert ay == pytest.approx(end, rel=1e-12, abs=1e-13)
    assert found.call(f"events_{mode}", state, **given)[-1] == pytest.approx(abs(slip))


def test_the_rail_is_pressed_on_both_sides_in_these_states() -> None:
    sides = {
        np.sign(scene("rail").call("contact_forces_slip_plus", s, inputs=[push])[0])
        for s in rod_states()
        for push in (-30.0, 60.0)
    }
    assert sides == {1, -1}


@pytest.mark.parametrize("state", list(rod_states()))
@pytest.mark.parametrize("name", ["rod", "rail"])
def test_a_sticking_end_stays(name, state) -> None:
    found, phi, spin = scene(name), state[2], state[5]
    state[3] = -0.7 * spin * np.sin(phi)  # no slip
    ax, ay, turn = found.call("accelerations_stick", state)
    assert ax == pytest.approx(-0.7 * (np.sin(phi) * turn + np.cos(phi) * spin**2), rel=1e-12)
    assert ay == pytest.approx(0.7 * (np.cos(phi) * turn - np.sin(phi) * spin**2), rel=1e-12)
    force = MASS * (ay + GRAVITY)
    size = abs(force) if name == "rail" else force
    reserve = found.call("events_stick", state)[-1]
    assert reserve == pytest.approx(0.5 * size - abs(MASS * ax), rel=1e-11, abs=1e-12)


@pytest.mark.parametrize("name", ["rod", "rail"])
@pytest.mark.parametrize(("mu", "jams"), [(1.333, False), (1.334, True)])
def test_painleves_rod_jams_beyond_four_thirds(name, mu, jams) -> None:
    """At tan(phi) = 2 the end is pushed ahead: 1 + 3 cos^2 - 3 mu sin cos < 0 for mu > 4/3.

    Painleve, Lecons sur le frottement (1895); uniform rod, J = m l^2 / 3.
    """
    found, phi = scene(name), np.arctan(2)
    state = [0, 0.7 * np.sin(phi), phi, 1.0, 0, 0]
    for mode in (UP, DOWN):
        slides = not (jams and (mode == DOWN or name == "rail"))
        if slides:
            assert np.all(np.isfinite(found.call(f"accelerations_{mode}", state, mu=mu)))
        else:
            with pytest.raises(SingularMassMatrix):
                found.call(f"accelerations_{mode}", state, mu=mu)


def body_point(found):
    """The place of P as SymPy, from rotation matrices of its own."""
    x, y, z, alpha, beta, gamma = (c.symbol for c in found.model.coordinates)
    turn = sp.rot_ccw_axis3(alpha) * sp.rot_ccw_axis2(beta) * sp.rot_ccw_axis1(gamma)
    arm = sp.Matrix([p.symbol for p in found.model.parameters if p.name in ("a", "b", "c")])
    return sp.Matrix([x, y, z]) + turn * arm


def body_states(count=5):
    """States at which P is at rest along the normal."""
    chance = np.random.default_rng(5)
    found = scene("body")
    for _ in range(count):
        state = chance.uniform(-1, 1, 12)
        rise = found.call("gap_rates", state)[0]
        state[8] -= rise
        yield state


@pytest.mark.parametrize("state", list(body_states()))
def test_a_body_of_full_inertia_slides_on_its_corner(state) -> None:
    """m a = m g + N e_z - mu N v_t/|v_t|, and the same force at P in the equations of turning."""
    found = scene("body")
    place = body_point(found)
    velocity = place.applyfunc(found.rate)
    slip = np.array([found.formula(v, state) for v in velocity])
    assert slip[2] == pytest.approx(0, abs=1e-14)
    accelerations = found.call("accelerations_slip", state)
    (force,) = found.call("contact_forces_slip", state)
    on_body = force * (np.array([0, 0, 1]) - 0.4 * slip / np.linalg.norm(slip))
    expected = np.array([0, 0, -MASS * GRAVITY]) + on_body
    assert MASS * accelerations[:3] == pytest.approx(expected, rel=1e-12, abs=1e-12)
    symbols = [c.symbol for c in found.model.coordinates]
    partials = np.array([[found.formula(sp.diff(p, s), state) for s in symbols] for p in place])
    residual = found.matrix(state[:6]) @ accelerations
    residual += found.call("bias", state) - found.call("generalized_forces", state)
    assert residual == pytest.approx(partials.T @ on_body, rel=1e-11, abs=1e-11)
    rise = velocity.applyfunc(found.rate)[2]
    assert found.formula(rise, state, accelerations) == pytest.approx(0, abs=1e-12)
    assert found.call("events_slip", state) == pytest.approx([force, np.linalg.norm(slip)])


@pytest.mark.parametrize("state", list(body_states()))
def test_a_body_of_full_inertia_turns_about_its_corner(state) -> None:
    found = scene("body")
    place = body_point(found)
    velocity = place.applyfunc(found.rate)
    state[6:9] -= [found.formula(v, state) for v in velocity]
    accelerations = found.call("accelerations_stick", state)
    for component in velocity.applyfunc(found.rate):
        assert found.formula(component, state, accelerations) == pytest.approx(0, abs=1e-12)
    hold = MASS * (accelerations[:3] + [0, 0, GRAVITY])
    expected = [hold[2], 0.4 * hold[2] - np.hypot(hold[0], hold[1])]
    assert found.call("events_stick", state) == pytest.approx(expected, rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("height", [1, -1, -1e20])  # the last: the lowest point
def test_friction_on_a_sphere_is_in_newtons_whatever_the_unit_of_the_gap(height) -> None:
    """The gap is an area: N = lambda_N 2 R; tangents on both halves of the sphere."""
    found, chance = scene("sphere"), np.random.default_rng(1)
    normal = chance.uniform(0.2, 1, 3) * [1, -1, height]
    normal /= np.linalg.norm(normal)
    speed = np.cross(normal, chance.uniform(-1, 1, 3))
    state = [*(1.5 * normal), *speed]
    force = found.call("contact_forces_slip", state)[0] * 3.0
    path = speed @ speed / 1.5  # centripetal
    assert force == pytest.approx(MASS * (GRAVITY * normal[2] - path), rel=1e-12)
    expected = [0, 0, -GRAVITY] + force / MASS * (normal - 0.4 * speed / np.linalg.norm(speed))
    assert found.call("accelerations_slip", state) == pytest.approx(expected, rel=1e-12)
    still = [*(1.5 * normal), 0, 0, 0]
    weight = MASS * GRAVITY * np.array([normal[2], np.hypot(normal[0], normal[1])])
    reserve = found.call("events_stick", still)[1]
    assert reserve == pytest.approx(0.4 * weight[0] - weight[1], rel=1e-12)


@pytest.mark.parametrize("side", [1, -1])
def test_a_block_shot_up_the_incline_stops_where_energy_says(side) -> None:
    """v^2 / 2 = s g (sin + mu cos); there the slip speed ends the mode and it sticks."""
    text, theta = ON_TOP.replace("mu: 0.3", "mu: 0.5"), np.deg2rad(20)
    found = Scene(text, rubbing("incline"))
    start = on_incline(theta, 0.0, side * 3.0)
    drag = GRAVITY * (side * np.sin(theta) + 0.5 * np.cos(theta))
    time, end = integrate(found, UP if side > 0 else DOWN, start, 20, event=1)
    assert time == pytest.approx(3.0 / drag, rel=1e-9)
    assert np.hypot(*end[:2]) == pytest.approx(9 / (2 * drag), rel=1e-9)
    assert found.call("events_stick", end)[1] > 0


def test_modes_of_friction_say_what_they_watch() -> None:
    def named(name):
        return {m.name: m for m in compile_contacts.Touching(scene(name).machine).modes}

    assert list(named("incline")) == ["stick", "slip_plus", "slip_minus"]  # never open
    assert list(named("on top")) == ["flight", "stick", "slip_plus", "slip_minus"]
    assert list(named("body")) == ["flight", "stick", "slip"]
    stick = named("on top")["stick"]
    assert stick.active == stick.sticking == ("incline",)
    assert stick.events == ("normal force of incline", "friction reserve of incline")
    assert named("incline")["slip_plus"].events == ("slip speed of incline",)
    assert named("body")["slip"].sticking == ()
    assert "gaps" not in scene("incline").functions


def test_friction_that_is_written_zero_is_none() -> None:
    found = Scene(ON_TOP.replace("tan(theta)}", "tan(theta), friction: 0}"))
    assert [m.name for m in compile_contacts.Touching(found.machine).modes] == ["flight", "contact"]


TWO_GUIDES = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 0.7 m, g: 9.81 m/s^2, mu: 0.5}
coordinates: {x: m, y: m, phi: rad}
points: {P: "[x, y] - l*[cos(phi), sin(phi)]", Q: "[x, y] + l*[cos(phi), sin(phi)]"}
bodies: {ladder: {mass: m, at: "[x, y]", angle: phi, inertia: m*l^2/3}}
constraints: {floor: {holonomic: y = l*sin(phi)}, wall: {holonomic: x + l*cos(phi) = l}}
"""


def test_a_ladder_slides_on_a_rough_floor_along_a_smooth_wall() -> None:
    """Beside the guide that slides there is another: m x'' = F + W, W the wall's force."""
    found = Scene(TWO_GUIDES, rubbing("floor"))
    phi, spin = 1.1, -0.8
    s, c = np.sin(phi), np.cos(phi)
    state = [0.7 - 0.7 * c, 0.7 * s, phi, 0.7 * s * spin, 0.7 * c * spin, spin]
    ax, ay, turn = found.call("accelerations_slip_minus", state, mu=0.2)
    force = MASS * (ay + GRAVITY)
    assert found.call("contact_forces_slip_minus", state, mu=0.2)[0] == pytest.approx(force)
    wall = MASS * ax - 0.2 * abs(force)
    moment = 0.7 * (-c * force + s * 0.2 * abs(force) - s * wall)
    assert MASS * 0.7**2 / 3 * turn == pytest.approx(moment, rel=1e-12)
    assert force > 0
    assert ax == pytest.approx(0.7 * (s * turn + c * spin**2), rel=1e-12)
    assert ay == pytest.approx(0.7 * (c * turn - s * spin**2), rel=1e-12)


def test_elimination_solves_what_is_not_symmetric() -> None:
    graph = Graph()
    rows = [[4, 1, -2], [3, 5, 1], [-1, 2, 6]]
    matrix = [[graph.symbol(f"a{i}{j}") for j in range(3)] for i in range(3)]
    right = [graph.symbol(f"b{i}") for i in range(3)]
    values = {matrix[i][j]: sp.Rational(rows[i][j]) for i in range(3) for j in range(3)}
    values |= {b: sp.Integer(i + 1) for i, b in enumerate(right)}
    (solution,), pivots = contacts_motion.eliminated(matrix, right)
    found = evaluate(solution, values, EXACT)
    assert sp.Matrix(rows) * sp.Matrix(found) == sp.Matrix([1, 2, 3])
    assert len(pivots) == 3
    with pytest.raises(UsageError, match="friction jams"):
        contacts_motion.eliminated([[graph.number(-1)]], [graph.one])
