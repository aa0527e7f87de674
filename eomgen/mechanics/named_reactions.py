"""Constraint forces under the author's names: components from multipliers, over either algebra."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Generic

from eomgen.algebra.scalar import S
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.kinematics import Kinematics
from eomgen.model import AXES, Constraint


@dataclass(frozen=True)
class Reaction(Generic[S]):
    """What a named reaction is: components by axis or coordinate, each lambda * factor summed."""

    name: str
    on: str  # the point or body it acts on, in world axes; or "coordinates"
    components: tuple[tuple[str, tuple[tuple[str, S | None], ...]], ...]
    # component -> (row, factor); a factor None is 1


def of(kinematics: Kinematics[S], rows: Sequence[Row[S]]) -> tuple[Reaction[S], ...]:
    """The reactions of two-sided constraints that the author names."""
    constraints = kinematics.model.constraints
    named = [c for c in constraints if c.reaction and c.kind != "unilateral"]
    return tuple(
        _reaction(kinematics, c, [r for r in rows if r.constraint.name == c.name]) for c in named
    )


def _reaction(
    kinematics: Kinematics[S], constraint: Constraint, rows: Sequence[Row[S]]
) -> Reaction[S]:
    assert constraint.reaction
    if constraint.points is not None:
        # C = Cr: the multipliers are the force on C, its opposite acts on Cr
        force = tuple((axis, ((r.name, None),)) for axis, r in zip(AXES, rows, strict=False))
        return Reaction(constraint.reaction, constraint.points[0], force)
    used = _used(kinematics, rows)
    body = body_of(kinematics, rows)
    entries = tuple(
        (name if body is None else body[1].get(name, name), _factors(rows, j))
        for j, name in used.items()
    )
    return Reaction(constraint.reaction, "coordinates" if body is None else body[0], entries)


def _factors(rows: Sequence[Row[S]], j: int) -> tuple[tuple[str, S | None], ...]:
    return tuple((r.name, r.jacobian[j]) for r in rows)


def _used(kinematics: Kinematics[S], rows: Sequence[Row[S]]) -> dict[int, str]:
    """The coordinates that the rows move with, by their numbers."""
    return {
        j: c.name
        for j, c in enumerate(kinematics.model.coordinates)
        if any(not kinematics.algebra.is_zero(r.jacobian[j]) for r in rows)
    }


def body_of(
    kinematics: Kinematics[S], rows: Sequence[Row[S]]
) -> tuple[str, Mapping[str, str]] | None:
    """(body, coordinate -> axis) where the rows hold Cartesian coordinates of one body only."""
    used = set(_used(kinematics, rows).values())
    leaves = {kinematics.algebra.of(c.symbol): c.name for c in kinematics.model.coordinates}
    for body in kinematics.model.bodies:
        places = kinematics.position(body.name)
        axes = {leaves[p]: axis for axis, p in zip(AXES, places, strict=False) if p in leaves}
        if used <= axes.keys():
            return body.name, axes
    return None
