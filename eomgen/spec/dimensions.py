"""Do the terms agree? A walk over syntax trees, so that an error points at a term of the source.

A measure is a known dimension times powers of names whose dimension nobody stated. Where such a
name is alone in an agreement its dimension follows; where it is not, the agreement says nothing.
"""

from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from eomgen.dimension import NONE, TIME, Dimension
from eomgen.spec.ledger import Mistake
from eomgen.spec.scope import Local, Scene, Statement
from eomgen.spec.syntax import (
    Call,
    Name,
    Number,
    Power,
    Product,
    Quantity,
    Relation,
    Span,
    Sum,
    Tree,
    Vector,
)

ANGLE_FREE = ("abs", "min", "max")  # their result is like their arguments
MOST_EXPONENT = 64


@dataclass(frozen=True)
class Measure:
    """dimension * product(name ^ power)."""

    dimension: Dimension = NONE
    unknown: Mapping[str, Fraction] = field(default_factory=dict)

    def __mul__(self, other: "Measure") -> "Measure":
        """The measure of a product."""
        if not other.unknown:
            return Measure(self.dimension * other.dimension, self.unknown)
        powers = dict(self.unknown)
        for name, power in other.unknown.items():
            powers[name] = powers.get(name, Fraction(0)) + power
        unknown = {name: power for name, power in powers.items() if power}
        return Measure(self.dimension * other.dimension, unknown)

    def __truediv__(self, other: "Measure") -> "Measure":
        """The measure of a quotient."""
        if not other.unknown:
            return Measure(self.dimension / other.dimension, self.unknown)
        return self * other**-1

    def __pow__(self, power: Fraction | int) -> "Measure":
        """The measure of a power."""
        unknown = {name: p * power for name, p in self.unknown.items() if power}
        return Measure(self.dimension**power, unknown)


@dataclass(frozen=True)
class Agreement:
    """Two measures that must be equal; the fault lies in the second, at its span."""

    first: Measure
    first_text: str
    second: Measure
    second_span: Span


class _Walk:
    """Measures of trees; every agreement met on the way is kept."""

    def __init__(self, scene: Scene, local: Local | None) -> None:
        self.scene, self.local = scene, local
        self.met: list[Agreement] = []

    def measure(self, tree: Tree) -> Measure | None:
        """The measure of a tree; None for zero, which agrees with anything."""
        match tree:
            case Number(value, _):
                return Measure() if value else None
            case Quantity(value, dimension, unit, _):
                return Measure(dimension) if unit or value != 0 else None
            case Name():
                return self.name(tree)
            case Sum(terms, _):
                return self.agreed(tuple(term for _, term in terms))
            case Vector(items, _):
                return self.agreed(items)
            case Product(factors, _):
                return self.product(factors)
            case Power(base, exponent, _):
                return self.power(base, exponent)
            case Call(function, arguments, _):
                return self.call(function, arguments)

    def name(self, name: Name) -> Measure:
        """What is known of a name, divided by seconds for each prime."""
        if self.local is not None and name.name == self.local.name:
            result = Measure(self.local.dimension)
            for tree, power in self.local.by:
                result = result * (_Walk(self.scene, None).measure(tree) or Measure()) ** power
            return result
        known = self.scene.names.get(name.name)
        dimension = known.dimension if known else None
        unknown = {} if dimension is not None else {name.name: Fraction(1)}
        per = TIME**name.order if name.order else NONE
        return Measure((dimension or NONE) / per, unknown)

    def agreed(self, trees: tuple[Tree, ...]) -> Measure | None:
        """The measure that all terms have; the first that has one speaks for the others."""
        first: tuple[Tree, Measure] | None = None
        for tree in trees:
            measure = self.measure(tree)
            if measure is None:
                continue
            if first is None:
                first = (tree, measure)
                continue
            self.met.append(Agreement(first[1], f"'{first[0].span.text}'", measure, tree.span))
        return first[1] if first else None

    def product(self, factors: tuple[tuple[int, Tree], ...]) -> Measure | None:
        """The product; zero makes it zero."""
        measures = [(side, self.measure(factor)) for side, factor in factors]
        result = Measure()
        for side, measure in measures:
            if measure is None:
                return None
            result = result * measure if side > 0 else result / measure
        return result

    def power(self, base: Tree, exponent: Tree) -> Measure | None:
        """Base to a number; with any other exponent both are plain numbers."""
        number = fixed(exponent)
        measure = self.measure(base)
        if number is not None:
            return None if measure is None else measure**number
        self.plain(exponent, "an exponent")
        if measure is not None and (measure.dimension != NONE or measure.unknown):
            self.plain(base, "the base of a power that is no fixed number")
        return Measure()

    def call(self, function: str, arguments: tuple[Tree, ...]) -> Measure | None:
        """Functions of plain numbers, but for the few that keep or drop a dimension."""
        if function in ANGLE_FREE:
            return self.agreed(arguments)
        if function == "sqrt":
            measure = self.measure(arguments[0])
            return None if measure is None else measure ** Fraction(1, 2)
        if function in ("atan2", "sign"):
            self.agreed(arguments)
            return Measure()
        self.plain(arguments[0], f"the argument of {function}")
        return Measure()

    def plain(self, tree: Tree, what: str) -> None:
        """Ask for a plain number or an angle."""
        measure = self.measure(tree)
        if measure is not None:
            self.met.append(Agreement(Measure(), what, measure, tree.span))


def fixed(tree: Tree) -> Fraction | None:
    """The rational number that a tree without names is; None for any other."""
    match tree:
        case Number(value, _):
            return value
        case Sum(terms, _):
            numbers = [sign * n for sign, term in terms if (n := fixed(term)) is not None]
            return sum(numbers, Fraction(0)) if len(numbers) == len(terms) else None
        case Product(factors, _):
            return _fixed_product(factors)
        case Power(base, exponent, _):
            return _fixed_power(fixed(base), fixed(exponent))
    return None


def _fixed_product(factors: tuple[tuple[int, Tree], ...]) -> Fraction | None:
    result = Fraction(1)
    for side, factor in factors:
        number = fixed(factor)
        if number is None or (side < 0 and number == 0):
            return None
        result *= number**side
    return result


def _fixed_power(base: Fraction | None, exponent: Fraction | None) -> Fraction | None:
    if not base or exponent is None or exponent.denominator != 1 or abs(exponent) > MOST_EXPONENT:
        return None
    return base ** int(exponent)


def agreements(statement: Statement, scene: Scene) -> Iterator[Agreement]:
    """What must be equal inside a formula, and in it and its purpose."""
    wanted, tree = statement.wanted, statement.tree
    walk = _Walk(scene, wanted.local)
    if isinstance(tree, Relation):
        walk.agreed((*_terms(tree.left), *_terms(tree.right)))
        yield from walk.met
        return
    measure = walk.measure(tree)
    yield from walk.met
    if measure is None or wanted.dimension is None:
        return
    purpose = Measure(wanted.dimension)
    for factor, power in wanted.by:
        purpose = purpose * (_Walk(scene, None).measure(factor) or Measure()) ** power
    yield Agreement(purpose, wanted.what, measure, tree.span)


def _terms(tree: Tree) -> tuple[Tree, ...]:
    return tuple(term for _, term in tree.terms) if isinstance(tree, Sum) else (tree,)


def check(scene: Scene) -> dict[str, Dimension]:
    """The dimensions that follow from the formulas; every disagreement is entered."""
    met = [a for statement in scene.statements for a in agreements(statement, scene)]
    found = _infer(met)
    for agreement in met:
        scene.ledger.attempt(_compare, agreement, found)
    return found


def _infer(met: list[Agreement]) -> dict[str, Dimension]:
    """The names that follow from agreements in which they are, one by one, the only unknown."""
    quotients = [a.first / a.second for a in met if a.first.unknown or a.second.unknown]
    users: dict[str, list[Measure]] = {}
    for quotient in quotients:
        for name in quotient.unknown:
            users.setdefault(name, []).append(quotient)
    found: dict[str, Dimension] = {}
    waiting = deque(quotients)
    while waiting:
        quotient = _known(waiting.popleft(), found)
        if len(quotient.unknown) == 1:
            ((name, power),) = quotient.unknown.items()
            found[name] = quotient.dimension ** (-1 / power)
            waiting.extend(users[name])
    return found


def _known(measure: Measure, found: Mapping[str, Dimension]) -> Measure:
    """The measure with the dimensions found so far put in."""
    if not measure.unknown:
        return measure
    result = Measure(measure.dimension)
    for name, power in measure.unknown.items():
        factor = Measure(found[name]) if name in found else Measure(NONE, {name: Fraction(1)})
        result = result * factor**power
    return result


def _compare(agreement: Agreement, found: Mapping[str, Dimension]) -> None:
    """Raise `Mistake` where two measures differ."""
    first, second = _known(agreement.first, found), _known(agreement.second, found)
    if first == second:
        return
    quotient = first / second
    if quotient.unknown or quotient.dimension == NONE:
        return
    text, what = agreement.second_span.text, agreement.first_text
    left, right = _shown(first.dimension), _shown(second.dimension)
    code = "E403" if what.startswith("'") else "E404"
    raise Mistake(agreement.second_span, code, _words(what, left, text, right))


def _shown(dimension: Dimension) -> str:
    return "a plain number" if dimension == NONE else f"[{dimension}]"


def _words(what: str, left: str, text: str, right: str) -> str:
    if what.startswith("'"):
        return f"{what} is {left} but '{text}' is {right}"
    return f"'{text}' is {right} but {what} must be {left}"
