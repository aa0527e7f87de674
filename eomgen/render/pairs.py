"""Sines and cosines as statements: each alone, or with its partner."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from eomgen.program import Apply, Assign, Expression, Statement

WAVE_KINDS = {"sin": "sine", "cos": "cosine"}


def is_wave(statement: Statement | None) -> bool:
    """Whether a statement may be one half of a pair."""
    tree = statement.expression if isinstance(statement, Assign) else None
    return isinstance(tree, Apply) and tree.operator in WAVE_KINDS


def pair(first: Statement, second: Statement) -> tuple[str, str, Expression] | None:
    """Sine, cosine and their angle, where two statements compute these."""
    match first, second:
        case Assign(a, Apply("sin", (x,))), Assign(b, Apply("cos", (y,))) if x == y:
            return a, b, x
        case Assign(a, Apply("cos", (x,))), Assign(b, Apply("sin", (y,))) if x == y:
            return b, a, x
    return None


def groups(statements: Iterable[Statement]) -> Iterator[tuple[Statement, ...]]:
    """The statements in order, a sine and the cosine behind it together."""
    waiting: Statement | None = None
    for statement in statements:
        if waiting is not None and pair(waiting, statement):
            yield waiting, statement
            waiting = None
            continue
        if waiting is not None:
            yield (waiting,)
        waiting = statement if is_wave(statement) else None
        if waiting is None:
            yield (statement,)
    if waiting is not None:
        yield (waiting,)
