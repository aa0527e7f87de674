"""A function as machines like it: powers as products, waves named, no dead values."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain, count

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
PLAIN = frozenset(("add", "subtract", "multiply", "divide"))
CHANGED = frozenset(("sin", "cos", "power", "negate"))  # all others stay as they are too
Name = Callable[[Expression], Value]  # makes an assignment of its argument


@dataclass(frozen=True, slots=True)
class Content:
    """What is in expressions, from left to right: names of values, arguments, operators."""

    values: tuple[str, ...]
    reads: tuple[Read, ...]
    operators: tuple[str, ...]


@dataclass(frozen=True)
class Lowered:
    """A function, and what is in each of its statements and in the results."""

    function: Function
    contents: tuple[Content, ...]
    results: Content

    @property
    def content(self) -> Content:
        """What is in the whole function."""
        return merged((*self.contents, self.results))


def content(expressions: Iterable[Expression]) -> Content:
    """What is in some expressions."""
    values: list[str] = []
    reads: list[Read] = []
    operators: list[str] = []
    stack = [*expressions]
    stack.reverse()
    while stack:
        part = stack.pop()
        if isinstance(part, Value):
            values.append(part.name)
        elif isinstance(part, Apply):
            operators.append(part.operator)
            stack += part.operands[::-1]
        elif isinstance(part, Read):
            reads.append(part)
    return Content(tuple(values), tuple(reads), tuple(operators))


def merged(contents: Sequence[Content]) -> Content:
    """Several contents, one behind the other."""
    return Content(
        tuple(chain.from_iterable([each.values for each in contents])),
        tuple(chain.from_iterable([each.reads for each in contents])),
        tuple(chain.from_iterable([each.operators for each in contents])),
    )


def surveyed(function: Function) -> Lowered:
    """What is in a function that is as machines like it."""
    contents = [content(operands(statement)) for statement in function.statements]
    return Lowered(function, tuple(contents), content(function.results))


def lower(function: Function) -> Function:
    """The same function without integer or half-integer powers and without unused values.

    Every sine and cosine has a statement of its own.
    """
    return lowered(function).function


def lowered(function: Function) -> Lowered:
    """`lower`, and what the statements are made of."""
    fresh = _fresh_names(function)
    found: list[tuple[Statement, Content]] = []

    def put(statement: Statement) -> None:
        found.append((statement, content(operands(statement))))

    def name(expression: Expression) -> Value:
        value = Value(next(fresh))
        put(Assign(value.name, expression))
        return value

    for statement in function.statements:
        inside = content(operands(statement))
        if CHANGED.isdisjoint(inside.operators):
            found.append((statement, inside))
        else:
            put(_lowered(statement, name))
    results = tuple(_simple(e, name) for e in function.results)
    return _without_dead_values(replace(function, results=results), found)


def _fresh_names(function: Function) -> Iterator[str]:
    taken = {n for s in function.statements for n in defined(s)}
    yield from (f"inner_{i}" for i in count(1) if f"inner_{i}" not in taken)


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


def mapped(statement: Statement, change: Callable[[Expression], Expression]) -> Statement:
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
    return mapped(statement, lambda e: _simple(e, name))


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


def _without_dead_values(
    function: Function, statements: Sequence[tuple[Statement, Content]]
) -> Lowered:
    """Backward over the statements: an assignment stays if something after it reads it."""
    results = content(function.results)
    alive = {*results.values}
    kept = []
    for statement, inside in reversed(statements):
        if not isinstance(statement, Assign) or statement.name in alive:
            kept.append((statement, inside))
            alive.update(inside.values)
    kept.reverse()
    live = replace(function, statements=tuple([statement for statement, _ in kept]))
    return Lowered(live, tuple([inside for _, inside in kept]), results)


def expressions(function: Function) -> tuple[Expression, ...]:
    """All expressions of a function, in order."""
    inside = tuple(e for s in function.statements for e in operands(s))
    return inside + function.results


def operations(function: Function) -> Counter[str]:
    """How often each operator is applied; the loop of a `Solve` is not counted."""
    return Counter(content(expressions(function)).operators)
