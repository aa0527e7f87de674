"""d'Alembert's principle in closed form: the virtual work of applied and inertial forces is zero.

sum of F . delta r + sum over bodies of (-m a) . delta r - (I w' + w x I w) . delta theta = 0

for every virtual displacement, at constant time; forces of constraint do no work and do not appear
(lecture: (F - m a) . delta r = 0).
"""

from __future__ import annotations

from dataclasses import dataclass

from eomgen.algebra.normal import Form
from eomgen.mechanics import free_bodies_loads, free_bodies_rows, motions
from eomgen.mechanics.efforts import Effort
from eomgen.mechanics.equations import Equation
from eomgen.mechanics.free_bodies_rows import BodyRow
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.vectors import Vector, dot


@dataclass(frozen=True)
class Inertial:
    """One component of an inertial force (-m a) or moment, and what it works on."""

    row: BodyRow  # its `inertia` is m a
    displacement: Form  # delta r, or delta theta, linear in the delta q


@dataclass(frozen=True)
class Applied:
    """The virtual work of one load."""

    name: str
    kind: str  # as `equations.Contribution`
    force: Vector[Form]
    displacement: Vector[Form]  # of what it acts on, in the same axes
    work: Form


@dataclass(frozen=True)
class VirtualWork:
    """Everything that d'Alembert's principle shows."""

    inertial: tuple[Inertial, ...]
    applied: tuple[Applied, ...]
    tied: tuple[Form, ...]  # J' lambda: what linked virtual displacements add, zero if free
    equations: tuple[Equation, ...]  # of each coordinate: the coefficient of delta q vanishes


def derive(kinematics: Kinematics[Form]) -> VirtualWork:
    """The virtual works of a scene with bodies, collected by the delta q."""
    rows = free_bodies_rows.bare(kinematics)
    names = [m.name for m in motions.of(kinematics.model, kinematics.algebra)]
    inertias = free_bodies_rows.weighted(kinematics, rows, "inertia")
    return VirtualWork(
        inertial=tuple(Inertial(row, virtual(kinematics, row.weights)) for row in rows),
        applied=tuple(_applied(kinematics, e) for e in free_bodies_loads.every(kinematics)),
        tied=free_bodies_loads.constrained(kinematics),
        equations=free_bodies_rows.balanced(names, inertias, free_bodies_loads.total(kinematics)),
    )


def virtual(kinematics: Kinematics[Form], weights: Vector[Form]) -> Form:
    """The sum of (d velocity / d q') delta q."""
    moving = motions.of(kinematics.model, kinematics.algebra)
    return dot(weights, [kinematics.algebra.of(m.virtual_symbol) for m in moving])


def _applied(kinematics: Kinematics[Form], effort: Effort[Form]) -> Applied:
    moved = tuple(
        virtual(kinematics, free_bodies_rows.partials(kinematics, v)) for v in effort.velocity
    )
    return Applied(effort.name, effort.kind, effort.force, moved, dot(effort.force, moved))
