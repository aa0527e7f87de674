"""Nodes of the file -> checked expressions: the one door through which formulas enter a model."""

import re
from dataclasses import replace

import sympy as sp

from eomgen import latex_name
from eomgen.dimension import NONE
from eomgen.model import Description
from eomgen.spec import lower, units
from eomgen.spec.formula import parse, parse_relation
from eomgen.spec.ledger import Mistake, shown
from eomgen.spec.reader import Mapping, Node, Scalar, Sequence
from eomgen.spec.scope import Known, Scene, Statement, Wanted
from eomgen.spec.syntax import Quantity, Relation, Span, Tree, Vector, names

UNIT_NAME = re.compile("[^0-9*/^() ]+")


def tree_of(node: Node, scene: Scene) -> Tree:
    """The syntax tree of a formula, of a list of formulas, or of a number with its unit."""
    if isinstance(node, Sequence):
        items = tuple(tree_of(item, scene) for item in node.items)
        text = f"[{', '.join(item.span.text for item in items)}]"
        return Vector(items, Span(node.line, node.column, text))
    assert isinstance(node, Scalar)
    return _lone_quantity(node, scene) or parse(node)


def _lone_quantity(node: Scalar, scene: Scene) -> Quantity | None:
    """`30 deg` in the place of a formula; not `2 m` where a name m could be meant."""
    match = units.QUANTITY.fullmatch(node.text)
    if match is None or match["unit"] is None:
        return None
    first = UNIT_NAME.match(match["unit"].strip())
    if first is None or first.group() not in units.UNITS or first.group() in scene.names:
        return None
    found = units.quantity(node)
    if found is not None and found.dimension != NONE:
        # as a bare number it would lose its dimension in the derived equations
        raise Mistake(
            node,
            "E407",
            f"the quantity {shown(node.text)} stands in the place of a formula",
            "give it a name under parameters and write the name here",
        )
    return found


def quantity_tree(node: Scalar, scene: Scene) -> Tree:
    """The tree of `2 kg` or of a formula."""
    found = units.quantity(node)
    if found is None:
        return parse(node)
    scene.units_seen = scene.units_seen or found.dimension != NONE
    return found


def scalar(node: Node, scene: Scene, wanted: Wanted) -> sp.Expr:
    """The expression of a scalar formula, which is kept for the dimension check."""
    return scalar_tree(tree_of(node, scene), scene, wanted)


def scalar_tree(tree: Tree, scene: Scene, wanted: Wanted) -> sp.Expr:
    """The expression of a tree that is parsed already."""
    result = lower.scalar(tree, lower.Lowering(scene, wanted.use, wanted.local))
    scene.statements.append(Statement(tree, wanted))
    return result


def vector(node: Node, scene: Scene, wanted: Wanted) -> lower.Affine:
    """The vector or place of a formula, which is kept for the dimension check."""
    tree = tree_of(node, scene)
    result = lower.vector(tree, lower.Lowering(scene, wanted.use, wanted.local))
    scene.statements.append(Statement(tree, wanted))
    return result


def relation(node: Scalar, scene: Scene, wanted: Wanted) -> sp.Expr:
    """left - right of an equation."""
    found = parse_relation(node)
    if found.sign != "=":
        raise Mistake(found.span, "E205", f"an equation has '=', not '{found.sign}'")
    return residual(found, scene, wanted)


def residual(found: Relation, scene: Scene, wanted: Wanted) -> sp.Expr:
    """left - right, turned round for `left <= right`, kept for the dimension check."""
    where = lower.Lowering(scene, wanted.use)
    difference = lower.scalar(found.left, where) - lower.scalar(found.right, where)
    scene.statements.append(Statement(found, wanted))
    return -difference if found.sign == "<=" else difference


def value_of(tree: Tree, scene: Scene) -> sp.Expr | None:
    """The number that the formula has with the values of the file; None where one is missing."""
    if any(n.name not in scene.values for n in names(tree)):
        return None
    return lower.scalar(tree, lower.Lowering(replace(scene, names=scene.values), "parameter"))


def constant(node: Scalar, scene: Scene, wanted: Wanted) -> sp.Expr:
    """The exact SI value of a quantity or of a formula of parameters that have values."""
    tree = quantity_tree(node, scene)
    scalar_tree(tree, scene, wanted)
    value = value_of(tree, scene)
    if value is None:
        name = next(n for n in names(tree) if n.name not in scene.values)
        raise Mistake(name.span, "E203", f"'{name.name}' has no value, {wanted.what} needs one")
    return value


def unit_of(node: Scalar | None, scene: Scene, coherent: bool = True) -> units.Unit | None:
    """The unit that a node names; `coherent`: it must be SI without a factor."""
    if node is None or not node.text.strip():
        return None
    unit = units.parse_unit(node)
    if coherent and unit.value != 1:
        hint = f"write '{units.si_unit(unit.dimension)}'"
        if unit.dimension == NONE:
            hint = "write 'rad'"
        message = f"'{node.text}' is no SI unit, and values enter and leave the code in SI"
        raise Mistake(node, "E405", message, hint)
    scene.units_seen = scene.units_seen or unit.dimension != NONE
    return unit


def text_of(node: Node | None) -> str:
    """The text of a scalar that may be absent."""
    return node.text if isinstance(node, Scalar) else ""


def field(node: Node, name: str) -> Scalar | None:
    """The scalar under a key of a map; None where it is absent or the node is no map."""
    found = node.get(name) if isinstance(node, Mapping) else None
    return found if isinstance(found, Scalar) else None


def description(node: Node, unit: str = "", known: Known | None = None) -> Description:
    """Unit, LaTeX and words of a name. Raises `Mistake` where the LaTeX is no name."""
    latex = field(node, "latex")
    if latex is not None and not latex_name.is_name(latex.text.strip()):
        raise Mistake(
            latex, "E516", f"{shown(latex.text)} is not the LaTeX of a name", latex_name.HINT
        )
    dimension = known.dimension if known else None
    about = text_of(field(node, "about"))
    return Description(unit, dimension, latex.text if latex else None, about)
