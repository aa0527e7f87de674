"""A basis of the virtual displacements: J delta q = 0 at frozen time, in numbers and as formulas.

With the dependent columns D of J and the independent ones F:  delta q_D = -D^-1 F delta q_F.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from eomgen.algebra.closed import ClosedForm
from eomgen.algebra.normal import Form, TooLarge
from eomgen.analysis import elimination
from eomgen.analysis import linkage as linkages
from eomgen.analysis.elimination import Matrix
from eomgen.analysis.linkage import PRECISE, Linkage, State
from eomgen.mechanics import constraints, lagrange, speeds
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.equations import virtual_name
from eomgen.mechanics.vectors import dot
from eomgen.model import Coordinate, Model

LEAST_PIVOT = 1e-2  # below it a linked coordinate is no better than a free one
LARGEST_BLOCK = 3  # of a symbolic inverse
MOST_TERMS = 30  # of all its entries


@dataclass(frozen=True)
class Basis:
    """One displacement for each independent coordinate: its own entry is 1, the others' are 0."""

    independent: tuple[str, ...]
    dependent: tuple[str, ...]
    vectors: tuple[tuple[Any, ...], ...]  # at the first state, entries by coordinate
    formulas: tuple[tuple[str, Form], ...] | None  # dependent -> form in the independent deltas


def symbol(coordinate: Coordinate) -> sp.Symbol:
    """The symbol of a coordinate's virtual displacement."""
    return sp.Symbol(virtual_name(coordinate.name), real=True)


def basis(linkage: Linkage, states: Sequence[State], kept: Sequence[int]) -> Basis:
    """The basis whose independent coordinates serve best at all states, free ones if they can."""
    rows = [linkage.rows[i].jacobian for i in kept]
    matrices = [linkages.matrix(linkage, rows, s, PRECISE) for s in states]
    coordinates = linkage.model.coordinates
    linked = [j for j, c in enumerate(coordinates) if c.role == "linked"]
    dependent = dependent_columns(matrices, linked)
    independent = [j for j in range(len(coordinates)) if j not in dependent]
    return Basis(
        tuple(coordinates[j].name for j in independent),
        tuple(coordinates[j].name for j in dependent),
        _vectors(matrices[0] if matrices else [], dependent, independent),
        _formulas(linkage, kept, dependent, independent),
    )


def dependent_columns(matrices: Sequence[Matrix], preferred: Sequence[int] = ()) -> list[int]:
    """The columns to solve for: the candidate of one state whose worst determinant is largest."""
    candidates = dict.fromkeys(
        elimination.pivot_columns(m, preferred, LEAST_PIVOT) for m in matrices
    )

    def worst(columns: Iterable[int]) -> Any:
        chosen = list(columns)
        return min(elimination.volume([[row[j] for j in chosen] for row in m]) for m in matrices)

    most = max((len(c) for c in candidates), default=0)
    return list(max((c for c in candidates if len(c) == most), key=worst, default=()))


def _vectors(
    matrix: Matrix, dependent: Sequence[int], independent: Sequence[int]
) -> tuple[tuple[Any, ...], ...]:
    right = [[-row[j] for j in independent] for row in matrix]
    solved = elimination.solved([[row[j] for j in dependent] for row in matrix], right)
    vectors = []
    for k, own in enumerate(independent):
        entries = {own: PRECISE.number(1)}
        entries |= {j: solved[i][k] for i, j in enumerate(dependent)}
        size = range(len(dependent) + len(independent))
        vectors.append(tuple(entries.get(j, PRECISE.number(0)) for j in size))
    return tuple(vectors)


def closed_rows(model: Model) -> tuple[ClosedForm, tuple[Row[Form], ...]]:
    """The rows in closed form, in the order of the linkage: holonomic first."""
    kinematics = lagrange.closed_kinematics(linkages.without_speeds(model))
    algebra = kinematics.algebra
    assert isinstance(algebra, ClosedForm)
    rows = constraints.rows(kinematics)
    return algebra, tuple(sorted(rows, key=lambda r: not r.is_holonomic))


def _formulas(
    linkage: Linkage, kept: Sequence[int], dependent: Sequence[int], independent: Sequence[int]
) -> tuple[tuple[str, Form], ...] | None:
    """Delta of each dependent coordinate; None where the formulas would be long."""
    try:
        algebra, rows = closed_rows(linkage.model)
        return _solved(linkage, algebra, [rows[i].jacobian for i in kept], dependent, independent)
    except TooLarge:
        return None


def _solved(
    linkage: Linkage,
    algebra: ClosedForm,
    matrix: Sequence[Sequence[Form]],
    dependent: Sequence[int],
    independent: Sequence[int],
) -> tuple[tuple[str, Form], ...] | None:
    coordinates = linkage.model.coordinates
    square = [[row[j] for j in dependent] for row in matrix]
    deltas = [algebra.of(symbol(coordinates[j])) for j in independent]
    zero = algebra.number(0)
    right = [dot([-row[j] for j in independent], deltas) if deltas else zero for row in matrix]
    found: dict[int, Form] = {}
    for rows, columns in speeds.blocks(algebra, square):
        block = [[square[i][j] for j in columns] for i in rows]
        if len(block) > LARGEST_BLOCK or sum(len(f.terms) for r in block for f in r) > MOST_TERMS:
            return None
        inverse = speeds.inverted(algebra, block, ())
        for j, shares in zip(columns, inverse, strict=True):
            found[dependent[j]] = dot(shares, [right[i] for i in rows])
    return tuple((coordinates[j].name, found[j]) for j in dependent)
