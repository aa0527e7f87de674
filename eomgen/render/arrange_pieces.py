"""Pieces of a sum: number * coefficient sum * parameters * coordinates * sum * rates * functions.

Also the order of the pieces, and which number is taken out of a bracket.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from eomgen.render import tree
from eomgen.render.arrange_order import Kind, Rank
from eomgen.render.arrange_terms import Factors, Powers, Term
from eomgen.render.tree import Tree

HALF = Fraction(1, 2)


@dataclass(frozen=True)
class Piece:
    """One term of a sum with what was collected in it.

    coefficient: sums of parameters, printed first; inner: sums that multiply rates, before them;
    last: other sums of what moves, before functions only.
    """

    number: Fraction
    parameters: Powers
    motion: Powers
    coefficient: tuple[Tree, ...] = ()
    inner: tuple[Tree, ...] = ()
    last: tuple[Tree, ...] = ()
    rank: tuple[object, ...] = ()


def of_term(factors: Factors, term: Term) -> Piece:
    """A term by itself."""
    return Piece(*term, rank=rank(factors, term))


def negated(piece: Piece) -> Piece:
    """The piece with the other sign."""
    return replace(piece, number=-piece.number)


def shown(factors: Factors, piece: Piece) -> Tree:
    """The piece as displayed."""
    above, below = _sides(_with_tangents(factors, piece.parameters))
    # x tan theta, not tan theta x
    plain = tuple(p for p in above if not factors.is_function(p[0]))
    constant = tuple(p for p in above if factors.is_function(p[0]))
    moving, divisors = _sides(_with_tangents(factors, piece.motion))
    early = tuple(p for p in moving if factors.kind(p[0]) < Kind.ACCELERATION)
    rates = tuple(p for p in moving if factors.kind(p[0]) in (Kind.ACCELERATION, Kind.RATE))
    late = tuple(p for p in moving if factors.kind(p[0]) > Kind.RATE)
    symbols = factors.tree(early) + piece.inner + factors.tree(rates)
    return tree.product(
        piece.number,
        piece.coefficient
        + factors.tree(plain)
        + symbols
        + piece.last
        + factors.tree(constant + late),
        factors.tree(below) + factors.tree(divisors),
    )


def _sides(powers: Powers) -> tuple[Powers, Powers]:
    """(numerator, denominator)."""
    return tuple(p for p in powers if p[1] > 0), tuple((f, -e) for f, e in powers if e < 0)


def _with_tangents(factors: Factors, powers: Powers) -> Powers:
    """Powers in which sin^n / cos^n of one angle is tan^n."""
    exponents = dict(powers)
    for factor, exponent in powers:
        partner = factors.tangent(factor) if exponent > 0 else None
        if partner is not None and exponents.get(partner[0]) == -exponent:
            del exponents[factor], exponents[partner[0]]
            exponents[partner[1]] = exponent
    return powers if len(exponents) == len(powers) else factors.sort(exponents.items())


def summed(factors: Factors, pieces: Sequence[Piece]) -> Tree:
    """Pieces as a sum in which a positive term leads, if there is one."""
    return tree.total(tuple(shown(factors, p) for p in ordered(pieces)))


def ordered(pieces: Sequence[Piece]) -> list[Piece]:
    """Pieces by rank, the first positive one in front."""
    ranked = sorted(pieces, key=lambda p: p.rank)
    first = next((i for i, p in enumerate(ranked) if p.number > 0), 0)
    return ranked[first : first + 1] + ranked[:first] + ranked[first + 1 :]


def rank(factors: Factors, term: Term) -> tuple[object, ...]:
    """Sort key of a term: inputs, accelerations, squares of rates, other rates, positions.

    Among positions s - l_0 and J + m l^2 cos q: symbols, then constants, then functions.
    """
    known = factors.keys.get(term.motion)
    if known is None:
        known = factors.keys[term.motion] = _rank_of_motion(factors, term.motion)
    return (known, tuple((factors.ranks[f], -e) for f, e in term.parameters))


def _rank_of_motion(factors: Factors, motion: Powers) -> tuple[object, ...]:
    ranks = [(factors.ranks[f], -e) for f, e in motion]
    by_kind: dict[Kind, list[tuple[Rank, int]]] = {}
    for item in ranks:
        by_kind.setdefault(item[0][0], []).append(item)
    rates = by_kind.get(Kind.RATE, [])
    return (
        by_kind.get(Kind.VIRTUAL, []),
        Kind.INPUT not in by_kind,
        Kind.ACCELERATION not in by_kind,
        by_kind.get(Kind.ACCELERATION, []),
        sum(e for _, e in rates),
        len(rates),
        rates,
        standing(factors, motion),
        -sum(e for _, e in by_kind.get(Kind.COORDINATE, [])),
        ranks,
    )


def standing(factors: Factors, motion: Powers) -> int:
    """0 with a symbol or a length, 1 for a constant, 2 for sines, cosines and quotients alone."""
    held = [(f, e) for f, e in motion if factors.kind(f) in (Kind.COORDINATE, Kind.FUNCTION)]
    solid = [f for f, e in held if e > 0 and f not in factors.waves]
    return 0 if solid else (2 if held else 1)


def oriented(factors: Factors, pieces: Sequence[Piece]) -> tuple[int, list[Piece]]:
    """(sign, pieces * sign): -k (s - l_0), not k (l_0 - s), yet c (x_2' - x_1')."""
    ranked = sorted(pieces, key=lambda p: p.rank)
    foremost = min(standing(factors, p.motion) for p in ranked)
    negative = [p.number < 0 for p in ranked if standing(factors, p.motion) == foremost]
    if negative[0] and (len(negative) != 2 or all(negative)):
        return -1, [negated(p) for p in ranked]
    return 1, ranked


def content(numbers: Iterable[Fraction], moving: bool = False) -> Fraction:
    """What is taken out of a bracket whose terms have these numbers.

    3/2 m_A + m_B stays; 3/4 m_A + 1/2 m_B gives 1/2. A moving bracket such as
    s'^2 + l^2 phi'^2 + 2 l s' phi' is freed of fractions wherever that is possible.
    """
    absolute = [abs(n) for n in numbers]
    smallest = min(absolute)
    whole = all((n / smallest).denominator == 1 for n in absolute)
    if moving and whole:
        return smallest
    if 1 in absolute:
        return Fraction(1)
    if HALF in absolute:
        return HALF
    return smallest if whole else Fraction(1)


def common(powers: Sequence[Powers]) -> dict[int, int]:
    """The powers that all have: the least positive exponent, or the one nearest to zero below."""
    shared = dict(powers[0])
    for other in powers[1:]:
        exponents = dict(other)
        shared = {
            f: min(e, exponents[f], key=abs)
            for f, e in shared.items()
            if f in exponents and (e > 0) == (exponents[f] > 0)
        }
    return shared


def without(factors: Factors, powers: Powers, shared: dict[int, int]) -> Powers:
    """powers / shared."""
    if not shared:
        return powers
    exponents = dict(powers)
    if shared.keys() <= exponents.keys():
        # the order stays
        return tuple((f, left) for f, e in powers if (left := e - shared.get(f, 0)))
    for factor, exponent in shared.items():
        exponents[factor] = exponents.get(factor, 0) - exponent
    return factors.sort(exponents.items())
