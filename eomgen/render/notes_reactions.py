"""The forces between components on the page, where their closed form is short."""

from __future__ import annotations

from eomgen.mechanics.free_bodies import FreeBodies, Unknown
from eomgen.render import arrange, notes_newton, tree
from eomgen.render.notes_page import Page, arranged, spelled

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
    found = arranged(page, arrange.loads, unknown.value)
    size = found if isinstance(found, int) else tree.size(found)
    return spelled(page, size if size > LONGEST else found)
