"""How far an error of one value reaches into the results: adjoints, swept backward in doubles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache

import numpy as np

from eomgen import interpreter
from eomgen.algebra.arithmetic import NUMPY, evaluate
from eomgen.algebra.derive import RULES
from eomgen.algebra.graph import Graph
from eomgen.precision.records import Array
from eomgen.program import OPERATORS, Apply, Assign, Expression, Function, Read, Solve, Value

SWEEPS = 4  # with random signs, where there are more results than this
Partial = Callable[..., Array]  # (value, operands, adjoint) -> adjoint of one operand


@cache
def partials(operator: str) -> tuple[Partial, ...]:
    """The rules of differentiation of an operator, over arrays."""
    graph = Graph()
    names = ["y", *(f"a{i}" for i in range(OPERATORS[operator])), "d"]
    leaves = [graph.symbol(name) for name in names]

    def over_arrays(rule: Callable[..., object]) -> Partial:
        node = rule(*leaves)
        return lambda *v: evaluate([node], dict(zip(leaves, v, strict=True)), NUMPY)[0]  # type: ignore[list-item]

    return tuple(map(over_arrays, RULES.get(operator, ())))


def seeds(scales: Array) -> list[Array]:
    """What a sweep starts from at each result, (S, N): one result each, or random signs.

    scales (number of results, N): what an error of each result is compared with.
    """
    size = len(scales)
    if size <= SWEEPS:
        signs = np.eye(size)
    else:
        chance = np.random.default_rng(size)
        signs = chance.choice((-1.0, 1.0), (SWEEPS, size))
    return [signs[:, i : i + 1] / scales[i] for i in range(size)]


def reach(adjoint: Array, results: int) -> Array:
    """(N,): the change of the results, in units of their scales, for a change by 1 of a value.

    With random signs the mean square over the sweeps is that over all results together.
    """
    if results <= SWEEPS:
        found: Array = np.abs(adjoint).max(axis=0)
    else:
        found = np.sqrt(np.mean(adjoint**2, axis=0))
    return found


@dataclass
class Sweep:
    """Adjoints (S, N) of everything that a function reads or assigns."""

    memory: interpreter.Memory  # with every value of the function, in doubles
    adjoints: dict[Expression, Array] = field(default_factory=dict)

    def back(self, function: Function, started: list[Array]) -> dict[Expression, Array]:
        """The adjoints, from those of the results."""
        with NUMPY.quiet():
            for result, adjoint in zip(function.results, started, strict=True):
                self.into(result, adjoint)
            for statement in reversed(function.statements):
                match statement:
                    case Assign(name, expression) if Value(name) in self.adjoints:
                        self.into(expression, self.adjoints[Value(name)])
                    case Solve():
                        self.solved(statement)
        return self.adjoints

    def into(self, expression: Expression, adjoint: Array) -> None:
        """Add what an expression passes on to its operands."""
        match expression:
            case Value() | Read("constants", _):
                known = self.adjoints.get(expression)
                self.adjoints[expression] = adjoint if known is None else known + adjoint
            case Apply(operator, operands):
                values = [self.memory.value(a) for a in operands]
                own = self.memory.value(expression)
                for operand, partial in zip(operands, partials(operator), strict=True):
                    if isinstance(operand, Apply | Value | Read):
                        self.into(operand, partial(own, *values, adjoint))

    def solved(self, statement: Solve) -> None:
        """A x = b passes l = A^-1 x' on to b, and -(l x' + x l') to A, which is symmetric."""
        size = statement.size
        for at in range(0, len(statement.names), size):
            known = [self.adjoints.get(Value(n)) for n in statement.names[at : at + size]]
            given = [a for a in known if a is not None]
            if not given:
                continue
            zero = np.zeros_like(given[0])
            adjoint = np.stack([zero if a is None else a for a in known], axis=-1)
            x = [self.memory.values[n] for n in statement.names[at : at + size]]
            push = np.linalg.solve(self._matrix(statement, zero.shape), adjoint[..., None])[..., 0]
            for i in range(size):
                self.into(statement.right[at + i], push[..., i])
                for j in range(i + 1):
                    share = -push[..., i] * x[j] - (push[..., j] * x[i] if i != j else 0.0)
                    self.into(statement.matrix[i * (i + 1) // 2 + j], share)

    def _matrix(self, statement: Solve, shape: tuple[int, ...]) -> Array:
        """A for every sweep and state; the identity where it is not finite."""
        size = statement.size
        full = np.zeros((*shape, size, size))
        for i in range(size):
            for j in range(i + 1):
                entry = self.memory.value(statement.matrix[i * (i + 1) // 2 + j])
                full[..., i, j] = full[..., j, i] = entry
        usable = np.isfinite(full).all(axis=(-1, -2), keepdims=True)
        return np.where(usable, full, np.eye(size))
