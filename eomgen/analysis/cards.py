"""A card for each constraint: what kind it is, decided, and all its forms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from eomgen.algebra import normal
from eomgen.algebra.closed import ClosedForm, to_sympy
from eomgen.algebra.normal import Form, Kernel
from eomgen.analysis import admissible, integrability, rank
from eomgen.analysis import linkage as linkages
from eomgen.analysis.admissible import Admissible
from eomgen.analysis.integrability import Hidden, Integrability
from eomgen.analysis.rank import Freedom
from eomgen.analysis.virtual import symbol
from eomgen.compile import Machine
from eomgen.mechanics import constraints, lagrange
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.vectors import dot
from eomgen.model import TIME, Constraint, Model


@dataclass(frozen=True)
class Card:
    """What is known of one constraint; forms have one entry for each of its rows."""

    name: str
    text: str  # as it was written
    kind: str  # as it was written: holonomic, nonholonomic, unilateral
    rows: tuple[str, ...]
    is_bilateral: bool
    is_scleronomic: bool  # no explicit time and no prescribed motion
    is_holonomic: bool  # decided: it holds between positions, or can be integrated
    residuals: tuple[Form, ...]  # phi, or the rate of a nonholonomic one; a gap is >= 0
    rates: tuple[Form, ...]
    virtual: tuple[Form, ...]  # delta phi at frozen time, linear in the virtual displacements
    hidden: tuple[Hidden, ...]  # relations between positions that were found behind rates
    is_hidden_form_known: bool  # every row that can be integrated was
    redundant: tuple[str, ...]  # rows that follow from other rows
    growth: tuple[tuple[int, ...], ...]  # of each rate row alone


@dataclass(frozen=True)
class Report:
    """All that is decided of a scene's constraints."""

    cards: tuple[Card, ...]
    freedom: Freedom
    integrability: Integrability
    initial: Admissible
    states: tuple[Admissible, ...]


def report(machine: Machine) -> Report:
    """The cards of a scene with its degrees of freedom.

    Raises:
        UsageError: no admissible state, or constraints that cannot be imposed.
    """
    initial = admissible.positions(machine)
    states = admissible.draw(machine, rank.STATES, first=initial)
    decided = integrability.decide(machine, states)
    freedom = rank.freedom(machine, states, decided.hidden)
    return Report(
        cards=_cards(machine.model, freedom, decided),
        freedom=freedom,
        integrability=decided,
        initial=initial,
        states=states,
    )


def _cards(model: Model, freedom: Freedom, decided: Integrability) -> tuple[Card, ...]:
    kinematics = lagrange.closed_kinematics(linkages.without_speeds(model))
    return tuple(
        _card(
            constraint, constraints.of(kinematics, constraint), (kinematics.model, freedom, decided)
        )
        for constraint in kinematics.model.constraints
    )


def _card(
    constraint: Constraint, rows: Sequence[Row[Form]], known: tuple[Model, Freedom, Integrability]
) -> Card:
    model, freedom, decided = known
    names = tuple(row.name for row in rows)
    verdicts = [v for v in decided.verdicts if v.row in names]
    hidden = tuple(v.hidden for v in verdicts if v.hidden is not None)
    residuals = tuple(r.rate if r.residual is None else r.residual for r in rows)
    timed = [*residuals, *(h.relation for h in hidden)]
    return Card(
        name=constraint.name,
        text=constraint.text,
        kind=constraint.kind,
        rows=names,
        is_bilateral=constraint.kind != "unilateral",
        is_scleronomic=not any(depends_on_time(model, f) for f in timed),
        # a one-sided relation eliminates no coordinate: the lecture does not call it holonomic
        is_holonomic=constraint.kind != "unilateral" and all(v.is_integrable for v in verdicts),
        residuals=residuals,
        rates=tuple(r.rate for r in rows),
        virtual=tuple(virtual_form(model, r) for r in rows),
        hidden=hidden,
        is_hidden_form_known=all(v.hidden is not None for v in verdicts if v.is_integrable),
        redundant=tuple(n for n in names if n in freedom.dropped),
        growth=tuple(v.growth for v in verdicts),
    )


def virtual_form(model: Model, row: Row[Form]) -> Form:
    """Sum of J_j delta q_j: the first variation at frozen time."""
    algebra = ClosedForm(row.rate.ring)
    return dot(row.jacobian, [algebra.of(symbol(c)) for c in model.coordinates])


def depends_on_time(model: Model, form: Form) -> bool:
    """Whether explicit time or a prescribed motion is in the form."""
    moving = {TIME}
    for known in model.prescribed:
        moving |= {known.symbol, known.rate, known.acceleration}
    return not moving.isdisjoint(symbols_of(form))


def symbols_of(form: Form) -> set[sp.Symbol]:
    """The symbols of a form, those in the arguments of its functions included."""
    found: set[sp.Symbol] = set()
    for atom in normal.atoms_of(form):
        what = form.ring.atoms[atom]
        if isinstance(what, Kernel):
            found = found.union(*(symbols_of(a) for a in what.arguments))
        elif isinstance(what, sp.Symbol):
            found.add(what)
    return found


def to_json(card: Card) -> dict[str, Any]:
    """The card as JSON values, formulas as text."""
    return {
        "name": card.name,
        "text": card.text,
        "written_as": card.kind,
        "rows": list(card.rows),
        "bilateral": card.is_bilateral,
        "scleronomic": card.is_scleronomic,
        "holonomic": card.is_holonomic,
        "residuals": _texts(card.residuals),
        "rates": _texts(card.rates),
        "virtual": _texts(card.virtual),
        "hidden": [
            {
                "of": {row: str(share) for row, share in h.shares},
                "relation": str(to_sympy(h.relation)),
                "factor": str(to_sympy(h.factor)),
                "constants": list(h.constants),
            }
            for h in card.hidden
        ],
        "hidden_form_known": card.is_hidden_form_known,
        "redundant": list(card.redundant),
        "growth": [list(g) for g in card.growth],
    }


def _texts(forms: Sequence[Form]) -> list[str]:
    return [str(to_sympy(f)) for f in forms]
