"""Trees in floats, with the axes of each link as they are, or turned to have joints about z."""

from __future__ import annotations

from dataclasses import dataclass
from math import isqrt
from typing import Any

import numpy as np

from lab.trees import Link, Tree

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Placed:
    """A link: base (3, 3) turns own components to the parent's where the coordinate is zero."""

    parent: int
    slides: bool
    axis: Array  # (3,), unit, in own axes
    base: Array
    place: Array  # of the joint, in the parent's axes
    mass: float
    com: Array
    inertia: Array  # (3, 3) about the mass centre


def plain(tree: Tree) -> list[Placed]:
    """The links with axes parallel to their parents' where all coordinates are zero."""
    return [_placed(link) for link in tree.links]


def _placed(link: Link) -> Placed:
    xx, yy, zz, xy, xz, yz = (float(v) for v in link.inertia)
    return Placed(
        parent=link.parent,
        slides=link.joint == "slide",
        axis=np.array(link.axis) / isqrt(sum(a * a for a in link.axis)),
        base=np.eye(3),
        place=np.array([float(v) for v in link.place]),
        mass=float(link.mass),
        com=np.array([float(v) for v in link.com]),
        inertia=np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]),
    )


def is_straight(axis: Array) -> bool:
    """Whether a unit vector lies along a coordinate axis."""
    return bool(np.count_nonzero(axis) == 1)


def aligned(tree: Tree) -> list[Placed]:
    """The links with own axes turned so that every joint that is skew to them has its axis z."""
    own: list[Array] = []
    result = []
    for link in plain(tree):
        turned = np.eye(3) if is_straight(link.axis) else _frame(link.axis)
        before = own[link.parent] if link.parent >= 0 else np.eye(3)
        own.append(turned)
        result.append(
            Placed(
                link.parent,
                link.slides,
                turned.T @ link.axis if is_straight(link.axis) else np.array([0.0, 0.0, 1.0]),
                before.T @ turned,
                before.T @ link.place,
                link.mass,
                turned.T @ link.com,
                turned.T @ link.inertia @ turned,
            )
        )
    return result


def _frame(axis: Array) -> Array:
    """A rotation whose third column is the axis."""
    across = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    across /= np.linalg.norm(across)
    return np.column_stack([np.cross(across, axis), across, axis])
