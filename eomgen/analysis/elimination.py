"""Elimination with pivots chosen by size, in 50 digits: rank, dependence, solutions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from eomgen.analysis.linkage import PRECISE

TOLERANCE = PRECISE.number(10) ** -25  # of a pivot, relative to the size of its row
Matrix = Sequence[Sequence[Any]]


@dataclass(frozen=True)
class Elimination:
    """What full pivoting leaves: `pivots` are (row, column), the largest first."""

    pivots: tuple[tuple[int, int], ...]

    @property
    def rank(self) -> int:
        """The number of pivots."""
        return len(self.pivots)


def full(matrix: Matrix) -> Elimination:
    """Full pivoting on the rows scaled to one."""
    rows = [_scaled(row) for row in matrix]
    left = set(range(len(rows)))
    pivots: list[tuple[int, int]] = []
    while left:
        size, i, j = max((abs(v), -i, -j) for i in left for j, v in enumerate(rows[i]))
        i, j = -i, -j
        if size <= TOLERANCE:
            break
        pivots.append((i, j))
        left.remove(i)
        for k in left:
            rows[k] = _without(rows[k], rows[i], j)
    return Elimination(tuple(pivots))


def rank(matrix: Matrix) -> int:
    """The rank, by full pivoting."""
    return full(matrix).rank if matrix and matrix[0] else 0


def volume(matrix: Matrix) -> Any:
    """|det| of a square matrix whose rows were scaled to one: how well its columns determine it."""
    if not matrix:
        return PRECISE.number(1)
    rows = [_scaled(row) for row in matrix]
    result = PRECISE.number(1)
    pivots = full(matrix).pivots
    for place, (i, j) in enumerate(pivots):
        result = result * abs(rows[i][j])
        for k, _ in pivots[place + 1 :]:
            rows[k] = _without(rows[k], rows[i], j)
    return result if len(pivots) == len(rows) else PRECISE.number(0)


def _scaled(row: Sequence[Any]) -> list[Any]:
    size = max(abs(v) for v in row)
    return [v / size for v in row] if size else list(row)


def _without(row: Sequence[Any], pivot: Sequence[Any], j: int) -> list[Any]:
    """The row less the multiple of the pivot row that clears column j."""
    factor = row[j] / pivot[j]
    return [a - factor * b for a, b in zip(row, pivot, strict=True)]


def dependencies(matrix: Matrix, sizes: Sequence[Any] | None = None) -> dict[int, tuple[int, ...]]:
    """Each row that depends on rows before it -> those rows; a zero row depends on none.

    sizes: what the entries of each row are small against; by default the largest of them.
    """
    return {i: tuple(shares) for i, shares in combinations(matrix, sizes).items()}


def combinations(matrix: Matrix, sizes: Sequence[Any] | None = None) -> dict[int, dict[int, Any]]:
    """Each row that depends on rows before it -> which multiples of these it is the sum of.

    sizes: as for `dependencies`.
    """
    kept: list[tuple[list[Any], int]] = []  # (row with its combination behind it, pivot column)
    found: dict[int, dict[int, Any]] = {}
    width = len(matrix[0]) if matrix else 0
    scales = [max(map(abs, row), default=0) or 1 for row in matrix] if sizes is None else sizes
    for i, row in enumerate(matrix):
        # behind the row stands which multiples of the scaled rows it is
        work = [v / scales[i] for v in row]
        work += [PRECISE.number(int(i == k)) for k in range(len(matrix))]
        for pivot, column in kept:
            work = _without(work, pivot, column)
        size, column = max((abs(v), -j) for j, v in enumerate(work[:width]))
        if size > TOLERANCE:
            kept.append((work, -column))
        else:
            shares = enumerate(work[width : width + i])
            found[i] = {k: -v * scales[i] / scales[k] for k, v in shares if abs(v) > TOLERANCE}
    return found


def pivot_columns(matrix: Matrix, preferred: Sequence[int], least: float) -> tuple[int, ...]:
    """Columns that carry the rank, `preferred` ones first where their pivots exceed `least`."""
    rows = [_scaled(row) for row in matrix]
    chosen: list[int] = []
    others = [j for j in range(len(matrix[0]) if matrix else 0) if j not in preferred]
    for columns, threshold in ((list(preferred), least), (others + list(preferred), TOLERANCE)):
        while rows:
            free = [j for j in columns if j not in chosen]
            best = max(
                ((abs(r[j]), -i, -j) for i, r in enumerate(rows) for j in free), default=None
            )
            if best is None or best[0] <= threshold:
                break
            pivot, column = rows.pop(-best[1]), -best[2]
            chosen.append(column)
            rows = [_without(row, pivot, column) for row in rows]
    return tuple(sorted(chosen))


def solved(matrix: Matrix, right: Matrix) -> list[list[Any]]:
    """X of A X = B for a square A, by full pivoting.

    Raises:
        ZeroDivisionError: A is singular.
    """
    size = len(matrix)
    work = [[*a, *b] for a, b in zip(matrix, right, strict=True)]
    pivots = full(matrix).pivots
    if len(pivots) < size:
        raise ZeroDivisionError("the matrix is singular")
    for i, j in pivots:
        work[i] = [v / work[i][j] for v in work[i]]
        work = [row if k == i else _without(row, work[i], j) for k, row in enumerate(work)]
    result: list[list[Any]] = [[]] * size
    for i, j in pivots:
        result[j] = work[i][size:]
    return result
