"""Loops over lanes written out, for everything that has no use for them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import replace

from eomgen.program import Alike, Apply, Assign, Expression, Function, Statement, Value, in_lane


def unrolled(function: Function) -> Function:
    """The same function without `Alike`."""
    if not any(isinstance(s, Alike) for s in function.statements):
        return function
    lanes: dict[int, dict[str, Expression]] = defaultdict(dict)
    statements: list[Statement] = []
    for statement in function.statements:
        if isinstance(statement, Alike):
            statements.extend(_lanes(statement, lanes))
        else:
            statements.append(statement)
    return replace(function, statements=tuple(statements))


def _lanes(alike: Alike, lanes: Mapping[int, dict[str, Expression]]) -> Iterator[Assign]:
    """The assignments of every lane; `lanes`: what names stand for, which they add to."""
    for lane in range(alike.lanes):
        known = lanes[lane]
        known.update((name, entries[lane]) for name, entries in alike.given)
        known.update((s.name, Value(in_lane(s.name, lane))) for s in alike.statements)
        for s in alike.statements:
            yield Assign(in_lane(s.name, lane), renamed(s.expression, known))


def renamed(expression: Expression, known: Mapping[str, Expression]) -> Expression:
    """The expression with names of a lane as what they stand for."""
    match expression:
        case Value(name):
            return known.get(name, expression)
        case Apply(operator, operands):
            return Apply(operator, tuple(renamed(a, known) for a in operands))
    return expression
