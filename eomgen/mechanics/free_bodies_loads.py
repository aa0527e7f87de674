"""What acts on each body in closed form, and what acts along coordinates instead."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from eomgen.algebra import normal
from eomgen.algebra.normal import Form
from eomgen.mechanics import (
    constraints,
    efforts,
    lagrange,
    motions,
    newton_euler,
    newton_euler_loads,
)
from eomgen.mechanics import newton_euler_tree as tree
from eomgen.mechanics.efforts import Effort
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.newton_euler import Wrench
from eomgen.mechanics.newton_euler_loads import Push
from eomgen.mechanics.vectors import Vector, add, dot, subtract, transform, transpose
from eomgen.model import Place

Closed = Kinematics[Form]
Wrenches = dict[str, Wrench[Form]]


@dataclass(frozen=True)
class Loads:
    """Sums about the mass centre of each body, world axes; a force [N] along each coordinate."""

    on_bodies: Wrenches
    along: tuple[Form, ...]
    lost: tuple[str, ...]  # loads on points that no body carries


def nothing(kinematics: Closed) -> Wrench[Form]:
    """No force and no moment."""
    zero = kinematics.algebra.number(0)
    return Wrench((zero,) * kinematics.dimensions, (zero,) * MOMENTS[kinematics.dimensions])


MOMENTS = {1: 0, 2: 1, 3: 3}  # components of a moment by those of a force


def plus(left: Wrench[Form], right: Wrench[Form]) -> Wrench[Form]:
    """The sum of two wrenches about one point."""
    return Wrench(add(left.force, right.force), add(left.moment, right.moment))


def less(left: Wrench[Form], right: Wrench[Form]) -> Wrench[Form]:
    """The difference of two wrenches about one point."""
    return Wrench(subtract(left.force, right.force), subtract(left.moment, right.moment))


def applied(kinematics: Closed) -> Loads:
    """Weights, springs, dampers, forces and moments."""
    still = nothing(kinematics).moment
    found = {
        b.name: Wrench(newton_euler_loads.weight(kinematics, b.mass), still)
        for b in kinematics.model.bodies
    }
    lost = list(_pushed(kinematics, found, newton_euler_loads.applied(kinematics)))
    none = nothing(kinematics).force
    for twist in newton_euler_loads.twists(kinematics):
        found[twist.body] = plus(found[twist.body], Wrench(none, twist.moment))
    return Loads(found, _along(kinematics), tuple(lost))


def multiplied(kinematics: Closed) -> Loads:
    """The forces of the bilateral constraints: lambda where two points are joined, else J' lambda.

    They stand apart: the equations of motion keep them.
    """
    found = {b.name: nothing(kinematics) for b in kinematics.model.bodies}
    along = nothing_along(kinematics)
    lost: list[str] = []
    for constraint in kinematics.model.constraints:
        if constraint.kind == "unilateral":
            continue
        rows = constraints.of(kinematics, constraint, varied(kinematics))
        values = [kinematics.algebra.of(lagrange.multiplier_symbol(r.name)) for r in rows]
        if constraint.points is not None:
            ends = newton_euler_loads.both(constraint.name, *constraint.points, tuple(values))
            lost += _pushed(kinematics, found, ends)
        else:
            columns = zip(*(r.jacobian for r in rows), strict=True)
            along = add(along, tuple(dot(column, values) for column in columns))
    return Loads(found, along, tuple(lost))


def nothing_along(kinematics: Closed) -> tuple[Form, ...]:
    """No force along any coordinate."""
    return (kinematics.algebra.number(0),) * len(varied(kinematics))


def _pushed(kinematics: Closed, found: Wrenches, pushes: Iterator[Push[Form]]) -> Iterator[str]:
    """Adds forces on points to the bodies that carry them; names of those that nobody does."""
    for push in pushes:
        carrier = tree.carrier(kinematics.model, push.point)
        if carrier.body is not None:
            arm = subtract(kinematics.position(push.point), kinematics.position(carrier.body))
            wrench = Wrench(push.force, newton_euler.lever(arm, push.force))
            found[carrier.body] = plus(found[carrier.body], wrench)
        elif carrier.massless:
            yield push.name


def _along(kinematics: Closed) -> tuple[Form, ...]:
    """Q of springs and dampers along formulas, and of energies that the author gives."""
    return _generalized(kinematics, list(_scalar(kinematics)))


def varied(kinematics: Closed) -> tuple[sp.Symbol, ...]:
    """The symbols of the velocities: the speeds where the scene moves by them, else the rates."""
    model = kinematics.model
    moving = tuple(s.symbol for s in model.speeds if s.symbol in kinematics.flow.derivatives)
    if moving and len(moving) == len(model.speeds):
        return moving
    return tuple(m.rate for m in motions.of(model, kinematics.algebra))


def _generalized(kinematics: Closed, found: Sequence[Effort[Form]]) -> tuple[Form, ...]:
    """Q for each velocity."""
    return tuple(_force(kinematics, found, u) for u in varied(kinematics))


def _force(kinematics: Closed, found: Sequence[Effort[Form]], velocity: sp.Symbol) -> Form:
    ring = kinematics.algebra.number(0).ring
    shares = (efforts.generalized_force(kinematics, e, velocity) for e in found)
    return normal.total(ring, shares)


def total(kinematics: Closed) -> tuple[Form, ...]:
    """Q of every applied force, for each velocity."""
    return _generalized(kinematics, every(kinematics))


def constrained(kinematics: Closed) -> tuple[Form, ...]:
    """J' lambda, for each coordinate."""
    rows = constraints.rows(kinematics, varied(kinematics))
    values = [kinematics.algebra.of(lagrange.multiplier_symbol(r.name)) for r in rows]
    columns = zip(*(r.jacobian for r in rows), strict=True)
    return tuple(dot(c, values) for c in columns) if rows else nothing_along(kinematics)


def every(kinematics: Closed) -> list[Effort[Form]]:
    """All efforts, with a potential or without."""
    return [
        *efforts.conservative(kinematics),
        *efforts.dissipative(kinematics),
        *efforts.nonconservative(kinematics),
    ]


def _scalar(kinematics: Closed) -> Iterator[Effort[Form]]:
    """Those that act along coordinates."""
    model = kinematics.model
    named = {(e.name, "spring") for e in model.springs if e.along is not None}
    named |= {(e.name, "damper") for e in model.dampers if e.along is not None}
    named |= {(d.name, "force") for d in model.drives}
    for effort in every(kinematics):
        if effort.kind == "formula" or (effort.name, effort.kind) in named:
            yield effort


def turning(kinematics: Closed) -> frozenset[str]:
    """Bodies of a plane scene whose moments count: with inertia, or holding or taking more.

    A body without inertia may carry others, take a moment, or be pushed beside its mass centre.
    """
    model = kinematics.model
    if kinematics.dimensions != 2:
        return frozenset()
    found = {b.name for b in model.bodies if kinematics.spin(b) is not None}
    found |= {on for b in model.bodies for on in _carriers(b.frame.origin)}
    found |= {on for p in model.points for on in _carriers(p.place)}
    for twist in newton_euler_loads.twists(kinematics):
        found.add(twist.body)
    for loads in (applied(kinematics), multiplied(kinematics)):
        for name, wrench in loads.on_bodies.items():
            if not all(kinematics.algebra.is_zero(m) for m in wrench.moment):
                found.add(name)
    return frozenset(found)


def _carriers(place: Place) -> list[str]:
    return [] if place.on is None else [place.on]


def in_own_axes(kinematics: Closed, name: str, moment: Vector[Form]) -> Vector[Form]:
    """A moment in world axes in those of the body's spin: a rod's are the world's."""
    spin = kinematics.spin(kinematics.bodies[name])
    if spin is None or not spin.gyroscopic:
        return moment
    return transform(transpose(kinematics.axes(name)), moment)
