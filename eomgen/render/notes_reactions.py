"""The forces between components on the page, where their closed form is short."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.algebra import normal
from eomgen.algebra.normal import Form
from eomgen.mechanics import constraints, lagrange, named_reactions
from eomgen.mechanics.equations import multiplier_name
from eomgen.mechanics.free_bodies import FreeBodies, Unknown
from eomgen.mechanics.named_reactions import Reaction
from eomgen.render import arrange, notes_newton, notes_steps, tree
from eomgen.render.notes_page import Page, arranged, joined, spelled
from eomgen.render.tree import Tree

LONGEST = 24  # terms of a force that is written out


def tables(page: Page, free: FreeBodies | None) -> dict[str, object]:
    """Legend and formulas; nothing where the joints do not tell the forces."""
    named = tuple(_named(page, r) for r in _reactions(page))
    if free is None or not free.by_joints:
        return {"reactions": "", "reactions_legend": (), "reactions_named": named}
    shown = [(u, _formula(page, u)) for u in free.unknowns if u.value.terms]
    rows = [(page.style.symbol(u.symbol.name), formula) for u, formula in shown]
    return {
        "reactions": page.style.display(rows) if rows else "",
        "reactions_legend": tuple(notes_newton.legend(page, u) for u, _ in shown),
        "reactions_named": named,
    }


def _reactions(page: Page) -> tuple[Reaction[Form], ...]:
    """The forces of constraints that the author names."""
    model = page.derivation.model
    if not any(c.reaction for c in model.constraints):
        return ()
    kinematics = lagrange.closed_kinematics(model)
    return named_reactions.of(kinematics, constraints.rows(kinematics))


def _named(page: Page, reaction: Reaction[Form]) -> dict[str, str]:
    """One of them, by component."""
    said = "named_coordinates" if reaction.on == "coordinates" else "named_on"
    words = page.words[said].format(
        name=page.style.words(reaction.name), on=page.style.words(reaction.on)
    )
    rows = [
        (_label(page, reaction, component), _component(page, shares))
        for component, shares in reaction.components
    ]
    return {"said": words, "rows": page.style.display(rows)}


def _label(page: Page, reaction: Reaction[Form], component: str) -> str:
    """R with the axis, or Q of the coordinate."""
    if reaction.on == "coordinates":
        return page.style.sub("Q", page.style.symbol(component))
    return page.style.index("R", reaction.name, component)


def _component(page: Page, shares: Sequence[tuple[str, Form | None]]) -> str:
    """The sum of multipliers times their factors."""
    found = [_share(page, row, factor) for row, factor in shares]
    trees = [t for t in found if not isinstance(t, int)]
    return spelled(page, joined(trees) if len(trees) == len(found) else len(found))


def _share(page: Page, row: str, factor: Form | None) -> Tree | int:
    if factor is None:
        return tree.Symbol(multiplier_name(row))
    force = factor * normal.of_atom(factor.ring, lagrange.multiplier_symbol(row))
    return notes_steps.acting(page, factor * 0, force)


def _formula(page: Page, unknown: Unknown) -> str:
    found = arranged(page, arrange.loads, unknown.value)
    size = found if isinstance(found, int) else tree.size(found)
    return spelled(page, size if size > LONGEST else found)
