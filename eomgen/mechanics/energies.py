"""Kinetic, potential and dissipation terms of a scene, one named contribution each."""

from __future__ import annotations

from fractions import Fraction

import sympy as sp

from eomgen.algebra.scalar import S
from eomgen.mechanics.elongation import elongation, elongation_rate, formula_of
from eomgen.mechanics.equations import Contribution
from eomgen.mechanics.kinematics import Kinematics, Spin
from eomgen.mechanics.vectors import dot
from eomgen.model import Body, Damper, Spring

HALF = Fraction(1, 2)


def kinetic(kinematics: Kinematics[S]) -> tuple[Contribution[S], ...]:
    """1/2 m v.v and 1/2 w.(I w) of every body, and the author's own terms."""
    result = []
    for body in kinematics.model.bodies:
        result += _body_terms(kinematics, body)
    if kinematics.model.energy.kinetic != 0:
        term = kinematics.algebra.of(kinematics.model.energy.kinetic)
        result.append(Contribution("T", "formula", term))
    return tuple(result)


def _body_terms(kinematics: Kinematics[S], body: Body) -> list[Contribution[S]]:
    velocity = kinematics.velocity(body.name)
    mass = kinematics.algebra.of(body.mass)
    terms = [Contribution(body.name, "translation", mass * HALF * dot(velocity, velocity))]
    spin = kinematics.spin(body)
    if spin is not None:
        terms.append(Contribution(body.name, "rotation", rotational_energy(spin)))
    return terms


def rotational_energy(spin: Spin[S]) -> S:
    """1/2 w . (I w), the symmetric I from its lower triangle."""
    w, inertia = spin.angular_velocity, spin.inertia
    terms = [inertia[i][i] * HALF * (w[i] * w[i]) for i in range(len(w))]
    terms += [inertia[i][j] * w[i] * w[j] for i in range(len(w)) for j in range(i)]
    return sum(terms[1:], terms[0])


def potential(kinematics: Kinematics[S]) -> tuple[Contribution[S], ...]:
    """-m g.r of every body, the energy of every spring that has one, the author's own term."""
    result = [
        Contribution(body.name, "gravity", _weight(kinematics, body))
        for body in kinematics.model.bodies
        if any(g != 0 for g in kinematics.model.gravity)
    ]
    result += [
        Contribution(spring.name, "spring", spring_energy(kinematics, spring))
        for spring in kinematics.model.springs
        if has_potential(spring)
    ]
    if kinematics.model.energy.potential != 0:
        term = kinematics.algebra.of(kinematics.model.energy.potential)
        result.append(Contribution("V", "formula", term))
    return tuple(result)


def _weight(kinematics: Kinematics[S], body: Body) -> S:
    gravity = kinematics.vector(kinematics.model.gravity)
    return -(kinematics.algebra.of(body.mass) * dot(gravity, kinematics.position(body.name)))


def has_potential(spring: Spring) -> bool:
    """Whether the spring's energy is known: a law is integrated where it is a polynomial."""
    return spring.law is None or bool(spring.law.is_polynomial(spring.elongation))


def spring_energy(kinematics: Kinematics[S], spring: Spring) -> S:
    """1/2 k e^2, the author's formula in the elongation e, or the integral of a polynomial law."""
    if spring.stiffness is not None:
        e = elongation(kinematics, spring)
        return kinematics.algebra.of(spring.stiffness) * HALF * (e * e)
    if spring.energy is not None:
        return formula_of(kinematics, spring, spring.energy)
    return formula_of(kinematics, spring, antiderivative(spring.law, spring.elongation))


def antiderivative(law: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """The integral of a polynomial in `variable`, zero at zero."""
    powers = sp.Poly(law, variable).terms()
    return sp.Add(*(c * variable ** (n + 1) / (n + 1) for (n,), c in powers))


def dissipation(kinematics: Kinematics[S]) -> tuple[Contribution[S], ...]:
    """1/2 c v^2 of every linear damper, and the author's own term (Rayleigh's function)."""
    result = [
        Contribution(damper.name, "damper", _damper_term(kinematics, damper))
        for damper in kinematics.model.dampers
        if damper.damping is not None
    ]
    if kinematics.model.energy.dissipation != 0:
        term = kinematics.algebra.of(kinematics.model.energy.dissipation)
        result.append(Contribution("D", "formula", term))
    return tuple(result)


def _damper_term(kinematics: Kinematics[S], damper: Damper) -> S:
    rate = elongation_rate(kinematics, damper)
    return kinematics.algebra.of(damper.damping) * HALF * (rate * rate)
