"""Lagrange's equations of the first kind, index 1: accelerations and multipliers together.

M q'' + h = Q + J' lambda,   J q'' + gamma = 0,   hence with  S = J M^-1 J'

S lambda = -gamma - J M^-1 (Q - h),   q'' = M^-1 (Q - h) + M^-1 J' lambda   (Schur complement).

Where a motion without inertia is one that the constraints forbid, M is singular and M + w J'J is
not. On J q'' = -gamma the first is the second with lambda + w gamma in the place of lambda, for any
weight w: the solution is the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from eomgen.algebra import ldl
from eomgen.algebra.graph import Node
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.equations import Equations
from eomgen.mechanics.vectors import dot


@dataclass(frozen=True)
class Schur:
    """M^-1 J' by columns and the factors that solve with S, with the pivots of both."""

    rows: tuple[Row[Node], ...]
    columns: tuple[tuple[Node, ...], ...]  # M^-1 J', one column for each row
    matrix: tuple[tuple[Node, ...], ...]  # S
    free: tuple[Node, ...]  # M^-1 (Q - h)
    pivots: ldl.Pivots
    weight: Fraction = Fraction(0)  # w, where M + w J'J stands for M


@dataclass(frozen=True)
class Solution:
    """The solution with every pivot that it divides by."""

    accelerations: tuple[Node, ...]
    multipliers: tuple[Node, ...]
    pivots: ldl.Pivots


def inertia(
    equations: Equations[Node], rows: Sequence[Row[Node]], weight: Fraction = Fraction(0)
) -> tuple[tuple[Node, ...], ...]:
    """M + w J'J."""
    if not weight:
        return equations.mass_matrix
    columns = list(zip(*(row.jacobian for row in rows), strict=True))
    return tuple(
        tuple(entry + weight * dot(left, right) for entry, right in zip(line, columns, strict=True))
        for line, left in zip(equations.mass_matrix, columns, strict=True)
    )


def schur(
    equations: Equations[Node], rows: Sequence[Row[Node]], weight: Fraction = Fraction(0)
) -> Schur:
    """The Schur complement of a scene; the rows are independent."""
    load = [q - h for q, h in zip(equations.generalized_forces, equations.bias, strict=True)]
    matrix = inertia(equations, rows, weight)
    solved, pivots = ldl.solve(matrix, load, *(row.jacobian for row in rows))
    free, *columns = (tuple(s) for s in solved)
    size = range(len(rows))
    lower = [[dot(rows[i].jacobian, columns[j]) for j in range(i + 1)] for i in size]
    complement = tuple(tuple(lower[max(i, j)][min(i, j)] for j in size) for i in size)
    return Schur(tuple(rows), tuple(columns), complement, free, pivots, weight)


def solve(system: Schur, rate: Fraction = Fraction(0)) -> Solution:
    """Accelerations and multipliers.

    rate: Baumgarte's alpha [1/s]: J q'' + gamma + 2 alpha phi' + alpha^2 phi = 0, and
    J q'' + gamma + alpha a = 0 for a rate constraint a. It injects or removes energy.
    """
    wanted = [row.gamma + stabilised(row, rate) for row in system.rows]
    right = [
        -w - dot(row.jacobian, system.free) for row, w in zip(system.rows, wanted, strict=True)
    ]
    (shares,), pivots = ldl.solve(system.matrix, right)
    accelerations = _corrected(system.free, system.columns, shares)
    multipliers = tuple(s + system.weight * w for s, w in zip(shares, wanted, strict=True))
    return Solution(accelerations, multipliers, system.pivots + pivots)


def responses(
    system: Schur, matrix: Sequence[Sequence[Node]], columns: Sequence[Sequence[Node]]
) -> tuple[list[list[Node]], ldl.Pivots]:
    """a of M a - J' lambda = b, J a = c for every column (b, c), and the pivots.

    matrix: M, or M + w J'J in its place, which changes lambda only.
    """
    size = len(matrix)
    free, _ = ldl.solve(matrix, *(column[:size] for column in columns))
    rights = [
        [c - dot(row.jacobian, a) for c, row in zip(column[size:], system.rows, strict=True)]
        for column, a in zip(columns, free, strict=True)
    ]
    shares, pivots = ldl.solve(system.matrix, *rights)
    pairs = zip(free, shares, strict=True)
    found = [list(_corrected(a, system.columns, share)) for a, share in pairs]
    return found, system.pivots + pivots


def stabilised(row: Row[Node], rate: Fraction) -> Node:
    """Baumgarte's terms of a row."""
    if row.residual is None:
        return row.rate * rate
    return row.rate * (2 * rate) + row.residual * rate**2


def projected(
    system: Schur, values: Sequence[Node], residuals: Sequence[Node]
) -> tuple[tuple[Node, ...], ldl.Pivots]:
    """values - M^-1 J' S^-1 residuals: the nearest in the metric of M, one Newton step."""
    (shares,), pivots = ldl.solve(system.matrix, [-r for r in residuals])
    return _corrected(values, system.columns, shares), system.pivots + pivots


def _corrected(
    values: Sequence[Node], columns: Sequence[Sequence[Node]], shares: Sequence[Node]
) -> tuple[Node, ...]:
    """Values plus the columns times their shares."""
    if not columns:
        return tuple(values)
    by_coordinate = zip(*columns, strict=True)
    return tuple(v + dot(c, shares) for v, c in zip(values, by_coordinate, strict=True))
