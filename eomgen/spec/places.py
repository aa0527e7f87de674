"""`points` and `bodies`: where things are, and the frames that bodies carry."""

import sympy as sp

from eomgen.dimension import LENGTH, MASS, NONE
from eomgen.model import Body, Frame, Place, Point, Quaternion, Turn
from eomgen.spec import inertias, quaternions
from eomgen.spec.formulas import description, scalar, scalar_tree, tree_of, value_of, vector
from eomgen.spec.ledger import CONSEQUENCE, Mistake, shown, suggestion
from eomgen.spec.lower import is_negative
from eomgen.spec.reader import Entry, Mapping, Node, Scalar, Sequence
from eomgen.spec.scope import Scene, Wanted

AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
PLACINGS = ("at", "rod", "frame")
EXCLUDED = {  # what a key that places a body leaves no room for
    "at": ("com",),
    "rod": ("angle", "turn", "inertia", "com"),
    "frame": ("angle", "turn"),
}


def points(entries: tuple[Entry, ...], scene: Scene) -> tuple[Point, ...]:
    """All points, in the order of the file."""
    found = [scene.ledger.attempt(_point, entry, scene) for entry in entries]
    return tuple(p for p in found if p is not None)


def _point(entry: Entry, scene: Scene) -> Point:
    name = entry.key.text
    if not isinstance(entry.value, Mapping):
        return Point(name, place(entry.value, scene, f"point '{name}'"))
    on = body_name(_required(entry.value, "on"), scene)
    components = _offset(_required(entry.value, "at"), scene, f"point '{name}'")
    return Point(name, Place(components, on=on))


def place(node: Node, scene: Scene, what: str, on: str | None = None) -> Place:
    """A position: named points and components."""
    found = vector(node, scene, Wanted("position", what, LENGTH))
    return Place(found.components, found.points, on)


def _offset(node: Node, scene: Scene, what: str, use: str = "offset") -> tuple[sp.Expr, ...]:
    return vector(node, scene, Wanted(use, what, LENGTH)).components


def place_name(node: Node, scene: Scene) -> str:
    """The name of a point or a body."""
    return _name(node, scene, ("point", "body"))


def body_name(node: Node, scene: Scene) -> str:
    """The name of a body."""
    return _name(node, scene, ("body",))


def _name(node: Node, scene: Scene, kinds: tuple[str, ...]) -> str:
    assert isinstance(node, Scalar)
    known = scene.names.get(node.text)
    what = " or ".join(kinds)
    if known is None:
        fitting = [n for n, k in scene.names.items() if k.kind in kinds]
        message = f"unknown {what} {shown(node.text)}"
        code = "E301" if scene.complete else CONSEQUENCE
        raise Mistake(node, code, message, suggestion(node.text, fitting))
    if known.kind not in kinds:
        raise Mistake(node, "E306", f"'{node.text}' is a {known.kind}, a {what} is needed here")
    return node.text


def pair(node: Node, scene: Scene) -> tuple[str, str]:
    """The names of two different points or bodies."""
    assert isinstance(node, Sequence)
    first, second = (place_name(item, scene) for item in node.items)
    if first == second:
        raise Mistake(node, "E507", f"'{first}' is named twice", "name two different points")
    return first, second


def _required(node: Mapping, key: str) -> Node:
    found = node.get(key)
    assert found is not None
    return found


def bodies(entries: tuple[Entry, ...], scene: Scene) -> tuple[Body, ...]:
    """All bodies, in the order of the file."""
    found = [scene.ledger.attempt(_body, entry, scene) for entry in entries]
    return tuple(b for b in found if b is not None)


def _body(entry: Entry, scene: Scene) -> Body | None:
    """One body; every fault of its keys is entered."""
    assert isinstance(entry.value, Mapping)
    name, keys = entry.key.text, entry.value
    attempt = scene.ledger.attempt
    attempt(_check_keys, entry.key, keys, scene)
    mass = attempt(_mass, name, _required(keys, "mass"), scene)
    placed = attempt(_placed, name, keys, scene)
    node = keys.get("inertia") if scene.space != "line" else None
    inertia = attempt(inertias.inertia, name, node, scene) if node is not None else ()
    if mass is None or placed is None or inertia is None:
        return None
    frame, com = placed
    return Body(name, mass, frame, com, inertia, description(keys))


def _check_keys(name: Scalar, keys: Mapping, scene: Scene) -> None:
    """One key places the body; others must go with it and with the space."""
    given = [key for key in PLACINGS if keys.get(key) is not None]
    if len(given) != 1:
        found = f", not {' and '.join(given)}" if given else ""
        message = f"body '{name.text}' is placed by one of 'at', 'rod', 'frame'{found}"
        raise Mistake(name, "E112" if keys.whole else CONSEQUENCE, message)
    for entry in keys.entries:
        if entry.key.text in EXCLUDED[given[0]]:
            message = f"'{entry.key.text}' does not go with '{given[0]}'"
            hint = "give it inside 'frame'" if given[0] == "frame" else ""
            raise Mistake(entry.key, "E112", message, hint)
        if scene.space == "line" and entry.key.text in ("rod", "inertia"):
            raise Mistake(entry.key, "E507", "a body in space 'line' is a particle")


def _mass(name: str, node: Node, scene: Scene) -> sp.Expr:
    tree = tree_of(node, scene)
    mass = scalar_tree(tree, scene, Wanted("mass", f"the mass of '{name}'", MASS))
    value = value_of(tree, scene)
    if value is not None and is_negative(value):
        raise Mistake(node, "E504", f"the mass of '{name}' is negative")
    return mass


def _placed(name: str, keys: Mapping, scene: Scene) -> tuple[Frame, Place] | None:
    """The frame and the mass centre; None where `_check_keys` has said why."""
    at, rod, frame = (keys.get(key) for key in PLACINGS)
    if at is not None:
        where = scene.ledger.attempt(place, at, scene, f"body '{name}'")
        turns = scene.ledger.attempt(_turns, keys, scene)
        if where is None or turns is None:
            return None
        return Frame(where, turns), _origin_of(name, scene)
    if rod is not None:
        return _rod(pair(rod, scene), scene)
    return _framed(name, keys, frame, scene) if isinstance(frame, Mapping) else None


def _rod(ends: tuple[str, str], scene: Scene) -> tuple[Frame, Place]:
    zeros, half = (sp.S.Zero,) * scene.size, sp.Rational(1, 2)
    origin = Place(zeros, ((sp.S.One, ends[0]),))
    return Frame(origin, along=ends), Place(zeros, ((half, ends[0]), (half, ends[1])))


def _framed(name: str, keys: Mapping, frame: Mapping, scene: Scene) -> tuple[Frame, Place] | None:
    attempt, zeros = scene.ledger.attempt, (sp.S.Zero,) * scene.size
    on_node, at, com_node = frame.get("on"), frame.get("at"), keys.get("com")
    on = attempt(body_name, on_node, scene) if on_node is not None else None
    origin, com = Place(zeros, on=on), _origin_of(name, scene)
    if at is not None:
        origin = attempt(place, at, scene, f"the frame of '{name}'", on) or origin
    turns = attempt(_turns, frame, scene)
    if com_node is not None:
        what = f"the mass centre of '{name}'"
        offset = attempt(_offset, com_node, scene, what, "mass centre")
        com = Place(offset or zeros, on=name)
    return None if turns is None else (Frame(origin, turns), com)


def _origin_of(name: str, scene: Scene) -> Place:
    return Place((sp.S.Zero,) * scene.size, on=name)


def _turns(keys: Mapping, scene: Scene) -> tuple[Turn | Quaternion, ...]:
    """The rotations of a body: `angle` in the plane, `turn` in solid space."""
    for key, space in (("angle", "plane"), ("turn", "solid")):
        if keys.get(key) is not None and scene.space != space:
            instead = {"plane": "write 'angle'", "solid": "write 'turn'"}.get(scene.space, "")
            node = _required(keys, key)
            raise Mistake(node, "E507", f"'{key}' belongs to space '{space}'", instead)
    angle, turn = keys.get("angle"), keys.get("turn")
    if angle is not None:
        return (Turn(_axis(AXES["z"]), scalar(angle, scene, Wanted("turn", "an angle", NONE))),)
    if isinstance(turn, Mapping):
        return (quaternions.turn(turn, scene),)
    if isinstance(turn, Sequence):
        return tuple(_turn(item, scene) for item in turn.items)
    return ()


def _turn(node: Node, scene: Scene) -> Turn | Quaternion:
    if isinstance(node, Mapping):
        return quaternions.turn(node, scene)
    assert isinstance(node, Sequence)
    axis, angle = node.items
    return Turn(axis_of(axis, scene), scalar(angle, scene, Wanted("turn", "an angle", NONE)))


def axis_of(node: Node, scene: Scene) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """The axis of `z`, `-x` or `[1, 2, 2]`."""
    if isinstance(node, Scalar):
        letter = node.text.removeprefix("-").strip()
        if letter not in AXES:
            raise Mistake(node, "E507", f"{shown(node.text)} is no axis", "x, y, z or [1, 2, 2]")
        sign = -1 if node.text.startswith("-") else 1
        return _axis(tuple(sign * c for c in AXES[letter]))
    found = vector(node, scene, Wanted("axis", "an axis", None)).components
    if all(c == 0 for c in found):
        raise Mistake(node, "E507", "an axis must not be zero")
    return found[0], found[1], found[2]


def _axis(numbers: tuple[int, ...]) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    return sp.Integer(numbers[0]), sp.Integer(numbers[1]), sp.Integer(numbers[2])
