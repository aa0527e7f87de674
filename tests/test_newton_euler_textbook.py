"""Joint reactions are those of the textbooks, by hand at one state."""

import math

import pytest
from scenes import machine_of, model_of
from test_newton_euler import of_text, scene_of

from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.analysis import cards
from eomgen.mechanics import newton_euler


class At:
    """A scene at a state: names -> numbers, and the joint reactions there."""

    def __init__(self, scene, **state):
        self.scene = scene
        leaves = {}
        bindings = scene.kinematics.algebra.bindings
        for parameter in scene.model.parameters:
            if parameter.formula is None:
                leaves[bindings[parameter.symbol]] = float(parameter.value)
        for c in scene.model.coordinates:
            leaves[bindings[c.symbol]] = state.get(c.name, 0.0)
            leaves[bindings[c.rate]] = state.get(f"{c.name}_dot", 0.0)
        for given in scene.model.inputs:
            leaves[bindings[given.symbol]] = state.get(given.name, 0.0)
        self.leaves = leaves
        self.reactions = {r.name: r for r in newton_euler.reactions(scene)}

    def values(self, nodes):
        return evaluate(nodes, self.leaves, FLOAT)

    def force(self, joint):
        return self.values(self.reactions[joint].force)

    def moment(self, joint):
        return self.values(self.reactions[joint].moment)

    def acceleration(self, name):
        names = [c.name for c in self.scene.model.coordinates]
        return self.values([self.scene.accelerations[names.index(name)]])[0]


def test_rod_force_of_the_simple_pendulum():
    """m (g cos phi + l phi'^2) from the bob to the pivot."""
    m, g, length, phi, rate = 0.5, 9.81, 1.0, 0.7, -1.3
    at = At(machine_of("simple_pendulum"), phi=phi, phi_dot=rate)
    rod = m * (g * math.cos(phi) + length * rate**2)
    expected = [-rod * math.sin(phi), rod * math.cos(phi)]
    assert at.force("world/bob") == pytest.approx(expected, rel=1e-13)


def test_rod_forces_of_the_double_pendulum_are_along_the_rods():
    phi_1, phi_2, rate_1, rate_2 = 0.4, -1.1, 2.0, -0.6
    state = {"phi_1": phi_1, "phi_2": phi_2, "phi_1_dot": rate_1, "phi_2_dot": rate_2}
    at = At(machine_of("double_pendulum"), **state)
    for joint, angle in (("world/upper", phi_1), ("upper/lower", phi_2)):
        x, y = at.force(joint)
        assert x * math.cos(angle) + y * math.sin(angle) == pytest.approx(0, abs=1e-12)
    # the lower bob along its rod: T = m_2 (g cos phi_2 + l_2 phi_2'^2 + acceleration of A along it)
    a = at.acceleration("phi_1")
    across, along = 0.5 * a, 0.5 * rate_1**2
    towards = across * math.sin(phi_1 - phi_2) + along * math.cos(phi_1 - phi_2)
    rod = 0.4 * (9.81 * math.cos(phi_2) + 0.4 * rate_2**2 + towards)
    expected = [-rod * math.sin(phi_2), rod * math.cos(phi_2)]
    assert at.force("upper/lower") == pytest.approx(expected, rel=1e-12)


def test_normal_force_of_the_slider():
    """N = (m_A + m_B) g + m_B l (phi'' sin phi + phi'^2 cos phi), nothing along the guide."""
    phi, rate = 0.9, 1.7
    scene = machine_of("slider_pendulum_free")
    at = At(scene, s=0.2, phi=phi, s_dot=0.3, phi_dot=rate)
    value = {p.name: float(p.value) for p in scene.model.parameters}
    swing = at.acceleration("phi") * math.sin(phi) + rate**2 * math.cos(phi)
    weight = (value["m_A"] + value["m_B"]) * value["g"]
    normal = weight + value["m_B"] * value["l"] * swing
    x, y = at.force("world/slider")
    assert x == pytest.approx(0, abs=1e-12)
    assert y == pytest.approx(normal, rel=1e-13)
    assert at.moment("slider/bob") == pytest.approx([0], abs=1e-12)


RODS = """\
eom: 1
system: Hanging chain of rods
space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 0.5 m, g: 10 m/s^2}
coordinates: {a: rad, b: rad, c: rad}
points:
  O: [0, 0]
  P: "O + l*[sin(a), -cos(a)]"
  Q: "P + l*[sin(b), -cos(b)]"
  R: "Q + l*[sin(c), -cos(c)]"
bodies:
  first: {rod: [O, P], mass: m}
  second: {rod: [P, Q], mass: m}
  third: {rod: [Q, R], mass: m}
"""


def test_a_chain_at_rest_carries_the_weight_below():
    at = At(of_text(RODS))
    assert at.force("world/first") == pytest.approx([0, 60])
    assert at.force("first/second") == pytest.approx([0, 40])
    assert at.force("second/third") == pytest.approx([0, 20])
    assert {r.about for r in at.reactions.values()} == {"O", "P", "Q"}


def test_pins_of_moving_rods_carry_no_moment():
    at = At(of_text(RODS), a=0.3, b=-1.2, c=2.0, a_dot=1.0, b_dot=-3.0, c_dot=0.5)
    for joint in at.reactions:
        assert at.moment(joint) == pytest.approx([0], abs=1e-12)
        assert max(map(abs, at.force(joint))) > 1


def test_rope_forces_of_atwoods_machine():
    """Each weight hangs on its rope force; what ties the weights is named."""
    at = At(machine_of("atwood_machine"), x=0.5, x_dot=1.0)
    a = at.acceleration("x")
    assert at.force("world/first") == pytest.approx([0, 2 * (9.81 - a)])
    assert at.force("world/second") == pytest.approx([0, 1.5 * (9.81 + a)])
    assert at.reactions["world/first"].together_with == ("second", "pulley")


def test_bearing_moment_of_a_precessing_top():
    """A point support takes no moment, in any state."""
    state = {"phi": 0.3, "theta": 0.8, "psi": 1.0, "phi_dot": 2.0, "theta_dot": -1.0}
    at = At(machine_of("heavy_top"), **state, psi_dot=200.0)
    assert at.moment("world/top") == pytest.approx([0, 0, 0], abs=1e-12)


def test_gyroscopic_moment_of_a_rotor_on_a_turning_frame():
    """C_z Omega psi' across both axes, where the frame's bearings hold the rotor's axis level."""
    model = model_of("gyroscope")
    at = At(machine_of("gyroscope"), theta=math.pi / 2, psi_dot=3.0, phi_dot=100.0)
    value = {p.name: float(p.value) for p in model.parameters}
    # theta = 90 deg: the rotor axis is -y; d(C_z Omega e)/dt = psi' z x C_z Omega (-y) = along x
    accelerated = at.acceleration("theta") * value["C"]
    x, _, _ = at.moment("inner/rotor")
    assert x == pytest.approx(accelerated + value["C_z"] * 100.0 * 3.0, rel=1e-12)


def test_a_constraint_that_joins_points_loads_both_bodies():
    """Slider-crank: the guide presses across only, the pins carry no moment."""
    scene = scene_of("slider_crank")
    report = cards.report(machine_of("slider_crank"))
    state = report.initial.state
    names = [c.name for c in scene.model.coordinates]
    start = dict(zip(names, map(float, state.coordinates), strict=True))
    start |= {f"{n}_dot": float(v) for n, v in zip(names, state.rates, strict=True)}
    at = At(scene, **start, tau=7.0, F=50.0)
    x, y = at.force("world/slider")
    assert x == pytest.approx(0, abs=1e-9)
    assert abs(y) > 1
    for joint in ("world/crank", "crank/connecting_rod"):
        assert at.moment(joint) == pytest.approx([0], abs=1e-9)
    pin = dict(zip(scene.kept, at.values(scene.linked.multipliers), strict=True))
    assert y == pytest.approx(1.1 * 9.81 + pin["wrist.y"], rel=1e-12)


def test_a_relation_between_coordinates_is_a_reaction():
    """Block on an incline: the normal force is m g cos(theta), up from the surface."""
    scene = scene_of("block_on_incline")
    value = {p.name: float(p.value) for p in scene.model.parameters}
    slope = value["theta"]
    at = At(scene, x=1.0, y=math.tan(slope), x_dot=0.4, y_dot=0.4 * math.tan(slope))
    normal = value["m"] * value["g"] * math.cos(slope)
    expected = [-normal * math.sin(slope), normal * math.cos(slope)]
    assert at.force("world/block") == pytest.approx(expected, rel=1e-12)
