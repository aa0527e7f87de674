"""One-sided constraints: modes, forces and impacts, by identity and by the lecture's results."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.linalg import null_space

from eomgen import compile, compile_contacts
from eomgen.interpreter import FLOAT, run
from eomgen.mechanics import machine
from eomgen.model import TIME
from eomgen.spec import read

HEAD = "eom: 1\nsystem: Contact\n"
BALL = """space: plane
gravity: [0, -g]
parameters: {m: 0.3 kg, g: 9.81 m/s^2, e: 0.8}
coordinates: {x: m, y: m}
bodies: {ball: {mass: m, at: "[x, y]"}}
constraints: {floor: {unilateral: y >= 0, restitution: e}}
"""
ROPE = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 1.5 m, g: 9.81 m/s^2, e: 0.25}
coordinates: {x: m, y: m}
bodies: {bob: {mass: m, at: "[x, y]"}}
constraints:
  taut: {unilateral: l - sqrt(x^2 + y^2) >= 0, restitution: e}
"""
SPHERE = """space: solid
gravity: [0, 0, -g]
parameters: {m: 2 kg, R: 1.5 m, g: 9.81 m/s^2, e: 1/2}
coordinates: {x: m, y: m, z: m}
bodies: {mass: {mass: m, at: "[x, y, z]"}}
constraints: {sphere: {unilateral: x^2 + y^2 + z^2 - R^2 >= 0, restitution: e}}
"""
ROD = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 0.7 m, g: 9.81 m/s^2, e: 0.6, A: 0.1 m, w: 5 rad/s}
prescribed: {s: A*sin(w*t)}
coordinates: {x: m, y: m, phi: rad}
points: {P: "[x, y] + l*[cos(phi), sin(phi)]"}
bodies: {rod: {mass: m, at: "[x, y]", angle: phi, inertia: m*l^2/3}}
constraints: {table: {unilateral: y + l*sin(phi) >= s, restitution: e}}
"""
BODY = """space: solid
gravity: [0, 0, -g]
parameters:
  {m: 2 kg, g: 9.81 m/s^2, e: 0.3, a: 0.3 m, b: -0.2 m, c: 0.4 m,
   I1: 0.5 kg*m^2, I2: 0.7 kg*m^2, I3: 0.6 kg*m^2, I12: 0.05 kg*m^2, I13: -0.04 kg*m^2,
   I23: 0.03 kg*m^2}
coordinates: {x: m, y: m, z: m, alpha: rad, beta: rad, gamma: rad}
points: {P: {on: block, at: "[a, b, c]"}}
bodies:
  block:
    mass: m
    at: "[x, y, z]"
    turn: [[z, alpha], [y, beta], [x, gamma]]
    inertia: [[I1, I12, I13], [I12, I2, I23], [I13, I23, I3]]
constraints:
  floor: {unilateral: z - a*sin(beta) + b*cos(beta)*sin(gamma) + c*cos(beta)*cos(gamma) >= 0,
          restitution: e}
"""
HANGER = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, M: 1 kg, l: 1.5 m, g: 9.81 m/s^2, d: 0.2 m, e: 0.4}
coordinates: {u: m, x: m, y: m}
bodies: {slider: {mass: M, at: "[u, 0]"}, bob: {mass: m, at: "[x, y]"}}
constraints:
  link: {holonomic: (x - u)^2 + y^2 = l^2}
  wall: {unilateral: x >= -d, restitution: e}
"""
SCENES = {"ball": BALL, "rope": ROPE, "sphere": SPHERE, "rod": ROD, "body": BODY, "hanger": HANGER}


def machine_of(model):
    """The machine of a model, with a multiplier for every row."""
    found = compile.machine_of(model)
    return replace(found, kept=tuple(r.name for r in found.rows))


class Scene:
    """A spec with contacts, whose functions are called at a state and with other parameters."""

    def __init__(self, text, change=lambda model: model):
        self.model = change(read(HEAD + text, "contact.yaml"))
        self.machine = machine_of(self.model)
        names = ("accelerations", "mass_matrix", "energy", "bias", "generalized_forces")
        found = [compile.FUNCTIONS[name](self.machine) for name in names]
        found += compile_contacts.functions(self.machine)
        self.functions = {f.name: f for f in found}
        self.size = len(self.model.coordinates)

    def call(self, name, state, time=0.0, inputs=None, **parameters):
        free = machine.free_parameters(self.model)
        values = [float(parameters.get(p.name, p.value)) for p in free]
        pushes = [0.0] * len(self.model.inputs) if inputs is None else inputs
        given = {"time": [time], "state": state, "inputs": pushes, "parameters": values}
        function = self.functions[name]
        return np.array(run(function, given, FLOAT)).reshape(function.shape)

    def matrix(self, q):
        return self.call("mass_matrix", [*q, *[0.0] * self.size])

    def formula(self, expression, state, accelerations=None, time=0.0):
        """A SymPy formula of coordinates, rates and accelerations, independent of the graph."""
        coordinates = self.model.coordinates
        symbols = [TIME, *(c.symbol for c in coordinates), *(c.rate for c in coordinates)]
        numbers = [time, *state]
        if accelerations is not None:
            symbols += [c.acceleration for c in coordinates]
            numbers += list(accelerations)
        values = {p.symbol: p.value for p in self.model.parameters}
        pairs = zip(symbols, numbers, strict=True)
        values |= {symbol: sp.Float(float(number), 30) for symbol, number in pairs}
        return float(sp.sympify(expression).xreplace(values).evalf(30))

    def rate(self, expression):
        """The time derivative, by SymPy."""
        motion = {TIME: sp.S.One}
        for c in self.model.coordinates:
            motion |= {c.symbol: c.rate, c.rate: c.acceleration}
        return sp.Add(*(sp.diff(expression, s) * r for s, r in motion.items()))

    def gap(self, name):
        """The gap with prescribed motions written out."""
        known = {p.symbol: p.formula for p in self.model.prescribed}
        (found,) = (c for c in self.model.constraints if c.name == name)
        return found.residuals[0].xreplace(known)

    def gradient(self, name, state, time=0.0):
        gap = self.gap(name)
        slopes = [sp.diff(gap, c.symbol) for c in self.model.coordinates]
        return np.array([self.formula(s, state, time=time) for s in slopes])


@cache
def scene(name):
    return Scene(SCENES[name])


def states(name, count=5):
    """Random states; the two-sided constraint of the hanger holds."""
    chance = np.random.default_rng(7)
    size = scene(name).size
    for _ in range(count):
        state = chance.uniform(0.2, 1.2, 2 * size) * chance.choice([-1, 1], 2 * size)
        if name == "hanger":
            u, phi, rate, spin = state[:4]
            x, y = u + 1.5 * np.sin(phi), -1.5 * np.cos(phi)
            state = np.array(
                [u, x, y, rate, rate + 1.5 * spin * np.cos(phi), 1.5 * spin * np.sin(phi)]
            )
        yield state


EACH = [(name, state) for name in SCENES for state in states(name)]


def contact_name(name):
    return next(c.name for c in scene(name).model.constraints if c.kind == "unilateral")


@pytest.mark.parametrize(("name", "state"), EACH)
def test_in_flight_the_motion_is_the_free_one(name, state) -> None:
    found = scene(name)
    assert "accelerations_flight" not in found.functions  # it is `accelerations`
    kept = tuple(c for c in found.model.constraints if c.kind != "unilateral")
    free = machine_of(replace(found.model, constraints=kept))
    function = compile.FUNCTIONS["accelerations"](free)
    assert function == found.functions["accelerations"]
    gap = found.formula(found.gap(contact_name(name)), state, time=0.3)
    assert found.call("events_flight", state, time=0.3)[0] == pytest.approx(gap, rel=1e-12)


@pytest.mark.parametrize(("name", "state"), EACH)
def test_a_closed_contact_keeps_its_gap(name, state) -> None:
    found, contact = scene(name), contact_name(name)
    rate = found.rate(found.gap(contact))
    accelerations = found.call("accelerations_contact", state, time=0.3)
    second = found.rate(rate)
    scale = 1 + abs(found.gradient(contact, state, 0.3)) @ abs(accelerations)
    assert abs(found.formula(second, state, accelerations, 0.3)) < 1e-14 * scale
    assert found.call("gap_rates", state, 0.3)[0] == pytest.approx(
        found.formula(rate, state, time=0.3), rel=1e-12
    )


@pytest.mark.parametrize(("name", "state"), EACH)
def test_the_contact_force_is_what_the_equations_need(name, state) -> None:
    """M q'' + h - Q - J' lambda = G' lambda_N, seen on the motions that J admits."""
    found, contact = scene(name), contact_name(name)
    force = found.call("contact_forces_contact", state, 0.3)
    assert force == pytest.approx(found.call("contact_forces", state, 0.3), rel=1e-13)
    assert force == pytest.approx(found.call("events_contact", state, 0.3), rel=1e-13)
    accelerations = found.call("accelerations_contact", state, 0.3)
    residual = found.matrix(state[: found.size]) @ accelerations
    residual += found.call("bias", state, 0.3) - found.call("generalized_forces", state, 0.3)
    admissible = admissible_directions(found, state)
    left = admissible.T @ residual
    right = admissible.T @ found.gradient(contact, state, 0.3) * force
    assert left == pytest.approx(right, rel=1e-11, abs=1e-11)
    assert abs(force[0]) > 1e-3


def admissible_directions(found, state):
    """A basis of what the two-sided constraints admit."""
    two_sided = [c.name for c in found.model.constraints if c.kind == "holonomic"]
    if not two_sided:
        return np.eye(found.size)
    return null_space(np.array([found.gradient(name, state) for name in two_sided]))


def admissible_mobility(found, state):
    """Z (Z' M Z)^-1 Z': M^-1 on what the two-sided constraints admit."""
    z = admissible_directions(found, state)
    return z @ np.linalg.inv(z.T @ found.matrix(state[: found.size]) @ z) @ z.T


SCLERONOMIC = [(name, state) for name, state in EACH if name != "rod"]


@pytest.mark.parametrize("e", [0, 0.35, 1])
@pytest.mark.parametrize(("name", "state"), SCLERONOMIC)
def test_an_impact_loses_the_energy_of_newtons_law(name, state, e) -> None:
    """dT = -(1 - e^2)/2 gap'^2 / (G M^-1 G'); e = 1 loses none."""
    found, contact = scene(name), contact_name(name)
    after = np.array(state)
    after[found.size :] = found.call(f"impact_{contact}", state, e=e)
    gradient = found.gradient(contact, state)
    rate = gradient @ state[found.size :]
    mobility = gradient @ admissible_mobility(found, state) @ gradient
    before = found.call("energy", state)
    change = found.call("energy", after)[0] - before[0]
    expected = -(1 - e**2) / 2 * rate**2 / mobility
    assert change == pytest.approx(expected, rel=1e-11, abs=1e-13 * before[0])
    assert gradient @ after[found.size :] == pytest.approx(-e * rate, abs=1e-13)


@pytest.mark.parametrize(("name", "state"), EACH)
def test_an_impact_keeps_the_momentum_along_the_contact(name, state) -> None:
    found, contact = scene(name), contact_name(name)
    after = found.call(f"impact_{contact}", state, time=0.3)
    change = found.matrix(state[: found.size]) @ (after - state[found.size :])
    z = admissible_directions(found, state)
    along = z @ null_space((found.gradient(contact, state, 0.3) @ z)[None])
    assert along.T @ change == pytest.approx(np.zeros(along.shape[1]), abs=1e-13)
    assert np.linalg.norm(change) > 1e-3
    two_sided = [c.name for c in found.model.constraints if c.kind == "holonomic"]
    for name_of_row in two_sided:
        assert found.gradient(name_of_row, state) @ after == pytest.approx(0, abs=1e-13)


@pytest.mark.parametrize("state", list(states("rod")))
def test_an_impact_on_a_moving_table_turns_the_relative_rate(state) -> None:
    found = scene("rod")
    after = np.array(state)
    after[3:] = found.call("impact_table", state, time=0.3)
    before = found.call("gap_rates", state, 0.3)
    assert found.call("gap_rates", after, 0.3) == pytest.approx(-0.6 * before, rel=1e-12)
    assert found.formula(found.rate(found.gap("table")), state, time=0.3) != pytest.approx(
        found.gradient("table", state, 0.3) @ state[3:], rel=1e-3
    )


def integrate(found, mode, state, until, event=0):
    """The motion in a mode until its event falls through zero: times, states."""
    name = "accelerations" if mode == "flight" else f"accelerations_{mode}"

    def derivative(t, y):
        return [*y[found.size :], *found.call(name, y, t)]

    def watch(t, y):
        return found.call(f"events_{mode}", y, t)[event]

    watch.terminal, watch.direction = True, -1
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "events": watch}
    done = solve_ivp(derivative, (0.0, until), state, **options)
    assert done.status == 1
    return done.t_events[0][0], done.y_events[0][0]


def test_a_mass_leaves_the_sphere_at_two_thirds() -> None:
    """Lecture, row 7: released at rest from the top it leaves at cos(angle) = 2/3."""
    found, small = scene("sphere"), 1e-5
    start = [1.5 * np.sin(small), 0, 1.5 * np.cos(small), 0, 0, 0]
    assert found.call("events_contact", start)[0] > 0
    _, left = integrate(found, "contact", start, 20)
    assert left[2] / np.linalg.norm(left[:3]) == pytest.approx(2 / 3, abs=1e-9)
    assert found.call("gaps", left)[0] == pytest.approx(0, abs=1e-10)
    # from there the gap opens
    _, landed = left, left + 1e-3 * np.array([*left[3:], *found.call("accelerations", left)])
    assert found.call("gap_rates", landed)[0] > 0


@pytest.mark.parametrize("angle", [-0.4, 0.7, 2.5])
def test_a_taut_rope_pulls_as_a_pendulum(angle) -> None:
    """N = m (l angle'^2 + g cos(angle)); at the top too slow a bob has a slack rope."""
    found, spin = scene("rope"), 1.3
    s, c = np.sin(angle), np.cos(angle)
    state = [1.5 * s, -1.5 * c, 1.5 * spin * c, 1.5 * spin * s]
    tension = 2 * (1.5 * spin**2 + 9.81 * c)
    assert found.call("contact_forces", state)[0] == pytest.approx(tension, rel=1e-13)
    assert (tension < 0) == (angle == 2.5)
    # the same rope as a rod: its multiplier, with the same sign
    rod = replace(found.model.constraints[0], kind="holonomic", restitution=None)
    linked = machine_of(replace(found.model, constraints=(rod,)))
    values = [2, 1.5, 9.81, 0.25]
    given = {"time": [0], "state": state, "inputs": [], "parameters": values}
    function = compile.FUNCTIONS["accelerations"](linked)
    assert found.call("accelerations_contact", state) == pytest.approx(
        np.array(run(function, given, FLOAT)), rel=1e-13
    )


def test_a_ball_bounces_to_e_squared_of_its_height() -> None:
    found = scene("ball")
    state, heights = np.array([0.0, 1.0, 0.4, 0.0]), []
    for _ in range(4):
        heights.append(state[1] + state[3] ** 2 / (2 * 9.81))
        _, down = integrate(found, "flight", state, 2)
        state = np.array([*down[:2], *found.call("impact_floor", down)])
        state[1] = max(state[1], 0) + 1e-300  # on the floor, moving up
    ratios = np.array(heights[1:]) / heights[:-1]
    assert ratios == pytest.approx(0.64, rel=1e-9)
