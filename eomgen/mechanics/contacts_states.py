"""Numbers of graph nodes at seeded random states: what the derivation decides by looking.

Inside the declared range of the coordinates; parameters have the spec's values.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from contextlib import suppress

from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.algebra.graph import Node
from eomgen.algebra.walk import below
from eomgen.errors import UsageError
from eomgen.mechanics import machine
from eomgen.mechanics.kinematics import Kinematics
from eomgen.model import Coordinate

COUNT = 5  # states that are looked at
TRIALS = 200  # states that are drawn to find so many
IRREGULAR = (ValueError, ZeroDivisionError, OverflowError)  # a root or quotient is not defined


def values(kinematics: Kinematics[Node], nodes: Sequence[Node]) -> list[list[float]]:
    """The values of the nodes at `COUNT` states where all are defined.

    Raises:
        UsageError: no such state was found.
    """
    chance = random.Random(f"contacts {kinematics.model.name}")
    found: list[list[float]] = []
    for _ in range(TRIALS):
        if len(found) == COUNT:
            break
        with suppress(*IRREGULAR):
            found.append(evaluate(nodes, _leaves(kinematics, nodes, chance), FLOAT))
    if not found:
        raise UsageError(
            f"no state was found at which the contacts of {kinematics.model.name} are defined; "
            "give `range` for the coordinates"
        )
    return found


def _leaves(
    kinematics: Kinematics[Node], nodes: Sequence[Node], chance: random.Random
) -> dict[Node, float]:
    """A value for every argument of the program that the nodes read."""
    known = dict(_given(kinematics, chance))
    for leaf in below(nodes):
        if leaf.operator == "read" and leaf not in known:
            known[leaf] = chance.uniform(-2.0, 2.0)
    return known


def _given(kinematics: Kinematics[Node], chance: random.Random) -> Iterator[tuple[Node, float]]:
    """Parameters, then the coordinates, whose range may be a formula of the parameters."""
    bindings = kinematics.algebra.bindings
    parameters = {
        bindings[p.symbol]: chance.uniform(1.0, 2.0) if p.value is None else float(p.value)
        for p in machine.free_parameters(kinematics.model)
    }
    yield from parameters.items()
    for coordinate in kinematics.model.coordinates:
        low, high = _bounds(kinematics, coordinate, parameters)
        yield bindings[coordinate.symbol], chance.uniform(low, high)


def _bounds(
    kinematics: Kinematics[Node], coordinate: Coordinate, parameters: dict[Node, float]
) -> tuple[float, float]:
    """The declared range; else a neighbourhood of zero, above it if declared positive."""
    declared = kinematics.model.range.get(coordinate.name)
    if declared is None:
        return (0.5, 2.0) if coordinate.positive else (-1.5, 1.5)
    low, high = evaluate([kinematics.algebra.of(end) for end in declared], parameters, FLOAT)
    return low, high
