"""Where a load along a coordinate acts: inside the one joint whose angle or travel that is.

About the axis of a hinge it is a moment on the body, along a slide a force through the origin of
the body's frame; the parent takes the opposite of both.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from eomgen.algebra.graph import Node
from eomgen.mechanics import newton_euler_tree, rotation
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.newton_euler_tree import Joint
from eomgen.mechanics.vectors import Vector, compose, scale, transform
from eomgen.model import Body, Coordinate, Model, Turn


@dataclass(frozen=True)
class Inside:
    """A joint with the direction in which its coordinate moves the body."""

    body: str
    parent: str | None
    turn: int | None  # which of the body's turns; None: a slide
    direction: tuple[sp.Expr, ...]  # unit vector of a slide, in the axes of the origin
    factor: sp.Expr  # d formula / d coordinate


def of(model: Model, formula: sp.Expr) -> Inside | None:
    """The joint that a load along this formula acts in; None where it is not one joint's alone."""
    held = [c for c in model.coordinates if c.symbol in formula.free_symbols]
    if len(held) != 1:
        return None
    factor = sp.diff(formula, held[0].symbol)
    if factor.free_symbols & {c.symbol for c in model.coordinates} or _elsewhere(model, held[0]):
        return None
    joints = newton_euler_tree.joints(model)
    own = [j for j in joints if held[0].symbol in j.own and j.is_relative]
    return _in_joint(model, own[0], held[0], factor) if len(own) == 1 else None


def _elsewhere(model: Model, coordinate: Coordinate) -> bool:
    """Whether a named point or a mass centre moves by itself with the coordinate."""
    places = [*(p.place for p in model.points), *(b.com for b in model.bodies)]
    formulas = [f for p in places for f in (*p.components, *(c for c, _ in p.points))]
    return any(coordinate.symbol in f.free_symbols for f in formulas)


def _in_joint(model: Model, joint: Joint, coordinate: Coordinate, factor: sp.Expr) -> Inside | None:
    body = next(b for b in model.bodies if b.name == joint.body)
    q, turns, origin = coordinate.symbol, body.frame.turns, body.frame.origin
    using = [i for i, t in enumerate(turns) if any(q in f.free_symbols for f in t.formulas)]
    slope = tuple(sp.diff(c, q) for c in origin.components)
    sliding = any(s != 0 for s in slope) or any(q in c.free_symbols for c, _ in origin.points)
    if len(using) == 1 and not sliding:
        turn = turns[using[0]]
        hinge = isinstance(turn, Turn) and turn.angle == q
        return Inside(body.name, joint.parent, using[0], (), factor) if hinge else None
    steady = not any(s.free_symbols for s in slope) and sum(s * s for s in slope) == 1
    if using or not steady or origin.points:
        return None
    return Inside(body.name, joint.parent, None, slope, factor)


def axis(kinematics: Kinematics[Node], found: Inside) -> Vector[Node]:
    """The direction of a hinge or a slide in world axes; in a plane a hinge has one component."""
    body, algebra = kinematics.bodies[found.body], kinematics.algebra
    if found.turn is None:
        return kinematics.to_world(kinematics.vector(found.direction), body.frame.origin.on)
    if kinematics.dimensions == 2:
        return (algebra.number(1),)
    turn = body.frame.turns[found.turn]
    assert isinstance(turn, Turn)
    return transform(_before(kinematics, body, found.turn), rotation.unit(algebra, turn.axis))


def _before(kinematics: Kinematics[Node], body: Body, count: int) -> tuple[Vector[Node], ...]:
    """The axes that the first turns of a body lead to."""
    algebra, on = kinematics.algebra, body.frame.origin.on
    found = kinematics.axes(on) if on is not None else rotation.identity(algebra, 3)
    for turn in body.frame.turns[:count]:
        assert isinstance(turn, Turn)
        step = rotation.about(algebra, rotation.unit(algebra, turn.axis), algebra.of(turn.angle))
        found = compose(found, step)
    return found


def wrench(
    kinematics: Kinematics[Node], found: Inside, effort: Node
) -> tuple[Vector[Node], Vector[Node]]:
    """(force through the origin of the body's frame, moment) on the body, of a force along q."""
    force = kinematics.algebra.of(found.factor) * effort
    along = scale(force, axis(kinematics, found))
    zero = kinematics.algebra.number(0)
    if found.turn is None:
        return along, (zero,) * {1: 0, 2: 1, 3: 3}[kinematics.dimensions]
    return (zero,) * kinematics.dimensions, along
