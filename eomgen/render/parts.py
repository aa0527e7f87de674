"""Long functions cut into parts, so that a C compiler takes time in proportion to their length.

Values that cross from one part to a later one live in slots of an array, which the parts share;
so do the results, in the first slots, until every pivot has been checked.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from heapq import heappop, heappush

from eomgen.program import Alike, Expression, Function, Statement, Value, operands
from eomgen.render.lowered import atoms, defined

Slots = tuple[tuple[Expression, int], ...]


@dataclass(frozen=True)
class Part:
    """Some statements of a function, the slots that they read before and write behind."""

    statements: tuple[Statement, ...]
    loads: tuple[tuple[Value, int], ...]
    stores: Slots


@dataclass(frozen=True)
class Divided:
    """A function in parts, and how many slots these share."""

    parts: tuple[Part, ...]
    slots: int


def divided(function: Function, limit: int) -> Divided | None:
    """The parts of a function with more statements than `limit`, of half of it; else None.

    Loops over lanes have made a function short.
    """
    statements = function.statements
    if len(statements) <= limit or any(isinstance(s, Alike) for s in statements):
        return None
    count = -(-2 * len(statements) // limit)
    size = -(-len(statements) // count)
    chunks = [statements[i : i + size] for i in range(0, len(statements), size)]
    return _connected(chunks, function.results)


def _connected(chunks: Sequence[tuple[Statement, ...]], results: Sequence[Expression]) -> Divided:
    """The parts with their loads and stores; a slot serves again when its value is dead."""
    place = {Value(n): i for i, chunk in enumerate(chunks) for s in chunk for n in defined(s)}
    stored = _results_by_part(results, place, len(chunks))
    reads = [_reads(chunk, stored[i]) for i, chunk in enumerate(chunks)]
    last = {value: i for i, values in enumerate(reads) for value in values}
    shelf = _Shelf(len(results))
    parts = []
    for i, chunk in enumerate(chunks):
        loads = tuple((v, shelf.slots[v]) for v in reads[i] if place[v] < i)
        shelf.clear(v for v, _ in loads if last[v] == i)
        values = (Value(n) for s in chunk for n in defined(s))
        stores = tuple((v, shelf.put(v)) for v in values if last.get(v, i) > i)
        parts.append(Part(chunk, loads, stores + stored[i]))
    return Divided(tuple(parts), shelf.size)


@dataclass
class _Shelf:
    """The slots of values that cross; the lowest free one is taken."""

    size: int
    slots: dict[Value, int] = field(default_factory=dict)
    free: list[int] = field(default_factory=list)

    def put(self, value: Value) -> int:
        """A slot for a value."""
        if not self.free:
            heappush(self.free, self.size)
            self.size += 1
        self.slots[value] = heappop(self.free)
        return self.slots[value]

    def clear(self, values: Iterable[Value]) -> None:
        """Free the slots of dead values."""
        for value in values:
            heappush(self.free, self.slots.pop(value))


def _results_by_part(
    results: Sequence[Expression], place: dict[Value, int], count: int
) -> list[Slots]:
    """For each part the results that are known at its end, in the slots of their numbers."""
    stored: list[list[tuple[Expression, int]]] = [[] for _ in range(count)]
    for number, result in enumerate(results):
        part = max((place[a] for a in atoms(result) if isinstance(a, Value)), default=0)
        stored[part].append((result, number))
    return [tuple(slots) for slots in stored]


def _reads(chunk: Sequence[Statement], stored: Slots) -> tuple[Value, ...]:
    """The values that a part reads, each once, in order."""

    def expressions() -> Iterator[Expression]:
        for statement in chunk:
            yield from operands(statement)
        yield from (result for result, _ in stored)

    return tuple(dict.fromkeys(a for e in expressions() for a in atoms(e) if isinstance(a, Value)))
