"""`constraints`: relations that the coordinates keep, as residuals or as two places set equal."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import sympy as sp

from eomgen.dimension import NONE
from eomgen.model import Body, Constraint, Place, Point
from eomgen.spec import cycles, lower
from eomgen.spec.formula import parse_relation
from eomgen.spec.formulas import description, field, residual, scalar, tree_of, value_of
from eomgen.spec.ledger import CONSEQUENCE, Mistake
from eomgen.spec.loads import named, only
from eomgen.spec.names import check, check_spelling
from eomgen.spec.reader import Entry, Mapping, Node, Scalar
from eomgen.spec.scope import Known, Scene, Wanted, resolve
from eomgen.spec.syntax import Name, Relation

SIGNS = {"holonomic": ("=",), "nonholonomic": ("=",), "unilateral": (">=", "<=")}
ONE_SIDED = ("restitution", "friction")
BOUNDS = {"restitution": (0, 1), "friction": (0, sp.oo)}


@dataclass(frozen=True)
class Places:
    """All points and bodies of the file."""

    points: tuple[Point, ...]
    bodies: tuple[Body, ...]


def constraints(node: Node | None, places: Places, scene: Scene) -> tuple[Constraint, ...]:
    """All constraints, in the order of the file; a list gets names of its own."""
    found = []
    for entry in named(node, "constraint"):
        if isinstance(node, Mapping):
            scene.ledger.attempt(check_spelling, entry.key)
        found.append(scene.ledger.attempt(_constraint, entry, places, scene))
    return tuple(c for c in found if c is not None)


def _constraint(entry: Entry, places: Places, scene: Scene) -> Constraint:
    """One constraint; every fault of its options is entered."""
    assert isinstance(entry.value, Mapping)
    name, keys = entry.key.text, entry.value
    options = {key: scene.ledger.attempt(_option, key, name, keys, scene) for key in ONE_SIDED}
    reaction = scene.ledger.attempt(_reaction, keys, scene)
    kind = only(name, keys, tuple(SIGNS))
    node = field(keys, kind)
    assert node is not None
    relation = _relation(node, kind)
    ends = _ends(relation, scene) if kind == "holonomic" else None
    if ends is None:
        residuals = (CHECKED[kind](relation, node, scene),)
    else:
        residuals = ()
        _check_moving(ends, node, places, scene)
    text = " ".join(node.text.split())
    described = description(keys)
    return Constraint(name, kind, residuals, text, ends, reaction, **options, description=described)


def _relation(node: Scalar, kind: str) -> Relation:
    """The two sides, if the sign between them goes with the kind."""
    found = parse_relation(node)
    if found.sign not in SIGNS[kind]:
        fitting = "unilateral" if found.sign != "=" else "holonomic"
        wanted = " or ".join(f"'{sign}'" for sign in SIGNS[kind])
        message = f"a {kind} constraint has {wanted}, not '{found.sign}'"
        raise Mistake(found.span, "E205", message, f"write '{fitting}' for '{found.sign}'")
    return found


def _ends(relation: Relation, scene: Scene) -> tuple[str, str] | None:
    """The two places of `C = Cr`; None for an equation between scalars."""
    where = lower.Lowering(scene, "coincidence")
    sides = (relation.left, relation.right)
    if not any(lower.is_vector(side, where) for side in sides):
        return None
    for side in sides:
        if not isinstance(side, Name):
            message = f"only named places are set equal, '{side.span.text}' is none"
            hint = "name it under 'points', or write one equation for each component"
            raise Mistake(side.span, "E502", message, hint)
        resolve(side, scene, "coincidence")
    first, second = (side.name for side in sides if isinstance(side, Name))
    if first == second:
        message = f"'{first}' is set equal to itself"
        raise Mistake(relation.span, "E507", message, "name two different points")
    return first, second


def _check_moving(ends: tuple[str, str], node: Scalar, places: Places, scene: Scene) -> None:
    """Raise `Mistake` where no coordinate moves either end; a faulty place may be moving."""
    graph = cycles.needs(places.points, places.bodies)
    formulas = _formulas(places)
    waiting: list[cycles.Vertex] = [("place", end) for end in ends]
    seen = set(waiting)
    while waiting:
        vertex = waiting.pop()
        if vertex not in graph or any(_holds(f, "coordinate", scene) for f in formulas[vertex]):
            return
        waiting += (v := [n for n in dict.fromkeys(graph[vertex]) if n not in seen])
        seen.update(v)
    message = f"no coordinate moves '{ends[0]}' or '{ends[1]}'"
    raise Mistake(node, "E510", message, "a constraint is a relation between coordinates")


def _formulas(places: Places) -> dict[cycles.Vertex, tuple[sp.Expr, ...]]:
    """The formulas that each place and each frame is placed by."""
    found = {("place", p.name): tuple(_of(p.place)) for p in places.points}
    for body in places.bodies:
        angles = tuple(turn.angle for turn in body.frame.turns)
        found["frame", body.name] = (*_of(body.frame.origin), *angles)
        found["place", body.name] = tuple(_of(body.com))
    return found


def _of(place: Place) -> Iterator[sp.Expr]:
    yield from place.components
    yield from (coefficient for coefficient, _ in place.points)


def _symbols(kind: str, order: int, scene: Scene) -> set[sp.Symbol]:
    return {k.expressions[order] for k in scene.names.values() if k.kind == kind}


def _holds(formula: sp.Expr, kind: str, scene: Scene) -> bool:
    return bool(formula.free_symbols & _symbols(kind, 0, scene))


def _of_positions(relation: Relation, node: Scalar, scene: Scene) -> sp.Expr:
    """left - right of positions, which must hold a coordinate."""
    use = "holonomic constraint" if relation.sign == "=" else "unilateral constraint"
    found = residual(relation, scene, Wanted(use, f"a {use}"))
    if not _holds(found, "coordinate", scene):
        message = f"'{relation.span.text}' holds no coordinate, so it constrains nothing"
        raise Mistake(node, "E510", message, "a constraint is a relation between coordinates")
    return found


def _of_rates(relation: Relation, node: Scalar, scene: Scene) -> sp.Expr:
    """left - right, which must hold a rate and be linear in the rates: d^2/dx'dy' = 0."""
    use = "nonholonomic constraint"
    found = residual(relation, scene, Wanted(use, f"a {use}"))
    rates = found.free_symbols & _symbols("coordinate", 1, scene)
    if not rates:
        message = f"'{relation.span.text}' holds no rate"
        hint = "write 'holonomic' for a relation between coordinates"
        raise Mistake(node, "E511", message, hint)
    for rate in sorted(rates, key=str):
        if found.diff(rate).free_symbols & rates:
            message = f"'{relation.span.text}' is not linear in {rate}"
            hint = "write it with the rates to the first power, coefficients of coordinates and t"
            raise Mistake(node, "E511", message, hint)
    return found


CHECKED: dict[str, Callable[[Relation, Scalar, Scene], sp.Expr]] = {
    "holonomic": _of_positions,
    "nonholonomic": _of_rates,
    "unilateral": _of_positions,
}


def _reaction(keys: Mapping, scene: Scene) -> str | None:
    """The name of the constraint force, which is taken from here on."""
    node = field(keys, "reaction")
    if node is None:
        return None
    scene.names[check(node, scene.names).text] = Known("reaction", (), None, node)
    return node.text


def _option(key: str, name: str, keys: Mapping, scene: Scene) -> sp.Expr | None:
    """The number of a unilateral constraint under the key, within its bounds."""
    entry = next((e for e in keys.entries if e.key.text == key), None)
    if entry is None:
        return None
    if keys.get("unilateral") is None:
        code = "E112" if keys.whole else CONSEQUENCE
        raise Mistake(entry.key, code, f"'{key}' goes with 'unilateral' only")
    found = scalar(entry.value, scene, Wanted(key, f"the {key} of {name}", NONE))
    value = value_of(tree_of(entry.value, scene), scene)
    least, most = BOUNDS[key]
    if value is not None and ((value - least).is_negative or (value - most).is_positive):
        bounds = f"between {least} and {most}" if most != sp.oo else "not negative"
        raise Mistake(entry.value, "E512", f"the {key} of {name} is {bounds}, not {value}")
    return found
