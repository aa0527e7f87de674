"""The order in which values are written: what the longest chain waits for comes first.

Processors and compilers look ahead in the code only so far. List scheduling: of all values whose
operands are there, the one with the longest way to the end is next. It pays where the code waits
for one value after the other; where there is always something to do, it would only keep more
values alive than there are registers.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from heapq import heapify, heappop, heappush

from eomgen.algebra.cost import CYCLES, WEIGHTS, longest
from eomgen.algebra.graph import Node

LATENCY = {**CYCLES, "sin": 25, "cos": 25}  # cycles until a value is there
ISSUED = {"sin": 18.0, "cos": 18.0, "divide": 2.0, "sqrt": 2.0}  # cycles that the units are busy
ANY = 0.5  # of any other operation
AT_ONCE = 2  # operations that are done while the chain waits one cycle


def by_critical_path(nodes: Sequence[Node], given: Container[Node]) -> list[Node]:
    """The nodes of a function in the order to write them; operands come before what they are in.

    They are as they were where they are more than `AT_ONCE` for each cycle of the longest chain.

    nodes: operands first; given: what is there from the start.
    """
    if not _waits(nodes, given):
        return list(nodes)
    number = {node: i for i, node in enumerate(nodes)}
    operands = [
        [] if node in given else [number[a] for a in dict.fromkeys(node.operands)] for node in nodes
    ]
    computed = list(zip(nodes, operands, strict=True))
    latency = [LATENCY.get(n.operator, 0) if below else 0 for n, below in computed]
    busy = [ISSUED.get(n.operator, ANY) if below else 0.0 for n, below in computed]
    return [nodes[i] for i in _listed(operands, latency, busy)]


def _waits(nodes: Sequence[Node], given: Container[Node]) -> bool:
    """Whether the longest chain takes more than the operations side by side."""
    computed = [node.operator if node not in given else "read" for node in nodes]
    work = sum([WEIGHTS.get(operator, 0) for operator in computed])
    chain = longest(nodes, [LATENCY.get(operator, 0) for operator in computed], given)
    return work <= AT_ONCE * chain


def _to_the_end(operands: Sequence[Sequence[int]], latency: Sequence[int]) -> list[int]:
    """The cycles from the start of each value to the end of the longest chain that it is in."""
    rest = list(latency)
    for i in reversed(range(len(rest))):
        for k in operands[i]:
            rest[k] = max(rest[k], latency[k] + rest[i])
    return rest


def _listed(
    operands: Sequence[Sequence[int]],
    latency: Sequence[int],
    busy: Sequence[float],
) -> list[int]:
    """Numbers in the order in which one unit would start them."""
    rest = _to_the_end(operands, latency)
    users: list[list[int]] = [[] for _ in operands]
    for i, below in enumerate(operands):
        for k in below:
            users[k].append(i)
    missing = [len(below) for below in operands]
    there = [0.0] * len(operands)  # when all operands are
    waiting = [(0.0, i) for i, count in enumerate(missing) if not count]
    heapify(waiting)
    startable: list[tuple[int, int]] = []
    time, order = 0.0, []
    while waiting or startable:
        if not startable:
            time = max(time, waiting[0][0])
        while waiting and waiting[0][0] <= time:
            _, i = heappop(waiting)
            heappush(startable, (-rest[i], i))
        _, i = heappop(startable)
        order.append(i)
        time += busy[i]
        for k in users[i]:
            there[k] = max(there[k], time + latency[i])
            missing[k] -= 1
            if not missing[k]:
                heappush(waiting, (there[k], k))
    return order
