"""Particles hung on each other by massless links: what the tensions of the links need to know.

A coordinate moves its particle by S = size * direction. The method of `rods` asks for directions
of constant length, at right angles to each other, whatever the state: decided by the graph where
it folds sin^2 + cos^2 by itself, and by the normal form of the formula elsewhere.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from eomgen.algebra.graph import Node
from eomgen.algebra.jacobian import substituted
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive.formulas import Clock
from eomgen.mechanics.recursive.records import GROUND, Place, Point, Tree
from eomgen.mechanics.recursive.short import Short, common_factor
from eomgen.mechanics.recursive.steps import Flat
from eomgen.mechanics.vectors import Vector, add, cross, dot, scale

FIXED = -1  # what hangs on the ground has this base


@dataclass(frozen=True)
class Way:
    """How a coordinate moves its particle against the base: S = size * direction."""

    coordinate: int
    size: Node
    direction: Vector[Node]
    square: Node  # of the direction, a constant

    @property
    def gram(self) -> Node:
        """S' S."""
        return self.size * self.size * self.square

    @property
    def inverse(self) -> Node:
        """What turns (direction . v) into the coordinate's share of v: size / (S' S)."""
        return self.size / self.gram


@dataclass(frozen=True)
class Drift:
    """The acceleration against the base while every q'' is zero."""

    vector: Vector[Node]
    parts: tuple[tuple[Node, Vector[Node]], ...]  # (factor, vector), which add up to it

    def along(self, direction: Vector[Node], short: Short) -> Node:
        """Its component, each part as short as it is."""
        total = short.zero
        for factor, vector in self.parts:
            total = total + factor * short.of(dot(direction, vector))
        return total


@dataclass(frozen=True)
class Particle:
    """A particle with all that is fixed to it."""

    base: int  # number of a particle before it, or FIXED
    mass: Node
    ways: tuple[Way, ...]
    drift: Drift
    carried: Vector[Node]  # acceleration of its hanging point against the particle of the base
    force: Vector[Node]  # what moves the masses fixed to it with prescribed motions of their own

    @property
    def is_free(self) -> bool:
        """Whether its coordinates move it everywhere."""
        return len(self.ways) == len(self.carried)

    @property
    def is_guided(self) -> bool:
        """Whether its coordinates alone say where it can go."""
        return self.base == FIXED and not self.is_free

    @property
    def is_hung(self) -> bool:
        """Whether a link pulls it along one direction that its coordinates leave out."""
        return self.base != FIXED and not self.is_free

    @property
    def link(self) -> Vector[Node]:
        """The direction of the link, of constant length."""
        first, *others = (way.direction for way in self.ways)
        return (-first[1], first[0]) if len(first) == 2 else cross(first, *others)


@dataclass
class _Draft:
    """Particles so far, and which of them a place moves with, at what acceleration against it."""

    tree: Tree
    clock: Clock
    short: Short
    found: list[Particle]
    at: dict[int, tuple[int, Vector[Node]]]


def of(kinematics: Kinematics[Node], tree: Tree, short: Short) -> tuple[Particle, ...] | None:
    """The particles of a tree, bases first; None where it has something else.

    That is: a body that turns, a joint that moves several places, a link that leaves more than
    one direction out, a coordinate with a direction of changing length, or a mass of zero.
    """
    zero = (kinematics.algebra.number(0),) * len(tree.gravity)
    draft = _Draft(tree, Clock(kinematics), short, [], {GROUND: (FIXED, zero)})
    for joint in tree.joints:
        if len(joint.places) > 1 or not _put(draft, joint.places[0]):
            return None
    values = _vanishing(kinematics)
    divisors = [p.mass for p in draft.found] + [w.gram for p in draft.found for w in p.ways]
    if any(d is short.zero for d in (*divisors, *substituted(divisors, values))):
        return None
    return tuple(draft.found)


def _vanishing(kinematics: Kinematics[Node]) -> dict[Node, Node]:
    """The parameters whose value is zero."""
    algebra = kinematics.algebra
    return {
        algebra.of(p.symbol): algebra.number(0)
        for p in kinematics.model.parameters
        if p.value is not None and p.value.is_zero
    }


def _put(draft: _Draft, number: int) -> bool:
    """Add what a place carries; False where it is no particle."""
    place, zero = draft.tree.places[number], draft.short.zero
    base, carried = draft.at[place.base]
    if not isinstance(place.kind, Point) or not all(
        _is_parallel(s, len(carried)) for s in place.steps
    ):
        return False
    drift = _drift(place, draft.tree.places[place.base].kind.size, zero)
    mass = zero if place.body is None else place.body.mass
    if not place.columns:
        draft.at[number] = base, add(carried, drift)
        if base != FIXED:
            before, push = draft.found[base], scale(-mass, draft.at[number][1])
            draft.found[base] = replace(
                before, mass=before.mass + mass, force=add(before.force, push)
            )
        return True
    ways = _ways(draft, place)
    if ways is None:
        return False
    particle = Particle(
        base, mass, ways, _parts(draft, place, drift), carried, (zero,) * len(drift)
    )
    draft.found.append(particle)
    draft.at[number] = len(draft.found) - 1, (zero,) * len(drift)
    return not particle.is_hung or len(ways) == len(carried) - 1


def _is_parallel(step: object, dimensions: int) -> bool:
    """Whether a step hands the velocity of the base on as it is."""
    return isinstance(step, Flat) and all(
        entry is (entry.graph.one if i == j else entry.graph.zero)
        for i, row in enumerate(step.matrix)
        for j, entry in enumerate(row[-dimensions:])
    )


def _drift(place: Place, size: int, zero: Node) -> Vector[Node]:
    value: Vector[Node] = (zero,) * size
    for step in place.steps:
        value = step.accelerated(value)
    return value


def _ways(draft: _Draft, place: Place) -> tuple[Way, ...] | None:
    """The coordinates of a place, each with a direction; None where these are not as asked for."""
    ways: list[Way] = []
    for c, column in place.columns.items():
        if all(s is draft.short.zero for s in column):
            return None
        size, direction = common_factor(column)
        square = draft.short.of(dot(direction, direction))
        others = (draft.short.of(dot(direction, w.direction)) for w in ways)
        if not draft.short.is_constant(square) or any(o is not draft.short.zero for o in others):
            return None
        ways.append(Way(c, size, direction, square))
    return tuple(ways)


def _parts(draft: _Draft, place: Place, drift: Vector[Node]) -> Drift:
    """The drift as sum of q_j' q_k' dS_j/dq_k, where it is nothing else."""
    movers = {m[0]: m for m in draft.clock.movers if m[0] in place.columns}
    still: Mapping[Node, Node] = {m[3]: draft.short.zero for m in movers.values()}
    known = draft.short.constant
    for _, _, leaf, _ in movers.values():
        known |= leaf.leaves
    steady = all(s.leaves & ~known == 0 for column in place.columns.values() for s in column)
    if not steady or any(d is not draft.short.zero for d in substituted(drift, still)):
        return Drift(drift, ((draft.short.zero.graph.one, drift),))
    return Drift(drift, tuple(_quadratic(draft.clock, place.columns, list(movers.values()))))


def _quadratic(
    clock: Clock,
    columns: Mapping[int, Vector[Node]],
    movers: Sequence[tuple[int, object, Node, Node]],
) -> list[tuple[Node, Vector[Node]]]:
    parts = []
    for i, (number, _, _, speed) in enumerate(movers):
        for other, symbol, _, second in movers[: i + 1]:
            slope = clock.along(columns[number], symbol)
            if all(s is speed.graph.zero for s in slope):
                continue
            size, direction = common_factor(slope)
            twice = 1 if number == other else 2
            parts.append((twice * speed * second * size, direction))
    return parts
