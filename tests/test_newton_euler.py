"""Newton-Euler: forces of constraint do no virtual work."""

import math
from dataclasses import replace
from functools import cache

import pytest
from scenes import FILES, machine_of, model_of, samples_of

from eomgen import compile
from eomgen.algebra.arithmetic import FLOAT
from eomgen.analysis import cards
from eomgen.checks.evaluation import singly
from eomgen.formulation import linked
from eomgen.mechanics import (
    newton_euler,
    newton_euler_inside,
    newton_euler_loads,
    newton_euler_tree,
    speeds,
)
from eomgen.mechanics.newton_euler import lever
from eomgen.mechanics.vectors import add, dot, scale, subtract, transform
from eomgen.spec import read

BODIES = [name for name in FILES if model_of(name).bodies]
FREE = [name for name in BODIES if not model_of(name).constraints]
SLOW = ("bricard",)  # its constraints are analysed for some seconds
LINKED = [
    pytest.param(name, marks=pytest.mark.slow) if name in SLOW else name
    for name in BODIES
    if model_of(name).constraints
]
FRAMES = ["manipulator", "two_link_arm", "gyroscope", "heavy_top", "skew_arm", "flyball_governor"]
SPATIAL = ["skew_arm", "gyroscope", "spatial_tree", "spatial_rod", "furuta_pendulum"]
STATES = 5


@cache
def scene_of(name):
    """The machine of a scene, with the independent rows where it is linked."""
    machine = machine_of(name)
    return linked(machine, cards.report(machine)).machine if machine.rows else machine


def of_text(text):
    return compile.machine_of(read(text, "own.yaml"))


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
        if element.between is None and newton_euler_inside.of(model, element.along) is None
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


def test_the_machine_without_kept_rows_has_no_multipliers():
    scene = scene_of("four_bar")
    assert scene.kept
    loose = replace(scene, kept=())
    ends = [p for p in newton_euler_loads.pushes(loose) if p.name == "loop"]
    assert all(loose.kinematics.algebra.is_zero(f) for p in ends for f in p.force)
