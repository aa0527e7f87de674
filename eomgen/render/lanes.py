"""A function for many states at once: its waves first, then what is left, in place.

Sines and cosines of arguments are computed for all lanes in loops of their own and read like
arguments. In the loops over the rest every argument is read where it is first needed and every
result is written where it is known: neither takes a register from one end to the other.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from eomgen.algebra.cost import CYCLES, WEIGHTS
from eomgen.algebra.order import AT_ONCE
from eomgen.algebra.unroll import renamed
from eomgen.program import (
    Apply,
    Assign,
    Expression,
    Read,
    RequirePositive,
    Statement,
    Value,
    operands,
)
from eomgen.render.lowered import Lowered, content, defined, mapped, surveyed
from eomgen.render.pairs import WAVE_KINDS, groups, is_wave
from eomgen.render.parts import Part

ROWS = ("state", "accelerations", "inputs")  # what differs between the states of a batch
WAVES = "waves"  # the array of sines and cosines
OF_A_CHAIN = 30  # statements of a loop whose lanes would wait
OF_MANY = 200  # of one that was cut because it was long


@dataclass(frozen=True)
class Wave:
    """Sines and cosines of an argument, for all lanes in a loop of their own.

    They go to `slot` of `WAVES`, of a pair the cosine to the next; the values are called `names`.
    """

    kind: str
    source: str
    index: int
    slot: int
    names: tuple[str, ...]

    @property
    def reads(self) -> dict[str, Read]:
        """Where each of the values is read."""
        return {name: Read(WAVES, self.slot + k) for k, name in enumerate(self.names)}


@dataclass(frozen=True)
class Load:
    """An argument is read, or a value that another part has left."""

    place: Read | str


@dataclass(frozen=True)
class Store:
    """An expression is written to its place."""

    expression: Expression
    place: int


Event = Load | Store | tuple[Statement, ...]


def waves(lowered: Lowered) -> tuple[Wave, ...]:
    """The waves of arguments; not those that are pivots, which must be values."""
    statements = lowered.function.statements
    pivots = {s.value.name for s in statements if isinstance(s, RequirePositive)}
    found: dict[Read, dict[str, str]] = {}
    for statement in statements:
        match statement:
            case Assign(name, Apply("sin" | "cos" as wave, (Read() as angle,))) if (
                angle.argument in ROWS and wave not in found.get(angle, {}) and name not in pivots
            ):
                found.setdefault(angle, {})[wave] = name
    made, slot = [], 0
    for angle, both in found.items():
        kind = "pair" if len(both) == 2 else WAVE_KINDS[next(iter(both))]
        names = tuple(both[w] for w in WAVE_KINDS if w in both)
        made.append(Wave(kind, angle.argument, angle.index, slot, names))
        slot += len(names)
    return tuple(made)


def without(lowered: Lowered, found: Sequence[Wave]) -> Lowered:
    """The function that reads these waves like an argument."""
    if not found:
        return lowered
    known = {name: read for wave in found for name, read in wave.reads.items()}
    function = lowered.function
    rest = (s for s in function.statements if not (is_wave(s) and known.keys() & {*defined(s)}))
    return surveyed(
        replace(
            function,
            statements=tuple(mapped(s, lambda e: renamed(e, known)) for s in rest),
            results=tuple(renamed(e, known) for e in function.results),
        )
    )


def runs(reads: Iterable[Read]) -> tuple[tuple[str, int, int], ...]:
    """The rows that are read of each argument: from the first to before the second number."""
    found: list[tuple[str, int, int]] = []
    taken = {r for r in reads if r.argument in ROWS}
    for read in sorted(taken, key=lambda r: (ROWS.index(r.argument), r.index)):
        if found and found[-1][0] == read.argument and found[-1][2] == read.index:
            found[-1] = (read.argument, found[-1][1], read.index + 1)
        else:
            found.append((read.argument, read.index, read.index + 1))
    return tuple(found)


def longest_body(lowered: Lowered, longest: int) -> int:
    """How many statements one loop over the lanes may have.

    A processor looks a few hundred operations ahead. Where all lanes would wait for one long chain,
    loops so short that it sees several of their rounds have something to do; else one loop is
    best, for it writes fewest values to memory, until there are too many to order them well.
    """
    if _waits(lowered):
        return min(longest, OF_A_CHAIN)
    return min(longest, OF_MANY) if len(lowered.function.statements) > longest else longest


def _waits(lowered: Lowered) -> bool:
    """Whether the longest chain takes more cycles than the operations, `AT_ONCE` in each."""
    ready: dict[str, int] = {}
    for statement in lowered.function.statements:
        end = max((_ready(e, ready) for e in operands(statement)), default=0)
        ready.update(dict.fromkeys(defined(statement), end))
    work = sum(WEIGHTS.get(operator, 0) for operator in lowered.content.operators)
    return work <= AT_ONCE * max(ready.values(), default=0)


def _ready(expression: Expression, ready: Mapping[str, int]) -> int:
    """When an expression is known [cycles]."""
    match expression:
        case Value(name):
            return ready[name]
        case Apply(operator, parts):
            start = max((_ready(e, ready) for e in parts), default=0)
            return start + CYCLES.get(operator, 0)
    return 0


def in_place(part: Part) -> Iterator[Event]:
    """The statements of a part, each behind the loads that it needs, before what it completes."""
    held = {name for name, _ in part.loads}
    here: set[Read | str] = set()

    def loads(expressions: Iterable[Expression]) -> Iterator[Load]:
        inside = content(expressions)
        read: list[Read | str] = [*inside.reads, *(v for v in inside.values if v in held)]
        fresh = [place for place in dict.fromkeys(read) if place not in here]
        here.update(fresh)
        return map(Load, fresh)

    def stores(completed: Iterable[tuple[Expression, int]]) -> Iterator[Event]:
        for expression, place in completed:
            yield from loads((expression,))
            yield Store(expression, place)

    ends = _ends(part, held)
    yield from stores(ends.get("", ()))
    for group in groups(part.statements):
        yield from loads(e for s in group for e in operands(s))
        yield group
        yield from stores(end for s in group for n in defined(s) for end in ends.get(n, ()))


def _ends(part: Part, held: set[str]) -> dict[str, list[tuple[Expression, int]]]:
    """What is stored as soon as a value is known; as soon as there is anything for no name."""
    made = (n for s in part.statements for n in defined(s))
    number = {name: i for i, name in enumerate(made)}
    ends: dict[str, list[tuple[Expression, int]]] = {}
    for expression, place in part.stores + part.results:
        needed = [v for v in content((expression,)).values if v not in held]
        last = max(needed, key=number.__getitem__, default="")
        ends.setdefault(last, []).append((expression, place))
    return ends
