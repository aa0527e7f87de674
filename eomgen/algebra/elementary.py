"""The functions of the graph algebra, folded at exact values, and the table of all constructors."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from eomgen.algebra.graph import (
    Exact,
    Node,
    add,
    binary,
    divide,
    multiply,
    negate,
    power,
    sqrt,
    subtract,
    term,
    unary,
)
from eomgen.program import OPERATORS

ODD = frozenset(("sin", "tan", "asin", "atan", "sinh", "tanh", "sign"))
EVEN = frozenset(("cos", "cosh", "abs"))
_AT_ZERO = dict.fromkeys(("sin", "tan", "asin", "atan", "sinh", "tanh"), 0) | dict.fromkeys(
    ("cos", "cosh", "exp"), 1
)
_AT_NUMBER: dict[str, Callable[[Fraction], Exact | None]] = {
    **{name: lambda x, y=y: None if x else y for name, y in _AT_ZERO.items()},  # type: ignore[misc]
    "abs": abs,
    "sign": lambda x: (x > 0) - (x < 0),
    "log": lambda x: 0 if x == 1 else None,
    "acos": lambda x: 0 if x == 1 else None,
}
# sin(k pi / 6), where it is rational
_SINE_OF_SIXTHS = {0: 0, 1: 1, 3: 2, 5: 1, 6: 0, 7: -1, 9: -2, 11: -1}  # halves


def _turn(operator: str, a: Node) -> Exact | None:
    """The sine or cosine of a rational multiple of pi, where it is rational."""
    factor, rest = term(a)
    sixths = 6 * Fraction(factor) + (3 if operator == "cos" else 0)
    if rest.operator != "pi" or sixths % 12 not in _SINE_OF_SIXTHS:
        return None
    return Fraction(_SINE_OF_SIXTHS[int(sixths % 12)], 2)


def function(operator: str) -> Callable[[Node], Node]:
    """The constructor of a function of one operand."""

    def build(a: Node) -> Node:
        if a.operator == "number":
            value = _AT_NUMBER[operator](a.datum)
            if value is not None:
                return a.graph.number(value)
        if a.operator == "negate" and operator in ODD:
            return negate(build(a.operands[0]))
        if a.operator == "negate" and operator in EVEN:
            return build(a.operands[0])
        if operator == "sin" or operator == "cos":
            value = _turn(operator, a)
            if value is not None:
                return a.graph.number(value)
        return unary(operator, a)

    build.__doc__ = f"{operator}(a)."
    return build


def _extreme(operator: str, pick: Callable[[Fraction, Fraction], Fraction]) -> Callable[..., Node]:
    """The constructor of `min` or `max`."""

    def build(a: Node, b: Node) -> Node:
        if a is b:
            return a
        if a.operator == b.operator == "number":
            return a.graph.number(pick(a.datum, b.datum))
        return binary(operator, a, b) if a.id < b.id else binary(operator, b, a)

    build.__doc__ = f"{operator}(a, b)."
    return build


def atan2(y: Node, x: Node) -> Node:
    """The angle of the point (x, y)."""
    if y is y.graph.zero and x.operator == "number" and x.datum > 0:
        return y
    return binary("atan2", y, x)


sin, cos, tan = function("sin"), function("cos"), function("tan")
asin, acos, atan = function("asin"), function("acos"), function("atan")
sinh, cosh, tanh = function("sinh"), function("cosh"), function("tanh")
exp, log = function("exp"), function("log")
absolute, sign = function("abs"), function("sign")
minimum, maximum = _extreme("min", min), _extreme("max", max)

BUILD: dict[str, Callable[..., Node]] = {
    "add": add, "subtract": subtract, "multiply": multiply, "divide": divide, "negate": negate,
    "power": power, "sin": sin, "cos": cos, "tan": tan, "asin": asin, "acos": acos, "atan": atan,
    "atan2": atan2, "sinh": sinh, "cosh": cosh, "tanh": tanh, "sqrt": sqrt, "exp": exp,
    "log": log, "abs": absolute, "sign": sign, "min": minimum, "max": maximum,
}  # fmt: skip
assert {*BUILD, "pi"} == {*OPERATORS}
