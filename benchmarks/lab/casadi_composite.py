"""Composite inertias, recursive Newton-Euler and L' D L in SX (Featherstone 2008, 5.3 and 6.2)."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from lab.casadi_spatial import SX, Joint, scaled, symmetric, turned, vector
from lab.trees import Tree


@dataclass
class Lump:
    """Bodies that move as one: mass, h = m c and the inertia about the joint."""

    mass: float
    moment: SX
    inertia: SX


def solve(tree: Tree, joints: list[Joint], efforts: SX) -> list[SX]:
    """The accelerations of the coordinates."""
    right = [efforts[i] - h for i, h in enumerate(bias(tree, joints))]
    return solved(mass_matrix(joints), right)


def bias(tree: Tree, joints: list[Joint]) -> list[SX]:
    """h of M q'' + h = tau: what moves the joints where q'' = 0."""
    motions: list[tuple[SX, SX]] = []
    wrenches: list[list[SX]] = []
    ground = ca.SX(3, 1), vector([-g for g in tree.gravity])
    for joint in joints:
        above = ground if joint.parent < 0 else motions[joint.parent]
        turning = joint.turn.T @ above[0] + joint.bias[0]
        moving = joint.turn.T @ (above[1] + ca.cross(above[0], joint.place)) + joint.bias[1]
        motions.append((turning, moving))
        wrenches.append(_needed(joint, turning, moving))
    return _inward(joints, wrenches)


def _needed(joint: Joint, turning: SX, moving: SX) -> list[SX]:
    """The torque about the joint and the force that a body needs."""
    stir = joint.swirl + ca.skew(turning)
    momentum = joint.inertia @ joint.spin
    gyroscopic = ca.cross(joint.spin, momentum)
    torque = joint.inertia @ turning + gyroscopic + ca.cross(joint.moment, moving)
    return [torque, joint.mass * moving + stir @ joint.moment]


def _inward(joints: list[Joint], wrenches: list[list[SX]]) -> list[SX]:
    result = [ca.SX(0)] * len(joints)
    for i in reversed(range(len(joints))):
        joint, (torque, force) = joints[i], wrenches[i]
        result[i] = joint.axis.T @ (force if joint.slides else torque)
        if joint.parent >= 0:
            carried = _carried(joint, torque, force)
            wrenches[joint.parent] = [
                old + new for old, new in zip(wrenches[joint.parent], carried, strict=True)
            ]
    return result


def _carried(joint: Joint, torque: SX, force: SX) -> tuple[SX, SX]:
    """A wrench at the joint as one at the parent's joint, in its axes."""
    turned = joint.turn @ force
    return joint.turn @ torque + ca.cross(joint.place, turned), turned


def mass_matrix(joints: list[Joint]) -> list[dict[int, SX]]:
    """The rows of M below the diagonal, with it: row i holds the columns of i's ancestors."""
    lumps = [Lump(j.mass, j.moment, j.inertia) for j in joints]
    rows: list[dict[int, SX]] = [{} for _ in joints]
    for i in reversed(range(len(joints))):
        _row(joints, i, lumps[i], rows[i])
        if joints[i].parent >= 0:
            _collect(joints[i], lumps[i], lumps[joints[i].parent])
    return rows


def _row(joints: list[Joint], i: int, lump: Lump, row: dict[int, SX]) -> None:
    """The wrench that accelerates joint i alone, seen by every joint before it."""
    axis = joints[i].axis
    if joints[i].slides:
        torque, force = ca.cross(lump.moment, axis), lump.mass * axis
    else:
        torque, force = lump.inertia @ axis, ca.cross(axis, lump.moment)
    j = i
    while j >= 0:
        row[j] = joints[j].axis.T @ (force if joints[j].slides else torque)
        torque, force = _carried(joints[j], torque, force)
        j = joints[j].parent


def _collect(joint: Joint, lump: Lump, parent: Lump) -> None:
    """Add a lump to its parent, about the parent's joint and in its axes."""
    arm, moment = ca.skew(joint.place), joint.turn @ lump.moment
    hat = ca.skew(moment)
    shift = arm @ hat + hat @ arm + lump.mass * (arm @ arm)
    parent.mass = parent.mass + lump.mass
    parent.moment = parent.moment + moment + lump.mass * joint.place
    parent.inertia = symmetric(parent.inertia + turned(joint, lump.inertia) - shift)


def solved(rows: list[dict[int, SX]], right: list[SX]) -> list[SX]:
    """M^-1 b by L' D L from the leaves to the root, which fills nothing in."""
    reciprocals: list[SX] = [None] * len(rows)
    for k in reversed(range(len(rows))):
        reciprocals[k] = 1 / rows[k][k]
        before = [j for j in rows[k] if j != k]
        for i in before:
            entry = scaled(rows[k][i], reciprocals[k])
            for j in before:
                if j <= i:
                    rows[i][j] = rows[i][j] - entry * rows[k][j]
            right[i] = right[i] - entry * right[k]
    solution: list[SX] = []
    for k, row in enumerate(rows):
        known = sum((row[j] * solution[j] for j in row if j != k), ca.SX(0))
        solution.append(scaled(right[k] - known, reciprocals[k]))
    return solution
