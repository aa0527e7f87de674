"""Which way the admissible directions lead: the growth of their Lie brackets.

X_1 .. X_d span the null space of the rows. D_1 = span X, D_(k+1) = D_k + [D_1, D_k], with
[X, Y] = DY X - DX Y. By Frobenius, n - (last dimension) relations between positions hold.
For rows that depend on time, or drift at rest, the time is one more coordinate (Murray, Li, Sastry,
A Mathematical Introduction to Robotic Manipulation, 1994, ch. 7).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from eomgen.algebra.graph import Node
from eomgen.analysis import elimination
from eomgen.analysis import linkage as linkages
from eomgen.analysis.linkage import IRREGULAR, PRECISE, Linkage, State
from eomgen.errors import UsageError
from eomgen.mechanics.vectors import dot, subtract
from eomgen.model import TIME

Field = tuple[Node, ...]
FAINT = PRECISE.number(10) ** -12  # a bracket's terms below this share of |X| |Y| are round-off


@dataclass(frozen=True)
class Growth:
    """Dimensions of D_1, D_2, ... until they stop, and fields that span the last of them."""

    dimensions: tuple[int, ...]
    with_time: bool  # the time counts as a coordinate
    fields: tuple[Field, ...]


@dataclass(frozen=True)
class Covectors:
    """Rows over (q) or (q, t): each admissible direction X has  row . X = 0."""

    symbols: tuple[sp.Symbol, ...]
    rows: tuple[Field, ...]  # in the order of the linkage
    with_time: bool


def covectors(linkage: Linkage) -> Covectors:
    """The rows as covectors on configuration space, or on it and time where time matters."""
    symbols = tuple(c.symbol for c in linkage.model.coordinates)
    rows = tuple(row.jacobian for row in linkage.rows)
    if not depends_on_time(linkage):
        return Covectors(symbols, rows, False)
    extended = tuple((*row, drift) for row, drift in zip(rows, linkage.drifts, strict=True))
    return Covectors((*symbols, TIME), extended, True)


def depends_on_time(linkage: Linkage) -> bool:
    """Whether any row has explicit time, or a rate that is not zero at rest."""
    time = linkage.kinematics.algebra.bindings[TIME].leaves
    entries = [entry for row in linkage.rows for entry in row.jacobian]
    return any(d is not linkage.zero for d in linkage.drifts) or any(
        entry.leaves & time for entry in entries
    )


def growth(
    linkage: Linkage, given: Covectors, kept: Sequence[int], states: Sequence[State]
) -> Growth:
    """The growth of the directions that the kept rows leave, at the best of the states."""
    fields = directions(linkage, given, kept, states)
    spanning, newest = list(fields), list(fields)
    dimensions = [len(fields)]
    most = len(given.symbols)
    while newest and dimensions[-1] < most:
        pairs = ((x, y) for i, x in enumerate(fields) for y in _partners(i, newest, fields))
        brackets = [bracket(linkage, given.symbols, x, y) for x, y in pairs]
        newest = _independent(linkage, spanning, brackets, states)
        spanning += newest
        dimensions.append(len(spanning))
        if dimensions[-1] == dimensions[-2]:
            dimensions.pop()
            break
    return Growth(tuple(dimensions), given.with_time, tuple(spanning))


def _partners(i: int, newest: Sequence[Field], fields: Sequence[Field]) -> Sequence[Field]:
    """What the i-th field is bracketed with: [X, Y] = -[Y, X] is taken once."""
    return newest[i + 1 :] if newest == fields else newest


@dataclass(frozen=True)
class Bracket:
    """[X, Y] = DY X - DX Y, with its terms and X and Y: they say when it is as good as zero."""

    value: Field
    terms: tuple[Field, Field]
    of: tuple[Field, Field]


def bracket(linkage: Linkage, symbols: Sequence[sp.Symbol], x: Field, y: Field) -> Bracket:
    """The Lie bracket of two fields."""
    along = linkage.kinematics.algebra.along
    by_x, by_y = (dict(zip(symbols, field, strict=True)) for field in (x, y))
    forth, back = tuple(along(b, by_x) for b in y), tuple(along(a, by_y) for a in x)
    return Bracket(subtract(forth, back), (forth, back), (x, y))


def numbers(
    linkage: Linkage, fields: Sequence[Field], states: Sequence[State]
) -> list[list[list[Any]]]:
    """The fields in 50 digits at every state where they are defined.

    Raises:
        UsageError: there is no such state.
    """
    found = []
    for state in states:
        try:
            found.append(linkages.matrix(linkage, fields, state, PRECISE))
        except IRREGULAR:
            continue
    if not found:
        raise UsageError(
            "the constraints could not be analysed: their roots and quotients are not defined at "
            "random admissible states; give `range` for the coordinates"
        )
    return found


def _independent(
    linkage: Linkage, spanning: Sequence[Field], more: Sequence[Bracket], states: Sequence[State]
) -> list[Field]:
    """Those of the brackets that are not spanned by the fields and brackets before them."""
    parts = [part for b in more for part in (*b.terms, *b.of)]
    fields = [*spanning, *(b.value for b in more), *parts]
    count = len(spanning) + len(more)
    dependent = []
    for matrix in numbers(linkage, fields, states):
        norms = [max(abs(v) for v in row) for row in matrix]
        sizes = norms[: len(spanning)]
        for k in range(len(more)):
            forth, back, x, y = norms[count + 4 * k : count + 4 * k + 4]
            sizes.append(max(forth, back, FAINT * x * y))
        dependent.append(elimination.dependencies(matrix[:count], sizes).keys())
    # the generic rank is the largest
    best = min(dependent, key=len)
    return [b.value for i, b in enumerate(more) if len(spanning) + i not in best]


def directions(
    linkage: Linkage, given: Covectors, kept: Sequence[int], states: Sequence[State]
) -> list[Field]:
    """A basis of the null space on the graph; numbers choose the pivots."""
    rows = [given.rows[i] for i in kept]
    pivots = _pivots(linkage, rows, states)
    work = {i: list(row) for i, row in enumerate(rows)}
    for i, j in pivots:
        work[i] = [v / work[i][j] for v in work[i]]
        for k in work:
            if k != i and work[k][j] is not linkage.zero:
                factor = work[k][j]
                work[k] = [a - factor * b for a, b in zip(work[k], work[i], strict=True)]
    one, solved = linkage.zero + 1, {j: work[i] for i, j in pivots}
    size = range(len(given.symbols))
    return [
        tuple(one if j == own else -solved[j][own] if j in solved else linkage.zero for j in size)
        for own in size
        if own not in solved
    ]


def _pivots(
    linkage: Linkage, rows: Sequence[Field], states: Sequence[State]
) -> tuple[tuple[int, int], ...]:
    """(row, column) in order; the choice whose worst state is best."""
    if not rows:
        return ()
    matrices = numbers(linkage, rows, states)
    candidates = dict.fromkeys(elimination.full(m).pivots for m in matrices)

    def worst(pivots: tuple[tuple[int, int], ...]) -> Any:
        columns = [j for _, j in pivots]
        return min(elimination.volume([[row[j] for j in columns] for row in m]) for m in matrices)

    return max((p for p in candidates if len(p) == len(rows)), key=worst)


def annihilates(
    linkage: Linkage, covector: Field, reached: Growth, states: Sequence[State]
) -> bool:
    """Whether no direction that was reached leaves the level sets of the row: it is integrable."""
    for matrix in numbers(linkage, [covector, *reached.fields], states):
        row, *fields = matrix
        size = max((abs(v) for v in row), default=0)
        for field in fields:
            scale = size * max(abs(v) for v in field)
            if abs(dot(row, field)) > elimination.TOLERANCE * scale:
                return False
    return True
