"""Lagrange's first kind of a free scene on the page: Cartesian coordinates with multipliers."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.mechanics.first_kind import CartesianRow, FirstKind
from eomgen.render import arrange, notes_steps, tree
from eomgen.render.notes_page import Page, formula, joined, spelled
from eomgen.render.tree import Symbol


def tables(page: Page, steps: FirstKind) -> dict[str, object]:
    """Everything that the template of the first kind shows beside the common parts."""
    model = page.derivation.model
    # the length of a quaternion is a constraint too
    freedom, links = len(steps.rest), len(steps.rows) + len(model.quaternions)
    rotation = (page.style.sub("T", "0"), formula(page, arrange.kinetic, steps.rotation))
    return {
        "count_said": page.words["cartesian_said"].format(
            count=freedom + links, links=links, freedom=freedom
        ),
        "links": tuple(_link(page, r) for r in steps.rows),
        "rotation": page.style.display([rotation]) if steps.rotation.terms else "",
        "cartesian_rows": tuple(_row(page, r) for r in steps.rows),
        "rest": tuple(_rest(page, steps)),
    }


def proposals(steps: FirstKind) -> Iterator[tuple[str, str]]:
    """(symbol, name) of every Cartesian coordinate and multiplier: x_bob, lambda_bob_x."""
    for found in steps.rows:
        yield place(found), f"{found.row.axis}_{found.row.body}"
        yield found.multiplier.name, f"lambda_{found.row.body}_{found.row.axis}"


def place(found: CartesianRow) -> str:
    """The name of the symbol of a Cartesian coordinate."""
    return f"place {found.row.axis} {found.row.body}"


def _link(page: Page, found: CartesianRow) -> str:
    """x_bob - s - l sin phi = 0."""
    position = notes_steps.moved(page, found.position)
    if isinstance(position, int):
        return page.style.equation(page.style.symbol(place(found)), spelled(page, position))
    whole = joined([Symbol(place(found)), tree.negated(position)])
    return page.style.equation(page.style.formula(whole), "0")


def _row(page: Page, found: CartesianRow) -> str:
    """M x'' = weight + lambda."""
    row = found.row
    assert row.factor is not None
    mass = notes_steps.moved(page, row.factor)
    shown = f"({spelled(page, mass)})" if isinstance(mass, tree.Sum) else spelled(page, mass)
    left = f"{shown} {page.style.accelerated(page.style.symbol(place(found)))}"
    return page.style.equation(
        left, spelled(page, notes_steps.acting(page, row.applied, row.reaction))
    )


def _rest(page: Page, steps: FirstKind) -> Iterator[str]:
    for row in steps.rest:
        assert row.reaction is not None
        right = notes_steps.acting(page, row.applied, row.reaction)
        yield notes_steps.equal(page, notes_steps.moved(page, row.inertia), right)
