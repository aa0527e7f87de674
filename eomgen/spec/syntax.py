"""The syntax tree of a formula: small records that know where in the file they stand."""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from eomgen.dimension import Dimension


@dataclass(frozen=True)
class Span:
    """A piece of a formula: its position in the file and its text."""

    line: int
    column: int
    text: str


@dataclass(frozen=True)
class Number:
    """An exact number as written."""

    value: Fraction
    span: Span


@dataclass(frozen=True)
class Quantity:
    """A number with its unit, in SI; stands alone, never inside a formula."""

    value: sp.Expr
    dimension: Dimension
    unit: str
    span: Span


@dataclass(frozen=True)
class Name:
    """A name; `order` 1 is its rate, 2 its acceleration."""

    name: str
    order: int
    span: Span


@dataclass(frozen=True)
class Vector:
    """[a, b, ...]."""

    items: tuple["Tree", ...]
    span: Span


@dataclass(frozen=True)
class Sum:
    """Terms with their signs, +1 or -1."""

    terms: tuple[tuple[int, "Tree"], ...]
    span: Span


@dataclass(frozen=True)
class Product:
    """Factors, +1 for one above and -1 for one below the fraction bar."""

    factors: tuple[tuple[int, "Tree"], ...]
    span: Span


@dataclass(frozen=True)
class Power:
    """base ^ exponent."""

    base: "Tree"
    exponent: "Tree"
    span: Span


@dataclass(frozen=True)
class Call:
    """A function of the language with its arguments."""

    function: str
    arguments: tuple["Tree", ...]
    span: Span


Tree = Number | Quantity | Name | Vector | Sum | Product | Power | Call


@dataclass(frozen=True)
class Relation:
    """left = right, left >= right or left <= right."""

    left: Tree
    sign: str
    right: Tree
    span: Span


def children(tree: Tree) -> tuple[Tree, ...]:
    """The operands, left to right."""
    match tree:
        case Vector(items, _) | Call(_, items, _):
            return items
        case Sum(parts, _) | Product(parts, _):
            return tuple(part for _, part in parts)
        case Power(base, exponent, _):
            return (base, exponent)
    return ()


def names(tree: Tree) -> Iterator[Name]:
    """Every name of the tree, left to right."""
    if isinstance(tree, Name):
        yield tree
    for child in children(tree):
        yield from names(child)
