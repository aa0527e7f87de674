"""`coordinates`, `speeds`, `prescribed`, `inputs`: what moves and what drives."""

from dataclasses import replace

import sympy as sp

from eomgen.dimension import NONE
from eomgen.model import TIME as T
from eomgen.model import Coordinate, Description, Input, Prescribed, Speed
from eomgen.spec import quaternions
from eomgen.spec.formulas import description, field, scalar_tree, text_of, tree_of, unit_of
from eomgen.spec.ledger import Mistake
from eomgen.spec.reader import Entry, Mapping, Node, Scalar
from eomgen.spec.scope import Known, Scene, Wanted
from eomgen.spec.syntax import Call, Name, Number, Power, Product, Quantity, Sum, Tree, Vector


def coordinates(entries: tuple[Entry, ...], scene: Scene) -> tuple[Coordinate, ...]:
    """All coordinates, in the order of the file."""
    result: list[Coordinate] = []
    for entry in entries:
        if scene.names[entry.key.text].kind == quaternions.WORD:
            result += quaternions.coordinates(entry, scene)
        elif (found := scene.ledger.attempt(_coordinate, entry, scene)) is not None:
            result.append(found)
    return tuple(result)


def _coordinate(entry: Entry, scene: Scene) -> Coordinate:
    described, known = _described(entry, scene)
    positive = text_of(field(entry.value, "positive")) == "true"
    value, rate, acceleration = known.expressions
    role = text_of(field(entry.value, "role")) or "free"
    return Coordinate(entry.key.text, value, rate, acceleration, described, role, positive)


def _described(entry: Entry, scene: Scene) -> tuple[Description, Known]:
    """What is said of a name, which gets its dimension."""
    is_unit = isinstance(entry.value, Scalar) and _formula_node(entry) is None
    node = entry.value if is_unit else field(entry.value, "unit")
    assert node is None or isinstance(node, Scalar)
    unit = unit_of(node, scene)
    known = scene.names[entry.key.text]
    if unit is not None:
        known = replace(known, dimension=unit.dimension)
        scene.names[entry.key.text] = known
    return description(entry.value, text_of(node), known), known


def _formula_node(entry: Entry) -> Node | None:
    return entry.value.get("formula") if isinstance(entry.value, Mapping) else None


def inputs(entries: tuple[Entry, ...], scene: Scene) -> tuple[Input, ...]:
    """All inputs, in the order of the file."""
    found = [scene.ledger.attempt(_input, entry, scene) for entry in entries]
    return tuple(i for i in found if i is not None)


def _input(entry: Entry, scene: Scene) -> Input:
    described, known = _described(entry, scene)
    return Input(entry.key.text, known.expressions[0], described)


def prescribed(entries: tuple[Entry, ...], scene: Scene) -> tuple[Prescribed, ...]:
    """All prescribed motions, in the order of the file."""
    found = [scene.ledger.attempt(_prescribed, entry, scene) for entry in entries]
    return tuple(p for p in found if p is not None)


def _prescribed(entry: Entry, scene: Scene) -> Prescribed:
    described, known, formula = _defined(entry, scene, "prescribed motion")
    value, rate, acceleration = known.expressions
    return Prescribed(entry.key.text, value, rate, acceleration, formula, described)


def speeds(entries: tuple[Entry, ...], scene: Scene) -> tuple[Speed, ...]:
    """All speeds; in the formulas that follow a speed stands for its own formula."""
    found = [scene.ledger.attempt(_speed, entry, scene) for entry in entries]
    kept = tuple(s for s in found if s is not None)
    count = sum(known.kind == "coordinate" for known in scene.names.values())
    count -= 4 * len(quaternions.names(scene))  # they bring their own speeds
    if entries and len(entries) != count:
        message = f"{len(entries)} speeds for {count} coordinates"
        scene.ledger.note(Mistake(entries[0].key, "E506", message, "give as many, or none"))
    for speed in kept:
        known = scene.names[speed.name]
        pair = (speed.formula, _rate(speed.formula, scene))
        scene.names[speed.name] = replace(known, expressions=pair)
    return kept


def _speed(entry: Entry, scene: Scene) -> Speed:
    described, known, formula = _defined(entry, scene, "speed")
    tree = tree_of(_formula_node(entry) or entry.value, scene)
    if _degree(tree, scene) != 1:
        message = f"speed '{entry.key.text}' must be linear in the rates"
        raise Mistake(tree.span, "E506", message)
    value, rate = known.expressions
    return Speed(entry.key.text, value, rate, formula, described)


def _defined(entry: Entry, scene: Scene, use: str) -> tuple[Description, Known, sp.Expr]:
    """Description, symbols and formula of a name that stands for a formula."""
    name = entry.key.text
    node = _formula_node(entry)
    if node is None:
        described, known = description(entry.value), scene.names[name]
    else:
        described, known = _described(entry, scene)
    tree = tree_of(node or entry.value, scene)
    wanted = Wanted(use, f"'{name}'", NONE, ((Name(name, 0, tree.span), 1),))
    return described, known, scalar_tree(tree, scene, wanted)


def _degree(tree: Tree, scene: Scene) -> int:
    """The degree in the rates as the formula is written; 2 for anything that is not linear."""
    match tree:
        case Name(name, order, _):
            return int(order > 0 and scene.names[name].kind == "coordinate")
        case Number() | Quantity():
            return 0
        case Sum(terms, _):
            return max(_degree(term, scene) for _, term in terms)
        case Product(factors, _):
            return sum(_degree(f, scene) * (1 if side > 0 else 2) for side, f in factors)
        case Power(base, exponent, _):
            return 2 * (_degree(base, scene) + _degree(exponent, scene))
        case Vector(items, _) | Call(_, items, _):
            return 2 * sum(_degree(item, scene) for item in items)


def _rate(formula: sp.Expr, scene: Scene) -> sp.Expr:
    """d/dt by the chain rule over coordinates, rates and prescribed motions."""
    chain = [(T, sp.S.One)]
    for known in scene.names.values():
        if known.kind in ("coordinate", "prescribed"):
            chain += zip(known.expressions, known.expressions[1:], strict=False)
    return sp.Add(*(sp.diff(formula, symbol) * rate for symbol, rate in chain))
