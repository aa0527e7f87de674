"""Elements -> Robot: every wrong one is entered, every one without meaning here is named."""

from collections.abc import Callable
from decimal import Decimal
from typing import TypeVar

from eomgen.spec.ledger import Mistake, shown, suggestion
from eomgen.urdf.elements import Element
from eomgen.urdf.parts import TENSOR, Book, Parts, needed, only, parts_of, scalar, text, triple
from eomgen.urdf.robot import (
    JOINTS,
    SINGLE,
    ZERO,
    Angle,
    Inertial,
    Joint,
    Link,
    Mimic,
    Origin,
    Robot,
    Triple,
)

MOST_LINKS = 400
X = (Decimal(1), ZERO, ZERO)  # the axis where none is given
WITHOUT_MEANING = {  # kind of joint -> its elements that say nothing
    "fixed": ("axis", "limit", "dynamics", "mimic"),
    "floating": ("axis", "limit", "dynamics", "mimic"),
    "planar": ("limit", "dynamics", "mimic"),
}
Read = TypeVar("Read")


def robot(root: Element, book: Book) -> Robot:
    """The robot as far as the file is right; what is wrong is in the book."""
    if root.name != "robot":
        hint = "run xacro first" if "xacro" in root.name else ""
        raise Mistake(root.place, "E703", f"the root is '{root.name}', not 'robot'", hint)
    if any(child.name.startswith("xacro:") for child in root.children):
        message = "this is a xacro file, a URDF with macros"
        raise Mistake(root.place, "E703", message, "run 'xacro robot.xacro > robot.urdf' first")
    parts = parts_of(root, book)
    name = root.attributes.get("name")
    if len(parts["link"]) > MOST_LINKS:
        raise Mistake(root.place, "E702", f"more than {MOST_LINKS} links")
    links = _each(_link, parts["link"], book)
    joints = _each(_joint, parts["joint"], book)
    for records in (parts["link"], parts["joint"]):
        _check_different(records, book)
    return Robot(name.text if name else "", links, joints)


def _each(
    read: Callable[[Element, Book], Read], elements: list[Element], book: Book
) -> tuple[Read, ...]:
    found = (book.ledger.attempt(read, element, book) for element in elements)
    return tuple(record for record in found if record is not None)


def _check_different(elements: list[Element], book: Book) -> None:
    """Two links, or two joints, of one name are entered."""
    seen: set[str] = set()
    for element in elements:
        name = element.attributes.get("name")
        if name is None:
            continue
        if name.text in seen:
            message = f"there are two of {element}"
            book.ledger.note(Mistake(name.place, "E709", message, "rename one of them"))
        seen.add(name.text)


def _origin(parts: Parts, book: Book) -> Origin:
    element = only(parts, "origin", book)
    if element is None:
        return Origin()
    xyz = triple(element, "xyz") if "xyz" in element.attributes else (ZERO, ZERO, ZERO)
    if "rpy" not in element.attributes:
        return Origin(xyz)
    place = element.attributes["rpy"].place
    return Origin(xyz, tuple(Angle(value, place) for value in triple(element, "rpy")))


def _link(element: Element, book: Book) -> Link:
    parts = parts_of(element, book)
    name = text(element, "name").text
    if not parts["inertial"]:
        return Link(name, element.place)
    inertial = book.ledger.attempt(_inertial, name, parts["inertial"][0], book)
    return Link(name, element.place, inertial)


def _inertial(link: str, element: Element, book: Book) -> Inertial:
    parts = parts_of(element, book)
    origin = _origin(parts, book)
    mass = needed(element, parts, "mass", book)
    tensor = needed(element, parts, "inertia", book)
    value = scalar(mass, "value")
    if value < 0:
        raise Mistake(mass.attributes["value"].place, "E713", f"the mass of '{link}' is negative")
    entries = tuple(scalar(tensor, name) for name in TENSOR)
    return Inertial(origin, value, entries, tensor.place)


def _joint(element: Element, book: Book) -> Joint:
    parts = parts_of(element, book)
    name, kind = text(element, "name").text, _kind(element)
    for useless in WITHOUT_MEANING.get(kind, ()):
        for child in parts.get(useless, ()):
            book.notes.ignored(f"'{useless}' of a {kind} joint", child.place)
    parts = {n: [] if n in WITHOUT_MEANING.get(kind, ()) else c for n, c in parts.items()}
    attempt = book.ledger.attempt
    return Joint(
        name,
        kind,
        element.place,
        parent=text(needed(element, parts, "parent", book), "link").text,
        child=text(needed(element, parts, "child", book), "link").text,
        origin=attempt(_origin, parts, book) or Origin(),
        axis=attempt(_axis, kind, parts, book) or X,
        limit=attempt(_limit, kind, parts, book),
        damping=attempt(_damping, parts, book) or ZERO,
        mimic=attempt(_mimic, parts, book),
    )


def _kind(element: Element) -> str:
    attribute = text(element, "type")
    if attribute.text not in JOINTS:
        message = f"unknown type {shown(attribute.text)} of {element}"
        raise Mistake(attribute.place, "E708", message, suggestion(attribute.text, JOINTS))
    return attribute.text


def _axis(kind: str, parts: Parts, book: Book) -> Triple:
    element = only(parts, "axis", book)
    if element is None:
        return X
    axis = triple(element, "xyz")
    if not any(axis):
        raise Mistake(element.attributes["xyz"].place, "E712", "an axis must not be zero")
    if kind == "planar" and sum(c != 0 for c in axis) > 1:
        message = "a planar joint is normal to x, y or z: else nobody says which way it slides"
        hint = "turn the joint's 'origin' instead"
        raise Mistake(element.attributes["xyz"].place, "E712", message, hint)
    return axis


def _limit(kind: str, parts: Parts, book: Book) -> tuple[Decimal, Decimal] | None:
    """Lower and upper [rad or m]; none where they leave no room or the joint turns for ever."""
    element = only(parts, "limit", book)
    if element is None:
        return None
    if parts["mimic"]:
        book.notes.ignored("'limit' of a joint that follows another", element.place)
        return None
    given = [name for name in ("lower", "upper") if name in element.attributes]
    if kind == "continuous":
        for name in given:
            book.notes.ignored(f"'{name}' of a continuous joint", element.attributes[name].place)
        return None
    lower, upper = scalar(element, "lower", ZERO), scalar(element, "upper", ZERO)
    if lower > upper:
        message = f"'lower' is {lower}, more than 'upper', which is {upper}"
        raise Mistake(element.place, "E714", message)
    if lower == upper and given:
        book.notes.add("limits that leave no room are not taken as a range", element.place)
    return (lower, upper) if lower < upper else None


def _damping(parts: Parts, book: Book) -> Decimal:
    element = only(parts, "dynamics", book)
    if element is None:
        return ZERO
    damping = scalar(element, "damping", ZERO)
    if damping < 0:
        place = element.attributes["damping"].place
        raise Mistake(place, "E713", "a damping must not be negative")
    return damping


def _mimic(parts: Parts, book: Book) -> Mimic | None:
    element = only(parts, "mimic", book)
    if element is None:
        return None
    multiplier = scalar(element, "multiplier", Decimal(1))
    if not multiplier:
        place = element.attributes["multiplier"].place
        raise Mistake(place, "E715", "a multiplier of zero", "make the joint fixed")
    return Mimic(
        text(element, "joint").text,
        element.place,
        multiplier,
        scalar(element, "offset", ZERO),
    )


assert set(SINGLE).isdisjoint(WITHOUT_MEANING)
