"""Newton's and Euler's equations on the page: bodies, unknowns, and the sums without them."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.mechanics import motions
from eomgen.mechanics.free_bodies import FreeBodies, Unknown
from eomgen.render import arrange, notes_steps
from eomgen.render.notes_page import Page, formula, spelled
from eomgen.render.notes_steps import Row


def tables(page: Page, free: FreeBodies) -> dict[str, object]:
    """Everything that the template of the vector formalism shows beside the common parts."""
    return {
        "bodies": tuple(_bodies(page, free)),
        "moments_said": _moments_said(page, free),
        "unknowns_said": _unknowns_said(page, free),
        "unknowns": tuple(legend(page, u) for u in free.unknowns if free.by_joints),
        "sums_title": page.words["elimination" if free.unknowns else "projection"],
        "sums_said": _sums_said(page, free),
        "sums": tuple(_sums(page, free)) if _is_summed(free) else (),
        "work_said": _work_said(page, free),
        "work": tuple(_work(page, free)),
    }


def proposals(free: FreeBodies) -> Iterator[tuple[str, str]]:
    """(symbol, name) of every unknown: S_bob, R_bob_x."""
    for unknown in free.unknowns:
        letter, axis = unknown.letter[0], unknown.letter[1:]
        yield unknown.symbol.name, "_".join(filter(None, (letter, unknown.body, axis)))


def _bodies(page: Page, free: FreeBodies) -> Iterator[dict[str, object]]:
    for body, rows in notes_steps.by_body(free.rows).items():
        shown = (
            notes_steps.equal(
                page,
                notes_steps.inertia(page, row),
                notes_steps.acting(page, row.applied, row.reaction),
            )
            for row in rows
        )
        yield {"name": page.style.words(body), "rows": tuple(shown)}


def _moments_said(page: Page, free: FreeBodies) -> str:
    moments = [row for row in free.rows if row.is_moment]
    if not moments:
        return ""
    return page.words["moments_body" if any(r.axis for r in moments) else "moments_said"]


def _unknowns_said(page: Page, free: FreeBodies) -> str:
    if not free.unknowns:
        return page.words["no_unknowns"]
    if free.by_joints:
        return page.words["unknowns"]
    letters = {u.letter[0] for u in free.unknowns}
    shown = {"forces": page.style.inline("R"), "moments": page.style.inline("L")}
    return page.words["resultants" if "L" in letters else "resultants_forces"].format(**shown)


def legend(page: Page, unknown: Unknown) -> str:
    """What one unknown is."""
    parent = unknown.held_by
    return page.words[f"unknown_{unknown.letter}"].format(
        symbol=page.style.inline(page.style.symbol(unknown.symbol.name)),
        of_parent=page.words["of_world" if parent is None else "of_body"].format(
            name=page.style.words(parent or "")
        ),
        body=page.style.words(unknown.body),
    )


def _is_summed(free: FreeBodies) -> bool:
    """Whether the equations of the bodies are not those of the coordinates already."""
    held = [w for row in free.rows for w in row.weights if w.terms]
    return (
        bool(free.unknowns) or len(held) > len(free.equations) or any(w != w * 0 + 1 for w in held)
    )


def _sums_said(page: Page, free: FreeBodies) -> str:
    if not free.unknowns:
        return page.words["sums_plain"]
    return page.words["sums_joints" if free.by_joints else "sums_resultants"]


def _sums(page: Page, free: FreeBodies) -> Iterator[Row]:
    """How the equations are added for each coordinate."""
    for j, name in enumerate(motions.displacements(page.derivation.model)):
        weights = [notes_steps.moved(page, row.weights[j]) for row in free.rows]
        added = notes_steps.numbered(weights)
        symbol = page.style.symbol(name)
        yield {
            "symbol": page.style.inline(symbol),
            "sum": page.style.inline(spelled(page, notes_steps.in_one_line(added))),
        }


def _work_said(page: Page, free: FreeBodies) -> str:
    if free.by_joints:
        return ""
    return page.words["work_other" if any(o.terms for o in free.other) else "work_ideal"]


def _work(page: Page, free: FreeBodies) -> Iterator[str]:
    """The virtual work of the resultants for each coordinate."""
    for work, other in zip(free.work, free.other, strict=True):
        left = notes_steps.acting(page, work * 0, work)
        yield page.style.equation(spelled(page, left), formula(page, arrange.loads, other))
