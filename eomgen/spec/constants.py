"""`parameters`: exact SI values, and the derived ones as formulas of the others."""

from dataclasses import replace
from graphlib import CycleError, TopologicalSorter

from eomgen.dimension import NONE
from eomgen.model import Parameter
from eomgen.spec import lower
from eomgen.spec.formulas import (
    description,
    field,
    quantity_tree,
    scalar_tree,
    text_of,
    unit_of,
    value_of,
)
from eomgen.spec.ledger import Mistake
from eomgen.spec.reader import Entry, Scalar
from eomgen.spec.scope import Known, Scene, Wanted
from eomgen.spec.syntax import Name, Quantity, Tree, names
from eomgen.spec.units import Unit


def parameters(entries: tuple[Entry, ...], scene: Scene) -> tuple[Parameter, ...]:
    """All parameters, in the order of the file; their values are left in the scene."""
    formulas: dict[str, Tree] = {}
    found = [scene.ledger.attempt(_parameter, entry, scene, formulas) for entry in entries]
    scene.ledger.attempt(_evaluate, formulas, scene)
    for entry in entries:
        scene.ledger.attempt(_check_positive, entry, scene)
    return tuple(p for p in found if p is not None)


def _parameter(entry: Entry, scene: Scene, formulas: dict[str, Tree]) -> Parameter:
    """One parameter; a derived one leaves its tree among the formulas."""
    name, known = entry.key.text, scene.names[entry.key.text]
    node = entry.value if isinstance(entry.value, Scalar) else field(entry.value, "value")
    unit_node = field(entry.value, "unit")
    positive = text_of(field(entry.value, "positive")) == "true"
    tree = quantity_tree(node, scene) if node is not None and node.text else None
    plain = tree is not None and lower.is_constant(tree)
    unit = unit_of(unit_node, scene, coherent=not plain)
    if isinstance(tree, Quantity) and tree.unit and unit_node is not None:
        raise Mistake(unit_node, "E406", f"'{name}' has its unit twice", "keep one of them")
    text = tree.unit if isinstance(tree, Quantity) and tree.unit else text_of(unit_node)
    if plain and tree is not None:
        known = _with_value(known, tree, unit, scene)
    elif unit is not None:
        known = replace(known, dimension=unit.dimension)
    scene.names[name] = known
    described = description(entry.value, text, known)
    symbol = known.expressions[0]
    if plain or tree is None:
        value = scene.values[name].expressions[0] if plain else None
        return Parameter(name, symbol, described, value, positive=positive)
    formulas[name] = tree
    wanted = Wanted("parameter", f"parameter '{name}'", NONE, ((Name(name, 0, tree.span), 1),))
    return Parameter(
        name, symbol, described, formula=scalar_tree(tree, scene, wanted), positive=positive
    )


def _with_value(known: Known, tree: Tree, unit: Unit | None, scene: Scene) -> Known:
    """The parameter's dimension; its value goes into the scene."""
    value = lower.scalar(tree, lower.Lowering(scene, "parameter"))
    dimension = tree.dimension if isinstance(tree, Quantity) else NONE
    if unit is not None:
        value, dimension = value * unit.value, unit.dimension
    assert known.spot is not None
    scene.values[known.spot.text] = Known("parameter", (value,))
    return replace(known, dimension=dimension)


def _evaluate(formulas: dict[str, Tree], scene: Scene) -> None:
    """Values of the derived parameters, each after those it needs."""
    scene.values["pi"] = scene.names["pi"]
    graph = {n: [d.name for d in names(tree) if d.name in formulas] for n, tree in formulas.items()}
    try:
        order = tuple(TopologicalSorter(graph).static_order())
    except CycleError as error:
        cycle = list(reversed(error.args[1]))
        span = formulas[cycle[0]].span
        message = f"parameters refer to each other: {' -> '.join(cycle)}"
        raise Mistake(span, "E305", message, "define one of them by a number") from None
    for name in order:
        value = scene.ledger.attempt(value_of, formulas[name], scene)
        if value is not None:
            scene.values[name] = Known("parameter", (value,))


def _check_positive(entry: Entry, scene: Scene) -> None:
    """A value must not contradict `positive: true`."""
    name = entry.key.text
    known = scene.values.get(name)
    positive = text_of(field(entry.value, "positive")) == "true"
    if positive and known is not None and known.expressions[0].is_positive is False:
        node = field(entry.value, "value") or entry.key
        raise Mistake(node, "E508", f"'{name}' is declared positive, but its value is not")
