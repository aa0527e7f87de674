"""The matrix form M q'' + h = Q: matrices where they fit on a line, else entry by entry."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.render import arrange
from eomgen.render.notes_page import Page, formula


def matrix(page: Page) -> dict[str, object]:
    """What stands for M, h and Q, and whether entries are listed instead of M."""
    found, style = page.derivation.matrix, page.style
    mass = [[formula(page, arrange.motion, m) for m in row] for row in found.mass_matrix]
    bias = [[formula(page, arrange.motion, h)] for h in found.bias]
    forces = [[formula(page, arrange.loads, q)] for q in found.generalized_forces]
    unknown = _unknown(page)
    whole = style.fits(mass)
    vectors = style.fits([[*h, *q] for h, q in zip(bias, forces, strict=True)])
    return {
        "whole": whole,
        "mass": style.matrix(mass) if whole else _entries(page, mass),
        "vectors_whole": vectors,
        "unknown": style.matrix([[u] for u in unknown]),
        "bias": style.matrix(bias) if vectors else _column(page, "h", bias),
        "forces": style.matrix(forces) if vectors else _column(page, "Q", forces),
    }


def _unknown(page: Page) -> list[str]:
    """The symbols of the accelerations."""
    model = page.derivation.model
    symbols = [s.rate for s in model.speeds] or [c.acceleration for c in model.coordinates]
    return [page.style.symbol(s.name) for s in symbols]


def _entries(page: Page, rows: Sequence[Sequence[str]]) -> str:
    """The entries on and above the diagonal that are not zero."""
    between = "," if len(rows) > 9 else ""
    return page.style.display(
        [
            (page.style.sub("M", f"{i + 1}{between}{j + 1}"), entry)
            for i, row in enumerate(rows)
            for j, entry in enumerate(row)
            if j >= i and entry != "0"
        ]
    )


def _column(page: Page, letter: str, rows: Sequence[Sequence[str]]) -> str:
    return page.style.display(
        [(page.style.sub(letter, str(i + 1)), entry) for i, (entry,) in enumerate(rows)]
    )
