"""The forces between components on the page, where their closed form is short."""

from __future__ import annotations

from eomgen.mechanics.free_bodies import FreeBodies, Unknown
from eomgen.render import notes_newton, notes_steps, tree
from eomgen.render.notes_page import Page, spelled

LONGEST = 24  # terms of a force that is written out


def tables(page: Page, free: FreeBodies | None) -> dict[str, object]:
    """Legend and formulas; nothing where the joints do not tell the forces."""
    if free is None or not free.by_joints:
        return {"reactions": "", "reactions_legend": ()}
    shown = [(u, _formula(page, u)) for u in free.unknowns if u.value.terms]
    rows = [(page.style.symbol(u.symbol.name), formula) for u, formula in shown]
    return {
        "reactions": page.style.display(rows) if rows else "",
        "reactions_legend": tuple(notes_newton.legend(page, u) for u, _ in shown),
    }


def _formula(page: Page, unknown: Unknown) -> str:
    found = notes_steps.moved(page, unknown.value)
    is_long = not isinstance(found, int) and tree.size(found) > LONGEST
    return spelled(page, tree.size(found) if is_long and not isinstance(found, int) else found)
