"""The table of the pages of formalisms: what each shows beside the common parts."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from eomgen.mechanics.equations import Derivation
from eomgen.mechanics.free_bodies import FreeBodies
from eomgen.mechanics.principles import Worked
from eomgen.render import (
    latex_names,
    notes_cartesian,
    notes_dalembert,
    notes_kane,
    notes_newton,
    notes_steps,
)
from eomgen.render.notes_page import Page


def _none(steps: Any) -> Iterator[tuple[str, str]]:
    return iter(())


@dataclass(frozen=True)
class Shown:
    """One page: its tables, and the names of the symbols that its formalism brings."""

    tables: Callable[[Page, Any], dict[str, object]]
    proposals: Callable[[Any], Iterator[tuple[str, str]]] = _none


PAGES = {
    "newton": Shown(notes_newton.tables, notes_newton.proposals),
    "dalembert": Shown(notes_dalembert.tables),
    "lagrange1": Shown(notes_cartesian.tables, notes_cartesian.proposals),
    "kane": Shown(notes_kane.tables),
}


def tables(page: Page, worked: Worked | None) -> dict[str, object]:
    """What the template of the formalism sees, under one name."""
    return {} if worked is None else {"steps": PAGES[worked.name].tables(page, worked.steps)}


def aliases(
    derivation: Derivation, worked: Worked | None, free: FreeBodies | None
) -> Mapping[str, str]:
    """How the symbols are called that no spec declares: S_bob, lambda_bob_x."""
    proposed: dict[str, str] = {}
    if free is not None:
        proposed |= dict(notes_newton.proposals(free))
    if worked is not None:
        proposed |= dict(PAGES[worked.name].proposals(worked.steps))
    return notes_steps.free_names(proposed.items(), latex_names.table(derivation.model).values())
