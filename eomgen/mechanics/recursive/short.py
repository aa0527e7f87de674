"""Short forms of small values: common factors taken out, constants found by the normal form."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce

import sympy as sp

from eomgen.algebra import closed, normal
from eomgen.algebra.arithmetic import evaluate, over
from eomgen.algebra.closed import ClosedForm
from eomgen.algebra.graph import Exact, Node, multiply
from eomgen.algebra.scalar import Algebra
from eomgen.algebra.walk import below
from eomgen.mechanics.vectors import Vector


@dataclass
class Short:
    """Shortens values of a graph; `constant` is the bit set of its parameters."""

    algebra: Algebra[Node]
    constant: int
    known: dict[Node, Node] = field(default_factory=dict)

    @property
    def zero(self) -> Node:
        """The number 0."""
        return self.algebra.number(0)

    def is_constant(self, value: Node) -> bool:
        """Whether a value depends on parameters only."""
        return not value.leaves & ~self.constant

    def of(self, value: Node) -> Node:
        """The value as its normal form has it, where that is a constant or one term; else itself.

        No sine or cosine is made that the value does not have.
        """
        if self.is_constant(value):
            return value
        if value not in self.known:
            self.known[value] = self._found(value)
        return self.known[value]

    def _found(self, value: Node) -> Node:
        nodes = below([value])
        leaves = {sp.Symbol(f"x{a.id}"): a for a in nodes if a.leaves and not a.operands}
        ring = ClosedForm()
        try:
            given = {leaf: ring.of(symbol) for symbol, leaf in leaves.items()}
            (form,) = evaluate([value], given, over(ring))
        except normal.TooLarge:
            return value  # as it stands it is right too
        back: Node = closed.Evaluation(leaves, self.algebra.number, self.algebra.apply).of(form)
        if self.is_constant(back):
            return back
        waves = {a for a in below([back]) if a.operator in ("sin", "cos")}
        return back if len(form.terms) == 1 and waves <= set(nodes) else value


def common_factor(vector: Sequence[Node]) -> tuple[Node, Vector[Node]]:
    """(size, direction) with vector = size * direction, from the products that it is written as.

    The vector must not be zero.
    """
    zero = vector[0].graph.zero
    signs, split = [], []
    for entry in vector:
        negative = entry.operator == "negate"
        signs.append(negative)
        split.append(_factors(entry.operands[0] if negative else entry))
    present = [parts for entry, parts in zip(vector, split, strict=True) if entry is not zero]
    number = present[0][0] if len({abs(c) for c, _ in present}) == 1 else Fraction(1)
    shared = _shared([factors for _, factors in present])
    direction = []
    for entry, negative, (c, factors) in zip(vector, signs, split, strict=True):
        rest = zero if entry is zero else _product(zero, c / number, _without(factors, shared))
        direction.append(-rest if negative else rest)
    return _product(zero, number, shared), tuple(direction)


def _factors(value: Node) -> tuple[Fraction, list[Node]]:
    """A number and the other factors of a product."""
    coefficient, factors, stack = Fraction(1), [], [value]
    while stack:
        factor = stack.pop()
        if factor.operator == "multiply":
            stack.extend(reversed(factor.operands))
        elif factor.operator == "number":
            coefficient *= factor.datum
        else:
            factors.append(factor)
    return coefficient, factors


def _shared(products: Sequence[list[Node]]) -> list[Node]:
    shared = list(products[0])
    for factors in products[1:]:
        left = list(factors)
        kept = []
        for factor in shared:
            if factor in left:
                left.remove(factor)
                kept.append(factor)
        shared = kept
    return shared


def _without(factors: Iterable[Node], taken: Iterable[Node]) -> list[Node]:
    left = list(factors)
    for factor in taken:
        left.remove(factor)
    return left


def _product(zero: Node, number: Exact, factors: Iterable[Node]) -> Node:
    return zero.graph.number(number) * reduce(multiply, factors, zero.graph.one)
