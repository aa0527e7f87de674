"""A formula as it is displayed: a small frozen tree, arranged already, for printers to spell."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Number:
    """An exact rational number."""

    value: Fraction


@dataclass(frozen=True)
class Symbol:
    """A name of the spec, a rate `s'`, an acceleration `s''`, a virtual displacement `delta s`."""

    name: str


@dataclass(frozen=True)
class Function:
    """A function of the language on displayed arguments."""

    name: str
    arguments: tuple[Tree, ...]


@dataclass(frozen=True)
class Power:
    """base^exponent with an exponent of at least 2."""

    base: Tree
    exponent: int


@dataclass(frozen=True)
class Product:
    """coefficient * factors / divisors, the factors from left to right."""

    coefficient: Fraction
    factors: tuple[Tree, ...]
    divisors: tuple[Tree, ...] = ()


@dataclass(frozen=True)
class Sum:
    """Two terms or more from left to right; a term's sign is that of its coefficient."""

    terms: tuple[Tree, ...]


Tree = Number | Symbol | Function | Power | Product | Sum

ZERO = Number(Fraction(0))
ONE = Number(Fraction(1))


def product(
    coefficient: Fraction, factors: tuple[Tree, ...], divisors: tuple[Tree, ...] = ()
) -> Tree:
    """The product in its shortest shape: a bare number or a bare factor where it is one."""
    if not factors and not divisors:
        return Number(coefficient)
    if coefficient == 1 and len(factors) == 1 and not divisors:
        return factors[0]
    return Product(coefficient, factors, divisors)


def power(base: Tree, exponent: int) -> Tree:
    """base^exponent, the base itself for the exponent 1."""
    return base if exponent == 1 else Power(base, exponent)


def total(terms: tuple[Tree, ...]) -> Tree:
    """The sum in its shortest shape: zero, one term, or a sum."""
    if len(terms) > 1:
        return Sum(terms)
    return terms[0] if terms else ZERO


def terms_of(tree: Tree) -> tuple[Tree, ...]:
    """The terms of a sum, else the tree itself; none of zero."""
    if isinstance(tree, Sum):
        return tree.terms
    return () if tree == ZERO else (tree,)


def split_sign(tree: Tree) -> tuple[bool, Tree]:
    """(negative, the tree without its sign)."""
    if isinstance(tree, Number):
        return tree.value < 0, Number(abs(tree.value))
    if isinstance(tree, Product) and tree.coefficient < 0:
        return True, product(-tree.coefficient, tree.factors, tree.divisors)
    return False, tree


def negated(tree: Tree) -> Tree:
    """The tree with the other sign."""
    match tree:
        case Number(value):
            return Number(-value)
        case Product(coefficient, factors, divisors):
            return product(-coefficient, factors, divisors)
        case Sum(terms):
            return Sum(tuple(negated(t) for t in terms))
    return Product(Fraction(-1), (tree,))


def children(tree: Tree) -> tuple[Tree, ...]:
    """What a tree is made of."""
    match tree:
        case Function(_, arguments):
            return arguments
        case Power(base, _):
            return (base,)
        case Product(_, factors, divisors):
            return factors + divisors
        case Sum(terms):
            return terms
    return ()


def length(tree: Tree) -> int:
    """How many symbols and functions a reader sees: the measure of what is shorter."""
    here = 1 if isinstance(tree, Symbol | Function) else 0
    return here + sum(length(child) for child in children(tree))


def size(tree: Tree) -> int:
    """How many terms there are, those of sums inside products counted one by one."""
    if isinstance(tree, Sum):
        return sum(size(term) for term in tree.terms)
    return max([1, *(size(child) for child in children(tree) if not isinstance(tree, Function))])


NUMERIC: dict[str, Callable[..., float]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin, "acos": math.acos,
    "atan": math.atan, "atan2": math.atan2, "sinh": math.sinh, "cosh": math.cosh,
    "tanh": math.tanh, "sqrt": math.sqrt, "exp": math.exp, "log": math.log, "abs": abs,
    "sign": lambda x: math.copysign(1.0, x) if x else 0.0, "min": min, "max": max,
    "power": pow,
}  # fmt: skip


def value(tree: Tree, values: Mapping[str, float]) -> float:
    """The number that the tree displays, at values of its symbols."""
    match tree:
        case Number(number):
            return float(number)
        case Symbol(name):
            return values[name]
        case Function(name, arguments):
            return NUMERIC[name](*(value(a, values) for a in arguments))
        case Power(base, exponent):
            return float(value(base, values) ** exponent)
        case Product(coefficient, factors, divisors):
            above = math.prod(value(f, values) for f in factors)
            return float(coefficient) * above / math.prod(value(d, values) for d in divisors)
        case Sum(terms):
            return math.fsum(value(t, values) for t in terms)
