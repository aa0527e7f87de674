"""Constants that a loop over lanes reads together: an array in the model that `prepare` fills."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from eomgen.program import Alike, Expression, Function, Program, Read

Groups = dict[int, int]  # number of the first constant -> how many


def groups(program: Program) -> Groups:
    """The constants that are read one behind the other, lane by lane; no two groups overlap."""
    found: Groups = {}
    taken: set[int] = set()
    loops = [s for f in program.functions for s in f.statements if isinstance(s, Alike)]
    for entries in [entries for loop in loops for _, entries in loop.given]:
        first = _first(entries)
        if first is None or not taken.isdisjoint(range(first, first + len(entries))):
            continue
        found[first] = len(entries)
        taken.update(range(first, first + len(entries)))
    return found


def _first(entries: Sequence[Expression]) -> int | None:
    """The number of the first of consecutive constants; None where these are none."""
    start = entries[0]
    if not isinstance(start, Read) or start.argument != "constants":
        return None
    following = [Read("constants", start.index + k) for k in range(len(entries))]
    return start.index if list(entries) == following else None


def codes(count: int, known: Groups) -> list[str]:
    """What each of the constants is called in the model."""
    found = [f"c{i}" for i in range(count)]
    for first, size in known.items():
        found[first : first + size] = [f"c{first}[{k}]" for k in range(size)]
    return found


def apart(function: Function, known: Groups) -> tuple[Function, dict[str, int]]:
    """The function without the groups that its loops read, and which name reads which group."""
    direct: dict[str, int] = {}
    statements = []
    for statement in function.statements:
        if isinstance(statement, Alike):
            starts = {name: _first(entries) for name, entries in statement.given}
            here = {n: i for n, i in starts.items() if i is not None}
            here = {n: i for n, i in here.items() if known.get(i) == statement.lanes}
            direct |= here
            kept = tuple(each for each in statement.given if each[0] not in here)
            statement = replace(statement, given=kept)
        statements.append(statement)
    return replace(function, statements=tuple(statements)), direct
