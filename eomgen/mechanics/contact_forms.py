"""Contacts in closed form: flight, contact, impact and friction, as equations to be read.

M q'' + h = Q + J' lambda + G' lambda_N with G = d gap/d q. In flight lambda_N = 0 and gap > 0; in
contact gap'' = G q'' + gamma = 0 and lambda_N >= 0; an impact changes the rates by
M dq' = G' P with gap'+ = -e gap'-. Each contact is shown as if it were the only closed one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from eomgen.algebra import functions, normal
from eomgen.algebra.normal import Form
from eomgen.mechanics import constraints, lagrange, named_reactions
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.equations import Equation, Equations, jump_name, reaction_name
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.lagrange import Lagrangian
from eomgen.mechanics.vectors import Vector, dot, scale
from eomgen.model import AXES, Constraint, Model

Closed = Kinematics[Form]


@dataclass(frozen=True)
class Rub:
    """Coulomb friction of a contact; what cannot be told in closed form is None."""

    point: str
    coefficient: Form
    slip: Form | None  # v_t along the tangent, in a plane [m/s]
    tangential: sp.Symbol  # F_t [N]
    equations: tuple[Equation, ...]  # of contact, with F_t where the tangent is known


@dataclass(frozen=True)
class ContactForms:
    """One unilateral constraint, in flight and closed."""

    name: str
    multiplier: sp.Symbol
    gap: Form
    rate: Form
    second: Form  # gap'', linear in q''
    equations: tuple[Equation, ...]  # of contact
    force: Form | None  # lambda_N, where M is diagonal and nothing else is linked
    normal: Form | None  # N = lambda_N |d gap/d r| [N], where the touching point is known
    jumps: tuple[Form, ...]  # M dq', over the symbols of dq'
    impulses: tuple[Form, ...]  # G' P
    restitution: Form | None
    rub: Rub | None


def of(model: Model, touching: Mapping[str, str]) -> tuple[ContactForms, ...]:
    """The one-sided contacts of a scene; `touching`: contact -> point where friction acts."""
    found = [c for c in model.constraints if c.kind == "unilateral"]
    if not found:
        return ()
    kinematics = lagrange.closed_kinematics(model)
    links = lagrange.closed_rows(kinematics)
    flight = lagrange.with_reactions(kinematics, Lagrangian(kinematics).equations, links)
    return tuple(_contact(kinematics, c, flight, touching.get(c.name)) for c in found)


def _contact(
    kinematics: Closed, constraint: Constraint, flight: Sequence[Equation], point: str | None
) -> ContactForms:
    (row,) = constraints.of(kinematics, constraint)
    assert row.residual is not None
    algebra = kinematics.algebra
    multiplier = lagrange.multiplier_symbol(row.name)
    matrix = lagrange.matrix_form(kinematics, tuple(flight))
    closed = _pushed(flight, scale(algebra.of(multiplier), row.jacobian))
    gradient = _gradient(kinematics, row, point)
    length = None if gradient is None else _length(gradient)
    jumps = [algebra.of(_symbol(jump_name(q.name))) for q in kinematics.model.coordinates]
    impulse = algebra.of(_symbol(reaction_name("P", row.name)))
    return ContactForms(
        name=row.name,
        multiplier=multiplier,
        gap=row.residual,
        rate=row.rate,
        second=dot(row.jacobian, _accelerations(kinematics)) + row.gamma,
        equations=closed,
        force=None if flight[0].reaction is not None else _force(matrix, row),
        normal=None if length is None else algebra.of(multiplier) * length,
        jumps=tuple(dot(m, jumps) for m in matrix.mass_matrix),
        impulses=scale(impulse, row.jacobian),
        restitution=None if constraint.restitution is None else algebra.of(constraint.restitution),
        rub=None if point is None else _rub(kinematics, constraint, closed, (point, gradient)),
    )


def _symbol(name: str) -> sp.Symbol:
    return sp.Symbol(name, real=True)


def _accelerations(kinematics: Closed) -> list[Form]:
    return [kinematics.algebra.of(q.acceleration) for q in kinematics.model.coordinates]


def _pushed(equations: Sequence[Equation], forces: Sequence[Form]) -> tuple[Equation, ...]:
    """The equations with generalized forces of constraint more."""
    return tuple(
        replace(e, reaction=f if e.reaction is None else e.reaction + f)
        for e, f in zip(equations, forces, strict=True)
    )


def _force(matrix: Equations[Form], row: Row[Form]) -> Form | None:
    """-(gamma + G M^-1 (Q - h)) / (G M^-1 G'), for a diagonal M."""
    size = range(len(matrix.bias))
    if any(matrix.mass_matrix[i][j].terms for i in size for j in size if i != j):
        return None
    inverses = [normal.inverse(matrix.mass_matrix[i][i]) for i in size]
    loads = [q - h for q, h in zip(matrix.generalized_forces, matrix.bias, strict=True)]
    weighted = [g * m for g, m in zip(row.jacobian, inverses, strict=True)]
    stiffness = dot(weighted, row.jacobian)
    # a unit normal and one mass: 1/m, however it is written
    plain = next((m for m in inverses if normal.is_zero(stiffness - m)), stiffness)
    return -(row.gamma + dot(weighted, loads)) / plain


def _length(vector: Vector[Form]) -> Form:
    """|v|; 1 of a unit vector, however it is written."""
    square = dot(vector, vector)
    one = normal.number(square.ring, 1)
    return one if normal.is_zero(square - one) else functions.sqrt(square)


def _gradient(kinematics: Closed, row: Row[Form], point: str | None) -> Vector[Form] | None:
    """D gap/d r of the touching point; of a body whose Cartesian coordinates the gap holds."""
    found = named_reactions.body_of(kinematics, [row])
    if found is not None:
        names = {q.name: g for q, g in zip(kinematics.model.coordinates, row.jacobian, strict=True)}
        by_axis = {axis: names[name] for name, axis in found[1].items()}
        zero = kinematics.algebra.number(0)
        return tuple(by_axis.get(a, zero) for a in AXES[: kinematics.dimensions])
    if point is None or kinematics.dimensions != 2:
        return None
    return _solved(kinematics, row, point)


def _solved(kinematics: Closed, row: Row[Form], point: str) -> Vector[Form]:
    """The gradient g of G = g . dr/dq' in a plane: (P P') g = P G', by Cramer's rule."""
    one = kinematics.algebra.number(1)
    first, second = (
        tuple(kinematics.algebra.along(v, {q.rate: one}) for q in kinematics.model.coordinates)
        for v in kinematics.velocity(point)
    )
    a, b, c = dot(first, first), dot(first, second), dot(second, second)
    x, y = dot(first, row.jacobian), dot(second, row.jacobian)
    determinant = a * c - b * b
    return ((x * c - y * b) / determinant, (y * a - x * b) / determinant)


def _rub(
    kinematics: Closed,
    constraint: Constraint,
    closed: Sequence[Equation],
    touch: tuple[str, Vector[Form] | None],
) -> Rub:
    """Friction along the tangent: the normal turned clockwise."""
    point, gradient = touch
    algebra, one = kinematics.algebra, kinematics.algebra.number(1)
    tangential = _symbol(reaction_name("T", constraint.name))
    coefficient = algebra.of(constraint.friction)
    if gradient is None or kinematics.dimensions != 2:
        return Rub(point, coefficient, None, tangential, tuple(closed))
    length = _length(gradient)
    tangent = (gradient[1] / length, -(gradient[0] / length))
    slip = dot(tangent, kinematics.velocity(point))
    partials = [algebra.along(slip, {q.rate: one}) for q in kinematics.model.coordinates]
    pushed = _pushed(closed, scale(algebra.of(tangential), partials))
    return Rub(point, coefficient, slip, tangential, pushed)
