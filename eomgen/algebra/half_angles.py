"""1 - cos(x) as 2 sin(x/2)^2 and 1 + cos(x) as 2 cos(x/2)^2, where the digits are missed.

They are missed where the value stands by itself: in a potential, a gap, an elongation. In a
rotation about a skew axis, cos(x) 1 + (1 - cos(x)) e e' + sin(x) [e x], it is added to a multiple
of sin(x), which is larger wherever it loses digits; there it stays, and a sine less is computed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from eomgen.algebra.elementary import cos, sin
from eomgen.algebra.graph import Node
from eomgen.algebra.lift import Build
from eomgen.algebra.terms import Products, summands
from eomgen.algebra.walk import below

Parents = Mapping[Node, list[Node]]


def replaced(nodes: Iterable[Node], build: Build, products: Products) -> dict[Node, Node] | None:
    """What each node becomes that `nodes` are computed from; None where nothing changes."""
    wanted = list(nodes)
    everything = below(wanted)
    candidates = {a: x for a in everything if (x := _angle(a)) is not None}
    if not candidates:
        return None
    parents: dict[Node, list[Node]] = {a: [] for a in everything}
    for node in everything:
        for operand in node.operands:
            parents[operand].append(node)
    final = frozenset(wanted)
    made = {
        a: _halved(a, x)
        for a, x in candidates.items()
        if a in final or not _is_covered(a, sin(x), (parents, final, products))
    }
    return _rebuilt(everything, made, build) if made else None


def _angle(node: Node) -> Node | None:
    """The angle x of 1 - cos(x), cos(x) - 1 or 1 + cos(x)."""
    if node.operator not in ("add", "subtract"):
        return None
    first, second = node.operands
    for wave, one in ((first, second), (second, first)):
        if wave.operator == "cos" and one is node.graph.one:
            return wave.operands[0]
    return None


def _halved(node: Node, angle: Node) -> Node:
    """The other form."""
    wave = (cos if node.operator == "add" else sin)(angle / 2)
    value = 2 * (wave * wave)
    return -value if node.operator == "subtract" and node.operands[1] is node.graph.one else value


def _is_covered(node: Node, wave: Node, around: tuple[Parents, frozenset[Node], Products]) -> bool:
    """Whether all that becomes of a node are terms beside a multiple of the sine."""
    parents, final, products = around
    for parent in parents[node]:
        if parent in final and parent.operator not in ("add", "subtract"):
            return False
        if parent.operator in ("multiply", "negate"):
            if not _is_covered(parent, wave, around):
                return False
        elif parent.operator in ("add", "subtract"):
            others = (a for a in parent.operands if a is not node)
            if not any(products.of(t).powers.get(wave) for a in others for t in summands(a)):
                return False
        else:
            return False
    return True


def _rebuilt(everything: Iterable[Node], made: dict[Node, Node], build: Build) -> dict[Node, Node]:
    """Every node over the new values."""
    found: dict[Node, Node] = {}
    for node in everything:
        operands = tuple(found[a] for a in node.operands)
        if node in made:
            found[node] = made[node]
        elif all(a is b for a, b in zip(operands, node.operands, strict=True)):
            found[node] = node
        elif node.operator in build:
            found[node] = build[node.operator](*operands)
        else:  # a system solved in a loop, which depends on more than its entries
            found[node] = node.graph.make(node.operator, operands, node.datum)
            found[node].leaves |= node.leaves
    return found
