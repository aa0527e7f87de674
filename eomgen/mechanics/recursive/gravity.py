"""Weights, and energies, of a tree of frames in space: sums from the leaves to the root.

What hangs on a place has a mass m and a first moment h about its origin. Gravity g, in the axes
of the place, pulls it with the wrench (h x g, m g); on what stands on the ground, with its origin
at r, V = -g . (h + m r).
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.algebra import cost
from eomgen.algebra.graph import Node
from eomgen.mechanics import energies
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive.formulas import Clock
from eomgen.mechanics.recursive.records import GROUND, SpatialFrame, Tree
from eomgen.mechanics.recursive.rigid import Rigid
from eomgen.mechanics.recursive.steps import Flat, FreeRotation, Shift, Step, forward
from eomgen.mechanics.vectors import Vector, add, cross, dot, scale, transform

Hanging = list[tuple[Node, Vector[Node]]]  # on each place: mass and first moment


def is_of_frames(tree: Tree) -> bool:
    """Whether all that moves are frames in space, none of them turned by a quaternion."""
    steps = [step for place in tree.places for step in place.steps]
    return (
        all(isinstance(place.kind, SpatialFrame) for place in tree.places)
        and not any(isinstance(step, Flat | FreeRotation) for step in steps)
        and tree.places[GROUND].body is None
    )


def hanging(tree: Tree) -> Hanging:
    """Mass [kg] and first moment [kg m] of everything that stands on a place, in its axes."""
    zero = tree.gravity[0].graph.zero
    found: Hanging = [
        (zero, (zero,) * 3) if place.body is None else (place.body.mass, place.body.first)
        for place in tree.places
    ]
    for joint in reversed(tree.joints):
        for number in joint.places:
            place, (mass, first) = tree.places[number], found[number]
            if place.base == GROUND:
                continue
            for step in reversed(place.steps):
                first = _moved_back(step, mass, first)
            before = found[place.base]
            found[place.base] = (before[0] + mass, add(before[1], first))
    return found


def _moved_back(step: Step, mass: Node, first: Vector[Node]) -> Vector[Node]:
    """h + m r before a shift, R h before a turn."""
    if isinstance(step, Shift):
        return add(first, scale(mass, step.arm))
    return step.force((*(mass.graph.zero,) * 3, *first))[3:]


def potential(kinematics: Kinematics[Node], tree: Tree) -> Node:
    """V of all weights [J], of a tree of frames that is not lumped."""
    zero = tree.gravity[0].graph.zero
    total = zero
    for place, (mass, first) in zip(tree.places, hanging(tree), strict=True):
        if place.base == GROUND and place.steps:
            for step in reversed(place.steps):
                first = _moved_back(step, zero, first)
            # the tree does not know where in the world its roots stand
            is_frame = tree.frames.get(place.name, GROUND) != GROUND
            origin = (kinematics.origin if is_frame else kinematics.position)(place.name)
            total = total - dot(tree.gravity, add(first, scale(mass, origin)))
    return total


def weights(tree: Tree) -> tuple[Node, ...]:
    """The generalized forces of all weights, S' (h x g, m g), of a tree of frames."""
    zero, whole = tree.gravity[0].graph.zero, hanging(tree)
    falling: list[Vector[Node]] = [(*(zero,) * 3, *tree.gravity)] * len(tree.places)
    found = [zero] * len(tree.order)
    for joint in tree.joints:
        for number in joint.places:
            place, (mass, first) = tree.places[number], whole[number]
            falling[number] = forward(place.steps, falling[place.base])
            pull = falling[number][3:]
            wrench = (*cross(first, pull), *scale(mass, pull))
            for c, column in place.columns.items():
                found[c] = found[c] + dot(column, wrench)
    return tuple(found)


def shortest(
    kinematics: Kinematics[Node], tree: Tree, lumped: Tree, known: tuple[Node, Node]
) -> tuple[Node, Node]:
    """T and V as `known`, or from the tree where that takes fewer operations."""
    if not is_of_frames(tree):
        return known
    others = [s.value for s in energies.potential(kinematics) if s.kind != "gravity"]
    found = kinetic(lumped), sum(others, potential(kinematics, tree))
    prepared = Clock(kinematics).constant_bits
    return min(known, found, key=lambda pair: cost.operations(pair, prepared))


def kinetic(tree: Tree) -> Node:
    """T = sum of 1/2 (w . (J w + 2 h x v) + m v . v) over a tree of frames [J]."""
    zero = tree.gravity[0].graph.zero
    velocities: list[Vector[Node]] = [(zero,) * 3] * len(tree.places)
    twice = zero
    for joint in tree.joints:
        for number in joint.places:
            place = tree.places[number]
            velocities[number] = _velocity(place.steps, velocities[place.base])
            if place.body is not None and isinstance(place.kind, SpatialFrame):
                twice = twice + _twice(place.body, place.kind.spin, velocities[number])
    return twice / 2


def _velocity(steps: Sequence[Step], velocity: Vector[Node]) -> Vector[Node]:
    """The velocity of an origin: v + w x r + r' after a shift, R' v after a turn."""
    still = (velocity[0].graph.zero,) * 3
    for step in steps:
        if isinstance(step, Shift):
            velocity = add(add(velocity, cross(step.spin, step.arm)), step.rate)
        else:
            velocity = step.motion((*still, *velocity))[3:]
    return velocity


def _twice(body: Rigid, spin: Vector[Node], velocity: Vector[Node]) -> Node:
    """Twice the kinetic energy of one body."""
    swept = cross(tuple(h * 2 for h in body.first), velocity)
    turning = dot(spin, add(transform(body.second, spin), swept))
    return turning + body.mass * dot(velocity, velocity)
