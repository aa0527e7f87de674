"""Rotation matrices: columns are the turned axes, in the axes before the turn."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import sympy as sp

from eomgen.algebra.scalar import Algebra, S
from eomgen.mechanics.vectors import Matrix, Vector, scale
from eomgen.model import Quaternion, Turn


def unit(algebra: Algebra[S], axis: tuple[sp.Expr, ...]) -> Vector[S]:
    """The axis divided by its length."""
    components = [algebra.of(c) for c in axis]
    length = sp.sqrt(sum(c**2 for c in axis))
    return tuple(components) if length == 1 else scale(algebra.of(1 / length), components)


def planar(algebra: Algebra[S], angle: S) -> Matrix[S]:
    """A turn by `angle` [rad] in the plane, counted from x to y."""
    s, c = algebra.apply("sin", angle), algebra.apply("cos", angle)
    return ((c, -s), (s, c))


def about(algebra: Algebra[S], axis: Vector[S], angle: S) -> Matrix[S]:
    """R = cos(a) 1 + (1 - cos(a)) e e' + sin(a) [e x] (Rodrigues), e a unit vector (3,)."""
    s, c = algebra.apply("sin", angle), algebra.apply("cos", angle)
    zero = algebra.number(0)
    tilde = (
        (zero, -axis[2], axis[1]),
        (axis[2], zero, -axis[0]),
        (-axis[1], axis[0], zero),
    )
    rows = []
    for i in range(3):
        # e_i^2 + (1 - e_i^2) cos(a) is 1 or cos(a) where the axis is along x, y or z
        square = axis[i] * axis[i]
        row = [(axis[i] * axis[j]) * (1 - c) + tilde[i][j] * s for j in range(3)]
        row[i] = square + (1 - square) * c
        rows.append(tuple(row))
    return tuple(rows)


def of(algebra: Algebra[S], turn: Turn | Quaternion) -> Matrix[S]:
    """The rotation matrix of a turn."""
    if isinstance(turn, Quaternion):
        return quaternion(algebra, [algebra.of(s) for s in turn.symbols])
    return about(algebra, unit(algebra, turn.axis), algebra.of(turn.angle))


def quaternion(algebra: Algebra[S], parts: Sequence[S]) -> Matrix[S]:
    """R = 1 + 2 (e0 [v x] + [v x]^2) for the unit quaternion (e0, v)."""
    e, x, y, z = parts
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - e * z), 2 * (x * z + e * y)),
        (2 * (x * y + e * z), 1 - 2 * (x * x + z * z), 2 * (y * z - e * x)),
        (2 * (x * z - e * y), 2 * (y * z + e * x), 1 - 2 * (x * x + y * y)),
    )


def identity(algebra: Algebra[S], size: int) -> Matrix[S]:
    """The unit matrix."""
    return tuple(
        tuple(algebra.number(Fraction(int(i == j))) for j in range(size)) for i in range(size)
    )
