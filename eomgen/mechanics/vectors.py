"""Small vectors and matrices of scalars of either algebra; a matrix is a tuple of rows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from eomgen.algebra.scalar import Scalar

S = TypeVar("S", bound=Scalar)
Vector = tuple[S, ...]
Matrix = tuple[tuple[S, ...], ...]


def dot(left: Sequence[S], right: Sequence[S]) -> S:
    """The scalar product."""
    first, *others = (a * b for a, b in zip(left, right, strict=True))
    for product in others:
        first = first + product
    return first


def cross(a: Sequence[S], b: Sequence[S]) -> Vector[S]:
    """A x b in three dimensions."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def add(left: Sequence[S], right: Sequence[S]) -> Vector[S]:
    """The sum of two vectors."""
    return tuple(a + b for a, b in zip(left, right, strict=True))


def subtract(left: Sequence[S], right: Sequence[S]) -> Vector[S]:
    """The difference of two vectors."""
    return tuple(a - b for a, b in zip(left, right, strict=True))


def scale(factor: S, vector: Sequence[S]) -> Vector[S]:
    """Factor * vector."""
    return tuple(factor * a for a in vector)


def transform(matrix: Sequence[Sequence[S]], vector: Sequence[S]) -> Vector[S]:
    """Matrix * vector."""
    return tuple(dot(row, vector) for row in matrix)


def transpose(matrix: Sequence[Sequence[S]]) -> Matrix[S]:
    """The transposed matrix."""
    return tuple(zip(*matrix, strict=True))


def compose(left: Sequence[Sequence[S]], right: Sequence[Sequence[S]]) -> Matrix[S]:
    """The product of two matrices."""
    columns = transpose(right)
    return tuple(tuple(dot(row, column) for column in columns) for row in left)
