"""What an import leaves out or changes, each kind of thing once with its first place."""

from collections.abc import Callable
from dataclasses import dataclass, field

from eomgen.spec.ledger import Spot


@dataclass(frozen=True)
class Note:
    """One line for the user."""

    line: int
    column: int
    text: str


@dataclass
class Notes:
    """Notes so far: a message of a count, where it first applied, and how often it did."""

    found: dict[str, tuple[Spot, int]] = field(default_factory=dict)

    def ignored(self, what: str, spot: Spot) -> None:
        """Something of the file has no meaning here."""
        self.add(f"{what} is ignored", spot)

    def add(self, text: str, spot: Spot) -> None:
        """Enter a note, or count one that was entered before."""
        first, count = self.found.get(text, (spot, 0))
        self.found[text] = (first, count + 1)

    def listed(self, chosen: Callable[[str], bool] = lambda text: True) -> tuple[Note, ...]:
        """All notes in the order of the file."""
        lines = [
            Note(spot.line, spot.column, text if count == 1 else f"{text} ({count} times)")
            for text, (spot, count) in self.found.items()
            if chosen(text)
        ]
        return tuple(sorted(lines, key=lambda n: (n.line, n.column)))
