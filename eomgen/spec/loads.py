"""`gravity`, `springs`, `dampers`, `forces`, `moments`, `energy`: what drives the motion."""

from collections.abc import Callable
from typing import TypeVar

import sympy as sp

from eomgen.dimension import ENERGY, FORCE, LENGTH, NONE, TIME, Dimension
from eomgen.model import Damper, Drive, Energy, Force, Moment, Spring
from eomgen.spec.formulas import scalar, scalar_tree, tree_of, vector
from eomgen.spec.ledger import CONSEQUENCE, Mistake
from eomgen.spec.names import WORLD
from eomgen.spec.places import body_name, pair, place_name
from eomgen.spec.reader import Entry, Mapping, Node, Scalar, Sequence
from eomgen.spec.scope import Local, Scene, Wanted
from eomgen.spec.syntax import Tree, names

Load = TypeVar("Load")
By = tuple[tuple[Tree, int], ...]
POWER = ENERGY / TIME
POTENTIALS = ("stiffness", "energy", "law")
RESISTANCES = ("damping", "law")


def named(node: Node | None, noun: str) -> tuple[Entry, ...]:
    """The entries of a map, or of a list as `spring 1`, `spring 2`."""
    if isinstance(node, Mapping):
        return node.entries
    items = node.items if isinstance(node, Sequence) else ()
    return tuple(
        Entry(Scalar(f"{noun} {count}", item.line, item.column), item)
        for count, item in enumerate(items, 1)
    )


def each(
    node: Node | None, noun: str, read: Callable[[str, Mapping, Scene], Load], scene: Scene
) -> tuple[Load, ...]:
    """One record for each entry that is right."""
    found = []
    for entry in named(node, noun):
        assert isinstance(entry.value, Mapping)
        found.append(scene.ledger.attempt(read, entry.key.text, entry.value, scene))
    return tuple(load for load in found if load is not None)


def gravity(node: Node, scene: Scene) -> tuple[sp.Expr, ...]:
    """The acceleration vector."""
    return vector(node, scene, Wanted("gravity", "gravity", LENGTH / TIME**2)).components


def spring(name: str, keys: Mapping, scene: Scene) -> Spring:
    """A spring between two points or along a formula."""
    between, along, by = _path(name, keys, scene)
    given = only(name, keys, POTENTIALS)
    energy, reach = _pairing(by)
    local = Local("s", sp.Symbol(f"s ({name})", real=True), reach, by)
    inverse = tuple((tree, -power) for tree, power in by)
    twice = tuple((tree, 2 * power) for tree, power in inverse)
    wanted = {
        "stiffness": Wanted("stiffness", f"the stiffness of {name}", energy / reach**2, twice),
        "energy": Wanted("spring law", f"the energy of {name}", energy, (), local),
        "law": Wanted("spring law", f"the force of {name}", energy / reach, inverse, local),
    }
    formula = scalar(node_of(keys, given), scene, wanted[given])
    free_length = _free_length(name, keys, Wanted("free length", "", reach, by), scene)
    return Spring(name, between, along, free_length, local.symbol, **{given: formula})


def damper(name: str, keys: Mapping, scene: Scene) -> Damper:
    """A damper between two points or along a formula."""
    between, along, by = _path(name, keys, scene)
    given = only(name, keys, RESISTANCES)
    energy, reach = _pairing(by)
    local = Local("v", sp.Symbol(f"v ({name})", real=True), reach / TIME, by)
    inverse = tuple((tree, -power) for tree, power in by)
    twice = tuple((tree, 2 * power) for tree, power in inverse)
    damping = energy * TIME / reach**2
    wanted = {
        "damping": Wanted("damping", f"the damping of {name}", damping, twice),
        "law": Wanted("damper law", f"the force of {name}", energy / reach, inverse, local),
    }
    formula = scalar(node_of(keys, given), scene, wanted[given])
    return Damper(name, between, along, local.symbol, **{given: formula})


def _pairing(by: By) -> tuple[Dimension, Dimension]:
    """Energy, and the dimension of an elongation beside that of its formula."""
    return ENERGY, NONE if by else LENGTH


def _path(
    name: str, keys: Mapping, scene: Scene
) -> tuple[tuple[str, str] | None, sp.Expr | None, By]:
    """The two ends, or the formula of the elongation and its tree."""
    if only(name, keys, ("between", "along")) == "between":
        return pair(node_of(keys, "between"), scene), None, ()
    return None, *_along(name, keys, scene)


def _along(name: str, keys: Mapping, scene: Scene) -> tuple[sp.Expr, By]:
    """The formula that a load acts along, and its tree."""
    node = node_of(keys, "along")
    tree = tree_of(node, scene)
    formula = scalar_tree(tree, scene, Wanted("elongation", f"the elongation of {name}"))
    if all(scene.names[n.name].kind != "coordinate" for n in names(tree)):
        raise Mistake(node, "E510", f"'{tree.span.text}' moves with no coordinate")
    return formula, ((tree, 1),)


def _free_length(name: str, keys: Mapping, wanted: Wanted, scene: Scene) -> sp.Expr:
    """Required between points; along a formula the formula itself is the elongation."""
    node = keys.get("free_length")
    if node is None and keys.get("between") is not None:
        hint = "0 for a spring that is slack at length zero"
        code = "E110" if keys.whole else CONSEQUENCE
        raise Mistake(keys, code, f"missing key 'free_length' in {name}", hint)
    if node is None:
        return sp.S.Zero
    what = f"the free length of {name}"
    return scalar(node, scene, Wanted(wanted.use, what, wanted.dimension, wanted.by))


def only(name: str, keys: Mapping, choices: tuple[str, ...]) -> str:
    """The one of the keys that is given."""
    given = [key for key in choices if keys.get(key) is not None]
    if len(given) == 1:
        return given[0]
    code = "E112" if keys.whole else CONSEQUENCE
    options = " or ".join(f"'{choice}'" for choice in choices)
    found = f"it has {' and '.join(given)}" if given else "it has none"
    raise Mistake(keys, code, f"{name} needs {options}, {found}")


def node_of(keys: Mapping, name: str) -> Node:
    """The value of a key that is there."""
    found = keys.get(name)
    assert found is not None
    return found


def force(name: str, keys: Mapping, scene: Scene) -> Force | Drive:
    """A force on a point, or along a formula."""
    if only(name, keys, ("on", "along")) == "along":
        return _drive(name, keys, scene)
    on, source = _ends(keys, place_name, scene)
    found = vector(node_of(keys, "force"), scene, Wanted("force", name, FORCE))
    return Force(name, on, found.components, source, _axes(keys, scene))


def _drive(name: str, keys: Mapping, scene: Scene) -> Drive:
    """A force along a formula: force times its rate is a power."""
    astray = next((e.key for e in keys.entries if e.key.text in ("from", "in")), None)
    if astray is not None:
        raise Mistake(astray, "E112", f"'{astray.text}' does not go with 'along'")
    along, by = _along(name, keys, scene)
    energy, reach = _pairing(by)
    inverse = tuple((tree, -power) for tree, power in by)
    wanted = Wanted("force", name, energy / reach, inverse)
    return Drive(name, along, scalar(node_of(keys, "force"), scene, wanted))


def moment(name: str, keys: Mapping, scene: Scene) -> Moment:
    """A moment on a body."""
    if scene.space == "line":
        raise Mistake(keys, "E507", "there are no moments in space 'line'")
    on, source = _ends(keys, body_name, scene)
    node, wanted = node_of(keys, "moment"), Wanted("moment", name, ENERGY)
    if scene.space == "solid":
        components = vector(node, scene, wanted).components
    else:
        components = (scalar(node, scene, wanted),)
    return Moment(name, on, components, source, _axes(keys, scene))


def _ends(
    keys: Mapping, name_of: Callable[[Node, Scene], str], scene: Scene
) -> tuple[str, str | None]:
    source = keys.get("from")
    on = name_of(node_of(keys, "on"), scene)
    other = name_of(source, scene) if source is not None else None
    if source is not None and other == on:
        raise Mistake(source, "E507", f"'{on}' takes its own reaction")
    return on, other


def _axes(keys: Mapping, scene: Scene) -> str | None:
    node = keys.get("in")
    if node is None or (isinstance(node, Scalar) and node.text == WORLD):
        return None
    return body_name(node, scene)


def energy(node: Node | None, scene: Scene) -> Energy:
    """The terms that the author gives as formulas."""
    if not isinstance(node, Mapping):
        return Energy()
    wanted = {
        "kinetic": Wanted("kinetic energy", "the kinetic energy", ENERGY),
        "potential": Wanted("potential energy", "the potential energy", ENERGY),
        "dissipation": Wanted("dissipation", "the dissipation function", POWER),
    }
    found = {
        e.key.text: scene.ledger.attempt(scalar, e.value, scene, wanted[e.key.text])
        for e in node.entries
    }
    return Energy(**{key: value for key, value in found.items() if value is not None})
