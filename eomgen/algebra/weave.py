"""A function with rows as statements: scalars, then a loop over lanes, then scalars again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from eomgen.algebra.alike import Row, Rows
from eomgen.algebra.assemble import written
from eomgen.algebra.graph import Graph, Node
from eomgen.algebra.ldl import Pivots
from eomgen.program import Alike, Assign, Expression, Function, Number, Statement, Value, in_lane


@dataclass
class _Draft:
    """A function being written: what is known of every value that has been computed."""

    head: Function
    rows: Rows
    known: dict[Node, Expression]  # fixed values, and those that cross from phase to phase
    kept: dict[Row, str] = field(default_factory=dict)  # rows that cross
    given: dict[tuple[Expression, ...], str] = field(default_factory=dict)  # what loops read
    statements: list[Statement] = field(default_factory=list)
    names: int = 0

    def take(self, made: Function) -> list[Expression]:
        """The statements of a piece, and its results as values."""
        self.statements.extend(made.statements)
        self.names += len(made.statements)
        return list(made.results)

    def named(self, expression: Expression) -> tuple[Value, list[Statement]]:
        """A value, and the statement that makes it of an expression that is none."""
        if isinstance(expression, Value):
            return expression, []
        name = f"v{self.names}"
        self.names += 1
        return Value(name), [Assign(name, expression)]


def woven(
    head: Function,
    results: Sequence[Node],
    pivots: Pivots,
    given: Mapping[Node, Expression],
    rows: Rows,
) -> Function:
    """As `assemble.written`, with the rows in loops over lanes."""
    draft = _Draft(head, rows, dict(given))
    last = [*results, *(n for pair in pivots for n in pair)]
    crossing = _crossing(rows, last)
    for phase in range(max(rows.phases.values()) + 1):
        wanted = [n for n in crossing if rows.phases[n] == phase]
        if not wanted:
            continue
        if phase % 2:
            _loop(draft, list(dict.fromkeys(rows.home[n] for n in wanted)))
        else:
            _scalars(draft, wanted)
    made = written(head, results, pivots, draft.known, draft.names)
    outputs = draft.take(made)
    return replace(head, statements=tuple(draft.statements), results=tuple(outputs))


def _crossing(rows: Rows, last: Sequence[Node]) -> list[Node]:
    """The values that are read in another phase or at the end."""
    found: dict[Node, None] = {}
    for node, phase in rows.phases.items():
        for operand in node.operands:
            if operand in rows.phases and rows.phases[operand] != phase:
                found[operand] = None
    return list(found | {n: None for n in last if n in rows.phases})


def _scalars(draft: _Draft, wanted: Sequence[Node]) -> None:
    """Statements for values of one phase."""
    leaves = [n for n in wanted if n.operator == "read"]
    draft.known |= {n: n.datum for n in leaves}
    computed = [n for n in wanted if n.operator != "read"]
    made = written(draft.head, computed, (), draft.known, draft.names)
    for node, expression in zip(computed, draft.take(made), strict=True):
        value, statements = draft.named(expression)
        draft.statements.extend(statements)
        draft.known[node] = value


def _loop(draft: _Draft, wanted: Sequence[Row]) -> None:
    """One loop that computes rows of one phase."""
    body, before = _Body(draft), len(draft.given)
    roots = [body.node(row) for row in wanted]
    made = written(draft.head, roots, (), body.leaves, draft.names)
    draft.names += len(made.statements)
    statements = list(made.statements)
    names: list[str] = []
    for row, expression in zip(wanted, made.results, strict=True):
        value, more = draft.named(expression)
        statements.extend(more)
        names.append(value.name)
        draft.kept[row] = value.name
        draft.known |= {n: Value(in_lane(value.name, k)) for k, n in enumerate(row)}
    inside = tuple(s for s in statements if isinstance(s, Assign))
    given = tuple((name, pack) for pack, name in list(draft.given.items())[before:])
    kept = tuple(dict.fromkeys(names))
    draft.statements.append(Alike(draft.rows.width, given, inside, kept))


@dataclass
class _Body:
    """Rows as nodes of a graph of their own, whose leaves are read from outside."""

    draft: _Draft
    graph: Graph = field(default_factory=Graph)
    nodes: dict[Row, Node] = field(default_factory=dict)
    leaves: dict[Node, Expression] = field(default_factory=dict)

    def node(self, row: Row) -> Node:
        """The node of a row, its operands first."""
        stack = [row]
        while stack:
            top = stack[-1]
            missing = [r for r in self._operands(top) if r not in self.nodes]
            if missing:
                stack.extend(missing)
                continue
            stack.pop()
            if top not in self.nodes:
                self.nodes[top] = self._made(top)
        return self.nodes[row]

    def _operands(self, row: Row) -> tuple[Row, ...]:
        """What a row is computed from here; nothing where it is read."""
        if row in self.draft.kept:
            return ()
        return self.draft.rows.operands.get(row, ())

    def _made(self, row: Row) -> Node:
        operands = self._operands(row)
        if operands:
            return self.graph.make(row[0].operator, tuple(self.nodes[r] for r in operands))
        leaf = self.graph.read("lane", len(self.leaves))
        self.leaves[leaf] = self._read(row)
        return leaf

    def _read(self, row: Row) -> Expression:
        """A row that was kept, one value for all lanes, or what stands for each lane."""
        if row in self.draft.kept:
            return Value(self.draft.kept[row])
        known = self.draft.known
        entries = tuple(Number(n.datum) if n.operator == "number" else known[n] for n in row)
        if len(set(entries)) == 1:
            return entries[0]
        given = self.draft.given
        if entries not in given:
            given[entries] = f"v{self.draft.names}"
            self.draft.names += 1
        return Value(given[entries])
