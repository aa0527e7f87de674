"""Functions of a program as text: arguments, steps and results, for a template to lay out."""

from dataclasses import dataclass

from eomgen.program import (
    ARGUMENTS,
    OPERATORS,
    Assign,
    Expression,
    Function,
    Program,
    Read,
    RequirePositive,
    Solve,
    Statement,
    Value,
)
from eomgen.render.code import Names, expression
from eomgen.render.dialects import Dialect
from eomgen.render.lowered import atoms, expressions, lower, operations
from eomgen.render.names import escaped, prefix

COUNTED = {"add": "+", "subtract": "-", "negate": "-", "multiply": "*", "divide": "/"}


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
    size: int = 0  # of a solve: the number of equations


@dataclass(frozen=True)
class Routine:
    """A function as text."""

    name: str
    about: str
    shape: tuple[int, ...]
    arguments: tuple[Argument, ...]
    steps: tuple[Step, ...]
    results: tuple[str, ...]
    operators: frozenset[str]
    operations: str  # such as `3 +  5 *  1 sin`
    takes: tuple[str, ...]  # which of `ARGUMENTS` a caller passes
    uses: tuple[str, ...]  # which of these are read
    can_fail: bool  # a pivot is checked


def routine(function: Function, program: Program, dialect: Dialect) -> Routine:
    """A function of the program as text, every argument that it reads in a variable of its own."""
    lowered = lower(function)
    trees = expressions(lowered)
    read = _ordered_reads(trees)
    values = tuple(dict.fromkeys(a for e in trees for a in atoms(e) if isinstance(a, Value)))
    given = _argument_names(program)
    labels = [given[r.argument][r.index] for r in read] + [v.name for v in values]
    codes = escaped(labels, dialect.reserved | _own_names(program, lowered))
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
        frozenset(operations(lowered)),
        _counted(lowered),
        function.arguments,
        _used(trees),
        _checks_pivots(function),
    )


def _own_names(program: Program, function: Function) -> frozenset[str]:
    """Names that our templates give to types, solvers and their arrays."""
    own = {f"{prefix(program.name)}_{kind}" for kind in ("real", "params", "status")}
    for place, statement in enumerate(function.statements, start=1):
        if isinstance(statement, Solve):
            own |= {f"matrix_of_{place}", f"solution_of_{place}", f"solve_{statement.size}"}
    return frozenset(own)


def _ordered_reads(trees: tuple[Expression, ...]) -> tuple[Read, ...]:
    """What is read of every argument but the time, by declaration."""
    found = {a for e in trees for a in atoms(e) if isinstance(a, Read) and a.argument != "time"}
    return tuple(sorted(found, key=lambda r: (ARGUMENTS.index(r.argument), r.index)))


def _used(trees: tuple[Expression, ...]) -> tuple[str, ...]:
    found = {a.argument for e in trees for a in atoms(e) if isinstance(a, Read)}
    return tuple(a for a in ARGUMENTS if a in found)


def _checks_pivots(function: Function) -> bool:
    return any(isinstance(s, RequirePositive | Solve) for s in function.statements)


def _argument_names(program: Program) -> dict[str, list[str]]:
    return {
        "state": [v.name for v in program.coordinates + program.speeds],
        "accelerations": [f"{v.name}'" for v in program.speeds],
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
                size=statement.size,
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
    loops = [s for s in function.statements if isinstance(s, Solve)]
    return ", ".join(parts + [_loop(s) for s in loops]) or "none"


def _loop(solve: Solve) -> str:
    """A system in words."""
    columns = len(solve.right) // solve.size
    many = f" for {columns} right sides" if columns > 1 else ""
    return f"L D L' of {solve.size} x {solve.size}{many}"
