"""Many states at once in fifty digits: arrays of `decimal.Decimal`, whose arithmetic runs in C.

Several times faster than mpmath, which has the functions that `decimal` lacks. Where a value is
not real or not finite it is NaN or infinite, and nothing is raised.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from decimal import MAX_EMAX, MIN_EMIN, Context, Decimal, localcontext
from fractions import Fraction
from functools import cache
from typing import Any

import mpmath
import numpy as np

from eomgen.algebra.arithmetic import Arithmetic
from eomgen.program import OPERATORS

NAN = Decimal("nan")
GUARD = 10  # digits that the functions of mpmath have beyond ours
_INFIX: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": lambda a, b: a / b,
    "negate": lambda a: -a,
}
_OWN: dict[str, Callable[..., Decimal]] = {
    "sqrt": Decimal.sqrt,
    "exp": Decimal.exp,
    "log": Decimal.ln,
    "abs": abs,
    "sign": lambda x: x if x.is_nan() else Decimal((x > 0) - (x < 0)),
    "min": lambda a, b: b if b < a else a,
    "max": lambda a, b: b if b > a else a,
    "power": lambda a, b: a**b,
}


def arithmetic(digits: int) -> Arithmetic:
    """Arrays of decimals of so many digits; to be used inside its `quiet`."""
    context = Context(prec=digits, Emin=MIN_EMIN, Emax=MAX_EMAX, traps=[])
    of_mpmath = _Functions(digits + GUARD)
    functions: dict[str, Callable[..., Any]] = {**_INFIX, "pi": of_mpmath.pi}
    for name, count in OPERATORS.items():
        if name not in functions:
            scalar = _OWN.get(name) or of_mpmath.function(name)
            functions[name] = _elementwise(scalar, count)

    def quiet() -> AbstractContextManager[Any]:
        return localcontext(context)

    return Arithmetic(_number, functions, holds=lambda condition: True, quiet=quiet)


def _number(value: Any) -> Any:
    if isinstance(value, Fraction):
        return Decimal(value.numerator) / Decimal(value.denominator)
    return Decimal(value) if isinstance(value, int | float) else value


def _elementwise(scalar: Any, count: int) -> Callable[..., Any]:
    """A function of decimals over arrays of them."""
    made: Callable[..., Any] = np.frompyfunc(scalar, count, 1)
    return made


class _Functions:
    """The functions that `decimal` lacks, each value computed once."""

    def __init__(self, digits: int) -> None:
        self.context = mpmath.MPContext()
        self.context.dps = self.digits = digits

    def pi(self) -> Decimal:
        """The number pi."""
        return self.decimal(+self.context.pi)

    def function(self, name: str) -> Callable[..., Decimal]:
        """A function by its name in mpmath; NaN where it is not real."""
        call = getattr(self.context, name)

        @cache
        def value(*operands: Decimal) -> Decimal:
            if not all(a.is_finite() for a in operands):
                return NAN
            try:
                found = call(*[self.context.mpf(str(a)) for a in operands])
            except (ValueError, ZeroDivisionError, OverflowError):
                return NAN
            return self.decimal(found) if isinstance(found, self.context.mpf) else NAN

        # what is not a number is equal to nothing, and so is never found again
        return lambda *operands: value(*operands)

    def decimal(self, value: Any) -> Decimal:
        """A number of mpmath as a decimal."""
        return Decimal(mpmath.nstr(value, self.digits, strip_zeros=False))


def exactly(values: Any) -> Any:
    """Doubles, one or an array of them, as decimals."""
    return _EXACTLY(values)


_EXACTLY = _elementwise(lambda value: Decimal(float(value)), 1)
