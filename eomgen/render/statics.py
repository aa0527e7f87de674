"""Statics -> what its templates get: virtual work, equations and equilibria as finished strings.

Who solves fills the record `StaticsNotes`; the names of `context` are those of the templates.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import sympy as sp

from eomgen import __version__
from eomgen.algebra import normal
from eomgen.algebra.normal import Form
from eomgen.mechanics import lagrange
from eomgen.mechanics.equations import (
    ConstraintRow,
    Contribution,
    Derivation,
    Equations,
    virtual_name,
)
from eomgen.model import TIME, Model
from eomgen.render import (
    arrange,
    latex_style,
    notes_data,
    notes_links_names,
    statics_tables,
    statics_words,
    text_style,
    tree,
    words,
)
from eomgen.render.latex_text import escaped
from eomgen.render.notes_page import Page, arranged, formula, joined, spelled
from eomgen.render.statics_tables import Layout, Rest
from eomgen.render.style import Style
from eomgen.render.tree import Number, Product, Symbol, Tree

Marked = Callable[[str, str], str]  # (spelled symbol, a word): Q_s of the springs


@dataclass(frozen=True)
class StaticsRow:
    """The equilibrium equation of one coordinate: force + reaction = 0."""

    name: str
    parts: tuple[tuple[str, Form], ...]  # shares of Q by origin, a key of `statics_words.ORIGINS`
    force: Form  # Q of all applied forces
    reaction: Form  # sum of lambda_a J_aj


@dataclass(frozen=True)
class StaticsLink:
    """One row of the bilateral constraints; `residual` is None where it holds between rates."""

    name: str
    residual: Form | None
    jacobian: tuple[Form, ...]


@dataclass(frozen=True)
class StaticsNotes:
    """What is rendered as statics: the equations, the equilibria, and how they were found.

    `method`, `notes` and the reasons of the equilibria are English sentences.
    """

    model: Model
    work: tuple[Contribution[Form], ...]  # linear in the virtual displacements
    rows: tuple[StaticsRow, ...]
    links: tuple[StaticsLink, ...]
    equilibria: tuple[Rest, ...]
    method: str
    complete: bool
    language: str = "en"
    arbitrary: tuple[str, ...] = ()  # coordinates on which nothing depends
    inputs: Mapping[str, sp.Expr] = field(default_factory=dict)
    time: sp.Expr | None = None  # None where nothing depends on it
    notes: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The stem of the files."""
        return self.model.name


def latex_context(notes: StaticsNotes) -> dict[str, object]:
    """What the templates of LaTeX see."""
    style = latex_style.style(notes.model)
    return context(
        notes, style, statics_tables.LATEX, lambda q, of: rf"{q}^{{\text{{{escaped(of)}}}}}"
    )


def text_context(notes: StaticsNotes) -> dict[str, object]:
    """What the templates of plain text see."""
    return context(notes, text_style.style(), statics_tables.TEXT, lambda q, of: f"{q} ({of})")


def context(notes: StaticsNotes, style: Style, layout: Layout, marked: Marked) -> dict[str, object]:
    """Every formula and every sentence, spelled."""
    still = _derivation(notes)
    style = notes_links_names.with_multipliers(style, notes_links_names.aliases(still))
    page = Page(still, notes.language, style)
    said = statics_words.of(notes.language)
    return {
        "language": notes.language,
        "version": __version__,
        "words": {**page.words, **said},
        "title": style.words(words.title(notes.model.title, notes.language)),
        "digest": notes.model.digest,
        **notes_data.tables(page),
        "work": style.display(list(_work(page, notes))),
        "forces": style.display(list(_forces(page, notes, marked))),
        "equations": tuple(_equation(page, row) for row in notes.rows),
        "is_linked": bool(notes.links),
        "constraint_equations": tuple(_link(page, link) for link in notes.links),
        "gaps": tuple(_gaps(page)),
        "given": tuple(_given(page, notes)),
        "tables": statics_tables.tables(page, notes.equilibria, layout, notes.arbitrary),
        "reasons": statics_tables.reasons(page, notes.equilibria),
        "loads_said": tuple(statics_tables.loads_said(page, notes.equilibria)),
        "counted": _counted(page, notes),
        "arbitrary": ", ".join(_symbol(page, name) for name in notes.arbitrary),
        "method": _sentence(page, notes.method),
        "completeness": said["complete" if notes.complete else "incomplete"],
        "notes": tuple(_sentence(page, note) for note in notes.notes),
    }


def _derivation(notes: StaticsNotes) -> Derivation:
    """The scene as the displays know one: nothing moves, so motion has no terms."""
    zero = notes.rows[0].force * 0
    touching = [c.name for c in notes.model.constraints if c.kind == "unilateral"]
    links = [*notes.links, *(StaticsLink(name, zero, ()) for name in touching)]
    return Derivation(
        model=notes.model,
        places=(),
        spins=(),
        kinetic=(),
        potential=(),
        dissipation=(),
        virtual_work=notes.work,
        kinetic_energy=zero,
        potential_energy=zero,
        dissipation_function=zero,
        rows=(),
        equations=(),
        matrix=Equations((), (), ()),
        constraints=tuple(
            ConstraintRow(r.name, r.residual, zero, zero, r.jacobian, zero) for r in links
        ),
    )


def _work(page: Page, notes: StaticsNotes) -> Iterator[tuple[str, str]]:
    """The shares of dW by owner where there are several, then the whole."""
    symbol = page.style.symbol("delta W")
    owners: dict[str, list[Form]] = {}
    for share in notes.work:
        owner = page.words["given"] if share.kind == "formula" else share.name
        owners.setdefault(owner, []).append(share.value)
    ring = page.derivation.kinetic_energy.ring
    for owner, shares in owners.items() if len(owners) > 1 else ():
        total = normal.total(ring, shares)
        yield page.style.index(symbol, owner), formula(page, arrange.work, total)
    yield symbol, _total_work(page, notes)


def _total_work(page: Page, notes: StaticsNotes) -> str:
    """Sum of Q_j delta q_j, each Q as it is shown by itself."""
    trees, count = [], 0
    for row in notes.rows if notes.work else ():
        force = arranged(page, arrange.loads, row.force)
        if isinstance(force, int):
            count = sum(len(r.force.terms) for r in notes.rows)
        elif force != tree.ZERO:
            trees.append(_displaced(force, Symbol(virtual_name(row.name))))
    return spelled(page, count or joined(trees))


def _displaced(force: Tree, by: Symbol) -> Tree:
    """Force * delta q."""
    match force:
        case Product(coefficient, factors, divisors):
            return tree.product(coefficient, (*factors, by), divisors)
        case Number(value):
            return tree.product(value, (by,))
    return tree.product(Fraction(1), (force, by))


def _forces(page: Page, notes: StaticsNotes, marked: Marked) -> Iterator[tuple[str, str]]:
    """Q of every coordinate, its shares by origin before it where there are several."""
    origins = statics_words.of(notes.language)
    for c, row in zip(page.derivation.model.coordinates, notes.rows, strict=True):
        symbol = page.style.sub("Q", page.style.symbol(c.symbol.name))
        for origin, part in row.parts if len(row.parts) > 1 else ():
            yield marked(symbol, origins[origin]), formula(page, arrange.loads, part)
        yield symbol, formula(page, arrange.loads, row.force)


def _equation(page: Page, row: StaticsRow) -> str:
    """Q + sum of lambda J = 0."""
    sides = [arranged(page, arrange.loads, form) for form in (row.force, row.reaction)]
    trees = [side for side in sides if not isinstance(side, int)]
    count = len(row.force.terms) + len(row.reaction.terms)
    left = joined(trees) if len(trees) == len(sides) else count
    return page.style.equation(spelled(page, left), "0")


def _link(page: Page, link: StaticsLink) -> str:
    """Residual = 0, or between rates: sum of J_j delta q_j = 0."""
    if link.residual is not None:
        return page.style.equation(formula(page, arrange.motion, link.residual), "0")
    coordinates = page.derivation.model.coordinates
    shares = (
        entry * normal.of_atom(entry.ring, lagrange.virtual_symbol(c))
        for entry, c in zip(link.jacobian, coordinates, strict=True)
    )
    virtual = normal.total(link.jacobian[0].ring, shares)
    return page.style.equation(formula(page, arrange.work, virtual), "0")


def _gaps(page: Page) -> Iterator[str]:
    """What the unilateral constraints keep from being negative."""
    for c in page.derivation.model.constraints:
        if c.kind == "unilateral":
            for residual in c.residuals:
                yield page.style.at_least(notes_data.closed(page, residual), "0")


def _given(page: Page, notes: StaticsNotes) -> Iterator[str]:
    """The loads and the time at which the equilibria hold: tau = 0.2 N*m."""
    for i in notes.model.inputs:
        unit = notes_data.si_unit(i.description)
        yield _valued(page, i.symbol.name, notes.inputs[i.name], unit)
    if notes.time is not None:
        yield _valued(page, TIME.name, notes.time, "s" if notes.model.with_units else "")


def _valued(page: Page, symbol: str, value: sp.Expr, unit: str) -> str:
    shown = notes_data.number(page, value)
    whole = f"{page.style.symbol(symbol)} = {shown}"
    return page.style.inline(whole) + (f" {page.style.inline(page.style.unit(unit))}" * bool(unit))


def _counted(page: Page, notes: StaticsNotes) -> str:
    """How many equilibria there are."""
    said, count = statics_words.of(page.language), len(notes.equilibria)
    return said["found_one" if count == 1 else "found" if count else "found_none"].format(
        count=count
    )


def _symbol(page: Page, name: str) -> str:
    (found,) = (c.symbol.name for c in page.derivation.model.coordinates if c.name == name)
    return page.style.inline(page.style.symbol(found))


def _sentence(page: Page, english: str) -> str:
    """A sentence of the solver in the language of the page."""
    said: Sequence[str] = statics_words.translated(english, page.language)
    return page.style.words(f"{said[:1]}".upper() + f"{said[1:]}.")
