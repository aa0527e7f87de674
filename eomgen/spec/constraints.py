"""`constraints`: relations that the coordinates keep, as residuals or as two places set equal."""

import math
from collections.abc import Callable

import sympy as sp

from eomgen.dimension import NONE
from eomgen.model import Constraint
from eomgen.spec import lower
from eomgen.spec.formula import parse_relation
from eomgen.spec.formulas import description, field, residual, scalar, tree_of, value_of
from eomgen.spec.ledger import CONSEQUENCE, Mistake
from eomgen.spec.loads import named, only
from eomgen.spec.names import check, check_spelling
from eomgen.spec.reader import Entry, Mapping, Node, Scalar
from eomgen.spec.scope import Known, Scene, Wanted, resolve
from eomgen.spec.syntax import Name, Relation

SIGNS = {"holonomic": ("=",), "nonholonomic": ("=",), "unilateral": (">=", "<=")}
INSTEAD = {  # of a sign that does not go with the kind
    "holonomic": "write 'unilateral' for a one-sided relation",
    "nonholonomic": "a relation between rates is an equation",
    "unilateral": "write 'holonomic' for an equation",
}
GOES_WITH = {"restitution": ("unilateral",), "friction": ("unilateral", "holonomic")}
RELATES = "a constraint is a relation between coordinates"
BOUNDS = {"restitution": (0, 1), "friction": (0, sp.oo)}


def constraints(node: Node | None, movers: frozenset[str], scene: Scene) -> tuple[Constraint, ...]:
    """All constraints, in the order of the file; a list gets names of its own."""
    found = []
    for entry in named(node, "constraint"):
        if isinstance(node, Mapping):
            scene.ledger.attempt(check_spelling, entry.key)
        found.append(scene.ledger.attempt(_constraint, entry, movers, scene))
    return tuple(c for c in found if c is not None)


def _constraint(entry: Entry, movers: frozenset[str], scene: Scene) -> Constraint:
    """One constraint; every fault of its options is entered."""
    assert isinstance(entry.value, Mapping)
    name, keys = entry.key.text, entry.value
    kind = only(name, keys, tuple(SIGNS))
    node = field(keys, kind)
    assert node is not None
    options = {key: scene.ledger.attempt(_option, key, name, keys, scene) for key in GOES_WITH}
    reaction = scene.ledger.attempt(_reaction, keys, scene)
    relation = _relation(node, kind)
    ends = _ends(relation, movers, scene) if kind == "holonomic" else None
    if ends and options["friction"] is not None:
        _refuse_rough_pin(keys)
    residuals = () if ends else (RESIDUALS[kind](relation, scene),)
    text, said = " ".join(node.text.split()), description(keys)
    return Constraint(name, kind, residuals, text, ends, reaction, **options, description=said)


def _refuse_rough_pin(keys: Mapping) -> None:
    """A pin has no surface."""
    entry = next(e for e in keys.entries if e.key.text == "friction")
    message = "'friction' needs a surface, and places that are set equal have none"
    hint = "write one relation between positions, or a moment for the friction of a bearing"
    raise Mistake(entry.key, "E112", message, hint)


def _relation(node: Scalar, kind: str) -> Relation:
    """The two sides, if the sign between them goes with the kind."""
    found = parse_relation(node)
    if found.sign not in SIGNS[kind]:
        wanted = " or ".join(f"'{sign}'" for sign in SIGNS[kind])
        message = f"a {kind} constraint has {wanted}, not '{found.sign}'"
        raise Mistake(found.span, "E205", message, INSTEAD[kind])
    return found


def _ends(relation: Relation, movers: frozenset[str], scene: Scene) -> tuple[str, str] | None:
    """The two places of `C = Cr`; None for an equation between scalars."""
    where = lower.Lowering(scene, "equation of places")
    sides = (relation.left, relation.right)
    if not any(lower.is_vector(side, where) for side in sides):
        return None
    for side in sides:
        if not isinstance(side, Name):
            message = f"only named places are set equal, '{side.span.text}' is none"
            hint = "name it under 'points', or write one equation for each component"
            raise Mistake(side.span, "E502", message, hint)
        resolve(side, scene, "equation of places")
    first, second = (side.name for side in sides if isinstance(side, Name))
    if first == second:
        message = f"'{first}' is set equal to itself"
        raise Mistake(relation.span, "E507", message, "name two different points")
    if not {first, second} & movers:
        message = f"no coordinate moves '{first}' or '{second}'"
        raise Mistake(relation.span, "E510", message, RELATES)
    return first, second


def _among(formula: sp.Expr, order: int, scene: Scene) -> list[sp.Symbol]:
    """The coordinates, or their rates, that a formula holds, as they are declared."""
    known = [k.expressions[order] for k in scene.names.values() if k.kind == "coordinate"]
    held = formula.free_symbols
    return [symbol for symbol in known if symbol in held]


def _of_positions(relation: Relation, scene: Scene) -> sp.Expr:
    """left - right of positions, which must hold a coordinate."""
    use = "holonomic constraint" if relation.sign == "=" else "unilateral constraint"
    found = residual(relation, scene, Wanted(use, f"a {use}"))
    if not _among(found, 0, scene):
        message = f"'{relation.span.text}' holds no coordinate, so it constrains nothing"
        raise Mistake(relation.span, "E510", message, RELATES)
    return found


def _of_rates(relation: Relation, scene: Scene) -> sp.Expr:
    """left - right, which must hold a rate and be linear in the rates."""
    use = "nonholonomic constraint"
    found = residual(relation, scene, Wanted(use, f"a {use}"))
    rates = _among(found, 1, scene)
    if not rates:
        message = f"'{relation.span.text}' holds no rate"
        hint = "write 'holonomic' for a relation between coordinates"
        raise Mistake(relation.span, "E511", message, hint)
    if not _is_linear(found, set(rates)):
        message = f"'{relation.span.text}' is not linear in the rates"
        hint = "write it with the rates to the first power, coefficients of coordinates and t"
        raise Mistake(relation.span, "E511", message, hint)
    return found


def _is_linear(formula: sp.Expr, rates: set[sp.Symbol]) -> bool:
    """Whether d/dx' holds no rate, for every rate x'; as it is written tells most."""
    degree = _degree(formula, rates)
    if degree <= 1 or degree == math.inf:
        return degree <= 1
    return all(formula.diff(rate).free_symbols.isdisjoint(rates) for rate in rates)


def _degree(formula: sp.Expr, rates: set[sp.Symbol]) -> float:
    """The degree in the rates as it is written; infinite where it is no polynomial of them.

    A derivative of nested functions may be too long to look at, so it is not taken.
    """
    if formula.free_symbols.isdisjoint(rates):
        return 0
    if formula.is_Symbol:
        return 1
    if formula.is_Add:
        return max(_degree(term, rates) for term in formula.args)
    if formula.is_Mul:
        return sum(_degree(factor, rates) for factor in formula.args)
    if formula.is_Pow and formula.exp.is_Integer and formula.exp > 0:
        return int(formula.exp) * _degree(formula.base, rates)
    return math.inf


RESIDUALS: dict[str, Callable[[Relation, Scene], sp.Expr]] = {
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
    """The number under the key, within its bounds."""
    entry = next((e for e in keys.entries if e.key.text == key), None)
    if entry is None:
        return None
    if all(keys.get(kind) is None for kind in GOES_WITH[key]):
        code = "E112" if keys.whole else CONSEQUENCE
        kinds = " or ".join(f"'{kind}'" for kind in GOES_WITH[key])
        raise Mistake(entry.key, code, f"'{key}' goes with {kinds} only")
    found = scalar(entry.value, scene, Wanted(key, f"the {key} of {name}", NONE))
    value = value_of(tree_of(entry.value, scene), scene)
    least, most = BOUNDS[key]
    if value is not None and ((value - least).is_negative or (value - most).is_positive):
        bounds = f"lie from {least} to {most}" if most != sp.oo else "not be negative"
        raise Mistake(entry.value, "E512", f"the {key} of {name} is {value}, it must {bounds}")
    return found
