"""Lagrange's equations in closed form, each partial derivative kept as a step.

d/dt(dL/dq') - dL/dq + dD/dq' = Q,  L = T - V   (lecture, "Ecuaciones de Lagrange").
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import sympy as sp

from eomgen.algebra import normal
from eomgen.algebra.closed import ClosedForm
from eomgen.algebra.normal import Form
from eomgen.mechanics import constraints, efforts, energies, motions, quasi_velocities
from eomgen.mechanics.equations import (
    ConstraintRow,
    Contribution,
    Derivation,
    Equation,
    Equations,
    LagrangeRow,
    Place,
    Spin,
    multiplier_name,
    virtual_name,
)
from eomgen.mechanics.kinematics import Flow, Kinematics
from eomgen.mechanics.motions import Motion
from eomgen.mechanics.vectors import cross, dot
from eomgen.model import TIME, Coordinate, Model


def closed_kinematics(model: Model) -> Kinematics[Form]:
    """Kinematics in closed form over q, q' and the prescribed motions as symbols of time."""
    algebra = ClosedForm()
    for symbol in quasi_velocities.declared(model):
        algebra.of(symbol)  # fixes the order of the atoms
    rates = {c.symbol: algebra.of(c.rate) for c in model.coordinates}
    derivatives = rates | {c.rate: algebra.of(c.acceleration) for c in model.coordinates}
    for known in model.prescribed:
        derivatives[known.symbol] = algebra.of(known.rate)
        derivatives[known.rate] = algebra.of(known.acceleration)
    derivatives[TIME] = algebra.number(1)
    normed(algebra, model)
    spins = _turning(algebra, model, rates, derivatives)
    return Kinematics(model, algebra, Flow(rates, derivatives, spins))


def _turning(
    algebra: ClosedForm,
    model: Model,
    rates: dict[sp.Symbol, Form],
    derivatives: dict[sp.Symbol, Form],
) -> dict[sp.Symbol, Form]:
    """The speeds of quaternions; the parts move with these: no rate e' stays."""
    spins: dict[sp.Symbol, Form] = {}
    for q in model.quaternions:
        own = {s: algebra.of(s) for s in q.speeds}
        moved = dict(zip(q.symbols, motions.rates(q, algebra, tuple(own.values())), strict=True))
        rates |= moved
        derivatives |= moved
        derivatives |= {s: algebra.of(a) for s, a in zip(q.speeds, q.accelerations, strict=True)}
        spins |= own
    return spins


def normed(algebra: ClosedForm, model: Model) -> None:
    """Have e_0^2 = 1 - e_1^2 - e_2^2 - e_3^2 hold for every quaternion.

    Only derivatives along turns are taken, which keep the length: e . de = 0.
    """
    for q in model.quaternions:
        rest = (algebra.of(s) for s in q.symbols[1:])
        square = algebra.number(1) - normal.total(algebra.ring, (e * e for e in rest))
        algebra.ring.squares[algebra.ring.atom(q.symbols[0])] = square


@dataclass(frozen=True)
class Lagrangian:
    """T, V, D and the nonconservative efforts of a scene, with their derivatives."""

    kinematics: Kinematics[Form]

    @cached_property
    def kinetic(self) -> tuple[Contribution[Form], ...]:
        """Shares of T."""
        return energies.kinetic(self.kinematics)

    @cached_property
    def potential(self) -> tuple[Contribution[Form], ...]:
        """Shares of V."""
        return energies.potential(self.kinematics)

    @cached_property
    def dissipation(self) -> tuple[Contribution[Form], ...]:
        """Shares of D."""
        return energies.dissipation(self.kinematics)

    @cached_property
    def efforts(self) -> tuple[efforts.Effort[Form], ...]:
        """What has neither potential nor dissipation function."""
        return tuple(efforts.nonconservative(self.kinematics))

    @cached_property
    def kinetic_energy(self) -> Form:
        """T."""
        return self.sum(self.kinetic)

    @cached_property
    def potential_energy(self) -> Form:
        """V."""
        return self.sum(self.potential)

    @cached_property
    def dissipation_function(self) -> Form:
        """D."""
        return self.sum(self.dissipation)

    def sum(self, shares: Iterable[Contribution[Form]]) -> Form:
        """The sum of some shares."""
        ring = self.kinematics.algebra.number(0).ring
        return normal.total(ring, (s.value for s in shares))

    def partial(self, value: Form, symbol: sp.Symbol) -> Form:
        """D value / d symbol."""
        return self.kinematics.algebra.along(value, {symbol: self.kinematics.algebra.number(1)})

    def along(self, value: Form, motion: Motion[Form]) -> Form:
        """The change of a value per displacement of a motion."""
        return self.kinematics.algebra.along(value, motion.direction)

    def force(self, motion: Motion[Form]) -> Form:
        """Q of a motion, by virtual work."""
        terms = (efforts.generalized_force(self.kinematics, e, motion.rate) for e in self.efforts)
        return normal.total(self.kinematics.algebra.number(0).ring, terms)

    @cached_property
    def moving(self) -> tuple[Motion[Form], ...]:
        """What is varied."""
        return motions.of(self.kinematics.model, self.kinematics.algebra)

    @cached_property
    def rows(self) -> tuple[LagrangeRow, ...]:
        """The partial derivatives of each motion."""
        return tuple(_row(self, m) for m in self.moving)

    @cached_property
    def equations(self) -> tuple[Equation, ...]:
        """The equation of each motion."""
        pairs = zip(self.moving, self.rows, strict=True)
        return tuple(_equation(self, m, row) for m, row in pairs)


def derive(model: Model) -> Derivation:
    """The whole derivation of a model in closed form.

    Raises:
        UsageError: declared speeds are not independent.
    """
    lagrangian = Lagrangian(closed_kinematics(model))
    rates, equations = quasi_velocities.project(lagrangian.kinematics, lagrangian.equations)
    links = closed_rows(lagrangian.kinematics)
    links = quasi_velocities.rows(lagrangian.kinematics, rates, links)
    equations = with_reactions(lagrangian.kinematics, equations, links)
    return Derivation(
        model=model,
        places=_places(lagrangian.kinematics),
        spins=_spins(lagrangian.kinematics),
        kinetic=lagrangian.kinetic,
        potential=lagrangian.potential,
        dissipation=lagrangian.dissipation,
        virtual_work=_virtual_work(lagrangian),
        kinetic_energy=lagrangian.kinetic_energy,
        potential_energy=lagrangian.potential_energy,
        dissipation_function=lagrangian.dissipation_function,
        rows=lagrangian.rows,
        equations=equations,
        matrix=matrix_form(lagrangian.kinematics, equations),
        constraints=links,
        rates=rates,
    )


def closed_rows(kinematics: Kinematics[Form]) -> tuple[ConstraintRow, ...]:
    """The rows of the bilateral constraints in closed form, with their virtual form."""
    deltas = [kinematics.algebra.of(virtual_symbol(c)) for c in kinematics.model.coordinates]
    return tuple(
        ConstraintRow(
            name=row.name,
            residual=row.residual,
            rate=row.rate,
            virtual=dot(row.jacobian, deltas),
            jacobian=row.jacobian,
            gamma=row.gamma,
        )
        for row in constraints.rows(kinematics)
    )


def with_reactions(
    kinematics: Kinematics[Form],
    equations: tuple[Equation, ...],
    links: tuple[ConstraintRow, ...],
) -> tuple[Equation, ...]:
    """Lagrange's equations of the first kind: J' lambda on the right."""
    if not links:
        return equations
    multipliers = [kinematics.algebra.of(multiplier_symbol(row.name)) for row in links]
    return tuple(
        replace(e, reaction=dot([row.jacobian[j] for row in links], multipliers))
        for j, e in enumerate(equations)
    )


def multiplier_symbol(row: str) -> sp.Symbol:
    """The symbol of a row's Lagrange multiplier."""
    return sp.Symbol(multiplier_name(row), real=True)


def _row(lagrangian: Lagrangian, motion: Motion[Form]) -> LagrangeRow:
    difference = lagrangian.kinetic_energy - lagrangian.potential_energy
    momentum = lagrangian.partial(lagrangian.kinetic_energy, motion.rate)
    return LagrangeRow(
        name=motion.name,
        momentum=momentum,
        momentum_rate=lagrangian.kinematics.rate(momentum),
        slope=lagrangian.along(difference, motion),
        dissipation=lagrangian.partial(lagrangian.dissipation_function, motion.rate),
        force=lagrangian.force(motion),
        gyroscopic=_gyroscopic(lagrangian, motion),
    )


def _gyroscopic(lagrangian: Lagrangian, motion: Motion[Form]) -> Form | None:
    """The component of w x dT/dw, for a turn.

    Poincare's equations d/dt(dL/dw) + w x dL/dw - dL/d(turn) = Q in body-fixed axes (Poincare,
    Comptes Rendus 132, 1901).
    """
    if motion.turn is None:
        return None
    quaternion, axis = motion.turn
    speeds = tuple(lagrangian.kinematics.algebra.of(s) for s in quaternion.speeds)
    kinetic = lagrangian.kinetic_energy
    momenta = tuple(lagrangian.partial(kinetic, s) for s in quaternion.speeds)
    return cross(speeds, momenta)[axis]


def _equation(lagrangian: Lagrangian, motion: Motion[Form], row: LagrangeRow) -> Equation:
    """The row with its terms sorted by origin: dL/dq is dT/dq less every share of dV/dq."""

    def stiffness(kind: str) -> Form:
        shares = (s for s in lagrangian.potential if s.kind == kind)
        return lagrangian.along(lagrangian.sum(shares), motion)

    elastic, gravity, other = (stiffness(kind) for kind in ("spring", "gravity", "formula"))
    inertia = row.momentum_rate - (row.slope + elastic + gravity + other)
    return Equation(
        name=row.name,
        inertia=inertia if row.gyroscopic is None else inertia + row.gyroscopic,
        damping=row.dissipation,
        elastic=elastic,
        gravity=gravity,
        other=other,
        applied=row.force,
    )


def matrix_form(kinematics: Kinematics[Form], equations: tuple[Equation, ...]) -> Equations[Form]:
    """M, h and Q read off the equations, whose inertia terms are linear in u'."""
    model, ring = kinematics.model, kinematics.algebra.number(0).ring
    unknown = [s.rate for s in model.speeds] or [c.acceleration for c in model.coordinates]
    atoms = [ring.atom(symbol) for symbol in unknown]
    parts = [normal.linear_parts(e.inertia, atoms) for e in equations]
    return Equations(
        mass_matrix=tuple(tuple(row[a] for a in atoms) for row, _ in parts),
        bias=tuple(rest for _, rest in parts),
        generalized_forces=tuple(
            e.applied - e.damping - e.elastic - e.gravity - e.other for e in equations
        ),
    )


def _places(kinematics: Kinematics[Form]) -> tuple[Place, ...]:
    """Named points, then mass centres that are not at one of them."""
    model = kinematics.model
    names = [p.name for p in model.points]
    known = {kinematics.position(name) for name in names}
    for body in model.bodies:
        if kinematics.position(body.name) not in known:
            names.append(body.name)
    return tuple(Place(n, kinematics.position(n), kinematics.velocity(n)) for n in names)


def _spins(kinematics: Kinematics[Form]) -> tuple[Spin, ...]:
    found = ((b.name, kinematics.spin(b)) for b in kinematics.model.bodies)
    return tuple(Spin(name, spin.angular_velocity) for name, spin in found if spin is not None)


def _virtual_work(lagrangian: Lagrangian) -> tuple[Contribution[Form], ...]:
    """Force . delta r of every nonconservative effort."""
    algebra = lagrangian.kinematics.algebra
    shares = []
    for effort in lagrangian.efforts:
        terms = (
            efforts.generalized_force(lagrangian.kinematics, effort, m.rate)
            * algebra.of(m.virtual_symbol)
            for m in lagrangian.moving
        )
        work = normal.total(algebra.number(0).ring, terms)
        shares.append(Contribution(effort.name, effort.kind, work))
    return tuple(shares)


def virtual_symbol(coordinate: Coordinate) -> sp.Symbol:
    """The symbol of a coordinate's virtual displacement."""
    return sp.Symbol(virtual_name(coordinate.name), real=True)
