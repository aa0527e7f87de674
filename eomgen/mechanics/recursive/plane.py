"""Places on a line and in the plane: world axes, absolute angles, twists of at most three parts."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from eomgen.algebra.graph import Node
from eomgen.mechanics.recursive.draft import Draft, columns_of
from eomgen.mechanics.recursive.formulas import Moving
from eomgen.mechanics.recursive.places import Hung
from eomgen.mechanics.recursive.records import GROUND, Kind, Place, PlanarFrame, Point
from eomgen.mechanics.recursive.steps import Flat
from eomgen.mechanics.vectors import Matrix, Vector, add, scale, transform


def ground(draft: Draft) -> Place:
    """The place that stands still."""
    return Place("the ground", Point(draft.kinematics.dimensions), GROUND, (), {})


def point(draft: Draft, name: str) -> int:
    """The place of a point or of a mass centre."""
    if name not in draft.points:
        draft.points[name] = _point(draft, name)
    return draft.points[name]


def _point(draft: Draft, name: str) -> int:
    hung = draft.words.hung(draft.words.place(name))
    base, offset = _base(draft, hung), draft.clock.moving(hung.components)
    if _is_here(draft, hung, offset):
        return base
    return _put(draft, name, (base, hung), offset, None)


def _base(draft: Draft, hung: Hung) -> int:
    if hung.on is not None:
        return frame(draft, hung.on)
    return GROUND if hung.point is None else point(draft, hung.point)


def _is_here(draft: Draft, hung: Hung, offset: Moving) -> bool:
    """Whether there is no offset at all."""
    at_base = all(v is draft.zero for v in offset.values)
    return at_base and (hung.on or hung.point) is not None


def frame(draft: Draft, name: str) -> int:
    """The place of a body's frame; a point where it never turns."""
    if name not in draft.frames:
        draft.frames[name] = _frame(draft, name)
    return draft.frames[name]


def _frame(draft: Draft, name: str) -> int:
    body = draft.words.bodies[name]
    hung = draft.words.hung(body.frame.origin)
    base, offset = _base(draft, hung), draft.clock.moving(hung.components)
    angle = draft.clock.moving([sp.Add(*(f for t in body.frame.turns for f in t.formulas))])
    turns = bool(draft.spin(base)) and hung.on is not None or not angle.is_still
    if not turns:
        here = _is_here(draft, hung, offset)
        return base if here else _put(draft, name, (base, hung), offset, None)
    if angle.values[0] is draft.zero and hung.on and _is_here(draft, hung, offset):
        return base
    return _put(draft, name, (base, hung), offset, angle)


def _put(
    draft: Draft, name: str, at: tuple[int, Hung], offset: Moving, angle: Moving | None
) -> int:
    """A new place at an offset from its base, with an angle of its own where it turns."""
    base, hung = at
    anchor = offset.values if offset.is_still else None
    if hung.on is not None:
        offset = _turned(draft.kinematics.axes(hung.on), offset)
    spin = draft.spin(base) if hung.on is not None else ()
    rows = _rows(draft, at, offset.values if spin else (), angle is not None)
    drift = _linear_drift(offset, spin)
    parts = [offset]
    kind: Kind = Point(draft.kinematics.dimensions)
    if angle is not None:
        parts.insert(0, angle)
        drift = (*angle.drift, *drift)
        own = spin[0] + angle.rate[0] if spin else angle.rate[0]
        kind = PlanarFrame((own,), draft.kinematics.axes(name))
    columns = {c: _column(parts, c, draft.zero) for c in columns_of(parts)}
    return draft.put(Place(name, kind, base, (Flat(rows, drift, anchor),), columns))


def _column(parts: Sequence[Moving], coordinate: int, zero: Node) -> Vector[Node]:
    return tuple(
        entry
        for part in parts
        for entry in part.columns.get(coordinate, (zero,) * len(part.values))
    )


def _turned(axes: Matrix[Node], offset: Moving) -> Moving:
    """An offset in a body's axes, in world axes while these stand still."""
    return Moving(
        transform(axes, offset.values),
        {c: transform(axes, column) for c, column in offset.columns.items()},
        transform(axes, offset.rate),
        transform(axes, offset.drift),
    )


def _linear_drift(offset: Moving, spin: Vector[Node]) -> Vector[Node]:
    """-w^2 r + 2 w J r' + r''."""
    if not spin:
        return offset.drift
    (w,), (x, y) = spin, offset.rate
    result = add(offset.drift, scale(-(w * w), offset.values))
    return add(result, scale(2 * w, (-y, x)))


def _rows(draft: Draft, at: tuple[int, Hung], arm: Vector[Node], turns: bool) -> Matrix[Node]:
    """X: the velocity of the base, w J r where the arm turns with it, and w."""
    base, hung = at
    zero, one = draft.zero, draft.kinematics.algebra.number(1)
    dimensions = draft.kinematics.dimensions
    has_spin = bool(draft.spin(base))
    swept = (-arm[1], arm[0]) if arm else (zero,) * dimensions
    rows = []
    for i in range(dimensions):
        linear = tuple(one if i == j else zero for j in range(dimensions))
        rows.append((swept[i], *linear) if has_spin else linear)
    if turns:
        spin_row = (one if arm else zero,) if has_spin else ()
        rows.insert(0, (*spin_row, *(zero,) * dimensions))
    return tuple(rows)
