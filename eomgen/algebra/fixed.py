"""The operators of the graph where parameter-only values behave as numbers do: they meet.

A product keeps one fixed factor, a sum one fixed term, a fixed divisor becomes a factor, and like
terms with fixed coefficients are added. The values are those of the plain operators but for
rounding; fewer operations are left to the values that move.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from eomgen.algebra import graph as plain
from eomgen.algebra.elementary import BUILD
from eomgen.algebra.graph import Node
from eomgen.algebra.lift import Build

Fixed = Callable[[Node], bool]


def builders(fixed: Fixed) -> Build:
    """The table of constructors, `fixed` telling which nodes are constant."""
    rules = _Rules(fixed)
    return {
        **BUILD,
        "add": rules.add,
        "subtract": rules.subtract,
        "multiply": rules.multiply,
        "divide": rules.divide,
    }


@dataclass(frozen=True)
class _Rules:
    """Sums, products and quotients of moving and fixed nodes."""

    fixed: Fixed

    def add(self, a: Node, b: Node) -> Node:
        """The sum a + b."""
        if b.operator == "negate":
            return self.subtract(a, b.operands[0])
        if a.operator == "negate":
            return self.subtract(b, a.operands[0])
        return self._sum(a, b, plain.add)

    def subtract(self, a: Node, b: Node) -> Node:
        """The difference a - b."""
        if b.operator == "negate":
            return self.add(a, b.operands[0])
        if a.operator == "negate":
            return plain.negate(self.add(a.operands[0], b))
        return self._sum(a, b, plain.subtract)

    def _sum(self, a: Node, b: Node, join: Callable[[Node, Node], Node]) -> Node:
        """a +- b: fixed terms meet, and so do the coefficients of one moving factor."""
        first, second = self.fixed(a), self.fixed(b)
        if first and second:
            return join(a, b)
        if second:
            positive, x, constant = self._shifted(a)
            return _shift(positive, x, join(constant, b))
        if first:
            positive, x, constant = self._shifted(b)
            return _shift(positive is (join is plain.add), x, join(a, constant))
        (c, x), (d, y) = self.term(a), self.term(b)
        return self.multiply(join(c, d), x) if x is y else join(a, b)

    def _shifted(self, a: Node) -> tuple[bool, Node, Node]:
        """The parts of a = +- x + c, c fixed: whether the sign is +, x and c."""
        if a.operator in ("add", "subtract"):
            x, y = a.operands
            if self.fixed(y):
                return True, x, y if a.operator == "add" else plain.negate(y)
            if self.fixed(x):
                return a.operator == "add", y, x
        return True, a, a.graph.zero

    def term(self, a: Node) -> tuple[Node, Node]:
        """The fixed factor of a moving product, and the rest."""
        if a.operator == "multiply":
            x, y = a.operands
            if self.fixed(x):
                return x, y
            if self.fixed(y):
                return y, x
        return a.graph.one, a

    def multiply(self, a: Node, b: Node) -> Node:
        """The product a b."""
        if a.operator == "negate":
            return plain.negate(self.multiply(a.operands[0], b))
        if b.operator == "negate":
            return plain.negate(self.multiply(a, b.operands[0]))
        if self.fixed(a) is self.fixed(b):
            return plain.multiply(a, b)
        return self._scale(a, b) if self.fixed(a) else self._scale(b, a)

    def _scale(self, c: Node, a: Node) -> Node:
        """The product c a, c fixed and a moving."""
        d, x = self.term(a)
        if x is not a:
            return plain.multiply(plain.multiply(c, d), x)
        if a.operator != "divide" or not self.fixed(a.operands[0]):
            return plain.multiply(c, a)
        if a.operands[0] is a.graph.one:
            return _times_reciprocal(c, a)
        return plain.divide(plain.multiply(c, a.operands[0]), a.operands[1])

    def divide(self, a: Node, b: Node) -> Node:
        """The quotient a / b; where b is fixed the product with its reciprocal."""
        if self.fixed(b) and not self.fixed(a):
            return self.multiply(a, plain.divide(b.graph.one, b))
        if self.fixed(a) and not self.fixed(b):
            d, y = self.term(b)
            return plain.divide(a if y is b else plain.divide(a, d), y)
        return plain.divide(a, b)


def _shift(positive: bool, x: Node, constant: Node) -> Node:
    """The sum +- x + constant."""
    return plain.add(x, constant) if positive else plain.subtract(constant, x)


def _times_reciprocal(c: Node, a: Node) -> Node:
    """The product c a of a reciprocal, which stays one: others share it."""
    if c.operator != "number" or c.datum in (0, 1):
        return plain.multiply(c, a)
    if c.datum < 0:
        return plain.negate(_times_reciprocal(plain.negate(c), a))
    return plain.binary("multiply", c, a)
