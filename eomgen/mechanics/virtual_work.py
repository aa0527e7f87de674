"""d'Alembert's principle: Newton-Euler projected on the virtual displacements.

sum over bodies of (m a - F) . dv/du + (I alpha + w x I w - M) . dw/du = 0   for every speed u,

with the velocities v of mass centres, w in body axes (Kane & Levinson, Dynamics: Theory and
Applications, ch. 6; lecture: (F - m a) . delta r = 0). No energy is used but for terms that the
author gives as energies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic

import sympy as sp

from eomgen.algebra.scalar import S
from eomgen.mechanics import efforts, speeds
from eomgen.mechanics.equations import Equations
from eomgen.mechanics.kinematics import Kinematics, Spin
from eomgen.mechanics.vectors import Vector, add, cross, dot, scale, transform
from eomgen.model import Body


@dataclass(frozen=True)
class Momentum(Generic[S]):
    """A velocity, the inertia that belongs to it, and the inertia force at zero accelerations."""

    partials: tuple[Vector[S], ...]  # d velocity / d speed, one for each speed
    inertia: tuple[Vector[S], ...]  # inertia * partial, one for each speed
    still: Vector[S]  # rate of momentum with u' = 0


def derive(kinematics: Kinematics[S]) -> Equations[S]:
    """M u' + h = Q by projection; the speeds are the spec's, or the rates."""
    unknown = speeds.symbols(kinematics.model)
    momenta = [m for body in kinematics.model.bodies for m in _momenta(kinematics, body, unknown)]
    if kinematics.model.energy.kinetic != 0:
        momenta.append(_given(kinematics, unknown))
    size = range(len(unknown))
    zero = kinematics.algebra.number(0)
    matrix = [[zero] * len(unknown) for _ in size]
    bias = [zero] * len(unknown)
    for momentum in momenta:
        for i in size:
            bias[i] = bias[i] + dot(momentum.partials[i], momentum.still)
            for j in range(i + 1):
                matrix[i][j] = matrix[i][j] + dot(momentum.partials[i], momentum.inertia[j])
    rows = tuple(tuple(matrix[max(i, j)][min(i, j)] for j in size) for i in size)
    return Equations(rows, tuple(bias), generalized_forces(kinematics, unknown))


def _partials(
    kinematics: Kinematics[S], velocity: Vector[S], unknown: Sequence[sp.Symbol]
) -> tuple[Vector[S], ...]:
    one = kinematics.algebra.number(1)
    return tuple(
        tuple(kinematics.algebra.along(v, {symbol: one}) for v in velocity) for symbol in unknown
    )


def _momenta(
    kinematics: Kinematics[S], body: Body, unknown: Sequence[sp.Symbol]
) -> list[Momentum[S]]:
    mass = kinematics.algebra.of(body.mass)
    velocity = kinematics.velocity(body.name)
    partials = _partials(kinematics, velocity, unknown)
    # with u' = 0 the rate of a velocity is its acceleration's part without u'
    acceleration = tuple(kinematics.rate(v) for v in velocity)
    result = [
        Momentum(partials, tuple(scale(mass, p) for p in partials), scale(mass, acceleration))
    ]
    spin = kinematics.spin(body)
    return result if spin is None else [*result, _angular(kinematics, spin, unknown)]


def _angular(kinematics: Kinematics[S], spin: Spin[S], unknown: Sequence[sp.Symbol]) -> Momentum[S]:
    w = spin.angular_velocity
    partials = _partials(kinematics, w, unknown)
    still = transform(spin.inertia, tuple(kinematics.rate(c) for c in w))
    if spin.gyroscopic:
        still = add(still, cross(w, transform(spin.inertia, w)))
    return Momentum(partials, tuple(transform(spin.inertia, p) for p in partials), still)


def _given(kinematics: Kinematics[S], unknown: Sequence[sp.Symbol]) -> Momentum[S]:
    """The author's own T(q, q', t): p = dT/dq' works on q', its rate less dT/dq is inertia."""
    coordinates, kinetic = kinematics.model.coordinates, kinematics.model.energy.kinetic
    rates = tuple(kinematics.flow.rates[c.symbol] for c in coordinates)
    momenta = kinematics.vector(tuple(sp.diff(kinetic, c.rate) for c in coordinates))
    slopes = kinematics.vector(tuple(sp.diff(kinetic, c.symbol) for c in coordinates))
    still = tuple(kinematics.rate(p) - slope for p, slope in zip(momenta, slopes, strict=True))
    return Momentum(
        _partials(kinematics, rates, unknown), _partials(kinematics, momenta, unknown), still
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
