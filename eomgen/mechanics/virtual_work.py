"""d'Alembert's principle: Newton-Euler projected on the virtual displacements.

sum over bodies of (m a - F) . dv/du + (I alpha + w x I w - M) . dw/du = 0   for every speed u,

with the velocities v of mass centres, w in body axes (Kane & Levinson, Dynamics: Theory and
Applications, ch. 6; lecture: (F - m a) . delta r = 0). No energy is used but for terms that the
author gives as energies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Generic

import sympy as sp

from eomgen.algebra.scalar import S
from eomgen.mechanics import efforts, speeds
from eomgen.mechanics.equations import Equations
from eomgen.mechanics.kinematics import Kinematics, Spin
from eomgen.mechanics.vectors import Vector, add, cross, dot, scale, subtract, transform
from eomgen.model import Body


@dataclass(frozen=True)
class Momentum(Generic[S]):
    """A velocity, the inertia that belongs to it, and the inertia force at zero accelerations."""

    partials: tuple[Vector[S], ...]  # d velocity / d speed, one for each speed
    inertia: tuple[Vector[S], ...]  # inertia * partial, one for each speed
    still: Vector[S]  # rate of momentum, with u' = 0 unless the kinematics is accelerated


def derive(kinematics: Kinematics[S]) -> Equations[S]:
    """M u' + h = Q by projection; the speeds are the spec's, or the rates."""
    unknown = speeds.symbols(kinematics.model)
    found = momenta(kinematics, unknown)
    size = range(len(unknown))
    matrix = [[kinematics.algebra.number(0)] * len(unknown) for _ in size]
    for momentum in found:
        for i in size:
            for j in range(i + 1):
                matrix[i][j] = matrix[i][j] + dot(momentum.partials[i], momentum.inertia[j])
    rows = tuple(tuple(matrix[max(i, j)][min(i, j)] for j in size) for i in size)
    bias = inertia_forces(kinematics, found, len(unknown))
    return Equations(rows, bias, generalized_forces(kinematics, unknown))


def inverse_dynamics(kinematics: Kinematics[S], accelerations: Sequence[S]) -> tuple[S, ...]:
    """M u' + h - Q for these u', a row for each speed; M is never formed."""
    unknown = speeds.symbols(kinematics.model)
    moving = accelerated(kinematics, accelerations)
    inertia = inertia_forces(kinematics, momenta(moving, unknown), len(unknown))
    return subtract(inertia, generalized_forces(kinematics, unknown))


def accelerated(kinematics: Kinematics[S], accelerations: Sequence[S]) -> Kinematics[S]:
    """The same kinematics with rates that know u', so that the rate of a velocity is whole."""
    chosen = dict(zip(speeds.symbols(kinematics.model), accelerations, strict=True))
    flow = replace(kinematics.flow, derivatives={**kinematics.flow.derivatives, **chosen})
    return replace(kinematics, flow=flow)


def momenta(kinematics: Kinematics[S], unknown: Sequence[sp.Symbol]) -> list[Momentum[S]]:
    """The momenta of all bodies, and of the author's own kinetic energy."""
    found = [m for body in kinematics.model.bodies for m in of_body(kinematics, body, unknown)]
    if kinematics.model.energy.kinetic != 0:
        found.append(of_formula(kinematics, unknown))
    return found


def inertia_forces(
    kinematics: Kinematics[S], shares: Sequence[Momentum[S]], size: int
) -> tuple[S, ...]:
    """sum of the rates of momentum . d velocity / d u, for every speed."""
    result = [kinematics.algebra.number(0)] * size
    for momentum in shares:
        for i in range(size):
            result[i] = result[i] + dot(momentum.partials[i], momentum.still)
    return tuple(result)


def partials(
    kinematics: Kinematics[S], velocity: Vector[S], unknown: Sequence[sp.Symbol]
) -> tuple[Vector[S], ...]:
    """d velocity / d u, a vector for each speed."""
    one = kinematics.algebra.number(1)
    return tuple(
        tuple(kinematics.algebra.along(v, {symbol: one}) for v in velocity) for symbol in unknown
    )


def of_body(
    kinematics: Kinematics[S], body: Body, unknown: Sequence[sp.Symbol]
) -> list[Momentum[S]]:
    """Linear momentum of a body, and angular momentum where it has inertia."""
    mass = kinematics.algebra.of(body.mass)
    velocity = kinematics.velocity(body.name)
    slopes = partials(kinematics, velocity, unknown)
    acceleration = tuple(kinematics.rate(v) for v in velocity)
    result = [Momentum(slopes, tuple(scale(mass, p) for p in slopes), scale(mass, acceleration))]
    spin = kinematics.spin(body)
    return result if spin is None else [*result, _angular(kinematics, spin, unknown)]


def _angular(kinematics: Kinematics[S], spin: Spin[S], unknown: Sequence[sp.Symbol]) -> Momentum[S]:
    w = spin.angular_velocity
    slopes = partials(kinematics, w, unknown)
    still = transform(spin.inertia, tuple(kinematics.rate(c) for c in w))
    if spin.gyroscopic:
        still = add(still, cross(w, transform(spin.inertia, w)))
    return Momentum(slopes, tuple(transform(spin.inertia, p) for p in slopes), still)


def of_formula(kinematics: Kinematics[S], unknown: Sequence[sp.Symbol]) -> Momentum[S]:
    """The author's own T(q, q', t): p = dT/dq' works on q', its rate less dT/dq is inertia."""
    coordinates, kinetic = kinematics.model.coordinates, kinematics.model.energy.kinetic
    rates = tuple(kinematics.flow.rates[c.symbol] for c in coordinates)
    momenta = kinematics.vector(tuple(sp.diff(kinetic, c.rate) for c in coordinates))
    slopes = kinematics.vector(tuple(sp.diff(kinetic, c.symbol) for c in coordinates))
    still = tuple(kinematics.rate(p) - slope for p, slope in zip(momenta, slopes, strict=True))
    return Momentum(
        partials(kinematics, rates, unknown), partials(kinematics, momenta, unknown), still
    )


def generalized_forces(kinematics: Kinematics[S], unknown: Sequence[sp.Symbol]) -> tuple[S, ...]:
    """Q for every speed: weights, springs, dampers, forces and moments by their virtual work."""
    everything = [
        *efforts.conservative(kinematics),
        *efforts.dissipative(kinematics),
        *efforts.nonconservative(kinematics),
    ]
    zero = kinematics.algebra.number(0)
    result = []
    for symbol in unknown:
        total = zero
        for effort in everything:
            total = total + efforts.generalized_force(kinematics, effort, symbol)
        result.append(total)
    return tuple(result)
