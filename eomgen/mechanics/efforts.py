"""Every applied force with the velocity that it works on.

The generalized force of a speed u is  Q = sum of force . (d velocity / d u), the virtual work per
virtual displacement, for forces on points, moments on bodies and forces along an elongation alike.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Generic

import sympy as sp

from eomgen.algebra.scalar import S
from eomgen.mechanics.elongation import (
    elongation,
    elongation_rate,
    formula_of,
    law_of,
    length,
    span,
)
from eomgen.mechanics.energies import has_potential
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.vectors import Vector, dot, scale, subtract, transform
from eomgen.model import Damper, Drive, Force, Moment, Spring


@dataclass(frozen=True)
class Effort(Generic[S]):
    """A force (or moment) and the velocity it works on, in the same axes."""

    name: str
    kind: str  # as `equations.Contribution`
    force: Vector[S]
    velocity: Vector[S]


def nonconservative(kinematics: Kinematics[S]) -> Iterator[Effort[S]]:
    """What has neither a potential nor a dissipation function: laws, forces and moments."""
    yield from forces(kinematics)
    for moment in kinematics.model.moments:
        yield moment_of(kinematics, moment)


def forces(kinematics: Kinematics[S]) -> Iterator[Effort[S]]:
    """Laws and forces: what is nonconservative but no moment."""
    model = kinematics.model
    for spring in model.springs:
        if not has_potential(spring):
            pull = formula_of(kinematics, spring, spring.law)
            rate = elongation_rate(kinematics, spring)
            yield Effort(spring.name, "spring", (-pull,), (rate,))
    for damper in model.dampers:
        if damper.law is not None:
            pull = law_of(kinematics, damper, damper.law)
            rate = elongation_rate(kinematics, damper)
            yield Effort(damper.name, "damper", (-pull,), (rate,))
    for force in model.forces:
        yield _force(kinematics, force)
    for drive in model.drives:
        yield _drive(kinematics, drive)


def _force(kinematics: Kinematics[S], force: Force) -> Effort[S]:
    vector = kinematics.to_world(kinematics.vector(force.components), force.axes)
    velocity = kinematics.velocity(force.on)
    if force.source is not None:
        velocity = subtract(velocity, kinematics.velocity(force.source))
    return Effort(force.name, "force", vector, velocity)


def _drive(kinematics: Kinematics[S], drive: Drive) -> Effort[S]:
    rate = kinematics.rate(kinematics.algebra.of(drive.along))
    return Effort(drive.name, "force", (kinematics.algebra.of(drive.force),), (rate,))


def moment_of(kinematics: Kinematics[S], moment: Moment) -> Effort[S]:
    """A moment and the angular velocity that it works on."""
    vector = kinematics.vector(moment.components)
    if kinematics.dimensions == 2:
        spin = kinematics.angular_velocity(moment.on)
        if moment.source is not None:
            spin = subtract(spin, kinematics.angular_velocity(moment.source))
        return Effort(moment.name, "moment", vector, spin)
    spin = world_spin(kinematics, moment.on)
    if moment.source is not None:
        spin = subtract(spin, world_spin(kinematics, moment.source))
    return Effort(moment.name, "moment", kinematics.to_world(vector, moment.axes), spin)


def world_spin(kinematics: Kinematics[S], name: str) -> Vector[S]:
    """The angular velocity of a body in solid space, in world axes."""
    spin = kinematics.angular_velocity(name)
    is_rod = kinematics.bodies[name].frame.along is not None
    return spin if is_rod else transform(kinematics.axes(name), spin)


def conservative(kinematics: Kinematics[S]) -> Iterator[Effort[S]]:
    """What has a potential, as forces: weights, springs, the author's own V."""
    yield from weights(kinematics)
    yield from elastic(kinematics)


def weights(kinematics: Kinematics[S]) -> Iterator[Effort[S]]:
    """The weight of every body."""
    gravity = kinematics.vector(kinematics.model.gravity)
    for body in kinematics.model.bodies:
        weight = scale(kinematics.algebra.of(body.mass), gravity)
        yield Effort(body.name, "gravity", weight, kinematics.velocity(body.name))


def elastic(kinematics: Kinematics[S]) -> Iterator[Effort[S]]:
    """What has a potential and is no weight: springs, the author's own V."""
    model = kinematics.model
    for spring in model.springs:
        if has_potential(spring):
            yield _spring(kinematics, spring)
    if model.energy.potential != 0:
        slopes = (sp.diff(-model.energy.potential, c.symbol) for c in model.coordinates)
        yield Effort("V", "formula", kinematics.vector(tuple(slopes)), _rates(kinematics))


def _rates(kinematics: Kinematics[S]) -> Vector[S]:
    return tuple(kinematics.flow.rates[c.symbol] for c in kinematics.model.coordinates)


def dissipative(kinematics: Kinematics[S]) -> Iterator[Effort[S]]:
    """What has a dissipation function, as forces: linear dampers, the author's own D."""
    model = kinematics.model
    for damper in model.dampers:
        if damper.damping is not None:
            yield _damper(kinematics, damper)
    if model.energy.dissipation != 0:
        slopes = (sp.diff(-model.energy.dissipation, c.rate) for c in model.coordinates)
        yield Effort("D", "formula", kinematics.vector(tuple(slopes)), _rates(kinematics))


def _spring(kinematics: Kinematics[S], spring: Spring) -> Effort[S]:
    if spring.between is None:
        pull = _pull(kinematics, spring)
        return Effort(spring.name, "spring", (-pull,), (elongation_rate(kinematics, spring),))
    first, second = spring.between
    along = span(kinematics, spring)
    moving = subtract(kinematics.velocity(second), kinematics.velocity(first))
    if spring.stiffness is not None and spring.free_length == 0:
        # a spring without free length pulls with k d: no root, nothing singular at d = 0
        return Effort(
            spring.name, "spring", scale(-kinematics.algebra.of(spring.stiffness), along), moving
        )
    tension = _pull(kinematics, spring) / length(kinematics, spring)
    if len(along) == 1:
        return Effort(spring.name, "spring", (-_pull(kinematics, spring),), moving)
    return Effort(spring.name, "spring", scale(-tension, along), moving)


def _pull(kinematics: Kinematics[S], spring: Spring) -> S:
    """The force that shortens the spring."""
    if spring.stiffness is not None:
        return kinematics.algebra.of(spring.stiffness) * elongation(kinematics, spring)
    law = spring.law if spring.law is not None else sp.diff(spring.energy, spring.elongation)
    return formula_of(kinematics, spring, law)


def _damper(kinematics: Kinematics[S], damper: Damper) -> Effort[S]:
    rate = elongation_rate(kinematics, damper)
    pull = kinematics.algebra.of(damper.damping) * rate
    return Effort(damper.name, "damper", (-pull,), (rate,))


def power(effort: Effort[S]) -> S:
    """Force . velocity [W]."""
    return dot(effort.force, effort.velocity)


def generalized_force(kinematics: Kinematics[S], effort: Effort[S], speed: sp.Symbol) -> S:
    """Force . (d velocity / d speed)."""
    one = kinematics.algebra.number(1)
    partial = tuple(kinematics.algebra.along(v, {speed: one}) for v in effort.velocity)
    return dot(effort.force, partial)
