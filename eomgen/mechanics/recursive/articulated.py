"""The articulated-body method: M x = y in a time that grows with the number of joints.

Every joint is eliminated from the leaves to the root: over (t, x), the twist of its place and its
coordinates, the matrix [[I, I S], [S' I, S' I S]] is factorised from its last row on; what is
left of I is what the base feels (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 7, with
all velocity terms on the right side).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from eomgen.algebra import ldl
from eomgen.algebra.graph import Node
from eomgen.mechanics.recursive.records import GROUND, Joint, Tree
from eomgen.mechanics.recursive.recursion import (
    Inertia,
    as_matrix,
    energy_product,
    momentum,
    moved_back,
    together,
)
from eomgen.mechanics.recursive.steps import back, forward
from eomgen.mechanics.vectors import Matrix, Vector, add, dot, scale


@dataclass(frozen=True)
class Elimination:
    """One joint: rows of L over (twist, coordinates) and reciprocals of the pivots."""

    joint: Joint
    single: bool  # the twist is that of the only place; else that of the base
    size: int  # of the twist
    rows: tuple[Vector[Node], ...]  # one for each coordinate
    reciprocals: tuple[Node, ...]


@dataclass(frozen=True)
class Articulated:
    """A tree ready to solve."""

    tree: Tree
    eliminations: tuple[Elimination, ...]  # from root to leaf
    pivots: ldl.Pivots


def factor(tree: Tree) -> Articulated:
    """Every joint eliminated.

    Raises:
        SingularMassMatrix: a motion has no inertia whatever the state.
    """
    inertias: list[Inertia | None] = [place.body for place in tree.places]
    bounds = _bounds(tree)
    pivots: list[tuple[Node, Node]] = []
    found = []
    for joint in reversed(tree.joints):
        if not joint.coordinates:
            _pass_on(tree, joint, inertias)
            continue
        elimination, rest = _eliminated(tree, joint, inertias, (bounds, pivots))
        found.append(elimination)
        if joint.base == GROUND:
            continue
        base = tree.places[joint.base]
        (first, *_) = joint.places
        moved = moved_back(tree.places[first], rest) if elimination.single else rest
        inertias[joint.base] = together(base, inertias[joint.base], moved)
    return Articulated(tree, tuple(reversed(found)), tuple(pivots))


def _pass_on(tree: Tree, joint: Joint, inertias: list[Inertia | None]) -> None:
    for number in joint.places:
        own, place = inertias[number], tree.places[number]
        if own is not None and place.base != GROUND:
            base = tree.places[place.base]
            inertias[place.base] = together(base, inertias[place.base], moved_back(place, own))


def _eliminated(
    tree: Tree,
    joint: Joint,
    inertias: Sequence[Inertia | None],
    known: tuple[Sequence[Vector[Node]], list[tuple[Node, Node]]],
) -> tuple[Elimination, Matrix[Node]]:
    """The elimination of a joint and what is left of the inertia."""
    bounds, pivots = known
    single = len(joint.places) == 1
    matrix, coupling, own = (_at_place if single else _at_base)(tree, joint, inertias)
    size = len(matrix)
    rows = [list(row[: i + 1]) for i, row in enumerate(matrix)]
    for i in range(len(joint.coordinates)):
        rows.append([*coupling[i], *own[i]])
    reciprocals: list[Node] = []
    for i in reversed(range(len(joint.coordinates))):
        scale_of = _scale(tree, joint, bounds, joint.coordinates[i])
        ldl.check_pivot(pivots, joint.coordinates[i], rows[size + i][-1], scale_of)
        reciprocals.insert(0, 1 / rows[size + i][-1])
        ldl.eliminate(rows, size + i, reciprocals[0])
    rest = tuple(tuple(rows[max(i, j)][min(i, j)] for j in range(size)) for i in range(size))
    lower = tuple(tuple(row[:-1]) for row in rows[size:])
    return Elimination(joint, single, size, lower, tuple(reciprocals)), rest


Parts = tuple[Matrix[Node], list[Vector[Node]], list[list[Node]]]  # I, (I S)', lower S' I S


def _at_place(tree: Tree, joint: Joint, inertias: Sequence[Inertia | None]) -> Parts:
    (number,) = joint.places
    place, inertia = tree.places[number], inertias[number]
    if inertia is None:
        raise ldl.SingularMassMatrix(f"of {place.name}", 0)
    columns = [place.columns[c] for c in joint.coordinates]
    coupling = [momentum(place, inertia, column) for column in columns]
    own = [
        [energy_product(place, inertia, columns[j], columns[i]) for j in range(i + 1)]
        for i in range(len(columns))
    ]
    return as_matrix(place, inertia), coupling, own


def _at_base(tree: Tree, joint: Joint, inertias: Sequence[Inertia | None]) -> Parts:
    """Several places are gathered at their base, as if the joint were frozen."""
    base = tree.places[joint.base]
    zero = tree.gravity[0].graph.zero
    size, count = base.kind.size, len(joint.coordinates)
    matrix: Inertia | None = None
    coupling: list[Vector[Node]] = [(zero,) * size for _ in range(count)]
    own = [[zero] * (i + 1) for i in range(count)]
    for number in joint.places:
        place, inertia = tree.places[number], inertias[number]
        if inertia is None:
            continue
        if joint.base != GROUND:
            matrix = together(base, matrix, moved_back(place, inertia))
        for i, c in enumerate(joint.coordinates):
            if c not in place.columns:
                continue
            moved = momentum(place, inertia, place.columns[c])
            if joint.base != GROUND:
                coupling[i] = add(coupling[i], back(place.steps, moved))
            for j, other in enumerate(joint.coordinates[: i + 1]):
                if other in place.columns:
                    left, right = place.columns[other], place.columns[c]
                    own[i][j] = own[i][j] + energy_product(place, inertia, left, right)
    nothing = tuple((zero,) * size for _ in range(size))
    return nothing if matrix is None else as_matrix(base, matrix), coupling, own


def _bounds(tree: Tree) -> list[Vector[Node]]:
    """The size of the inertia that each place carries, which pivots are compared with."""
    zero = tree.gravity[0].graph.zero
    found = [
        (zero,) * place.kind.size if place.body is None else place.kind.bound(place.body)
        for place in tree.places
    ]
    for joint in reversed(tree.joints):
        for number in joint.places:
            place, sizes = tree.places[number], found[number]
            if place.base != GROUND:
                for step in reversed(place.steps):
                    sizes = step.bound(sizes)
                found[place.base] = add(found[place.base], sizes)
    return found


def _scale(tree: Tree, joint: Joint, bounds: Sequence[Vector[Node]], c: int) -> Node:
    """A bound of M_cc: sum of S_k^2 times the size of the k-th diagonal entry."""
    total = tree.gravity[0].graph.zero
    for number in joint.places:
        column = tree.places[number].columns.get(c)
        if column is not None:
            total = total + dot(bounds[number], tuple(s * s for s in column))
    return total


def solve(
    found: Articulated, right: Sequence[Node], wrenches: Sequence[Vector[Node] | None] = ()
) -> tuple[Node, ...]:
    """The solution x of M x = y - (wrenches of the places, gathered at the coordinates)."""
    tree, zero = found.tree, found.tree.gravity[0].graph.zero
    y = list(right)
    forces = list(wrenches) or [None] * len(tree.places)
    used = {e.joint: e for e in found.eliminations}
    for joint in reversed(tree.joints):
        if joint in used:
            _forces(tree, used[joint], forces, y)
        else:
            for number in joint.places:
                _lift(tree, number, forces, forces[number])
    twists: list[Vector[Node]] = [(zero,) * p.kind.size for p in tree.places]
    for joint in tree.joints:
        _twists(tree, joint, used.get(joint), (twists, y))
    return tuple(y)


def _lift(
    tree: Tree, number: int, forces: list[Vector[Node] | None], force: Vector[Node] | None
) -> None:
    """Add the force of a place to that of its base."""
    place = tree.places[number]
    if force is None or place.base == GROUND:
        return
    moved, before = back(place.steps, force), forces[place.base]
    forces[place.base] = moved if before is None else add(before, moved)


def _forces(tree: Tree, e: Elimination, forces: list[Vector[Node] | None], y: list[Node]) -> None:
    """u = y - S' p, and p + L' u for the base."""
    zero = tree.gravity[0].graph.zero
    for number in e.joint.places:
        force, place = forces[number], tree.places[number]
        if force is not None:
            for c, column in place.columns.items():
                y[c] = y[c] - dot(column, force)
    right = [zero] * e.size + [y[c] for c in e.joint.coordinates]
    for i, row in reversed(list(enumerate(e.rows))):
        for k, entry in enumerate(row):
            right[k] = right[k] - entry * right[e.size + i]
    for i, c in enumerate(e.joint.coordinates):
        y[c] = right[e.size + i]
    felt = tuple(-value for value in right[: e.size])
    if e.single:
        (number,) = e.joint.places
        force = forces[number]
        _lift(tree, number, forces, felt if force is None else add(force, felt))
        return
    for number in e.joint.places:
        _lift(tree, number, forces, forces[number])
    if e.joint.base != GROUND:
        before = forces[e.joint.base]
        forces[e.joint.base] = felt if before is None else add(before, felt)


def _twists(
    tree: Tree, joint: Joint, e: Elimination | None, known: tuple[list[Vector[Node]], list[Node]]
) -> None:
    """x = D^-1 u - L t from root to leaf, and the twists of the places."""
    twists, y = known
    base = twists[joint.base]
    moved = {n: forward(tree.places[n].steps, base) for n in joint.places}
    if e is not None:
        felt = list(moved[joint.places[0]] if e.single else base)
        for i, c in enumerate(joint.coordinates):
            y[c] = y[c] * e.reciprocals[i]
            for entry, value in zip(e.rows[i], felt, strict=True):
                y[c] = y[c] - entry * value
            felt.append(y[c])
    for n, twist in moved.items():
        for c, column in tree.places[n].columns.items():
            twist = add(twist, scale(y[c], column))
        twists[n] = twist
