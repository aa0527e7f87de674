"""d'Alembert's principle on the page: inertial forces, virtual displacements, coefficients."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.algebra.normal import Form
from eomgen.mechanics import motions
from eomgen.mechanics.dalembert import Inertial, VirtualWork
from eomgen.mechanics.equations import Equation, virtual_name
from eomgen.render import arrange, notes_steps, tree
from eomgen.render.notes_page import Page, formula, joined, readable, spelled
from eomgen.render.tree import Symbol, Tree


def tables(page: Page, steps: VirtualWork) -> dict[str, object]:
    """Everything that the template of the principle shows beside the common parts."""
    moving = (i for i in steps.inertial if i.row.inertia.terms or i.displacement.terms)
    rows = [row for i in moving for row in _inertial(page, i)]
    works = [
        (
            page.style.index(page.style.symbol("delta W"), a.name),
            formula(page, arrange.work, a.work),
        )
        for a in steps.applied
        if a.work.terms
    ]
    linked = bool(page.derivation.constraints)
    return {
        "inertial": page.style.display(rows),
        "momentum_said": _momentum_said(page, steps),
        "works": page.style.display(works) if works else "",
        "coefficients_said": page.words["coefficients_linked" if linked else "coefficients"],
        "coefficients": tuple(_coefficients(page, steps)),
    }


def _momentum_said(page: Page, steps: VirtualWork) -> str:
    in_space = any(i.row.is_moment and i.row.factor is None for i in steps.inertial)
    return page.words["momentum_said"] if in_space else ""


def _inertial(page: Page, found: Inertial) -> Iterator[tuple[str, str]]:
    """-m a and delta r of one component, or the rate of angular momentum and delta theta."""
    row, style = found.row, page.style
    value = notes_steps.inertia(page, row)
    opposite = value if isinstance(value, int) else tree.negated(value)
    yield _inertial_name(page, found), spelled(page, opposite)
    letter = f"theta_{row.body}" + (f"_{row.axis}" if row.axis else "")
    name = letter if row.is_moment else f"{row.axis}_{row.body}"
    yield style.symbol(f"delta {name}"), formula(page, arrange.work, found.displacement)


def _inertial_name(page: Page, found: Inertial) -> str:
    """-m a_x, -I alpha, or minus a component of the rate of the angular momentum."""
    row = found.row
    if row.factor is None:
        minus = page.style.formula(tree.negated(tree.ONE))[0]
        return minus + page.style.dotted(page.style.index("L", row.body, row.axis))
    mass = notes_steps.moved(page, row.factor)
    name = f"alpha_{row.body}" if row.is_moment else f"a_{row.body}_{row.axis}"
    factor: Tree = Symbol("m") if isinstance(mass, int) else mass
    return page.style.formula(tree.negated(notes_steps.times(factor, Symbol(name))))


def _coefficients(page: Page, steps: VirtualWork) -> Iterator[dict[str, str]]:
    """Applied less inertia, and what the constraints add, for each virtual displacement."""
    deltas = (virtual_name(name) for name in motions.displacements(page.derivation.model))
    for name, row, tied in zip(deltas, steps.equations, steps.tied, strict=True):
        body = page.style.equation(spelled(page, balance(page, row, tied)), "0")
        yield {"symbol": page.style.inline(page.style.symbol(name)), "body": body}


def balance(page: Page, row: Equation, tied: Form) -> Tree | int:
    """Forces less inertia terms."""
    left = notes_steps.acting(page, row.applied, tied)
    right = notes_steps.moved(page, row.inertia)
    if isinstance(left, int) or isinstance(right, int):
        return len(row.applied.terms) + len(row.inertia.terms)
    return readable(joined([left, tree.negated(right)]))
