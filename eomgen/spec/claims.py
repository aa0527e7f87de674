"""`initial`, `range`, `outputs`, `expect`: values, results and the author's own claims."""

import sympy as sp

from eomgen.dimension import ENERGY, NONE, TIME, Dimension
from eomgen.model import Claim, Expectation, Output, Simulation
from eomgen.spec import quaternions
from eomgen.spec.formulas import (
    constant,
    description,
    field,
    quantity_tree,
    relation,
    scalar,
    scalar_tree,
    text_of,
    tree_of,
    unit_of,
)
from eomgen.spec.ledger import Mistake, shown, suggestion
from eomgen.spec.names import check
from eomgen.spec.reader import Entry, Mapping, Node, Scalar, Sequence
from eomgen.spec.scope import Known, Scene, Wanted
from eomgen.spec.syntax import Name, Span

Values = dict[str, sp.Expr]


def initial(entries: tuple[Entry, ...], scene: Scene, noun: str = "initial value") -> Values:
    """`q` and `q'` -> exact SI value; the guess, which is a map, is left out."""
    known = [e for e in entries if isinstance(e.value, Scalar)]
    found = {e.key.text: scene.ledger.attempt(_initial, e, scene, noun) for e in known}
    values = {name: value for name, value in found.items() if value is not None}
    for entry in entries:
        if isinstance(entry.value, Sequence):
            values |= scene.ledger.attempt(quaternions.initial, entry, scene) or {}
    return quaternions.with_rates(scene, values)


def guess(entries: tuple[Entry, ...], scene: Scene) -> Values:
    """The values under `guess`, none of which is given as an initial value too."""
    given = {e.key.text for e in entries}
    tables = [e.value for e in entries if isinstance(e.value, Mapping)]
    guessed = tuple(e for table in tables for e in table.entries)
    for entry in guessed:
        if entry.key.text in given:
            message = f"'{entry.key.text}' has an initial value and a guess"
            scene.ledger.note(Mistake(entry.key, "E514", message, "keep one of them"))
    return initial(guessed, scene, "guess")


def _initial(entry: Entry, scene: Scene, noun: str) -> sp.Expr:
    name = _coordinate(entry.key, scene, most=1)
    assert isinstance(entry.value, Scalar)
    what = f"the {noun} of '{entry.key.text}'"
    value = constant(entry.value, scene, _like(name, "initial value", what))
    positive = name.order == 0 and scene.names[name.name].expressions[0].is_positive
    if positive and value.is_positive is False:
        raise Mistake(entry.value, "E508", f"'{name.name}' is declared positive")
    return value


def _coordinate(key: Scalar, scene: Scene, most: int = 0) -> Name:
    """The coordinate or rate that a key names."""
    name = key.text.rstrip("'")
    order = len(key.text) - len(name)
    known = scene.names.get(name)
    spins = [s.name for q in quaternions.found(scene) for s in q.speeds] if most else []
    if name in spins and not order:
        return Name(name, 0, Span(key.line, key.column, key.text))
    if known is None or known.kind != "coordinate" or order > most:
        fitting = [n for n, k in scene.names.items() if k.kind == "coordinate"]
        noun = "coordinate or rate" if most else "coordinate"
        message = f"{shown(key.text)} is no {noun}"
        raise Mistake(key, "E301", message, suggestion(name, fitting))
    return Name(name, order, Span(key.line, key.column, key.text))


def _like(name: Name, use: str, what: str) -> Wanted:
    return Wanted(use, what, NONE, ((name, 1),))


def ranges(entries: tuple[Entry, ...], scene: Scene) -> dict[str, tuple[sp.Expr, sp.Expr]]:
    """Coordinate -> least and greatest value."""
    found = {e.key.text: scene.ledger.attempt(_range, e, scene) for e in entries}
    return {name: pair for name, pair in found.items() if pair is not None}


def _range(entry: Entry, scene: Scene) -> tuple[sp.Expr, sp.Expr]:
    name = _coordinate(entry.key, scene)
    assert isinstance(entry.value, Sequence)
    wanted = _like(name, "range", f"the range of '{name.name}'")
    least, most = (constant(n, scene, wanted) for n in entry.value.items if isinstance(n, Scalar))
    if (most - least).is_positive is not True:
        message = f"the range of '{name.name}' ends before it begins"
        raise Mistake(entry.value, "E509", message, "[least, greatest]")
    return least, most


def outputs(entries: tuple[Entry, ...], scene: Scene) -> tuple[Output, ...]:
    """All outputs, in the order of the file."""
    found = [scene.ledger.attempt(_output, entry, scene) for entry in entries]
    return tuple(o for o in found if o is not None)


def _output(entry: Entry, scene: Scene) -> Output:
    name = check(entry.key, scene.names).text
    node = entry.value.get("formula") if isinstance(entry.value, Mapping) else entry.value
    assert node is not None
    unit_node = field(entry.value, "unit")
    unit = unit_of(unit_node, scene)
    known = Known("output", (), unit.dimension if unit else None, entry.key)
    tree = tree_of(node, scene)
    by = ((Name(name, 0, tree.span), 1),)
    formula = scalar(node, scene, Wanted("output", f"output '{name}'", NONE, by))
    scene.names[name] = known
    return Output(name, formula, description(entry.value, text_of(unit_node), known))


def simulation(node: Node | None, scene: Scene) -> Simulation:
    """The method, step and formulation that the author wants."""
    if not isinstance(node, Mapping):
        return Simulation()
    step = field(node, "step")
    return Simulation(
        text_of(node.get("method")) or None,
        None if step is None else scene.ledger.attempt(_step, step, scene),
        text_of(node.get("formulation")) or None,
    )


def _step(node: Scalar, scene: Scene) -> sp.Expr:
    value = constant(node, scene, Wanted("initial value", "the step", TIME))
    if value.is_positive is not True:
        raise Mistake(node, "E508", "a step must be positive")
    return value


def expectation(node: Node | None, scene: Scene) -> Expectation:
    """All claims."""
    if not isinstance(node, Mapping):
        return Expectation()
    dof = field(node, "dof")
    claims = {
        key: scene.ledger.attempt(_claim, found, scene, f"the claimed {key} energy", ENERGY)
        for key in ("kinetic", "potential")
        if (found := field(node, key)) is not None
    }
    return Expectation(
        int(dof.text) if dof is not None else None,
        _equations(node.get("equations"), scene),
        _equilibria(node.get("equilibrium"), scene),
        _conserved(node.get("conserved"), scene),
        claims.get("kinetic"),
        claims.get("potential"),
    )


def _claim(node: Scalar, scene: Scene, what: str, dimension: Dimension | None) -> Claim:
    return Claim(scalar(node, scene, Wanted("claim", what, dimension)), node.text)


def _conserved(node: Node | None, scene: Scene) -> tuple[Claim, ...]:
    found = [
        scene.ledger.attempt(_claim, item, scene, "what is conserved", None)
        for item in _listed(node)
    ]
    return tuple(claim for claim in found if claim is not None)


def _equations(node: Node | None, scene: Scene) -> tuple[Claim, ...]:
    if isinstance(node, Mapping):
        for entry in node.entries:
            scene.ledger.attempt(_coordinate, entry.key, scene)
    found = [scene.ledger.attempt(_equation, item, scene) for item in _listed(node)]
    return tuple(claim for claim in found if claim is not None)


def _equation(node: Scalar, scene: Scene) -> Claim:
    return Claim(relation(node, scene, Wanted("claim", "an equation")), node.text)


def _listed(node: Node | None) -> list[Scalar]:
    """The scalars of one text, a list or a map."""
    if isinstance(node, Mapping):
        return [e.value for e in node.entries if isinstance(e.value, Scalar)]
    items = node.items if isinstance(node, Sequence) else (node,)
    return [item for item in items if isinstance(item, Scalar)]


def _equilibria(node: Node | None, scene: Scene) -> tuple[dict[str, sp.Expr], ...]:
    tables = node.items if isinstance(node, Sequence) else (node,)
    return tuple(_equilibrium(t, scene) for t in tables if isinstance(t, Mapping))


def _equilibrium(table: Mapping, scene: Scene) -> dict[str, sp.Expr]:
    found = {e.key.text: scene.ledger.attempt(_rest, e, scene) for e in table.entries}
    return {name: value for name, value in found.items() if value is not None}


def _rest(entry: Entry, scene: Scene) -> sp.Expr:
    """The value of a coordinate at rest, a quantity or a formula."""
    name = _coordinate(entry.key, scene)
    assert isinstance(entry.value, Scalar)
    wanted = _like(name, "equilibrium", f"the equilibrium of '{name.name}'")
    return scalar_tree(quantity_tree(entry.value, scene), scene, wanted)
