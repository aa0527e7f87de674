"""Roots and arcs without the difference in which their digits are lost."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from eomgen.algebra.elementary import absolute, acos, asin, atan2, sign
from eomgen.algebra.graph import Node, add, divide, exact_root, multiply, negate, sqrt, subtract
from eomgen.algebra.signs import Signs
from eomgen.algebra.terms import Product, Products, built, summands, total


def less(products: Products, inside: Node, length: Product) -> Node | None:
    """The value of u - L^2, where both have a term, or u has the square of a sum with the term L.

    (x + L)^2 - L^2 = x (x + 2 L). None: u would have to be formed before L^2 is taken away.
    """
    terms, gone = _terms(inside), _squared(products, length)
    left = [a for a in terms if not any(products.of(a).is_same(g) for g in gone)]
    if len(left) < len(terms):
        kept = [g for g in gone if not any(products.of(a).is_same(g) for a in terms)]
        return total(inside, [*left, *(negate(built(inside, g)) for g in kept)])
    for at, term in enumerate(terms):
        if (product := _beside(products, term, length)) is not None:
            return add(product, total(inside, terms[:at] + terms[at + 1 :]))
    return None


def _terms(inside: Node) -> list[Node]:
    """The terms of a sum, and of the product (a - b)(a + b) that `root` makes of a^2 - b^2."""
    match inside.operator, [a.operator for a in inside.operands]:
        case "multiply", ["subtract", "add"] | ["add", "subtract"]:
            first, second = (a.operands for a in inside.operands)
            if {*first} == {*second}:
                a, b = first if inside.operands[0].operator == "subtract" else second
                return [multiply(a, a), negate(multiply(b, b))]
    return summands(inside)


def _squared(products: Products, length: Product) -> list[Product]:
    """The terms of L^2: several where L is a root."""
    if [(a.operator, e) for a, e in length.powers.items()] != [("sqrt", 1)]:
        return [length.square()]
    ((rooted, _),) = length.powers.items()
    found = map(products.of, summands(rooted.operands[0]))
    return [Product(length.number**2 * p.number, p.powers) for p in found]


def _beside(products: Products, square: Node, length: Product) -> Node | None:
    """(p - L)(p + L) for the square of p = x + L or its like; None for anything else."""
    product = products.of(square)
    if product.number != 1 or list(product.powers.values()) != [2]:
        return None
    (p,) = product.powers
    own = built(p, length)
    for side in (own, negate(own)):
        terms = summands(p)
        left = [a for a in terms if not products.of(a).is_same(products.of(side))]
        if len(left) < len(terms):
            x = total(p, left)
            return multiply(x, add(x, multiply(side.graph.number(2), side)))
    return _beside_number(p, terms, length)


def _beside_number(p: Node, terms: Sequence[Node], length: Product) -> Node | None:
    """The same where p holds a number and L is one: the numbers meet exactly."""
    numbers = [a for a in terms if a.operator == "number"]
    if length.powers or not numbers:
        return None
    return multiply(subtract(p, built(p, length)), add(p, built(p, length)))


def root(products: Products, signs: Signs, inside: Node) -> Node:
    """sqrt(x^2) = |x|,  sqrt(a^2 - b^2) = sqrt((a - b)(a + b)),  else the root as it stands."""
    found = _base(products.of(inside))
    if found is not None:
        return _size(signs, built(inside, found))
    terms = summands(inside)
    if len(terms) != 2:
        return sqrt(inside)
    first, second = sorted(map(products.of, terms), key=lambda p: p.number < 0)
    a, b = _base(first), _base(Product(-second.number, second.powers))
    return sqrt(inside) if a is None or b is None else _leg(signs, inside, (a, b))


def _base(product: Product) -> Product | None:
    """The product of which this is the square; None where there is none."""
    number = exact_root(Fraction(product.number))
    if number is None or any(e % 2 for e in product.powers.values()):
        return None
    return Product(number, {a: e // 2 for a, e in product.powers.items()})


def _size(signs: Signs, node: Node) -> Node:
    """The absolute value."""
    return node if signs.is_not_negative(node) else absolute(node)


def _leg(signs: Signs, at: Node, sides: tuple[Product, Product]) -> Node:
    """sqrt(a^2 - b^2) with the common denominators of a and b outside."""
    a, b = sides
    below = {f: -e for p in sides for f, e in p.powers.items() if e < 0}
    shared = Product(1, {f: max(-p.powers.get(f, 0) for p in sides) for f in below})
    first, second = (built(at, _times(p, shared)) for p in (a, b))
    leg = sqrt(multiply(subtract(first, second), add(first, second)))
    return divide(leg, _size(signs, built(at, shared))) if below else leg


def _times(a: Product, b: Product) -> Product:
    powers = {f: a.powers.get(f, 0) + b.powers.get(f, 0) for f in (*a.powers, *b.powers)}
    return Product(a.number * b.number, {f: e for f, e in powers.items() if e})


def arc_cosine(products: Products, signs: Signs, ratio: Node) -> Node:
    """acos(n/d) = atan2(sqrt((d - n)(d + n)), n) for d > 0; of a triangle by its half angle.

    The angle between the sides a and b of a triangle, opposite c, has
    tan^2(C/2) = (c - a + b)(c + a - b) / ((a + b - c)(a + b + c)).
    Source: Kahan, Miscalculating Area and Angles of a Needle-like Triangle.
    """
    parts = _ratio(products, signs, ratio)
    if parts is None:
        return acos(ratio)
    above, below = parts
    sides = _triangle(products, signs, above, below)
    if sides is None:
        return atan2(_across(above, below), above)
    a, b, c = sides
    first = multiply(add(subtract(c, a), b), add(c, subtract(a, b)))
    second = multiply(subtract(add(a, b), c), add(add(a, b), c))
    return multiply(ratio.graph.number(2), atan2(sqrt(first), sqrt(second)))


def arc_sine(products: Products, signs: Signs, ratio: Node) -> Node:
    """asin(n/d) = atan2(n, sqrt((d - n)(d + n))) for d > 0."""
    parts = _ratio(products, signs, ratio)
    return asin(ratio) if parts is None else atan2(parts[0], _across(*parts))


def _across(above: Node, below: Node) -> Node:
    return sqrt(multiply(subtract(below, above), add(below, above)))


def _ratio(products: Products, signs: Signs, ratio: Node) -> tuple[Node, Node] | None:
    """(n, d) of n/d with d > 0; None for what is no ratio."""
    product = products.of(ratio)
    number = Fraction(product.number)
    above = {a: e for a, e in product.powers.items() if e > 0}
    below = {a: -e for a, e in product.powers.items() if e < 0}
    if not below and number.denominator == 1:
        return None
    top = built(ratio, Product(number.numerator, above))
    bottom = built(ratio, Product(number.denominator, below))
    if signs.is_positive(bottom):
        return top, bottom
    return multiply(sign(bottom), top), _size(signs, bottom)


def _triangle(
    products: Products, signs: Signs, above: Node, below: Node
) -> tuple[Node, Node, Node] | None:
    """(a, b, c) of n = a^2 + b^2 - c^2, d = 2 a b with a, b > 0; None for anything else."""
    terms = [products.of(a) for a in summands(above)]
    sides = [_base(t) for t in terms if t.number > 0]
    opposite = [_base(Product(-t.number, t.powers)) for t in terms if t.number < 0]
    found = [s for s in (*sides, *opposite) if s is not None]
    if (len(sides), len(opposite), len(found)) != (2, 1, 3):
        return None
    a, b, c = found
    twice = _times(Product(2, {}), _times(a, b))
    first, second, third = (built(above, s) for s in found)
    if not twice.is_same(products.of(below)) or not all(map(signs.is_positive, (first, second))):
        return None
    return first, second, _size(signs, third)
