"""Inverse dynamics and the mass matrix by recursion over a tree of places.

Source: Featherstone, Rigid Body Dynamics Algorithms (2008): recursive Newton-Euler (ch. 5) and the
composite-rigid-body algorithm (ch. 6), each place of a joint with its own S.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from eomgen.algebra.graph import Node
from eomgen.mechanics.recursive.records import GROUND, Joint, Place, Point, Tree
from eomgen.mechanics.recursive.rigid import Rigid, product
from eomgen.mechanics.recursive.steps import back
from eomgen.mechanics.vectors import Matrix, Vector, add, dot, scale, transform


def accelerations(
    tree: Tree, falling: bool, second: Sequence[Node] | None = None
) -> list[Vector[Node]]:
    """The acceleration of every place, a_i = X a_base + S q'' + the terms of velocities.

    falling: the ground accelerates by -g, which acts as weight does; second: q'', zero if None.
    """
    ground = _ground(tree, falling)
    found = [ground] * len(tree.places)
    for joint in tree.joints:
        for number in joint.places:
            place = tree.places[number]
            value = found[place.base]
            for step in place.steps:
                value = step.accelerated(value)
            for c, column in place.columns.items():
                if second is not None:
                    value = add(value, scale(second[c], column))
            found[number] = value
    return found


def _ground(tree: Tree, falling: bool) -> Vector[Node]:
    zero = tree.gravity[0].graph.zero
    linear = tuple(-g for g in tree.gravity) if falling else (zero,) * len(tree.gravity)
    spins = tree.places[GROUND].kind.size - len(linear)
    return (*(zero,) * spins, *linear)


@dataclass(frozen=True)
class Loads:
    """Everything applied but the weights: on places as wrenches, on coordinates as forces."""

    wrenches: Mapping[int, Vector[Node]]
    forces: tuple[Node, ...]


def inverse_dynamics(
    tree: Tree, falling: bool, second: Sequence[Node] | None = None, loads: Loads | None = None
) -> tuple[Node, ...]:
    """The forces M q'' + h that a motion takes, less weights (where `falling`) and `loads`.

    Rows are those of the coordinates; with `second` = None it is the bias h.
    """
    rows = gathered(tree, wrenches(tree, falling, second, loads))
    if loads is None:
        return rows
    return tuple(row - force for row, force in zip(rows, loads.forces, strict=True))


def wrenches(
    tree: Tree, falling: bool, second: Sequence[Node] | None = None, loads: Loads | None = None
) -> list[Vector[Node] | None]:
    """The wrench that every place needs for the motion of its body, less what is applied to it."""
    found = accelerations(tree, falling, second)
    result = [
        None if place.body is None else place.kind.wrench(place.body, found[i])
        for i, place in enumerate(tree.places)
    ]
    for number, applied in () if loads is None else loads.wrenches.items():
        result[number] = _sum(result[number], tuple(-w for w in applied))
    return result


def gathered(tree: Tree, applied: Sequence[Vector[Node] | None]) -> tuple[Node, ...]:
    """The force of every coordinate, from wrenches on places: S' w, and X' w for the base."""
    felt = list(applied)
    zero = tree.gravity[0].graph.zero
    result = [zero] * len(tree.order)
    for joint in reversed(tree.joints):
        for number in joint.places:
            wrench, place = felt[number], tree.places[number]
            if wrench is None:
                continue
            for c, column in place.columns.items():
                result[c] = result[c] + dot(column, wrench)
            if place.base != GROUND:
                felt[place.base] = _sum(felt[place.base], back(place.steps, wrench))
    return tuple(result)


def _sum(before: Vector[Node] | None, more: Vector[Node]) -> Vector[Node]:
    return more if before is None else add(before, more)


Inertia = Rigid | Matrix[Node]


def composites(tree: Tree) -> list[Inertia | None]:
    """The inertia of everything that stands on a place, joints frozen, the place included."""
    found: list[Inertia | None] = [place.body for place in tree.places]
    for joint in reversed(tree.joints):
        for number in joint.places:
            own, place = found[number], tree.places[number]
            if own is not None and place.base != GROUND:
                base = tree.places[place.base]
                found[place.base] = together(base, found[place.base], moved_back(place, own))
    return found


def moved_back(place: Place, inertia: Inertia) -> Inertia:
    """An inertia of a place, as its base feels it with the joint frozen."""
    for step in reversed(place.steps):
        if isinstance(inertia, Rigid):
            rigid = step.rigid(inertia)
            inertia = step.inertia(place.kind.matrix(inertia)) if rigid is None else rigid
        else:
            inertia = step.inertia(inertia)
    return inertia


def together(base: Place, first: Inertia | None, second: Inertia) -> Inertia:
    """The sum of two inertias of one place."""
    if first is None:
        return second
    if isinstance(first, Rigid) and isinstance(second, Rigid):
        return first + second
    rows = zip(as_matrix(base, first), as_matrix(base, second), strict=True)
    return tuple(add(a, b) for a, b in rows)


def as_matrix(place: Place, inertia: Inertia) -> Matrix[Node]:
    """An inertia of a place as a matrix over its twist."""
    return place.kind.matrix(inertia) if isinstance(inertia, Rigid) else inertia


def momentum(place: Place, inertia: Inertia, twist: Vector[Node]) -> Vector[Node]:
    """I t."""
    if isinstance(place.kind, Point) and isinstance(inertia, Rigid):
        return scale(inertia.mass, twist)
    if isinstance(inertia, Rigid) and len(inertia.first) == 3:
        return product(inertia, twist)
    return transform(as_matrix(place, inertia), twist)


def energy_product(place: Place, inertia: Inertia, left: Vector[Node], right: Vector[Node]) -> Node:
    """T_left' I t_right; a mass times the product where the place is a point."""
    if isinstance(place.kind, Point) and isinstance(inertia, Rigid):
        return inertia.mass * dot(left, right)
    return dot(left, momentum(place, inertia, right))


def mass_matrix(tree: Tree) -> Matrix[Node]:
    """M by composite inertias: column by column, from a joint up to the root."""
    size = len(tree.order)
    zero = tree.gravity[0].graph.zero
    rows = [[zero] * size for _ in range(size)]
    whole = composites(tree)
    holder = {place: joint for joint in tree.joints for place in joint.places}
    for joint in tree.joints:
        for c in joint.coordinates:
            _column(tree, rows, (whole, holder), joint, c)
    return tuple(tuple(row) for row in rows)


def _column(
    tree: Tree,
    rows: list[list[Node]],
    known: tuple[list[Inertia | None], dict[int, Joint]],
    joint: Joint,
    c: int,
) -> None:
    """M_ic for the coordinates of the same joint up to c and of all joints above."""
    whole, holder = known
    lifted: Vector[Node] | None = None
    for number in joint.places:
        place, inertia = tree.places[number], whole[number]
        if inertia is None or c not in place.columns:
            continue
        for i, column in place.columns.items():
            if i <= c:
                entry = energy_product(place, inertia, column, place.columns[c])
                rows[i][c] = rows[c][i] = rows[i][c] + entry
        moved = back(place.steps, momentum(place, inertia, place.columns[c]))
        lifted = _sum(lifted, moved)
    at = joint.base
    while at != GROUND and lifted is not None:
        place = tree.places[at]
        for i, column in place.columns.items():
            rows[i][c] = rows[c][i] = dot(column, lifted)
        lifted = back(place.steps, lifted)
        at = holder[at].base
