"""Constraint forces in N or N m on a named point, from the multipliers of  ... = Q + J' lambda."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from eomgen.algebra.graph import Node
from eomgen.formulation import Linked
from eomgen.mechanics import named_reactions
from eomgen.mechanics.named_reactions import Reaction


def of(scene: Linked) -> tuple[Reaction[Node], ...]:
    """The reactions that the author names."""
    return named_reactions.of(scene.links.kinematics, scene.links.rows)


def values(
    reactions: tuple[Reaction[Node], ...], multipliers: Mapping[str, Any], factor: Any
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
