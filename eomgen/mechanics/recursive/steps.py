"""Steps from a place to the next: how twists go forward, wrenches and inertias back.

A step maps the twist t of the place before to X t, a wrench w back to X' w and an inertia matrix
to X' I X. `accelerated` is X a plus everything that velocities and prescribed motion add while
every q'' is zero. Lines, planes and points in space use world axes, so that X is a small sparse
matrix (`Flat`); frames in space use their own axes, and X is a chain of shifts and turns.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from eomgen.algebra.graph import Node
from eomgen.mechanics.recursive import rigid
from eomgen.mechanics.recursive.rigid import PAIRS, Rigid
from eomgen.mechanics.vectors import (
    Matrix,
    Vector,
    add,
    compose,
    cross,
    dot,
    scale,
    transform,
)
from eomgen.mechanics.vectors import transpose as transposed


class Step(Protocol):
    """What a recursion asks of a step."""

    def motion(self, twist: Vector[Node]) -> Vector[Node]:
        """X t."""

    def accelerated(self, acceleration: Vector[Node]) -> Vector[Node]:
        """X a + the terms of velocities and prescribed motion."""

    def force(self, wrench: Vector[Node]) -> Vector[Node]:
        """X' w."""

    def inertia(self, matrix: Matrix[Node]) -> Matrix[Node]:
        """X' I X."""

    def rigid(self, body: Rigid) -> Rigid | None:
        """The same inertia before the step; None where it is no rigid body's."""

    def bound(self, sizes: Vector[Node]) -> Vector[Node]:
        """What bounds the diagonal of X' I X, up to a small factor, from a bound of I's."""


@dataclass(frozen=True)
class Flat:
    """A sparse matrix, for places whose twists are in world axes."""

    matrix: Matrix[Node]
    drift: Vector[Node]
    anchor: Vector[Node] | None = None  # where a frame's origin is fixed, in the base's axes

    def motion(self, twist: Vector[Node]) -> Vector[Node]:
        """X t."""
        return transform(self.matrix, twist)

    def accelerated(self, acceleration: Vector[Node]) -> Vector[Node]:
        """X a + drift."""
        return add(self.motion(acceleration), self.drift)

    def force(self, wrench: Vector[Node]) -> Vector[Node]:
        """X' w."""
        return transform(transposed(self.matrix), wrench)

    def inertia(self, matrix: Matrix[Node]) -> Matrix[Node]:
        """X' I X."""
        return congruent(self.matrix, matrix)

    def rigid(self, body: Rigid) -> Rigid | None:
        """Never."""

    def bound(self, sizes: Vector[Node]) -> Vector[Node]:
        """Sum of X_ki^2 I_kk."""
        columns = transposed(self.matrix)
        return tuple(dot(sizes, tuple(x * x for x in column)) for column in columns)


def congruent(left: Matrix[Node], matrix: Matrix[Node]) -> Matrix[Node]:
    """X' I X, each entry of the symmetric result once."""
    columns = transposed(left)
    moved = tuple(transform(matrix, column) for column in columns)
    size = range(len(columns))
    lower = [[dot(columns[j], moved[i]) for j in range(i + 1)] for i in size]
    return tuple(tuple(lower[max(i, j)][min(i, j)] for j in size) for i in size)


@dataclass(frozen=True)
class Shift:
    """To an origin at `arm` in the same axes, which turn with `spin`; the arm may move."""

    spin: Vector[Node]
    arm: Vector[Node]
    rate: Vector[Node]
    drift: Vector[Node]  # second rate of the arm with every q'' = 0

    def motion(self, twist: Vector[Node]) -> Vector[Node]:
        """(w, v + w x r)."""
        return (*twist[:3], *add(twist[3:], cross(twist[:3], self.arm)))

    def accelerated(self, acceleration: Vector[Node]) -> Vector[Node]:
        """(alpha, a + U r + 2 w x r' + r'')."""
        alpha, linear = acceleration[:3], acceleration[3:]
        linear = add(linear, transform(rigid.swirl(self.spin, alpha), self.arm))
        linear = add(linear, scale(linear[0].graph.number(2), cross(self.spin, self.rate)))
        return (*alpha, *add(linear, self.drift))

    def force(self, wrench: Vector[Node]) -> Vector[Node]:
        """(n + r x f, f)."""
        return (*add(wrench[:3], cross(self.arm, wrench[3:])), *wrench[3:])

    def inertia(self, matrix: Matrix[Node]) -> Matrix[Node]:
        """H' = H + [r x] M,  A' = A - H [r x] + [r x] H'^T."""
        rows = [list(row) for row in matrix]
        for k in range(3):
            moved = cross(self.arm, tuple(matrix[3 + i][3 + k] for i in range(3)))
            for i in range(3):
                rows[i][3 + k] = rows[3 + k][i] = matrix[i][3 + k] + moved[i]
        before = [cross(self.arm, matrix[i][3:]) for i in range(3)]
        after = [cross(self.arm, tuple(rows[j][3:])) for j in range(3)]
        for i in range(3):
            for j in range(i + 1):
                rows[i][j] = rows[j][i] = matrix[i][j] + (before[i][j] + after[j][i])
        return tuple(tuple(row) for row in rows)

    def rigid(self, body: Rigid) -> Rigid | None:
        """About the origin before."""
        return rigid.shifted(body, self.arm)

    def bound(self, sizes: Vector[Node]) -> Vector[Node]:
        """The masses add their squared distance to the second moments."""
        return with_arm(sizes, self.arm, 3)


def with_arm(sizes: Vector[Node], arm: Vector[Node], spins: int) -> Vector[Node]:
    """Bounds of the diagonal about an origin from which the old one is at `arm`."""
    square = dot(arm, arm)
    return (*(size + sizes[spins] * square for size in sizes[:spins]), *sizes[spins:])


@dataclass(frozen=True)
class Turn:
    """About axis 0, 1 or 2 by an angle; `spin` is the angular velocity before, in the axes after.

    Two products a component: v_i' = c v_i + s v_j,  v_j' = c v_j - s v_i.
    """

    axis: int
    sine: Node
    cosine: Node
    rate: Node
    drift: Node
    spin: Vector[Node]

    def _after(self, vector: Sequence[Node]) -> Vector[Node]:
        (i, j), result = PAIRS[self.axis], list(vector)
        result[i] = self.cosine * vector[i] + self.sine * vector[j]
        result[j] = self.cosine * vector[j] - self.sine * vector[i]
        return tuple(result)

    def _before(self, vector: Sequence[Node]) -> Vector[Node]:
        (i, j), result = PAIRS[self.axis], list(vector)
        result[i] = self.cosine * vector[i] - self.sine * vector[j]
        result[j] = self.sine * vector[i] + self.cosine * vector[j]
        return tuple(result)

    def motion(self, twist: Vector[Node]) -> Vector[Node]:
        """Both parts in the axes after."""
        return (*self._after(twist[:3]), *self._after(twist[3:]))

    def accelerated(self, acceleration: Vector[Node]) -> Vector[Node]:
        """Alpha gains w x e phi' + e phi''."""
        return self.gained(self.motion(acceleration))

    def gained(self, moved: Vector[Node]) -> Vector[Node]:
        """What has been turned, with what the rate of the turn adds."""
        (i, j), result = PAIRS[self.axis], list(moved)
        result[i] = result[i] + self.spin[j] * self.rate
        result[j] = result[j] - self.spin[i] * self.rate
        result[self.axis] = result[self.axis] + self.drift
        return tuple(result)

    def force(self, wrench: Vector[Node]) -> Vector[Node]:
        """Both parts in the axes before."""
        return (*self._before(wrench[:3]), *self._before(wrench[3:]))

    def inertia(self, matrix: Matrix[Node]) -> Matrix[Node]:
        """The three blocks in the axes before."""
        rows = [list(row) for row in matrix]
        for down, across in ((0, 0), (0, 3), (3, 3)):
            block = tuple(tuple(row[across : across + 3]) for row in matrix[down : down + 3])
            turned = self._tensor(block) if down == across else self._general(block)
            for i in range(3):
                for j in range(3):
                    rows[down + i][across + j] = rows[across + j][down + i] = turned[i][j]
        return tuple(tuple(row) for row in rows)

    def rigid(self, body: Rigid) -> Rigid | None:
        """In the axes before."""
        return Rigid(body.mass, self._before(body.first), self._tensor(body.second))

    def bound(self, sizes: Vector[Node]) -> Vector[Node]:
        """The bounds are the same for all axes."""
        return sizes

    def _mixed(self, unlike: Node, both: Node) -> tuple[Node, Node]:
        """s^2 (p - t) + s c (q + r) and s^2 (q + r) - s c (p - t) of a block [[p, q], [r, t]]."""
        square, product = self.sine * self.sine, self.sine * self.cosine
        return square * unlike + product * both, square * both - product * unlike

    def _tensor(self, m: Matrix[Node]) -> Matrix[Node]:
        """R m R' of a symmetric m: trace and antisymmetric part of the turning block stay."""
        (i, j), k, rows = PAIRS[self.axis], self.axis, [list(row) for row in m]
        w, v = self._mixed(m[i][i] - m[j][j], m[i][j] + m[i][j])
        rows[i][i], rows[j][j] = m[i][i] - w, m[j][j] + w
        rows[i][j] = rows[j][i] = m[i][j] - v
        column = self._before([row[k] for row in m])
        rows[i][k] = rows[k][i] = column[i]
        rows[j][k] = rows[k][j] = column[j]
        return tuple(tuple(row) for row in rows)

    def _general(self, m: Matrix[Node]) -> Matrix[Node]:
        """R m R' of any m."""
        (i, j), k, rows = PAIRS[self.axis], self.axis, [list(row) for row in m]
        w, v = self._mixed(m[i][i] - m[j][j], m[i][j] + m[j][i])
        rows[i][i], rows[j][j] = m[i][i] - w, m[j][j] + w
        rows[i][j], rows[j][i] = m[i][j] - v, m[j][i] - v
        column, row = self._before([r[k] for r in m]), self._before(m[k])
        for x in (i, j):
            rows[x][k], rows[k][x] = column[x], row[x]
        return tuple(tuple(row) for row in rows)


def blockwise(rotation: Matrix[Node], matrix: Matrix[Node]) -> Matrix[Node]:
    """R m R' of each of the three blocks of an inertia (6, 6)."""
    rows, back = [list(row) for row in matrix], transposed(rotation)
    for down, across in ((0, 0), (0, 3), (3, 3)):
        block = tuple(tuple(row[across : across + 3]) for row in matrix[down : down + 3])
        if down == across:
            turned = rigid.turned_tensor(block, rotation)
        else:
            turned = compose(compose(rotation, block), back)
        for i in range(3):
            for j in range(3):
                rows[down + i][across + j] = rows[across + j][down + i] = turned[i][j]
    return tuple(tuple(row) for row in rows)


@dataclass(frozen=True)
class _ByMatrix:
    """What a matrix R does to vectors; it has the axes after as its columns."""

    matrix: Matrix[Node]

    def motion(self, twist: Vector[Node]) -> Vector[Node]:
        """R' w, R' v."""
        back = transposed(self.matrix)
        return (*transform(back, twist[:3]), *transform(back, twist[3:]))

    def force(self, wrench: Vector[Node]) -> Vector[Node]:
        """R n, R f."""
        return (*transform(self.matrix, wrench[:3]), *transform(self.matrix, wrench[3:]))

    def inertia(self, matrix: Matrix[Node]) -> Matrix[Node]:
        """Blockwise R m R'."""
        return blockwise(self.matrix, matrix)

    def rigid(self, body: Rigid) -> Rigid | None:
        """In the axes before."""
        return rigid.rotated(body, self.matrix)

    def bound(self, sizes: Vector[Node]) -> Vector[Node]:
        """The bounds are the same for all axes."""
        return sizes


@dataclass(frozen=True)
class Rotation(_ByMatrix):
    """Any turn; `spin` as for `Turn`."""

    rate: Vector[Node]  # e phi'
    drift: Vector[Node]  # e phi'' with every q'' = 0
    spin: Vector[Node]

    def accelerated(self, acceleration: Vector[Node]) -> Vector[Node]:
        """Alpha gains w x e phi' + e phi''."""
        result = self.motion(acceleration)
        gained = add(cross(self.spin, self.rate), self.drift)
        return (*add(result[:3], gained), *result[3:])


@dataclass(frozen=True)
class FreeRotation(Rotation):
    """By a quaternion: the matrix is orthogonal only at states whose quaternion has length one.

    Derivatives with respect to its parts leave these states, so nothing may cancel R R' = 1.
    """

    def rigid(self, body: Rigid) -> Rigid | None:
        """Never."""


@dataclass(frozen=True)
class SkewTurn(_ByMatrix):
    """A constant rotation and a turn about z in one; inertias can be lumped between the two."""

    still: Rotation
    turn: Turn

    @property
    def spin(self) -> Vector[Node]:
        """The angular velocity before, in the axes after."""
        return self.turn.spin

    def accelerated(self, acceleration: Vector[Node]) -> Vector[Node]:
        """Alpha gains w x e phi' + e phi''."""
        return self.turn.gained(self.motion(acceleration))


Motion = tuple[Node, Node, Node, Node]  # of a turn: sine, cosine, rate, drift


def turned(axis: int, motion: Motion, spin: Vector[Node]) -> Turn:
    """A turn about axis 0, 1 or 2, `spin` in the axes before."""
    step = Turn(axis, *motion, spin)
    return replace(step, spin=step.motion((*spin, *spin))[:3])


def advanced(motion: Motion, sine: Node, cosine: Node) -> Motion:
    """The motion with a constant angle added."""
    s, c, rate, drift = motion
    return s * cosine + c * sine, c * cosine - s * sine, rate, drift


def turned_askew(upright: Matrix[Node], motion: Motion, spin: Vector[Node]) -> SkewTurn:
    """A turn about the third column of a constant rotation, `spin` in the axes before."""
    sine, cosine, *_ = motion
    matrix = tuple((cosine * a + sine * b, cosine * b - sine * a, c) for a, b, c in upright)
    none = (spin[0].graph.zero,) * 3
    still = Rotation(upright, none, none, transform(transposed(upright), spin))
    turn = Turn(2, *motion, transform(transposed(matrix), spin))
    return SkewTurn(matrix, still, turn)


def forward(steps: Sequence[Step], twist: Vector[Node]) -> Vector[Node]:
    """X t through all steps."""
    for step in steps:
        twist = step.motion(twist)
    return twist


def back(steps: Sequence[Step], wrench: Vector[Node]) -> Vector[Node]:
    """X' w through all steps."""
    for step in reversed(steps):
        wrench = step.force(wrench)
    return wrench
