"""Root-free factors of a symmetric positive definite matrix, and solutions with them.

A = L' D L with a unit lower triangular L, eliminating from the last row to the first: where the
rows of a tree are numbered from root to leaf nothing fills in (Featherstone, Rigid Body Dynamics
Algorithms, 2008, section 6.5). Never a choice of pivots. The entries are graph nodes, whose zeros
are skipped, or numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from eomgen.algebra.graph import Node
from eomgen.errors import CheckError

Check = Callable[[int, Any, Any], None]  # (row, pivot, scale), before the pivot divides


class SingularMassMatrix(CheckError):
    """A pivot is not positive: some motion has no inertia."""

    def __init__(self, place: str, pivot: Any) -> None:
        super().__init__(
            f"the mass matrix is singular: its pivot {place} is {pivot}, not positive; "
            "give every coordinate inertia, or leave the state where two motions coincide"
        )


@dataclass(frozen=True)
class Factors:
    """L below the diagonal, by rows, and the reciprocals of D."""

    lower: tuple[tuple[Any, ...], ...]
    reciprocals: tuple[Any, ...]


def factor(matrix: Sequence[Sequence[Any]], check: Check) -> Factors:
    """The factors of a matrix, of which only the lower triangle is read."""
    rows = [list(row[: i + 1]) for i, row in enumerate(matrix)]
    reciprocals = [None] * len(rows)
    for k in reversed(range(len(rows))):
        check(k, rows[k][k], matrix[k][k])
        reciprocals[k] = 1 / rows[k][k]
        eliminate(rows, k, reciprocals[k])
    return Factors(tuple(tuple(row[:-1]) for row in rows), tuple(reciprocals))


def eliminate(rows: list[list[Any]], k: int, reciprocal: Any) -> None:
    """A_ij -= L_ki A_kj with L_ki = A_ki / d_k; row k becomes L's."""
    for i in reversed(range(k)):
        if _is_zero(rows[k][i]):
            continue
        entry = rows[k][i] * reciprocal
        for j in range(i + 1):
            if not _is_zero(rows[k][j]):
                rows[i][j] = rows[i][j] - entry * rows[k][j]
        rows[k][i] = entry


def _is_zero(value: Any) -> bool:
    """Whether a node is the number zero; a numeric zero is not looked for."""
    return isinstance(value, Node) and value is value.graph.zero


def substitute(factors: Factors, right: Sequence[Any]) -> list[Any]:
    """The solution x of L' D L x = b."""
    x = list(right)
    rows = factors.lower
    # y = L'^-1 b
    for k in reversed(range(len(x))):
        for i, entry in enumerate(rows[k]):
            if not _is_zero(entry):
                x[i] = x[i] - entry * x[k]
    # x = L^-1 D^-1 y
    for k, row in enumerate(rows):
        x[k] = x[k] * factors.reciprocals[k]
        for i, entry in enumerate(row):
            if not _is_zero(entry):
                x[k] = x[k] - entry * x[i]
    return x


Pivots = tuple[tuple[Node, Node], ...]


def solve(
    matrix: Sequence[Sequence[Node]], *rights: Sequence[Node]
) -> tuple[list[list[Node]], Pivots]:
    """The solutions of A x = b for every b, unrolled, and each pivot with its scale A_kk."""
    pivots: list[tuple[Node, Node]] = []
    factors = factor(matrix, partial(check_pivot, pivots))
    return [substitute(factors, right) for right in rights], tuple(pivots)


def check_pivot(pivots: list[tuple[Node, Node]], row: int, pivot: Node, scale: Node) -> None:
    """Remember a pivot, which the program will check; a number is checked here.

    Raises:
        SingularMassMatrix: it is a number and not positive.
    """
    if pivot.operator == "number" and pivot.datum <= 0:
        raise SingularMassMatrix(f"in row {row + 1}", pivot.datum)
    if pivot.operator != "number":
        pivots.append((pivot, scale))


def solve_in_loop(matrix: Sequence[Sequence[Node]], *rights: Sequence[Node]) -> list[list[Node]]:
    """The solutions of A x = b for every b as opaque nodes: a program finds them in a loop.

    The program checks the pivots itself. The nodes depend on all entries but have no derivative.
    """
    size = len(matrix)
    if not size or not rights:
        return [[] for _ in rights]
    entries = [matrix[i][j] for i in range(size) for j in range(i + 1)]
    columns = [entry for right in rights for entry in right]
    graph = columns[0].graph
    system = graph.make("system", (*entries, *columns), size)
    return [
        [graph.make("solved", (system,), size * column + row) for row in range(size)]
        for column in range(len(rights))
    ]
