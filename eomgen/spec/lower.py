"""Syntax tree -> SymPy expression, exact and within limits; never by text."""

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from eomgen.spec.ledger import Mistake
from eomgen.spec.scope import Local, Scene, resolve
from eomgen.spec.syntax import (
    Call,
    Name,
    Number,
    Power,
    Product,
    Quantity,
    Sum,
    Tree,
    Vector,
    names,
)

MOST_BITS = 2048
MOST_EXPONENT = 64
NOT_FINITE = (sp.nan, sp.zoo, sp.oo, -sp.oo)

SYMPY: dict[str, Callable[..., sp.Expr]] = {
    "sin": sp.sin, "cos": sp.cos, "tan": sp.tan, "asin": sp.asin, "acos": sp.acos,
    "atan": sp.atan, "atan2": sp.atan2, "sinh": sp.sinh, "cosh": sp.cosh, "tanh": sp.tanh,
    "sqrt": sp.sqrt, "exp": sp.exp, "log": sp.log, "abs": sp.Abs, "sign": sp.sign,
    "min": sp.Min, "max": sp.Max,
}  # fmt: skip


@dataclass(frozen=True)
class Lowering:
    """Where the names of a formula are looked up."""

    scene: Scene
    use: str
    local: Local | None = None


def scalar(tree: Tree, where: Lowering) -> sp.Expr:
    """The expression of a scalar formula; raises `Mistake` at the offending term."""
    result = _scalar(tree, where)
    if result.has(*NOT_FINITE, sp.I) or (result.is_number and result.is_extended_real is False):
        raise Mistake(tree.span, "E203", f"'{tree.span.text}' has no finite real value")
    if isinstance(result, sp.Rational) and _bits(result) > MOST_BITS:
        raise Mistake(tree.span, "E202", "the number is too large")
    return result


def _scalar(tree: Tree, where: Lowering) -> sp.Expr:
    match tree:
        case Number(value, _):
            return sp.Rational(value.numerator, value.denominator)
        case Quantity(value, _, _, _):
            return value
        case Name():
            return _name(tree, where)
        case Sum(terms, _):
            return sp.Add(*(sign * scalar(term, where) for sign, term in terms))
        case Product(factors, _):
            return _product(factors, where)
        case Power(base, exponent, _):
            return _power(tree, scalar(base, where), scalar(exponent, where))
        case Call(function, arguments, _):
            return SYMPY[function](*(scalar(argument, where) for argument in arguments))
    raise Mistake(tree.span, "E502", f"'{tree.span.text}' is a vector, a scalar is needed here")


def _name(name: Name, where: Lowering) -> sp.Expr:
    known = resolve(name, where.scene, where.use, where.local)
    if known.kind in ("point", "body"):
        raise Mistake(name.span, "E502", f"'{name.name}' is a place, a scalar is needed here")
    return known.expressions[name.order]


def _product(factors: tuple[tuple[int, Tree], ...], where: Lowering) -> sp.Expr:
    result = sp.S.One
    for side, factor in factors:
        value = scalar(factor, where)
        if side < 0 and value == 0:
            raise Mistake(factor.span, "E203", f"division by '{factor.span.text}', which is zero")
        result = result * value**side
        if isinstance(result, sp.Rational) and _bits(result) > MOST_BITS:
            raise Mistake(factor.span, "E202", "the number is too large")
    return result


def _power(tree: Power, base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    if isinstance(exponent, sp.Rational):
        if max(abs(exponent.p), exponent.q) > MOST_EXPONENT:
            raise Mistake(tree.exponent.span, "E202", f"an exponent is at most {MOST_EXPONENT}")
        if isinstance(base, sp.Rational) and _bits(base) * abs(exponent) > MOST_BITS:
            raise Mistake(tree.span, "E202", f"'{tree.span.text}' is too large a number")
    return base**exponent


def _bits(number: sp.Rational) -> int:
    return max(abs(int(number.p)).bit_length(), int(number.q).bit_length())


@dataclass(frozen=True)
class Affine:
    """sum(coefficient * named point) + components."""

    components: tuple[sp.Expr, ...]
    points: tuple[tuple[sp.Expr, str], ...] = ()

    def __add__(self, other: "Affine") -> "Affine":
        """The sum, points in the order of their first mention."""
        components = tuple(a + b for a, b in zip(self.components, other.components, strict=True))
        points = {name: coefficient for coefficient, name in self.points}
        for coefficient, name in other.points:
            points[name] = points.get(name, sp.S.Zero) + coefficient
        return Affine(components, tuple((c, name) for name, c in points.items() if c != 0))

    def scaled(self, factor: sp.Expr) -> "Affine":
        """The product with a scalar."""
        points = tuple((c * factor, name) for c, name in self.points if c * factor != 0)
        return Affine(tuple(c * factor for c in self.components), points)


def vector(tree: Tree, where: Lowering) -> Affine:
    """The vector or place that a formula describes; in a line a scalar is a vector."""
    size = where.scene.size
    if not is_vector(tree, where):
        return _lone_scalar(tree, where)
    match tree:
        case Vector(items, span):
            if len(items) != size:
                message = f"a vector in space '{where.scene.space}' has {size} component"
                raise Mistake(span, "E501", f"{message}{'s' * (size > 1)}, not {len(items)}")
            return Affine(tuple(scalar(item, where) for item in items))
        case Name(name, _, _):
            resolve(tree, where.scene, where.use, where.local)
            return Affine((sp.S.Zero,) * size, ((sp.S.One, name),))
        case Sum(terms, _):
            total = Affine((sp.S.Zero,) * size)
            for sign, term in terms:
                total += vector(term, where).scaled(sp.Integer(sign))
            return total
        case Product(factors, _):
            return _scaled_vector(tree, factors, where)
    raise Mistake(tree.span, "E502", "vectors are only added, subtracted and scaled")


def _lone_scalar(tree: Tree, where: Lowering) -> Affine:
    value = scalar(tree, where)
    if where.scene.size > 1 and value != 0:
        message = f"'{tree.span.text}' is a scalar, a vector is needed here"
        example = "[" + ", ".join("xyz"[: where.scene.size]) + "]"
        raise Mistake(tree.span, "E502", message, f"write {example}")
    return Affine((value,) * where.scene.size)


def _scaled_vector(tree: Product, factors: tuple[tuple[int, Tree], ...], where: Lowering) -> Affine:
    vectors = [(side, factor) for side, factor in factors if is_vector(factor, where)]
    if len(vectors) != 1 or vectors[0][0] < 0:
        message = "a product holds one vector at most, and none is divided by"
        raise Mistake(tree.span, "E502", message)
    scalars = tuple((s, f) for s, f in factors if f is not vectors[0][1])
    return vector(vectors[0][1], where).scaled(_product(scalars, where))


def is_vector(tree: Tree, where: Lowering) -> bool:
    """Whether a vector or a named place stands in it outside of functions."""
    match tree:
        case Vector():
            return True
        case Name(name, _, _):
            known = where.scene.names.get(name)
            local = where.local is not None and where.local.name == name
            return known is not None and known.kind in ("point", "body") and not local
        case Sum(parts, _) | Product(parts, _):
            return any(is_vector(part, where) for _, part in parts)
        case Power(base, _, _):
            return is_vector(base, where)
    return False


def is_constant(tree: Tree) -> bool:
    """Whether the formula holds no name but pi."""
    return all(name.name == "pi" for name in names(tree))
