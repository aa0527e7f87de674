"""The independent motions of a scene: one for each coordinate, three for each quaternion."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Generic

import sympy as sp

from eomgen.algebra.scalar import Algebra, S
from eomgen.mechanics.equations import virtual_name
from eomgen.mechanics.vectors import Vector, dot
from eomgen.model import Coordinate, Model, Quaternion, quaternion_rates

AXES = ("x", "y", "z")


@dataclass(frozen=True)
class Motion(Generic[S]):
    """One way to move: its rate, and where it leads: d coordinate / d displacement."""

    name: str  # of the coordinate or the speed
    displacement: str  # name of the coordinate, or of the virtual turn
    rate: sp.Symbol
    acceleration: sp.Symbol
    direction: Mapping[sp.Symbol, S]
    turn: tuple[Quaternion, int] | None = None  # the quaternion, and about which of its axes

    @property
    def virtual_symbol(self) -> sp.Symbol:
        """The symbol of the virtual displacement."""
        return sp.Symbol(virtual_name(self.displacement), real=True)


def plain(model: Model) -> tuple[Coordinate, ...]:
    """The coordinates that are no part of a quaternion."""
    parts = {s for q in model.quaternions for s in q.symbols}
    return tuple(c for c in model.coordinates if c.symbol not in parts)


def turn_name(quaternion: Quaternion, axis: int) -> str:
    """The name of the turn about an axis, which is no coordinate: only its variation exists."""
    return f"pi_{quaternion.name}_{AXES[axis]}"


def displacements(model: Model) -> tuple[str, ...]:
    """The names of what is varied, in the order of the equations."""
    turns = (turn_name(q, i) for q in model.quaternions for i in range(3))
    return (*(c.name for c in plain(model)), *turns)


def of(model: Model, algebra: Algebra[S]) -> tuple[Motion[S], ...]:
    """The motions, in the order of the equations."""
    one = algebra.number(1)
    moving = (Motion(c.name, c.name, c.rate, c.acceleration, {c.symbol: one}) for c in plain(model))
    return (*moving, *(m for q in model.quaternions for m in _turns(q, algebra)))


def _turns(quaternion: Quaternion, algebra: Algebra[S]) -> Iterator[Motion[S]]:
    """The turns about the body-fixed axes: de = e (0, d pi) / 2."""
    pairs = zip(quaternion.speeds, quaternion.accelerations, strict=True)
    for i, (speed, rate) in enumerate(pairs):
        axis = tuple(algebra.number(int(i == j)) for j in range(3))
        direction = dict(zip(quaternion.symbols, rates(quaternion, algebra, axis), strict=True))
        name = turn_name(quaternion, i)
        yield Motion(speed.name, name, speed, rate, direction, (quaternion, i))


def rates(quaternion: Quaternion, algebra: Algebra[S], spin: Vector[S]) -> tuple[S, ...]:
    """e' of a quaternion that turns with the angular velocity `spin` in the turned axes."""
    parts = [algebra.of(s) for s in quaternion.symbols]
    return quaternion_rates(parts, spin)


def normalised(model: Model, algebra: Algebra[S]) -> tuple[S, ...]:
    """The coordinates, the parts of every quaternion divided by their length."""
    found = {c.symbol: algebra.of(c.symbol) for c in model.coordinates}
    for q in model.quaternions:
        parts = tuple(found[s] for s in q.symbols)
        scale = algebra.number(1) / algebra.apply("sqrt", dot(parts, parts))
        found |= {s: found[s] * scale for s in q.symbols}
    return tuple(found[c.symbol] for c in model.coordinates)


def holds_motion(model: Model, eliminated: tuple[Coordinate, ...] = ()) -> bool:
    """Whether an output mentions q'' or u', those of eliminated coordinates too."""
    held = {c.acceleration for c in model.coordinates + eliminated}
    held |= {s.rate for s in model.speeds}
    return any(o.formula.free_symbols & held for o in model.outputs)
