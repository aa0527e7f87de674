"""Closed form -> displayed tree, as a textbook writes it.

Each kind of quantity is shown in the shortest of the arrangements that suit it, the first on a tie.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from eomgen.algebra.normal import Form, Ring
from eomgen.model import Model
from eomgen.render import arrange_order, tree
from eomgen.render.arrange_order import Kind, Order
from eomgen.render.arrange_pieces import Piece, ordered, shown, summed
from eomgen.render.arrange_powers import by_power, by_whole_power
from eomgen.render.arrange_sums import (
    Strategy,
    by_content,
    by_parameter,
    by_weight,
    collected,
    shortest,
)
from eomgen.render.arrange_terms import Factors, Term, flat
from eomgen.render.tree import Symbol, Tree

INERTIA: tuple[Strategy, ...] = (collected, by_power)
WORK: tuple[Strategy, ...] = (collected,)
LOADS: tuple[Strategy, ...] = (collected, by_power, by_parameter)
KINETIC: tuple[Strategy, ...] = (collected, by_whole_power, by_content)
POTENTIAL: tuple[Strategy, ...] = (collected, by_power, by_weight, by_parameter)
DISSIPATION: tuple[Strategy, ...] = (collected, by_power)


@dataclass
class Arranger:
    """What arranges the forms of one model; remembers the factors of every ring that it met."""

    order: Order
    tables: dict[int, Factors] = field(default_factory=dict)

    def factors(self, ring: Ring) -> Factors:
        """The factors of a ring; the table keeps the ring alive, so that its id stays its own."""
        if id(ring) not in self.tables:
            self.tables[id(ring)] = Factors(ring, self.order, _argument)
        return self.tables[id(ring)]


def of_model(model: Model) -> Arranger:
    """The arranger of a model's forms."""
    return Arranger(arrange_order.of_model(model))


def _argument(factors: Factors, form: Form) -> Tree:
    """The inside of a function."""
    return summed(factors, shortest(factors, flat(factors, form), LOADS))


def degree(factors: Factors, term: Term) -> int:
    """The degree of a term in the rates."""
    return sum(e for f, e in term.motion if factors.kind(f) is Kind.RATE)


def _shortest(arranger: Arranger, form: Form, strategies: tuple[Strategy, ...]) -> Tree:
    factors = arranger.factors(form.ring)
    return summed(factors, shortest(factors, flat(factors, form), strategies))


def kinetic(arranger: Arranger, form: Form) -> Tree:
    """1/2 (m_A + m_B) s'^2 + ..., 1/2 m (R'^2 + R^2 theta'^2): squares first, then products."""
    return _shortest(arranger, form, KINETIC)


def potential(arranger: Arranger, form: Form) -> Tree:
    """1/2 k (s - l_0)^2 - m g l cos phi."""
    return _shortest(arranger, form, POTENTIAL)


def dissipation(arranger: Arranger, form: Form) -> Tree:
    """1/2 c (x_1' - x_2')^2."""
    return _shortest(arranger, form, DISSIPATION)


def motion(arranger: Arranger, form: Form, own: str | None = None) -> Tree:
    """A position, a momentum or its rate, a slope: by accelerations, `own` first, then by rates."""
    factors = arranger.factors(form.ring)
    parts = list(sections(factors, flat(factors, form), own))
    *moving, resting = parts
    pieces = [p for part in moving for p in sorted(part, key=lambda p: p.rank)]
    pieces += ordered(resting)
    if any(parts[:-2]):
        return tree.total(tuple(shown(factors, p) for p in pieces))
    return summed(factors, pieces)


def sections(
    factors: Factors, terms: Sequence[Term], own: str | None = None
) -> Iterator[list[Piece]]:
    """Pieces with each acceleration, `own` first, then those with rates, then the others."""
    first = Symbol(own) if own else None
    held: dict[int, list[Term]] = {}
    rates: list[Term] = []
    rest: list[Term] = []
    for term in terms:
        lead = next((f for f, _ in term.motion if factors.kind(f) is Kind.ACCELERATION), None)
        moving = rates if degree(factors, term) else rest
        (moving if lead is None else held.setdefault(lead, [])).append(term)
    for lead in sorted(held, key=lambda f: (factors.trees[f] != first, factors.place((f, 1)))):
        yield shortest(factors, held[lead], INERTIA)
    yield shortest(factors, rates, INERTIA)
    yield shortest(factors, rest, LOADS)


def loads(arranger: Arranger, form: Form) -> Tree:
    """A generalized force: inputs first, F - c (x_1' - x_2') - k (s - l_0)."""
    return _shortest(arranger, form, LOADS)


def work(arranger: Arranger, form: Form) -> Tree:
    """Virtual work: one bracket for each virtual displacement, as declared."""
    return _shortest(arranger, form, WORK)
