"""Derivation -> what the templates of the notes get: finished strings, in the order of a lecture.

`context` is pure; the names of its dictionary are the interface of the templates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from eomgen.algebra import normal
from eomgen.algebra.closed import ClosedForm
from eomgen.algebra.normal import Form
from eomgen.mechanics import motions
from eomgen.mechanics.contact_forms import ContactForms
from eomgen.mechanics.equations import Contribution, Derivation, LagrangeRow
from eomgen.mechanics.free_bodies import FreeBodies
from eomgen.mechanics.motions import Motion
from eomgen.mechanics.principles import Worked
from eomgen.model import AXES, SPACES, Quaternion
from eomgen.render import (
    arrange,
    latex_style,
    notes_contacts,
    notes_data,
    notes_equation,
    notes_links_names,
    notes_links_page,
    notes_matrix,
    notes_principles,
    notes_reactions,
    text_style,
    tree,
    words,
)
from eomgen.render.notes_links import Links
from eomgen.render.notes_page import (
    How,
    Page,
    arranged,
    formula,
    joined,
    spelled,
)
from eomgen.render.style import Style
from eomgen.render.tree import Tree

REPEATED = 60  # terms of a Lagrangian that is written out below T and V


@dataclass(frozen=True)
class Notes:
    """What is rendered as notes: a derivation, a language, the line that says it was checked."""

    derivation: Derivation
    language: str = "en"
    check: str = ""
    steps: bool = False  # whether the text shows the partial derivatives; LaTeX always does
    links: Links | None = None  # what is known of the constraints
    worked: Worked | None = None  # the formalism that was asked for, where it is not as ever
    free: FreeBodies | None = None  # what holds the bodies, where it is shown
    contacts: tuple[ContactForms, ...] = ()

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
    names = notes_links_names.aliases(notes.derivation)
    names = {**names, **notes_principles.aliases(notes.derivation, notes.worked, notes.free)}
    names = {**names, **notes_contacts.aliases(notes.derivation, notes.contacts)}
    style = notes_links_names.with_multipliers(style, names)
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
        **notes_links_page.tables(page, notes.links),
        **_places(page),
        **_energies(page),
        **_forces(page),
        "steps": tuple(_step(page, m, r) for m, r in _by_motion(page)),
        **_equations(page),
        "matrix": notes_matrix.matrix(page),
        "contacts": tuple(notes_contacts.contact(page, c) for c in notes.contacts),
        **notes_reactions.tables(page, notes.free),
        **notes_principles.tables(page, notes.worked),
    }


def _by_motion(page: Page) -> Iterator[tuple[Motion[Form], LagrangeRow]]:
    moving = motions.of(page.derivation.model, ClosedForm())
    return zip(moving, page.derivation.rows, strict=True)


def _places(page: Page) -> dict[str, object]:
    """Positions, velocities of what moves, angular velocities."""
    style = page.style
    axes = AXES[: SPACES[page.derivation.model.space]]
    rows = []
    for place in page.derivation.places:
        moves = any(v.terms for v in place.velocity)
        for axis, at, speed in zip(axes, place.position, place.velocity, strict=True):
            name = style.index(axis, place.name)
            row = [(name, formula(page, arrange.motion, at))]
            if moves:
                row.append((style.dotted(name), formula(page, arrange.motion, speed)))
            rows.append(row)
    return {
        "places": style.pairs(rows) if rows else "",
        "spins_said": page.words["spins_body" if len(axes) > 2 else "spins"],
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
    return {
        "kinetic": _energy(page, "T", d.kinetic, arrange.kinetic, spelled(page, kinetic)),
        "potential": _energy(page, "V", d.potential, arrange.potential, spelled(page, potential)),
        "lagrangian": _lagrangian(page, kinetic, potential),
        "dissipation": _energy(
            page,
            "D",
            d.dissipation,
            arrange.dissipation,
            formula(page, arrange.dissipation, d.dissipation_function),
        ),
    }


def _lagrangian(page: Page, kinetic: Tree | int, potential: Tree | int) -> str:
    """L = T - V, written out unless it would only repeat two long formulas."""
    minus = page.style.formula(tree.negated(tree.ONE))[0]
    difference = f"T {minus} V"
    if not isinstance(kinetic, int) and not isinstance(potential, int):
        whole = joined([kinetic, tree.negated(potential)])
        if tree.size(whole) <= REPEATED:
            return page.style.display([(f"L = {difference}", page.style.formula(whole))])
    return page.style.display([("L", difference)])


def _energy(
    page: Page, letter: str, shares: Sequence[Contribution[Form]], how: How, total: str
) -> str:
    """Rows of the shares that are not zero, by owner, then the whole; nothing if all are zero."""
    owners: dict[str, list[Tree | int]] = {}
    for share in shares:
        if share.value.terms:
            owner = page.words["given"] if share.kind == "formula" else share.name
            owners.setdefault(owner, []).append(arranged(page, how, share.value))
    rows = [(page.style.index(letter, owner), _sum(page, found)) for owner, found in owners.items()]
    if not rows:
        return ""
    single = len(rows) == 1 and rows[0][1] == total
    return page.style.display([*(() if single else rows), (letter, total)])


def _sum(page: Page, found: Sequence[Tree | int]) -> str:
    trees = [t for t in found if not isinstance(t, int)]
    if len(trees) == len(found):
        return page.style.formula(joined(trees))
    return spelled(page, sum(t if isinstance(t, int) else tree.size(t) for t in found))


def _forces(page: Page) -> dict[str, object]:
    """The virtual work of what has no potential, and Q; nothing where there is no such force."""
    d, style = page.derivation, page.style
    ring = d.kinetic_energy.ring
    work = normal.total(ring, (share.value for share in d.virtual_work))
    rows = [
        (style.sub("Q", style.symbol(m.displacement)), formula(page, arrange.loads, row.force))
        for m, row in _by_motion(page)
    ]
    total = (style.symbol("delta W"), formula(page, arrange.work, work))
    return {"forces": style.display([total, *rows]) if work.terms else ""}


def _step(page: Page, motion: Motion[Form], row: LagrangeRow) -> dict[str, str]:
    """The partial derivatives of one motion."""
    style, own = page.style, motion.acceleration.name
    q, rate = style.symbol(motion.displacement), style.symbol(motion.rate.name)
    momentum = style.partial("L", rate)

    def moving(form: Form) -> str:
        return formula(page, lambda a, f: arrange.motion(a, f, own), form)

    rows = [
        (momentum, moving(row.momentum)),
        (style.rate(momentum), moving(row.momentum_rate)),
        (style.partial("L", q), moving(row.slope)),
    ]
    if row.gyroscopic is not None and motion.turn is not None:
        rows.append((style.gyroscopic(*_turn(motion.turn)), moving(row.gyroscopic)))
    if page.derivation.dissipation:
        rows.append((style.partial("D", rate), moving(row.dissipation)))
    if row.force.terms:
        rows.append((style.sub("Q", q), formula(page, arrange.loads, row.force)))
    said = page.words["steps_for" if motion.turn is None else "steps_turn"]
    return {"said": said, "symbol": style.inline(q), "rows": style.display(rows)}


def _turns_said(page: Page) -> str:
    """What the virtual turn about an axis is, where there are quaternions."""
    if not page.derivation.model.quaternions:
        return ""
    name = motions.turn_name(page.derivation.model.quaternions[0], 0)
    return page.words["turns"].format(math=page.style.inline(page.style.symbol(name)))


def _turn(turn: tuple[Quaternion, int]) -> tuple[str, str]:
    """The name of a quaternion and of one of its axes."""
    return turn[0].name, AXES[turn[1]]


def _equations(page: Page) -> dict[str, object]:
    """The equations of motion, in the speeds where the spec has some."""
    d, style = page.derivation, page.style
    speeds = d.model.speeds
    trivial = {s.symbol for s in speeds if s.symbol == s.formula}
    rates = [
        (style.symbol(c.rate.name), rate)
        for c, rate in zip(d.model.coordinates, d.rates, strict=bool(d.rates))
        if c.rate not in trivial
    ]
    return {
        "rates": style.display([(q, formula(page, arrange.motion, r)) for q, r in rates]),
        "equations": tuple(notes_equation.shown(page, e) for e in d.equations),
        "in_speeds": bool(speeds),
        "turns": _turns_said(page),
        "constraint_equations": notes_links_page.equations(page),
    }
