"""The waist on the way out: an ordered list of assignments with named inputs and outputs.

Every target renders it, the interpreter defines what it means, and nothing behind it knows
mechanics. Every function of a program has the arguments t, state = (coordinates, speeds), inputs
and parameters; some have the accelerations u', derivatives of the speeds, behind the state. Those
of a prepared program also read the constants which `prepare` makes of the parameters.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

import sympy as sp

OPERATORS = {  # name -> number of operands
    "add": 2, "subtract": 2, "multiply": 2, "divide": 2, "negate": 1, "power": 2,
    "sin": 1, "cos": 1, "tan": 1, "asin": 1, "acos": 1, "atan": 1, "atan2": 2,
    "sinh": 1, "cosh": 1, "tanh": 1, "sqrt": 1, "exp": 1, "log": 1,
    "abs": 1, "sign": 1, "min": 2, "max": 2, "pi": 0,
}  # fmt: skip


ARGUMENTS = ("time", "state", "accelerations", "inputs", "parameters")  # in the order of a call
AT_A_STATE = ("time", "state", "inputs", "parameters")
IN_MOTION = ARGUMENTS  # with accelerations that the caller chooses


@dataclass(frozen=True, slots=True)
class Number:
    """An exact rational constant."""

    value: Fraction


@dataclass(frozen=True, slots=True)
class Read:
    """One component of an argument of `ARGUMENTS`, or of the `constants`; of `time` that is 0."""

    argument: str
    index: int


@dataclass(frozen=True, slots=True)
class Value:
    """The result of an earlier assignment."""

    name: str


@dataclass(frozen=True, slots=True)
class Apply:
    """An operator of `OPERATORS` on its operands; the exponent of `power` is any expression."""

    operator: str
    operands: tuple[Expression, ...]


Expression = Number | Read | Value | Apply


@dataclass(frozen=True, slots=True)
class Assign:
    """name = expression."""

    name: str
    expression: Expression


@dataclass(frozen=True, slots=True)
class RequirePositive:
    """Stop with the status `singular` unless value > tolerance * scale (a pivot of L D L')."""

    value: Value
    scale: Expression


@dataclass(frozen=True, slots=True)
class Solve:
    """names = A^-1 B by L D L' in a loop, for systems too large to unroll; same pivot rule.

    matrix: the lower triangle of A row by row, n (n + 1) / 2 entries; right: B, column by column,
    n entries for each, as the names.
    """

    names: tuple[str, ...]
    matrix: tuple[Expression, ...]
    right: tuple[Expression, ...]

    @property
    def size(self) -> int:
        """The number n of equations."""
        return (isqrt(8 * len(self.matrix) + 1) - 1) // 2


@dataclass(frozen=True, slots=True)
class Alike:
    """The same assignments once for each of `lanes` limbs that are built alike.

    given: names that the assignments, and later ones of this kind, read, each with what it stands
    for lane by lane; kept: those of their own names that statements behind may read, of one lane
    as `in_lane(name, lane)` or, in later `Alike`, of each lane as `name`. All have as many lanes.
    """

    lanes: int
    given: tuple[tuple[str, tuple[Expression, ...]], ...]
    statements: tuple[Assign, ...]
    kept: tuple[str, ...]


Statement = Assign | RequirePositive | Solve | Alike


def in_lane(name: str, lane: int) -> str:
    """What a value of one lane is called outside."""
    return f"{name}_{lane}"


def operands(statement: Statement) -> tuple[Expression, ...]:
    """The expressions that a statement reads."""
    match statement:
        case Assign(_, expression):
            return (expression,)
        case RequirePositive(value, scale):
            return (value, scale)
        case Solve(_, matrix, right):
            return matrix + right
        case Alike(_, given, statements, _):
            return tuple(e for _, entries in given for e in entries) + tuple(
                s.expression for s in statements
            )


@dataclass(frozen=True)
class Function:
    """One function: statements, then its results in row-major order of `shape`.

    arguments: what a caller passes, `AT_A_STATE` or `IN_MOTION`.
    """

    name: str
    about: str
    shape: tuple[int, ...]
    statements: tuple[Statement, ...]
    results: tuple[Expression, ...]
    arguments: tuple[str, ...] = AT_A_STATE


@dataclass(frozen=True)
class Variable:
    """A named scalar of the interface; `unit` is SI; `value` exact, where the spec has one."""

    name: str
    unit: str = ""
    about: str = ""
    value: sp.Expr | None = None


@dataclass(frozen=True)
class Program:
    """What a target renders; `parameters` are the free ones, derived ones are computed inside."""

    name: str
    title: str
    digest: str
    version: str
    coordinates: tuple[Variable, ...]  # value: the spec's initial value
    speeds: tuple[Variable, ...]
    inputs: tuple[Variable, ...]
    parameters: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    functions: tuple[Function, ...]
    engine: str = ""  # how accelerations are found, and what that costs
    prepare: Function | None = None  # from the parameters alone: the `constants` of the functions
    folded: tuple[Variable, ...] = ()  # parameters that have become numbers in the functions

    def function(self, name: str) -> Function:
        """The function of that name."""
        return next(f for f in self.functions if f.name == name)
