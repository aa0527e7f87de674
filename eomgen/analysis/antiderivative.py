"""Antiderivatives of closed forms in one symbol, and potentials of exact one-forms.

Term by term: powers, powers times waves of a linear angle (by parts), exponentials of a linear
argument; or as a whole by the substitution p = p(v), dp = p' dv. What is not found is None.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import sympy as sp

from eomgen.algebra import functions, normal
from eomgen.algebra.closed import ClosedForm, Evaluation
from eomgen.algebra.normal import Form, Kernel, Key, of_atom

ROOTS = {"base": 1, "sqrt": 2}  # kernel -> n with kernel^n = its argument


def of(algebra: ClosedForm, form: Form, variable: sp.Symbol) -> Form | None:
    """A form whose derivative by the variable is `form`."""
    parts = [_term(algebra, key, c, variable) for key, c in form.terms.items()]
    if all(p is not None for p in parts):
        return normal.total(algebra.ring, [p for p in parts if p is not None])
    return _substituted(algebra, form, variable)


def slope(algebra: ClosedForm, form: Form, variable: sp.Symbol) -> Form:
    """D form / d variable."""
    return algebra.along(form, {variable: algebra.number(1)})


def _term(algebra: ClosedForm, key: Key, c: normal.Number, variable: sp.Symbol) -> Form | None:
    monomial, wave, sine = key
    ring = algebra.ring
    atom = ring.atom(variable)
    power = dict(monomial).get(atom, 0)
    rest = tuple(p for p in monomial if p[0] != atom)
    moving = [
        (a, e) for a, e in rest if slope(algebra, of_atom(ring, ring.atoms[a]), variable).terms
    ]
    outside = Form(ring, {(tuple(p for p in rest if p not in moving), (), False): c})
    inside = Form(ring, {((), wave, sine): 1})
    if not moving and not slope(algebra, inside, variable).terms:
        return outside * inside * _power(algebra, variable, power)
    if moving and not slope(algebra, inside, variable).terms:
        exponential = _exponential(algebra, moving, power, variable)
        return None if exponential is None else outside * inside * exponential
    if moving or power < 0:
        return None
    oscillation = _oscillation(algebra, (wave, sine), power, variable)
    return None if oscillation is None else outside * oscillation


def _power(algebra: ClosedForm, variable: sp.Symbol, power: int) -> Form:
    v = algebra.of(variable)
    return algebra.apply("log", v) if power == -1 else v ** (power + 1) * Fraction(1, power + 1)


def _exponential(
    algebra: ClosedForm, moving: Sequence[tuple[int, int]], power: int, variable: sp.Symbol
) -> Form | None:
    """The antiderivative of exp(a v + b)^e."""
    (atom, exponent), *others = moving
    what = algebra.ring.atoms[atom]
    if others or power or what.function != "exp":
        return None
    factor = slope(algebra, what.arguments[0], variable)
    if slope(algebra, factor, variable).terms:
        return None
    return of_atom(algebra.ring, what, exponent) / (factor * exponent)


def _oscillation(
    algebra: ClosedForm, wave: tuple[normal.Wave, bool], power: int, variable: sp.Symbol
) -> Form | None:
    """The antiderivative of v^k cos(s v + b) or v^k sin(s v + b), by parts."""
    ring, (angles, sine) = algebra.ring, wave
    angle = Form(ring, {ring.angles[a]: f for a, f in angles})
    speed = slope(algebra, angle, variable)
    if slope(algebra, speed, variable).terms:
        return None
    v, result = algebra.of(variable), algebra.number(0)
    factor = algebra.number(1)
    for k in range(power, -1, -1):
        # int v^k cos = v^k sin / s - k/s int v^(k-1) sin;  int v^k sin = -v^k cos / s + ...
        sign = -1 if sine else 1
        turned = Form(ring, {((), angles, not sine): sign})
        result = result + factor * v**k * turned / speed
        factor = factor * (-k * sign) / speed
        sine = not sine
    return result


def _substituted(algebra: ClosedForm, form: Form, variable: sp.Symbol) -> Form | None:
    """Int q p^e p' dv = q p^(e+1) / (e+1), or q log p, with q free of the variable."""
    ring = algebra.ring
    powers = {(a, e) for monomial, _, _ in form.terms for a, e in monomial}
    for atom, exponent in sorted(powers):
        what = ring.atoms[atom]
        if not isinstance(what, Kernel) or what.function not in ROOTS:
            continue
        inside, root = what.arguments[0], ROOTS[what.function]
        moving = slope(algebra, inside, variable)
        if not moving.terms:
            continue
        share = _free_of(algebra, form / (of_atom(ring, what, exponent) * moving), variable)
        if share is None:
            continue
        if exponent == -root:
            return share * algebra.apply("log", inside)
        raised = Fraction(root, exponent + root)
        return share * of_atom(ring, what, exponent) * inside * raised
    return None


def _free_of(algebra: ClosedForm, form: Form, variable: sp.Symbol) -> Form | None:
    """The form without the variable, where it only seems to depend on it."""
    if not algebra.is_zero(slope(algebra, form, variable)):
        return None
    if not slope(algebra, form, variable).terms:
        return form
    found = [f for v in _places(algebra) if (f := at(algebra, form, {variable: v})) is not None]
    return _plainest(found) if found else None


def _plainest(forms: Sequence[Form]) -> Form:
    return sorted(forms, key=lambda f: len(normal.atoms_of(f)))[0]


def _places(algebra: ClosedForm) -> list[Form]:
    """Numbers at which sines and cosines are exact, then others."""
    quarter = algebra.of(sp.pi / 2)
    return [algebra.number(0), quarter, algebra.number(1)]


class _Others(dict[sp.Symbol, Form]):
    """Every other symbol is itself."""

    def __init__(self, algebra: ClosedForm, values: Mapping[sp.Symbol, Form]) -> None:
        super().__init__(values)
        self.algebra = algebra

    def __missing__(self, symbol: sp.Symbol) -> Form:
        return self.algebra.of(symbol)


def at(algebra: ClosedForm, form: Form, values: Mapping[sp.Symbol, Form]) -> Form | None:
    """The form with values for some symbols; None where it is not defined there."""
    evaluation = Evaluation(
        _Others(algebra, values), algebra.number, lambda name, *a: _apply(algebra, name, *a)
    )
    try:
        found: Form = evaluation.of(form)
        return found
    except ZeroDivisionError:
        return None


def _apply(algebra: ClosedForm, name: str, *operands: Form) -> Form:
    return algebra.of(sp.pi) if name == "pi" else functions.apply(name, *operands)


OneForm = Sequence[tuple[sp.Symbol, Form]]  # sum of form * d symbol


def is_exact(algebra: ClosedForm, one_form: OneForm) -> bool:
    """Whether all mixed derivatives agree: d a_i / d q_j = d a_j / d q_i."""
    return all(
        algebra.is_zero(slope(algebra, a, v) - slope(algebra, b, u))
        for i, (u, a) in enumerate(one_form)
        for v, b in one_form[:i]
    )


def potential(algebra: ClosedForm, one_form: OneForm) -> Form | None:
    """Phi with d phi / d q_j = a_j for every entry of an exact one-form."""
    result = algebra.number(0)
    for variable, entry in one_form:
        part = of(algebra, entry - slope(algebra, result, variable), variable)
        if part is None:
            return None
        result = result + part
    checks = (entry - slope(algebra, result, v) for v, entry in one_form)
    return result if all(algebra.is_zero(c) for c in checks) else None


def factors(algebra: ClosedForm, one_form: OneForm) -> list[Form]:
    """Integrating factors worth trying: 1, functions of one variable each, sums that divide."""
    found = [algebra.number(1)]
    entries = [(v, entry) for v, entry in one_form if entry.terms]
    for variable, _ in entries:
        v = algebra.of(variable)
        found += [v**k for k in (-1, -2, 1, 2, -3, 3)]
        for name in ("sin", "cos"):
            wave = algebra.apply(name, v)
            found += [wave, normal.inverse(wave), normal.inverse(wave * wave)]
        found += [algebra.apply("exp", v), algebra.apply("exp", -v)]
    sums = dict.fromkeys(normal.split_content(entry)[1] for _, entry in entries)
    return found + [normal.inverse(s) for s in sums if len(s.terms) > 1]


Factored = tuple[Form, Form]  # (factor, phi)


def integrated(algebra: ClosedForm, one_form: OneForm) -> Factored | None:
    """A factor of the table and phi with d phi = factor * one-form, phi without logarithm first."""
    logarithmic: Factored | None = None
    for factor in factors(algebra, one_form):
        candidate = [(v, factor * entry) for v, entry in one_form]
        found = potential(algebra, candidate) if is_exact(algebra, candidate) else None
        if found is None or not found.terms:
            continue
        sign = -1 if all(c < 0 for c in found.terms.values()) else 1
        result = (factor * sign, found * sign)
        if not _has_logarithm(found):
            return result
        logarithmic = logarithmic or result
    return logarithmic


def _has_logarithm(form: Form) -> bool:
    atoms = (form.ring.atoms[a] for a in normal.atoms_of(form))
    return any(isinstance(what, Kernel) and what.function == "log" for what in atoms)
