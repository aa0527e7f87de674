"""What the pages of the formalisms share: products of displayed formulas, names of unknowns."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from eomgen.algebra.normal import Form
from eomgen.mechanics.free_bodies_rows import BodyRow
from eomgen.render import arrange, arrange_equation, latex_names, notes_links_page, tree
from eomgen.render.notes_page import ENOUGH, How, Page, arranged, readable, spelled
from eomgen.render.tree import Number, Product, Symbol, Tree

Row = Mapping[str, str]

SENTENCE = 20  # terms of a formula that stands inside of one


def times(*factors: Tree) -> Tree:
    """The product in one row of factors."""
    parts = [f if isinstance(f, Product) else _single(f) for f in factors]
    number = parts[0].coefficient
    for part in parts[1:]:
        number *= part.coefficient
    above = tuple(f for part in parts for f in part.factors)
    below = tuple(d for part in parts for d in part.divisors)
    return tree.product(number, above if number else (), below if number else ())


def _single(factor: Tree) -> Product:
    """A tree as a product."""
    if isinstance(factor, Number):
        return Product(factor.value, ())
    negative, rest = tree.split_sign(factor)
    if isinstance(rest, Product):
        return rest
    return Product(-tree.ONE.value if negative else tree.ONE.value, (rest,))


def moved(page: Page, form: Form) -> Tree | int:
    """A position, velocity or acceleration."""
    return arranged(page, arrange.motion, form)


def inertia(page: Page, row: BodyRow) -> Tree | int:
    """M a, the mass in front of the acceleration; in space the whole rate of a momentum."""
    if row.factor is None:
        return moved(page, row.inertia)
    mass, acceleration = moved(page, row.factor), _acceleration(page, row.acceleration)
    if isinstance(mass, int) or isinstance(acceleration, int):
        return len(row.inertia.terms)
    found = times(mass, acceleration)
    return arranged(page, arrange.loads, row.inertia) if _is_reducible(found) else found


def _is_reducible(found: Tree) -> bool:
    """Whether the mass shares a factor with the acceleration, or cancels one."""
    if not isinstance(found, Product):
        return False
    return bool(found.divisors) or len(set(found.factors)) < len(found.factors)


def _acceleration(page: Page, form: Form) -> Tree | int:
    """s'' + l phi'' cos phi - ..., or l (phi'' sin phi + ...) where all terms share a factor."""
    shared = arranged(page, arrange.loads, form)
    return shared if isinstance(shared, Product) else moved(page, form)


def reduced(page: Page, how: How, form: Form) -> Tree | int:
    """A form with what stands on both sides of its fractions cancelled."""
    found = arranged(page, how, form)
    if isinstance(found, int):
        return found
    return tree.total(tuple(map(notes_links_page.cancelled, tree.terms_of(found))))


def acting(page: Page, applied: Form, reaction: Form) -> Tree | int:
    """Unknown forces and applied ones."""
    count = len(applied.terms) + len(reaction.terms)
    if count > ENOUGH:
        return count
    found = arrange_equation.forces(page.arranger, applied, reaction)
    return readable(tree.total(tuple(map(notes_links_page.cancelled, tree.terms_of(found)))))


def equal(page: Page, left: Tree | int, right: Tree | int) -> str:
    """One equation."""
    return page.style.equation(spelled(page, left), spelled(page, right))


def free_names(proposed: Iterable[tuple[str, str]], taken: Iterable[str]) -> dict[str, str]:
    """Symbol -> displayed name, with an index more where the scene has that name."""
    used, found = set(taken), {}
    for symbol, name in proposed:
        while latex_names.spelled(name) in used:
            name += "_0"
        used.add(latex_names.spelled(name))
        found[symbol] = name
    return found


def by_body(rows: Sequence[BodyRow]) -> dict[str, list[BodyRow]]:
    """The rows of each body, as declared."""
    found: dict[str, list[BodyRow]] = {}
    for row in rows:
        found.setdefault(row.body, []).append(row)
    return found


def numbered(weights: Sequence[Tree | int]) -> Tree:
    """(1) + (3) l cos phi: the sum of numbered equations, each times its weight."""
    terms = (
        Symbol(f"({i})") if w == tree.ONE else _weighted(i, w)
        for i, w in enumerate(weights, 1)
        if w != tree.ZERO
    )
    return tree.total(tuple(terms))


def in_one_line(found: Tree) -> Tree | int:
    """The tree, or its size where it does not go into a sentence."""
    size = tree.size(found)
    return size if size > SENTENCE or tree.length(found) > 3 * SENTENCE else found


def _weighted(number: int, weight: Tree | int) -> Tree:
    if isinstance(weight, int):
        return tree.Sum((Symbol(f"({number})"),) * weight)  # too long to be shown, as any part is
    return led(Symbol(f"({number})"), weight)


def led(lead: Symbol, factor: Tree) -> Tree:
    """Lead * factor with the sign outside: -(3) l cos phi."""
    negative, rest = tree.split_sign(factor)
    term = lead if rest == tree.ONE else times(lead, rest)
    return tree.negated(term) if negative else term
