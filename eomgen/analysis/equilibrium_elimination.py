"""All real solutions of a polynomial system with finitely many, by exact elimination.

A Groebner basis gives the algebra Q[x]/I of dimension D (D solutions, counted with multiplicity)
and how every variable multiplies in it. With a linear form u that takes another value at every
solution, the rational univariate representation (Rouillier 1999) is

    f(T) = squarefree part of the characteristic polynomial of u,    x_k = g(x_k, T) / g(1, T),
    g(v, T) = sum over i < deg f of trace(v u^i) H_(deg f - 1 - i)(T),   H_j the Horner sums of f.

Real solutions are the real roots of f, which Sturm sequences isolate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice, product
from typing import Any

import mpmath
import sympy as sp
from sympy.polys.groebnertools import groebner
from sympy.polys.matrices import DomainMatrix
from sympy.polys.rings import PolyElement

MOST_SOLUTIONS = 24  # with multiplicity; beyond, exact matrices take minutes
ROOT_DIGITS = 80
Monomial = tuple[int, ...]


class NotFinite(Exception):
    """The system has infinitely many complex solutions."""


class TooMany(Exception):
    """More solutions than exact elimination is given."""


@dataclass(frozen=True)
class Solutions:
    """Real solutions, each a tuple of mpmath numbers, and how many there are in all."""

    real: tuple[tuple[Any, ...], ...]
    complex_count: int  # distinct
    dimension: int  # with multiplicity


def solve(polynomials: Sequence[PolyElement]) -> Solutions:
    """All real solutions, certified.

    Raises:
        NotFinite: there are infinitely many complex solutions.
        TooMany: elimination would take too long.
    """
    basis = groebner(list(polynomials), polynomials[0].ring)
    if any(p == 1 for p in basis):
        return Solutions((), 0, 0)
    quotient = Quotient(basis, standard_monomials(basis))
    return quotient.solutions()


def standard_monomials(basis: Sequence[PolyElement]) -> list[Monomial]:
    """The monomials that no leading one divides, a basis of the algebra."""
    leading = [p.LM for p in basis]
    size = basis[0].ring.ngens
    for k in range(size):
        if not any(sum(m) == m[k] for m in leading):
            raise NotFinite
    found: list[Monomial] = [(0,) * size]
    for monomial in found:
        for k in range(size):
            larger = tuple(e + (i == k) for i, e in enumerate(monomial))
            divided = any(all(a <= b for a, b in zip(m, larger, strict=True)) for m in leading)
            if not divided and larger not in found:
                found.append(larger)
        if len(found) > MOST_SOLUTIONS:
            raise TooMany
    return found


class Quotient:
    """The algebra of a zero-dimensional system, over the rational numbers."""

    def __init__(self, basis: Sequence[PolyElement], monomials: Sequence[Monomial]) -> None:
        self.basis = list(basis)
        self.monomials = list(monomials)
        self.size = len(monomials)
        self.multiplications = [self._multiplication(x) for x in basis[0].ring.gens]
        self.traces = self._traces()

    def _multiplication(self, variable: PolyElement) -> DomainMatrix:
        """The matrix of p -> variable * p."""
        ring = variable.ring
        columns = []
        for monomial in self.monomials:
            rest = (variable * ring.term_new(monomial, ring.domain.one)).rem(self.basis)
            columns.append([rest.get(m, ring.domain.zero) for m in self.monomials])
        rows = [list(row) for row in zip(*columns, strict=True)]
        return DomainMatrix(rows, (self.size, self.size), sp.QQ)

    def _traces(self) -> DomainMatrix:
        """The trace of multiplication by every standard monomial, as a row."""
        matrices = {self.monomials[0]: DomainMatrix.eye(self.size, sp.QQ).to_dense()}
        for monomial in self.monomials[1:]:
            k = next(i for i, e in enumerate(monomial) if e)
            smaller = tuple(e - (i == k) for i, e in enumerate(monomial))
            matrices[monomial] = self.multiplications[k] * matrices[smaller]
        row = [_trace(matrices[m]) for m in self.monomials]
        self.distinct = self._rank(row, matrices)
        return DomainMatrix([row], (1, self.size), sp.QQ)

    def _rank(self, row: list[Any], matrices: dict[Monomial, DomainMatrix]) -> int:
        """The number of distinct complex solutions: the rank of the trace form (Hermite)."""
        traces = DomainMatrix([row], (1, self.size), sp.QQ)
        # trace(b_i b_j) = traces . (matrix of b_i applied to b_j)
        form = [(traces * matrices[m]).to_list()[0] for m in self.monomials]
        return int(DomainMatrix(form, (self.size, self.size), sp.QQ).rank())

    def solutions(self) -> Solutions:
        """The real solutions."""
        form, matrix = self._separating()
        degree = len(form) - 1
        horner = _horner(form)
        one = DomainMatrix([[sp.QQ(int(i == 0))] for i in range(self.size)], (self.size, 1), sp.QQ)
        powers = [one]
        for _ in range(degree - 1):
            powers.append(matrix * powers[-1])
        identity = DomainMatrix.eye(self.size, sp.QQ).to_dense()
        over = [self._numerator(v, powers, horner) for v in (identity, *self.multiplications)]
        real = tuple(_point(over, root) for root in _real_roots(form))
        return Solutions(real, degree, self.size)

    def _separating(self) -> tuple[list[Any], DomainMatrix]:
        """(f, matrix of u) for the first linear form u that tells all solutions apart."""
        size = len(self.multiplications)
        for weights in islice(_weights(size), 200):
            matrix = sum(
                (m * sp.QQ(w) for m, w in zip(self.multiplications, weights, strict=True)),
                DomainMatrix.zeros((self.size, self.size), sp.QQ).to_dense(),
            )
            variable = sp.Symbol("T")
            polynomial = sp.Poly(matrix.charpoly(), variable, domain=sp.QQ).sqf_part().monic()
            if polynomial.degree() == self.distinct:
                return polynomial.rep.to_list(), matrix
        raise AssertionError("finitely many points are told apart by one of these forms")

    def _numerator(
        self, factor: DomainMatrix, powers: Sequence[DomainMatrix], horner: Sequence[list[Any]]
    ) -> list[Any]:
        """g(v, T), highest power first."""
        degree = len(powers)
        total = [sp.QQ(0)] * degree
        for i, power in enumerate(powers):
            trace = (self.traces * (factor * power)).to_list()[0][0]
            sums = horner[degree - 1 - i]
            for place, c in enumerate(reversed(sums)):
                total[degree - 1 - place] += trace * c
        return total


def _trace(matrix: DomainMatrix) -> Any:
    rows = matrix.to_list()
    return sum((rows[i][i] for i in range(len(rows))), sp.QQ(0))


def _weights(size: int) -> Any:
    """Small whole weights: coordinates alone first, then powers of 2, 3, ..."""
    for k in range(size):
        yield tuple(int(i == k) for i in range(size))
    for base, sign in product(range(2, 60), (1, -1)):
        yield tuple((sign * base) ** i for i in range(size))


def _horner(form: Sequence[Any]) -> list[list[Any]]:
    """H_0 = 1, H_(j+1) = T H_j + a_(d-1-j), highest power first."""
    sums = [[form[0]]]
    for c in form[1:-1]:
        sums.append([*sums[-1], c])
    return sums


def _real_roots(form: Sequence[Any]) -> list[Any]:
    """The real roots of a squarefree polynomial, isolated exactly, to `ROOT_DIGITS` digits."""
    polynomial = sp.Poly(list(form), sp.Symbol("T"), domain=sp.QQ)
    small = sp.Rational(1, 10**ROOT_DIGITS)
    with mpmath.workdps(2 * ROOT_DIGITS):
        return [
            (_real(low) + _real(high)) / 2
            for low, high in polynomial.intervals(eps=small, sqf=True)
        ]


def _real(value: sp.Rational) -> Any:
    return mpmath.mpf(int(value.p)) / int(value.q)


def _point(over: Sequence[list[Any]], root: Any) -> tuple[Any, ...]:
    """Every variable at a root."""
    with mpmath.workdps(2 * ROOT_DIGITS):
        values = [
            mpmath.polyval([mpmath.mpf(int(c.numerator)) / int(c.denominator) for c in g], root)
            for g in over
        ]
        return tuple(v / values[0] for v in values[1:])
