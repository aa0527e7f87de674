"""The order of statements that keeps few values alive: for many states at once.

There the states fill the vectors and nothing waits long for anything, but every value that finds no
register is written to memory and read again. List scheduling from the results back to the leaves:
of all statements whose readers are placed, the one is next that needs the fewest values beside
those that are alive already; among equals, the one whose value was asked for last. (Goodman and
Hsu, Code scheduling and register allocation in large basic blocks, ICS 1988, go forward by the
same rule.)
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from heapq import heappop, heappush

from eomgen.program import Statement
from eomgen.render.lowered import Content, Lowered, defined
from eomgen.render.pairs import groups


def sparing(lowered: Lowered) -> Lowered:
    """The same function with its statements in such an order; a sine stays with its cosine."""
    statements = lowered.function.statements
    contents = dict(zip(map(id, statements), lowered.contents, strict=True))
    together = list(groups(statements))
    order = _Order.of(together, contents, lowered.results).placed()
    placed = [s for i in reversed(order) if i < len(together) for s in together[i]]
    function = replace(lowered.function, statements=tuple(placed))
    return Lowered(function, tuple(contents[id(s)] for s in placed), lowered.results)


@dataclass
class _Order:
    """What each group reads and gives, and who waits; the last number is that of the results."""

    operands: list[list[int]]
    gives: list[int]  # values
    readers: list[int]  # that are not placed
    users: dict[int, list[int]]
    asked: dict[int, int] = field(default_factory=dict)  # when a value was asked for last
    ready: list[tuple[int, int, int]] = field(default_factory=list)

    @classmethod
    def of(
        cls,
        together: Sequence[tuple[Statement, ...]],
        contents: dict[int, Content],
        results: Content,
    ) -> _Order:
        """Groups of statements and the results, nothing placed yet."""
        made = [[n for s in group for n in defined(s)] for group in together]
        home = {name: i for i, names in enumerate(made) for name in names}
        reads = [[v for s in group for v in contents[id(s)].values] for group in together]
        operands = [
            [k for k in dict.fromkeys(home[v] for v in values) if k != i]
            for i, values in enumerate([*reads, results.values])
        ]
        users: dict[int, list[int]] = defaultdict(list)
        for i, below in enumerate(operands):
            for k in below:
                users[k].append(i)
        readers = [len(users[i]) for i in range(len(operands))]
        return cls(operands, [*map(len, made), 0], readers, users)

    def placed(self) -> list[int]:
        """The numbers, from the last to the first."""
        for i, count in enumerate(self.readers):
            if not count:
                self.offer(i)
        done: dict[int, None] = {}
        while self.ready:
            growth, recency, negative = heappop(self.ready)
            number = -negative
            if number in done or (growth, recency) != self.urgency(number):
                continue
            done[number] = None
            self.ask(number, len(done))
        return list(done)

    def urgency(self, number: int) -> tuple[int, int]:
        """How many more values are alive before it than behind it, and how long it waits."""
        opened = sum(self.gives[k] for k in self.operands[number] if k not in self.asked)
        closed = self.gives[number] if number in self.asked else 0
        return opened - closed, -self.asked.get(number, -1)

    def offer(self, number: int) -> None:
        """All that read it are placed; what is offered again counts as it was offered last."""
        heappush(self.ready, (*self.urgency(number), -number))

    def ask(self, number: int, time: int) -> None:
        """Its operands are alive from here on backward."""
        for k in self.operands[number]:
            is_new = k not in self.asked
            self.asked[k] = time
            self.readers[k] -= 1
            if not self.readers[k]:
                self.offer(k)
            for other in self.users[k] if is_new else ():
                if not self.readers[other]:
                    self.offer(other)
