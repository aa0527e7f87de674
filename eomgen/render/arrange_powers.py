"""Factors of a sum: 1/2 k (s - l_0)^2, I_3 (psi' + phi' cos theta)^2, k (x - y) (1 - l_0 / r)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import isqrt
from typing import Any

from sympy.polys.domains import QQ
from sympy.polys.rings import ring

from eomgen.render import tree
from eomgen.render.arrange_order import Kind
from eomgen.render.arrange_pieces import Piece, common, negated, rank, summed, without
from eomgen.render.arrange_sums import LEADS, collected
from eomgen.render.arrange_terms import Factors, Powers, Term, flat

MOST = 20  # terms of a sum that is tried
FEW = 8  # terms, and factors in them, where a polynomial is factored

Factored = tuple[Fraction, tuple[tree.Tree, ...]]  # number * sums


def by_power(factors: Factors, terms: Sequence[Term]) -> list[Piece]:
    """Groups that share a parameter and have factors, as pieces; nothing if there is none."""
    # terms are told apart by identity: comparing their numbers would cost more than the rest
    left, pieces = {id(t): t for t in terms}, []
    for group in _groups(factors, terms):
        if all(id(t) in left for t in group) and (piece := _factored(factors, group)):
            pieces.append(piece)
            for t in group:
                del left[id(t)]
    return pieces + collected(factors, list(left.values())) if pieces else []


def by_whole_power(factors: Factors, terms: Sequence[Term]) -> list[Piece]:
    """As `by_power`, unless products of two rates are left: those show the mass matrix."""
    pieces = by_power(factors, terms)
    crossing = [p for p in pieces if sum(factors.kind(f) is Kind.RATE for f, _ in p.motion) > 1]
    return pieces if not crossing else []


def _groups(factors: Factors, terms: Sequence[Term]) -> Iterator[list[Term]]:
    """Terms that share a parameter, as declared, whole and in unconnected parts; then all."""
    groups: dict[int, list[Term]] = {}
    for term in terms:
        for factor, exponent in term.parameters:
            if exponent > 0:
                groups.setdefault(factor, []).append(term)
    declared = [groups[f] for f in sorted(groups, key=lambda f: factors.place((f, 1)))]
    seen: set[tuple[int, ...]] = set()
    for group in (*declared, list(terms)):
        names = tuple(sorted(map(id, group)))
        if names not in seen and _may_be_power(factors, group):
            seen.add(names)
            yield from (p for p in (group, *_parts(factors, group)) if 3 <= len(p) <= MOST)


def _may_be_power(factors: Factors, terms: list[Term]) -> bool:
    """A cheap necessary mark: two terms with a square, or a root, or a quotient."""
    powers = [t.parameters + t.motion for t in terms]
    squares = sum(any(abs(e) > 1 for _, e in p) for p in powers)
    return squares > 1 or any(e < 0 or f in factors.squares for p in powers for f, e in p)


def _parts(factors: Factors, terms: list[Term]) -> list[list[Term]]:
    """The terms split where no part moves with another; nothing if they hang together."""
    shared = common([t.motion for t in terms])
    parts: list[tuple[set[int], list[Term]]] = []
    for term in terms:
        moving = {f for f, _ in without(factors, term.motion, shared)}
        joined = [p for p in parts if p[0] & moving]
        parts = [p for p in parts if not p[0] & moving]
        members = [t for _, held in joined for t in held]
        parts.append((moving.union(*(names for names, _ in joined)), [*members, term]))
    return [held for _, held in parts] if len(parts) > 1 else []


def _factored(factors: Factors, terms: list[Term]) -> Piece | None:
    """number * parameters * motion * sums, if the terms are a power or a product of sums."""
    parameters, motion = common([t.parameters for t in terms]), common([t.motion for t in terms])
    rest = _with_roots(factors, [
        Term(t.number, without(factors, t.parameters, parameters),
             without(factors, t.motion, motion))
        for t in terms
    ])  # fmt: skip
    found = _square(factors, rest) or _sums(factors, rest)
    if found is None:
        return None
    number, sums = found
    lead = any(factors.kind(f) in LEADS for f in motion)
    return Piece(
        number,
        factors.sort(parameters.items()),
        factors.sort(motion.items()),
        inner=sums if lead else (),
        last=() if lead else sums,
        rank=min(rank(factors, t) for t in terms),
    )


def _square(factors: Factors, terms: list[Term]) -> Factored | None:
    """The terms as number * sum^2."""
    even = [t for t in terms if all(e % 2 == 0 for _, e in t.parameters + t.motion)]
    return next((f for unit in even if (f := _square_with(factors, terms, unit))), None)


def _square_with(factors: Factors, terms: list[Term], unit: Term) -> Factored | None:
    """The same with a corner given: roots of the corners, their signs from the mixed terms."""
    numbers = {_whole(t): t.number for t in terms}
    corners = [unit, *(t for t in terms if t is not unit and _ratio(t, unit) is not None)]
    if len(corners) < 2 or len(terms) != len(corners) * (len(corners) + 1) // 2:
        return None
    number, first = corners[0].number, _root(corners[0], Fraction(1))
    roots = [first]
    for corner in corners[1:]:
        root = _root(corner, _ratio(corner, corners[0]) or Fraction(0))
        mixed = numbers.get(_whole(_times(factors, first, root)))
        sign = -1 if mixed is not None and mixed * number < 0 else 1
        roots.append(root._replace(number=sign * root.number))
    found: dict[object, Fraction] = {}
    for left in roots:
        for right in roots:
            both = _times(factors, left, right)
            found[_whole(both)] = found.get(_whole(both), Fraction(0)) + number * both.number
    if found != numbers:
        return None
    _, pieces = _leading(factors, roots)
    return number, (tree.Power(summed(factors, pieces), 2),)


def _whole(term: Term) -> tuple[Powers, Powers]:
    return term.parameters, term.motion


def _times(factors: Factors, left: Term, right: Term) -> Term:
    """The product of two terms."""
    return Term(
        left.number * right.number,
        without(factors, left.parameters, {f: -e for f, e in right.parameters}),
        without(factors, left.motion, {f: -e for f, e in right.motion}),
    )


def _ratio(term: Term, unit: Term) -> Fraction | None:
    """The root of term.number / unit.number, if that is rational and the powers are even."""
    ratio = term.number / unit.number
    if ratio < 0 or any(e % 2 for _, e in term.parameters + term.motion):
        return None
    above, below = isqrt(ratio.numerator), isqrt(ratio.denominator)
    return Fraction(above, below) if Fraction(above, below) ** 2 == ratio else None


def _root(term: Term, number: Fraction) -> Term:
    """number * the root of the powers."""
    halves = (tuple((f, e // 2) for f, e in p) for p in (term.parameters, term.motion))
    return Term(number, *halves)


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


def _sums(factors: Factors, terms: list[Term]) -> Factored | None:
    """(number, sums) whose product the terms are; two sums or a higher power of one."""
    cubic = len(terms) <= FEW and sum(_is_cube(t) for t in terms) > 1
    if not (cubic or _has_quotient(terms)):
        return None
    names, signs, polynomial = _polynomial(terms)
    if not polynomial:
        return None
    content, found = polynomial.factor_list()
    if sum(exponent for _, exponent in found) < 2 or any(len(base) < 2 for base, _ in found):
        return None
    bases = [(_leading(factors, _terms(factors, names, signs, b)), e) for b, e in found]
    number = _fraction(content)
    for (sign, _), exponent in bases:
        number *= sign**exponent
    if number < 0:
        number, bases = _turned(number, bases)
    ranked = sorted(((pieces, e) for (_, pieces), e in bases), key=lambda item: item[0][0].rank)
    return number, tuple(tree.power(summed(factors, pieces), e) for pieces, e in ranked)


def _has_quotient(terms: list[Term]) -> bool:
    """Whether something is divided by, in so few terms that factors are found at once."""
    names = {f for t in terms for f, _ in t.parameters + t.motion}
    few = 3 < len(terms) <= FEW and len(names) <= FEW
    return few and any(e < 0 for t in terms for _, e in t.motion)


def _is_cube(term: Term) -> bool:
    """A mark of the corners of a higher power: no factor below the third power."""
    return all(abs(e) > 2 for _, e in term.parameters + term.motion)


Base = tuple[tuple[int, list[Piece]], int]  # ((sign, pieces), exponent)


def _leading(factors: Factors, terms: list[Term]) -> tuple[int, list[Piece]]:
    """(sign, pieces * sign) with the piece of the first rank positive."""
    pieces = sorted(collected(factors, terms), key=lambda p: p.rank)
    if pieces[0].number > 0:
        return 1, pieces
    return -1, [negated(p) for p in pieces]


def _turned(number: Fraction, bases: list[Base]) -> tuple[Fraction, list[Base]]:
    """k (x_2 - x_1) (...), not -k (x_1 - x_2) (...), if there is a difference to turn round."""
    for i, ((sign, pieces), exponent) in enumerate(bases):
        if exponent % 2 and len(pieces) == 2 and pieces[1].number < 0 and pieces[1].motion:
            turned = ((-sign, [negated(p) for p in pieces]), exponent)
            if not any(e < 0 for _, e in pieces[1].motion):
                return -number, [*bases[:i], turned, *bases[i + 1 :]]
    return number, bases


def _polynomial(terms: list[Term]) -> tuple[list[int], list[int], Any]:
    """(factors, signs, polynomial); a factor that is only divided by enters as its inverse."""
    powers = [dict(t.parameters + t.motion) for t in terms]
    names = list(dict.fromkeys(f for p in powers for f in p))
    signs = [-1 if all(p.get(f, 0) <= 0 for p in powers) else 1 for f in names]
    dense = [tuple(s * p.get(f, 0) for f, s in zip(names, signs, strict=True)) for p in powers]
    if any(e < 0 for exponents in dense for e in exponents):
        return names, signs, None
    numbers = [QQ(t.number.numerator, t.number.denominator) for t in terms]
    polynomials = ring([f"x{f}" for f in names], QQ)[0]
    return names, signs, polynomials.from_dict(dict(zip(dense, numbers, strict=True)))


def _terms(factors: Factors, names: list[int], signs: list[int], polynomial: Any) -> list[Term]:
    """The terms of a polynomial whose generators are the factors or their inverses."""
    terms = []
    for exponents, c in polynomial.terms():
        signed = (s * e for s, e in zip(signs, exponents, strict=True))
        powers: Powers = factors.sort(zip(names, signed, strict=True))
        fixed = tuple(p for p in powers if factors.kind(p[0]) <= Kind.PARAMETER)
        terms.append(Term(_fraction(c), fixed, tuple(p for p in powers if p not in fixed)))
    return terms


def _fraction(number: Any) -> Fraction:
    return Fraction(int(number.numerator), int(number.denominator))
