"""Derivation -> what the templates of the notes get: finished strings, in the order of a lecture.

`context` is pure; the names of its dictionary are the interface of the templates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from eomgen.algebra import normal
from eomgen.mechanics.equations import Contribution, Derivation, LagrangeRow
from eomgen.model import AXES, SPACES, TIME, Coordinate
from eomgen.render import arrange, arrange_equation, latex_style, notes_data, notes_matrix
from eomgen.render import text_style, tree, words
from eomgen.render.arrange_equation import Arranged
from eomgen.render.notes_page import LARGEST, How, Page, arranged, formula, joined, spelled
from eomgen.render.style import Style


@dataclass(frozen=True)
class Notes:
    """What is rendered as notes: a derivation, a language, the line that says it was checked."""

    derivation: Derivation
    language: str = "en"
    check: str = ""
    steps: bool = False  # whether the text shows the partial derivatives; LaTeX always does

    @property
    def name(self) -> str:
        """The stem of the files."""
        return self.derivation.model.name


def latex_context(notes: Notes) -> dict[str, object]:
    """What the templates of `latex` see."""
    return context(notes, latex_style.style(notes.derivation.model))


def text_context(notes: Notes) -> dict[str, object]:
    """What the templates of `text` see."""
    return context(notes, text_style.style())


def context(notes: Notes, style: Style) -> dict[str, object]:
    """Every formula of the notes, spelled."""
    page = Page(notes.derivation, notes.language, style)
    model = notes.derivation.model
    return {
        "language": notes.language,
        "words": page.words,
        "title": style.words(words.title(model.title, notes.language)),
        "digest": model.digest,
        "check": style.words(notes.check),
        "show_steps": notes.steps,
        **notes_data.tables(page),
        **_places(page),
        **_energies(page),
        **_forces(page),
        "steps": tuple(_step(page, c, r) for c, r in _by_coordinate(page)),
        **_equations(page),
        "matrix": notes_matrix.matrix(page),
    }


def _by_coordinate(page: Page) -> Iterator[tuple[Coordinate, LagrangeRow]]:
    return zip(page.derivation.model.coordinates, page.derivation.rows, strict=True)


def _places(page: Page) -> dict[str, object]:
    """Positions, velocities of what moves, angular velocities."""
    style, rows = page.style, []
    axes = AXES[: SPACES[page.derivation.model.space]]
    for place in page.derivation.places:
        moves = any(v.terms for v in place.velocity)
        for axis, at, speed in zip(axes, place.position, place.velocity, strict=True):
            name = style.index(axis, place.name)
            rows.append((name, formula(page, arrange.motion, at)))
            if moves:
                rows.append((style.dotted(name), formula(page, arrange.motion, speed)))
    return {
        "places": style.display(rows) if rows else "",
        "spins": style.display(list(_spins(page))) if page.derivation.spins else "",
    }


def _spins(page: Page) -> Iterator[tuple[str, str]]:
    omega = page.style.symbol("omega")
    for spin in page.derivation.spins:
        values = [formula(page, arrange.motion, w) for w in spin.angular_velocity]
        if len(values) == 1:
            yield page.style.index(omega, spin.name), values[0]
        else:
            for axis, value in zip(AXES, values, strict=True):
                yield page.style.index(omega, spin.name, axis), value


def _energies(page: Page) -> dict[str, object]:
    """T, V, L and D, by contribution and reduced."""
    d = page.derivation
    kinetic = arranged(page, arrange.kinetic, d.kinetic_energy)
    potential = arranged(page, arrange.potential, d.potential_energy)
    lagrangian = ""
    if not isinstance(kinetic, int) and not isinstance(potential, int):
        difference = joined([kinetic, tree.negated(potential)])
        lagrangian = page.style.display([("L", "T - V"), ("", page.style.formula(difference))])
    return {
        "kinetic": _energy(page, "T", d.kinetic, arrange.kinetic, spelled(page, kinetic)),
        "potential": _energy(page, "V", d.potential, arrange.potential, spelled(page, potential)),
        "lagrangian": lagrangian,
        "dissipation": _energy(
            page,
            "D",
            d.dissipation,
            arrange.dissipation,
            formula(page, arrange.dissipation, d.dissipation_function),
        ),
    }
