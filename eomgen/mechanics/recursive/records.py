"""The tree of places: what moves against what, by which coordinates, with what inertia."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from eomgen.algebra.graph import Node
from eomgen.algebra.ldl import Pivots
from eomgen.mechanics.recursive import rigid
from eomgen.mechanics.recursive.rigid import Rigid
from eomgen.mechanics.recursive.steps import Step
from eomgen.mechanics.vectors import Matrix, Vector, add, scale, transform

GROUND = 0  # the number of the place that stands still
Solution = tuple[tuple[Node, ...], Pivots]  # accelerations, and what they divide by


class NoTree(Exception):
    """The scene is no tree of joints; the message says what it is instead."""


@dataclass(frozen=True)
class Point:
    """Moves with a velocity in world axes [m/s] (1, 2 or 3 components); carries particles."""

    dimensions: int

    @property
    def size(self) -> int:
        """Number of components of a twist."""
        return self.dimensions

    def matrix(self, body: Rigid) -> Matrix[Node]:
        """Mass times the unit matrix."""
        return diagonal((body.mass,) * self.dimensions)

    def wrench(self, body: Rigid, acceleration: Vector[Node]) -> Vector[Node]:
        """The force m a."""
        return scale(body.mass, acceleration)

    def bound(self, body: Rigid) -> Vector[Node]:
        """The mass."""
        return (body.mass,) * self.dimensions


@dataclass(frozen=True)
class PlanarFrame:
    """Moves with (w, v), v of its origin in world axes; carries rigid bodies in its own `axes`."""

    spin: Vector[Node]
    axes: Matrix[Node]

    @property
    def size(self) -> int:
        """Number of components of a twist."""
        return 3

    def matrix(self, body: Rigid) -> Matrix[Node]:
        """The inertia in world axes."""
        first = transform(self.axes, body.first)
        return rigid.matrix(Rigid(body.mass, first, body.second))

    def wrench(self, body: Rigid, acceleration: Vector[Node]) -> Vector[Node]:
        """I a less the centripetal force w^2 h."""
        first = transform(self.axes, body.first)
        square = self.spin[0] * self.spin[0]
        moment, *force = rigid.product(Rigid(body.mass, first, body.second), acceleration)
        return (moment, *add(tuple(force), scale(-square, first)))

    def bound(self, body: Rigid) -> Vector[Node]:
        """Second moment and mass."""
        return (body.second[0][0], body.mass, body.mass)


@dataclass(frozen=True)
class SpatialFrame:
    """Moves with (w, v) in its own axes; carries rigid bodies."""

    spin: Vector[Node]

    @property
    def size(self) -> int:
        """Number of components of a twist."""
        return 6

    def matrix(self, body: Rigid) -> Matrix[Node]:
        """The inertia (6, 6)."""
        return rigid.matrix(body)

    def wrench(self, body: Rigid, acceleration: Vector[Node]) -> Vector[Node]:
        """Newton's and Euler's laws."""
        return rigid.wrench(body, self.spin, acceleration)

    def bound(self, body: Rigid) -> Vector[Node]:
        """Sums of second moments, and masses."""
        return (rigid.squares(body),) * 3 + (body.mass,) * 3


@dataclass(frozen=True)
class Spin:
    """Turns only: the angular velocity of a uniform rod, whose inertia is the same across it."""

    size: int

    def matrix(self, body: Rigid) -> Matrix[Node]:
        """One second moment for all axes."""
        return diagonal((body.second[0][0],) * self.size)

    def wrench(self, body: Rigid, acceleration: Vector[Node]) -> Vector[Node]:
        """J alpha."""
        return scale(body.second[0][0], acceleration)

    def bound(self, body: Rigid) -> Vector[Node]:
        """The second moment."""
        return (body.second[0][0],) * self.size


Kind = Point | PlanarFrame | SpatialFrame | Spin


def diagonal(entries: Vector[Node]) -> Matrix[Node]:
    """A diagonal matrix."""
    zero = entries[0].graph.zero
    size = range(len(entries))
    return tuple(tuple(entries[i] if i == j else zero for j in size) for i in size)


@dataclass(frozen=True)
class Place:
    """Something that moves: its twist is X t_base + sum of column * q' (+ prescribed motion)."""

    name: str
    kind: Kind
    base: int
    steps: tuple[Step, ...]  # X
    columns: Mapping[int, Vector[Node]]  # S, by the number of the coordinate
    body: Rigid | None = None


@dataclass(frozen=True)
class Joint:
    """Coordinates (none for what is fixed) and all places that they move against one base."""

    coordinates: tuple[int, ...]
    base: int
    places: tuple[int, ...]


@dataclass(frozen=True)
class Tree:
    """Places, bases before what stands on them, and joints from root to leaf."""

    places: tuple[Place, ...]
    joints: tuple[Joint, ...]
    gravity: Vector[Node]  # world axes, [m/s^2]
    frames: Mapping[str, int] = field(default_factory=dict)  # body -> the place of its axes
    turned: Mapping[str, Matrix[Node]] = field(default_factory=dict)  # the place's in the body's

    @property
    def order(self) -> tuple[int, ...]:
        """The numbers of the coordinates from root to leaf."""
        return tuple(c for joint in self.joints for c in joint.coordinates)
