"""Newton's method with least-change steps: in doubles first, then polished to 50 digits.

dx = -J^+ r, with the pseudo-inverse J^+ in doubles: redundant rows do no harm, and every step is
the smallest one. The polishing steps keep J^+ in doubles and the residual r in 50 digits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from eomgen.algebra.arithmetic import FLOAT, Arithmetic
from eomgen.analysis.linkage import IRREGULAR, PRECISE

Floats = npt.NDArray[np.float64]
Rows = tuple[list[Any], list[list[Any]]]  # residuals, Jacobian
Problem = Callable[[Sequence[Any], Arithmetic], Rows]

MOST_STEPS = 100
SLOW = 0.97  # a step that leaves more than this share of the residual
PATIENCE = 5  # slow steps on end, as at a minimum that is no zero
MOST_POLISHING = 250  # linear convergence, where J loses rank, gains one bit a step
CUT = 1e-11  # singular values below this share of the largest are zero
FLOAT_TOLERANCE = 1e-10
ROUND_OFF = 1e-15
TOLERANCE = PRECISE.number(10) ** -44
SHORTEST = 2.0**-20  # of the line search
LENGTH = 1e-3  # a coordinate at zero still has a size


@dataclass(frozen=True)
class Outcome:
    """Where the search ended, and what is left of every residual there."""

    values: tuple[Any, ...]
    residuals: tuple[Any, ...]
    closed: bool


def close(problem: Problem, start: Sequence[Any], movable: Sequence[int]) -> Outcome:
    """The nearest zero of the residuals that Newton finds, moving only the `movable` values."""
    rough = _descend(problem, np.array([float(v) for v in start]), list(movable))
    if rough is None:
        return Outcome(tuple(start), (), False)
    values: list[Any] = [PRECISE.number(v) for v in start]
    for i in movable:
        values[i] = PRECISE.number(float(rough[i]))
    try:
        return _polish(problem, values, list(movable))
    except IRREGULAR:
        return Outcome(tuple(start), (), False)


def roughly(problem: Problem, start: Sequence[Any]) -> Floats | None:
    """A zero of the residuals in doubles, moving everything; None where none is found.

    The search goes on to round-off: where the zero is a double one it gains one bit a step.
    """
    try:
        everything = list(range(len(start)))
        x = _descend(problem, np.array([float(v) for v in start]), everything, ROUND_OFF)
        return x if x is not None and _is_closed(*_floats(problem, x), x, FLOAT_TOLERANCE) else None
    except (np.linalg.LinAlgError, *IRREGULAR):
        return None


def _descend(
    problem: Problem, x: Floats, movable: list[int], tolerance: float = FLOAT_TOLERANCE
) -> Floats | None:
    """The last point of a damped Gauss-Newton search; None where nothing is defined."""
    try:
        residual, slope = _floats(problem, x)
    except IRREGULAR:
        return None
    slow = 0
    for _ in range(MOST_STEPS):
        if _is_closed(residual, slope, x, tolerance) or not movable or slow > PATIENCE:
            break
        step = np.zeros_like(x)
        step[movable] = -np.linalg.pinv(slope[:, movable], rcond=CUT) @ residual
        before = float(np.linalg.norm(residual))
        found = _search(problem, x, step, before)
        if found is None:
            break
        x, residual, slope = found
        slow = slow + 1 if np.linalg.norm(residual) > SLOW * before else 0
    return x


def _floats(problem: Problem, x: Floats) -> tuple[Floats, Floats]:
    residual, slope = problem([float(v) for v in x], FLOAT)
    matrix = np.array(slope, dtype=float).reshape(len(residual), len(x))
    if not (np.isfinite(matrix).all() and np.isfinite(residual).all()):
        raise ValueError("not defined here")
    return np.array(residual, dtype=float), matrix


def _search(
    problem: Problem, x: Floats, step: Floats, norm: float
) -> tuple[Floats, Floats, Floats] | None:
    """The longest of the halved steps that lowers the residual; None where none does."""
    share = 1.0
    while share >= SHORTEST:
        try:
            residual, slope = _floats(problem, x + share * step)
        except IRREGULAR:
            share /= 2
            continue
        if np.linalg.norm(residual) < norm * (1 - share / 10):
            return x + share * step, residual, slope
        share /= 2
    return None


def _is_closed(residual: Any, slope: Any, x: Any, tolerance: Any) -> bool:
    """|r_i| <= tolerance * sum |J_ij| |x_j| for every row."""
    sizes = [abs(v) + LENGTH for v in x]
    return all(
        abs(r) <= tolerance * (LENGTH**2 + sum(abs(s) * v for s, v in zip(row, sizes, strict=True)))
        for r, row in zip(residual, slope, strict=True)
    )


def _polish(problem: Problem, values: list[Any], movable: list[int]) -> Outcome:
    """The zero in 50 digits."""
    previous = None
    for _ in range(MOST_POLISHING):
        residual, slope = problem(values, PRECISE)
        size = max((abs(r) for r in residual), default=0)
        closed = _is_closed(residual, slope, values, TOLERANCE)
        stuck = previous is not None and size > previous * 0.9
        if closed or not movable or stuck:
            break
        previous = size
        matrix = np.array([[float(s) for s in row] for row in slope])[:, movable]
        inverse = np.linalg.pinv(matrix, rcond=CUT)
        for i, weights in zip(movable, inverse, strict=True):
            shares = (PRECISE.number(float(w)) * r for w, r in zip(weights, residual, strict=True))
            values[i] = values[i] - sum(shares, PRECISE.number(0))
    return Outcome(tuple(values), tuple(residual), closed)
