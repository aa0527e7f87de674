"""The number kinds that nodes and programs are evaluated over, each one table of functions."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from importlib import import_module
from typing import Any

import mpmath
import sympy as sp

from eomgen.algebra import ldl
from eomgen.algebra.graph import Node
from eomgen.algebra.scalar import Algebra
from eomgen.algebra.walk import below
from eomgen.program import OPERATORS


@dataclass(frozen=True)
class Arithmetic:
    """A number kind: `number` converts Fractions and arguments, `functions` are the operators.

    tolerance: what a pivot must exceed, relative to its scale; holds: a comparison as one bool.
    """

    number: Callable[[Any], Any]
    functions: Mapping[str, Callable[..., Any]]
    tolerance: Any = 0
    holds: Callable[[Any], bool] = bool
    quiet: Callable[[], AbstractContextManager[Any]] = nullcontext  # no warnings inside

    def require_positive(self, place: int | str, pivot: Any, scale: Any) -> None:
        """Raise SingularMassMatrix unless pivot > tolerance * scale (everywhere in an array)."""
        if not self.holds(pivot > self.tolerance * abs(scale)):
            where = place if isinstance(place, str) else f"in row {place + 1}"
            raise ldl.SingularMassMatrix(where, pivot)


class NotExact(Exception):
    """The value of a function is not a rational number."""


PIVOT_EPSILONS = 100  # the tolerance of a pivot, in units of the last place of 1

_FIELD: dict[str, Callable[..., Any]] = {
    "add": operator.add, "subtract": operator.sub, "multiply": operator.mul,
    "divide": operator.truediv, "negate": operator.neg,
}  # fmt: skip
_ORDERED: dict[str, Callable[..., Any]] = {
    "abs": abs, "sign": lambda x: (x > 0) - (x < 0), "min": min, "max": max,
}  # fmt: skip
_TRANSCENDENTAL = (
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
    "sqrt", "exp", "log",
)  # fmt: skip


FLOAT = Arithmetic(
    float,
    {
        **_FIELD,
        **_ORDERED,
        **{name: getattr(math, name) for name in _TRANSCENDENTAL},
        "sign": lambda x: float((x > 0) - (x < 0)),
        "power": math.pow,
        "pi": lambda: math.pi,
    },
    PIVOT_EPSILONS * 2.0**-52,
)


def _numpy(name: str) -> Callable[..., Any]:
    """A function of NumPy, which is imported when it is first called."""
    return lambda *operands: getattr(import_module("numpy"), name)(*operands)


def _array(value: Any) -> Any:
    """A float or an array of floats."""
    return import_module("numpy").asarray(
        float(value) if isinstance(value, Fraction) else value, float
    )


_NUMPY_NAMES = {
    "asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2", "min": "minimum",
    "max": "maximum", "negate": "negative",
}  # fmt: skip
NUMPY = Arithmetic(
    _array,
    {
        **{name: _numpy(_NUMPY_NAMES.get(name, name)) for name in OPERATORS if name != "pi"},
        "pi": lambda: math.pi,
    },
    PIVOT_EPSILONS * 2.0**-52,
    lambda condition: bool(_numpy("all")(condition)),
    lambda: import_module("numpy").errstate(all="ignore"),
)


def mpmath_arithmetic(digits: int) -> Arithmetic:
    """Real numbers of so many decimal digits, in a context of their own."""
    context = mpmath.MPContext()
    context.dps = digits

    def number(value: Any) -> Any:
        if isinstance(value, Fraction):
            return context.mpf(value.numerator) / value.denominator
        return context.convert(value)

    def real(name: str) -> Callable[..., Any]:
        """The function of mpmath, a ValueError where it is not real and finite, as in `math`."""

        def call(*operands: Any) -> Any:
            value = getattr(context, name)(*operands)
            if not isinstance(value, context.mpf) or not context.isfinite(value):
                raise ValueError(f"{name} is not defined here")
            return value

        return call

    functions = {name: real(name) for name in (*_TRANSCENDENTAL, "power")}
    functions["pi"] = lambda: +context.pi
    tolerance = PIVOT_EPSILONS * context.eps
    return Arithmetic(number, {**_FIELD, **_ORDERED, **functions}, tolerance)


def _exact_root(value: Fraction) -> Fraction:
    root = Fraction(math.isqrt(value.numerator), math.isqrt(value.denominator))
    if root * root != value:
        raise NotExact(f"sqrt({value}) is not rational")
    return root


def _exact_power(base: Fraction, exponent: Fraction) -> Fraction:
    if exponent.denominator != 1:
        raise NotExact(f"{base} ** {exponent} is not computed exactly")
    return base ** int(exponent)


def _never(name: str) -> Callable[..., Any]:
    def call(*operands: Any) -> Any:
        raise NotExact(f"{name} has no exact value")

    return call


EXACT = Arithmetic(
    Fraction,
    {
        **{name: _never(name) for name in OPERATORS},
        **_FIELD,
        **_ORDERED,
        "sign": lambda x: Fraction((x > 0) - (x < 0)),
        "sqrt": _exact_root,
        "power": _exact_power,
    },
)


def over(algebra: Algebra[Any]) -> Arithmetic:
    """Any algebra as an arithmetic: a graph can be evaluated over the closed form."""
    functions: dict[str, Callable[..., Any]] = {
        **{name: partial(algebra.apply, name) for name in OPERATORS},
        **_FIELD,
        "pi": lambda: algebra.of(sp.pi),
    }
    return Arithmetic(algebra.number, functions)


def evaluate(
    nodes: Iterable[Node], values: Mapping[Node, Any], arithmetic: Arithmetic
) -> list[Any]:
    """The values of nodes, given those of the leaves, or of any nodes: below these none is read."""
    wanted = list(nodes)
    known: dict[Node, Any] = dict(values)
    for node in below(wanted, stop=lambda a: a in values):
        if node not in known:
            known[node] = _value(node, known, arithmetic)
    return [known[node] for node in wanted]


def _value(node: Node, known: Mapping[Node, Any], arithmetic: Arithmetic) -> Any:
    """The value of one node from those of its operands."""
    if node.operator == "number":
        return arithmetic.number(node.datum)
    operands = [known[a] for a in node.operands]
    if node.operator == "solved":
        return operands[0][node.datum]
    if node.operator == "system":
        return solve_loop(operands, node.datum, arithmetic)
    if node.operator in ("read", "symbol"):
        raise KeyError(f"no value is given for {node.datum}")
    return arithmetic.functions[node.operator](*operands)


def solve_loop(entries: list[Any], size: int, arithmetic: Arithmetic) -> list[Any]:
    """The solution of the system of a `program.Solve`: lower triangle row by row, then columns."""
    starts = [i * (i + 1) // 2 for i in range(size + 1)]
    matrix = [entries[starts[i] : starts[i + 1]] for i in range(size)]
    factors = ldl.factor(matrix, arithmetic.require_positive)
    columns = (entries[at : at + size] for at in range(starts[size], len(entries), size))
    return [value for column in columns for value in ldl.substitute(factors, column)]
