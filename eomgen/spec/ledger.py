"""The faults of one file, gathered while reading goes on."""

from collections.abc import Callable, Iterable
from difflib import get_close_matches
from typing import ParamSpec, Protocol, TypeVar

from eomgen.errors import Fault, Location, SpecError

CONSEQUENCE = ""  # the code of what is wrong because something else is, which has its own fault
MOST_FAULTS = 100  # nobody reads more, and a hostile file could ask for millions

Result = TypeVar("Result")
Arguments = ParamSpec("Arguments")


class Spot(Protocol):
    """Anything with a line and a column, both counted from 1."""

    @property
    def line(self) -> int:
        """The line."""

    @property
    def column(self) -> int:
        """The column."""


class Mistake(Exception):
    """One fault on its way to the ledger; `attempt` catches it."""

    def __init__(self, spot: Spot, code: str, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.spot, self.code, self.message, self.hint = spot, code, message, hint


class Ledger:
    """Every fault of the file so far."""

    def __init__(self, file: str, lines: tuple[str, ...]) -> None:
        self.file, self.lines = file, lines
        self.faults: list[Fault] = []

    def note(self, mistake: Mistake) -> None:
        """Enter one fault, unless it only follows from another or the book is full."""
        if mistake.code == CONSEQUENCE:
            return
        line, column = mistake.spot.line, mistake.spot.column
        source = self.lines[line - 1] if line <= len(self.lines) else ""
        fault = Fault(
            Location(self.file, line, column), mistake.code, mistake.message, mistake.hint, source
        )
        if len(self.faults) < MOST_FAULTS and fault not in self.faults:
            self.faults.append(fault)

    def attempt(
        self,
        function: Callable[Arguments, Result],
        *arguments: Arguments.args,
        **named: Arguments.kwargs,
    ) -> Result | None:
        """The function's result; None when it raised a `Mistake`, which is entered."""
        try:
            return function(*arguments, **named)
        except Mistake as mistake:
            self.note(mistake)
            return None

    def close(self) -> None:
        """Raise all faults at once, if there is any."""
        if self.faults:
            raise SpecError(tuple(self.faults))


def suggestion(word: str, known: Iterable[str]) -> str:
    """`did you mean 'mass'?` for the nearest known word; else the words that are known."""
    words = list(dict.fromkeys(known))
    near = get_close_matches(word[:60], words, 1, 0.6)
    if near:
        return f"did you mean '{near[0]}'?"
    return f"known here: {', '.join(words)}" if 0 < len(words) <= 24 else ""


def shown(text: str) -> str:
    """The text in quotes on one line, cut where it is long."""
    flat = " ".join(text.split())
    return f"'{flat}'" if len(flat) <= 60 else f"'{flat[:57]}...'"
