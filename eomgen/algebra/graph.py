"""The second algebra: hash-consed nodes, each distinct value built once and folded where it arises.

A node knows its operator (of `program.OPERATORS`, or one of `LEAVES`, or "system" and "solved" for
a linear system solved in a loop) and its operands, which always have smaller ids: ascending ids are
an order of evaluation. Nothing is ever expanded. Where folding has a choice the sign stands
outside a product, a number stands first in a product and last in a sum.
"""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from math import isqrt
from typing import Any

from eomgen.program import Read

LEAVES = ("number", "read", "symbol")
LARGEST_UNROLLED_EXPONENT = 64
Exact = int | Fraction


class Node:
    """A scalar of the graph: `+ - * / **` and unary minus mix with int, Fraction and each other."""

    __slots__ = ("datum", "graph", "id", "leaves", "operands", "operator")

    graph: Graph
    id: int
    operator: str
    operands: tuple[Node, ...]
    datum: Any  # number: Fraction; read: program.Read; symbol: its name; solved: its row
    leaves: int  # bit set of the leaves that the value depends on

    def __init__(
        self, graph: Graph, operator: str, operands: tuple[Node, ...], leaves: int, datum: Any
    ) -> None:
        self.graph, self.operator, self.operands = graph, operator, operands
        self.leaves, self.datum, self.id = leaves, datum, len(graph.nodes)
        graph.nodes.append(self)

    def __add__(self, other: Node | Exact) -> Node:
        return add(self, other if isinstance(other, Node) else self.graph.number(other))

    def __sub__(self, other: Node | Exact) -> Node:
        return subtract(self, other if isinstance(other, Node) else self.graph.number(other))

    def __mul__(self, other: Node | Exact) -> Node:
        return multiply(self, other if isinstance(other, Node) else self.graph.number(other))

    def __truediv__(self, other: Node | Exact) -> Node:
        return divide(self, other if isinstance(other, Node) else self.graph.number(other))

    def __pow__(self, other: Node | Exact) -> Node:
        return power(self, other if isinstance(other, Node) else self.graph.number(other))

    def __radd__(self, other: Exact) -> Node:
        return add(self.graph.number(other), self)

    def __rsub__(self, other: Exact) -> Node:
        return subtract(self.graph.number(other), self)

    def __rmul__(self, other: Exact) -> Node:
        return multiply(self.graph.number(other), self)

    def __rtruediv__(self, other: Exact) -> Node:
        return divide(self.graph.number(other), self)

    def __rpow__(self, other: Exact) -> Node:
        return power(self.graph.number(other), self)

    def __neg__(self) -> Node:
        return negate(self)

    def __repr__(self) -> str:
        return f"<{self.id}: {self.operator} {self.datum or [a.id for a in self.operands]}>"


class Graph:
    """All nodes in the order of their ids, and the tables that make equal values one node."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self._table: dict[tuple[Any, ...], Node] = {}
        self.pairs: defaultdict[str, dict[tuple[Node, Node], Node]] = defaultdict(dict)
        self._leaf_count = 0
        self.zero = self.number(0)
        self.one = self.number(1)

    def number(self, value: Exact) -> Node:
        """An exact constant."""
        if not isinstance(value, int | Fraction):
            raise TypeError(f"{value!r} is not an exact number")
        key = ("number", value.numerator, value.denominator)
        return self._table.get(key) or self._new(key, (), Fraction(value))

    def read(self, argument: str, index: int) -> Node:
        """A component of an argument of the program."""
        key = ("read", argument, index)
        return self._table.get(key) or self._new(key, (), Read(argument, index))

    def symbol(self, name: str) -> Node:
        """A free leaf, for derivations that are not compiled to a program."""
        key = ("symbol", name)
        return self._table.get(key) or self._new(key, (), name)

    def make(self, operator: str, operands: tuple[Node, ...], datum: Any = None) -> Node:
        """The node of an operator on operands of any number, without folding."""
        key = (operator, datum, *[a.id for a in operands])
        return self._table.get(key) or self._new(key, operands, datum)

    def pi(self) -> Node:
        """The constant pi."""
        return self.make("pi", ())

    def _new(self, key: tuple[Any, ...], operands: tuple[Node, ...], datum: Any) -> Node:
        leaves = 0
        for operand in operands:
            leaves |= operand.leaves
        if key[0] == "read" or key[0] == "symbol":
            leaves = 1 << self._leaf_count
            self._leaf_count += 1
        node = self._table[key] = Node(self, key[0], operands, leaves, datum)
        return node


def binary(operator: str, a: Node, b: Node) -> Node:
    """The node of a binary operator: one look-up."""
    operands = (a, b)
    table = a.graph.pairs[operator]
    node = table.get(operands)
    if node is None:
        node = table[operands] = Node(a.graph, operator, operands, a.leaves | b.leaves, None)
    return node


def unary(operator: str, a: Node) -> Node:
    """The node of a unary operator: one look-up."""
    key = (operator, a.id)
    return a.graph._table.get(key) or a.graph._new(key, (a,), None)


def add(a: Node, b: Node) -> Node:
    """The sum a + b."""
    if b.operator == "number":
        return a if b is a.graph.zero else _shift(a, b.datum)
    if a.operator == "number":
        return b if a is a.graph.zero else _shift(b, a.datum)
    if b.operator == "negate":
        return subtract(a, b.operands[0])
    if a.operator == "negate":
        return subtract(b, a.operands[0])
    if (total := _total(a, b)) is not None:
        return total
    return binary("add", a, b) if a.id < b.id else binary("add", b, a)


def _total(a: Node, b: Node) -> Node | None:
    """A sum that is simpler than its operands; None elsewhere."""
    # a + (b - a) = b
    if a.operator == "subtract" and a.operands[1] is b:
        return a.operands[0]
    if b.operator == "subtract" and b.operands[1] is a:
        return b.operands[0]
    if a is not b and a.operator != "multiply" and b.operator != "multiply":
        return None
    (c, x), (d, y) = term(a), term(b)
    if x is y:
        return _scale(c + d, x)
    square = _pythagoras(x, y) if c == d else None
    return None if square is None else _scale(c, square)


def _pythagoras(a: Node, b: Node) -> Node | None:
    """x^2 where a = (x sin y)^2 and b = (x cos y)^2 or the other way round; None elsewhere."""
    if a.operator != "multiply" or b.operator != "multiply":
        return None
    (first, again), (second, once_more) = a.operands, b.operands
    if first is not again or second is not once_more:
        return None
    for p in _factors(first):
        for q in _factors(second):
            angles = {p.operator, q.operator} == {"sin", "cos"} and p.operands == q.operands
            if angles and (rest := _without(first, p)) is _without(second, q):
                return multiply(rest, rest)
    return None


def _factors(a: Node) -> tuple[Node, ...]:
    return a.operands if a.operator == "multiply" else (a,)


def _without(product: Node, factor: Node) -> Node:
    """The other factor of a product of two, one for the factor itself."""
    if product is factor:
        return product.graph.one
    first, second = product.operands
    return second if first is factor else first


def subtract(a: Node, b: Node) -> Node:
    """The difference a - b."""
    if b.operator == "number":
        return a if b is a.graph.zero else _shift(a, -b.datum)
    if b.operator == "negate":
        return add(a, b.operands[0])
    if a is b:
        return a.graph.zero
    if a.operator == "number":
        return negate(b) if a is a.graph.zero else _shift(negate(b), a.datum)
    if a.operator == "negate":
        return negate(add(a.operands[0], b))
    if (rest := _difference(a, b)) is not None:
        return rest
    if a.operator == "multiply" or b.operator == "multiply":
        (c, x), (d, y) = term(a), term(b)
        if x is y:
            return _scale(c - d, x)
    return binary("subtract", a, b)


def _difference(a: Node, b: Node) -> Node | None:
    """(a + b) - b = a and its like: what is left where one operand holds the other."""
    if a.operator == "add" and b in a.operands:
        return a.operands[a.operands[0] is b]
    if b.operator == "add" and a in b.operands:
        return negate(b.operands[b.operands[0] is a])
    if a.operator == "subtract" and a.operands[0] is b:
        return negate(a.operands[1])
    if b.operator == "subtract" and b.operands[0] is a:
        return b.operands[1]
    return None


def term(a: Node) -> tuple[Exact, Node]:
    """The numeric coefficient of a product, and the rest."""
    if a.operator == "multiply" and a.operands[0].operator == "number":
        return a.operands[0].datum, a.operands[1]
    return 1, a


def _shift(a: Node, c: Fraction) -> Node:
    """The sum a + c for a number c."""
    number = a.graph.number
    if not c:
        return a
    if a.operator == "number":
        return number(a.datum + c)
    if a.operator == "negate":
        return binary("subtract", number(c), a.operands[0])
    if a.operator in ("add", "subtract"):
        first, second = a.operands
        if second.operator == "number":
            return _shift(first, c + (second.datum if a.operator == "add" else -second.datum))
        if first.operator == "number":
            return _shift(negate(second), first.datum + c)
    return binary("add", a, number(c)) if c > 0 else binary("subtract", a, number(-c))


def negate(a: Node) -> Node:
    """-a."""
    if a is a.graph.zero:
        return a
    if a.operator == "number":
        return a.graph.number(-a.datum)
    if a.operator == "negate":
        return a.operands[0]
    if a.operator == "subtract":
        return subtract(a.operands[1], a.operands[0])
    return unary("negate", a)


def multiply(a: Node, b: Node) -> Node:
    """A product; the sign goes outside, numeric coefficients meet."""
    if a.operator == "number":
        return a if a is a.graph.zero else _scale(a.datum, b)
    if b.operator == "number":
        return b if b is a.graph.zero else _scale(b.datum, a)
    if a.operator == "negate":
        return negate(multiply(a.operands[0], b))
    if b.operator == "negate":
        return negate(multiply(a, b.operands[0]))
    if a is b or a.operator == "divide" or b.operator == "divide":
        cancelled = _cancelled(a, b)
        if cancelled is not None:
            return cancelled
    if a.operator == "multiply" and b.operator == "multiply":
        (c, x), (d, y) = term(a), term(b)
        if x is not a and y is not b:
            return _scale(c * d, multiply(x, y))
    return binary("multiply", a, b) if a.id < b.id else binary("multiply", b, a)


def _cancelled(a: Node, b: Node) -> Node | None:
    """The product of two equal roots, or of a quotient and its denominator."""
    if a is b:
        return a.operands[0] if a.operator == "sqrt" else None
    for quotient, other in ((a, b), (b, a)):
        if quotient.operator == "divide" and quotient.operands[1] is other:
            return quotient.operands[0]
    return None


def _scale(c: Exact, a: Node) -> Node:
    """The product c a for a number c."""
    graph = a.graph
    if c == 0 or a is graph.zero:
        return graph.zero
    if c == 1:
        return a
    if a.operator == "number":
        return graph.number(c * a.datum)
    if a.operator == "negate":
        return _scale(-c, a.operands[0])
    if c < 0:
        return negate(_scale(-c, a))
    d, x = term(a)
    if x is not a:
        return _scale(c * d, x)
    if a.operator == "divide" and a.operands[0].operator == "number":
        return divide(_scale(c, a.operands[0]), a.operands[1])
    return binary("multiply", graph.number(c), a)


def divide(a: Node, b: Node) -> Node:
    """A quotient; the sign and the denominator's numeric coefficient go outside."""
    if b.operator == "number":
        return _scale(1 / b.datum, a)
    if a is a.graph.zero:
        return a
    if a is b:
        return a.graph.one
    if b.operator == "negate":
        return negate(divide(a, b.operands[0]))
    if a.operator == "negate":
        return negate(divide(a.operands[0], b))
    d, y = term(b)
    if y is not b:
        return _scale(1 / Fraction(d), divide(a, y))
    return binary("divide", a, b)


def power(a: Node, b: Node) -> Node:
    """The power a ** b; small integers and halves become products and square roots."""
    if b.operator != "number":
        return a.graph.one if a is a.graph.one else binary("power", a, b)
    exponent: Fraction = b.datum
    if exponent < 0 and exponent.denominator <= 2:
        return divide(a.graph.one, power(a, negate(b)))
    if exponent > LARGEST_UNROLLED_EXPONENT and a.operator != "number":
        return binary("power", a, b)
    if exponent.denominator == 1:
        return _integer_power(a, int(exponent))
    if exponent.denominator == 2:
        return multiply(_integer_power(a, int(exponent)), sqrt(a))
    return a if a in (a.graph.zero, a.graph.one) and exponent > 0 else binary("power", a, b)


def _integer_power(a: Node, exponent: int) -> Node:
    """The power a ** exponent by repeated squaring, exponent >= 0."""
    if a.operator == "number":
        return a.graph.number(a.datum**exponent)
    result = a.graph.one
    while exponent:
        if exponent & 1:
            result = multiply(result, a)
        exponent >>= 1
        a = multiply(a, a) if exponent else a
    return result


def exact_root(value: Fraction) -> Fraction | None:
    """The square root of a number, where it is rational."""
    if value < 0:
        return None
    root = Fraction(isqrt(value.numerator), isqrt(value.denominator))
    return root if root * root == value else None


def sqrt(a: Node) -> Node:
    """The square root."""
    root = exact_root(a.datum) if a.operator == "number" else None
    return unary("sqrt", a) if root is None else a.graph.number(root)
