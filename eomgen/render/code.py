"""Numbers and expressions as text of C or Python: what is computed is the tree, in its order."""

from collections.abc import Mapping
from fractions import Fraction

import sympy as sp

from eomgen.errors import UsageError
from eomgen.program import Apply, Expression, Number, Value
from eomgen.render.dialects import Dialect

INFIX = {"add": ("+", 1), "subtract": ("-", 1), "multiply": ("*", 2), "divide": ("/", 2)}
UNARY, ATOM = 3, 4

Names = Mapping[Expression | str, str]  # of what is read; a value stands by its name


def literal(value: Fraction) -> str:
    """The double nearest to an exact number, so that it reads back equal."""
    try:
        nearest = float(value)
    except OverflowError:
        nearest = float("inf")
    if abs(nearest) == float("inf") or (value and not nearest):
        raise UsageError(
            f"the number {sp.N(sp.Rational(value), 5)} is outside the range of a double"
        )
    return repr(nearest)


def number(value: sp.Expr) -> str:
    """The double nearest to an exact constant of SymPy."""
    if value.is_Rational:
        return literal(Fraction(int(value.p), int(value.q)))
    return repr(float(value.evalf(40)))


def expression(tree: Expression, dialect: Dialect, names: Names) -> str:
    """`tree` as text; the language evaluates it in the order of the tree."""
    return _bound(tree, dialect, names)[0]


def _bound(tree: Expression, dialect: Dialect, names: Names) -> tuple[str, int]:
    """An expression as text, and how tightly that binds."""
    if isinstance(tree, Value):
        return names[tree.name], ATOM
    if not isinstance(tree, Apply):
        return _number(tree, dialect) if isinstance(tree, Number) else (names[tree], ATOM)
    operator, operands = tree.operator, tree.operands
    if operator in INFIX:
        sign, level = INFIX[operator]
        first, binding = _bound(operands[0], dialect, names)
        second, tight = _bound(operands[1], dialect, names)
        if binding < level:
            first = f"({first})"
        if tight <= level or tight == UNARY:
            second = f"({second})"
        return f"{first} {sign} {second}", level
    if operator == "negate":
        text, binding = _bound(operands[0], dialect, names)
        return f"-{text}" if binding > UNARY else f"-({text})", UNARY
    if operator == "pi":
        return dialect.number.format("3.141592653589793"), ATOM
    arguments = ", ".join([_bound(e, dialect, names)[0] for e in operands])
    return f"{dialect.calls[operator]}({arguments})", ATOM


def _number(tree: Number, dialect: Dialect) -> tuple[str, int]:
    text = dialect.number.format(literal(abs(tree.value)))
    return (f"-{text}", UNARY) if tree.value < 0 else (text, ATOM)
