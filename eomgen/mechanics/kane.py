"""Kane's equations in closed form:  F_r + F*_r = 0  for every speed u_r.

F_r = sum of F . v_r,   F*_r = - sum over bodies of m a . v_r + (I w' + w x I w) . w_r,

with the partial velocities v_r = dv/du_r and w_r = dw/du_r (Kane & Levinson, Dynamics: Theory and
Applications, ch. 4 and 6).
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from eomgen.algebra.normal import Form
from eomgen.mechanics import free_bodies_loads, free_bodies_rows, lagrange, speeds
from eomgen.mechanics.equations import Equation
from eomgen.mechanics.free_bodies_rows import BodyRow
from eomgen.mechanics.kinematics import Flow, Kinematics
from eomgen.model import Model


@dataclass(frozen=True)
class Kane:
    """Everything that Kane's method shows; one entry for each speed."""

    rows: tuple[BodyRow, ...]  # their `weights` are components of the partial velocities
    active: tuple[Form, ...]  # F_r
    inertia: tuple[Form, ...]  # F*_r
    tied: tuple[Form, ...]  # J' lambda of a linked scene, else zero
    equations: tuple[Equation, ...]  # of the speeds


def kinematics_over_speeds(model: Model) -> Kinematics[Form]:
    """Kinematics whose velocities are linear in the declared speeds; in q' if there are none.

    Raises:
        UsageError: declared speeds are not independent.
    """
    plain = lagrange.closed_kinematics(model)
    if not model.speeds:
        return plain
    algebra = plain.algebra
    found = speeds.rates(model, algebra)
    rates = {q.symbol: rate for q, rate in zip(model.coordinates, found, strict=True)}
    old = {q.rate for q in model.coordinates}
    derivatives = {s: d for s, d in plain.flow.derivatives.items() if s not in old} | rates
    derivatives |= {u.symbol: algebra.of(u.rate) for u in model.speeds}
    bound: dict[sp.Symbol, Form] = {q.rate: rates[q.symbol] for q in model.coordinates}
    return Kinematics(model, algebra.extended(bound), Flow(rates, derivatives, plain.flow.spins))


def derive(kinematics: Kinematics[Form]) -> Kane:
    """The equations of a scene with bodies over its speeds."""
    rows = free_bodies_rows.bare(kinematics)
    momenta = free_bodies_rows.weighted(kinematics, rows, "inertia")
    active = free_bodies_loads.total(kinematics)
    return Kane(
        rows=rows,
        active=active,
        inertia=tuple(-p for p in momenta),
        tied=free_bodies_loads.constrained(kinematics),
        equations=free_bodies_rows.balanced(speeds.names(kinematics.model), momenta, active),
    )
