"""Newton-Euler, component by component: the forces that hold each body.

R = m a - F          resultant of the forces of constraint on a body [N], world axes
L = d(I w)/dt - M    their moment about its mass centre [N m], world axes; one component in a plane

F and M are applied: weights, springs, dampers, forces, moments, and the forces of constraints that
join two points. Through the joint between a body and its parent go the sums over all that hangs
on it (recursive Newton-Euler; Featherstone, Rigid Body Dynamics Algorithms, 5.3):

F_joint = sum R,   M_joint = sum (L + (r - p) x R)   about the point p of the joint.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Generic

import sympy as sp

from eomgen.algebra.graph import Node
from eomgen.algebra.scalar import S
from eomgen.mechanics import (
    newton_euler_inside,
    newton_euler_loads,
    newton_euler_tree,
    newton_euler_unknown,
    speeds,
)
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.newton_euler_loads import Scene
from eomgen.mechanics.newton_euler_tree import Joint
from eomgen.mechanics.vectors import Vector, add, cross, scale, subtract, transform
from eomgen.model import Body


@dataclass(frozen=True)
class Wrench(Generic[S]):
    """A force [N] and a moment [N m] on a body, in world axes; no moment on a line."""

    force: Vector[S]
    moment: Vector[S]  # one component in a plane


@dataclass(frozen=True)
class JointReaction:
    """What holds a body, and all that hangs on it, to its parent."""

    name: str  # parent/body, such as slider/bob; world/slider
    on: str  # the body
    about: str  # the point that the moment is about, in words
    force: Vector[Node]
    moment: Vector[Node]
    together_with: tuple[str, ...]  # bodies that are moved by the same coordinates: what ties them
    # to this one is not in the tree, and acts in the resultants of both


def resultants(scene: Scene) -> dict[str, Wrench[Node]]:
    """R and L, about the mass centre, of every body; what cannot be attributed is in them."""
    kinematics = scene.kinematics
    found = {b.name: _inertia(scene, b) for b in kinematics.model.bodies}
    for push in newton_euler_loads.pushes(scene):
        body = newton_euler_tree.carrier(kinematics.model, push.point).body
        if body is not None:
            arm = subtract(kinematics.position(push.point), kinematics.position(body))
            found[body] = _less(found[body], Wrench(push.force, lever(arm, push.force)))
    for twist in newton_euler_loads.twists(kinematics):
        none = tuple(kinematics.algebra.number(0) for _ in range(kinematics.dimensions))
        found[twist.body] = _less(found[twist.body], Wrench(none, twist.moment))
    for joint, effort in newton_euler_loads.inside(kinematics):
        force, moment = newton_euler_inside.wrench(kinematics, joint, effort)
        origin = kinematics.origin(joint.body)
        for body, sign in ((joint.body, 1), (joint.parent, -1)):
            if body is not None:
                arm = subtract(origin, kinematics.position(body))
                both = add(lever(arm, force), moment)
                acting = Wrench(tuple(sign * f for f in force), tuple(sign * m for m in both))
                found[body] = _less(found[body], acting)
    return found


def _less(total: Wrench[Node], applied: Wrench[Node]) -> Wrench[Node]:
    return Wrench(subtract(total.force, applied.force), subtract(total.moment, applied.moment))


def _inertia(scene: Scene, body: Body) -> Wrench[Node]:
    """M (a - g) and d(I w)/dt."""
    kinematics = scene.kinematics
    acceleration = _rate(scene, kinematics.velocity(body.name))
    momentum = scale(kinematics.algebra.of(body.mass), acceleration)
    force = subtract(momentum, newton_euler_loads.weight(kinematics, body.mass))
    return Wrench(force, _spin_rate(scene, body))


def _rate(scene: Scene, values: Vector[Node]) -> Vector[Node]:
    """The time derivative on the motion."""
    kinematics = scene.kinematics
    pairs = zip(speeds.symbols(kinematics.model), scene.solution[0], strict=True)
    motion: dict[sp.Symbol, Node] = dict(kinematics.flow.derivatives) | dict(pairs)
    return tuple(kinematics.algebra.along(v, motion) for v in values)


def _spin_rate(scene: Scene, body: Body) -> Vector[Node]:
    """I w' + w x I w of a body in its axes, then in the world's; zero for a particle."""
    kinematics = scene.kinematics
    spin = kinematics.spin(body)
    if spin is None:
        count = {1: 0, 2: 1, 3: 3}[kinematics.dimensions]
        return tuple(kinematics.algebra.number(0) for _ in range(count))
    w = spin.angular_velocity
    moment = transform(spin.inertia, _rate(scene, w))
    if not spin.gyroscopic:
        return moment
    moment = add(moment, cross(w, transform(spin.inertia, w)))
    return kinematics.to_world(moment, body.name)


def lever(arm: Vector[S], force: Vector[S]) -> Vector[S]:
    """The moment arm x force: none on a line, one component in a plane."""
    if len(arm) == 3:
        return cross(arm, force)
    return (arm[0] * force[1] - arm[1] * force[0],) if len(arm) == 2 else ()


def joint_wrenches(scene: Scene, tree: Sequence[Joint]) -> dict[str, Wrench[Node]]:
    """The sums over all that hangs on each joint, about the joint's point, by the body's name."""
    return carried(scene.kinematics, resultants(scene), tree)


def carried(
    kinematics: Kinematics[S], single: Mapping[str, Wrench[S]], tree: Sequence[Joint]
) -> dict[str, Wrench[S]]:
    """What each joint holds: `single` is about the mass centre of each body alone."""
    found = dict(single)
    places = {j.body: about(kinematics, j) for j in tree}
    for name, wrench in found.items():
        arm = subtract(kinematics.position(name), places[name])
        found[name] = Wrench(wrench.force, add(wrench.moment, lever(arm, wrench.force)))
    for joint in reversed(tree):  # children before parents
        if joint.parent is not None:
            arm = subtract(places[joint.body], places[joint.parent])
            child, parent = found[joint.body], found[joint.parent]
            moment = add(child.moment, lever(arm, child.force))
            found[joint.parent] = Wrench(add(parent.force, child.force), add(parent.moment, moment))
    return found


def about(kinematics: Kinematics[S], joint: Joint) -> Vector[S]:
    """The place of the point that a joint's moment is about."""
    if joint.point is None:
        return kinematics.origin(joint.body)
    return kinematics.position(joint.point)


def reactions(scene: Scene) -> tuple[JointReaction, ...]:
    """The reaction of every joint whose loads can all be attributed to bodies."""
    model = scene.kinematics.model
    tree = newton_euler_tree.joints(model)
    unknown = {left.on for left in newton_euler_unknown.left_out(scene)}
    found = joint_wrenches(scene, tree)
    return tuple(
        JointReaction(
            name=newton_euler_unknown.name_of(joint),
            on=joint.body,
            about=_words(scene.kinematics, joint),
            force=found[joint.body].force,
            moment=found[joint.body].moment,
            together_with=newton_euler_tree.companions(model, tree, joint),
        )
        for joint in tree
        if joint.body not in unknown
    )


def _words(kinematics: Kinematics[Node], joint: Joint) -> str:
    if joint.point is not None:
        return joint.point
    com = kinematics.bodies[joint.body].com
    centred = com.on == joint.body and all(c == 0 for c in com.components)
    return f"{'mass centre' if centred else 'origin'} of {joint.body}"
