"""Equilibrium equations as polynomials with rational coefficients, where they are any.

An angle q becomes the pair (c, s) with c^2 + s^2 = 1, a root r = sqrt(p) a variable with r^2 = p,
a denominator d a variable w with w d = 1 (so that d = 0 is no solution).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import reduce
from typing import Any

import mpmath
import sympy as sp
from sympy.polys.orderings import grevlex
from sympy.polys.rings import PolyElement, ring

from eomgen.algebra import normal
from eomgen.algebra.arithmetic import mpmath_arithmetic
from eomgen.algebra.closed import Evaluation
from eomgen.algebra.normal import Form, Kernel
from eomgen.analysis.equilibrium_equations import symbols_of

ROUNDED_DIGITS = 40  # of constants that are not rational


class NotPolynomial(Exception):
    """The equations are no polynomials in lengths, sines and cosines of single angles."""


@dataclass(frozen=True)
class System:
    """Polynomials that vanish in equilibrium, and what their variables stand for."""

    polynomials: tuple[PolyElement, ...]
    lengths: Mapping[sp.Symbol, int]  # symbol -> index of its variable
    angles: Mapping[sp.Symbol, tuple[int, int]]  # symbol -> indices of cosine and sine
    roots: tuple[int, ...]  # variables that must not be negative
    is_exact: bool  # no constant was rounded


@dataclass
class Usage:
    """Where symbols occur: outside of sine and cosine, and with which factors inside."""

    bare: set[sp.Symbol] = field(default_factory=set)
    factors: dict[sp.Symbol, set[Fraction]] = field(default_factory=dict)
    tangled: set[sp.Symbol] = field(default_factory=set)  # inside, in products or functions

    def see(self, form: Form) -> None:
        """Note every symbol of a form."""
        for monomial, wave, _ in form.terms:
            for atom, _ in monomial:
                self._atom(form, form.ring.atoms[atom])
            for angle, factor in wave:
                self._angle(form, form.ring.angles[angle], Fraction(factor))

    def _atom(self, form: Form, what: normal.Atom) -> None:
        if isinstance(what, Kernel):
            for argument in what.arguments:
                self.see(argument)
        elif isinstance(what, sp.Symbol):
            self.bare.add(what)

    def _angle(self, form: Form, key: normal.Key, factor: Fraction) -> None:
        symbol = angle_symbol(form.ring, key)
        if symbol is None:
            self.tangled |= symbols_of(Form(form.ring, {key: 1}))
        else:
            self.factors.setdefault(symbol, set()).add(factor)

    def is_periodic(self, symbol: sp.Symbol) -> bool:
        """Whether nothing changes when the symbol grows by a full turn."""
        whole = all(f.denominator == 1 for f in self.factors.get(symbol, ()))
        return whole and symbol in self.factors and symbol not in self.bare | self.tangled


def angle_symbol(ring: normal.Ring, key: normal.Key) -> sp.Symbol | None:
    """The symbol that an angle consists of, alone."""
    monomial, wave, _ = key
    if wave or len(monomial) != 1 or monomial[0][1] != 1:
        return None
    what = ring.atoms[monomial[0][0]]
    return what if isinstance(what, sp.Symbol) else None


def usage(forms: Iterable[Form]) -> Usage:
    """Where the symbols of some forms occur."""
    found = Usage()
    for form in forms:
        found.see(form)
    return found


def system(forms: Sequence[Form], unknowns: Sequence[sp.Symbol]) -> System:
    """The equations `form = 0` as polynomials in the unknowns; every other symbol has its value.

    Raises:
        NotPolynomial: says which unknown hinders it.
    """
    seen = usage(forms)
    angles = [u for u in unknowns if u in seen.factors]
    for unknown in unknowns:
        mixed = unknown in seen.factors and not seen.is_periodic(unknown)
        if mixed or unknown in seen.tangled:
            raise NotPolynomial(f"{unknown.name} stands inside and outside of sine and cosine")
    lengths = [u for u in unknowns if u not in angles]
    roots, divisors = _special(forms)
    names = [u.name for u in lengths]
    names += [f"{letter} {u.name}" for u in angles for letter in ("cos", "sin")]
    names += [f"root {i}" for i, _ in enumerate(roots)]
    names += [f"inverse {i}" for i, _ in enumerate(divisors)]
    polynomials, *variables = ring(names, sp.QQ, grevlex)
    pairs = {u: (len(lengths) + 2 * i, len(lengths) + 2 * i + 1) for i, u in enumerate(angles)}
    count = len(lengths) + 2 * len(angles)
    places = {what: i for i, what in enumerate(lengths)}
    places |= {what: count + i for i, what in enumerate(roots)}
    inverses = {what: count + len(roots) + i for i, what in enumerate(divisors)}
    writer = _Writer(polynomials, variables, places, inverses, pairs)
    found = [writer.of(f) for f in forms]
    found += [variables[c] ** 2 + variables[s] ** 2 - 1 for c, s in pairs.values()]
    found += [variables[places[k]] ** 2 - writer.of(k.arguments[0]) for k in roots]
    found += [variables[i] * writer.divisor(what) - 1 for what, i in inverses.items()]
    return System(
        polynomials=tuple(p for p in found if p),
        lengths={u: places[u] for u in lengths},
        angles=pairs,
        roots=tuple(places[k] for k in roots),
        is_exact=writer.is_exact,
    )


def _is_constant(ring: normal.Ring, what: normal.Atom) -> bool:
    return not symbols_of(normal.of_atom(ring, what))


def _special(forms: Sequence[Form]) -> tuple[list[Kernel], list[Any]]:
    """(roots, atoms that divide), of those that hold unknowns, in the order of their sight."""
    roots: dict[Kernel, None] = {}
    divisors: dict[Any, None] = {}
    waiting = [*forms]
    while waiting:
        form = waiting.pop(0)
        for atom, exponent in (power for m, _, _ in form.terms for power in m):
            what = form.ring.atoms[atom]
            if _is_constant(form.ring, what):
                continue
            fresh = what not in roots and what not in divisors
            if exponent < 0:
                divisors[what] = None
            if isinstance(what, Kernel) and what.function == "sqrt":
                roots[what] = None
            if isinstance(what, Kernel) and fresh:
                _look_into(what)
                waiting.append(what.arguments[0])
    return list(roots), list(divisors)


def _look_into(kernel: Kernel) -> None:
    if kernel.function not in ("sqrt", "base"):
        raise NotPolynomial(f"the function {kernel.function} is no polynomial")


@dataclass
class _Writer:
    """Writes forms in the variables of a polynomial ring."""

    polynomials: Any
    variables: Sequence[PolyElement]
    places: Mapping[Any, int]
    inverses: Mapping[Any, int]
    pairs: Mapping[sp.Symbol, tuple[int, int]]
    is_exact: bool = True

    def of(self, form: Form) -> PolyElement:
        """The polynomial of a form."""
        total = self.polynomials.zero
        for (monomial, wave, sine), c in form.terms.items():
            term = self.polynomials.one * _rational(c)
            for atom, exponent in monomial:
                term = term * self._power(form, atom, exponent)
            total += term * self._wave(form, wave, sine) if wave else term
        return total

    def _power(self, form: Form, atom: int, exponent: int) -> PolyElement:
        what = form.ring.atoms[atom]
        if exponent < 0 and what in self.inverses:
            return self.variables[self.inverses[what]] ** -exponent
        if what in self.places:
            return self.variables[self.places[what]] ** exponent
        return self.polynomials.one * self._rounded(normal.of_atom(form.ring, what, exponent))

    def divisor(self, what: Any) -> PolyElement:
        """The polynomial of an atom that divides."""
        if isinstance(what, Kernel) and what.function == "base":
            return self.of(what.arguments[0])
        return self.variables[self.places[what]]

    def _rounded(self, form: Form) -> Any:
        """The value of a constant, rounded to a rational number."""
        self.is_exact = False
        arithmetic = mpmath_arithmetic(ROUNDED_DIGITS + 10)
        functions = arithmetic.functions
        value = Evaluation(
            {}, lambda c: arithmetic.number(Fraction(c)), lambda name, *a: functions[name](*a)
        ).of(form)
        return _rational(Fraction(mpmath.nstr(value, ROUNDED_DIGITS)))

    def _wave(self, form: Form, wave: normal.Wave, sine: bool) -> PolyElement:
        """cos or sin of sum of n_k q_k + phase, as the parts of a product of c_k + i s_k."""
        one, zero = self.polynomials.one, self.polynomials.zero
        real, imaginary = one, zero
        phase: list[tuple[int, Fraction | int]] = []
        for angle, factor in wave:
            symbol = angle_symbol(form.ring, form.ring.angles[angle])
            if symbol not in self.pairs:
                phase.append((angle, factor))
                continue
            c, s = (self.variables[i] for i in self.pairs[symbol])
            turned = (c, s if factor > 0 else -s)
            for _ in range(abs(int(factor))):
                real, imaginary = _product((real, imaginary), turned)
        if phase:
            rest = tuple(phase)
            parts = [Form(form.ring, {((), rest, odd): 1}) for odd in (False, True)]
            turned = (one * self._rounded(parts[0]), one * self._rounded(parts[1]))
            real, imaginary = _product((real, imaginary), turned)
        return imaginary if sine else real


def _product(a: tuple[Any, Any], b: tuple[Any, Any]) -> tuple[Any, Any]:
    """(a0 + i a1)(b0 + i b1)."""
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def _rational(value: normal.Number) -> Any:
    fraction = Fraction(value)
    return sp.QQ(fraction.numerator, fraction.denominator)


def bezout(found: System) -> int:
    """A bound on the number of solutions: the product of the degrees."""
    degrees = (max(sum(m) for m in p.monoms()) for p in found.polynomials)
    return reduce(lambda a, b: a * b, degrees, 1)
