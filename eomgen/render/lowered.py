"""A function as machines like it: powers as products, waves named, no dead values."""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import count

from eomgen.program import (
    Alike,
    Apply,
    Assign,
    Expression,
    Function,
    Number,
    Read,
    RequirePositive,
    Solve,
    Statement,
    Value,
    in_lane,
    operands,
)

UNROLLED = 64  # largest exponent written as products
ONE = Number(Fraction(1))
PLAIN = frozenset(("add", "subtract", "multiply", "divide"))  # these stay as they are
Name = Callable[[Expression], Value]  # makes an assignment of its argument


def lower(function: Function) -> Function:
    """The same function without integer or half-integer powers and without unused values.

    Every sine and cosine has a statement of its own.
    """
    statements: list[Statement] = []
    fresh = _fresh_names(function)

    def name(expression: Expression) -> Value:
        value = Value(next(fresh))
        statements.append(Assign(value.name, expression))
        return value

    for statement in function.statements:
        statements.append(_lowered(statement, name))
    results = tuple(_simple(e, name) for e in function.results)
    return _without_dead_values(replace(function, statements=tuple(statements), results=results))


def _fresh_names(function: Function) -> Iterator[str]:
    taken = {n for s in function.statements for n in defined(s)}
    return (f"inner_{i}" for i in count(1) if f"inner_{i}" not in taken)


def defined(statement: Statement) -> tuple[str, ...]:
    """The names that a statement gives values to."""
    match statement:
        case Assign(name, _):
            return (name,)
        case Solve(names, _, _):
            return names
        case Alike(lanes, _, _, kept):
            return tuple(in_lane(name, lane) for name in kept for lane in range(lanes))
    return ()


def _map(statement: Statement, change: Callable[[Expression], Expression]) -> Statement:
    """The statement with every expression changed."""
    match statement:
        case Assign(name, expression):
            return Assign(name, change(expression))
        case RequirePositive(value, scale):
            return RequirePositive(value, change(scale))
        case Solve(names, matrix, right):
            return Solve(names, tuple(map(change, matrix)), tuple(map(change, right)))
        case Alike(_, given, _, _):
            # its own assignments are sums, products, quotients and roots
            entries = tuple((name, tuple(map(change, each))) for name, each in given)
            return replace(statement, given=entries)


def _lowered(statement: Statement, name: Name) -> Statement:
    """The statement with simple expressions; one that names a wave is left to do so."""
    match statement:
        case Assign(_, Apply("sin" | "cos" as wave, (angle,))):
            return replace(statement, expression=Apply(wave, (_simple(angle, name),)))
    return _map(statement, lambda e: _simple(e, name))


def _simple(expression: Expression, name: Name) -> Expression:
    """The expression without integer powers, every sine and cosine in it named before."""
    if not isinstance(expression, Apply):
        return expression
    changed = tuple([_simple(e, name) for e in expression.operands])
    if expression.operator in PLAIN:
        return Apply(expression.operator, changed)
    match (expression.operator, changed):
        case ("sin" | "cos" as wave, _):
            return name(Apply(wave, changed))
        case ("power", (base, Number(exponent))) if abs(exponent) <= UNROLLED:
            if exponent.denominator == 1:
                return _power(base, int(exponent), name)
            if exponent.denominator == 2:
                return _power(Apply("sqrt", (base,)), exponent.numerator, name)
        case ("negate", (Apply("negate", (operand,)),)):
            return operand
        case ("negate", (Number(number),)):
            return Number(-number)
    return Apply(expression.operator, changed)


def _power(base: Expression, exponent: int, name: Name) -> Expression:
    """base^exponent = 1 / base^-exponent, and products of squares where it is positive."""
    if exponent < 0:
        return Apply("divide", (ONE, _power(base, -exponent, name)))
    if exponent == 0:
        return ONE
    if exponent == 1:
        return base
    return _product(base if not isinstance(base, Apply) else name(base), exponent, name)


def _product(base: Expression, exponent: int, name: Name) -> Expression:
    if exponent == 1:
        return base
    if exponent % 2:
        return Apply("multiply", (_product(base, exponent - 1, name), base))
    root = base if exponent == 2 else name(_product(base, exponent // 2, name))
    return Apply("multiply", (root, root))


def atoms(expression: Expression) -> list[Number | Read | Value]:
    """The numbers, arguments and values in an expression, from left to right."""
    found: list[Number | Read | Value] = []
    stack = [expression]
    while stack:
        part = stack.pop()
        if isinstance(part, Apply):
            stack.extend(reversed(part.operands))
        else:
            found.append(part)
    return found


def _without_dead_values(function: Function) -> Function:
    """Backward over the statements: an assignment stays if something after it reads it."""
    alive = {a.name for e in function.results for a in atoms(e) if isinstance(a, Value)}
    kept: list[Statement] = []
    for statement in reversed(function.statements):
        if isinstance(statement, Assign) and statement.name not in alive:
            continue
        kept.append(statement)
        for expression in operands(statement):
            alive.update([a.name for a in atoms(expression) if isinstance(a, Value)])
    return replace(function, statements=tuple(reversed(kept)))


def expressions(function: Function) -> tuple[Expression, ...]:
    """All expressions of a function, in order."""
    inside = tuple(e for s in function.statements for e in operands(s))
    return inside + function.results


def operations(function: Function) -> Counter[str]:
    """How often each operator is applied; the loop of a `Solve` is not counted."""
    counts: Counter[str] = Counter()
    stack = list(expressions(function))
    while stack:
        part = stack.pop()
        if isinstance(part, Apply):
            counts[part.operator] += 1
            stack.extend(part.operands)
    return counts
