"""Quasi-velocities: from u = Y(q, t) q' + y(q, t) to the rates q' = N(q, t) u + n(q, t)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Generic

import sympy as sp

from eomgen.algebra.scalar import Algebra, S
from eomgen.errors import UsageError
from eomgen.mechanics import motions
from eomgen.mechanics.vectors import dot
from eomgen.model import TIME, Model, Speed


def symbols(model: Model) -> tuple[sp.Symbol, ...]:
    """The symbols of the speeds: the rates q' where the spec declares no speeds."""
    return tuple(s.symbol for s in model.speeds) or tuple(c.rate for c in model.coordinates)


def names(model: Model) -> tuple[str, ...]:
    """The names of the equations: speeds, or the coordinates where the spec declares none."""
    return tuple(s.name for s in model.speeds) or tuple(c.name for c in model.coordinates)


def plain(model: Model) -> tuple[Speed, ...]:
    """The speeds that are no angular velocity of a quaternion."""
    own = {s for q in model.quaternions for s in q.speeds}
    return tuple(s for s in model.speeds if s.symbol not in own)


def spelled_out(model: Model, formula: sp.Expr) -> sp.Expr:
    """A formula with derived parameters and prescribed motions replaced by what they stand for."""
    definitions = {p.symbol: p.formula for p in model.parameters if p.formula is not None}
    for known in model.prescribed:
        rate = sp.diff(known.formula, TIME)
        definitions |= {known.symbol: known.formula, known.rate: rate}
        definitions[known.acceleration] = sp.diff(rate, TIME)
    while formula.free_symbols & definitions.keys():
        formula = formula.xreplace(definitions)
    return formula


def rates(model: Model, algebra: Algebra[S]) -> tuple[S, ...]:
    """Q' for every coordinate, over the symbols of the speeds.

    Raises:
        UsageError: the speeds are not independent: Y is singular everywhere.
    """
    if not model.speeds:
        return tuple(algebra.of(c.rate) for c in model.coordinates)
    turned: dict[sp.Symbol, S] = {}
    for q in model.quaternions:
        spin = tuple(algebra.of(s) for s in q.speeds)
        turned |= zip(q.rates, motions.rates(q, algebra, spin), strict=True)
    rest = [c.rate for c in motions.plain(model)]
    found = _solved(algebra, plain(model), rest)
    everything = turned | dict(zip(rest, found, strict=True))
    return tuple(everything[c.rate] for c in model.coordinates)


def _solved(algebra: Algebra[S], speeds: Sequence[Speed], rates: Sequence[sp.Symbol]) -> list[S]:
    """The rates that follow from the formulas of the speeds."""
    matrix = [[algebra.of(sp.diff(s.formula, r)) for r in rates] for s in speeds]
    still = dict.fromkeys(rates, sp.S.Zero)
    right = [algebra.of(s.symbol) - algebra.of(s.formula.xreplace(still)) for s in speeds]
    solution: list[S] = [algebra.number(0)] * len(rates)
    for rows, columns in blocks(algebra, matrix):
        block = [[matrix[i][j] for j in columns] for i in rows]
        inverse = inverted(algebra, block, [speeds[i] for i in rows])
        for j, row in zip(columns, inverse, strict=True):
            solution[j] = dot(row, [right[i] for i in rows])
    return solution


def blocks(algebra: Algebra[S], matrix: Sequence[Sequence[S]]) -> list[tuple[list[int], list[int]]]:
    """Rows and columns that hang together, so that each block is inverted alone."""
    size = len(matrix)
    label = list(range(size))  # of rows; a column joins every row in which it occurs
    for j in range(size):
        touching = {label[i] for i in range(size) if not algebra.is_zero(matrix[i][j])}
        label = [min(touching) if old in touching else old for old in label]
    return [
        (
            rows := [i for i in range(size) if label[i] == name],
            [j for j in range(size) if any(not algebra.is_zero(matrix[i][j]) for i in rows)],
        )
        for name in dict.fromkeys(label)
    ]


def inverted(
    algebra: Algebra[S], matrix: Sequence[Sequence[S]], speeds: Sequence[Speed]
) -> list[list[S]]:
    """The inverse by cofactors over the determinant: nothing is pivoted on.

    Raises:
        UsageError: the determinant is zero.
    """
    size = len(matrix)
    everything = tuple(range(size))
    minors = Minors(algebra, matrix)
    determinant = minors.of(everything, everything) if len(matrix[0]) == size else None
    if determinant is None or algebra.is_zero(determinant):
        listed = ", ".join(s.name for s in speeds)
        raise UsageError(
            f"the speeds {listed} do not determine the rates: they are not independent"
        )

    def cofactor(i: int, j: int) -> S:
        rest = minors.of(everything[:i] + everything[i + 1 :], everything[:j] + everything[j + 1 :])
        return (rest if (i + j) % 2 == 0 else -rest) / determinant

    return [[cofactor(i, j) for i in everything] for j in everything]


class Minors(Generic[S]):
    """Determinants of submatrices by expansion along the first row, each found once."""

    def __init__(self, algebra: Algebra[S], matrix: Sequence[Sequence[S]]) -> None:
        self.algebra, self.matrix = algebra, matrix
        self.known: dict[tuple[tuple[int, ...], tuple[int, ...]], S] = {}

    def of(self, rows: tuple[int, ...], columns: tuple[int, ...]) -> S:
        """The determinant of the chosen rows and columns."""
        if not rows:
            return self.algebra.number(1)
        if (rows, columns) not in self.known:
            self.known[rows, columns] = self._expanded(rows, columns)
        return self.known[rows, columns]

    def _expanded(self, rows: tuple[int, ...], columns: tuple[int, ...]) -> S:
        result = self.algebra.number(0)
        for place, column in enumerate(columns):
            entry = self.matrix[rows[0]][column]
            if not self.algebra.is_zero(entry):
                rest = self.of(rows[1:], columns[:place] + columns[place + 1 :])
                result = result + (entry * rest if place % 2 == 0 else -(entry * rest))
        return result
