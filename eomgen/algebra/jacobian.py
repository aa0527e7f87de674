"""Matrices of partial derivatives on the graph, forward or reverse, whichever costs less.

At the kinks of the language a Jacobian is the mean of both sides: |x|' = sign(x), 0 at x = 0;
min and max share the derivative half and half at a tie; sign' = 0. The derivative of a square
root is that of x / max(sqrt(x), 2^-100) / 2: zero at rest for laws such as |v| v, never 0 / 0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from eomgen.algebra.cost import operations
from eomgen.algebra.derive import HALF, RULES, Rules, direction, gradient
from eomgen.algebra.elementary import BUILD, maximum
from eomgen.algebra.graph import Node
from eomgen.algebra.walk import below

Rows = list[list[Node]]
LEAST_ROOT = Fraction(1, 2**100)  # below every root of a normal number in single precision


def jacobian(results: Sequence[Node], variables: Sequence[Node]) -> Rows:
    """The partial derivatives of all results, a row for each, by all variables (leaves)."""
    rules = _guarded(results)
    forward = _forward(results, variables, rules)
    reverse = [gradient(node, variables, rules) for node in results]
    return min(
        (forward, reverse), key=lambda rows: operations(entry for row in rows for entry in row)
    )


def _forward(results: Sequence[Node], variables: Sequence[Node], rules: Rules) -> Rows:
    rows: Rows = [[] for _ in results]
    for variable in variables:
        along = direction(variable.graph, {variable: variable.graph.one}, rules)
        for row, node in zip(rows, results, strict=True):
            row.append(along(node))
    return rows


def _guarded(results: Sequence[Node]) -> Rules:
    """The rules with roots that may vanish; a root that the results divide by may not."""
    divisors = {node.operands[1] for node in below(results) if node.operator == "divide"}

    def root(y: Node, a: Node, d: Node) -> Node:
        return HALF * (d / (y if y in divisors else maximum(y, y.graph.number(LEAST_ROOT))))

    return {**RULES, "sqrt": (root,)}


def substituted(nodes: Sequence[Node], values: Mapping[Node, Node]) -> list[Node]:
    """The nodes with leaves replaced by values; what depends on none of these stays as it is."""
    moving = 0
    for leaf in values:
        moving |= leaf.leaves
    known = dict(values)
    for node in below(nodes, stop=lambda a: not a.leaves & moving):
        if not node.leaves & moving:
            known[node] = node
        elif node not in known:
            known[node] = BUILD[node.operator](*(known[a] for a in node.operands))
    return [known[node] for node in nodes]
