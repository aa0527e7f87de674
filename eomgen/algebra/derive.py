"""Derivatives of graph nodes: forward along a direction, reverse to a gradient, from one table.

`RULES[operator][i](y, *operands, d)` is (dy / d operand i) * d: forward, d is the operand's rate;
in reverse, d is the adjoint of y.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from eomgen.algebra.elementary import cos, cosh, log, sign, sin, sinh
from eomgen.algebra.graph import Graph, Node, sqrt
from eomgen.algebra.walk import below

HALF = Fraction(1, 2)

Rules = Mapping[str, tuple[Callable[..., Node], ...]]

RULES: Rules = {
    "add": (lambda y, a, b, d: d, lambda y, a, b, d: d),
    "subtract": (lambda y, a, b, d: d, lambda y, a, b, d: -d),
    "multiply": (lambda y, a, b, d: d * b, lambda y, a, b, d: a * d),
    "divide": (lambda y, a, b, d: d / b, lambda y, a, b, d: -(y * d / b)),
    "negate": (lambda y, a, d: -d,),
    "power": (lambda y, a, b, d: b * a ** (b - 1) * d, lambda y, a, b, d: y * log(a) * d),
    "sin": (lambda y, a, d: cos(a) * d,),
    "cos": (lambda y, a, d: -(sin(a) * d),),
    "tan": (lambda y, a, d: (1 + y * y) * d,),
    "asin": (lambda y, a, d: d / sqrt(1 - a * a),),
    "acos": (lambda y, a, d: -(d / sqrt(1 - a * a)),),
    "atan": (lambda y, a, d: d / (1 + a * a),),
    "atan2": (
        lambda y, a, b, d: b * d / (a * a + b * b),
        lambda y, a, b, d: -(a * d / (a * a + b * b)),
    ),
    "sinh": (lambda y, a, d: cosh(a) * d,),
    "cosh": (lambda y, a, d: sinh(a) * d,),
    "tanh": (lambda y, a, d: (1 - y * y) * d,),
    "sqrt": (lambda y, a, d: HALF * (d / y),),
    "exp": (lambda y, a, d: y * d,),
    "log": (lambda y, a, d: d / a,),
    "abs": (lambda y, a, d: sign(a) * d,),
    "sign": (lambda y, a, d: y.graph.zero,),
    "min": (
        lambda y, a, b, d: HALF * (1 - sign(a - b)) * d,
        lambda y, a, b, d: HALF * (1 + sign(a - b)) * d,
    ),
    "max": (
        lambda y, a, b, d: HALF * (1 + sign(a - b)) * d,
        lambda y, a, b, d: HALF * (1 - sign(a - b)) * d,
    ),
}


def direction(
    graph: Graph, seeds: Mapping[Node, Node], rules: Rules = RULES
) -> Callable[[Node], Node]:
    """The directional derivative as a function of the node: seeds give the rates of some nodes.

    All calls share one memory. A seed need not be a leaf: below it nothing is entered, so a
    formula that stands for a prescribed motion moves with the rate given for it.
    """
    rates = dict(seeds)
    moving = 0
    for node, rate in seeds.items():
        if node.operator == "number" and rate is not graph.zero:
            raise ValueError(f"the number {node.datum} cannot move")
        moving |= node.leaves if rate is not graph.zero else 0

    def along(node: Node) -> Node:
        stack = [node]
        while stack:
            top = stack[-1]
            if top in rates:
                stack.pop()
            elif not top.leaves & moving:
                rates[top] = graph.zero
            elif waiting := [a for a in top.operands if a not in rates]:
                stack.extend(waiting)
            else:
                rates[top] = _rate(top, rates, rules)
        return rates[node]

    return along


def _rate(node: Node, rates: Mapping[Node, Node], rules: Rules) -> Node:
    """The rate of a node from the rates of its operands: dy = sum (dy/da) da."""
    total = zero = node.graph.zero
    for index, operand in enumerate(node.operands):
        if rates[operand] is not zero:
            total = total + rules[node.operator][index](node, *node.operands, rates[operand])
    return total


def along(node: Node, seeds: Mapping[Node, Node]) -> Node:
    """The directional derivative of one node."""
    return direction(node.graph, seeds)(node)


def gradient(node: Node, variables: Sequence[Node], rules: Rules = RULES) -> list[Node]:
    """The partial derivatives of one node by all variables, in one reverse sweep."""
    return pullback([(node, node.graph.one)], variables, rules)


def pullback(
    weighted: Sequence[tuple[Node, Node]], variables: Sequence[Node], rules: Rules = RULES
) -> list[Node]:
    """The sum of weight * d value / d variable for every variable, in one reverse sweep.

    With (velocity, force) pairs and the speeds as variables these are the generalized forces.
    """
    if not weighted:
        return [variable.graph.zero for variable in variables]
    wanted = 0
    for variable in variables:
        wanted |= variable.leaves
    ends, zero = set(variables), weighted[0][0].graph.zero
    adjoints: dict[Node, Node] = {}
    for value, weight in weighted:
        adjoints[value] = adjoints.get(value, zero) + weight
    values = [value for value, _ in weighted]
    for top in reversed(below(values, stop=lambda a: a in ends or not a.leaves & wanted)):
        adjoint = adjoints.get(top, zero)
        if top in ends or adjoint is zero:
            continue
        for index, operand in enumerate(top.operands):
            if operand.leaves & wanted:
                share = rules[top.operator][index](top, *top.operands, adjoint)
                adjoints[operand] = adjoints.get(operand, zero) + share
    return [adjoints.get(variable, zero) for variable in variables]
