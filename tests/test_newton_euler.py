"""Newton-Euler: forces of constraint do no virtual work, and are those of the textbooks."""

import math
from dataclasses import replace

import pytest
from scenes import FILES, machine_of, model_of, samples_of

from eomgen import compile
from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.analysis import cards
from eomgen.checks.evaluation import singly
from eomgen.formulation import linked
from eomgen.mechanics import newton_euler, newton_euler_loads, newton_euler_tree, speeds
from eomgen.mechanics.newton_euler import lever
from eomgen.mechanics.vectors import add, dot, scale, subtract, transform
from eomgen.spec import read

BODIES = [name for name in FILES if model_of(name).bodies]
FREE = [name for name in BODIES if not model_of(name).constraints]
LINKED = [name for name in BODIES if model_of(name).constraints]
FRAMES = ["manipulator", "two_link_arm", "gyroscope", "heavy_top", "skew_arm", "flyball_governor"]
SPATIAL = ["skew_arm", "gyroscope", "spatial_tree", "spatial_rod", "furuta_pendulum"]
STATES = 5


def scene_of(name):
    """The machine of a scene, with the independent rows where it is linked."""
    machine = machine_of(name)
    return linked(machine, cards.report(machine)).machine if machine.rows else machine


def partials(kinematics, velocity):
    """d velocity / d u, one vector for each speed."""
    one = kinematics.algebra.number(1)
    return [
        tuple(kinematics.algebra.along(v, {u: one}) for v in velocity)
        for u in speeds.symbols(kinematics.model)
    ]


def works(kinematics, force, velocity):
    """Virtual work of a force on a velocity, one term for each speed."""
    return [dot(force, p) for p in partials(kinematics, velocity)] if force else []


def spin_of(kinematics, name):
    """The angular velocity of a body in world axes; one component in a plane."""
    spin = kinematics.angular_velocity(name)
    if kinematics.dimensions < 3 or kinematics.bodies[name].frame.along:
        return spin
    return transform(kinematics.axes(name), spin)


def body_terms(scene):
    """Terms of R . dv/du + L . dw/du over the bodies, one list for each speed."""
    kinematics = scene.kinematics
    columns = []
    for name, wrench in newton_euler.resultants(scene).items():
        columns.append(works(kinematics, wrench.force, kinematics.velocity(name)))
        if wrench.moment:
            columns.append(works(kinematics, wrench.moment, spin_of(kinematics, name)))
    return list(zip(*columns, strict=True))


def elsewhere(scene):
    """Generalized forces of what acts on no body, one list for each speed."""
    kinematics, model = scene.kinematics, scene.model
    rows = [r for r in scene.rows if r.name in scene.kept]
    columns = [
        works(kinematics, e.force, e.velocity)
        for element, e in newton_euler_loads._elements(kinematics)
        if element.between is None
    ]
    columns += [
        works(kinematics, push.force, kinematics.velocity(push.point))
        for push in newton_euler_loads.pushes(scene)
        if newton_euler_tree.carrier(model, push.point).massless
    ]
    if rows:
        columns += [
            [multiplier * entry for entry in row.jacobian]
            for row, multiplier in zip(rows, scene.linked.multipliers, strict=True)
            if row.constraint.points is None
        ]
    zero = kinematics.algebra.number(0)
    return list(zip(*columns, strict=True)) or [(zero,)] * len(speeds.symbols(model))


def worst(scene, name, equations):
    """The worst of |sum| / sum of |terms| over the equations, at random states."""
    found = 0.0
    for at, _ in singly(scene, samples_of(name), FLOAT, STATES):
        for terms in equations:
            values = at.nodes(terms)
            scale = sum(abs(v) for v in values)
            found = max(found, abs(math.fsum(values)) / (scale or 1))
    return found


def balance(name):
    """Reactions' work less the work of what acts on no body, term by term: R = m a - F alone."""
    scene = scene_of(name)
    pairs = zip(body_terms(scene), elsewhere(scene), strict=True)
    return scene, [[*work, *(-q for q in given)] for work, given in pairs]


@pytest.mark.parametrize("name", [*FREE, *LINKED])
def test_forces_of_constraint_do_no_virtual_work(name):
    scene, equations = balance(name)
    scale = inertia_scale(scene, name)
    for at, largest in scale:
        for terms in equations:
            assert abs(math.fsum(at.nodes(terms))) <= 1e-12 * largest(terms, at)


def inertia_scale(scene, name):
    """(state, size of an equation there): its terms, and those of the bodies' m a and F."""
    matrix = [entry for row in scene.equations.mass_matrix for entry in row]
    other = [*scene.equations.bias, *scene.equations.generalized_forces, *scene.solution[0]]

    def largest(terms, at):
        values = [abs(v) for v in at.nodes([*terms, *other])]
        accelerations = max(abs(v) for v in at.nodes(scene.solution[0]))
        return sum(values) + accelerations * sum(abs(v) for v in at.nodes(matrix))

    return [(at, largest) for at, _ in singly(scene, samples_of(name), FLOAT, STATES)]


@pytest.mark.parametrize("name", [n for n in FREE if len(model_of(n).bodies) > 1])
def test_joint_forces_do_the_same_work_on_relative_velocities(name):
    """Sum over joints of F . d(v - v_parent) = sum over bodies of R . dv, for every speed."""
    scene = machine_of(name)
    kinematics = scene.kinematics
    tree = newton_euler_tree.joints(scene.model)
    found, own = newton_euler.joint_wrenches(scene, tree), newton_euler.resultants(scene)
    columns = []
    for joint in tree:
        velocity = kinematics.velocity(joint.body)
        columns.append([-w for w in works(kinematics, own[joint.body].force, velocity)])
        if joint.parent:
            velocity = subtract(velocity, kinematics.velocity(joint.parent))
        columns.append(works(kinematics, found[joint.body].force, velocity))
    equations = list(zip(*columns, strict=True))
    for at, largest in inertia_scale(scene, name):
        for terms in equations:
            assert abs(math.fsum(at.nodes(terms))) <= 1e-12 * largest(terms, at)


def material(kinematics, body, place):
    """The velocity of the place as a point of the body."""
    spin = spin_of(kinematics, body)
    arm = subtract(place, kinematics.origin(body))
    start = tuple(kinematics.rate(c) for c in kinematics.origin(body))
    if len(arm) == 2:
        return add(start, (-(spin[0] * arm[1]), spin[0] * arm[0]))
    return add(start, lever(spin, arm))


@pytest.mark.parametrize("name", FRAMES)
def test_each_joint_of_frames_transmits_no_work(name):
    """F . d(relative velocity at the joint) + M . d(relative spin) = 0, joint by joint."""
    scene = machine_of(name)
    kinematics = scene.kinematics
    parents = {j.body: j.parent for j in newton_euler_tree.joints(scene.model)}
    equations = []
    for reaction in newton_euler.reactions(scene):
        place = kinematics.origin(reaction.on)
        velocity, spin = material(kinematics, reaction.on, place), spin_of(kinematics, reaction.on)
        if parent := parents[reaction.on]:
            velocity = subtract(velocity, material(kinematics, parent, place))
            spin = subtract(spin, spin_of(kinematics, parent))
        columns = zip(partials(kinematics, velocity), partials(kinematics, spin), strict=True)
        equations += [[dot(reaction.force, v), dot(reaction.moment, w)] for v, w in columns]
    assert equations
    for at, largest in inertia_scale(scene, name):
        for terms in equations:
            assert abs(math.fsum(at.nodes(terms))) <= 1e-12 * largest(terms, at)


@pytest.mark.parametrize("name", [*FREE, "four_bar", "slider_crank", "parallelogram"])
def test_ground_reactions_and_applied_forces_change_the_momentum(name):
    """Sum of F_world + applied = d/dt sum(m v), of every load with its reaction."""
    scene = scene_of(name)
    kinematics = scene.kinematics
    tree = newton_euler_tree.joints(scene.model)
    found = newton_euler.joint_wrenches(scene, tree)
    shares = [found[j.body].force for j in tree if j.parent is None]
    shares += [newton_euler_loads.weight(kinematics, b.mass) for b in scene.model.bodies]
    shares += [
        p.force
        for p in newton_euler_loads.pushes(scene)
        if newton_euler_tree.carrier(scene.model, p.point).body
    ]
    for body in scene.model.bodies:
        momentum = scale(kinematics.algebra.of(body.mass), kinematics.velocity(body.name))
        shares.append(tuple(-r for r in newton_euler._rate(scene, momentum)))
    assert worst(scene, name, list(zip(*shares, strict=True))) < 1e-12


@pytest.mark.parametrize("name", SPATIAL)
def test_ground_reactions_change_the_angular_momentum(name):
    """Moments about the world's origin; d/dt (r x m v + R I w) is differentiated as it stands."""
    scene = machine_of(name)
    kinematics = scene.kinematics
    tree = newton_euler_tree.joints(scene.model)
    found = newton_euler.joint_wrenches(scene, tree)
    shares = []
    for joint in tree:
        if joint.parent is None:
            wrench = found[joint.body]
            arm = newton_euler.about(kinematics, joint)
            shares += [wrench.moment, lever(arm, wrench.force)]
    for push in newton_euler_loads.pushes(scene):
        if newton_euler_tree.carrier(scene.model, push.point).body:
            shares.append(lever(kinematics.position(push.point), push.force))
    shares += [twist.moment for twist in newton_euler_loads.twists(kinematics)]
    for body in scene.model.bodies:
        place, velocity = kinematics.position(body.name), kinematics.velocity(body.name)
        mass = kinematics.algebra.of(body.mass)
        momenta = [lever(place, scale(mass, velocity))]
        if spin := kinematics.spin(body):
            own = transform(spin.inertia, spin.angular_velocity)
            momenta.append(kinematics.to_world(own, body.name) if spin.gyroscopic else own)
        shares.append(lever(place, newton_euler_loads.weight(kinematics, body.mass)))
        shares += [tuple(-r for r in newton_euler._rate(scene, m)) for m in momenta]
    assert worst(scene, name, list(zip(*shares, strict=True))) < 1e-12


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


def of_text(text):
    return compile.machine_of(read(text, "own.yaml"))


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


def test_the_machine_without_kept_rows_has_no_multipliers():
    scene = scene_of("four_bar")
    assert scene.kept
    loose = replace(scene, kept=())
    ends = [p for p in newton_euler_loads.pushes(loose) if p.name == "loop"]
    assert all(loose.kinematics.algebra.is_zero(f) for p in ends for f in p.force)
