"""Numbers of a URDF: exact decimals, and how the language writes them."""

import re
from decimal import Context, Decimal
from fractions import Fraction
from math import isqrt

from eomgen.spec.ledger import Mistake, Spot, shown

NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?", re.ASCII)
MOST_CHARACTERS = 400
MOST_DIGITS = 22  # significant ones; with zeros and point the language reads 30 characters
MOST_EXPONENT = 100
PLAIN_EXPONENTS = range(-4, 7)  # written without an exponent

EXACT = Context(prec=1000)


def number(text: str, spot: Spot) -> Decimal:
    """The decimal of one word; raises `Mistake` where it is none or out of bounds."""
    if len(text) > MOST_CHARACTERS or not NUMBER.fullmatch(text):
        raise Mistake(spot, "E707", f"{shown(text)} is not a decimal number")
    value = EXACT.create_decimal(text).normalize(EXACT)
    if len(value.as_tuple().digits) > MOST_DIGITS:
        message = f"{shown(text)} has more than {MOST_DIGITS} digits"
        raise Mistake(spot, "E707", message, "round it")
    if value and abs(value.adjusted()) > MOST_EXPONENT:
        raise Mistake(spot, "E707", f"{shown(text)} is too large or too small a number")
    return value


def written(value: Decimal) -> str:
    """The same decimal as the language writes it."""
    if not value:
        return "0"
    if value.adjusted() in PLAIN_EXPONENTS:
        return format(value, "f")
    digits = "".join(map(str, value.as_tuple().digits))
    point = f".{digits[1:]}" if digits[1:] else ""
    return f"{'-' * value.is_signed()}{digits[0]}{point}e{value.adjusted()}"


def direction(axis: tuple[Decimal, ...]) -> tuple[str, ...]:
    """The unit vector along an axis, exactly: each component as a factor."""
    square = sum((Fraction(c) ** 2 for c in axis), Fraction(0))
    length = _root(square)
    if length is None:
        squares = " + ".join(f"{written(abs(c))}^2" for c in axis if c)
        return tuple(f"{written(c)}/sqrt({squares})" if c else "0" for c in axis)
    return tuple(_fraction(Fraction(c) / length) if c else "0" for c in axis)


def _root(square: Fraction) -> Fraction | None:
    """The root, where it is rational."""
    root = Fraction(isqrt(square.numerator), isqrt(square.denominator))
    return root if root * root == square else None


def _fraction(value: Fraction) -> str:
    """A rational number as a short decimal, or as a quotient."""
    for places in range(7):
        scaled = value * 10**places
        if scaled.denominator == 1:
            return written(Decimal(scaled.numerator).scaleb(-places, EXACT))
    return f"{value.numerator}/{value.denominator}"
