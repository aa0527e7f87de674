"""The matrix form M q'' + h = Q + J' lambda, J q'' + gamma = 0: entries where a matrix is wide."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.mechanics.equations import multiplier_name
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
        "mass": style.matrix(mass) if whole else _entries(page, "M", _upper(mass)),
        "vectors_whole": vectors,
        "unknown": style.matrix([[u] for u in unknown]),
        "bias": style.matrix(bias) if vectors else _column(page, "h", bias),
        "forces": style.matrix(forces) if vectors else _column(page, "Q", forces),
        **_links(page),
    }


def _links(page: Page) -> dict[str, object]:
    """What stands for lambda, J and gamma; nothing in a scene without bilateral constraints."""
    rows, style = page.derivation.constraints, page.style
    if not rows:
        return {"multipliers": ""}
    jacobian = [[formula(page, arrange.motion, j) for j in row.jacobian] for row in rows]
    gamma = [[formula(page, arrange.motion, row.gamma)] for row in rows]
    multipliers = [[style.symbol(multiplier_name(row.name))] for row in rows]
    whole, short = style.fits(jacobian), style.fits(gamma)
    return {
        "multipliers": style.matrix(multipliers),
        "jacobian_whole": whole,
        "jacobian": style.matrix(jacobian) if whole else _entries(page, "J", jacobian),
        "gamma_whole": short,
        "gamma": style.matrix(gamma) if short else _column(page, page.style.symbol("gamma"), gamma),
    }


def _unknown(page: Page) -> list[str]:
    """The symbols of the accelerations."""
    model = page.derivation.model
    symbols = [s.rate for s in model.speeds] or [c.acceleration for c in model.coordinates]
    return [page.style.symbol(s.name) for s in symbols]


def _upper(rows: Sequence[Sequence[str]]) -> list[list[str]]:
    """The rows with zeros below the diagonal."""
    return [["0"] * i + list(row[i:]) for i, row in enumerate(rows)]


def _entries(page: Page, letter: str, rows: Sequence[Sequence[str]]) -> str:
    """The entries that are not zero."""
    between = "," if max(len(rows), len(rows[0])) > 9 else ""
    return page.style.display(
        [
            (page.style.sub(letter, f"{i + 1}{between}{j + 1}"), entry)
            for i, row in enumerate(rows)
            for j, entry in enumerate(row)
            if entry != "0"
        ]
    )


def _column(page: Page, letter: str, rows: Sequence[Sequence[str]]) -> str:
    return page.style.display(
        [(page.style.sub(letter, str(i + 1)), entry) for i, (entry,) in enumerate(rows)]
    )
