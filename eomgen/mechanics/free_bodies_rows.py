"""The scalar equations of each body, and the sums of them that hold no reaction."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter

from eomgen.algebra import normal
from eomgen.algebra.normal import Form
from eomgen.mechanics import free_bodies_loads as loads
from eomgen.mechanics.equations import Equation
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.newton_euler import Wrench
from eomgen.mechanics.vectors import Vector, add, cross, scale, transform
from eomgen.model import AXES, Body

Closed = Kinematics[Form]


@dataclass(frozen=True)
class BodyRow:
    """One scalar equation of a body: inertia = applied + reaction [N or N m]."""

    body: str
    axis: str  # x, y, z of a force; of a moment in space too; "" of a moment in a plane
    is_moment: bool  # about the mass centre, in the axes of the angular velocity
    factor: Form | None  # m, or I in a plane: inertia = factor * acceleration; None in space
    acceleration: Form
    inertia: Form
    applied: Form
    reaction: Form  # linear in the unknowns and the multipliers
    weights: tuple[Form, ...]  # d velocity / d q', one for each coordinate


def of(
    kinematics: Closed,
    applied: Mapping[str, Wrench[Form]],
    reactions: Mapping[str, Wrench[Form]],
    turning: frozenset[str],
) -> tuple[BodyRow, ...]:
    """The rows of every body: forces, then the moments of those that turn."""
    return tuple(
        row
        for body in kinematics.model.bodies
        for row in _of_body(
            kinematics,
            body,
            applied[body.name],
            reactions.get(body.name, loads.nothing(kinematics)),
            body.name in turning,
        )
    )


def _of_body(
    kinematics: Closed, body: Body, applied: Wrench[Form], reaction: Wrench[Form], turns: bool
) -> Iterator[BodyRow]:
    velocity, held = kinematics.velocity(body.name), inertia(kinematics, body)
    mass = kinematics.algebra.of(body.mass)
    for k, axis in enumerate(AXES[: kinematics.dimensions]):
        yield BodyRow(
            body.name, axis, False, mass, kinematics.rate(velocity[k]), held.force[k],
            applied.force[k], reaction.force[k], partials(kinematics, velocity[k]),
        )  # fmt: skip
    if turns:
        given, unknown = (
            loads.in_own_axes(kinematics, body.name, w.moment) for w in (applied, reaction)
        )
        w, factor = kinematics.angular_velocity(body.name), _moment_of_inertia(kinematics, body)
        for k, axis in enumerate(AXES[: len(w)]):
            yield BodyRow(
                body.name, axis if len(w) > 1 else "", True, factor, kinematics.rate(w[k]),
                held.moment[k], given[k], unknown[k], partials(kinematics, w[k]),
            )  # fmt: skip


def inertia(kinematics: Closed, body: Body) -> Wrench[Form]:
    """M a in world axes and I w' + w x I w in the axes of the spin."""
    acceleration = tuple(kinematics.rate(v) for v in kinematics.velocity(body.name))
    force = scale(kinematics.algebra.of(body.mass), acceleration)
    spin = kinematics.spin(body)
    if spin is None:
        return Wrench(force, loads.nothing(kinematics).moment)
    w = spin.angular_velocity
    moment: Vector[Form] = transform(spin.inertia, tuple(kinematics.rate(c) for c in w))
    if spin.gyroscopic:
        moment = add(moment, cross(w, transform(spin.inertia, w)))
    return Wrench(force, moment)


def _moment_of_inertia(kinematics: Closed, body: Body) -> Form | None:
    """I in a plane."""
    spin = kinematics.spin(body)
    return spin.inertia[0][0] if spin is not None and kinematics.dimensions == 2 else None


def partials(kinematics: Closed, component: Form) -> tuple[Form, ...]:
    """d component / d q' for every coordinate."""
    one = kinematics.algebra.number(1)
    return tuple(
        kinematics.algebra.along(component, {q.rate: one}) for q in kinematics.model.coordinates
    )


def weighted(kinematics: Closed, rows: Sequence[BodyRow], part: str) -> tuple[Form, ...]:
    """The sum of d velocity / d q_j' times a part of each row, for every coordinate."""
    ring, read = kinematics.algebra.number(0).ring, attrgetter(part)
    return tuple(
        normal.total(ring, (row.weights[j] * read(row) for row in rows))
        for j in range(len(kinematics.model.coordinates))
    )


def eliminated(
    kinematics: Closed, rows: Sequence[BodyRow], other: Sequence[Form]
) -> tuple[Equation, ...]:
    """The equation of each coordinate: inertia = applied + what acts along coordinates."""
    inertias, forces = (weighted(kinematics, rows, part) for part in ("inertia", "applied"))
    return tuple(
        balanced(kinematics, q.name, left, right + more)
        for q, left, right, more in zip(
            kinematics.model.coordinates, inertias, forces, other, strict=True
        )
    )


def balanced(kinematics: Closed, name: str, inertia: Form, applied: Form) -> Equation:
    """Inertia = applied, whatever the applied forces come from."""
    none = kinematics.algebra.number(0)
    return Equation(name, inertia, none, none, none, none, applied)
