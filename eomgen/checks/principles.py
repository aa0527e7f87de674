"""All formalisms that a scene has give one motion, and the free-body equations hold on it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import sympy as sp

from eomgen.algebra.arithmetic import FLOAT, mpmath_arithmetic
from eomgen.algebra.closed import Evaluation
from eomgen.algebra.normal import Form, TooLarge
from eomgen.checks import agreement
from eomgen.checks.agreement import DIGITS, Agreement
from eomgen.checks.evaluation import Bench, over, singly
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError
from eomgen.mechanics import lagrange, principles
from eomgen.mechanics.equations import Derivation
from eomgen.mechanics.free_bodies import FreeBodies
from eomgen.mechanics.principles import Worked

STATES = 5  # at which the equations of the bodies are tried
TOLERANCE = 1e-9


@dataclass(frozen=True)
class Comparison:
    """The formalisms that were compared, how well they agree, and the one that was asked for."""

    names: tuple[str, ...]
    agreement: Agreement
    worked: Worked


def compare(derivation: Derivation, machine: Machine, samples: Samples, method: str) -> Comparison:
    """The wanted formalism beside all others whose closed form is not too large.

    Raises:
        UsageError: the formalism does not apply to the scene, or its closed form is too large.
        CheckError: two formalisms differ.
    """
    found = {method: principles.worked(derivation.model, method)}
    for name in principles.applicable(derivation.model):
        if name not in found:
            with suppress(TooLarge):
                found[name] = principles.worked(derivation.model, name)
    names = tuple(n for n in principles.NAMES if n in found)
    all_found = [_agreement(derivation, machine, samples, found[n]) for n in names]
    for one in found.values():
        if isinstance(one.steps, FreeBodies):
            on_bodies(one.steps, machine, samples)
    whole = Agreement(
        states=min(a.states for a in all_found),
        error=max(a.error for a in all_found),
        digits=max(a.digits for a in all_found),
        proven=all(a.proven for a in all_found),
    )
    return Comparison(names, whole, found[method])


def _agreement(
    derivation: Derivation, machine: Machine, samples: Samples, found: Worked
) -> Agreement:
    try:
        return agreement.compare(replace(derivation, matrix=found.matrix), machine, samples)
    except CheckError as error:
        raise CheckError(f"method {found.name}: {error}") from error


def on_bodies(free: FreeBodies, machine: Machine, samples: Samples) -> float:
    """The worst relative error of the bodies' equations on the motion, the reactions put in.

    Raises:
        CheckError: they do not hold.
    """
    plain = list(singly(machine, samples, FLOAT, STATES))
    error = max(over(plain, lambda at, _: _worst(free, at, at)))
    if error > TOLERANCE:
        # a row whose terms vanish is round-off: its sum in 50 digits, its size in doubles
        fine = list(singly(machine, samples, mpmath_arithmetic(DIGITS), STATES))
        twin = {id(at): exact for (at, _), (exact, _) in zip(plain, fine, strict=True)}
        error = max(over(plain, lambda at, _: _worst(free, twin[id(at)], at)))
    if error > TOLERANCE:
        raise CheckError(
            f"the equations of the bodies do not hold on the motion, relative error {error:.1e}: "
            "this is a defect of eomgen, nothing was written"
        )
    return error


def _worst(free: FreeBodies, exact: Bench, rough: Bench) -> float:
    """The largest sum of a row, over the sizes of its terms."""
    rows: list[tuple[Form, ...]] = [(r.inertia, -r.applied, -r.reaction) for r in free.rows]
    rows += [(w, -o) for w, o in zip(free.work, free.other, strict=True)]
    sums = _with_unknowns(free, exact, lambda terms: sum(terms))
    # an unknown that is zero is the sum of forces that are not
    sizes = _with_unknowns(free, rough, lambda terms: sum(map(abs, terms)))
    return max(_imbalance(sums, sizes, row) for row in rows)


def _with_unknowns(
    free: FreeBodies, at: Bench, joined: Callable[[Sequence[Any]], Any]
) -> Evaluation:
    """Evaluates forms on the motion, every unknown as `joined` makes it of its terms."""
    values = moving(at)
    known = evaluation(values, at)
    found = {u.symbol: joined(_terms(known, u.value)) for u in free.unknowns}
    return evaluation({**values, **found}, at)


def _imbalance(sums: Evaluation, sizes: Evaluation, row: Sequence[Form]) -> float:
    """|sum| over the sum of the sizes of all terms, 0 where all vanish."""
    left = sum(t for form in row for t in _terms(sums, form))
    scale = sum(abs(t) for form in row for t in _terms(sizes, form))
    return float(abs(left) / (scale or 1.0))


def _terms(evaluation: Evaluation, form: Form) -> list[Any]:
    """The values of the terms of a form."""
    return [evaluation.of(Form(form.ring, {key: c})) for key, c in form.terms.items()]


def moving(at: Bench) -> dict[sp.Symbol, Any]:
    """Every symbol of the scene on its motion: the accelerations and the multipliers too."""
    machine, bindings = at.machine, at.machine.kinematics.algebra.bindings
    values = dict(zip(bindings, at.nodes(list(bindings.values())), strict=True))
    pairs = zip(machine.model.coordinates, at.nodes(machine.accelerations), strict=True)
    values |= {q.acceleration: a for q, a in pairs}
    own = zip(machine.model.speeds, at.nodes(machine.solution[0]), strict=False)
    values |= {s.rate: a for s, a in own}
    values |= {
        lagrange.multiplier_symbol(row.name): at.arithmetic.number(0) for row in machine.rows
    }
    if machine.kept:
        names = [row.name for row in machine.schur.rows]
        found = zip(names, at.nodes(machine.linked.multipliers), strict=True)
        values |= {lagrange.multiplier_symbol(name): v for name, v in found}
    return values


def evaluation(values: Mapping[sp.Symbol, Any], at: Bench) -> Evaluation:
    """Evaluates forms in the numbers of a state."""
    arithmetic = at.arithmetic
    return Evaluation(
        values,
        lambda c: arithmetic.number(Fraction(c)),
        lambda name, *a: arithmetic.functions[name](*a),
    )
