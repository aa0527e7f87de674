"""Forward dynamics of a tree in CasADi's SX, as an expert writes it, in body axes.

Featherstone, Rigid Body Dynamics Algorithms (2008), chapters 5-7, with 3-vectors in place of 6-D
ones and with classical accelerations of the joints (Luh, Walker and Paul's form), so that no linear
velocity is ever formed. Constants are numbers, rotations about coordinate axes are sparse, and of
symmetric matrices one half is computed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import casadi as ca
import numpy as np

from lab.frames import Array, Placed, is_straight
from lab.trees import Tree

SX = Any


@dataclass(frozen=True)
class Joint:
    """A link in SX: what it carries, its axis e, and how it moves."""

    parent: int
    slides: bool
    axis: SX  # (3,)
    place: SX  # (3,) in the parent's axes, for a slide with the coordinate
    turn: SX  # (3, 3), own components to the parent's
    base: Array  # (3, 3), what is constant in it, on the left
    straight: tuple[int, SX, SX] | None  # a turn about a coordinate axis: which, cos, sin
    mass: float
    moment: SX  # h = m c (3,)
    inertia: SX  # (3, 3) about the joint
    rate: SX
    spin: SX = None  # w
    swirl: SX = None  # w x (w x .) as a matrix
    bias: tuple[SX, SX] = (None, None)  # acceleration that the rates alone cause


def vector(values: Any) -> SX:
    """A constant vector whose zeros are structural."""
    return ca.sparsify(ca.SX([float(v) for v in values]))


def symmetric(matrix: SX) -> SX:
    """The matrix with its upper half copied from the lower one."""
    return ca.tril2symm(ca.tril(matrix))


def scaled(value: SX, reciprocal: SX) -> SX:
    """The product, kept as one: CasADi would turn x (1/d) into a division for every x."""
    value = ca.sparsify(value)
    ca.GlobalOptions.setSimplificationOnTheFly(False)
    product = value * reciprocal
    ca.GlobalOptions.setSimplificationOnTheFly(True)
    return product


def _rotation(axis: SX, c: SX, s: SX) -> SX:
    """Rodrigues' matrix; with structural zeros for a coordinate axis."""
    straight = axis @ axis.T
    return ca.sparsify(straight + c * (ca.SX.eye(3) - straight) + s * ca.skew(axis))


def turned(joint: Joint, matrix: SX) -> SX:
    """R X R', about a coordinate axis with four products for its block, not sixteen."""
    if joint.slides:
        return matrix
    if joint.straight is None:
        return joint.turn @ matrix @ joint.turn.T
    k, c, s = joint.straight
    i, j = (k + 1) % 3, (k + 2) % 3
    result = ca.SX(matrix)
    mixed = s * (matrix[j, j] - matrix[i, i]) - c * (matrix[i, j] + matrix[j, i])
    result[i, i], result[j, j] = matrix[i, i] + s * mixed, matrix[j, j] - s * mixed
    result[i, j] = -c * mixed - matrix[j, i]
    result[j, i] = -c * mixed - matrix[i, j]
    result[k, i] = c * matrix[k, i] - s * matrix[k, j]
    result[k, j] = s * matrix[k, i] + c * matrix[k, j]
    result[i, k] = c * matrix[i, k] - s * matrix[j, k]
    result[j, k] = s * matrix[i, k] + c * matrix[j, k]
    if np.array_equal(joint.base, np.eye(3)):
        return ca.sparsify(result)
    return joint.base @ result @ joint.base.T


def joints(links: list[Placed], q: SX, rates: SX) -> list[Joint]:
    """The links at coordinates q, moving with `rates`."""
    found: list[Joint] = []
    for i, link in enumerate(links):
        joint = _at_rest(link, q[i], rates[i])
        found.append(_moving(joint, found[link.parent] if link.parent >= 0 else None))
    return found


def _at_rest(link: Placed, q: SX, rate: SX) -> Joint:
    axis, place, com = vector(link.axis), vector(link.place), link.com
    base = ca.sparsify(ca.SX(link.base))
    about_joint = link.inertia + link.mass * (com @ com * np.eye(3) - np.outer(com, com))
    c, s = (None, None) if link.slides else (ca.cos(q), ca.sin(q))
    straight = not link.slides and is_straight(link.axis)
    return Joint(
        parent=link.parent,
        slides=link.slides,
        axis=axis,
        place=place + base @ axis * q if link.slides else place,
        turn=base if link.slides else base @ _rotation(axis, c, s),
        base=link.base,
        straight=(int(link.axis.argmax()), c, s) if straight else None,
        mass=link.mass,
        moment=vector(link.mass * com),
        inertia=ca.sparsify(ca.SX(about_joint)),
        rate=rate,
    )


def _moving(joint: Joint, parent: Joint | None) -> Joint:
    """The joint with its spin; c = (e' x w q', w x (w x r)), for a slide 2 w x e q' as well."""
    zero = ca.SX(3, 1)
    before = zero if parent is None else joint.turn.T @ parent.spin
    own = joint.axis * joint.rate
    linear = zero if parent is None else joint.turn.T @ (parent.swirl @ joint.place)
    if joint.slides:
        swirl = ca.SX(3, 3) if parent is None else parent.swirl
        return replace(
            joint, spin=before, swirl=swirl, bias=(zero, linear + 2 * ca.cross(before, own))
        )
    spin = before + own
    square = spin @ spin.T
    swirl = symmetric(square - ca.trace(square) * ca.SX.eye(3))
    return replace(joint, spin=spin, swirl=swirl, bias=(ca.cross(before, own), linear))


Solver = Callable[[Tree, list[Joint], SX], list[SX]]


def function(tree: Tree, links: list[Placed], solver: Solver, name: str = "fd") -> ca.Function:
    """(state, inputs) -> accelerations."""
    n = len(links)
    state, inputs = ca.SX.sym("x", 2 * n), ca.SX.sym("u", len(tree.driven))
    efforts = ca.SX(n, 1)
    for i, joint in enumerate(tree.driven):
        efforts[joint] = inputs[i]
    solution = solver(tree, joints(links, state[:n], state[n:]), efforts)
    return ca.Function(name, [state, inputs], [ca.densify(ca.vertcat(*solution))])
