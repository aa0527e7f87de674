"""`inertia`: a scalar in the plane, the nine entries of a symmetric tensor in solid space."""

from itertools import combinations
from math import lcm

import sympy as sp

from eomgen.dimension import LENGTH, MASS
from eomgen.spec.formulas import scalar_tree, tree_of, value_of
from eomgen.spec.ledger import Mistake, Spot
from eomgen.spec.lower import is_negative
from eomgen.spec.reader import Node, Sequence
from eomgen.spec.scope import Scene, Wanted
from eomgen.spec.syntax import Tree

INERTIA = MASS * LENGTH**2
ORDER = {  # number of entries given -> which of them stands where, row by row
    3: (0, None, None, None, 1, None, None, None, 2),
    6: (0, 3, 4, 3, 1, 5, 4, 5, 2),
}


def inertia(name: str, node: Node, scene: Scene) -> tuple[sp.Expr, ...]:
    """One scalar or nine entries; raises `Mistake` where no body can have them."""
    what = f"the inertia of '{name}'"
    nodes = _entries(node, scene, what)
    # the six entries of a tensor fill nine places
    read = {n: _entry(n, scene, what) for n in dict.fromkeys(nodes)}
    entries = [read[n][1] for n in nodes]
    values = {n: value_of(tree, scene) if tree else zero for n, (tree, zero) in read.items()}
    if len(entries) == 9:
        _check_symmetric(entries, node, what)
    if all(value is not None for value in values.values()):
        check_possible([v for n in nodes if (v := values[n]) is not None], node, what)
    return tuple(entries)


def _entries(node: Node, scene: Scene, what: str) -> tuple[Node | None, ...]:
    if scene.space == "plane":
        if isinstance(node, Sequence):
            raise Mistake(node, "E501", f"{what} is one scalar in space 'plane'")
        return (node,)
    items = node.items if isinstance(node, Sequence) else ()
    rows = [item.items for item in items if isinstance(item, Sequence)]
    if len(rows) == 3 == len(items) and all(len(row) == 3 for row in rows):
        return tuple(item for row in rows for item in row)
    if rows or len(items) not in ORDER:
        hint = "[a, b, c], [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] or three rows of three"
        raise Mistake(node, "E501", f"{what} has 3, 6 or 3x3 entries in space 'solid'", hint)
    return tuple(None if at is None else items[at] for at in ORDER[len(items)])


def _entry(node: Node | None, scene: Scene, what: str) -> tuple[Tree | None, sp.Expr]:
    """One entry with its tree; zero where nothing is given."""
    if node is None:
        return None, sp.S.Zero
    tree = tree_of(node, scene)
    return tree, scalar_tree(tree, scene, Wanted("inertia", what, INERTIA))


def _check_symmetric(entries: list[sp.Expr], node: Node, what: str) -> None:
    for row, column in combinations(range(3), 2):
        if entries[3 * row + column] != entries[3 * column + row]:
            message = f"{what} is not symmetric: entries {row + 1},{column + 1} differ"
            raise Mistake(node, "E505", message)


def check_possible(values: list[sp.Expr], spot: Spot, what: str) -> None:
    """Raise `Mistake` unless tr(J)/2 - J, the second moments of the mass, is semidefinite."""
    if any(is_negative(values[i]) for i in range(0, len(values), 4)):
        raise Mistake(spot, "E504", f"{what} is negative")
    if len(values) == 1:
        return
    numbers = _proportional(values)
    trace = numbers[0] + numbers[4] + numbers[8]
    moments = [[trace * int(i == j) - 2 * numbers[3 * i + j] for j in range(3)] for i in range(3)]
    minors = (
        _determinant([[moments[i][j] for j in rows] for i in rows])
        for size in (1, 2, 3)
        for rows in combinations(range(3), size)
    )
    if any(is_negative(minor) for minor in minors):
        message = f"{what} belongs to no body: one principal value exceeds the sum of the others"
        raise Mistake(spot, "E505", message)


def _proportional(values: list[sp.Expr]) -> list[int] | list[sp.Expr]:
    """The values times one positive number: integers, where all are rational."""
    if not all(isinstance(value, sp.Rational) for value in values):
        return values
    common = lcm(*(int(value.q) for value in values))
    return [int(value.p) * (common // int(value.q)) for value in values]


def _determinant(rows: list[list[int | sp.Expr]]) -> int | sp.Expr:
    """By the entries of the first row and their minors."""
    first, *others = rows
    if not others:
        return first[0]
    return sum(
        (-1) ** j * entry * _determinant([[*row[:j], *row[j + 1 :]] for row in others])
        for j, entry in enumerate(first)
    )
