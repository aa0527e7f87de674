"""What the rest of a file says of its constraints: roles of coordinates, guesses, speeds."""

from collections.abc import Iterator

from eomgen.spec import quaternions
from eomgen.spec.formulas import field
from eomgen.spec.language import LANGUAGE
from eomgen.spec.ledger import Mistake
from eomgen.spec.reader import Entry, Mapping, Node, Scalar, Sequence
from eomgen.spec.scope import Scene
from eomgen.spec.structure import is_misspelt

OTHER_KINDS = ("nonholonomic", "unilateral")
TOUCHING = ("unilateral", "friction")


def check(whole: Mapping, root: Mapping, scene: Scene) -> None:
    """Enter what needs constraints and has none, and what does not go with them.

    The whole file says what the author meant, so that a wrong constraint is one fault only.
    """
    are_there = is_misspelt("constraints", whole, LANGUAGE.keys) or bool(_given(whole))
    for mistake in (
        *_roles(root, _has_holonomic(whole)),
        *_guesses(root, are_there),
        *_speeds(root, whole),
        *_quaternions(root, are_there),
    ):
        scene.ledger.note(mistake)


def _given(whole: Mapping) -> tuple[Node, ...]:
    """The constraints as they stand in the file, whatever their shape."""
    node = whole.get("constraints")
    match node:
        case None:
            return ()
        case Mapping():
            return tuple(entry.value for entry in node.entries)
        case Sequence():
            return node.items
    return (node,)


def _has_holonomic(whole: Mapping) -> bool:
    """Whether one may be holonomic; what is misspelt may be."""
    return is_misspelt("constraints", whole, LANGUAGE.keys) or any(
        not isinstance(node, Mapping)
        or node.get("holonomic") is not None
        or all(node.get(kind) is None for kind in OTHER_KINDS)
        for node in _given(whole)
    )


def _roles(root: Mapping, has_holonomic: bool) -> Iterator[Mistake]:
    """A linked coordinate needs a holonomic constraint, and the other way round."""
    roles = [
        role for entry in _entries(root, "coordinates") if (role := field(entry.value, "role"))
    ]
    linked = [role for role in roles if role.text == "linked"]
    if not has_holonomic:
        hint = "write a 'holonomic' constraint, or leave the role out"
        message = "a linked coordinate needs a holonomic constraint"
        yield from (Mistake(role, "E513", message, hint) for role in linked)
    elif roles and not linked:
        message = "a coordinate is 'free', but none is 'linked' beside a holonomic constraint"
        hint = "write 'role: linked' for each dependent coordinate, or leave all roles out"
        yield Mistake(roles[0], "E513", message, hint)


def _guesses(root: Mapping, are_there: bool) -> Iterator[Mistake]:
    for entry in _entries(root, "initial"):
        if entry.key.text == "guess" and not isinstance(entry.value, Scalar) and not are_there:
            message = "a guess is for what constraints decide, and there are none"
            yield Mistake(entry.key, "E513", message, "write it as an initial value")


def _speeds(root: Mapping, whole: Mapping) -> Iterator[Mistake]:
    """Contacts are written over the rates."""
    touching = any(
        isinstance(node, Mapping) and any(node.get(key) is not None for key in TOUCHING)
        for node in _given(whole)
    )
    for entry in root.entries:
        if entry.key.text == "speeds" and touching:
            message = "not supported: speeds beside unilateral constraints or friction"
            hint = "leave 'speeds' out and write the equations in the rates"
            yield Mistake(entry.key, "E602", message, hint)


def _quaternions(root: Mapping, are_there: bool) -> Iterator[Mistake]:
    for entry in _entries(root, "coordinates") if are_there else ():
        if quaternions.is_quaternion(entry.value):
            message = "not supported yet: a quaternion beside constraints"
            yield Mistake(entry.key, "E602", message, "turn by angles")


def _entries(root: Mapping, section: str) -> tuple[Entry, ...]:
    table = root.get(section)
    return table.entries if isinstance(table, Mapping) else ()
