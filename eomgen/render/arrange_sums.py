"""Common structure of a sum: (m_A + m_B) s'', (J + m l^2) phi'', m (R'^2 + R^2 theta'^2)."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import replace
from typing import TypeVar

from eomgen.render import tree
from eomgen.render.arrange_order import Kind
from eomgen.render.arrange_pieces import (
    Piece,
    common,
    content,
    of_term,
    oriented,
    rank,
    shown,
    summed,
    without,
)
from eomgen.render.arrange_terms import Factors, Powers, Term

LEADS = (Kind.ACCELERATION, Kind.RATE, Kind.VIRTUAL)
WIDEST = 8  # terms of a bracket; what is longer stays in terms, so that lines can break

LONGEST = 60  # terms of a sum that is arranged in more than one way

Item = TypeVar("Item")
Strategy = Callable[[Factors, Sequence[Term]], list[Piece]]


def grouped(items: Sequence[Item], key: Callable[[Item], Hashable]) -> list[list[Item]]:
    """The items by key, groups in the order of their first item."""
    groups: dict[Hashable, list[Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return list(groups.values())


def shortest(
    factors: Factors, terms: Sequence[Term], strategies: Sequence[Strategy]
) -> list[Piece]:
    """What the first of the strategies that show least makes of the terms."""
    if len(terms) < 2:
        return [of_term(factors, t) for t in terms]
    tried = strategies if len(terms) <= LONGEST else strategies[:1]
    found = [pieces for strategy in tried if (pieces := strategy(factors, terms))]
    return found[0] if len(found) == 1 else min(found, key=lambda p: _length(factors, p))


def _length(factors: Factors, pieces: Sequence[Piece]) -> int:
    return sum(tree.length(shown(factors, p)) for p in pieces)


def collected(factors: Factors, terms: Sequence[Term]) -> list[Piece]:
    """Terms with the same motion, then the same rates, then the same coefficient, put together."""
    by_lead = grouped(sorted(terms, key=lambda t: rank(factors, t)), lambda t: _lead(factors, t))
    pieces = [p for group in by_lead for p in _one_lead(factors, group)]
    return [p for group in grouped(pieces, _coefficient) for p in _shared(factors, group)]


def _lead(factors: Factors, term: Term) -> Powers:
    """The virtual displacement of a term, else its accelerations and rates."""
    virtual = tuple(p for p in term.motion if factors.kind(p[0]) is Kind.VIRTUAL)
    return virtual or tuple(p for p in term.motion if factors.kind(p[0]) in LEADS)


def _one_lead(factors: Factors, terms: list[Term]) -> list[Piece]:
    """Terms with the same rates: one bracket, if it is not too long."""
    pieces = [
        p for group in grouped(terms, lambda t: t.motion) for p in _one_motion(factors, group)
    ]
    lead = _lead(factors, terms[0])
    if len(pieces) < 2 or not lead or len(terms) > WIDEST:
        return pieces
    found = bracket(factors, terms, collected)
    return [replace(found, inner=found.last, last=())]


def bracket(factors: Factors, terms: Sequence[Term], inside: Strategy) -> Piece:
    """number * parameters * (sum) * motion, with all that the terms have in common outside."""
    parameters = common([t.parameters for t in terms])
    motion = common([t.motion for t in terms])
    rest = [
        Term(t.number, without(factors, t.parameters, parameters),
             without(factors, t.motion, motion))
        for t in terms
    ]  # fmt: skip
    number = content([t.number for t in rest], moving=True)
    rest = [t._replace(number=t.number / number) for t in rest]
    pieces = inside(factors, rest)
    sign, pieces = oriented(factors, pieces)
    return Piece(
        sign * number,
        factors.sort(parameters.items()),
        factors.sort(motion.items()),
        last=(summed(factors, pieces),),
        rank=min(rank(factors, t) for t in terms),
    )


def _one_motion(factors: Factors, terms: list[Term]) -> list[Piece]:
    """Terms that differ in their parameters: (m_A + m_B) l s'', a constant in plain terms."""
    if len(terms) == 1:
        return [of_term(factors, terms[0])]
    shared = common([t.parameters for t in terms])
    if not shared and not terms[0].motion:
        return _by_cofactor(factors, terms)
    number = content([t.number for t in terms])
    rest = [Term(t.number / number, without(factors, t.parameters, shared), ()) for t in terms]
    sign, pieces = oriented(factors, _by_cofactor(factors, rest))
    return [
        Piece(
            sign * number,
            factors.sort(shared.items()),
            terms[0].motion,
            coefficient=(summed(factors, pieces),),
            rank=rank(factors, terms[0]),
        )
    ]


def _by_cofactor(factors: Factors, terms: Sequence[Term]) -> list[Piece]:
    """Parameters such as J + m_1 l^2 + m_2 l^2, put together as J + (m_1 + m_2) l^2."""
    left, pieces = list(terms), []
    while len(left) > 2:
        groups: dict[Powers, list[Term]] = {}
        for term in left:
            for cofactor in _cofactors(term.parameters):
                groups.setdefault(cofactor, []).append(term)
        largest = max(groups.values(), key=len, default=[])
        if not 2 <= len(largest) < len(left):
            break
        pieces += _one_motion(factors, largest)
        taken = set(map(id, largest))
        left = [t for t in left if id(t) not in taken]
    return pieces + [of_term(factors, t) for t in left]


def _cofactors(powers: Powers) -> list[Powers]:
    """The powers without one of their plain factors; none of a single factor."""
    if len(powers) < 2:
        return []
    return [powers[:i] + powers[i + 1 :] for i, (_, e) in enumerate(powers) if e == 1]


def _coefficient(piece: Piece) -> Hashable:
    """Pieces with an equal key may share their coefficient and their denominator."""
    if piece.inner + piece.last:
        return id(piece)
    return piece.parameters, piece.coefficient, tuple(p for p in piece.motion if p[1] < 0)


def _shared(factors: Factors, pieces: list[Piece]) -> list[Piece]:
    """Pieces with one coefficient: c (x1' - x2'), (x x' + y y') / r; numbers alone stay."""
    first = pieces[0]
    divided = any(e < 0 for _, e in first.motion)
    if len(pieces) == 1 or not (first.parameters or first.coefficient or divided):
        return pieces
    if any(not p.motion for p in pieces):
        return pieces
    motion = common([p.motion for p in pieces])
    number = content([p.number for p in pieces], moving=True)
    rest = [
        of_term(factors, Term(p.number / number, (), without(factors, p.motion, motion)))
        for p in pieces
    ]
    sign, rest = oriented(factors, rest)
    return [
        Piece(
            sign * number,
            first.parameters,
            factors.sort(motion.items()),
            first.coefficient,
            last=(summed(factors, rest),),
            rank=min(p.rank for p in pieces),
        )
    ]


def by_parameter(factors: Factors, terms: Sequence[Term]) -> list[Piece]:
    """Terms that share a parameter: k (s - l_0), k x (1 - l_0 / r); one must be free of others."""
    left, pieces = list(terms), []
    while group := _largest(factors, left):
        pieces.append(bracket(factors, group, collected))
        taken = set(map(id, group))
        left = [t for t in left if id(t) not in taken]
    return pieces + collected(factors, left)


def _largest(factors: Factors, terms: Sequence[Term]) -> list[Term]:
    """The most terms that share a parameter, the first declared on a tie; empty if none do."""
    groups: dict[int, list[Term]] = {}
    for term in terms:
        for factor, exponent in term.parameters:
            if exponent > 0:
                groups.setdefault(factor, []).append(term)
    fit = [groups[f] for f in sorted(groups, key=lambda f: factors.place((f, 1)))]
    return max((g for g in fit if _has_bare(factors, g)), key=len, default=[])


def _has_bare(factors: Factors, terms: list[Term]) -> bool:
    shared = common([t.parameters for t in terms])
    return len(terms) > 1 and any(not without(factors, t.parameters, shared) for t in terms)


def by_content(factors: Factors, terms: Sequence[Term]) -> list[Piece]:
    """All terms in one bracket if they share a parameter, else nothing."""
    shared = common([t.parameters for t in terms])
    return [bracket(factors, terms, collected)] if shared else []


def by_weight(factors: Factors, terms: Sequence[Term]) -> list[Piece]:
    """-m g (l_1 cos q_1 + l_2 cos q_2), but g alone is not taken out of a potential."""
    shared = common([t.parameters for t in terms])
    return [bracket(factors, terms, collected)] if len(shared) > 1 else []
