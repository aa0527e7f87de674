"""Perfect powers in a sum: 1/2 k (s - l_0)^2, 1/2 I_3 (psi' + phi' cos theta)^2."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from sympy.polys.domains import QQ
from sympy.polys.rings import ring

from eomgen.render import tree
from eomgen.render.arrange_order import Kind
from eomgen.render.arrange_pieces import Piece, common, negated, rank, summed, without
from eomgen.render.arrange_sums import collected
from eomgen.render.arrange_terms import Factors, Term, flat

MOST = 16  # terms of a sum that is tried


def by_power(factors: Factors, terms: Sequence[Term]) -> list[Piece]:
    """Groups that share a parameter and are a power, as pieces; nothing if there is none."""
    left, pieces = list(terms), []
    for group in _groups(factors, terms):
        if all(t in left for t in group) and (piece := _as_power(factors, group)):
            pieces.append(piece)
            left = [t for t in left if t not in group]
    return pieces + collected(factors, left) if pieces else []


def by_whole_power(factors: Factors, terms: Sequence[Term]) -> list[Piece]:
    """As `by_power`, unless products of two rates are left: those show the mass matrix."""
    pieces = by_power(factors, terms)
    crossing = [p for p in pieces if sum(factors.kind(f) is Kind.RATE for f, _ in p.motion) > 1]
    return pieces if not crossing else []


def _groups(factors: Factors, terms: Sequence[Term]) -> list[list[Term]]:
    """Terms that share a parameter, as declared; at last all of them."""
    groups: dict[int, list[Term]] = {}
    for term in terms:
        for factor, exponent in term.parameters:
            if exponent > 0:
                groups.setdefault(factor, []).append(term)
    declared = [groups[f] for f in sorted(groups, key=lambda f: factors.place((f, 1)))]
    return [g for g in (*declared, list(terms)) if 3 <= len(g) <= MOST]


def _as_power(factors: Factors, terms: list[Term]) -> Piece | None:
    """number * parameters * motion * sum^n with n > 1, if the terms are that."""
    parameters, motion = common([t.parameters for t in terms]), common([t.motion for t in terms])
    rest = _with_roots(factors, [
        Term(t.number, without(factors, t.parameters, parameters),
             without(factors, t.motion, motion))
        for t in terms
    ])  # fmt: skip
    if len(rest) < 3 or sum(_is_square(t) for t in rest) < 2:
        return None
    found = _root(factors, rest)
    if found is None:
        return None
    number, base, exponent = found
    return Piece(
        number,
        factors.sort(parameters.items()),
        factors.sort(motion.items()),
        last=(tree.Power(base, exponent),),
        rank=min(rank(factors, t) for t in terms),
    )


def _is_square(term: Term) -> bool:
    """A necessary mark of the corners of a power: no factor occurs to the first power."""
    return all(abs(e) > 1 for _, e in term.parameters + term.motion)


def _with_roots(factors: Factors, terms: list[Term]) -> list[Term]:
    """The terms with x^2 + y^2 written as the square of the root r, where r itself occurs."""
    found = {f for t in terms for f, e in t.motion if e == 1 and f in factors.squares}
    for root in sorted(found):
        square = flat(factors, factors.squares[root])
        numbers = {(t.parameters, t.motion): t.number for t in terms}
        first = square[0]
        ratio = numbers.get((first.parameters, first.motion), Fraction(0)) / first.number
        for t in square:
            key = (t.parameters, t.motion)
            numbers[key] = numbers.get(key, Fraction(0)) - ratio * t.number
        numbers[(), ((root, 2),)] = ratio
        folded = [Term(c, *key) for key, c in numbers.items() if c]
        terms = folded if len(folded) < len(terms) else terms
    return terms


def _root(factors: Factors, terms: list[Term]) -> tuple[Fraction, tree.Tree, int] | None:
    """(number, base, n) with terms = number * base^n, n > 1."""
    powers = [t.parameters + t.motion for t in terms]
    if any(e < 0 for p in powers for _, e in p):
        return None
    names = list(dict.fromkeys(f for p in powers for f, _ in p))
    dense = [tuple(dict(p).get(f, 0) for f in names) for p in powers]
    numbers = [QQ(t.number.numerator, t.number.denominator) for t in terms]
    polynomials = ring([f"x{f}" for f in names], QQ)[0]
    number, roots = polynomials.from_dict(dict(zip(dense, numbers, strict=True))).factor_list()
    if len(roots) != 1 or roots[0][1] < 2:
        return None
    base, exponent = roots[0]
    flipped, shown = _base(factors, _terms(factors, names, base))
    return _fraction(number) * (-1 if flipped and exponent % 2 else 1), shown, exponent


def _terms(factors: Factors, names: list[int], polynomial: Any) -> list[Term]:
    """The terms of a polynomial whose generators are the factors `names`."""
    terms = []
    for exponents, c in polynomial.terms():
        powers = factors.sort(zip(names, exponents, strict=True))
        fixed = tuple(p for p in powers if factors.kind(p[0]) <= Kind.PARAMETER)
        terms.append(Term(_fraction(c), fixed, tuple(p for p in powers if p not in fixed)))
    return terms


def _base(factors: Factors, terms: list[Term]) -> tuple[bool, tree.Tree]:
    """(whether the sign was changed, the sum with its first term positive)."""
    pieces = collected(factors, terms)
    flipped = min(pieces, key=lambda p: p.rank).number < 0
    return flipped, summed(factors, [negated(p) for p in pieces] if flipped else pieces)


def _fraction(number: Any) -> Fraction:
    return Fraction(int(number.numerator), int(number.denominator))
