"""Long functions cut into parts, so that a C compiler takes time in proportion to their length.

Values that cross from one part to a later one live in slots of an array, which the parts share;
so do the results, in the first slots, until every pivot has been checked. What has no pivots may
give its results away as they come. A part may end with a linear system, which is solved in the
slots before the next part reads them.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass, field
from heapq import heappop, heappush
from itertools import pairwise

from eomgen.program import Alike, Expression, Solve, Statement, Value
from eomgen.render.lowered import Content, Lowered, content, defined, merged

# statements of a part; fewer cost more to hand on than a compiler gains
MOST = 200
LARGEST_SYSTEM = 60  # equations that are solved in slots: more would take much of a stack
Slots = tuple[tuple[Expression, int], ...]


@dataclass(frozen=True)
class Elimination:
    """A x = b in slots: from `matrix` on the lower triangle of A, from `right` on b, then x."""

    size: int
    columns: int
    matrix: int
    right: int


@dataclass(frozen=True)
class Part:
    """Some statements of a function, the slots that they read before and write behind."""

    statements: tuple[Statement, ...]
    loads: tuple[tuple[str, int], ...]
    stores: Slots
    results: Slots  # that are given away: the number of each
    content: Content  # of the statements, in order, and of the results
    elimination: Elimination | None = None  # which is solved behind them


@dataclass(frozen=True)
class Divided:
    """A function in parts, and how many slots these share."""

    parts: tuple[Part, ...]
    slots: int


def whole(lowered: Lowered) -> Part:
    """A function as the only part of itself."""
    function = lowered.function
    results = tuple((e, i) for i, e in enumerate(function.results))
    return Part(function.statements, (), (), results, lowered.content)


def divided(
    lowered: Lowered, longest: int, at_once: bool = False, in_place: bool = False
) -> Divided | None:
    """The parts of a function with more than `longest` statements, of half of it; else None.

    No part has more than `MOST`. Loops over lanes have made a function short. at_once: results are
    given away as they come; in_place: a part fills slots before it has read all others, so that
    what it reads for the last time is kept to its end, and its systems are solved behind it.
    """
    statements = lowered.function.statements
    systems = [i for i, s in enumerate(statements) if in_place and _is_apart(s)]
    if any(isinstance(s, Alike) for s in statements):
        return None
    if len(statements) <= longest and not systems:
        return None
    count = max(-(-2 * len(statements) // longest), -(-len(statements) // MOST))
    size = -(-len(statements) // count) if len(statements) > longest else len(statements)
    bounds = sorted({*range(0, len(statements), size), *(i + 1 for i in systems)})
    pieces = [slice(*ends) for ends in pairwise([*bounds, len(statements)])]
    chunks = [statements[piece] for piece in pieces]
    contents = [lowered.contents[piece] for piece in pieces]
    return _connected(chunks, contents, lowered.function.results, at_once, in_place)


def _is_apart(statement: Statement) -> bool:
    """Whether a statement is a system that is solved in slots."""
    return isinstance(statement, Solve) and statement.size <= LARGEST_SYSTEM


def _connected(
    chunks: Sequence[tuple[Statement, ...]],
    contents: Sequence[Sequence[Content]],
    results: Sequence[Expression],
    at_once: bool,
    in_place: bool,
) -> Divided:
    """The parts with their loads and stores; a slot serves again when its value is dead."""
    systems = [_system(chunk) if in_place else None for chunk in chunks]
    chunks = [c[:-1] if solve else c for c, solve in zip(chunks, systems, strict=True)]
    made = [[n for s in chunk for n in defined(s)] for chunk in chunks]
    place = {name: i for i, found in enumerate(made) for name in found}
    place |= {n: i + 1 for i, solve in enumerate(systems) if solve for n in solve.names}
    given = _results_by_part(results, place, len(chunks))
    known = [
        merged((*inside, content([e for e, _ in kept])))
        for inside, kept in zip(contents, given, strict=True)
    ]
    reads = [dict.fromkeys(found.values) for found in known]
    last = {name: i for i, found in enumerate(reads) for name in found}
    shelf = _Shelf(0 if at_once else len(results))
    parts = []
    for i, chunk in enumerate(chunks):
        own = {*made[i]}
        loads = [(name, shelf.slots[name]) for name in reads[i] if name not in own]
        dead = [name for name, _ in loads if last[name] == i]
        shelf.clear(() if in_place else dead)
        crossing = tuple((Value(n), shelf.put(n)) for n in made[i] if last.get(n, i) > i)
        elimination, entries = _in_slots(systems[i], shelf, last)
        shelf.clear(dead if in_place else ())
        kept, away = ((), given[i]) if at_once else (given[i], ())
        # results first: what they read may stand in a slot that is filled again
        stores = kept + crossing + entries
        parts.append(Part(chunk, tuple(loads), stores, away, known[i], elimination))
    return Divided(tuple(parts), shelf.size)


def _system(chunk: Sequence[Statement]) -> Solve | None:
    """The system that a chunk ends with."""
    solve = chunk[-1] if chunk else None
    return solve if isinstance(solve, Solve) and _is_apart(solve) else None


def _in_slots(
    solve: Solve | None, shelf: _Shelf, read: Container[str]
) -> tuple[Elimination | None, Slots]:
    """Where a system stands, and its entries; the names that are `read` stand where they come."""
    if solve is None:
        return None, ()
    triangle, entries = len(solve.matrix), solve.matrix + solve.right
    first = shelf.block(len(entries))
    for k, name in enumerate(solve.names):
        if name in read:
            shelf.slots[name] = first + triangle + k
    columns = len(solve.right) // solve.size
    found = Elimination(solve.size, columns, first, first + triangle)
    return found, tuple((e, first + k) for k, e in enumerate(entries))


@dataclass
class _Shelf:
    """The slots of values that cross; the lowest free one is taken."""

    size: int
    slots: dict[str, int] = field(default_factory=dict)
    free: list[int] = field(default_factory=list)

    def put(self, value: str) -> int:
        """A slot for a value."""
        if not self.free:
            heappush(self.free, self.size)
            self.size += 1
        self.slots[value] = heappop(self.free)
        return self.slots[value]

    def block(self, size: int) -> int:
        """The first of some new slots, one behind the other."""
        self.size += size
        return self.size - size

    def clear(self, values: Iterable[str]) -> None:
        """Free the slots of dead values."""
        for value in values:
            heappush(self.free, self.slots.pop(value))


def _results_by_part(
    results: Sequence[Expression], place: dict[str, int], count: int
) -> list[Slots]:
    """For each part the results that are known at its end, in the slots of their numbers."""
    stored: list[list[tuple[Expression, int]]] = [[] for _ in range(count)]
    for number, result in enumerate(results):
        part = max((place[name] for name in content((result,)).values), default=0)
        stored[part].append((result, number))
    return [tuple(slots) for slots in stored]
