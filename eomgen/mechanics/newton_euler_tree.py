"""Which body hangs on which: the tree of joints, and the body that carries a point.

The parent of a body is the body whose axes its frame is on; for a body placed by a formula, the
body at a point that the formula refers to (`B: A + l*[...]` with a slider at A); else the world.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from eomgen.model import Body, Constraint, Model, Place


@dataclass(frozen=True)
class Joint:
    """What holds a body to its parent."""

    body: str
    parent: str | None  # None: the world
    point: str | None  # what moments are about; None: the origin of the body's frame
    own: frozenset[sp.Symbol]  # coordinates of its motion against the parent
    placed_by: tuple[str, ...]  # every body that its place refers to; two or more close a loop
    is_relative: bool  # whether its coordinates count in the axes of the parent


@dataclass(frozen=True)
class Trace:
    """Where a place leads to: the symbols on the way and (body, point of it) at the ends."""

    symbols: frozenset[sp.Symbol] = frozenset()
    ends: tuple[tuple[str, str | None], ...] = ()

    def __add__(self, other: Trace) -> Trace:
        """Both."""
        return Trace(self.symbols | other.symbols, self.ends + other.ends)


def joints(model: Model) -> tuple[Joint, ...]:
    """One for each body, parents before children."""
    traces = {b.name: _trace_of(model, b) for b in model.bodies}
    parents = _without_circles({n: _first(t) for n, t in traces.items()})
    order = sorted(parents, key=lambda name: len(list(above(parents, name))))  # stable
    own: dict[str, frozenset[sp.Symbol]] = {}
    for name in order:
        known = frozenset().union(*(own[a] for a in above(parents, name)))
        own[name] = (traces[name].symbols & _coordinates(model)) - known
    bodies = {b.name: b for b in model.bodies}
    return tuple(
        Joint(
            body=name,
            parent=parents[name],
            point=_point(model, bodies[name], traces[name]),
            own=own[name],
            placed_by=tuple(dict.fromkeys(body for body, _ in traces[name].ends)),
            is_relative=bodies[name].frame.origin.on is not None,
        )
        for name in order
    )


def above(parents: dict[str, str | None], name: str) -> Iterator[str]:
    """The parent, its parent, and so on below the world."""
    parent = parents[name]
    while parent is not None:
        yield parent
        parent = parents[parent]


def _first(trace: Trace) -> str | None:
    return trace.ends[0][0] if trace.ends else None


def _without_circles(parents: dict[str, str | None]) -> dict[str, str | None]:
    """Bodies that place each other in a circle: the first declared is held by the world."""
    found = dict(parents)
    for name in parents:
        seen, parent = {name}, found[name]
        while parent is not None and parent not in seen:
            seen.add(parent)
            parent = found[parent]
        if parent == name:
            found[name] = None
    return found


def _coordinates(model: Model) -> frozenset[sp.Symbol]:
    return frozenset(c.symbol for c in model.coordinates)


def _symbols(expressions: Sequence[sp.Expr]) -> frozenset[sp.Symbol]:
    return frozenset().union(*(e.free_symbols for e in expressions))


def _trace_of(model: Model, body: Body) -> Trace:
    """What places and turns a body."""
    turns = _symbols([f for t in body.frame.turns for f in t.formulas])
    found = Trace(turns) + _trace(model, body.frame.origin, body)
    if body.frame.along:
        second = Place(body.com.components, ((sp.S.One, body.frame.along[1]),))
        found += Trace(_trace(model, second, body).symbols)
    return found


def _trace(model: Model, place: Place, body: Body | None) -> Trace:
    found = Trace(_symbols([*place.components, *(c for c, _ in place.points)]))
    if place.on is not None:
        found += Trace(ends=((place.on, None),))
    for _, point in place.points:
        holder = _holder(model, point, body)
        if holder is None:
            below = _trace(model, _places(model)[point], body)
            ends = tuple((end, at or point) for end, at in below.ends)
            found += Trace(below.symbols, ends)
        else:
            found += Trace(ends=((holder, point),))
    return found


def _places(model: Model) -> dict[str, Place]:
    return {p.name: p.place for p in model.points}


def _holder(model: Model, point: str, body: Body | None) -> str | None:
    """The body at a point, or whose rod ends there, that `body` hangs on."""
    point = _same(model, point)
    if point not in _places(model):
        return point  # a body's name: its mass centre
    at = [b for b in model.bodies if not b.frame.along and _origin(model, b) == point]
    if body is not None and body in at:
        at = at[: at.index(body)]
    ends = [
        b
        for b in model.bodies
        if b is not body and b.frame.along and _same(model, b.frame.along[1]) == point
    ]
    return next((b.name for b in [*at, *ends]), None)


def _same(model: Model, point: str) -> str:
    """The first name of a point that is declared as another point."""
    places = _places(model)
    while point in places and (alias := _alias(places[point])) is not None:
        point = alias
    return point


def _alias(place: Place) -> str | None:
    """The one point that a place is."""
    if place.on is None and len(place.points) == 1 and all(c == 0 for c in place.components):
        coefficient, point = place.points[0]
        return point if coefficient == 1 else None
    return None


def _origin(model: Model, body: Body) -> str | None:
    """The named point at which a body's frame is."""
    alias = _alias(body.frame.origin)
    return None if alias is None else _same(model, alias)


def _point(model: Model, body: Body, trace: Trace) -> str | None:
    """The parent's point, for a body without a frame of its own; None: the frame's origin."""
    origin = body.frame.origin
    framed = origin.on is not None or any(c != 0 for c in body.com.components)
    if framed or body.frame.along or _origin(model, body) is not None and not trace.ends:
        return _origin(model, body)
    if trace.ends:
        return trace.ends[0][1]
    return origin.points[0][1] if len(origin.points) == 1 else None


@dataclass(frozen=True)
class Carrier:
    """The body that a point belongs to; None: the world, or nobody if the point is massless."""

    body: str | None
    massless: bool = False


def carrier(model: Model, name: str) -> Carrier:
    """What carries a point; where several do: the body placed there, then the rod ending there."""
    point = _same(model, name)
    holder = _holder(model, point, None)
    if holder is not None:
        return Carrier(holder)
    place = _places(model)[point]
    starts = [
        b.name for b in model.bodies if b.frame.along and _same(model, b.frame.along[0]) == point
    ]
    if place.on is not None and not place.points:
        return Carrier(place.on)
    if not _symbols_below(model, point) & _coordinates(model):
        return Carrier(None)
    return Carrier(starts[0]) if starts else Carrier(None, massless=True)


def _symbols_below(model: Model, point: str) -> frozenset[sp.Symbol]:
    """Symbols of a place; a body on the way counts with its own."""
    trace = _trace(model, _places(model)[point], None)
    bodies = {b.name: b for b in model.bodies}
    return trace.symbols.union(*(_trace_of(model, bodies[b]).symbols for b, _ in trace.ends))


def reached(model: Model, point: str) -> tuple[frozenset[sp.Symbol], tuple[str, ...]]:
    """Coordinates that move a massless point, and the bodies that it hangs on."""
    trace = _trace(model, _places(model)[_same(model, point)], None)
    return trace.symbols & _coordinates(model), tuple(body for body, _ in trace.ends)


def companions(model: Model, tree: Sequence[Joint], joint: Joint) -> tuple[str, ...]:
    """Other bodies that the same coordinate, or a relation between coordinates, ties to this one.

    A relation on coordinates that do not count against the parent is felt by all joints above.
    """
    relations = [related_by(model, c) for c in model.constraints if c.kind != "unilateral"]
    near = joint.own.union(*(r for r in relations if r & joint.own))
    parents = {j.body: j.parent for j in tree}
    return tuple(
        j.body
        for j in tree
        if j is not joint
        and (
            j.own & near or (_is_felt_above(j, relations) and joint.body in above(parents, j.body))
        )
    )


def _is_felt_above(joint: Joint, relations: Sequence[frozenset[sp.Symbol]]) -> bool:
    return not joint.is_relative and any(r & joint.own for r in relations)


def related_by(model: Model, constraint: Constraint) -> frozenset[sp.Symbol]:
    """The coordinates in the formulas of a constraint; none where it joins two points."""
    used = _symbols(constraint.residuals)
    return frozenset(c.symbol for c in model.coordinates if {c.symbol, c.rate} & used)
