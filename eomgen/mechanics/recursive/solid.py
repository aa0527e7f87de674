"""Places in space: frames in their own axes, points of position formulas in world axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

from eomgen.algebra.elementary import BUILD
from eomgen.algebra.graph import Node
from eomgen.mechanics import rotation
from eomgen.mechanics.recursive.draft import Draft
from eomgen.mechanics.recursive.formulas import Moving
from eomgen.mechanics.recursive.places import Hung
from eomgen.mechanics.recursive.records import GROUND, NoTree, Place, Point, SpatialFrame
from eomgen.mechanics.recursive.steps import (
    Flat,
    FreeRotation,
    Motion,
    Rotation,
    Shift,
    SkewTurn,
    Step,
    Turn,
    advanced,
    turned,
    turned_askew,
)
from eomgen.mechanics.recursive.upright import Upright, towards, upright
from eomgen.mechanics.vectors import Matrix, Vector, add, compose, scale, transform, transpose
from eomgen.model import Quaternion
from eomgen.model import Turn as Turned


def ground(draft: Draft) -> Place:
    """The place that stands still."""
    return Place("the ground", SpatialFrame((draft.zero,) * 3), GROUND, (), {})


@dataclass
class _Path:
    """Steps from a base, with the spin and the columns at their end."""

    draft: Draft
    name: str
    base: int
    spin: Vector[Node]
    turned: Matrix[Node] | None = None  # the axes here in those of the body
    steps: list[Step] = field(default_factory=list)
    columns: dict[int, Vector[Node]] = field(default_factory=dict)

    def end(self) -> int:
        """The place where the steps so far lead."""
        if not self.steps:
            return self.base
        kind = SpatialFrame(self.spin)
        place = Place(self.name, kind, self.base, tuple(self.steps), self.columns)
        number = self.draft.put(place)
        if self.turned is not None:
            self.draft.turned[number] = self.turned
        return number

    def own(self, vector: Vector[Node]) -> Vector[Node]:
        """A vector in the axes of the body, in the axes here."""
        return vector if self.turned is None else transform(transpose(self.turned), vector)

    def cut(self, moves: bool) -> None:
        """End a place where another motion begins: what shares a coordinate is joined later."""
        if moves and self.columns:
            self.base, self.steps, self.columns = self.end(), [], {}

    def go(self, step: Step, own: dict[int, Vector[Node]]) -> None:
        """One step more; `own` are its columns."""
        moved = {c: step.motion(column) for c, column in self.columns.items()}
        for c, column in own.items():
            moved[c] = add(moved[c], column) if c in moved else column
        self.steps.append(step)
        self.columns = moved


def point(draft: Draft, name: str) -> int:
    """The place of a point or of a mass centre; in a body's axes where it is given in them."""
    if name not in draft.points:
        draft.points[name] = _point(draft, name)
    return draft.points[name]


def _point(draft: Draft, name: str) -> int:
    hung = draft.words.hung(draft.words.place(name))
    offset = draft.clock.moving(hung.components)
    if hung.on is not None:
        return _on_frame(draft, name, frame(draft, hung.on), offset)
    return _world_point(draft, name, hung, offset)


def _world_point(draft: Draft, name: str, hung: Hung, offset: Moving) -> int:
    """A place at an offset in world axes."""
    base = GROUND if hung.point is None else point(draft, hung.point)
    if hung.point is not None and _is_nothing(draft, offset):
        return base
    step = Flat(_to_world(draft, base), offset.drift)
    return draft.put(Place(name, Point(3), base, (step,), dict(offset.columns)))


def _is_nothing(draft: Draft, offset: Moving) -> bool:
    return all(v is draft.zero for v in offset.values)


def _to_world(draft: Draft, base: int) -> Matrix[Node]:
    """The velocity of a place in world axes."""
    algebra = draft.kinematics.algebra
    if isinstance(draft.kind(base), Point):
        return rotation.identity(algebra, 3)
    known = draft.turned_as.get(base)
    axes = draft.kinematics.axes(known) if known else rotation.identity(algebra, 3)
    if base in draft.turned:
        axes = compose(axes, draft.turned[base])
    return tuple((*(draft.zero,) * 3, *row) for row in axes)


def _on_frame(draft: Draft, name: str, base: int, offset: Moving) -> int:
    """A place in the axes of its base."""
    if _is_nothing(draft, offset):
        return base
    path = _Path(draft, name, base, draft.spin(base), draft.turned.get(base))
    _shift(path, offset)
    place = path.end()
    if base in draft.turned_as:
        draft.turned_as[place] = draft.turned_as[base]
    return place


def frame(draft: Draft, name: str) -> int:
    """The place of a body's frame."""
    if name not in draft.frames:
        draft.frames[name] = _frame(draft, name)
        draft.turned_as.setdefault(draft.frames[name], name)
    return draft.frames[name]


def _frame(draft: Draft, name: str) -> int:
    body = draft.words.bodies[name]
    if body.frame.along:
        raise NoTree(f"the rod {name} has no axes of its own in space")
    hung = draft.words.hung(body.frame.origin)
    offset = draft.clock.moving(hung.components)
    path = _start(draft, name, hung, offset)
    for turn in body.frame.turns:
        if isinstance(turn, Quaternion):
            _turn_freely(path, turn)
        else:
            _turn(path, turn)
    return path.end()


def _start(draft: Draft, name: str, hung: Hung, offset: Moving) -> _Path:
    """The way to the origin of a frame; where that moves in world axes it is a point first."""
    if hung.on is not None:
        base = frame(draft, hung.on)
        path = _Path(draft, name, base, draft.spin(base), draft.turned.get(base))
        if not _is_nothing(draft, offset):
            _shift(path, offset)
        return path
    if hung.point is None and offset.is_still:
        return _Path(draft, name, GROUND, draft.spin(GROUND))
    path = _Path(draft, name, _world_point(draft, name, hung, offset), (draft.zero,) * 3)
    rows = _to_world(draft, path.base)
    still = (draft.zero,) * len(rows[0])
    path.steps.append(Flat((still,) * 3 + rows, (draft.zero,) * 6))
    return path


def _shift(path: _Path, offset: Moving) -> None:
    zero = path.draft.zero
    path.cut(bool(offset.columns))
    step = Shift(path.spin, *map(path.own, (offset.values, offset.rate, offset.drift)))
    columns = {c: path.own(column) for c, column in offset.columns.items()}
    path.go(step, {c: (zero, zero, zero, *column) for c, column in columns.items()})


def _turn(path: _Path, turn: Turned) -> None:
    draft = path.draft
    angle = draft.clock.moving([turn.angle])
    axis = _axis(path, turn)
    path.cut(bool(angle.columns))
    number = _aligned(axis, axis[0].graph.one)
    step: Turn | SkewTurn | Rotation
    if number is not None:
        step = turned(number, _motion(angle, axis[number]), path.spin)
    elif angle.is_still or any(a.leaves for a in axis):
        step = _rotation(path, axis, angle)
    else:
        found = _upright(path, axis, turn)
        axis = (draft.zero, draft.zero, axis[0].graph.one * found.sign)
        motion = advanced(_motion(angle, axis[2]), found.sine, found.cosine)
        if found.tilt is None:
            step = turned_askew(found.matrix, motion, path.spin)
        else:
            tilted = turned(0, (*found.tilt, draft.zero, draft.zero), path.spin)
            path.go(tilted, {})
            step = turned(2, motion, tilted.spin)
    path.spin = add(step.spin, scale(angle.rate[0], axis))
    still = (draft.zero,) * 3
    own = {c: (*scale(slope, axis), *still) for c, (slope,) in angle.columns.items()}
    path.go(step, own)


def _axis(path: _Path, turn: Turned) -> Vector[Node]:
    """The axis of a turn in the axes before it."""
    draft = path.draft
    if turn is draft.words.bodies[path.name].frame.turns[0] and path.name in draft.ahead:
        return draft.ahead[path.name]
    return path.own(rotation.unit(draft.kinematics.algebra, turn.axis))


def _motion(angle: Moving, sign: Node) -> Motion:
    """Sine, cosine, rate and drift of an angle, counted the other way round where sign is -1."""
    (value,), (rate,), (drift,) = angle.values, angle.rate, angle.drift
    value = sign * value
    return BUILD["sin"](value), BUILD["cos"](value), sign * rate, sign * drift


def _rotation(path: _Path, axis: Vector[Node], angle: Moving) -> Rotation:
    """A turn that stands still, or about an axis that parameters decide."""
    (value,), (rate,), (drift,) = angle.values, angle.rate, angle.drift
    matrix = rotation.about(path.draft.kinematics.algebra, axis, value)
    spin = transform(transpose(matrix), path.spin)
    return Rotation(matrix, scale(rate, axis), scale(drift, axis), spin)


def _upright(path: _Path, axis: Vector[Node], turn: Turned) -> Upright:
    """The axes behind a joint about a skew axis; the body has them from now on."""
    draft, found = path.draft, upright(axis)
    before, unit = path.turned, partial(rotation.unit, draft.kinematics.algebra)
    path.turned = found.axes if before is None else compose(before, found.axes)
    following = _following(path, turn)
    if following is not None:
        columns = transpose(path.turned)
        along = scale(axis[0].graph.one * found.sign, unit(turn.axis))
        ahead = towards(found, columns[0], along, unit(following[1].axis))
        if ahead is not None:
            found, draft.ahead[following[0]], path.turned = ahead
    return found


def _following(path: _Path, turn: Turned) -> tuple[str, Turned] | None:
    """The only body that hangs on this one, and its first turn; limbs that are alike stay so."""
    bodies = path.draft.words.bodies
    hanging = [(n, b.frame.turns) for n, b in bodies.items() if b.frame.origin.on == path.name]
    if turn is not bodies[path.name].frame.turns[-1] or len(hanging) != 1:
        return None
    ((name, turns),) = hanging
    first = next(iter(turns), None)
    if not isinstance(first, Turned) or not all(c.is_number for c in first.axis):
        return None
    return name, first


def _turn_freely(path: _Path, quaternion: Quaternion) -> None:
    """A ball joint: its speeds are the angular velocity in the axes after the turn."""
    algebra, zero = path.draft.kinematics.algebra, path.draft.zero
    path.cut(True)
    matrix = rotation.quaternion(algebra, [algebra.of(s) for s in quaternion.symbols])
    if path.turned is not None:
        matrix, path.turned = compose(transpose(path.turned), matrix), None
    spin = tuple(algebra.of(s) for s in quaternion.speeds)
    before = transform(transpose(matrix), path.spin)
    units = rotation.identity(algebra, 3)
    numbers = [path.draft.clock.numbers[s] for s in quaternion.speeds]
    own = {n: (*axis, zero, zero, zero) for n, axis in zip(numbers, units, strict=True)}
    path.spin = add(before, spin)
    path.go(FreeRotation(matrix, spin, (zero,) * 3, before), own)


def _aligned(axis: Sequence[Node], one: Node) -> int | None:
    """The number of the coordinate axis along which a unit vector is; None for skew ones."""
    number, parts = None, [i for i, a in enumerate(axis) if a is not one.graph.zero]
    if len(parts) == 1 and axis[parts[0]] in (one, -one):
        number = parts[0]
    return number
