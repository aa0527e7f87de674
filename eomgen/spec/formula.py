"""Formula text -> syntax tree, by recursive descent; nothing is evaluated here.

sum     := [+|-] product {(+|-) product}
product := factor {(*|/) factor}
factor  := (+|-) factor | power
power   := atom [(^|**) factor]                      right-associative, -x^2 = -(x^2)
atom    := number | name | function(sum, ...) | der(name) | (sum) | [sum, ...]
"""

import re
from dataclasses import dataclass
from fractions import Fraction

from eomgen.spec.ledger import Mistake, shown, suggestion
from eomgen.spec.reader import Point, Scalar
from eomgen.spec.syntax import (
    Call,
    Name,
    Number,
    Power,
    Product,
    Relation,
    Span,
    Sum,
    Tree,
    Vector,
)

MOST_CHARACTERS = 2000
MOST_TOKENS = 500
MOST_DEPTH = 50
MOST_DIGITS = 30
MOST_DECIMAL_EXPONENT = 300
MOST_ORDER = 2

FUNCTIONS = {  # name -> fewest and most arguments
    **dict.fromkeys(("sin", "cos", "tan", "asin", "acos", "atan"), (1, 1)),
    **dict.fromkeys(("sinh", "cosh", "tanh", "sqrt", "exp", "log", "abs", "sign"), (1, 1)),
    "atan2": (2, 2),
    "min": (2, 8),
    "max": (2, 8),
}
SIGNS = ("=", ">=", "<=")
RESERVED = ("t", "pi", "der", *FUNCTIONS)

LETTER = "A-Za-z_\u0391-\u03a9\u03b1-\u03c9\u03d1\u03d5\u03d6\u03f1\u03f5"
NAME = re.compile(f"[{LETTER}][{LETTER}0-9]*")
NUMBER = re.compile(r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
TOKEN = re.compile(
    rf"(?P<number>{NUMBER.pattern})|(?P<name>{NAME.pattern}'*)|(?P<mark>\*\*|>=|<=|[-+*/^()\[\],=])",
    re.ASCII,
)
INSTEAD = {
    "\u2212": "write '-'", "\u2013": "write '-'", "\u00b7": "write '*'", "\u00d7": "write '*'",
    "\u2019": "write ' for a rate", "\u00b2": "write '^2'", "\u00b3": "write '^3'",
    ">": "write '>='", "<": "write '<='", "\u2265": "write '>='", "\u2264": "write '<='",
}  # fmt: skip


def digits(mantissa: str) -> int:
    """How many digits a number has: its sign and its point are none."""
    return sum(c.isdigit() for c in mantissa)


@dataclass(frozen=True)
class Token:
    """A piece of the text from `start` up to `end`; kind is number, name, mark or end."""

    kind: str
    text: str
    start: int
    end: int


def parse(source: Scalar) -> Tree:
    """The tree of one formula; raises `Mistake` at the offending column."""
    parser = _Parser(source)
    tree = parser.sum(0)
    parser.expect_end()
    return tree


def parse_relation(source: Scalar) -> Relation:
    """The two sides of `left = right`, `left >= right` or `left <= right`."""
    parser = _Parser(source)
    left = parser.sum(0)
    sign = parser.token
    if sign.kind == "end":
        raise parser.mistake(sign, "expected '=' and a right side", "E205")
    if sign.text not in SIGNS:
        parser.expect_end()
    parser.index += 1
    if parser.token.text == sign.text:
        raise parser.mistake(
            parser.token, f"'{sign.text}' stands here twice", "E205", "once will do"
        )
    right = parser.sum(0)
    if parser.token.text in SIGNS:
        message = f"a second '{parser.token.text}' in one relation"
        raise parser.mistake(parser.token, message, "E205", "write two relations")
    parser.expect_end()
    return Relation(left, sign.text, right, parser.span(0, len(source.text)))


def tokens(source: Scalar) -> tuple[Token, ...]:
    """The tokens of the text, an end mark last."""
    text, found, index = source.text, [], 0
    if len(text) > MOST_CHARACTERS:
        raise Mistake(source, "E202", f"a formula has at most {MOST_CHARACTERS} characters")
    while index < len(text):
        if text[index].isspace():
            index += 1
            continue
        token = _token(source, index)
        found.append(token)
        index = token.end
        if len(found) > MOST_TOKENS:
            raise Mistake(_spot(source, token.start), "E202", f"more than {MOST_TOKENS} tokens")
    return (*found, Token("end", "", len(text.rstrip()), len(text.rstrip())))


def _token(source: Scalar, index: int) -> Token:
    match = TOKEN.match(source.text, index)
    if match is None:
        character = source.text[index]
        message = f"{shown(character)} has no meaning in a formula"
        raise Mistake(_spot(source, index), "E201", message, INSTEAD.get(character, ""))
    return Token(str(match.lastgroup), match.group(), index, match.end())


def _spot(source: Scalar, index: int) -> Point:
    return Point(source.line, source.column + index if source.exact else source.column)


class _Parser:
    """A cursor over the tokens of one formula."""

    def __init__(self, source: Scalar) -> None:
        self.source, self.tokens, self.index = source, tokens(source), 0

    @property
    def token(self) -> Token:
        """The token to read next."""
        return self.tokens[self.index]

    def span(self, start: int, end: int) -> Span:
        """The span of a piece of the text."""
        spot = _spot(self.source, start)
        return Span(spot.line, spot.column, self.source.text[start:end].strip())

    def since(self, start: int) -> Span:
        """The span from `start` up to the last token read."""
        return self.span(start, self.tokens[self.index - 1].end)

    def mistake(self, token: Token, message: str, code: str = "E201", hint: str = "") -> Mistake:
        """A fault at a token."""
        return Mistake(_spot(self.source, token.start), code, message, hint)

    def accept(self, *marks: str) -> Token | None:
        """The next token if it is one of the marks, else None."""
        token = self.tokens[self.index]
        if token.text not in marks:
            return None
        self.index += 1
        return token

    def expect(self, mark: str, opened: Token) -> None:
        """Step over a closing mark."""
        if not self.accept(mark):
            found = shown(self.token.text) if self.token.text else "the end of the formula"
            hint = f"'{opened.text}' in column {_spot(self.source, opened.start).column} is open"
            if self.token.kind == "end":
                hint += "; put a formula that holds ',' in quotes when it stands inside { } or [ ]"
            raise self.mistake(self.token, f"expected '{mark}' before {found}", hint=hint)

    def expect_end(self) -> None:
        """Raise when something is left over."""
        token = self.token
        if token.kind == "end":
            return
        if token.kind in ("name", "number") or token.text in ("(", "["):
            hint = "write '*' for a product"
            if self.tokens[self.index - 1].kind == "number":
                hint += "; a unit stands behind a number alone: 2 kg, 2 m^-1"
            raise self.mistake(token, f"missing operator before {shown(token.text)}", hint=hint)
        if token.text in SIGNS:
            raise self.mistake(token, f"'{token.text}' has no place in this formula", "E205")
        hint = "decimals take a point: 9.81" if token.text == "," else ""
        raise self.mistake(token, f"{shown(token.text)} is one too many", hint=hint)

    def sum(self, depth: int) -> Tree:
        """A sum of products."""
        start = self.token.start
        if depth > MOST_DEPTH:
            raise self.mistake(self.token, f"nested deeper than {MOST_DEPTH} levels", "E202")
        first = self.accept("+", "-")
        terms = [(-1 if first and first.text == "-" else 1, self.product(depth))]
        while sign := self.accept("+", "-"):
            terms.append((-1 if sign.text == "-" else 1, self.product(depth)))
        if len(terms) == 1 and terms[0][0] == 1:
            return terms[0][1]
        return Sum(tuple(terms), self.since(start))

    def product(self, depth: int) -> Tree:
        """A product of factors."""
        start = self.token.start
        factors = [(1, self.factor(depth))]
        while sign := self.accept("*", "/"):
            factors.append((-1 if sign.text == "/" else 1, self.factor(depth)))
        return factors[0][1] if len(factors) == 1 else Product(tuple(factors), self.since(start))

    def factor(self, depth: int) -> Tree:
        """A power, or one with a sign before it."""
        start = self.token.start
        if depth > MOST_DEPTH:
            raise self.mistake(self.token, f"nested deeper than {MOST_DEPTH} levels", "E202")
        sign = self.accept("+", "-")
        if sign is None:
            return self.power(depth)
        inner = self.factor(depth + 1)
        return inner if sign.text == "+" else Sum(((-1, inner),), self.since(start))

    def power(self, depth: int) -> Tree:
        """An atom, perhaps with an exponent."""
        start = self.token.start
        base = self.atom(depth)
        if not self.accept("^", "**"):
            return base
        exponent = self.factor(depth + 1)
        return Power(base, exponent, self.since(start))

    def atom(self, depth: int) -> Tree:
        """A number, a name, a call, brackets."""
        token = self.token
        self.index += token.kind != "end"
        if token.kind == "number":
            return Number(self.number(token), self.span(token.start, token.end))
        if token.kind == "name":
            return self.name(token, depth)
        if token.text == "(":
            inner = self.sum(depth + 1)
            self.expect(")", token)
            return inner
        if token.text == "[":
            items = self.items(depth + 1)
            self.expect("]", token)
            return Vector(items, self.since(token.start))
        found = shown(token.text) if token.text else "the end of the formula"
        raise self.mistake(token, f"expected a number, a name or '(' before {found}")

    def number(self, token: Token) -> Fraction:
        """The exact value, within limits."""
        mantissa, _, exponent = token.text.lower().partition("e")
        if digits(mantissa) > MOST_DIGITS:
            raise self.mistake(token, f"a number has at most {MOST_DIGITS} digits", "E202")
        if len(exponent) > 6 or abs(int(exponent or 0)) > MOST_DECIMAL_EXPONENT:
            limit = f"a decimal exponent is at most {MOST_DECIMAL_EXPONENT}"
            raise self.mistake(token, limit, "E202")
        return Fraction(token.text)

    def name(self, token: Token, depth: int) -> Tree:
        """A name with its primes, a derivative or a call."""
        name = token.text.rstrip("'")
        order = len(token.text) - len(name)
        opened = self.accept("(") if not order else None
        if opened and name == "der":
            return self.derivative(token, opened, depth)
        if opened:
            return self.call(token, opened, depth)
        if name in FUNCTIONS or name == "der":
            hint = f"write {name}(...)"
            raise self.mistake(token, f"the function '{name}' needs an argument", "E204", hint)
        return self.rate(Name(name, order, self.span(token.start, token.end)), token)

    def rate(self, name: Name, token: Token) -> Name:
        """The name, unless it is differentiated too often."""
        if name.order > MOST_ORDER:
            raise self.mistake(token, f"{shown(name.span.text)}: rates end with x''", "E204")
        return name

    def derivative(self, token: Token, opened: Token, depth: int) -> Tree:
        """der(x) is x', der(der(x)) is x''."""
        inner = self.sum(depth + 1)
        self.expect(")", opened)
        if not isinstance(inner, Name):
            hint = "write out the derivative"
            raise self.mistake(token, "der(...) takes one name", "E204", hint)
        return self.rate(Name(inner.name, inner.order + 1, self.since(token.start)), token)

    def call(self, token: Token, opened: Token, depth: int) -> Tree:
        """A function with the right number of arguments."""
        if token.text not in FUNCTIONS:
            near = suggestion(token.text, FUNCTIONS)
            hint = near if near.startswith("did") else "write '*' for a product"
            raise self.mistake(token, f"{shown(token.text)} is not a function", "E204", hint)
        arguments = self.items(depth + 1)
        self.expect(")", opened)
        fewest, most = FUNCTIONS[token.text]
        if not fewest <= len(arguments) <= most:
            count = str(fewest) if fewest == most else f"{fewest} to {most}"
            message = f"'{token.text}' takes {count} argument{'s' * (most > 1)}"
            raise self.mistake(token, f"{message}, not {len(arguments)}", "E204")
        return Call(token.text, arguments, self.since(token.start))

    def items(self, depth: int) -> tuple[Tree, ...]:
        """Sums with commas between them."""
        found = [self.sum(depth)]
        while self.accept(","):
            found.append(self.sum(depth))
        return tuple(found)
