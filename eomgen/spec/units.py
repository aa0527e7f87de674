"""Quantity and unit text -> exact SI value and dimension, from a table of our own.

A unit is a product of names with SI prefixes: `kg`, `N*s/m`, `kg*m/(s^2*rad)`, `m s^-2`. `5 Nm` is
five newton metres. An angle is a plain number, so `deg` is pi/180 and `rad` is 1.
"""

import re
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from eomgen.dimension import (
    BASE,
    CURRENT,
    ENERGY,
    FORCE,
    LENGTH,
    MASS,
    NONE,
    TEMPERATURE,
    TIME,
    Dimension,
)
from eomgen.spec.formula import MOST_DECIMAL_EXPONENT, MOST_DIGITS, NUMBER, digits
from eomgen.spec.ledger import Mistake, shown, suggestion
from eomgen.spec.reader import Point, Scalar
from eomgen.spec.syntax import Quantity, Span

MOST_CHARACTERS = 80
MOST_POWER = 12
MOST_BRACKETS = 8

POWER = ENERGY / TIME
VOLTAGE = POWER / CURRENT
INCH = Fraction(254, 10000)
POUND = Fraction(45359237, 10**8)
STANDARD_GRAVITY = Fraction(980665, 10**5)


@dataclass(frozen=True)
class Unit:
    """factor * pi^turns in SI, and the dimension."""

    factor: Fraction
    dimension: Dimension
    turns: int = 0

    def __mul__(self, other: "Unit") -> "Unit":
        """The product of two units."""
        dimension = self.dimension * other.dimension
        return Unit(self.factor * other.factor, dimension, self.turns + other.turns)

    def __pow__(self, power: int) -> "Unit":
        """An integer power of a unit."""
        return Unit(self.factor**power, self.dimension**power, self.turns * power)

    @property
    def value(self) -> sp.Expr:
        """The exact factor to SI."""
        return self.of(Fraction(1))

    def of(self, number: Fraction) -> sp.Expr:
        """So many of this unit, exactly, in SI."""
        value = number * self.factor
        exact = sp.Rational(value.numerator, value.denominator)
        return exact * sp.pi**self.turns if self.turns else exact


def _unit(dimension: Dimension, factor: Fraction | int = 1, turns: int = 0) -> Unit:
    return Unit(Fraction(factor), dimension, turns)


ONE = _unit(NONE)
PREFIXES = {
    "T": 12, "G": 9, "M": 6, "k": 3, "h": 2, "da": 1, "d": -1, "c": -2, "m": -3,
    "u": -6, "\u00b5": -6, "\u03bc": -6, "n": -9, "p": -12,
}  # fmt: skip

PREFIXED = {
    "m": _unit(LENGTH),
    "g": _unit(MASS, Fraction(1, 1000)),
    "s": _unit(TIME),
    "A": _unit(CURRENT),
    "K": _unit(TEMPERATURE),
    "rad": _unit(NONE),
    "Hz": _unit(NONE / TIME),
    "N": _unit(FORCE),
    "Nm": _unit(ENERGY),
    "J": _unit(ENERGY),
    "W": _unit(POWER),
    "Pa": _unit(FORCE / LENGTH**2),
    "bar": _unit(FORCE / LENGTH**2, 10**5),
    "V": _unit(VOLTAGE),
    "C": _unit(CURRENT * TIME),
    "F": _unit(CURRENT * TIME / VOLTAGE),
    "H": _unit(VOLTAGE * TIME / CURRENT),
    "T": _unit(VOLTAGE * TIME / LENGTH**2),
    "Ohm": _unit(VOLTAGE / CURRENT),
    "\u03a9": _unit(VOLTAGE / CURRENT),
    "L": _unit(LENGTH**3, Fraction(1, 1000)),
}

PLAIN = {
    "t": _unit(MASS, 1000),
    "min": _unit(TIME, 60),
    "h": _unit(TIME, 3600),
    "deg": _unit(NONE, Fraction(1, 180), 1),
    "\u00b0": _unit(NONE, Fraction(1, 180), 1),
    "rev": _unit(NONE, 2, 1),
    "rpm": _unit(NONE / TIME, Fraction(1, 30), 1),
    "%": _unit(NONE, Fraction(1, 100)),
    "in": _unit(LENGTH, INCH),
    "ft": _unit(LENGTH, 12 * INCH),
    "lb": _unit(MASS, POUND),
    "lbf": _unit(FORCE, POUND * STANDARD_GRAVITY),
    "kgf": _unit(FORCE, STANDARD_GRAVITY),
}

UNITS = {
    **{
        p + n: Unit(Fraction(10) ** e, NONE) * u
        for p, e in PREFIXES.items()
        for n, u in PREFIXED.items()
    },
    **PREFIXED,
    **PLAIN,
}
SUGGESTED = (*PREFIXED, *PLAIN, "kg", "mm", "cm", "km", "ms", "kN", "kW", "MPa")

SI_TEXT = {  # how engineers write what the base units spell out
    FORCE: "N",
    ENERGY: "N*m",
    POWER: "W",
    FORCE / LENGTH: "N/m",
    FORCE * TIME / LENGTH: "N*s/m",
    ENERGY * TIME: "N*m*s",
    FORCE * TIME: "N*s",
}

QUANTITY = re.compile(
    rf"\s*(?P<value>[+-]?(?:{NUMBER.pattern})(?:/\d+)?)(?P<unit>\s*[A-Za-z\u00b0\u00b5\u03bc\u03a9%].*)?\s*",
    re.ASCII | re.DOTALL,
)
TOKEN = re.compile(
    r"\s*(?:(?P<name>[A-Za-z\u00b0\u00b5\u03bc\u03a9%]+)|(?P<mark>\*\*|[*/^()\u00b7])|(?P<one>1)(?!\d))"
)
EXPONENT = re.compile(r"\s*([+-]?\d{1,3})(?!\d)|\s*\(\s*([+-]?\d{1,3})\s*\)", re.ASCII)


def quantity(source: Scalar) -> Quantity | None:
    """The exact value of `9.81 m/s^2`; None where the text is no number with or without a unit."""
    match = QUANTITY.fullmatch(source.text)
    if match is None:
        return None
    value = fraction(source, match["value"].strip())
    span = Span(source.line, source.column, source.text.strip())
    if match["unit"] is None:
        return Quantity(ONE.of(value), NONE, "", span)
    skipped = match.start("unit")
    column = source.column + skipped if source.exact else source.column
    unit = parse_unit(Scalar(match["unit"], source.line, column, source.plain, source.exact))
    return Quantity(unit.of(value), unit.dimension, match["unit"].strip(), span)


def fraction(source: Scalar, text: str) -> Fraction:
    """The exact number; raises `Mistake` past the limits on digits."""
    mantissa, _, exponent = text.lower().partition("e")
    over, _, under = mantissa.partition("/")
    if max(map(digits, (over, under))) > MOST_DIGITS:
        raise Mistake(source, "E202", f"a number has at most {MOST_DIGITS} digits")
    if len(exponent) > 6 or abs(int(exponent.partition("/")[0] or 0)) > MOST_DECIMAL_EXPONENT:
        raise Mistake(source, "E202", f"a decimal exponent is at most {MOST_DECIMAL_EXPONENT}")
    above, _, below = text.partition("/")
    if below and int(below) == 0:
        raise Mistake(source, "E203", f"{shown(text)} divides by zero")
    return Fraction(above) / int(below or 1)


def parse_unit(source: Scalar) -> Unit:
    """The unit that the text names; raises `Mistake` with the column."""
    if len(source.text) > MOST_CHARACTERS:
        raise Mistake(source, "E402", f"a unit has at most {MOST_CHARACTERS} characters")
    if (known := UNITS.get(source.text.strip())) is not None:
        return known
    reader = _UnitReader(source)
    unit = reader.product(0)
    if reader.rest():
        raise reader.mistake(f"{shown(reader.rest())} has no meaning in a unit")
    return unit


def si_unit(dimension: Dimension) -> str:
    """SI text for comments: `N*m`, `kg*m^2/s`, and `1` for a plain number."""
    if dimension in SI_TEXT:
        return SI_TEXT[dimension]
    powers = list(zip(BASE, dimension.exponents, strict=True))
    above = [_power(name, e) for name, e in powers if e > 0]
    below = [_power(name, -e) for name, e in powers if e < 0]
    bottom = f"({'*'.join(below)})" if len(below) > 1 else "".join(below)
    return ("*".join(above) or "1") + (f"/{bottom}" if below else "")


def _power(name: str, exponent: Fraction | int) -> str:
    if exponent == 1:
        return name
    return f"{name}^{exponent}" if exponent.denominator == 1 else f"{name}^({exponent})"


class _UnitReader:
    """A cursor over one unit text."""

    def __init__(self, source: Scalar) -> None:
        self.source, self.index = source, 0

    def rest(self) -> str:
        """What is not read yet."""
        return self.source.text[self.index :].strip()

    def mistake(self, message: str, code: str = "E402", hint: str = "") -> Mistake:
        """A fault at the cursor."""
        text = self.source.text
        at = self.index + len(text[self.index :]) - len(text[self.index :].lstrip())
        column = self.source.column + at if self.source.exact else self.source.column
        return Mistake(Point(self.source.line, column), code, message, hint)

    def peek(self) -> re.Match[str] | None:
        """The next token."""
        return TOKEN.match(self.source.text, self.index)

    def product(self, depth: int) -> Unit:
        """Factors with `*`, `/` or a space between them."""
        if depth > MOST_BRACKETS:
            raise self.mistake("too many brackets in a unit")
        unit, divided = self.factor(depth), False
        while (token := self.peek()) and token["mark"] != ")":
            if token["mark"] in ("*", "\u00b7", "/"):
                divided = divided or token["mark"] == "/"
                self.index = token.end()
                unit *= self.factor(depth) ** (-1 if token["mark"] == "/" else 1)
            elif divided:
                raise self.mistake("a space after '/' is ambiguous", hint="write '*' or brackets")
            else:
                unit *= self.factor(depth)
        return unit

    def factor(self, depth: int) -> Unit:
        """A name or brackets, perhaps with an integer exponent."""
        token = self.peek()
        if token is None or token["mark"] not in (None, "("):
            raise self.mistake("expected the name of a unit")
        unit = ONE if token["one"] else self.named(token, depth)
        self.index = token.end() if token["mark"] is None else self.index
        power = self.peek()
        if power is None or power["mark"] not in ("^", "**"):
            return unit
        exponent = EXPONENT.match(self.source.text, power.end())
        if exponent is None or abs(int(exponent[1] or exponent[2])) > MOST_POWER:
            raise self.mistake(f"a power of a unit is an integer up to {MOST_POWER}")
        self.index = exponent.end()
        return unit ** int(exponent[1] or exponent[2])

    def named(self, token: re.Match[str], depth: int) -> Unit:
        """The unit of a name, or of what stands in brackets."""
        if token["mark"] == "(":
            self.index = token.end()
            unit = self.product(depth + 1)
            closing = self.peek()
            if closing is None or closing["mark"] != ")":
                raise self.mistake("expected ')' in the unit")
            self.index = closing.end()
            return unit
        name = token["name"]
        if name in UNITS:
            return UNITS[name]
        if name in ("degC", "degF", "\u00b0C", "\u00b0F"):
            raise self.mistake("a temperature scale with an offset is no unit", hint="use K")
        near = suggestion(name, SUGGESTED)
        hint = near if near.startswith("did") else "for a product with a name write '*'"
        raise self.mistake(f"unknown unit {shown(name)}", "E401", hint)
