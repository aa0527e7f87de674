"""The articulated-body method in SX (Featherstone 2008, section 7.3), with 3x3 blocks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import casadi as ca

from lab.casadi_spatial import SX, Joint, scaled, symmetric, turned, vector
from lab.trees import Tree


@dataclass
class Body:
    """An articulated body: torque = I alpha + H a + n, force = H' alpha + M a + f."""

    rotational: SX
    coupling: SX
    linear: SX
    torque: SX
    force: SX


def solve(tree: Tree, joints: list[Joint], efforts: SX) -> list[SX]:
    """The accelerations of the coordinates."""
    bodies = [_alone(joint) for joint in joints]
    kept: list[Any] = [None] * len(joints)
    for i in reversed(range(len(joints))):
        joint = joints[i]
        kept[i] = _projected(joint, bodies[i], efforts[i])
        if joint.parent >= 0:
            _carry(joint, bodies[i], bodies[joint.parent])
    return _outward(tree, joints, kept)


def _alone(joint: Joint) -> Body:
    """A body's own inertia and the torque and force of its spin."""
    hat = ca.skew(joint.moment)
    return Body(
        rotational=joint.inertia,
        coupling=hat,
        linear=joint.mass * ca.SX.eye(3) if joint.mass else ca.SX(3, 3),
        torque=ca.cross(joint.spin, joint.inertia @ joint.spin),
        force=joint.swirl @ joint.moment,
    )


def _projected(joint: Joint, body: Body, effort: SX) -> tuple[SX, SX, SX, SX]:
    """Free the joint: I -= U U' / D and p += I c + U u / D; what the outward sweep needs."""
    axis = joint.axis
    if joint.slides:
        angular, linear = body.coupling @ axis, body.linear @ axis
        inertia, rest = axis.T @ linear, effort - axis.T @ body.force
    else:
        angular, linear = body.rotational @ axis, body.coupling.T @ axis
        inertia, rest = axis.T @ angular, effort - axis.T @ body.torque
    reciprocal = 1 / inertia
    first, second = scaled(angular, reciprocal), scaled(linear, reciprocal)
    body.rotational = symmetric(body.rotational - first @ angular.T)
    body.coupling = body.coupling - first @ linear.T
    body.linear = symmetric(body.linear - second @ linear.T)
    _clear(joint, body)
    turning, moving = joint.bias
    body.torque = body.torque + body.rotational @ turning + body.coupling @ moving + first * rest
    body.force = body.force + body.coupling.T @ turning + body.linear @ moving + second * rest
    return angular, linear, reciprocal, rest


def _clear(joint: Joint, body: Body) -> None:
    """Nothing resists along a free coordinate axis: those entries are zeros, not differences."""
    if joint.axis.nnz() > 1:
        return
    k = joint.axis.sparsity().row()[0]
    keep = ca.SX.eye(3)
    keep[k, k] = 0
    keep = ca.sparsify(keep)
    if joint.slides:
        body.linear, body.coupling = keep @ body.linear @ keep, body.coupling @ keep
    else:
        body.rotational, body.coupling = keep @ body.rotational @ keep, keep @ body.coupling


def _carry(joint: Joint, body: Body, parent: Body) -> None:
    """Add a freed body to its parent, at the parent's joint and in its axes."""
    arm = ca.skew(joint.place)
    linear = symmetric(turned(joint, body.linear))
    shifted = turned(joint, body.coupling)
    coupling = shifted + arm @ linear
    rotational = symmetric(turned(joint, body.rotational) - shifted @ arm + arm @ coupling.T)
    force = joint.turn @ body.force
    parent.rotational = parent.rotational + rotational
    parent.coupling = parent.coupling + coupling
    parent.linear = parent.linear + linear
    parent.torque = parent.torque + joint.turn @ body.torque + ca.cross(joint.place, force)
    parent.force = parent.force + force


def _outward(tree: Tree, joints: list[Joint], kept: list[Any]) -> list[SX]:
    """q'' = (u - U' a) / D, from the root, where a = -g."""
    motions: list[tuple[SX, SX]] = []
    solution: list[SX] = []
    ground = ca.SX(3, 1), vector([-g for g in tree.gravity])
    for joint, (angular, linear, reciprocal, rest) in zip(joints, kept, strict=True):
        turning, moving = ground if joint.parent < 0 else motions[joint.parent]
        moving = joint.turn.T @ (moving + ca.cross(turning, joint.place)) + joint.bias[1]
        turning = joint.turn.T @ turning + joint.bias[0]
        known = angular.T @ turning + linear.T @ moving
        solution.append(scaled(rest - known, reciprocal))
        step = joint.axis * solution[-1]
        slid, turned = (turning, moving + step), (turning + step, moving)
        motions.append(slid if joint.slides else turned)
    return solution
