"""A tree being built: places in the order in which they are found."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

from eomgen.algebra.graph import Node
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive.formulas import Clock, Moving
from eomgen.mechanics.recursive.places import Words
from eomgen.mechanics.recursive.records import (
    GROUND,
    Joint,
    Kind,
    NoTree,
    Place,
    PlanarFrame,
    SpatialFrame,
)
from eomgen.mechanics.recursive.rigid import Rigid
from eomgen.mechanics.recursive.steps import forward
from eomgen.mechanics.vectors import Matrix, Vector, add, transform, transpose


@dataclass
class Draft:
    """Places so far, and by which name each was found."""

    kinematics: Kinematics[Node]
    words: Words
    clock: Clock
    places: list[Place] = field(default_factory=list)
    points: dict[str, int] = field(default_factory=dict)
    frames: dict[str, int] = field(default_factory=dict)
    turned: dict[int, Matrix[Node]] = field(default_factory=dict)  # own axes in those of the body
    ahead: dict[str, Vector[Node]] = field(default_factory=dict)  # axes of bodies to come
    turned_as: dict[int, str] = field(default_factory=dict)  # place -> the body whose axes it has

    @property
    def zero(self) -> Node:
        """The number 0."""
        return self.kinematics.algebra.number(0)

    def kind(self, place: int) -> Kind:
        """What a place is."""
        return self.places[place].kind

    def spin(self, place: int) -> Vector[Node]:
        """The angular velocity of a place that is a frame; none of a point."""
        kind = self.kind(place)
        return kind.spin if isinstance(kind, PlanarFrame | SpatialFrame) else ()

    def own(self, place: int, vector: Vector[Node]) -> Vector[Node]:
        """A vector in a body's axes, in the axes of its place."""
        turned = self.turned.get(place)
        return vector if turned is None else transform(transpose(turned), vector)

    def put(self, place: Place) -> int:
        """The number of a new place."""
        self.places.append(place)
        return len(self.places) - 1

    def load(self, place: int, body: Rigid) -> None:
        """Fix a body to a place."""
        before = self.places[place].body
        total = body if before is None else before + body
        self.places[place] = replace(self.places[place], body=total)


def columns_of(parts: Iterable[Moving]) -> tuple[int, ...]:
    """The numbers of all coordinates of some motions, by declaration."""
    return tuple(sorted({c for part in parts for c in part.columns}))


def settled(draft: Draft) -> tuple[list[Place], dict[str, int]]:
    """Places of which those that share a coordinate have one base, and the frames among them.

    Where bases differ the place that is deepest goes by its base's base: its twist is X t + S q'
    with the coordinates of both. What carries nothing is left out.
    """
    found = list(draft.places)
    while (deepest := _apart(found)) is not None:
        found[deepest] = _through(found[deepest], found[found[deepest].base])
    kept = _kept(found)
    number = {old: new for new, old in enumerate(kept)}
    places = [replace(found[i], base=number[found[i].base]) for i in kept]
    return places, {n: number[i] for n, i in draft.frames.items() if i in number}


def _apart(places: list[Place]) -> int | None:
    """The deepest place of the first group with several bases."""
    depths = _depths(places)
    for members in _groups(places):
        if len({places[m].base for m in members}) > 1:
            return max(members, key=lambda m: depths[places[m].base])
    return None


def _through(place: Place, base: Place) -> Place:
    """The place counted from its base's base."""
    columns = {c: forward(place.steps, column) for c, column in base.columns.items()}
    for c, column in place.columns.items():
        columns[c] = add(columns[c], column) if c in columns else column
    return replace(place, base=base.base, steps=base.steps + place.steps, columns=columns)


def _kept(places: list[Place]) -> list[int]:
    """The numbers of places that carry a body or another place."""
    used = {GROUND}
    for i in reversed(range(len(places))):
        if i in used or places[i].body is not None:
            used |= {i, places[i].base}
    return sorted(used)


def _depths(places: Sequence[Place]) -> list[int]:
    depths = [0]
    for place in places[1:]:
        depths.append(depths[place.base] + 1)
    return depths


def joints(places: Sequence[Place], names: Sequence[str]) -> tuple[Joint, ...]:
    """Settled places that share a coordinate are moved by one joint; from root to leaf.

    Raises:
        NoTree: a coordinate moves nothing.
    """
    found = []
    for members in _groups(places):
        coordinates = tuple(sorted({c for m in members for c in places[m].columns}))
        found.append(Joint(coordinates, places[members[0]].base, tuple(members)))
    moved = {c for joint in found for c in joint.coordinates}
    idle = [name for i, name in enumerate(names) if i not in moved]
    if idle:
        raise NoTree(f"no body moves with {', '.join(idle)}")
    depths = _depths(places)
    return tuple(sorted(found, key=lambda joint: depths[joint.base]))


def _groups(places: Sequence[Place]) -> list[list[int]]:
    """Numbers of places that hang together by their coordinates, as first declared."""
    label: dict[int, int] = {}  # coordinate -> group
    groups: dict[int, list[int]] = {}
    for i, place in enumerate(places[1:], start=1):
        touching = sorted({label[c] for c in place.columns if c in label})
        groups[i] = [m for g in touching for m in groups.pop(g)] + [i]
        for c in {c for m in groups[i] for c in places[m].columns}:
            label[c] = i
    return [sorted(members) for members in groups.values()]
