"""Which nodes of a graph a value is computed from."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from operator import attrgetter

from eomgen.algebra.graph import Node


def below(
    nodes: Iterable[Node],
    stop: Callable[[Node], bool] | None = None,
    known: Collection[Node] = (),
) -> list[Node]:
    """All nodes that `nodes` are computed from, themselves included, in order of evaluation.

    Operands of a node that satisfies `stop` are not entered. known: some of them, with all that is
    below these.
    """
    found = {*known, *nodes}
    stack = [*found.difference(known)]
    while stack:
        node = stack.pop()
        if stop is None or not stop(node):
            for operand in node.operands:
                if operand not in found:
                    found.add(operand)
                    stack.append(operand)
    return sorted(found, key=attrgetter("id"))
