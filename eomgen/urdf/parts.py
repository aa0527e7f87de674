"""The words of a URDF: what is read of each element, what is unknown, what has no meaning here.

An unknown word that looks like a known one is a fault, and so is an unknown attribute of an element
that places or weighs: to leave it out would be another robot.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from difflib import get_close_matches

from eomgen.spec.ledger import Ledger, Mistake, shown, suggestion
from eomgen.urdf.elements import Attribute, Element
from eomgen.urdf.notes import Notes
from eomgen.urdf.numbers import number
from eomgen.urdf.robot import Triple

NEAR = 0.75  # how alike a word must be to be taken for a misspelt one
TENSOR = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


@dataclass(frozen=True)
class Kind:
    """What is read of an element; `strict`: an unknown attribute cannot be left out."""

    attributes: tuple[str, ...] = ()
    once: tuple[str, ...] = ()  # children that may be there once
    many: tuple[str, ...] = ()
    strict: bool = False


KINDS = {
    "robot": Kind(("name",), many=("link", "joint")),
    "link": Kind(("name",), once=("inertial",)),
    "inertial": Kind(once=("origin", "mass", "inertia"), strict=True),
    "joint": Kind(
        ("name", "type"),
        once=("origin", "parent", "child", "axis", "limit", "dynamics", "mimic"),
    ),
    "origin": Kind(("xyz", "rpy"), strict=True),
    "mass": Kind(("value",), strict=True),
    "inertia": Kind(TENSOR, strict=True),
    "parent": Kind(("link",), strict=True),
    "child": Kind(("link",), strict=True),
    "axis": Kind(("xyz",), strict=True),
    "limit": Kind(("lower", "upper")),
    "dynamics": Kind(("damping",)),
    "mimic": Kind(("joint", "multiplier", "offset"), strict=True),
}
HARMLESS = ("xmlns", "version")  # attributes of the root that say nothing of the robot

Parts = Mapping[str, list[Element]]


@dataclass
class Book:
    """What is wrong and what is left out, so far."""

    ledger: Ledger
    notes: Notes = field(default_factory=Notes)


def parts_of(element: Element, book: Book) -> Parts:
    """The children by name; unknown ones and unknown attributes are entered or named."""
    kind = KINDS[element.name]
    known = (*kind.once, *kind.many)
    parts: dict[str, list[Element]] = {name: [] for name in known}
    for child in element.children:
        if child.name not in parts:
            book.ledger.attempt(_unknown_child, child, element.name, known, book.notes)
            continue
        if child.name in kind.once and parts[child.name]:
            message = f"a second '{child.name}' in {element}"
            book.ledger.note(Mistake(child.place, "E705", message, "remove one of them"))
        parts[child.name].append(child)
    for name, attribute in element.attributes.items():
        if name not in kind.attributes:
            book.ledger.attempt(_unknown_attribute, name, attribute, element.name, book.notes)
    return parts


def _unknown_child(child: Element, parent: str, known: tuple[str, ...], notes: Notes) -> None:
    if get_close_matches(child.name[:60], known, 1, NEAR):
        message = f"unknown element {shown(child.name)} in {parent}"
        raise Mistake(child.place, "E704", message, suggestion(child.name, known))
    notes.ignored(f"{shown(child.name)} in {parent}", child.place)


def _unknown_attribute(name: str, attribute: Attribute, owner: str, notes: Notes) -> None:
    kind = KINDS[owner]
    if kind.strict or get_close_matches(name[:60], kind.attributes, 1, NEAR):
        message = f"unknown attribute {shown(name)} of '{owner}'"
        raise Mistake(attribute.name_place, "E704", message, suggestion(name, kind.attributes))
    if owner == "robot" and name.partition(":")[0] in HARMLESS:
        return
    if owner == "dynamics" and name == "friction" and _is_zero(attribute):
        return
    notes.ignored(f"{shown(name)} of '{owner}'", attribute.name_place)


def _is_zero(attribute: Attribute) -> bool:
    return number(attribute.text.strip(), attribute.place) == 0


def text(element: Element, name: str) -> Attribute:
    """A required attribute that is not empty."""
    attribute = element.attributes.get(name)
    if attribute is None:
        raise Mistake(element.place, "E706", f"{element} has no attribute '{name}'")
    if not attribute.text.strip():
        raise Mistake(attribute.place, "E706", f"'{name}' of {element} is empty")
    return attribute


def numbers(element: Element, name: str, count: int) -> tuple[Decimal, ...]:
    """So many numbers of a required attribute."""
    attribute = text(element, name)
    words = attribute.text.split()
    if len(words) != count:
        wanted = "one number" if count == 1 else f"{count} numbers"
        message = f"'{name}' of {element} is {wanted}, not {shown(attribute.text)}"
        raise Mistake(attribute.place, "E707", message)
    return tuple(number(word, attribute.place) for word in words)


def scalar(element: Element, name: str, default: Decimal | None = None) -> Decimal:
    """One number of an attribute, which is required where there is no default."""
    if default is not None and name not in element.attributes:
        return default
    return numbers(element, name, 1)[0]


def triple(element: Element, name: str) -> Triple:
    """Three numbers of a required attribute."""
    x, y, z = numbers(element, name, 3)
    return x, y, z


def only(parts: Parts, name: str, book: Book) -> Element | None:
    """The one child of that name, its own unknown parts entered; None if it is not there."""
    if not parts[name]:
        return None
    parts_of(parts[name][0], book)
    return parts[name][0]


def needed(element: Element, parts: Parts, name: str, book: Book) -> Element:
    """As `only`; raises `Mistake` if it is not there."""
    found = only(parts, name, book)
    if found is None:
        raise Mistake(element.place, "E706", f"{element} has no '{name}'")
    return found
