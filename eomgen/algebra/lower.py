"""SymPy formulas as graph nodes, and the graph behind the interface of `algebra.scalar`."""

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import reduce
from typing import Any

import sympy as sp

from eomgen.algebra.derive import direction
from eomgen.algebra.elementary import BUILD, exp
from eomgen.algebra.graph import Graph, Node, add, power

FUNCTIONS: dict[Any, str] = {
    sp.sin: "sin", sp.cos: "cos", sp.tan: "tan", sp.asin: "asin", sp.acos: "acos",
    sp.atan: "atan", sp.atan2: "atan2", sp.sinh: "sinh", sp.cosh: "cosh", sp.tanh: "tanh",
    sp.exp: "exp", sp.log: "log", sp.Abs: "abs", sp.sign: "sign", sp.Min: "min", sp.Max: "max",
}  # fmt: skip


class GraphAlgebra:
    """The algebra of nodes: `bindings` say what each SymPy symbol stands for."""

    def __init__(self, graph: Graph, bindings: Mapping[sp.Symbol, Node]) -> None:
        self.graph = graph
        self.bindings: dict[sp.Symbol, Node] = dict(bindings)
        self._lowered: dict[sp.Expr, Node] = {}
        self._directions: dict[tuple[tuple[int, int], ...], Callable[[Node], Node]] = {}

    def number(self, value: int | Fraction) -> Node:
        """An exact constant."""
        return self.graph.number(value)

    def of(self, expression: sp.Expr) -> Node:
        """The node of a SymPy formula; a symbol without a binding is a KeyError."""
        node = self._lowered.get(expression)
        if node is None:
            node = self._lowered[expression] = self._lower(expression)
        return node

    def along(self, value: Node, direction: Mapping[sp.Symbol, Node]) -> Node:
        """The sum of d value / d symbol * direction[symbol]; symbols not bound are in no value."""
        return self.direction(direction)(value)

    def apply(self, name: str, *operands: Node) -> Node:
        """An operator of `program.OPERATORS` on its operands."""
        return self.graph.pi() if name == "pi" else BUILD[name](*operands)

    def extended(self, bindings: Mapping[sp.Symbol, Node]) -> "GraphAlgebra":
        """The same graph, with more symbols bound."""
        return GraphAlgebra(self.graph, {**self.bindings, **bindings})

    def is_zero(self, value: Node) -> bool:
        """Whether the node is the number 0; another form of zero is not seen."""
        return value is self.graph.zero

    def direction(self, rates: Mapping[sp.Symbol, Node]) -> Callable[[Node], Node]:
        """The derivative along `rates`; equal directions share their memory."""
        seeds = {self.bindings[s]: rate for s, rate in rates.items() if s in self.bindings}
        key = tuple((node.id, rate.id) for node, rate in seeds.items())
        if key not in self._directions:
            self._directions[key] = direction(self.graph, seeds)
        return self._directions[key]

    def _lower(self, expression: sp.Expr) -> Node:
        if expression.is_Symbol:
            node = self.bindings.get(expression)
            if node is None:
                raise KeyError(f"no node is bound to the symbol {expression.name}")
            return node
        if expression.is_Rational:
            return self.graph.number(Fraction(int(expression.p), int(expression.q)))
        operation = FUNCTIONS.get(expression.func)
        if operation is not None:
            return _chain(operation, [self.of(a) for a in expression.args])
        return LOWERINGS[expression.func](self, expression)

    def _sum(self, expression: sp.Expr) -> Node:
        return reduce(add, [self.of(term) for term in expression.args])

    def _product(self, expression: sp.Expr) -> Node:
        """Factors with a negative numeric exponent go to one denominator; the number comes last."""
        number, factors = expression.as_coeff_mul()
        above, below = self.graph.one, self.graph.one
        for factor in factors:
            exponent = factor.exp if factor.is_Pow else sp.S.One
            if exponent.is_Rational and exponent < 0:
                below = below * self.of(sp.Pow(factor.base, -exponent))
            else:
                above = above * self.of(factor)
        return self.of(number) * (above / below)

    def _power(self, expression: sp.Expr) -> Node:
        return power(self.of(expression.base), self.of(expression.exp))


def _chain(operation: str, operands: list[Node]) -> Node:
    """A function of its operands; `min` and `max` of many as a chain of two each."""
    build = BUILD[operation]
    return reduce(build, operands) if operation in ("min", "max") else build(*operands)


LOWERINGS: dict[Any, Callable[[GraphAlgebra, sp.Expr], Node]] = {
    sp.Add: GraphAlgebra._sum,
    sp.Mul: GraphAlgebra._product,
    sp.Pow: GraphAlgebra._power,
    type(sp.pi): lambda algebra, pi: algebra.graph.pi(),
    type(sp.E): lambda algebra, e: exp(algebra.graph.one),
}
