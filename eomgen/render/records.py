"""What a template lays out: functions as text, in records of text and numbers."""

from __future__ import annotations

from dataclasses import dataclass

from eomgen.render.lanes import ROWS, Wave
from eomgen.render.parts import Elimination

WORK = "work"  # the array of values that cross between the parts of a function


@dataclass(frozen=True)
class Argument:
    """A local variable `code` that holds component `index`, called `name`, of `source`.

    `member`: its name in the interface, where `source` has named components.
    """

    code: str
    source: str
    index: int
    name: str
    member: str = ""


@dataclass(frozen=True)
class Given:
    """An array that a loop over lanes reads; `fixed`: of literals."""

    name: str
    entries: tuple[str, ...]
    fixed: bool


@dataclass(frozen=True)
class Step:
    """One statement; `kind` says which fields are used.

    `assign`; `sine` or `cosine` of an expression; `pair` is a `Pair`, `require` a `Requirement`,
    `solve` a `System`, `alike` a `Loop`.
    """

    kind: str
    name: str = ""
    expression: str = ""


@dataclass(frozen=True)
class Pair(Step):
    """A sine and its cosine."""

    other: str = ""  # the name of the cosine


@dataclass(frozen=True)
class Requirement(Step):
    """What is checked of a pivot."""

    scale: str = ""


@dataclass(frozen=True)
class System(Step):
    """A linear system that is solved in a loop."""

    values: tuple[tuple[str, int], ...] = ()  # the names that are read of the solution, and where
    matrix: tuple[str, ...] = ()
    right: tuple[str, ...] = ()
    size: int = 0  # the number of equations


@dataclass(frozen=True)
class Loop(Step):
    """A loop over lanes."""

    size: int = 0  # how many there are
    given: tuple[Given, ...] = ()
    steps: tuple[Step, ...] = ()  # of kind `assign`, or `keep` in an array
    kept: tuple[str, ...] = ()  # arrays that it fills


@dataclass(frozen=True)
class Body:
    """Statements as text with all that they need: of a function, or of a part of one."""

    arguments: tuple[Argument, ...]
    steps: tuple[Step, ...]
    stores: tuple[tuple[int, str], ...]  # slots of `WORK` that are filled, and with what
    results: tuple[tuple[int, str], ...]  # where each goes, and what
    uses: tuple[str, ...]  # which of `READ` and `WORK` are read
    elimination: Elimination | None = None  # of a system behind them

    @property
    def can_fail(self) -> bool:
        """Whether a pivot is checked."""
        return any(step.kind in ("require", "solve") for step in self.steps)


@dataclass(frozen=True)
class Lanes:
    """A function for many states: its waves, and the rest in bodies over an array of `slots`.

    runs: the rows of each argument that the bodies read, from the first to before the second.
    """

    waves: tuple[Wave, ...]
    bodies: tuple[Body, ...]
    slots: int
    runs: tuple[tuple[str, int, int], ...]

    @property
    def wave_slots(self) -> int:
        """The length of `WAVES`."""
        return sum(len(w.names) for w in self.waves)

    @property
    def wave_sources(self) -> tuple[str, ...]:
        """The arguments of which there are waves."""
        return tuple(row for row in ROWS if any(w.source == row for w in self.waves))


@dataclass(frozen=True)
class Routine:
    """A function as text; if it is long, `parts` compute it over an array of `slots` numbers."""

    name: str
    about: str
    shape: tuple[int, ...]
    body: Body
    parts: tuple[Body, ...]
    lanes: Lanes | None  # of a batch
    slots: int
    size: int  # the number of results
    operators: frozenset[str]
    operations: str  # such as `3 +  5 *  1 sin`
    takes: tuple[str, ...]  # which of `ARGUMENTS` a caller passes
    uses: tuple[str, ...]  # which of these are read
    can_fail: bool  # a pivot is checked
    base: str = ""  # a function that it calls; its results follow those of the body
