"""What a program means: its statements carried out over any arithmetic."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from eomgen.algebra.arithmetic import (
    EXACT,
    FLOAT,
    NUMPY,
    Arithmetic,
    mpmath_arithmetic,
    solve_loop,
)
from eomgen.algebra.ldl import SingularMassMatrix
from eomgen.algebra.unroll import unrolled
from eomgen.errors import CheckError
from eomgen.program import (
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
)

__all__ = [
    "EXACT", "FLOAT", "NUMPY", "Arithmetic", "Memory", "NotDefined", "SingularMassMatrix",
    "call", "mpmath_arithmetic", "run",
]  # fmt: skip


class NotDefined(CheckError):
    """A formula has no real value at the state that was asked for."""


class Memory:
    """The arguments and the values assigned so far."""

    def __init__(self, arguments: Mapping[str, Sequence[Any]], arithmetic: Arithmetic) -> None:
        self.arithmetic = arithmetic
        self.arguments = {
            name: [arithmetic.number(value) for value in values]
            for name, values in arguments.items()
        }
        self.values: dict[str, Any] = {}

    def value(self, expression: Expression) -> Any:
        """The value of an expression."""
        match expression:
            case Apply(operator, operands):
                return self.arithmetic.functions[operator](*[self.value(a) for a in operands])
            case Value(name):
                return self.values[name]
            case Read(argument, index):
                return self.arguments[argument][index]
            case Number(value):
                return self.arithmetic.number(value)

    def execute(self, statement: Statement) -> None:
        """Carry out one statement."""
        match statement:
            case Assign(name, expression):
                self.values[name] = self.value(expression)
            case RequirePositive(pivot, scale):
                value, size = self.value(pivot), self.value(scale)
                self.arithmetic.require_positive(pivot.name, value, size)
            case Solve(names, matrix, right):
                entries = [self.value(a) for a in (*matrix, *right)]
                solution = solve_loop(entries, statement.size, self.arithmetic)
                self.values.update(zip(names, solution, strict=True))


def run(
    function: Function, arguments: Mapping[str, Sequence[Any]], arithmetic: Arithmetic
) -> list[Any]:
    """The results of a function, row-major.

    arguments: those of `program.ARGUMENTS` by name, `time` with one entry; what the function does
    not read may be absent; with NUMPY an entry may be an array over states.
    Raises SingularMassMatrix, and NotDefined where a formula has no real value.
    """
    memory = Memory(arguments, arithmetic)
    try:
        for statement in unrolled(function).statements:
            memory.execute(statement)
        return [memory.value(result) for result in function.results]
    except (ZeroDivisionError, ValueError, OverflowError) as error:
        raise NotDefined(f"{function.name} is not defined at this state: {error}") from error


def call(
    program: Program, name: str, arguments: Mapping[str, Sequence[Any]], arithmetic: Arithmetic
) -> list[Any]:
    """The results of a function of a program, prepared or not; arguments and errors as of `run`."""
    given = dict(arguments)
    if program.prepare is not None:
        given["constants"] = run(program.prepare, given, arithmetic)
    return run(program.function(name), given, arithmetic)
