"""Where a place hangs, by the spec's own words: at most one other place, and an offset."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from eomgen.mechanics.recursive.records import NoTree
from eomgen.model import Body, Model, Place


@dataclass(frozen=True)
class Hung:
    """A point (None: nothing) + components in the axes of `on` (None: the world's)."""

    point: str | None
    components: tuple[sp.Expr, ...]
    on: str | None


@dataclass(frozen=True)
class Words:
    """A model's places by name."""

    points: Mapping[str, Place]
    bodies: Mapping[str, Body]
    rank: Mapping[str, int]  # order of declaration
    carriers: frozenset[str]  # bodies in whose axes something is placed

    def hung(self, place: Place) -> Hung:
        """What a place hangs on.

        Raises:
            NoTree: it hangs on several things at once.
        """
        if place.on is not None:
            if place.points:
                raise NoTree("a place has the axes of a body and counts from another point")
            return Hung(None, place.components, place.on)
        weights: dict[str, sp.Expr] = {}
        components = _gathered(weights, place, sp.S.One, (sp.S.Zero,) * len(place.components))
        # a weight that is not one would weigh the ground's fall too
        while weights and list(weights.values()) != [1]:
            components = self._spelled_out(weights, components)
        return Hung(next(iter(weights), None), components, None)

    def _spelled_out(
        self, weights: dict[str, sp.Expr], components: tuple[sp.Expr, ...]
    ) -> tuple[sp.Expr, ...]:
        """The last declared of the points replaced by what it stands for."""
        plain = [name for name in weights if self.definition(name) is not None]
        if not plain:
            raise NoTree(f"a place counts from {' and '.join(weights)} with weights")
        last = max(plain, key=self.rank.__getitem__)
        definition = self.definition(last)
        assert definition is not None
        return _gathered(weights, definition, weights.pop(last), components)

    def between(self, first: str, second: str) -> tuple[sp.Expr, ...]:
        """From one point to another, in world axes.

        Raises:
            NoTree: it depends on how a body is turned.
        """
        weights: dict[str, sp.Expr] = {first: -sp.S.One, second: sp.S.One}
        components = (sp.S.Zero,) * len(self.place(first).components)
        while weights:
            components = self._spelled_out(weights, components)
        return components

    def definition(self, name: str) -> Place | None:
        """A point's place in world axes; None where it is fixed in a body's axes."""
        if name in self.points:
            place = self.points[name]
            return place if place.on is None else None
        body = self.bodies[name]
        if body.com.on is None:
            return body.com
        origin = body.frame.origin
        return origin if self.is_at_origin(name) and origin.on is None else None

    def place(self, name: str) -> Place:
        """The place of a point or of a mass centre."""
        if name in self.points:
            return self.points[name]
        body = self.bodies[name]
        return body.frame.origin if self.is_at_origin(name) else body.com

    def is_at_origin(self, name: str) -> bool:
        """Whether a body's mass centre is the origin of its frame."""
        com = self.bodies[name].com
        return com.on == name and all(c.is_zero for c in com.components)


def _gathered(
    weights: dict[str, sp.Expr], place: Place, factor: sp.Expr, start: tuple[sp.Expr, ...]
) -> tuple[sp.Expr, ...]:
    """Add factor * place to the points and the components."""
    for coefficient, point in place.points:
        total = weights.pop(point, sp.S.Zero) + factor * coefficient
        if not total.is_zero:
            weights[point] = total
    pairs = zip(start, place.components, strict=True)
    return tuple(a if b.is_zero else a + factor * b for a, b in pairs)


def words(model: Model) -> Words:
    """The places of a model."""
    names = [p.name for p in model.points] + [b.name for b in model.bodies]
    places = [*(p.place for p in model.points), *(b.frame.origin for b in model.bodies)]
    return Words(
        {p.name: p.place for p in model.points},
        {b.name: b for b in model.bodies},
        {name: i for i, name in enumerate(names)},
        frozenset(place.on for place in places if place.on is not None),
    )
