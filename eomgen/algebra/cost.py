"""What values on a graph cost: floating-point operations, and the longest chain among them.

A processor computes several values at once that do not need each other, so a method with fewer
operations in one long chain may take longer than one with more of them side by side.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Container, Iterable, Sequence
from dataclasses import dataclass

from eomgen.algebra.graph import Node
from eomgen.algebra.walk import swept
from eomgen.program import OPERATORS

FREE = dict.fromkeys(("number", "read", "symbol", "solved", "pi", "negate"), 0)
# in additions; a sine with its cosine counts as one pair, any other function as two of them
WEIGHTS = dict.fromkeys(OPERATORS, 20) | FREE | {
    "add": 1, "subtract": 1, "multiply": 1, "divide": 5, "sqrt": 5, "sin": 10, "cos": 10,
    "abs": 1, "sign": 1, "min": 1, "max": 1,
}  # fmt: skip
# latencies of a present processor; every method waits for the same sines and cosines first
CYCLES = dict.fromkeys(OPERATORS, 45) | FREE | {
    "add": 4, "subtract": 4, "multiply": 4, "divide": 13, "sqrt": 18, "sin": 0, "cos": 0,
    "abs": 1, "sign": 4, "min": 4, "max": 4,
}  # fmt: skip


@dataclass(frozen=True)
class Cost:
    """What a call computes, and how long it must wait."""

    operations: int  # weighted, in additions
    cycles: int  # of the longest chain

    @property
    def total(self) -> int:
        """About the time of a call: an operation takes as long as a cycle of waiting."""
        return self.operations + self.cycles


def of(results: Collection[Node], prepared: int = 0) -> Cost:
    """What results cost together, each shared value once.

    prepared: bit set of leaves; what depends on these only is known before and costs nothing.
    """
    moving = _moving(results, prepared)
    return Cost(_operations(moving), _longest_chain(moving))


def operations(results: Iterable[Node], prepared: int = 0) -> int:
    """The weighted operations that results take."""
    return _operations(_moving(results, prepared))


def _moving(results: Iterable[Node], prepared: int) -> list[Node]:
    """The nodes that are not known before, in order of evaluation."""
    bits = ~prepared
    return [node for node in swept(results) if node.leaves & bits]


def _operations(nodes: Sequence[Node]) -> int:
    counts = Counter([node.operator for node in nodes if node.operator != "system"])
    systems = sum(_system(node) for node in nodes if node.operator == "system")
    return sum(WEIGHTS[operator] * count for operator, count in counts.items()) + systems


def _longest_chain(nodes: Sequence[Node]) -> int:
    """The cycles that pass from the arguments, sines and cosines known, to the last result."""
    cycles = [CYCLES.get(node.operator) for node in nodes]
    systems = zip(nodes, cycles, strict=True)
    return longest(nodes, [_chain_of_system(n) if c is None else c for n, c in systems])


def longest(nodes: Sequence[Node], takes: Iterable[int], given: Container[Node] = ()) -> int:
    """The longest sum of what nodes take, one after the other; what is given waits for nothing.

    nodes: operands first.
    """
    ready = [0] * (1 + max([node.id for node in nodes], default=0))
    for node, own in zip(nodes, takes, strict=True):
        start = 0
        for operand in () if node in given else node.operands:
            if ready[operand.id] > start:
                start = ready[operand.id]
        ready[node.id] = start + own
    return max(ready)


def _system(node: Node) -> int:
    """A system solved in a loop: n^3 / 3, and 2 n^2 for each right side."""
    size: int = node.datum
    columns = len(node.operands) // size - (size + 1) // 2
    return size**3 // 3 + 2 * size**2 * columns


def _chain_of_system(node: Node) -> int:
    """One row after the other is eliminated and filled in."""
    size: int = node.datum
    return size * (CYCLES["divide"] + 4 * CYCLES["multiply"])
