"""A function of a program as graph nodes again, so that it can be rewritten as a whole."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from eomgen.algebra.graph import Graph, Node
from eomgen.algebra.ldl import Pivots
from eomgen.algebra.unroll import unrolled
from eomgen.program import (
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
    operands,
)

Build = Mapping[str, Callable[..., Node]]


@dataclass(frozen=True)
class Target:
    """Where functions are rebuilt: `build` has the operators, `given` what some arguments are."""

    graph: Graph
    build: Build
    given: Mapping[Read, Node]


@dataclass(frozen=True)
class Lifted:
    """What a function computes, and the pivots that it checks, each with its scale."""

    function: Function
    results: tuple[Node, ...]
    pivots: Pivots


def lift(function: Function, target: Target) -> Lifted:
    """The nodes of a function, folded and shared with all that the graph has already.

    Several quotients of one denominator become products with one reciprocal.
    """
    function = unrolled(function)
    work = _Work(target, _shared_denominators(function))
    for statement in function.statements:
        work.execute(statement)
    return Lifted(function, tuple(map(work.node, function.results)), tuple(work.pivots))


def _shared_denominators(function: Function) -> frozenset[Expression]:
    """The values and arguments that divide more than once."""
    statements = [e for s in function.statements for e in operands(s)]
    found = Counter(_denominators([*statements, *function.results]))
    return frozenset(d for d, count in found.items() if count > 1)


def _denominators(stack: list[Expression]) -> Iterator[Expression]:
    """What is divided by in expressions, in no order."""
    while stack:
        part = stack.pop()
        if isinstance(part, Apply):
            stack += part.operands
            if part.operator == "divide" and isinstance(part.operands[1], Value | Read):
                yield part.operands[1]


@dataclass
class _Work:
    """A function being lifted: the nodes of its values."""

    target: Target
    inverted: frozenset[Expression]
    values: dict[str, Node] = field(default_factory=dict)
    pivots: list[tuple[Node, Node]] = field(default_factory=list)

    def execute(self, statement: Statement) -> None:
        """Take in one statement."""
        match statement:
            case Assign(name, expression):
                self.values[name] = self.node(expression)
            case RequirePositive(pivot, scale):
                self.pivots.append((self.values[pivot.name], self.node(scale)))
            case Solve(names, matrix, right):
                entries = tuple(self.node(e) for e in (*matrix, *right))
                solution = self._solved(entries, statement.size, len(names))
                self.values.update(zip(names, solution, strict=True))

    def _solved(self, entries: tuple[Node, ...], size: int, count: int) -> list[Node]:
        """The solutions of a system; as it can fail these depend on more than its entries."""
        graph = self.target.graph
        system = graph.make("system", entries, size)
        system.leaves |= graph.symbol("a system").leaves
        return [graph.make("solved", (system,), row) for row in range(count)]

    def node(self, expression: Expression) -> Node:
        """The node of an expression."""
        if isinstance(expression, Value):
            return self.values[expression.name]
        if isinstance(expression, Apply):
            return self._applied(expression)
        if isinstance(expression, Number):
            return self.target.graph.number(expression.value)
        given = self.target.given.get(expression)
        return given or self.target.graph.read(expression.argument, expression.index)

    def _applied(self, tree: Apply) -> Node:
        """The node of an operator on its operands."""
        graph, build = self.target.graph, self.target.build
        if tree.operator == "divide" and tree.operands[1] in self.inverted:
            numerator, denominator = tree.operands
            reciprocal = build["divide"](graph.one, self.node(denominator))
            return build["multiply"](self.node(numerator), reciprocal)
        if tree.operator == "pi":
            return graph.pi()
        return build[tree.operator](*[self.node(e) for e in tree.operands])
