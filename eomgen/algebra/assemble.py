"""Graph nodes as a function of a program: named where used twice, inlined where used once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from math import prod

from eomgen.algebra.graph import Node, term
from eomgen.algebra.ldl import Pivots
from eomgen.algebra.order import by_critical_path
from eomgen.algebra.walk import below, swept
from eomgen.program import (
    Apply,
    Assign,
    Expression,
    Function,
    Number,
    RequirePositive,
    Solve,
    Statement,
    Value,
)

LARGEST_EXPRESSION = 12  # operators on one line


@dataclass
class _Draft:
    """A function being written: the expression and size of each node that has been placed."""

    shared: frozenset[Node]  # these get a name
    partners: Mapping[Node, Node]  # sin(a) <-> cos(a)
    given: Mapping[Node, Expression]  # these are read, not computed
    expressions: dict[Node, Expression] = field(default_factory=dict)
    sizes: dict[Node, int] = field(default_factory=dict)
    statements: list[Statement] = field(default_factory=list)
    names: int = 0

    def knows(self, node: Node) -> bool:
        """Whether a node need not be computed any more."""
        return node in self.expressions or node in self.given

    def new_name(self) -> str:
        """The next name: v0, v1, ..."""
        self.names += 1
        return f"v{self.names - 1}"


def assemble(
    name: str, about: str, shape: tuple[int, ...], results: Sequence[Node], pivots: Pivots = ()
) -> Function:
    """The function that computes `results`, and checks the pivots that these depend on.

    What no result depends on is not computed.
    """
    if prod(shape) != len(results):
        raise ValueError(f"{name} has {len(results)} results, its shape is {shape}")
    nodes = swept(results)
    known = frozenset(nodes)
    checks = tuple(pair for pair in pivots if not known.isdisjoint(_divisors(pair[0])))
    if checks:
        nodes = swept(chain(results, *checks))
    return _stated(Function(name, about, shape, (), ()), (results, checks), nodes, {})


def _divisors(pivot: Node) -> list[Node]:
    """What is divided by: the pivot without signs and numbers; the least of several is each."""
    stack, found = [pivot], []
    while stack:
        value = stack.pop()
        value = term(value.operands[0] if value.operator == "negate" else value)[1]
        if value.operator == "min":
            stack.extend(value.operands)
        else:
            found.append(value)
    return found


def written(
    head: Function,
    results: Sequence[Node],
    pivots: Pivots,
    given: Mapping[Node, Expression],
    names: int = 0,
) -> Function:
    """`head` with statements that check all `pivots` and compute `results`.

    Nodes of `given` are not computed but read as it says; `names` have been given before.
    """
    wanted = chain(results, *pivots)
    nodes = below(wanted, given.__contains__) if given else swept(wanted)
    return _stated(head, (results, pivots), nodes, given, names)


def _stated(
    head: Function,
    wanted: tuple[Sequence[Node], Pivots],
    nodes: Sequence[Node],
    given: Mapping[Node, Expression],
    names: int = 0,
) -> Function:
    """`head` with statements for results and pivots; `nodes` are all that these are made of."""
    results, checks = wanted[0], dict(wanted[1])
    partners = _partners(nodes)
    unnamed = {a for a, e in given.items() if a not in checks or isinstance(e, Value)}
    named = {*partners, *checks, *_used_twice(nodes, [*results, *checks.values()])} - unnamed
    draft = _Draft(frozenset(named), partners, given, names=names)
    # depth first, 2 to 15 % less values would be alive at a time, and the machine code no better
    # the least of several divisors is checked before any of them divides
    least = below([pivot for pivot in checks if pivot.operator == "min"], given.__contains__)
    for node in dict.fromkeys([*least, *by_critical_path(nodes, given)]):
        if node in checks:
            _place_all(draft, below([checks[node]], stop=draft.knows))
        _place_all(draft, (node,))
        if node in checks:
            _require_positive(draft, node, checks[node])
    outputs = tuple(draft.expressions[node] for node in results)
    return replace(head, statements=tuple(draft.statements), results=outputs)


def _used_twice(nodes: Iterable[Node], wanted: Iterable[Node]) -> list[Node]:
    """The computed nodes that are read more than once; a pivot's own check does not count."""
    uses = Counter(chain.from_iterable([node.operands for node in nodes]))
    uses.update(wanted)
    return [a for a in uses if a.operands and uses[a] > 1]


def _partners(nodes: Iterable[Node]) -> dict[Node, Node]:
    """Both ways between the sine and the cosine of the same angle."""
    sines = {a.operands[0]: a for a in nodes if a.operator == "sin"}
    pairs = [(sines.get(a.operands[0]), a) for a in nodes if a.operator == "cos"]
    both = [(sine, cosine) for sine, cosine in pairs if sine is not None]
    return dict(both) | {cosine: sine for sine, cosine in both}


def _place_all(draft: _Draft, nodes: Iterable[Node]) -> None:
    """Place nodes that are not placed yet; a sine brings its cosine along."""
    for node in nodes:
        if node not in draft.expressions:
            _place(draft, node)
            if node in draft.partners:
                _place(draft, draft.partners[node])


def _place(draft: _Draft, node: Node) -> None:
    """The expression of a node whose operands are placed; a statement where it gets a name."""
    if node in draft.given:
        draft.expressions[node], draft.sizes[node] = draft.given[node], 0
    elif node.operator in READS:
        draft.expressions[node], draft.sizes[node] = READS[node.operator](draft, node), 0
    elif node.operator == "system":
        _solve(draft, node)
        return
    else:
        _apply(draft, node)
    if node in draft.shared:
        _assign(draft, node)


def _symbol(draft: _Draft, node: Node) -> Expression:
    raise ValueError(f"a program cannot read the free symbol {node.datum}")


def _solved(draft: _Draft, node: Node) -> Expression:
    system = draft.expressions[node.operands[0]]
    assert isinstance(system, Apply)
    row: int = node.datum
    return system.operands[row]


# what is read rather than computed
READS: dict[str, Callable[[_Draft, Node], Expression]] = {
    "number": lambda draft, node: Number(node.datum),
    "read": lambda draft, node: node.datum,
    "symbol": _symbol,
    "solved": _solved,
}


def _apply(draft: _Draft, node: Node) -> None:
    """An operator on its operands; the largest of these get names where the line is too long."""
    expressions, sizes, operands = draft.expressions, draft.sizes, node.operands
    size = 1
    for operand in operands:
        size += sizes[operand]
    while size > LARGEST_EXPRESSION:
        largest = max(operands, key=sizes.__getitem__)
        size -= sizes[largest] * operands.count(largest)
        _assign(draft, largest)
    expressions[node] = Apply(node.operator, tuple([expressions[a] for a in operands]))
    sizes[node] = size


def _assign(draft: _Draft, node: Node) -> None:
    """Give a placed node a name."""
    name = draft.new_name()
    draft.statements.append(Assign(name, draft.expressions[node]))
    draft.expressions[node], draft.sizes[node] = Value(name), 0


def _require_positive(draft: _Draft, pivot: Node, scale: Node) -> None:
    value = draft.expressions[pivot]
    assert isinstance(value, Value)
    draft.statements.append(RequirePositive(value, draft.expressions[scale]))


def _solve(draft: _Draft, system: Node) -> None:
    """The statement of a system; its expression lists the names of the solution."""
    entries = [draft.expressions[a] for a in system.operands]
    size: int = system.datum
    start = size * (size + 1) // 2
    names = tuple(draft.new_name() for _ in entries[start:])
    draft.statements.append(Solve(names, tuple(entries[:start]), tuple(entries[start:])))
    draft.expressions[system] = Apply("solved", tuple(Value(name) for name in names))
    draft.sizes[system] = 0
