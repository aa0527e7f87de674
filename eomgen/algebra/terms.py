"""Products as factors with exponents, sums as terms: how rewriting rules look at graph nodes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from eomgen.algebra.graph import Exact, Node, add, divide, multiply, negate, subtract

Powers = Mapping[Node, int]  # factor -> exponent, none of them zero
WAVES = frozenset(("sin", "cos"))
MOST_TERMS = 8  # of a sum that is looked into


@dataclass(frozen=True)
class Product:
    """A number times powers of nodes that are no products, in order of appearance."""

    number: Exact
    powers: Powers

    @cached_property
    def still(self) -> frozenset[tuple[Node, int]]:
        """The factors that are no sines and cosines."""
        return frozenset(p for p in self.powers.items() if p[0].operator not in WAVES)

    @cached_property
    def has_root(self) -> bool:
        """Whether a factor is a square root."""
        return any(a.operator == "sqrt" for a in self.powers)

    def is_same(self, other: Product) -> bool:
        """Whether both are the same product, in whatever order."""
        return self.number == other.number and self.powers == other.powers

    def square(self) -> Product:
        """The product times itself."""
        return Product(self.number**2, {a: 2 * e for a, e in self.powers.items()})


class Products:
    """The products that nodes are, each found once."""

    def __init__(self) -> None:
        self.known: dict[Node, Product] = {}

    def of(self, node: Node) -> Product:
        """The factors of a node."""
        found = self.known.get(node)
        if found is None:
            found = self.known[node] = self._find(node)
        return found

    def _find(self, node: Node) -> Product:
        operator = node.operator
        if operator == "multiply" or operator == "divide":
            return self._joined(node)
        if operator == "number":
            return Product(node.datum, {})
        if operator == "negate":
            inner = self.of(node.operands[0])
            return Product(-inner.number, inner.powers)
        return Product(1, {node: 1})

    def _joined(self, node: Node) -> Product:
        """A product or a quotient of two."""
        first, second = map(self.of, node.operands)
        powers = dict(first.powers)
        sign = 1 if node.operator == "multiply" else -1
        for factor, exponent in second.powers.items():
            found = powers.get(factor, 0) + sign * exponent
            if found:
                powers[factor] = found
            else:
                del powers[factor]
        number = first.number
        if second.number != 1:
            number = number * second.number if sign == 1 else Fraction(number) / second.number
        return Product(number, powers)


def built(graph_of: Node, product: Product) -> Node:
    """The node of a product; graph_of: any node of its graph."""
    one = graph_of.graph.one
    above, below = one, one
    for factor, exponent in product.powers.items():
        for _ in range(abs(exponent)):
            if exponent > 0:
                above = multiply(above, factor)
            else:
                below = multiply(below, factor)
    node = above if below is one else multiply(above, divide(one, below))
    return multiply(graph_of.graph.number(product.number), node)


def summands(node: Node) -> list[Node]:
    """The terms of a sum, with their signs; a node that is no sum, or a long one, is one term."""
    found = _summands(node, MOST_TERMS)
    return found if len(found) <= MOST_TERMS else [node]


def _summands(node: Node, most: int) -> list[Node]:
    if node.operator not in ("add", "subtract") or most <= 0:
        return [node]
    first = _summands(node.operands[0], most - 1)
    second = _summands(node.operands[1], most - len(first))
    return first + ([negate(a) for a in second] if node.operator == "subtract" else second)


def total(graph_of: Node, terms: Iterable[Node]) -> Node:
    """The sum of terms."""
    result = graph_of.graph.zero
    for term in terms:
        result = (
            subtract(result, term.operands[0]) if term.operator == "negate" else add(result, term)
        )
    return result
