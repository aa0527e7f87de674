"""Equations of quasi-velocities: Lagrange's equations projected on dq'/du (Maggi)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import sympy as sp

from eomgen.algebra.closed import Evaluation
from eomgen.algebra.normal import Form, total
from eomgen.algebra.scalar import Algebra
from eomgen.mechanics import motions, speeds
from eomgen.mechanics.equations import ConstraintRow, Equation
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.vectors import dot
from eomgen.model import TIME, Coordinate, Model, Prescribed

PARTS = ("inertia", "damping", "elastic", "gravity", "other", "applied")


def project(
    kinematics: Kinematics[Form], equations: tuple[Equation, ...]
) -> tuple[tuple[Form, ...], tuple[Equation, ...]]:
    """(rates over the speeds, equations of the speeds): sum of (dq'/du) * equation of q."""
    model, algebra = kinematics.model, kinematics.algebra
    if not model.speeds:
        return (), equations
    rates = speeds.rates(model, algebra)
    named = tuple(replace(e, name=s.name) for e, s in zip(equations, model.speeds, strict=True))
    if all(s.symbol == s.formula for s in speeds.plain(model)):
        return rates, named  # the speeds are rates, but for those of quaternions
    substitute = _substitution(kinematics, rates)
    in_speeds = [
        Equation(e.name, **{part: substitute(getattr(e, part)) for part in PARTS}) for e in named
    ]
    return rates, _projected(kinematics, rates, in_speeds)


def _projected(
    kinematics: Kinematics[Form], rates: Sequence[Form], equations: Sequence[Equation]
) -> tuple[Equation, ...]:
    """The sums of dq'/du * equation of q; what belongs to a quaternion stays."""
    model, algebra = kinematics.model, kinematics.algebra
    own = motions.plain(model)
    moving = [r for c, r in zip(model.coordinates, rates, strict=True) if c in own]
    one = algebra.number(1)
    result = []
    for speed in speeds.plain(model):
        weights = [algebra.along(r, {speed.symbol: one}) for r in moving]
        parts = {
            part: dot(weights, [getattr(e, part) for e in equations[: len(own)]]) for part in PARTS
        }
        result.append(Equation(speed.name, **parts))
    return (*result, *equations[len(own) :])


def rows(
    kinematics: Kinematics[Form], rates: tuple[Form, ...], found: tuple[ConstraintRow, ...]
) -> tuple[ConstraintRow, ...]:
    """Constraint rows over the speeds: J N u + ... = 0, and J N u' + gamma = 0."""
    if not rates:
        return found
    model, algebra = kinematics.model, kinematics.algebra
    substitute, one = _substitution(kinematics, rates), algebra.number(1)
    coasting = {c.symbol: r for c, r in zip(model.coordinates, rates, strict=True)}
    still = {s for c in model.coordinates for s in (c.symbol, c.rate)}
    coasting |= {s: r for s, r in kinematics.flow.derivatives.items() if s not in still}
    result = []
    for row in found:
        rate = substitute(row.rate)
        jacobian = tuple(algebra.along(rate, {s.symbol: one}) for s in model.speeds)
        gamma = algebra.along(rate, coasting)
        result.append(replace(row, rate=rate, jacobian=jacobian, gamma=gamma))
    return tuple(result)


def _substitution(kinematics: Kinematics[Form], rates: tuple[Form, ...]) -> Callable[[Form], Form]:
    """Puts q' and q'' over the speeds u and u' into a form."""
    model, algebra = kinematics.model, kinematics.algebra
    flow = {c.symbol: r for c, r in zip(model.coordinates, rates, strict=True)}
    flow |= {s.symbol: algebra.of(s.rate) for s in model.speeds}
    flow |= {
        symbol: rate
        for symbol, rate in kinematics.flow.derivatives.items()
        if symbol not in flow and symbol not in {c.rate for c in model.coordinates}
    }
    values: dict[sp.Symbol, Form] = {s: algebra.of(s) for s in declared(model)}
    for coordinate, rate in zip(model.coordinates, rates, strict=True):
        values[coordinate.rate] = rate
        values[coordinate.acceleration] = algebra.along(rate, flow)
    return evaluator(algebra, values)


def evaluator(algebra: Algebra[Form], values: Mapping[sp.Symbol, Form]) -> Callable[[Form], Form]:
    """A function that puts closed forms in the place of symbols."""
    ring = algebra.number(0).ring
    return Evaluation(
        values,
        algebra.number,
        lambda name, *a: closed_function(algebra, name, *a),
        lambda terms: total(ring, terms),  # each added to the sum so far takes the square of time
    ).of


def closed_function(algebra: Algebra[Form], name: str, *arguments: Form) -> Form:
    """A function of the language, or pi."""
    return algebra.apply(name, *arguments) if arguments else algebra.of(sp.pi)


def declared(model: Model) -> list[sp.Symbol]:
    """Every symbol of the model, in the order of declaration: what is constant comes first."""
    moving: list[Coordinate | Prescribed] = [*model.coordinates, *model.prescribed]
    return [
        *(p.symbol for p in model.parameters),
        *(i.symbol for i in model.inputs),
        TIME,
        *(m.symbol for m in moving),
        *(s.symbol for s in model.speeds),
        *(m.rate for m in moving),
        *(s.rate for s in model.speeds),
        *(m.acceleration for m in moving),
    ]
