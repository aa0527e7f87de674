"""Kane's equations on the page: partial velocities, active and inertia forces."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.mechanics import speeds
from eomgen.mechanics.free_bodies_rows import BodyRow
from eomgen.mechanics.kane import Kane
from eomgen.render import arrange, notes_dalembert, notes_steps
from eomgen.render.notes_page import Page, formula, spelled


def tables(page: Page, steps: Kane) -> dict[str, object]:
    """Everything that the template of the method shows beside the common parts."""
    names = [page.style.symbol(s.name) for s in speeds.symbols(page.derivation.model)]
    rows = list(_partials(page, steps, names))
    active = [
        (page.style.sub("F", u), formula(page, arrange.loads, f))
        for u, f in zip(names, steps.active, strict=True)
    ]
    inertia = [
        (page.style.sub("F^*", u), formula(page, arrange.motion, f))
        for u, f in zip(names, steps.inertia, strict=True)
    ]
    return {
        "partials": page.style.display(rows),
        "active": page.style.display(active),
        "inertia": page.style.display(inertia),
        "sums": tuple(_sums(page, steps)),
        "linked_said": page.words["kane_linked"] if page.derivation.constraints else "",
    }


def _partials(page: Page, steps: Kane, names: list[str]) -> Iterator[tuple[str, str]]:
    """Vectors by body and speed; those that vanish are left out."""
    for body, rows in notes_steps.by_body(steps.rows).items():
        for letter, is_moment in (("v", False), (page.style.symbol("omega"), True)):
            chosen = [r for r in rows if r.is_moment == is_moment]
            for j, u in enumerate(names):
                if any(r.weights[j].terms for r in chosen):
                    left = page.style.partial(page.style.index(letter, body), u)
                    yield left, _vector(page, chosen, j)


def _vector(page: Page, rows: list[BodyRow], j: int) -> str:
    """The components side by side."""
    found = [formula(page, arrange.motion, r.weights[j]) for r in rows]
    return found[0] if len(found) == 1 else f"({', '.join(found)})"


def _sums(page: Page, steps: Kane) -> Iterator[str]:
    """F_r + F*_r = 0, with what the constraints add."""
    for row, tied in zip(steps.equations, steps.tied, strict=True):
        shown = notes_dalembert.balance(page, row, tied)
        yield page.style.equation(spelled(page, shown), "0")
