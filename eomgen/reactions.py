"""Constraint forces in N or N m on a named point, from the multipliers of  ... = Q + J' lambda."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from eomgen.algebra.graph import Node
from eomgen.formulation import Linked
from eomgen.mechanics.constraints import Row
from eomgen.model import AXES, Constraint


@dataclass(frozen=True)
class Reaction:
    """What a named reaction is: components by axis or coordinate, each lambda * factor summed."""

    name: str
    on: str  # the point or body it acts on, in world axes; or "coordinates"
    components: tuple[tuple[str, tuple[tuple[str, Node | None], ...]], ...]
    # component -> (row, factor); a factor None is 1


def of(scene: Linked) -> tuple[Reaction, ...]:
    """The reactions that the author names."""
    named = [c for c in scene.model.constraints if c.reaction and c.kind != "unilateral"]
    return tuple(_reaction(scene, c) for c in named)


def _reaction(scene: Linked, constraint: Constraint) -> Reaction:
    assert constraint.reaction
    rows = [r for r in scene.links.rows if r.constraint.name == constraint.name]
    if constraint.points is not None:
        # C = Cr: the multipliers are the force on C, its opposite acts on Cr
        force = tuple((axis, ((r.name, None),)) for axis, r in zip(AXES, rows, strict=False))
        return Reaction(constraint.reaction, constraint.points[0], force)
    body = _body_of(scene, rows)
    names = [c.name for c in scene.model.coordinates]
    entries = tuple(
        (name if body is None else body[1].get(name, name), _factors(rows, j))
        for j, name in enumerate(names)
        if any(r.jacobian[j] is not r.rate.graph.zero for r in rows)
    )
    return Reaction(constraint.reaction, "coordinates" if body is None else body[0], entries)


def _factors(rows: list[Row[Node]], j: int) -> tuple[tuple[str, Node | None], ...]:
    return tuple((r.name, r.jacobian[j]) for r in rows)


def _body_of(scene: Linked, rows: list[Row[Node]]) -> tuple[str, Mapping[str, str]] | None:
    """(body, coordinate -> axis) where the rows hold Cartesian coordinates of one body only."""
    kinematics = scene.links.kinematics
    zero = rows[0].rate.graph.zero
    leaves = {kinematics.algebra.of(c.symbol): c.name for c in scene.model.coordinates}
    used = {
        c.name
        for j, c in enumerate(scene.model.coordinates)
        if any(r.jacobian[j] is not zero for r in rows)
    }
    for body in scene.model.bodies:
        places = kinematics.position(body.name)
        axes = {leaves[p]: axis for axis, p in zip(AXES, places, strict=False) if p in leaves}
        if used <= axes.keys():
            return body.name, axes
    return None


def values(
    reactions: tuple[Reaction, ...], multipliers: Mapping[str, Any], factor: Any
) -> dict[str, dict[str, Any]]:
    """The components of every reaction; `factor(node)` is the value of a graph node."""
    found: dict[str, dict[str, Any]] = {}
    for reaction in reactions:
        components = {
            axis: sum(
                multipliers.get(row, 0) * (1 if node is None else factor(node))
                for row, node in shares
            )
            for axis, shares in reaction.components
        }
        found[reaction.name] = {"on": reaction.on, **components}
    return found
