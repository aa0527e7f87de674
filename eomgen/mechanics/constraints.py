"""Constraints as rows: the residual, its rate form J q' + ..., and J q'' + gamma = 0.

Over either algebra. The virtual form of a row is sum of J_j delta q_j = 0, at frozen time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic

import sympy as sp

from eomgen.algebra.scalar import S
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.vectors import subtract
from eomgen.model import AXES, Constraint


@dataclass(frozen=True)
class Row(Generic[S]):
    """One scalar equation of a constraint."""

    name: str  # the constraint's, with the axis where two points are set equal
    constraint: Constraint
    residual: S | None  # phi(q, t); None for a nonholonomic row, which has none
    rate: S  # phi' or a(q, q', t)
    jacobian: tuple[S, ...]  # d rate / d u, one entry for each speed (u = q' by default)
    gamma: S  # J u' + gamma is the second rate

    @property
    def is_holonomic(self) -> bool:
        """Whether the author states it between positions."""
        return self.residual is not None


def rows(
    kinematics: Kinematics[S], unknown: Sequence[sp.Symbol] | None = None
) -> tuple[Row[S], ...]:
    """The rows of every bilateral constraint, as declared; unknown: the speeds, by default q'."""
    bilateral = (c for c in kinematics.model.constraints if c.kind != "unilateral")
    return tuple(row for c in bilateral for row in of(kinematics, c, unknown))


def of(
    kinematics: Kinematics[S], constraint: Constraint, unknown: Sequence[sp.Symbol] | None = None
) -> list[Row[S]]:
    """The rows of one constraint; two equal points give one for each axis."""
    if unknown is None:
        unknown = [c.rate for c in kinematics.model.coordinates]
    if constraint.kind == "nonholonomic":
        algebra = kinematics.algebra
        rates = [algebra.of(r) for r in constraint.residuals]
        return [
            _row(kinematics, unknown, (constraint, name, None), rate)
            for name, rate in zip(_names(constraint, len(rates)), rates, strict=True)
        ]
    residuals = residuals_of(kinematics, constraint)
    names = _names(constraint, len(residuals))
    return [
        _row(kinematics, unknown, (constraint, name, residual), kinematics.rate(residual))
        for name, residual in zip(names, residuals, strict=True)
    ]


def residuals_of(kinematics: Kinematics[S], constraint: Constraint) -> tuple[S, ...]:
    """Position residuals: first point minus second, or the author's own."""
    if constraint.points is None:
        return tuple(kinematics.algebra.of(r) for r in constraint.residuals)
    first, second = constraint.points
    return subtract(kinematics.position(first), kinematics.position(second))


def _names(constraint: Constraint, count: int) -> list[str]:
    if count == 1:
        return [constraint.name]
    return [f"{constraint.name}.{axis}" for axis in AXES[:count]]


def _row(
    kinematics: Kinematics[S],
    unknown: Sequence[sp.Symbol],
    known: tuple[Constraint, str, S | None],
    rate: S,
) -> Row[S]:
    algebra, one = kinematics.algebra, kinematics.algebra.number(1)
    constraint, name, residual = known
    return Row(
        name=name,
        constraint=constraint,
        residual=residual,
        rate=rate,
        jacobian=tuple(algebra.along(rate, {symbol: one}) for symbol in unknown),
        gamma=algebra.along(rate, coasting(kinematics)),
    )


def coasting(kinematics: Kinematics[S]) -> dict[sp.Symbol, S]:
    """How symbols move while every q'' is zero."""
    rates = {c.rate for c in kinematics.model.coordinates}
    return {s: v for s, v in kinematics.flow.derivatives.items() if s not in rates}
