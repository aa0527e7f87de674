"""Values that several limbs have alike: computed from other leaves by the same operations.

Where a robot has four equal legs every value of a leg has three like it, whatever the numbers of
the legs are. Such values in a row can be computed side by side (superword-level parallelism:
Larsen & Amarasinghe, Exploiting superword level parallelism with multimedia instruction sets,
PLDI 2000; here rows are grown from the results down to the leaves).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from eomgen.algebra.graph import Node
from eomgen.algebra.walk import below

# what compilers do for several lanes at once: a root may set errno, a sine is a call
SIDE_BY_SIDE = frozenset(("add", "subtract", "multiply", "divide", "negate"))
COMMUTATIVE = frozenset(("add", "multiply"))
WIDEST = 16  # lanes
LEAST_SHARE = 0.25  # of all operations, saved by rows: with fewer it does not pay to move data

Row = tuple[Node, ...]
Fixed = Callable[[Node], bool]


@dataclass(frozen=True)
class Rows:
    """The rows of a function, all of one width, and when everything is computed.

    phases: of all values that move, scalars in even phases and rows in odd ones, each computed
    from the values of its own phase and the phases before.
    """

    width: int
    home: dict[Node, Row]
    operands: dict[Row, tuple[Row, ...]]
    phases: dict[Node, int]

    @property
    def packs(self) -> list[Row]:
        """What rows are computed from that are no rows themselves, each once."""
        found = dict.fromkeys(row for rows in self.operands.values() for row in rows)
        return [row for row in found if row not in self.operands]


def rows_of(results: Sequence[Node], others: Sequence[Node], fixed: Fixed) -> Rows | None:
    """The rows among the values that `results` and `others` need; None where these save little.

    fixed: whether a value is known before, so that it may be another number in every lane.
    """
    nodes = below([*results, *others], stop=fixed)
    shapes = _Shapes.of(nodes, fixed)
    best, most = None, LEAST_SHARE * sum(1 for n in nodes if n.operands and not fixed(n))
    for width in _widths(results, shapes):
        search = _Search(width, shapes, fixed)
        search.grow_from_results(results)
        if search.operands:
            search.grow_from_lanes(nodes)
        saved = (width - 1) * len(search.operands)
        if saved > most:
            best, most = search, saved
    if best is None:
        return None
    phases = _phases(nodes, best, shapes)
    return Rows(best.width, best.home, best.operands, phases)


def _widths(results: Sequence[Node], shapes: _Shapes) -> list[int]:
    """How many results are alike."""
    sizes = Counter(shapes.number[n] for n in dict.fromkeys(results)).values()
    return sorted(size for size in set(sizes) if 2 <= size <= WIDEST)


@dataclass(frozen=True)
class _Shapes:
    """How each value is computed, whatever its leaves are: equal numbers for equal ways."""

    number: dict[Node, int]
    height: dict[Node, int]

    @classmethod
    def of(cls, nodes: Iterable[Node], fixed: Fixed) -> _Shapes:
        """The shapes of nodes in order of evaluation."""
        table: dict[object, int] = {}
        number: dict[Node, int] = {}
        height: dict[Node, int] = {}
        for node in nodes:
            key: object = "fixed"
            height[node] = 0
            if not fixed(node):
                parts = [number[a] for a in node.operands]
                if node.operator in COMMUTATIVE:
                    parts.sort()
                leaf = node.datum.argument if node.operator == "read" else node.datum
                key = (node.operator, leaf, *parts)
                height[node] = 1 + max((height[a] for a in node.operands), default=0)
            number[node] = table.setdefault(key, len(table))
        return cls(number, height)


@dataclass
class _Search:
    """Rows found so far; `packs` are rows of leaves and of values that are no row."""

    width: int
    shapes: _Shapes
    fixed: Fixed
    home: dict[Node, Row] = field(default_factory=dict)
    operands: dict[Row, tuple[Row, ...]] = field(default_factory=dict)
    packs: dict[Row, None] = field(default_factory=dict)

    def grow_from_results(self, results: Sequence[Node]) -> None:
        """From the results that are alike, in their order."""
        groups: dict[int, dict[Node, None]] = defaultdict(dict)
        for node in results:
            groups[self.shapes.number[node]][node] = None
        for group in groups.values():
            if len(group) == self.width:
                self._grow(tuple(group))

    def grow_from_lanes(self, nodes: Sequence[Node]) -> None:
        """From all other values that depend on the leaves of one lane only, the highest first."""
        lanes = self._lanes()
        groups: dict[int, list[list[Node]]] = {}
        for node in nodes:
            if node in self.home or self.fixed(node) or node.operator not in SIDE_BY_SIDE:
                continue
            own = [k for k, bits in enumerate(lanes) if node.leaves & bits]
            if len(own) == 1:
                shape = self.shapes.number[node]
                groups.setdefault(shape, [[] for _ in lanes])[own[0]].append(node)
        height = self.shapes.height
        for group in sorted(groups.values(), key=lambda g: -height[next(n for r in g for n in r)]):
            if len({len(members) for members in group}) == 1:
                for row in zip(*group, strict=True):
                    self._grow(row)

    def _lanes(self) -> list[int]:
        """The leaves that belong to each lane alone, as bit sets."""
        found = [0] * self.width
        for pack in self.packs:
            for k, node in enumerate(pack):
                found[k] |= node.leaves
        seen = several = 0
        for bits in found:
            several |= seen & bits
            seen |= bits
        return [bits & ~several for bits in found]

    def _grow(self, first: Row) -> None:
        """A row with all rows that it is computed from."""
        stack = [first]
        while stack:
            row = stack.pop()
            if row in self.operands or len(set(row)) == 1:
                continue
            if not self._is_side_by_side(row):
                self.packs[row] = None
                continue
            self.operands[row] = self._operands(row)
            self.home.update((node, row) for node in row)
            stack.extend(self.operands[row])

    def _is_side_by_side(self, row: Row) -> bool:
        """Whether one operation computes a row, of which no value is in another."""
        return (
            row[0].operator in SIDE_BY_SIDE
            and len(set(row)) == len(row)
            and len({self.shapes.number[n] for n in row}) == 1
            and not any(n in self.home or self.fixed(n) for n in row)
        )

    def _operands(self, row: Row) -> tuple[Row, ...]:
        """What a row is computed from; factors and terms in the order of the first lane."""
        shape = self.shapes.number
        wanted = [shape[a] for a in row[0].operands]
        matched = [
            n.operands if [shape[a] for a in n.operands] == wanted else n.operands[::-1]
            for n in row
        ]
        return tuple(zip(*matched, strict=True))


def _phases(nodes: Iterable[Node], found: _Search, shapes: _Shapes) -> dict[Node, int]:
    """Operands have less height, and all values of a row the same."""
    phases: dict[Node, int] = {}
    for node in sorted(nodes, key=lambda n: (shapes.height[n], n.id)):
        if node in phases or found.fixed(node):
            continue
        row = found.home.get(node)
        members = (node,) if row is None else row
        if row is None:
            before = [phases[a] + phases[a] % 2 for a in node.operands if a in phases]
        else:
            before = [p for r in found.operands[row] for p in _before(r, found, phases)]
        # the least phase of the right kind that no operand comes after
        phase = max(before, default=int(row is not None))
        phases.update(dict.fromkeys(members, phase))
    return phases


def _before(operand: Row, found: _Search, phases: Mapping[Node, int]) -> Iterator[int]:
    """The first phases in which a row can be computed from an operand.

    The loop that computes a row can go on with it; values of other rows, or of several, are read
    when their loops have ended.
    """
    for node in operand:
        if node in phases:
            phase = phases[node]
            yield phase if operand in found.operands else phase + 1 + phase % 2
