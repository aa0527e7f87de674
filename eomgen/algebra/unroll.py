"""Loops over lanes written out, for everything that has no use for them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from eomgen.program import Alike, Apply, Assign, Expression, Function, Statement, Value, in_lane


def unrolled(function: Function) -> Function:
    """The same function without `Alike`."""
    if not any(isinstance(s, Alike) for s in function.statements):
        return function
    laned: set[str] = set()
    statements: list[Statement] = []
    for statement in function.statements:
        if isinstance(statement, Alike):
            laned.update(s.name for s in statement.statements)
            statements.extend(_lanes(statement, laned))
        else:
            statements.append(statement)
    return replace(function, statements=tuple(statements))


def _lanes(alike: Alike, laned: set[str]) -> Iterator[Assign]:
    """The assignments of every lane."""
    for lane in range(alike.lanes):
        known: dict[str, Expression] = {name: Value(in_lane(name, lane)) for name in laned}
        known |= {name: entries[lane] for name, entries in alike.given}
        for s in alike.statements:
            yield Assign(in_lane(s.name, lane), _renamed(s.expression, known))


def _renamed(expression: Expression, known: Mapping[str, Expression]) -> Expression:
    match expression:
        case Value(name):
            return known.get(name, expression)
        case Apply(operator, operands):
            return Apply(operator, tuple(_renamed(a, known) for a in operands))
    return expression
