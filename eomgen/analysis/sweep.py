"""Nodes put in order once and evaluated at many states: what a search needs thousands of times."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from eomgen.algebra.arithmetic import Arithmetic
from eomgen.algebra.graph import Node
from eomgen.algebra.walk import below
from eomgen.analysis.linkage import State

LEAVES = ("read", "symbol")
Step = tuple[int, Callable[..., Any], tuple[int, ...]]  # slot, operator, operands' slots


@dataclass(frozen=True)
class Sweep:
    """Nodes with everything that they are computed from, in order of evaluation."""

    order: tuple[Node, ...]
    leaves: tuple[tuple[int, Node], ...]  # with their slots
    results: tuple[int, ...]  # slots of the nodes
    plans: dict[int, tuple[list[Any], list[Step]]] = field(default_factory=dict)

    def at(
        self, state: State, arithmetic: Arithmetic, more: Mapping[Node, Any] | None = None
    ) -> list[Any]:
        """The values at a state; `more` gives those of leaves that no state has."""
        start, steps = self._plan(arithmetic)
        slots = list(start)
        for slot, leaf in self.leaves:
            value = state.read(leaf.datum) if leaf.operator == "read" else (more or {})[leaf]
            slots[slot] = arithmetic.number(value)
        for slot, function, operands in steps:
            slots[slot] = function(*[slots[o] for o in operands])
        return [slots[slot] for slot in self.results]

    def _plan(self, arithmetic: Arithmetic) -> tuple[list[Any], list[Step]]:
        """Numbers in their slots, and the steps, over one kind of number."""
        if id(arithmetic) not in self.plans:
            self.plans[id(arithmetic)] = _planned(self.order, arithmetic)
        return self.plans[id(arithmetic)]


def of(nodes: Sequence[Node]) -> Sweep:
    """The sweep of some nodes."""
    order = tuple(below(nodes))
    places = {node: slot for slot, node in enumerate(order)}
    leaves = ((s, node) for node, s in places.items() if node.operator in LEAVES)
    return Sweep(order, tuple(leaves), tuple(places[node] for node in nodes))


def _planned(order: Sequence[Node], arithmetic: Arithmetic) -> tuple[list[Any], list[Step]]:
    places = {node: slot for slot, node in enumerate(order)}
    start: list[Any] = [None] * len(order)
    steps: list[Step] = []
    for slot, node in enumerate(order):
        if node.operator == "number":
            start[slot] = arithmetic.number(node.datum)
        elif node.operator not in LEAVES:
            operands = tuple(places[a] for a in node.operands)
            steps.append((slot, arithmetic.functions[node.operator], operands))
    return start, steps
