"""Sums, roots and arcs written so that they lose fewer digits: exact identities, in one table.

A difference of nearly equal values keeps only the digits in which they differ. What is recognised
here has another form without that difference, or with a difference of exact values. The rules work
where code is written, on values that have been derived, compared and proven before.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from fractions import Fraction

from eomgen.algebra.cancellation_roots import arc_cosine, arc_sine, less, root
from eomgen.algebra.elementary import cos, sin
from eomgen.algebra.graph import Exact, Node, negate
from eomgen.algebra.lift import Build
from eomgen.algebra.signs import Signs
from eomgen.algebra.terms import Powers, Product, Products, built

SUMS = {"add": 1, "subtract": -1}
PLAIN = {sign: operator for operator, sign in SUMS.items()}
DEPTH = 2  # how deep in a sum a term looks for its like


@dataclass(frozen=True)
class Pair:
    """The bracket of a sum, common * (number first + other_number second), nothing in common."""

    number: Exact
    first: Powers
    other_number: Exact
    second: Powers

    def turned(self) -> Pair:
        """The same with its terms in the other order."""
        return Pair(self.other_number, self.second, self.number, self.first)


@dataclass(frozen=True)
class Scene:
    """What a rule may ask: the products that nodes are, their signs, the constructors."""

    build: Build
    fixed: Callable[[Node], bool]
    products: Products
    signs: Signs


@dataclass(frozen=True)
class Rule:
    """One row of the table: what is recognised, what is written, and why that is better."""

    pattern: str
    rewrite: str
    reason: str
    apply: Callable[[Scene, Pair, Node], Node | None]  # the last: any node of the graph


def _same(scene: Scene, pair: Pair, at: Node) -> Node | None:
    if pair.first or pair.second:
        return None
    return at.graph.number(pair.number + pair.other_number)


def _power(powers: Powers, operator: str, exponent: int) -> Node | None:
    """The operand of f in f(x)^exponent; None where the powers are something else."""
    if len(powers) != 1:
        return None
    ((node, found),) = powers.items()
    return node.operands[0] if (node.operator, found) == (operator, exponent) else None


def _pythagoras(scene: Scene, pair: Pair, at: Node) -> Node | None:
    angle = _power(pair.first, "sin", 2)
    if angle is None or angle is not _power(pair.second, "cos", 2):
        return None
    return at.graph.number(pair.number) if pair.number == pair.other_number else None


def _square_left(scene: Scene, pair: Pair, at: Node) -> Node | None:
    if pair.first or pair.number != -pair.other_number:
        return None
    for wave, other in (("cos", sin), ("sin", cos)):
        if (angle := _power(pair.second, wave, 2)) is not None:
            return pair.number * (other(angle) * other(angle))
    return None


def _half_angle(scene: Scene, pair: Pair, at: Node) -> Node | None:
    angle = _power(pair.second, "cos", 1)
    if pair.first or angle is None or abs(pair.number) != abs(pair.other_number):
        return None
    wave = cos(angle)
    turned = 1 + wave if pair.number == pair.other_number else 1 - wave
    return pair.number * turned  # halved where that pays


def _roots(scene: Scene, pair: Pair, at: Node) -> Node | None:
    inside = _power(pair.first, "sqrt", 1)
    if inside is None or pair.number * pair.other_number > 0:
        return None
    length = Product(-Fraction(pair.other_number) / pair.number, pair.second)
    if not all(scene.signs.is_positive(a) for a in length.powers):
        return None
    difference = less(scene.products, inside, length)
    if difference is None:
        return None
    (rooted,) = pair.first
    add, divide = scene.build["add"], scene.build["divide"]
    return pair.number * divide(difference, add(rooted, built(at, length)))


RULES = (
    Rule(
        "a b - b a, a b + b a",
        "0, 2 a b",
        "equal products in another order leave their rounding",
        _same,
    ),
    Rule(
        "a sin(x)^2 + a cos(x)^2",
        "a",
        "rounding of both, and the angle is not needed",
        _pythagoras,
    ),
    Rule(
        "a - a cos(x)^2, a - a sin(x)^2",
        "a sin(x)^2, a cos(x)^2",
        "no digit is left near cos(x)^2 = 1",
        _square_left,
    ),
    Rule(
        "a - a cos(x), a + a cos(x)",
        "2 a sin(x/2)^2, 2 a cos(x/2)^2",
        "no digit is left where cos(x) is near 1 or -1; not beside a multiple of sin(x)",
        _half_angle,
    ),
    Rule(
        "sqrt(u) - L, L > 0, where u - L^2 is known without L^2",
        "(u - L^2)/(sqrt(u) + L)",
        "a spring near its natural length, sqrt(1 + x) - 1, a difference of roots",
        _roots,
    ),
)


def builders(inner: Build, fixed: Callable[[Node], bool], positive: Collection[Node]) -> Build:
    """The constructors `inner` behind the rules.

    fixed: which nodes depend on parameters only; positive: leaves with positive values.
    """
    found = _Rules(Scene(inner, fixed, Products(), Signs(frozenset(positive))))
    return {
        **inner,
        "add": lambda a, b: found.sum(a, b, 1),
        "subtract": lambda a, b: found.sum(a, b, -1),
        "sqrt": lambda a: root(found.scene.products, found.scene.signs, a),
        "acos": lambda a: arc_cosine(found.scene.products, found.scene.signs, a),
        "asin": lambda a: arc_sine(found.scene.products, found.scene.signs, a),
    }


@dataclass(frozen=True)
class _Rules:
    """The rules on sums."""

    scene: Scene

    def sum(self, a: Node, b: Node, sign: int) -> Node:
        """a + sign b by the first rule that fits, else as it stands."""
        found = self.absorbed(a, b, sign, DEPTH)
        if found is None and b.operator in SUMS:
            found = self.absorbed(b, a, sign, DEPTH)
            found = found if found is None or sign == 1 else negate(found)
        return self.scene.build[PLAIN[sign]](a, b) if found is None else found

    def absorbed(self, a: Node, b: Node, sign: int, depth: int) -> Node | None:
        """a + sign b, where b meets its like among the terms of a; None where no rule fits."""
        found = self.rewritten(a, b, sign, depth == DEPTH)
        if found is not None or depth == 0 or a.operator not in SUMS:
            return found
        first, second = a.operands
        own = SUMS[a.operator]
        if (inner := self.absorbed(second, b, own * sign, depth - 1)) is not None:
            return self.scene.build[a.operator](first, inner)
        if (inner := self.absorbed(first, b, sign, depth - 1)) is not None:
            return self.scene.build[a.operator](inner, second)
        return None

    def rewritten(self, a: Node, b: Node, sign: int, outside: bool) -> Node | None:
        """The result of the first rule that fits.

        Inside of a sum like terms that only add up are left: others may share them.
        """
        first, second = self.scene.products.of(a), self.scene.products.of(b)
        if first.still != second.still and not (first.has_root or second.has_root):
            return None  # only waves may differ, or a root be there
        common, pair = _parted(first, second, sign)
        if not (outside or pair.first or pair.second or pair.number == -pair.other_number):
            return None
        for rule, each in _trials(pair):
            if (bracket := rule.apply(self.scene, each, a)) is not None:
                return self.scene.build["multiply"](self.common(common, first, a), bracket)
        return None

    def common(self, powers: Powers, whole: Product, a: Node) -> Node:
        """The common factor; the term itself where that is all of it."""
        if powers == whole.powers and whole.number == 1:
            return a
        fixed = {f: e for f, e in powers.items() if self.scene.fixed(f)}
        moving = {f: e for f, e in powers.items() if f not in fixed}
        parts = (built(a, Product(1, part)) for part in (fixed, moving))
        return self.scene.build["multiply"](*parts)


def _trials(pair: Pair) -> Iterator[tuple[Rule, Pair]]:
    for rule in RULES:
        yield rule, pair
        yield rule, pair.turned()


def _parted(first: Product, second: Product, sign: int) -> tuple[Powers, Pair]:
    """The common powers, and the pair of what is left."""
    common: dict[Node, int] = {}
    left, right = dict(first.powers), dict(second.powers)
    for factor in (*first.powers, *(f for f in second.powers if f not in first.powers)):
        shared = _shared(left.get(factor, 0), right.get(factor, 0))
        for rest in (left, right) if shared else ():
            rest[factor] = rest.get(factor, 0) - shared
            if not rest[factor]:
                del rest[factor]
        if shared:
            common[factor] = shared
    return common, Pair(first.number, left, sign * second.number, right)


def _shared(one: int, other: int) -> int:
    """The exponent that two have in common; none where a factor is above in one, below in one."""
    return min(one, other) if one > 0 and other > 0 else max(one, other) if one < 0 > other else 0
