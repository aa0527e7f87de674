"""Inertia that a joint does not feel moves to the body before it; the motion stays the same.

What is left unchanged by the turning of a revolute joint may as well be fixed to its base: the
mass, the first moment along the axis and the second moment that is the same for all axes across
it. A sliding joint leaves the second moments unchanged, a fixed one everything (Khalil & Dombre,
Modeling, Identification and Control of Robots, 2002, ch. 9: grouped inertial parameters).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from eomgen.mechanics.recursive import rigid
from eomgen.mechanics.recursive.records import (
    GROUND,
    Place,
    PlanarFrame,
    Point,
    SpatialFrame,
    Tree,
)
from eomgen.mechanics.recursive.rigid import PAIRS, Rigid
from eomgen.mechanics.recursive.steps import Flat, Rotation, Shift, SkewTurn, Step, Turn

Split = tuple[Rigid, Rigid]  # what moves to the base, in the base's axes, and what stays


def lumped(tree: Tree) -> Tree:
    """The same tree with less inertia at its leaves; itself where nothing moves."""
    places, moves = list(tree.places), False
    for number in reversed(range(1, len(places))):
        place = places[number]
        if place.body is None or (split := _split(place, places[place.base])) is None:
            continue
        moves, (moved, kept) = True, split
        places[number] = replace(place, body=kept)
        base = places[place.base]
        if place.base != GROUND:
            total = moved if base.body is None else base.body + moved
            places[place.base] = replace(base, body=total)
    return replace(tree, places=tuple(places)) if moves else tree


def moments(tree: Tree) -> int:
    """How many masses, first and second moments of all bodies are not zero."""
    bodies = [place.body for place in tree.places if place.body is not None]
    return sum(value is not value.graph.zero for body in bodies for value in body.moments)


def _split(place: Place, base: Place) -> Split | None:
    """The two parts of a place's inertia; None where nothing moves."""
    assert place.body is not None
    if isinstance(place.kind, PlanarFrame):
        return _planar(place, base, place.body)
    if isinstance(place.kind, SpatialFrame) and isinstance(base.kind, SpatialFrame):
        return _spatial(place.steps, place.body)
    return None


def _planar(place: Place, base: Place, body: Rigid) -> Split | None:
    """The mass, where the origin is fixed to the base."""
    if len(place.steps) > 1 or not isinstance(place.steps[0], Flat):
        return None
    anchor, zero = place.steps[0].anchor, body.mass.graph.zero
    if anchor is None or not isinstance(base.kind, PlanarFrame | Point):
        return None
    particle = rigid.particle(body.mass, 2)
    moved = rigid.shifted(particle, anchor) if isinstance(base.kind, PlanarFrame) else particle
    return moved, replace(body, mass=zero)


def _spatial(steps: Sequence[Step], body: Rigid) -> Split | None:
    """Through the one run of turns, or the one sliding step, that moves."""
    steps = [s for each in steps for s in _apart(each)]
    moving = [i for i, step in enumerate(steps) if _moves(step)]
    parts = _parts(steps, moving, body)
    if parts is None:
        return None
    moved, kept = parts
    for i, step in reversed(list(enumerate(steps))):
        if i not in moving:
            before = step.rigid(moved)
            if before is None or (moving and i > moving[0]):
                return None
            moved = before
    return moved, kept


def _apart(step: Step) -> tuple[Step, ...]:
    return (step.still, step.turn) if isinstance(step, SkewTurn) else (step,)


def _moves(step: Step) -> bool:
    match step:
        case Shift(_, arm, rate, drift):
            return any(r is not arm[0].graph.zero for r in (*rate, *drift))
        case Turn(_, sine, _, rate, drift):
            return any(r is not sine.graph.zero for r in (rate, drift))
        case Rotation(matrix, rate, drift):
            return any(r is not matrix[0][0].graph.zero for r in (*rate, *drift))
    return True


def _parts(steps: Sequence[Step], moving: Sequence[int], body: Rigid) -> Split | None:
    zero = body.mass.graph.zero
    nothing = rigid.nothing(zero, 3)
    turning = [steps[i] for i in moving]
    if not turning:
        return body, nothing
    if len(turning) == 1 and isinstance(turning[0], Turn):
        return _about_axis(turning[0].axis, body)
    if all(isinstance(step, Turn | Rotation) for step in turning):
        return rigid.particle(body.mass, 3), replace(body, mass=zero)
    if len(turning) == 1 and isinstance(turning[0], Shift):
        return replace(nothing, second=body.second), replace(body, second=nothing.second)
    return None


def _about_axis(k: int, body: Rigid) -> Split:
    """m, h_k and J_jj for both axes across, which no turn about axis k changes."""
    zero, (i, j) = body.mass.graph.zero, PAIRS[k]
    across = body.second[j][j]
    first = tuple(h if axis == k else zero for axis, h in enumerate(body.first))
    second = tuple(tuple(across if a == b != k else zero for b in range(3)) for a in range(3))
    rows = [list(row) for row in body.second]
    rows[i][i], rows[j][j] = rows[i][i] - across, zero
    rest = tuple(zero if axis == k else h for axis, h in enumerate(body.first))
    kept = Rigid(zero, rest, tuple(tuple(row) for row in rows))
    return Rigid(body.mass, first, second), kept
