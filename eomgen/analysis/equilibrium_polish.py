"""A root to 30 digits: Newton's method in 100 digits on the graph."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from typing import Any

import mpmath
import numpy as np

from eomgen.algebra.arithmetic import Arithmetic, mpmath_arithmetic
from eomgen.analysis.equilibrium_scene import DIGITS, Numbers, Scene
from eomgen.analysis.equilibrium_search import RANK, system_matrix

SHOWN = 30  # digits of a value
MOST_STEPS = 400  # a root of multiplicity m converges like (1 - 1/m)^n
NOISE = 1e-12  # rows and columns smaller than this share of the largest are zero
NEGLIGIBLE = 1e-28  # of the size of a coordinate: zero


@dataclass(frozen=True)
class Root:
    """A root in 100-digit numbers, with everything at it."""

    coordinates: tuple[Any, ...]
    multipliers: tuple[Any, ...]
    numbers: Numbers
    regular: bool  # the system's matrix has full rank


@cache
def precise() -> Arithmetic:
    """The arithmetic of the roots."""
    return mpmath_arithmetic(DIGITS)


def context() -> Any:
    """The mpmath context of that arithmetic."""
    return precise().number(0).context


def numbers_at(scene: Scene, q: Sequence[Any], multipliers: Sequence[Any]) -> Numbers | None:
    """Everything at a point; None where a formula has no value."""
    try:
        return scene.at(q, multipliers, precise())
    except (ZeroDivisionError, ValueError):
        return None


def root(
    scene: Scene, q: Sequence[Any], multipliers: Sequence[Any], free: Sequence[int]
) -> Root | None:
    """The root next to a point; None where Newton's method finds none."""
    ctx = context()
    x = [ctx.convert(v) for v in (*q, *multipliers)]
    columns = [*free, *range(len(q), len(x))]
    last = ctx.inf
    for _ in range(MOST_STEPS):
        found = numbers_at(scene, x[: len(q)], x[len(q) :])
        if found is None:
            return None
        change = _change(scene, found, free)
        for k, dx in zip(columns, change, strict=True):
            x[k] -= dx
        moved = max((abs(dx) for dx in change), default=ctx.zero)
        if moved <= ctx.mpf(10) ** (-DIGITS + 20) or (moved > last and moved < 1e-25):
            break
        last = moved
    return checked(scene, x[: len(q)], x[len(q) :], free)


def checked(
    scene: Scene, q: Sequence[Any], multipliers: Sequence[Any], free: Sequence[int]
) -> Root | None:
    """The point as a root if the equations hold there to 20 digits."""
    ctx = context()
    q, multipliers = [ctx.convert(v) for v in q], [ctx.convert(v) for v in multipliers]
    found = numbers_at(scene, q, multipliers)
    if found is None:
        return None
    left = [abs(v) for v in (*found.balances, *found.residuals)]
    sizes = [abs(v) for row in (*found.slopes, *found.jacobian) for v in row]
    if max(left, default=0) > 1e-20 * max([*sizes, ctx.mpf(1e-300)]):
        return None
    return Root(tuple(q), tuple(multipliers), found, is_regular(scene, found, free))


def is_regular(scene: Scene, found: Numbers, free: Sequence[int]) -> bool:
    """Whether the system's matrix has full column rank there, in plain floats."""
    matrix = _floats(scene, found, free)
    if not matrix.shape[1]:
        return True
    rows = np.max(np.abs(matrix), axis=1, initial=0.0)
    noise = NOISE * rows.max(initial=0.0)  # what is left of zeros is not scaled up to one
    matrix = matrix / np.where(rows > noise, rows, 1.0)[:, None]
    columns = np.max(np.abs(matrix), axis=0, initial=0.0)
    if columns.min() <= NOISE * columns.max() or matrix.shape[0] < matrix.shape[1]:
        return False
    values = np.linalg.svd(matrix / columns, compute_uv=False)
    return bool(values[-1] > RANK * values[0])


def _floats(scene: Scene, found: Numbers, free: Sequence[int]) -> Any:
    plain = Numbers(
        [float(v) for v in found.balances],
        [float(v) for v in found.residuals],
        [],
        [[float(v) for v in row] for row in found.jacobian],
        [[float(v) for v in row] for row in found.slopes],
    )
    return system_matrix(plain, scene.holonomic, free, 1)[0]


def _change(scene: Scene, found: Numbers, free: Sequence[int]) -> list[Any]:
    """The Newton step, of least size where the matrix is singular."""
    ctx = context()
    matrix = ctx.matrix(_rows(scene, found, free))
    right = ctx.matrix([*found.balances, *found.residuals])
    if not matrix.cols:
        return []
    if matrix.rows == matrix.cols and is_regular(scene, found, free):
        try:
            return list(ctx.lu_solve(matrix, right))
        except ZeroDivisionError:
            return _least(matrix, right)  # rows of very different size
    return _least(matrix, right)


def _rows(scene: Scene, found: Numbers, free: Sequence[int]) -> list[list[Any]]:
    rows = [
        [found.slopes[i][j] for j in free] + [jacobian[i] for jacobian in found.jacobian]
        for i in range(len(found.slopes))
    ]
    for jacobian, holonomic in zip(found.jacobian, scene.holonomic, strict=True):
        if holonomic:
            rows.append([jacobian[j] for j in free] + [0] * len(found.jacobian))
    return rows


def _least(matrix: Any, right: Any) -> list[Any]:
    """The pseudo-inverse times the right side."""
    ctx = context()
    wide = matrix.rows < matrix.cols
    u, s, v = ctx.svd_r(matrix.T if wide else matrix)
    u, v = (v.T, u.T) if wide else (u, v)
    cut = max(s) * ctx.mpf(10) ** (-DIGITS * 7 // 10)
    loads = u.T * right
    shares = ctx.matrix([loads[i] / s[i] if s[i] > cut else ctx.zero for i in range(len(s))])
    return list(v.T * shares)


def decimal(value: Any, size: float = 1.0) -> Decimal:
    """The value with 30 digits; what is negligible beside `size` is zero."""
    if abs(value) <= NEGLIGIBLE * size:
        return Decimal(0)
    return Decimal(mpmath.nstr(value, SHOWN))
