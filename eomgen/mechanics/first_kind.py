"""Lagrange's equations of the first kind of a free scene: Cartesian coordinates beside its own.

The mass centres r and the coordinates q are a linked set with the constraints  r - r(q, t) = 0:

m r'' = m g + lambda,   d/dt(dT/dq') - dT/dq = Q - sum of lambda . dr/dq,

with the T of rotation and the Q of everything but weights. Without the multipliers, which are the
resultants of all that acts on each body but its weight, the equations of the second kind are left.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import sympy as sp

from eomgen.algebra.normal import Form
from eomgen.mechanics import energies, free_bodies_rows, newton_euler_loads
from eomgen.mechanics.equations import Contribution, Equation, multiplier_name
from eomgen.mechanics.free_bodies_rows import BodyRow
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.lagrange import Lagrangian
from eomgen.mechanics.vectors import add
from eomgen.model import AXES


@dataclass(frozen=True)
class CartesianRow:
    """One Cartesian coordinate r:  r - position = 0  and  m r'' = weight + lambda."""

    row: BodyRow  # `applied` is the weight, `reaction` the multiplier
    position: Form  # the formula over q and t
    multiplier: sp.Symbol


@dataclass(frozen=True)
class FirstKind:
    """Everything that the first kind shows."""

    rows: tuple[CartesianRow, ...]
    rotation: Form  # T of rotation, and of the author's own formula
    rest: tuple[Equation, ...]  # of each coordinate, with `reaction` = - sum of lambda dr/dq
    equations: tuple[Equation, ...]  # without multipliers


class Rest(Lagrangian):
    """What is left for the coordinates where the masses have Cartesian ones."""

    @cached_property
    def kinetic(self) -> tuple[Contribution[Form], ...]:
        """Shares of T without translation."""
        return tuple(s for s in energies.kinetic(self.kinematics) if s.kind != "translation")

    @cached_property
    def potential(self) -> tuple[Contribution[Form], ...]:
        """Shares of V without weights."""
        return tuple(s for s in energies.potential(self.kinematics) if s.kind != "gravity")

    @property
    def forces(self) -> list[Form]:
        """All that is applied, on the right side."""
        return [e.applied - e.damping - e.elastic - e.other for e in self.equations]


def derive(kinematics: Kinematics[Form]) -> FirstKind:
    """The equations of a free scene with bodies."""
    rest_of = Rest(kinematics)
    rows = tuple(_rows(kinematics))
    held = [r.row for r in rows]
    tied = free_bodies_rows.weighted(kinematics, held, "reaction")
    rest = tuple(
        replace(e, applied=right, reaction=-work)
        for e, right, work in zip(rest_of.equations, rest_of.forces, tied, strict=True)
    )
    inertias, weights = (
        free_bodies_rows.weighted(kinematics, held, part) for part in ("inertia", "applied")
    )
    return FirstKind(
        rows,
        rest_of.kinetic_energy,
        rest,
        free_bodies_rows.balanced(
            [e.name for e in rest],
            add(inertias, [e.inertia for e in rest]),
            add(weights, [e.applied for e in rest]),
        ),
    )


def _rows(kinematics: Kinematics[Form]) -> Iterator[CartesianRow]:
    for row in free_bodies_rows.bare(kinematics):
        if not row.is_moment:
            axis, body = AXES.index(row.axis), kinematics.bodies[row.body]
            weight = newton_euler_loads.weight(kinematics, body.mass)[axis]
            symbol = sp.Symbol(multiplier_name(f"{row.body}.{row.axis}"), real=True)
            held = replace(row, applied=weight, reaction=kinematics.algebra.of(symbol))
            yield CartesianRow(held, kinematics.position(row.body)[axis], symbol)
