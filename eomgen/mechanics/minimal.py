"""Elimination in closed form: dependent coordinates as functions of the independent ones.

A residual is solved for a coordinate q where it is, with coefficients free of q,
  linear        a q + c = 0                       (a free of coordinates),
  quadratic     a q^2 + b q + c = 0               (a free of coordinates),
  harmonic      a cos q + b sin q + c = 0,
  a dyad        two harmonic residuals: cos q and sin q follow, their squares add up to 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from eomgen.algebra import functions, normal
from eomgen.algebra.closed import ClosedForm, Evaluation, to_sympy
from eomgen.algebra.normal import Form, Kernel, is_zero
from eomgen.model import Coordinate

BRANCHES = (1, -1)


@dataclass(frozen=True)
class Elimination:
    """q = formula(branch), defined while `discriminant` >= 0 (None: always).

    The formulas are not multiplied out: each is a few products of the residual's coefficients.
    """

    coordinate: Coordinate
    rows: tuple[str, ...]
    branches: tuple[sp.Expr, ...]  # one formula, or one for each of `BRANCHES`
    discriminant: sp.Expr | None = None


@dataclass(frozen=True)
class Residual:
    """A holonomic residual that is still to be solved, and the rows it came from."""

    rows: tuple[str, ...]
    form: Form


@dataclass(frozen=True)
class Step:
    """An elimination, and the residuals that are left."""

    elimination: Elimination
    left: tuple[Residual, ...]


def eliminations(
    algebra: ClosedForm,
    residuals: Sequence[Residual],
    dependent: Sequence[Coordinate],
    all_symbols: Iterable[sp.Symbol],
) -> tuple[Elimination, ...] | None:
    """Formulas for the dependent coordinates, in an order of evaluation; None if one has none.

    A formula may hold independent coordinates and dependent ones that come before it.
    """
    moving = {ring_index(algebra, s) for s in all_symbols}
    found: list[Elimination] = []
    left, waiting = list(residuals), list(dependent)
    while waiting:
        step = _first_step(algebra, left, waiting, moving)
        if step is None:
            return None
        found.append(step.elimination)
        waiting.remove(step.elimination.coordinate)
        left = list(step.left)
    # what was solved first may hold what was solved later
    return tuple(reversed(found))


def ring_index(algebra: ClosedForm, symbol: sp.Symbol) -> int:
    """The number of a symbol's atom."""
    return algebra.ring.atom(symbol)


def _first_step(
    algebra: ClosedForm,
    residuals: Sequence[Residual],
    waiting: Sequence[Coordinate],
    moving: set[int],
) -> Step | None:
    for solver in (_linear, _dyad, _harmonic, _quadratic):
        for coordinate in waiting:
            step = solver(algebra, residuals, coordinate, moving)
            if step is not None:
                return step
    return None


def powers(algebra: ClosedForm, form: Form, coordinate: Coordinate) -> dict[int, Form] | None:
    """Coefficients by the power of q; None where q stands in a wave or a kernel."""
    atom = ring_index(algebra, coordinate.symbol)
    parts: dict[int, normal.Terms] = {}
    for (monomial, wave, sine), c in form.terms.items():
        exponent = dict(monomial).get(atom, 0)
        rest = (tuple(p for p in monomial if p[0] != atom), wave, sine)
        if exponent < 0 or atom in normal.atoms_of(_beside(algebra, rest)):
            return None
        parts.setdefault(exponent, {})[rest] = c
    return {e: Form(algebra.ring, terms) for e, terms in parts.items()}


def _beside(algebra: ClosedForm, key: normal.Key) -> Form:
    """A term with the arguments of its kernels laid open, to see what it holds."""
    form = Form(algebra.ring, {key: 1})
    opened = [form]
    for atom in normal.atoms_of(form):
        what = algebra.ring.atoms[atom]
        if isinstance(what, Kernel):
            opened += [_beside(algebra, k) for a in what.arguments for k in a.terms]
    return normal.total(algebra.ring, (scaled_apart(f, i) for i, f in enumerate(opened, 1)))


def scaled_apart(form: Form, factor: int) -> Form:
    """A multiple that does not cancel against the others."""
    return form * (factor * 7919)


def harmonics(
    algebra: ClosedForm, form: Form, coordinate: Coordinate
) -> tuple[Form, Form, Form] | None:
    """(a, b, c) of a cos q + b sin q + c; None where q stands anywhere else."""
    one = algebra.number(1)
    slope = algebra.along(form, {coordinate.symbol: one})
    curvature = algebra.along(slope, {coordinate.symbol: one})
    # for a harmonic form  f'' = -(f - c)
    constant = form + curvature
    if _holds(algebra, constant, coordinate) or not is_zero(
        algebra.along(curvature, {coordinate.symbol: one}) + slope
    ):
        return None
    s, c = (
        functions.sin(algebra.of(coordinate.symbol)),
        functions.cos(algebra.of(coordinate.symbol)),
    )
    swing = form - constant
    a, b = swing * c - slope * s, swing * s + slope * c
    if not a.terms and not b.terms:
        return None
    return (a, b, constant) if not any(_holds(algebra, f, coordinate) for f in (a, b)) else None


def _holds(algebra: ClosedForm, form: Form, coordinate: Coordinate) -> bool:
    """Whether the coordinate stands anywhere in the form."""
    atom = ring_index(algebra, coordinate.symbol)
    return any(atom in normal.atoms_of(_beside(algebra, key)) for key in form.terms)


def _is_steady(algebra: ClosedForm, form: Form, moving: set[int]) -> bool:
    """Whether a form holds no coordinate, and is not zero."""
    inside = {a for key in form.terms for a in normal.atoms_of(_beside(algebra, key))}
    return not inside & moving and not is_zero(form)


def _others(residuals: Sequence[Residual], *taken: Residual) -> list[Residual]:
    return [r for r in residuals if r not in taken]


def _linear(
    algebra: ClosedForm, residuals: Sequence[Residual], q: Coordinate, moving: set[int]
) -> Step | None:
    for residual in residuals:
        found = powers(algebra, residual.form, q)
        if found is None or set(found) - {0, 1} or 1 not in found:
            continue
        if _is_steady(algebra, found[1], moving):
            value = -found.get(0, algebra.number(0)) / found[1]
            return _solved(algebra, residuals, residual, (q, value))
    return None


def _quadratic(
    algebra: ClosedForm, residuals: Sequence[Residual], q: Coordinate, moving: set[int]
) -> Step | None:
    for residual in residuals:
        found = powers(algebra, residual.form, q)
        if found is None or set(found) - {0, 1, 2} or 2 not in found:
            continue
        if any(_holds(algebra, r.form, q) for r in _others(residuals, residual)):
            continue
        if _is_steady(algebra, found[2], moving):
            zero = algebra.number(0)
            a, b, c = (to_sympy(f) for f in (found[2], found.get(1, zero), found.get(0, zero)))
            discriminant = b * b - 4 * a * c
            root = sp.sqrt(discriminant)
            values = tuple((sign * root - b) / (2 * a) for sign in BRANCHES)
            solved = Elimination(q, residual.rows, values, discriminant)
            return _without(residuals, residual, solved)
    return None


def _harmonic(
    algebra: ClosedForm, residuals: Sequence[Residual], q: Coordinate, moving: set[int]
) -> Step | None:
    for residual in residuals:
        found = harmonics(algebra, residual.form, q)
        if found is None or any(_holds(algebra, r.form, q) for r in _others(residuals, residual)):
            continue
        a, b, c = (to_sympy(f) for f in found)
        # cos q = (-a c - s b d)/r^2, sin q = (-b c + s a d)/r^2, d^2 = r^2 - c^2, r^2 = a^2 + b^2
        discriminant = a * a + b * b - c * c
        d = sp.sqrt(discriminant)
        values = tuple(
            sp.atan2(sign * a * d - b * c, -a * c - sign * b * d, evaluate=False)
            for sign in BRANCHES
        )
        return _without(residuals, residual, Elimination(q, residual.rows, values, discriminant))
    return None


def _dyad(
    algebra: ClosedForm, residuals: Sequence[Residual], q: Coordinate, moving: set[int]
) -> Step | None:
    holding = [r for r in residuals if _holds(algebra, r.form, q)]
    if len(holding) != 2:
        return None
    first, second = (harmonics(algebra, r.form, q) for r in holding)
    if first is None or second is None:
        return None
    (a1, b1, c1), (a2, b2, c2) = first, second
    determinant = a1 * b2 - a2 * b1
    if not _is_steady(algebra, determinant, moving):
        return None
    # d cos q and d sin q with the determinant d, whose sign is not known: nothing is divided
    cosine, sine = c2 * b1 - c1 * b2, a2 * c1 - a1 * c2
    rows = holding[0].rows + holding[1].rows
    sign, y, x = (to_sympy(f) for f in (determinant, sine, cosine))
    value = sp.atan2(y * sign, x * sign, evaluate=False)
    rest = Residual(rows, cosine * cosine + sine * sine - determinant * determinant)
    return Step(Elimination(q, rows, (value,)), (*_others(residuals, *holding), rest))


def _solved(
    algebra: ClosedForm,
    residuals: Sequence[Residual],
    residual: Residual,
    found: tuple[Coordinate, Form],
) -> Step:
    """The coordinate put into the other residuals."""
    coordinate, value = found
    put = substitution(algebra, {coordinate.symbol: value})
    left = tuple(Residual(r.rows, put(r.form)) for r in _others(residuals, residual))
    return Step(Elimination(coordinate, residual.rows, (to_sympy(value),)), left)


def _without(residuals: Sequence[Residual], residual: Residual, elimination: Elimination) -> Step:
    """The step if the coordinate stands in no other residual; its branch is not known yet."""
    return Step(elimination, tuple(_others(residuals, residual)))


def substitution(algebra: ClosedForm, values: Mapping[sp.Symbol, Form]) -> Callable[[Form], Form]:
    """Puts forms in the place of symbols."""

    class Known(dict[sp.Symbol, Form]):
        def __missing__(self, symbol: sp.Symbol) -> Form:
            return algebra.of(symbol)

    def apply(name: str, *a: Form) -> Form:
        return algebra.apply(name, *a) if a else algebra.of(sp.pi)

    return Evaluation(Known(values), algebra.number, apply).of
