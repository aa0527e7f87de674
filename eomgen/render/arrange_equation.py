"""An equation of motion, sorted: accelerations, velocity terms, damping, stiffness, gravity = Q.

Common factors that never vanish are divided out, and said. Forces that only dissipate do not
hinder this: they are divided too, -c' phi' / (m_B l). Constraint forces do, unless they share them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from eomgen.algebra.normal import Form
from eomgen.mechanics.equations import REACTION, Equation, multiplier_name
from eomgen.render import tree
from eomgen.render.arrange import LOADS, Arranger, degree, sections
from eomgen.render.arrange_order import Kind
from eomgen.render.arrange_pieces import (
    Piece,
    common,
    of_term,
    ordered,
    shown,
    summed,
    without,
)
from eomgen.render.arrange_sums import bracket, collected, grouped, shortest
from eomgen.render.arrange_terms import Factors, Term, flat
from eomgen.render.tree import Number, Product, Symbol, Tree


@dataclass(frozen=True)
class Arranged:
    """left = right, after division by `divisor` (1: by nothing)."""

    name: str
    left: Tree
    right: Tree
    divisor: Tree = tree.ONE


Parts = Mapping[str, Sequence[Term]]  # the terms by origin, as in `Equation`

LOADED = ("damping", "elastic", "gravity", "other")
RIGHT = ("applied", "reaction")
UNKNOWN = (multiplier_name(""), REACTION)  # what the names of unknown forces begin with


def equation(arranger: Arranger, row: Equation) -> Arranged:
    """The displayed equation of a coordinate or a speed."""
    factors = arranger.factors(row.inertia.ring)
    given = {name: getattr(row, name) for name in ("inertia", *LOADED, *RIGHT)}
    parts: Parts = {name: flat(factors, form) if form else [] for name, form in given.items()}
    shared = _shared(factors, parts)
    parts = _over(factors, parts, shared)
    number = _number([t.number for terms in parts.values() for t in terms])
    own = arranger.order.accelerations.get(row.name)
    left = _left(factors, parts, own)
    if left and left[0].number < 0:
        number = -number
    parts = {name: [t._replace(number=t.number / number) for t in ts] for name, ts in parts.items()}
    divisor = tree.product(abs(number), factors.tree(factors.sort(shared.items())))
    return Arranged(row.name, _front(factors, parts, own), _right(factors, parts), divisor)


def _right(factors: Factors, parts: Parts) -> Tree:
    """What is applied, then what each constraint adds: F + lambda J."""
    applied = summed(factors, shortest(factors, parts["applied"], LOADS))
    return tree.total(tree.terms_of(applied) + _reaction(factors, parts["reaction"]))


def forces(arranger: Arranger, applied: Form, reaction: Form) -> Tree:
    """The forces on a body: unknown ones, then applied ones, positive ones first."""
    factors = arranger.factors(applied.ring)
    given = summed(factors, shortest(factors, flat(factors, applied), LOADS))
    terms = (*_reaction(factors, flat(factors, reaction)), *tree.terms_of(given))
    return tree.total(tuple(sorted(terms, key=lambda t: tree.split_sign(t)[0])))


def _reaction(factors: Factors, terms: Sequence[Term]) -> tuple[Tree, ...]:
    """One term for each multiplier, which stands in front: -2 lambda (x_2 - x_1)."""
    own = sorted(terms, key=lambda t: factors.place((_multiplier(factors, t), 1)))
    return tuple(_share(factors, g) for g in grouped(own, lambda t: _multiplier(factors, t)))


def _multiplier(factors: Factors, term: Term) -> int:
    """The factor that is a Lagrange multiplier or a reaction."""
    return next(f for f, _ in term.motion if _is_multiplier(factors.trees[f]))


def _is_multiplier(shown: Tree) -> bool:
    return isinstance(shown, Symbol) and shown.name.startswith(UNKNOWN)


def _share(factors: Factors, terms: Sequence[Term]) -> Tree:
    """The multiplier times its coefficient."""
    factor = _multiplier(factors, terms[0])
    rest = [t._replace(motion=without(factors, t.motion, {factor: 1})) for t in terms]
    piece = bracket(factors, rest, collected) if len(rest) > 1 else of_term(factors, rest[0])
    found, lead = shown(factors, piece), factors.trees[factor]
    match found:
        case Number(number):
            return tree.product(number, (lead,))
        case Product(coefficient, symbols, divisors):
            return tree.product(coefficient, (lead, *symbols), divisors)
    return tree.product(Fraction(1), (lead, found))


def _left(factors: Factors, parts: Parts, own: str | None) -> list[Piece]:
    """Pieces of the left side, the equation's own acceleration first."""
    pieces = [p for part in sections(factors, parts["inertia"], own) for p in part]
    for name in LOADED:
        pieces += ordered(shortest(factors, parts[name], LOADS))
    return pieces


def _front(factors: Factors, parts: Parts, own: str | None) -> Tree:
    """The left side; m (R'' - R theta'^2) where what drives it keeps m from leaving."""
    left = [t for name in ("inertia", *LOADED) for t in parts[name]]
    shared = common([t.parameters for t in left]) if left else {}
    driven = any(_is_driven(factors, t) for name in RIGHT for t in parts[name])
    if len(left) < 2 or len(shared) != 1 or not driven:
        return tree.total(tuple(shown(factors, p) for p in _left(factors, parts, own)))
    inside = _left(factors, _over(factors, parts, shared), own)
    bracket = tree.total(tuple(shown(factors, p) for p in inside))
    return tree.product(Fraction(1), (*factors.tree(tuple(shared.items())), bracket))


def _is_driven(factors: Factors, term: Term) -> bool:
    """Whether an input or a multiplier acts in the term."""
    return any(factors.kind(f) is Kind.INPUT for f, _ in term.motion)


def _shared(factors: Factors, parts: Parts) -> dict[int, int]:
    """Powers of what never vanishes that all terms have, those that only dissipate left aside."""
    held = [t for name in parts if name not in ("damping", "applied") for t in parts[name]]
    held += [t for t in parts["applied"] if _is_driven(factors, t) or not degree(factors, t)]
    shared = common([t.parameters + t.motion for t in held]) if held else {}
    return {f: e for f, e in shared.items() if e > 0 and _never_vanishes(factors, f)}


def _never_vanishes(factors: Factors, factor: int) -> bool:
    shown_as = factors.trees[factor]
    return isinstance(shown_as, Symbol) and shown_as.name in factors.order.nonzero


def _over(factors: Factors, parts: Parts, shared: dict[int, int]) -> Parts:
    """Every term divided."""
    fixed = {f: e for f, e in shared.items() if factors.kind(f) <= Kind.PARAMETER}
    moving = {f: e for f, e in shared.items() if f not in fixed}
    return {
        name: [
            Term(
                t.number, without(factors, t.parameters, fixed), without(factors, t.motion, moving)
            )
            for t in terms
        ]
        for name, terms in parts.items()
    }


def _number(numbers: Sequence[Fraction]) -> Fraction:
    """The number of which all are whole multiples, unless one of them is 1 already."""
    smallest = min((abs(n) for n in numbers), default=Fraction(1))
    whole = all((n / smallest).denominator == 1 for n in numbers)
    return smallest if whole and all(abs(n) != 1 for n in numbers) else Fraction(1)
