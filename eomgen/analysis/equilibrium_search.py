"""Roots by Newton's method from many starts: what is found is a root, what is missed is not known.

The starts are a low-discrepancy sequence in the given box (Roberts: x_n = frac(n a), a_k = p^-k
with p^(d+1) = p + 1), so that the same scene gives the same starts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eomgen.algebra.arithmetic import NUMPY
from eomgen.analysis.equilibrium_scene import Numbers, Scene

Array = NDArray[np.float64]

STARTS = 400
ITERATIONS = 120
COARSE, FINE = 1e-3, 1e-10  # shares of singular values that count: far from a root, near it
SAMPLES = 16  # points at which typical sizes are read off
SAME = 1e-6  # of the size of the box: nearer roots are one
ACCEPTED = 1e-9  # residual, of the typical one at the starts
RANK = 1e-7  # singular values below this share of the largest are zero


@dataclass(frozen=True)
class Box:
    """Where the coordinates start: `low` and `high`; `periods` of angles, 0 for the others."""

    low: Array
    high: Array
    periods: Array

    @property
    def width(self) -> Array:
        """The sides."""
        return self.high - self.low


@dataclass(frozen=True)
class Hit:
    """A root in plain floats, how many starts led to it, and the first that did."""

    coordinates: Array
    multipliers: Array
    count: int
    first: int


@dataclass(frozen=True)
class Search:
    """All hits in the order in which they were found."""

    hits: tuple[Hit, ...]
    starts: int
    failed: int  # starts that led to no root


def search(
    scene: Scene, box: Box, free: Sequence[int], first: Sequence[float], starts: int = STARTS
) -> Search:
    """Roots from many starts; coordinates that are not `free` stay as they are at the first."""
    q = box.low + box.width * _sequence(len(box.low), starts)
    q[0] = first
    held = [k for k in range(len(box.low)) if k not in free]
    q[:, held] = q[0, held]
    unknown = _Unknowns(scene, box, tuple(free))
    multipliers = unknown.first_multipliers(q)
    scale = unknown.scale(q)
    for i in range(ITERATIONS):
        q, multipliers = unknown.step(q, multipliers, COARSE if 2 * i < ITERATIONS else FINE)
    residual = unknown.residual(q, multipliers)
    small: Any = np.isfinite(residual) & (np.abs(residual) <= ACCEPTED * scale)
    good: Any = small.all(axis=1)
    hits = _merged(box, q, multipliers, good)
    return Search(tuple(hits), starts, int(starts - good.sum()))


def _sequence(dimensions: int, count: int) -> Array:
    """Points of the unit cube."""
    p = 2.0
    for _ in range(60):
        p = (1 + p) ** (1 / (dimensions + 1))
    steps = p ** -np.arange(1, dimensions + 1)
    return np.mod(0.5 + np.outer(np.arange(1, count + 1), steps), 1.0)


@dataclass(frozen=True)
class _Unknowns:
    """Newton's steps of F(q, lambda) = 0 over arrays of points."""

    scene: Scene
    box: Box
    free: tuple[int, ...]

    def numbers(self, q: Array, multipliers: Array) -> Numbers:
        """All numbers at every point."""
        with NUMPY.quiet():
            return self.scene.at(list(q.T), list(multipliers.T), NUMPY)

    def residual(self, q: Array, multipliers: Array) -> Array:
        """F, one row for each point."""
        found = self.numbers(q, multipliers)
        return _stack([*found.balances, *found.residuals], len(q))

    def first_multipliers(self, q: Array) -> Array:
        """The multipliers that come nearest to equilibrium."""
        rows = len(self.scene.multipliers)
        zero = np.zeros((len(q), rows))
        if not rows:
            return zero
        found = self.numbers(q, zero)
        jacobian = _matrix(found.jacobian, len(q))
        forces = _stack(found.balances, len(q))
        return -_solved(np.swapaxes(jacobian, 1, 2), forces)

    def scale(self, q: Array) -> Array:
        """A typical size of every equation over the starts, never zero."""
        found = self.numbers(q, np.zeros((len(q), len(self.scene.multipliers))))
        forces = np.abs(_stack(found.balances, len(q)))
        parts = [np.full(len(found.balances), _typical(forces))]
        if found.residuals:
            parts.append(_columns(np.abs(_stack(found.residuals, len(q)))))
        return np.concatenate(parts)

    def step(self, q: Array, multipliers: Array, cut: float) -> tuple[Array, Array]:
        """One step, no coordinate moving more than a tenth of the box."""
        found = self.numbers(q, multipliers)
        residual = _stack([*found.balances, *found.residuals], len(q))
        matrix = system_matrix(found, self.scene.holonomic, self.free, len(q))
        lengths = self.box.width[list(self.free)]
        sizes = np.concatenate([lengths, np.ones(len(self.scene.multipliers))])
        change = -_solved(matrix * sizes, residual, cut) * sizes
        moves = change[:, : len(self.free)]
        largest = np.max(np.abs(moves) / lengths, axis=1, initial=0.0)
        moves = moves * np.minimum(1.0, 0.1 / np.maximum(largest, 1e-300))[:, None]
        q = q.copy()
        q[:, list(self.free)] += moves
        return q, multipliers + change[:, len(self.free) :]


def system_matrix(
    found: Numbers, holonomic: Sequence[bool], free: Sequence[int], count: int
) -> Array:
    """dF/d(q, lambda): slopes beside J', and J of the holonomic rows beside nothing."""
    slopes = _matrix(found.slopes, count)[:, :, list(free)]
    rows = len(found.jacobian)
    if not rows:
        return slopes
    jacobian = _matrix(found.jacobian, count)
    positions = jacobian[:, list(holonomic), :][:, :, list(free)]
    above = np.concatenate([slopes, np.swapaxes(jacobian, 1, 2)], axis=2)
    below = np.concatenate([positions, np.zeros((count, positions.shape[1], rows))], axis=2)
    return np.concatenate([above, below], axis=1)


def typical_slope(scene: Scene, box: Box) -> float:
    """The size of the largest d Q_i / d q_j at points of the box, without multipliers."""
    q = box.low + box.width * _sequence(len(box.low), SAMPLES)
    with NUMPY.quiet():
        found = scene.at(list(q.T), [np.zeros(SAMPLES)] * len(scene.multipliers), NUMPY)
    sizes = np.abs(_stack([v for row in found.slopes for v in row], SAMPLES)).max(axis=1)
    kept = sizes[np.isfinite(sizes)]
    return float(np.median(kept)) if kept.size else 0.0


def _stack(values: Sequence[Any], count: int) -> Array:
    """Values by point."""
    if not values:
        return np.zeros((count, 0))
    return np.stack([np.broadcast_to(np.asarray(v, float), (count,)) for v in values], axis=1)


def _matrix(rows: Sequence[Sequence[Any]], count: int) -> Array:
    return np.stack([_stack(row, count) for row in rows], axis=1)


def _typical(values: Array) -> float:
    """The median of the largest entries that are finite; 1 where all vanish."""
    largest = np.max(values, axis=1)
    kept = largest[np.isfinite(largest)]
    median = float(np.median(kept)) if kept.size else 0.0
    return median or 1.0


def _columns(values: Array) -> Array:
    return np.array([_typical(values[:, [k]]) for k in range(values.shape[1])])


def _solved(matrix: Any, right: Any, cut: float = FINE) -> Array:
    """The least squares solution at every point; zero where the numbers are not finite."""
    fine = np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite(right).all(axis=1)
    matrix = np.where(fine[:, None, None], matrix, 0.0)
    right = np.where(fine[:, None], right, 0.0)
    size = np.max(np.abs(matrix), axis=2, initial=0.0)
    size = np.where(size > 0, size, 1.0)
    scaled, load = matrix / size[:, :, None], right / size
    result: Array = (np.linalg.pinv(scaled, rcond=cut) @ load[:, :, None])[:, :, 0]
    return result


def distance(box: Box, a: Array, b: Array) -> float:
    """The largest difference in shares of the box, whole turns apart."""
    gap = np.abs(a - b)
    turned = np.where(
        box.periods > 0,
        np.abs(gap - box.periods * np.round(gap / np.where(box.periods > 0, box.periods, 1.0))),
        gap,
    )
    return float(np.max(turned / box.width, initial=0.0))


def _merged(box: Box, q: Array, multipliers: Array, good: Any) -> list[Hit]:
    """Equal roots as one hit."""
    hits: list[Hit] = []
    for start in np.flatnonzero(good):
        for i, hit in enumerate(hits):
            if distance(box, hit.coordinates, q[start]) < SAME:
                hits[i] = Hit(hit.coordinates, hit.multipliers, hit.count + 1, hit.first)
                break
        else:
            hits.append(Hit(q[start], multipliers[start], 1, int(start) + 1))
    return hits
