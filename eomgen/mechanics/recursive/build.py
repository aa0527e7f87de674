"""Kinematics on the graph -> tree of places with what each carries."""

from __future__ import annotations

from types import ModuleType

from eomgen.algebra.graph import Node
from eomgen.mechanics import motions, rotation, speeds
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive import plane, solid
from eomgen.mechanics.recursive import rigid as inertia
from eomgen.mechanics.recursive.draft import Draft, joints, settled
from eomgen.mechanics.recursive.formulas import Clock, Moving
from eomgen.mechanics.recursive.places import words
from eomgen.mechanics.recursive.records import (
    GROUND,
    NoTree,
    Place,
    PlanarFrame,
    SpatialFrame,
    Spin,
    Tree,
)
from eomgen.mechanics.recursive.rigid import Rigid
from eomgen.mechanics.recursive.steps import Flat
from eomgen.mechanics.vectors import Vector, add, cross, dot, scale, transpose
from eomgen.model import Body
from eomgen.program import Read


def tree_of(kinematics: Kinematics[Node]) -> Tree:
    """The tree of a scene whose speeds are rates of coordinates and spins of quaternions.

    Raises:
        NoTree: it is none; the message says why.
    """
    _refuse(kinematics)
    draft = Draft(kinematics, words(kinematics.model), Clock(kinematics))
    space = solid if kinematics.dimensions == 3 else plane
    draft.places.append(space.ground(draft))
    for body in kinematics.model.bodies:
        _load(draft, space, body)
    names = speeds.names(kinematics.model)
    gravity = kinematics.vector(kinematics.model.gravity)
    places, frames = settled(draft)
    turned = {n: draft.turned[i] for n, i in draft.frames.items() if i in draft.turned}
    return Tree(tuple(places), joints(places, names), gravity, frames, turned)


def _refuse(kinematics: Kinematics[Node]) -> None:
    model, algebra = kinematics.model, kinematics.algebra
    plain = motions.plain(model)
    if model.speeds and [s.symbol for s in speeds.plain(model)] != [c.rate for c in plain]:
        raise NoTree("its speeds are declared")
    if model.energy.kinetic != 0:
        raise NoTree("a kinetic energy is given as a formula")
    for c in plain:
        if not all(isinstance(algebra.of(s).datum, Read) for s in (c.symbol, c.rate)):
            raise NoTree(f"{c.name} follows from other coordinates")


def _load(draft: Draft, space: ModuleType, body: Body) -> None:
    """The inertia of a body, at the place that carries it."""
    mass = draft.kinematics.algebra.of(body.mass)
    dimensions = draft.kinematics.dimensions
    if body.frame.along and dimensions > 1:
        centre = space.point(draft, body.name)
        draft.load(centre, inertia.particle(mass, dimensions))
        _load_rod(draft, body, mass, centre)
        return
    com = body.com
    if not body.inertia and _is_plain(draft, body):
        draft.load(space.point(draft, body.name), inertia.particle(mass, dimensions))
        return
    frame = space.frame(draft, body.name)
    if not isinstance(draft.kind(frame), PlanarFrame | SpatialFrame):
        # it never turns
        draft.load(space.point(draft, body.name), inertia.particle(mass, dimensions))
        return
    offset = draft.clock.moving(com.components)
    tensor = _tensor(draft, body, frame)
    if com.points or not offset.is_still:
        draft.load(space.point(draft, body.name), inertia.particle(mass, dimensions))
        none = inertia.nothing(draft.zero, dimensions)
        draft.load(frame, Rigid(none.mass, none.first, tensor))
        return
    draft.load(frame, inertia.about_origin(mass, draft.own(frame, offset.values), tensor))


def _is_plain(draft: Draft, body: Body) -> bool:
    """Whether a particle is at a point that needs no axes of the body."""
    if body.com.on != body.name:
        return True
    return draft.words.is_at_origin(body.name) and body.name not in draft.words.carriers


def _tensor(draft: Draft, body: Body, frame: int) -> tuple[tuple[Node, ...], ...]:
    size = 1 if draft.kinematics.dimensions == 2 else 3
    if not body.inertia:
        return inertia.particle(draft.zero, draft.kinematics.dimensions).second
    entries = draft.kinematics.vector(body.inertia)
    if any(draft.clock.moved_by(e) for e in entries):
        raise NoTree(f"the inertia of {body.name} moves")
    tensor = tuple(tuple(entries[size * i : size * i + size]) for i in range(size))
    turned = draft.turned.get(frame)
    return tensor if turned is None else inertia.turned_tensor(tensor, transpose(turned))


def _load_rod(draft: Draft, body: Body, mass: Node, centre: int) -> None:
    """The turning of a uniform rod: w = d x d' / d^2, J = m d^2 / 12 across it."""
    assert body.frame.along
    along = draft.clock.moving(draft.words.between(*body.frame.along))
    if along.is_still:
        return
    square = dot(along.values, along.values)
    second = mass * square / 12
    if draft.clock.moved_by(second):
        raise NoTree(f"the rod {body.name} changes its length")
    columns = {c: _spun(along.values, column, square) for c, column in along.columns.items()}
    size = (
        len(next(iter(columns.values())))
        if columns
        else len(_spun(along.values, along.rate, square))
    )
    base = draft.places[centre].base if draft.places[centre].columns else GROUND
    still = (draft.zero,) * draft.kind(base).size
    step = Flat((still,) * size, _spin_drift(draft, along, square, size))
    body_inertia = Rigid(draft.zero, (), rotation.identity(draft.kinematics.algebra, size))
    body_inertia = Rigid(draft.zero, (), tuple(scale(second, row) for row in body_inertia.second))
    draft.put(Place(f"{body.name} (turning)", Spin(size), base, (step,), columns, body_inertia))


def _spun(along: Vector[Node], moving: Vector[Node], square: Node) -> Vector[Node]:
    if len(along) == 2:
        return ((along[0] * moving[1] - along[1] * moving[0]) / square,)
    return tuple(c / square for c in cross(along, moving))


def _spin_drift(draft: Draft, along: Moving, square: Node, size: int) -> Vector[Node]:
    """The rate of w with every q'' = 0: w = sum of W_j q_j' + W_t, each W differentiated."""
    movers = {number: (symbol, speed) for number, symbol, _, speed in draft.clock.movers}
    parts = dict(along.columns)
    parts[-1] = draft.clock.along(along.values, movers[-1][0])
    total = (draft.zero,) * size
    for number, column in parts.items():
        slope = _spun(along.values, column, square)
        moving = draft.clock.motion(slope).rate
        total = add(total, scale(movers[number][1], moving))
    return total
