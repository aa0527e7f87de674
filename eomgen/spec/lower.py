"""Syntax tree -> SymPy expression, exact and within limits; never by text."""

import math
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
NOT_REAL = frozenset((sp.nan, sp.zoo, sp.oo, -sp.oo, sp.I))

LARGEST_ANGLE = 2.0**53  # a double beyond it has no digit left for the angle
LARGEST_EXPONENT = 700.0  # exp(-700) is still a double with all its digits
UNEVALUATED = ("min", "max")  # SymPy would compare every pair of arguments


@dataclass(frozen=True)
class Function:
    """A function of the language: exact, and roughly on floats."""

    symbolic: Callable[..., sp.Expr]
    estimate: Callable[..., float]
    limit: float = math.inf  # of a constant argument


FUNCTIONS = {
    "sin": Function(sp.sin, math.sin, LARGEST_ANGLE),
    "cos": Function(sp.cos, math.cos, LARGEST_ANGLE),
    "tan": Function(sp.tan, math.tan, LARGEST_ANGLE),
    "asin": Function(sp.asin, math.asin),
    "acos": Function(sp.acos, math.acos),
    "atan": Function(sp.atan, math.atan),
    "atan2": Function(sp.atan2, math.atan2),
    "sinh": Function(sp.sinh, math.sinh),
    "cosh": Function(sp.cosh, math.cosh),
    "tanh": Function(sp.tanh, math.tanh),
    "sqrt": Function(sp.sqrt, math.sqrt),
    "exp": Function(sp.exp, math.exp, LARGEST_EXPONENT),
    "log": Function(sp.log, math.log),
    "abs": Function(sp.Abs, abs),
    "sign": Function(sp.sign, lambda x: math.copysign(1.0, x)),
    "min": Function(sp.Min, min),
    "max": Function(sp.Max, max),
}


@dataclass(frozen=True)
class Lowering:
    """Where the names of a formula are looked up."""

    scene: Scene
    use: str
    local: Local | None = None


@dataclass(frozen=True)
class Lowered:
    """An expression, and its rough value where it is a constant."""

    expression: sp.Expr
    estimate: float | None = None


def scalar(tree: Tree, where: Lowering) -> sp.Expr:
    """The expression of a scalar formula; raises `Mistake` at the offending term."""
    return _lowered(tree, where).expression


def _lowered(tree: Tree, where: Lowering) -> Lowered:
    """The checked expression; every constant in it is real and fits in a double.

    SymPy compares constants by evaluating them, which does not end for exp(10^18) and the like.
    """
    found = _combined(tree, where)
    expression = found.expression
    _check_estimate(found.estimate, tree)
    if isinstance(expression, sp.Rational):
        return Lowered(expression, _checked_number(expression, tree))
    if not (expression.is_Symbol or NOT_REAL.isdisjoint(sp.preorder_traversal(expression))):
        raise _no_value(tree)
    if found.estimate is not None and expression.is_extended_real is False:
        raise _no_value(tree)
    return found


def _no_value(tree: Tree) -> Mistake:
    return Mistake(tree.span, "E203", f"'{tree.span.text}' has no finite real value")


def _too_large(tree: Tree) -> Mistake:
    return Mistake(tree.span, "E202", f"'{tree.span.text}' is too large or too small a number")


def _checked_number(number: sp.Rational, tree: Tree) -> float:
    """The number as a float, if it is not too large."""
    estimate = _estimated(lambda: int(number.p) / int(number.q))
    if _bits(number) > MOST_BITS or estimate == math.inf:
        raise _too_large(tree)
    return estimate


def _estimated(compute: Callable[[], float]) -> float:
    """The rough value; infinite where it overflows, not a number where it is not real."""
    try:
        return compute()
    except (OverflowError, ZeroDivisionError):
        return math.inf
    except ValueError:
        return math.nan


def _check_estimate(estimate: float | None, tree: Tree) -> None:
    """Raise `Mistake` before SymPy sees a constant that it cannot compare."""
    if estimate is None or math.isfinite(estimate):
        return
    raise _no_value(tree) if math.isnan(estimate) else _too_large(tree)


def _combined(tree: Tree, where: Lowering) -> Lowered:
    """The operator of the tree on its lowered operands."""
    match tree:
        case Number(value, _):
            return Lowered(sp.Rational(value.numerator, value.denominator))
        case Quantity(value, _, _, _):
            return Lowered(value, float(value))
        case Name():
            return _name(tree, where)
        case Sum(terms, _):
            parts = [(sign, _lowered(term, where)) for sign, term in terms]
            total = sp.Add(*(_times_sign(sign, part.expression) for sign, part in parts))
            return Lowered(total, _constant([p for _, p in parts], lambda x: _signed(parts, x)))
        case Product(factors, _):
            return _product(factors, where)
        case Power(base, exponent, _):
            return _power(tree, _lowered(base, where), _lowered(exponent, where))
        case Call(function, arguments, _):
            return _call(tree, function, [_lowered(argument, where) for argument in arguments])
    raise Mistake(tree.span, "E502", f"'{tree.span.text}' is a vector, a scalar is needed here")


def _constant(operands: list[Lowered], compute: Callable[[list[float]], float]) -> float | None:
    """The rough value of an operation on constants; None if an operand is none."""
    values = [operand.estimate for operand in operands]
    known = [value for value in values if value is not None]
    return _estimated(lambda: compute(known)) if len(known) == len(values) else None


def _signed(parts: list[tuple[int, Lowered]], values: list[float]) -> float:
    return sum(sign * value for (sign, _), value in zip(parts, values, strict=True))


def _name(name: Name, where: Lowering) -> Lowered:
    known = resolve(name, where.scene, where.use, where.local)
    if known.kind in ("point", "body"):
        raise Mistake(name.span, "E502", f"'{name.name}' is a place, a scalar is needed here")
    expression = known.expressions[name.order]
    return Lowered(expression, None if expression.free_symbols else float(expression))


def _product(factors: tuple[tuple[int, Tree], ...], where: Lowering) -> Lowered:
    result = Lowered(sp.S.One, 1.0)
    for side, factor in factors:
        part = _lowered(factor, where)
        if side < 0 and part.expression == 0:
            raise Mistake(factor.span, "E203", f"division by '{factor.span.text}', which is zero")
        estimate = _constant([result, part], _times if side > 0 else _over)
        expression = part.expression if side > 0 else part.expression**side
        result = Lowered(result.expression * expression, estimate)
        if isinstance(result.expression, sp.Rational):
            result = Lowered(result.expression, _checked_number(result.expression, factor))
    return result


def _times_sign(sign: int, expression: sp.Expr) -> sp.Expr:
    return expression if sign > 0 else sign * expression


def _times(values: list[float]) -> float:
    return values[0] * values[1]


def _over(values: list[float]) -> float:
    return values[0] / values[1]


def _power(tree: Power, base: Lowered, exponent: Lowered) -> Lowered:
    number, power = base.expression, exponent.expression
    if isinstance(power, sp.Rational):
        if max(abs(power.p), power.q) > MOST_EXPONENT:
            raise Mistake(tree.exponent.span, "E202", f"an exponent is at most {MOST_EXPONENT}")
        # SymPy raises a coefficient at once: (3*x)^2 is 9*x^2
        coefficient, _ = number.as_coeff_Mul()
        if isinstance(coefficient, sp.Rational) and _bits(coefficient) * abs(power) > MOST_BITS:
            raise _too_large(tree)
    estimate = _constant([base, exponent], lambda x: math.pow(*x))
    _check_estimate(estimate, tree)
    if estimate == 0 and number != 0:
        raise _too_large(tree)
    return Lowered(number**power, estimate)


def _call(tree: Tree, function: str, arguments: list[Lowered]) -> Lowered:
    estimate = _constant(arguments, lambda x: FUNCTIONS[function].estimate(*x))
    expressions = [argument.expression for argument in arguments]
    _check_estimate(estimate, tree)
    limit = FUNCTIONS[function].limit
    if any(abs(argument.estimate or 0) > limit for argument in arguments):
        raise _too_large(tree)
    if function in UNEVALUATED and estimate is None:
        return Lowered(FUNCTIONS[function].symbolic(*expressions, evaluate=False))
    return Lowered(FUNCTIONS[function].symbolic(*expressions), estimate)


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
    return vector(vectors[0][1], where).scaled(_product(scalars, where).expression)


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


def is_negative(value: int | sp.Expr) -> bool:
    """Whether a constant is known to be negative; SymPy's deductions are slow for a number."""
    number = int(value.p) if isinstance(value, sp.Rational) else value
    return number < 0 if isinstance(number, int) else bool(number.is_negative)


def is_constant(tree: Tree) -> bool:
    """Whether the formula holds no name but pi."""
    return all(name.name == "pi" for name in names(tree))
