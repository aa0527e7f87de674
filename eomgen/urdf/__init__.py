"""URDF (Unified Robot Description Format) -> the text of a spec that describes the same robot.

text -> elements -> Robot -> tree -> scene -> text of the spec
"""

from dataclasses import dataclass
from pathlib import PurePath

from eomgen import spec
from eomgen.errors import Fault, Location, SpecError
from eomgen.spec.ledger import Ledger
from eomgen.urdf import angles, build, elements, reading, tree, writing
from eomgen.urdf.notes import Note
from eomgen.urdf.parts import Book
from eomgen.urdf.robot import Robot
from eomgen.urdf.wishes import Wishes

PAST_A_LIMIT = ("E102", "E108")


@dataclass(frozen=True)
class Imported:
    """The text of a spec, and what of the robot is not in it."""

    text: str
    notes: tuple[Note, ...]


def imported(data: bytes, file: str, wishes: Wishes) -> Imported:
    """The spec of a URDF.

    Raises:
        SpecError: the file has mistakes, all are listed.
    """
    book = Book(Ledger(file, ()))
    robot = _robot(data, book)
    if wishes.within is not None:
        robot = angles.rounded(robot, wishes.within, book.notes)
    angles.point_out(robot, book.notes)
    base = "floating" if wishes.floating_base else "fixed"
    scene = build.scene(tree.of(robot, base, book.ledger), book, wishes)
    notes = book.notes.listed()
    made = writing.spec(scene, robot.name, _remarks(file, notes))
    _check(made, file)
    return Imported(made, notes)


def _robot(data: bytes, book: Book) -> Robot:
    """The robot of a file; raises `SpecError` with all faults of its words and numbers."""
    ledger = book.ledger
    text = ledger.attempt(elements.decode, data)
    if text is not None:
        ledger.lines = elements.lines_of(text)
        root = ledger.attempt(elements.read_tree, text)
        found = None if root is None else ledger.attempt(reading.robot, root, book)
    ledger.close()
    assert found is not None
    return found


def _remarks(file: str, notes: tuple[Note, ...]) -> list[str]:
    return [
        f"Imported from {PurePath(file).name}.",
        *(f"Line {note.line}: {note.text}." for note in notes),
    ]


def _check(made: str, file: str) -> None:
    """The spec must read back: a robot may be too large for one, any other defect is ours.

    Raises:
        SpecError: the spec is past a limit of the language.
    """
    try:
        spec.read(made, file)
    except SpecError as error:
        if all(fault.code in PAST_A_LIMIT for fault in error.faults):
            message = f"the robot is too large: {error}"
            raise SpecError((Fault(Location(file, 1, 1), "E702", message),)) from error
        raise AssertionError(f"the spec made from {file} does not read back: {error}") from error
