"""The scalar equations of each body, and the sums of them that hold no reaction."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter

from eomgen.algebra import normal
from eomgen.algebra.normal import Form
from eomgen.mechanics import free_bodies_loads as loads
from eomgen.mechanics import motions
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
    weights: tuple[Form, ...]  # d velocity / d u, one for each velocity u: q' or a speed


def of(
    kinematics: Closed,
    applied: Mapping[str, Wrench[Form]],
    reactions: Mapping[str, Wrench[Form]],
    turning: frozenset[str],
) -> tuple[BodyRow, ...]:
    """The rows of every body: forces, then the moments of those that turn."""
    none = loads.nothing(kinematics)
    return tuple(
        row
        for body in kinematics.model.bodies
        for row in _of_body(
            kinematics,
            body,
            applied.get(body.name, none),
            reactions.get(body.name, none),
            body.name in turning,
        )
    )


def bare(kinematics: Closed) -> tuple[BodyRow, ...]:
    """The rows of every body with nothing that acts on it."""
    return of(kinematics, {}, {}, solid(kinematics))


def solid(kinematics: Closed) -> frozenset[str]:
    """Bodies with inertia against turning."""
    return frozenset(b.name for b in kinematics.model.bodies if kinematics.spin(b) is not None)


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
    """d component / d u for every velocity u, q' or a speed."""
    one = kinematics.algebra.number(1)
    return tuple(kinematics.algebra.along(component, {u: one}) for u in loads.varied(kinematics))


def weighted(kinematics: Closed, rows: Sequence[BodyRow], part: str) -> tuple[Form, ...]:
    """The sum of d velocity / d u times a part of each row, for every velocity u."""
    ring, read = kinematics.algebra.number(0).ring, attrgetter(part)
    return tuple(
        normal.total(ring, (row.weights[j] * read(row) for row in rows))
        for j in range(len(loads.varied(kinematics)))
    )


def eliminated(
    kinematics: Closed, rows: Sequence[BodyRow], other: Sequence[Form]
) -> tuple[Equation, ...]:
    """The equation of each coordinate: inertia = applied + what acts along coordinates."""
    inertias, forces = (weighted(kinematics, rows, part) for part in ("inertia", "applied"))
    names = [m.name for m in motions.of(kinematics.model, kinematics.algebra)]
    return balanced(names, inertias, add(forces, other))


def balanced(
    names: Sequence[str], inertias: Sequence[Form], applied: Sequence[Form]
) -> tuple[Equation, ...]:
    """Inertia = applied, wherever the applied forces come from."""
    return tuple(
        Equation(name, left, left * 0, left * 0, left * 0, left * 0, right)
        for name, left, right in zip(names, inertias, applied, strict=True)
    )
