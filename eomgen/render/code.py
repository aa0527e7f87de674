"""Expressions and functions as text of C or Python: what is computed is the tree, in its order."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from eomgen.errors import UsageError
from eomgen.program import (
    OPERATORS,
    Apply,
    Assign,
    Expression,
    Function,
    Number,
    Program,
    Read,
    RequirePositive,
    Solve,
    Statement,
    Value,
    Variable,
)
from eomgen.render.dialects import C, C_FUNCTIONS, PYTHON, Dialect
from eomgen.render.lowered import atoms, expressions, lower, operations
from eomgen.render.names import escaped, identifier

INFIX = {"add": ("+", 1), "subtract": ("-", 1), "multiply": ("*", 2), "divide": ("/", 2)}
UNARY, ATOM = 3, 4
COUNTED = {"add": "+", "subtract": "-", "negate": "-", "multiply": "*", "divide": "/"}
ARGUMENTS = ("time", "state", "inputs", "parameters")


Names = Mapping[Expression, str]


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


def expression(tree: Expression, dialect: Dialect, names: Names) -> str:
    """`tree` as text; the language evaluates it in the order of the tree."""
    return _printed(tree, dialect, names)[0]


def _printed(tree: Expression, dialect: Dialect, names: Names) -> tuple[str, int]:
    """The text and how tightly it binds."""
    match tree:
        case Number(value):
            text = dialect.number.format(literal(abs(value)))
            return (f"-{text}", UNARY) if value < 0 else (text, ATOM)
        case Read() | Value():
            return names[tree], ATOM
        case Apply("pi", ()):
            return dialect.number.format("3.141592653589793"), ATOM
        case Apply("negate", (operand,)):
            return "-" + _guarded(operand, UNARY, dialect, names), UNARY
        case Apply(operator, (left, right)) if operator in INFIX:
            sign, level = INFIX[operator]
            first, binding = _printed(left, dialect, names)
            first = first if binding >= level else f"({first})"
            return f"{first} {sign} {_guarded(right, level, dialect, names)}", level
    arguments = ", ".join(expression(e, dialect, names) for e in tree.operands)
    return f"{dialect.calls[tree.operator]}({arguments})", ATOM


def _guarded(operand: Expression, level: int, dialect: Dialect, names: Names) -> str:
    """A right operand: in parentheses unless it binds tighter than `level` and has no sign."""
    text, binding = _printed(operand, dialect, names)
    return text if binding > level and binding != UNARY else f"({text})"


@dataclass(frozen=True)
class Symbol:
    """A scalar of the interface: its name in the spec, in the code, and its value as a literal."""

    name: str
    code: str
    unit: str
    about: str
    value: str | None


@dataclass(frozen=True)
class Argument:
    """A local variable `code` that holds component `index`, called `name`, of `source`."""

    code: str
    source: str
    index: int
    name: str


@dataclass(frozen=True)
class Step:
    """One statement; `kind` is `assign`, `require` or `solve` and says which fields are used."""

    kind: str
    name: str = ""
    expression: str = ""
    scale: str = ""
    values: tuple[tuple[str, int], ...] = ()  # of a solve: the names that are read, and where
    matrix: tuple[str, ...] = ()
    right: tuple[str, ...] = ()


@dataclass(frozen=True)
class Routine:
    """A function as text."""

    name: str
    about: str
    shape: tuple[int, ...]
    arguments: tuple[Argument, ...]
    steps: tuple[Step, ...]
    results: tuple[str, ...]
    operations: str  # such as `3 +  5 *  1 sin`
    uses: tuple[str, ...]  # which of `ARGUMENTS` are read


def number(value: sp.Expr) -> str:
    """The double nearest to an exact constant of SymPy."""
    if value.is_Rational:
        return literal(Fraction(int(value.p), int(value.q)))
    return repr(float(value.evalf(40)))


def symbols(variables: tuple[Variable, ...], reserved: frozenset[str]) -> tuple[Symbol, ...]:
    """The variables as a target writes them."""
    codes = escaped((v.name for v in variables), reserved)
    return tuple(
        Symbol(v.name, code, v.unit, v.about, None if v.value is None else number(v.value))
        for v, code in zip(variables, codes, strict=True)
    )


def routine(function: Function, program: Program, dialect: Dialect) -> Routine:
    """A function of the program as text, every argument that it reads in a variable of its own."""
    lowered = lower(function)
    trees = expressions(lowered)
    read = _ordered_reads(trees)
    values = tuple(dict.fromkeys(a for e in trees for a in atoms(e) if isinstance(a, Value)))
    given = _argument_names(program)
    labels = [given[r.argument][r.index] for r in read] + [v.name for v in values]
    codes = escaped(labels, dialect.reserved)
    names: dict[Expression, str] = dict(zip((*read, *values), codes, strict=True))
    names[Read("time", 0)] = "t"
    arguments = tuple(
        Argument(code, r.argument, r.index, label)
        for code, r, label in zip(codes, read, labels, strict=False)
    )
    return Routine(
        lowered.name,
        lowered.about,
        lowered.shape,
        arguments,
        tuple(_step(s, dialect, names) for s in lowered.statements),
        tuple(expression(e, dialect, names) for e in lowered.results),
        _counted(lowered),
        _used(trees),
    )


def _ordered_reads(trees: tuple[Expression, ...]) -> tuple[Read, ...]:
    """What is read of state, inputs and parameters, by declaration."""
    found = {a for e in trees for a in atoms(e) if isinstance(a, Read) and a.argument != "time"}
    return tuple(sorted(found, key=lambda r: (ARGUMENTS.index(r.argument), r.index)))


def _used(trees: tuple[Expression, ...]) -> tuple[str, ...]:
    found = {a.argument for e in trees for a in atoms(e) if isinstance(a, Read)}
    return tuple(a for a in ARGUMENTS if a in found)


def _argument_names(program: Program) -> dict[str, list[str]]:
    return {
        "state": [v.name for v in program.coordinates + program.speeds],
        "inputs": [v.name for v in program.inputs],
        "parameters": [v.name for v in program.parameters],
    }


def _step(statement: Statement, dialect: Dialect, names: Names) -> Step:
    def text(tree: Expression) -> str:
        return expression(tree, dialect, names)

    match statement:
        case Assign(name, tree):
            return Step("assign", names[Value(name)], text(tree))
        case RequirePositive(value, scale):
            return Step("require", names[value], scale=text(scale))
        case Solve(unknowns, matrix, right):
            places = [(Value(name), i) for i, name in enumerate(unknowns)]
            return Step(
                "solve",
                values=tuple((names[v], i) for v, i in places if v in names),
                matrix=tuple(map(text, matrix)),
                right=tuple(map(text, right)),
            )


def _counted(function: Function) -> str:
    """Operations in the order of `OPERATORS`; a system that a loop solves is named by its size."""
    counts: dict[str, int] = {}
    applied = operations(function)
    for operator in OPERATORS:
        if applied[operator] and operator != "pi":
            sign = COUNTED.get(operator, operator)
            counts[sign] = counts.get(sign, 0) + applied[operator]
    parts = [f"{n} {sign}" for sign, n in counts.items()]
    sizes = [len(s.names) for s in function.statements if isinstance(s, Solve)]
    return ", ".join(parts + [f"L D L' of {n} x {n}" for n in sizes]) or "none"


def prefix(name: str) -> str:
    """The identifier that a program's name becomes in code."""
    return escaped([identifier(name)], C.reserved_members | PYTHON.reserved)[0]


def interface(program: Program, dialect: Dialect) -> dict[str, object]:
    """What every code template is given: plain text and numbers only."""
    reserved = dialect.reserved_members
    used = {o for f in program.functions for o in operations(lower(f))}
    statements = [s for f in program.functions for s in f.statements]
    return {
        "name": program.name,
        "prefix": prefix(program.name),
        "title": program.title,
        "digest": program.digest,
        "version": program.version,
        "coordinates": symbols(program.coordinates, reserved),
        "speeds": symbols(program.speeds, reserved),
        "inputs": symbols(program.inputs, reserved),
        "parameters": symbols(program.parameters, reserved),
        "outputs": symbols(program.outputs, reserved),
        "functions": tuple(routine(f, program, dialect) for f in program.functions),
        "operators": tuple(o for o in OPERATORS if o in used),
        "solve_sizes": tuple(sorted({len(s.names) for s in statements if isinstance(s, Solve)})),
        "pivots": any(isinstance(s, RequirePositive | Solve) for s in statements),
    }


def c_context(program: Program) -> dict[str, object]:
    """The names of the C templates: `interface` and the functions of <math.h> that are called."""
    context = interface(program, C)
    used = context["operators"]
    assert isinstance(used, tuple)
    calls = [(C.calls[o], f, OPERATORS[o]) for o, f in C_FUNCTIONS.items() if o in used]
    if context["pivots"] and "abs" not in used:
        calls.append((C.calls["abs"], "fabs", 1))
    open_codes = escaped(
        (v.name for v in program.parameters if v.value is None), C.reserved
    )  # arguments of the function that sets the parameters
    return context | {"math": tuple(calls), "open_codes": open_codes}


def python_context(program: Program) -> dict[str, object]:
    """The names of the Python templates."""
    return interface(program, PYTHON)
