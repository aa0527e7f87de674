"""Where things are and how they move: the waist between the model and every formalism.

All scalars are of one algebra. Positions are in world axes [m]; an angular velocity has one
component in a plane (about z) and three in solid space, in body axes (a rod's: world axes).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Generic

import sympy as sp

from eomgen.algebra.scalar import Algebra, S
from eomgen.mechanics import rotation
from eomgen.mechanics.vectors import (
    Matrix,
    Vector,
    add,
    compose,
    cross,
    dot,
    scale,
    subtract,
    transform,
    transpose,
)
from eomgen.model import SPACES, Body, Model, Place, Quaternion, Turn


@dataclass(frozen=True)
class Flow(Generic[S]):
    """How the symbols move: `rates` per coordinate, and the time derivative of every symbol."""

    rates: Mapping[sp.Symbol, S]  # q -> q'
    derivatives: Mapping[sp.Symbol, S]  # q -> q', t -> 1, prescribed w -> w', ...
    spins: Mapping[sp.Symbol, S] = field(default_factory=dict)  # speeds of quaternions


@dataclass(frozen=True)
class Spin(Generic[S]):
    """Angular velocity and inertia of a body, in the same axes; turning axes have I w x w terms."""

    angular_velocity: Vector[S]
    inertia: Matrix[S]
    gyroscopic: bool


@dataclass
class Kinematics(Generic[S]):
    """Positions, axes and spins, each found once when first asked for."""

    model: Model
    algebra: Algebra[S]
    flow: Flow[S]
    origins: dict[str, Vector[S]] = field(default_factory=dict)
    positions: dict[str, Vector[S]] = field(default_factory=dict)
    velocities: dict[str, Vector[S]] = field(default_factory=dict)
    rotations: dict[str, Matrix[S]] = field(default_factory=dict)
    angles: dict[str, S | None] = field(default_factory=dict)
    turning: dict[str, Vector[S]] = field(default_factory=dict)

    @cached_property
    def bodies(self) -> dict[str, Body]:
        """Bodies by name."""
        return {b.name: b for b in self.model.bodies}

    @property
    def dimensions(self) -> int:
        """Number of components of a vector."""
        return SPACES[self.model.space]

    @cached_property
    def places(self) -> dict[str, Place]:
        """Where the points and the mass centres are, by name."""
        centres = {b.name: b.com for b in self.model.bodies}
        return centres | {p.name: p.place for p in self.model.points}

    @cached_property
    def rate(self) -> Callable[[S], S]:
        """The time derivative, as a function of the value."""
        return self.algebra.direction(self.flow.derivatives)

    def vector(self, components: tuple[sp.Expr, ...]) -> Vector[S]:
        """Formulas as scalars."""
        return tuple(self.algebra.of(c) for c in components)

    def position(self, name: str) -> Vector[S]:
        """A point, or a body's mass centre."""
        if name not in self.positions:
            self.positions[name] = self.place(self.places[name])
        return self.positions[name]

    def velocity(self, name: str) -> Vector[S]:
        """The velocity of a point or mass centre, in world axes."""
        if name not in self.velocities:
            self.velocities[name] = tuple(self.rate(c) for c in self.position(name))
        return self.velocities[name]

    def place(self, place: Place) -> Vector[S]:
        """sum(coefficient * point) + components in the axes of `on`, from its origin if alone."""
        result = self.vector(place.components)
        if place.on is not None and not all(c.is_zero for c in place.components):
            result = transform(self.axes(place.on), result)
        if place.on is not None and not place.points:
            result = add(self.origin(place.on), result)
        for coefficient, point in place.points:
            result = add(result, scale(self.algebra.of(coefficient), self.position(point)))
        return result

    def origin(self, name: str) -> Vector[S]:
        """The origin of a body's frame."""
        if name not in self.origins:
            self.origins[name] = self.place(self.bodies[name].frame.origin)
        return self.origins[name]

    def to_world(self, components: Vector[S], name: str | None) -> Vector[S]:
        """Components in a body's axes (None: the world's) as components in world axes."""
        return components if name is None else transform(self.axes(name), components)

    def axes(self, name: str) -> Matrix[S]:
        """The rotation matrix of a body: columns are its axes, in world components."""
        if name not in self.rotations:
            self.rotations[name] = self._axes(self.bodies[name])
        return self.rotations[name]

    def _axes(self, body: Body) -> Matrix[S]:
        if body.frame.along:
            return self._rod_axes(body)
        if self.dimensions == 2:
            return self._planar_axes(body)
        result = self._parent_axes(body)
        for turn in body.frame.turns:
            result = compose(result, rotation.of(self.algebra, turn))
        return result

    def _parent_axes(self, body: Body) -> Matrix[S]:
        parent = body.frame.origin.on
        return self.axes(parent) if parent else rotation.identity(self.algebra, self.dimensions)

    def _planar_axes(self, body: Body) -> Matrix[S]:
        angle = self.angle(body.name)
        if angle is not None:
            return rotation.planar(self.algebra, angle)
        own = self._own_angle(body)
        return compose(self._parent_axes(body), rotation.planar(self.algebra, own))

    def _own_angle(self, body: Body) -> S:
        angles = (self.algebra.of(angle) for t in body.frame.turns for angle in t.formulas)
        return sum(angles, self.algebra.number(0))

    def angle(self, name: str) -> S | None:
        """The angle of a body in the plane from the world's x axis; None above a rod."""
        body = self.bodies[name]
        if body.frame.along:
            return None
        parent = body.frame.origin.on
        before = self.angle(parent) if parent else self.algebra.number(0)
        return None if before is None else before + self._own_angle(body)

    def rod(self, body: Body) -> Vector[S]:
        """From the first end of a rod to the second, in world axes."""
        assert body.frame.along
        first, second = body.frame.along
        return subtract(self.position(second), self.position(first))

    def _rod_axes(self, body: Body) -> Matrix[S]:
        along = self.rod(body)
        length = self.algebra.apply("sqrt", dot(along, along))
        unit = tuple(c / length for c in along)
        if self.dimensions == 1:
            return ((unit[0],),)
        if self.dimensions == 2:
            return ((unit[0], -unit[1]), (unit[1], unit[0]))
        raise NotImplementedError("a uniform rod in solid space has one axis only")

    def angular_velocity(self, name: str) -> Vector[S]:
        """One component in a plane; three in solid space in body axes (a rod's: world axes)."""
        if name not in self.turning:
            self.turning[name] = self._angular_velocity(self.bodies[name])
        return self.turning[name]

    def _angular_velocity(self, body: Body) -> Vector[S]:
        if body.frame.along:
            return self._rod_spin(body)
        parent = body.frame.origin.on
        spin = self._above(parent) if parent else None
        if self.dimensions == 2:
            own = self.rate(self._own_angle(body))
            return (own,) if spin is None else (spin[0] + own,)
        result = spin or tuple(self.algebra.number(0) for _ in range(3))
        for turn in body.frame.turns:
            # w = R' w_before + w_own
            back = transpose(rotation.of(self.algebra, turn))
            result = add(transform(back, result), self._own_spin(turn))
        return result

    def _own_spin(self, turn: Turn | Quaternion) -> Vector[S]:
        """The angular velocity of a turn, in the axes after it."""
        if isinstance(turn, Quaternion):
            return tuple(self.flow.spins[speed] for speed in turn.speeds)
        rate = self.rate(self.algebra.of(turn.angle))
        return scale(rate, rotation.unit(self.algebra, turn.axis))

    def _above(self, parent: str) -> Vector[S]:
        return self.angular_velocity(parent)

    def _rod_spin(self, body: Body) -> Vector[S]:
        """W = d x d' / d^2, without spin about the rod itself."""
        along = self.rod(body)
        moving = tuple(self.rate(c) for c in along)
        square = dot(along, along)
        if self.dimensions == 2:
            return ((along[0] * moving[1] - along[1] * moving[0]) / square,)
        return tuple(c / square for c in cross(along, moving))

    def spin(self, body: Body) -> Spin[S] | None:
        """Angular velocity and inertia; None for a particle and for anything on a line."""
        if body.frame.along and self.dimensions > 1:
            along = self.rod(body)
            # a uniform rod: I = m l^2 / 12 across it
            inertia = self.algebra.of(body.mass) * dot(along, along) * Fraction(1, 12)
            rows = rotation.identity(self.algebra, 1 if self.dimensions == 2 else 3)
            matrix = tuple(scale(inertia, row) for row in rows)
            return Spin(self.angular_velocity(body.name), matrix, gyroscopic=False)
        if not body.inertia:
            return None
        entries = self.vector(body.inertia)
        size = 1 if self.dimensions == 2 else 3
        matrix = tuple(tuple(entries[size * i : size * i + size]) for i in range(size))
        return Spin(self.angular_velocity(body.name), matrix, gyroscopic=size == 3)
