"""Linear systems with a fixed order of pivots, chosen from numbers and never from symbols."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from eomgen.algebra.graph import Node
from eomgen.algebra.ldl import Pivots


@dataclass(frozen=True)
class Order:
    """Which row is eliminated with which column, best pivot first."""

    rows: tuple[int, ...]
    columns: tuple[int, ...]


def order_of(matrix: Sequence[Sequence[float]], least: float = 1e-9) -> Order:
    """The order of complete pivoting on a numeric matrix; stops at its rank.

    least: what a pivot must exceed, relative to the first.
    """
    left = [list(row) for row in matrix]
    rows, columns = list(range(len(left))), list(range(len(left[0]) if left else 0))
    taken: list[tuple[int, int]] = []
    first = 0.0
    while rows and columns:
        i, j = max(((i, j) for i in rows for j in columns), key=lambda p: abs(left[p[0]][p[1]]))
        first = first or abs(left[i][j])
        if abs(left[i][j]) <= least * first or first == 0:
            break
        rows.remove(i)
        columns.remove(j)
        taken.append((i, j))
        for r in rows:
            factor = left[r][j] / left[i][j]
            left[r] = [a - factor * b for a, b in zip(left[r], left[i], strict=True)]
    return Order(tuple(i for i, _ in taken), tuple(j for _, j in taken))


def solve(
    matrix: Sequence[Sequence[Node]], rights: Sequence[Sequence[Node]], order: Order
) -> tuple[list[list[Node]], Pivots, Node]:
    """(x of A x = b for every right side, pivot^2 with its scale for each pivot, their product).

    The unknowns are in the order of the matrix's columns. The product of the pivots is the
    determinant, but for a sign that is always the same.
    """
    rows = [list(row) for row in matrix]
    sides = [[right[i] for right in rights] for i in range(len(rows))]
    pivots = []
    product = matrix[0][0].graph.one
    for place, (i, j) in enumerate(zip(order.rows, order.columns, strict=True)):
        pivot = rows[i][j]
        product = pivot * product
        # 1/p as p/p^2: the square is what the program requires to be positive
        reciprocal = 1 / pivot if pivot.operator == "number" else pivot / (pivot * pivot)
        if pivot.operator != "number":
            pivots.append((pivot * pivot, sum((a * a for a in matrix[i]), pivot.graph.zero)))
        rows[i] = [a * reciprocal for a in rows[i]]
        sides[i] = [a * reciprocal for a in sides[i]]
        for r in order.rows[place + 1 :]:
            factor = rows[r][j]
            rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i], strict=True)]
            sides[r] = [a - factor * b for a, b in zip(sides[r], sides[i], strict=True)]
    return _substituted_back(rows, sides, order), tuple(pivots), product


def _substituted_back(
    rows: Sequence[Sequence[Node]], sides: Sequence[Sequence[Node]], order: Order
) -> list[list[Node]]:
    """The solutions of the triangular system, one list for each right side."""
    count = len(sides[0]) if sides else 0
    found: dict[int, list[Node]] = {}
    for place in reversed(range(len(order.rows))):
        i, j = order.rows[place], order.columns[place]
        values = list(sides[i])
        for later in order.columns[place + 1 :]:
            values = [v - rows[i][later] * x for v, x in zip(values, found[later], strict=True)]
        found[j] = values
    return [[found[j][k] for j in sorted(found)] for k in range(count)]
