"""`inertia`: a scalar in the plane, the nine entries of a symmetric tensor in solid space."""

from itertools import combinations

import sympy as sp

from eomgen.dimension import LENGTH, MASS
from eomgen.spec.formulas import scalar, tree_of, value_of
from eomgen.spec.ledger import Mistake, Spot
from eomgen.spec.reader import Node, Sequence
from eomgen.spec.scope import Scene, Wanted

INERTIA = MASS * LENGTH**2
ORDER = {  # number of entries given -> which of them stands where, row by row
    3: (0, None, None, None, 1, None, None, None, 2),
    6: (0, 3, 4, 3, 1, 5, 4, 5, 2),
}


def inertia(name: str, node: Node, scene: Scene) -> tuple[sp.Expr, ...]:
    """One scalar or nine entries; raises `Mistake` where no body can have them."""
    what = f"the inertia of '{name}'"
    nodes = _entries(node, scene, what)
    entries = [
        scalar(n, scene, Wanted("inertia", what, INERTIA)) if n else sp.S.Zero for n in nodes
    ]
    values = [value_of(tree_of(n, scene), scene) if n else sp.S.Zero for n in nodes]
    if len(entries) == 9:
        _check_symmetric(entries, node, what)
    if all(value is not None for value in values):
        check_possible([v for v in values if v is not None], node, what)
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


def _check_symmetric(entries: list[sp.Expr], node: Node, what: str) -> None:
    for row, column in combinations(range(3), 2):
        if entries[3 * row + column] != entries[3 * column + row]:
            message = f"{what} is not symmetric: entries {row + 1},{column + 1} differ"
            raise Mistake(node, "E505", message)


def check_possible(values: list[sp.Expr], spot: Spot, what: str) -> None:
    """Raise `Mistake` unless tr(J)/2 - J, the second moments of the mass, is semidefinite."""
    if any(values[i].is_negative for i in range(0, len(values), 4)):
        raise Mistake(spot, "E504", f"{what} is negative")
    if len(values) == 1:
        return
    tensor = sp.Matrix(3, 3, values)
    moments = sp.eye(3) * tensor.trace() / 2 - tensor
    minors = (
        moments.extract(list(rows), list(rows)).det()
        for size in (1, 2, 3)
        for rows in combinations(range(3), size)
    )
    if any(minor.is_negative for minor in minors):
        message = f"{what} belongs to no body: one principal value exceeds the sum of the others"
        raise Mistake(spot, "E505", message)
