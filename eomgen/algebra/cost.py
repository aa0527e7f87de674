"""What a program of graph nodes would cost, counted in floating-point operations."""

from __future__ import annotations

from collections.abc import Iterable

from eomgen.algebra.graph import Node, reached
from eomgen.program import OPERATORS

WEIGHTS = dict.fromkeys(OPERATORS, 20) | {  # flops; a sine with its cosine counts as one pair
    "add": 1, "subtract": 1, "multiply": 1, "negate": 0, "divide": 5, "sqrt": 5, "pi": 0,
    "sin": 10, "cos": 10, "abs": 1, "sign": 1, "min": 1, "max": 1,
    "number": 0, "read": 0, "symbol": 0, "solved": 0,
}  # fmt: skip


def operations(results: Iterable[Node], prepared: int = 0) -> int:
    """The weighted operations that results take, each shared value once.

    prepared: bit set of leaves; what depends on these only is known before and counts nothing.
    """
    moving, total = ~prepared, 0
    for node in reached(results):
        weight = WEIGHTS.get(node.operator)
        if weight != 0 and node.leaves & moving:
            total += weight or _system(node)
    return total


def _system(node: Node) -> int:
    """A system solved in a loop: n^3 / 3 and twice n^2."""
    size: int = node.datum
    return size**3 // 3 + 2 * size**2
