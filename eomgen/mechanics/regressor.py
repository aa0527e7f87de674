"""The inverse dynamics, linear in the inertial parameters of the bodies.

M u' + h - Q = Y(q, u, u', t) theta + rest

theta of a rigid body: m, m c and I about the origin of its frame, in its axes (c: the mass centre);
4 entries in a plane, 10 in solid space. Of a particle or a uniform rod: m. With a the acceleration
of the origin less that of gravity, w and alpha in body axes (Khalil & Dombre, Modeling,
Identification and Control of Robots, ch. 9 and 12), force and moment about the origin are

F = m a + alpha x mc + w x (w x mc),   L = I alpha + w x I w + mc x a,

and a speed's row of Y is that of  F . dv/du + L . dw/du.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Generic

import sympy as sp

from eomgen.algebra.scalar import S
from eomgen.mechanics import speeds, virtual_work
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.vectors import Vector, add, cross, dot, scale, subtract, transform, transpose
from eomgen.model import AXES, Body

TENSOR = tuple((i, j) for i in range(3) for j in range(i, 3))  # I_xx, I_xy, I_xz, I_yy, ...


@dataclass(frozen=True)
class Inertial(Generic[S]):
    """An inertial parameter of a body with its column of Y.

    kind: `m` [kg], `mc_x` [kg m] or `I_xx` [kg m^2] (`I` in a plane); `value` by the spec.
    """

    body: str
    kind: str
    value: S
    column: tuple[S, ...]

    @property
    def name(self) -> str:
        """As it is listed."""
        return f"{self.kind}({self.body})"

    @property
    def moment(self) -> int:
        """The power of length in it: 0 for m, 1 for m c, 2 for I."""
        return {"m": 0, "mc": 1, "I": 2}[self.kind.partition("_")[0]]


def columns(kinematics: Kinematics[S], accelerations: Sequence[S]) -> tuple[Inertial[S], ...]:
    """Every inertial parameter, body by body: m, m c, I."""
    moving = virtual_work.accelerated(kinematics, accelerations)
    return tuple(p for body in kinematics.model.bodies for p in _of_body(moving, body))


def rest(kinematics: Kinematics[S], accelerations: Sequence[S]) -> tuple[S, ...]:
    """What no inertial parameter multiplies: all loads but weights, and energies as formulas."""
    model = kinematics.model
    weightless = replace(model, gravity=tuple(sp.S.Zero for _ in model.gravity))
    bare = replace(virtual_work.accelerated(kinematics, accelerations), model=weightless)
    unknown = speeds.symbols(model)
    own = [] if model.energy.kinetic == 0 else [virtual_work.of_formula(bare, unknown)]
    inertia = virtual_work.inertia_forces(bare, own, len(unknown))
    return subtract(inertia, virtual_work.generalized_forces(bare, unknown))


def _of_body(moving: Kinematics[S], body: Body) -> Iterator[Inertial[S]]:
    if not body.inertia:
        yield _mass_alone(moving, body)
        return
    carried = CARRIED[moving.dimensions](moving, body)
    for (kind, value), column in zip(_values(moving, body), carried, strict=True):
        yield Inertial(body.name, kind, value, column)


def _mass_alone(moving: Kinematics[S], body: Body) -> Inertial[S]:
    """A particle or uniform rod: everything is proportional to its mass."""
    unknown = speeds.symbols(moving.model)
    gravity = moving.vector(moving.model.gravity)
    shares = virtual_work.of_body(moving, replace(body, mass=sp.S.One), unknown)
    weights = [dot(partial, gravity) for partial in shares[0].partials]
    column = subtract(virtual_work.inertia_forces(moving, shares, len(unknown)), weights)
    return Inertial(body.name, "m", moving.algebra.of(body.mass), column)


def _values(moving: Kinematics[S], body: Body) -> Iterator[tuple[str, S]]:
    """(kind, value) of the parameters of a rigid body."""
    mass, centre = moving.algebra.of(body.mass), moving.vector(body.com.components)
    yield "m", mass
    for axis, first in zip(AXES, scale(mass, centre), strict=False):
        yield f"mc_{axis}", first
    square = dot(centre, centre)
    if moving.dimensions == 2:
        yield "I", moving.algebra.of(body.inertia[0]) + mass * square
        return
    for i, j in TENSOR:
        # Steiner: I about the origin = I about the mass centre + m (c.c 1 - c c')
        shift = (square if i == j else moving.algebra.number(0)) - centre[i] * centre[j]
        own = moving.algebra.of(body.inertia[3 * i + j])
        yield f"I_{AXES[i]}{AXES[j]}", own + mass * shift


def _origin(moving: Kinematics[S], body: Body) -> tuple[Vector[S], list[Vector[S]]]:
    """The acceleration of the origin less gravity, and d velocity / d u; both in body axes."""
    back = transpose(moving.axes(body.name))
    velocity = tuple(moving.rate(c) for c in moving.origin(body.name))
    gravity = moving.vector(moving.model.gravity)
    acceleration = subtract(tuple(moving.rate(v) for v in velocity), gravity)
    partials = virtual_work.partials(moving, velocity, speeds.symbols(moving.model))
    return transform(back, acceleration), [transform(back, p) for p in partials]


def _spin(moving: Kinematics[S], body: Body) -> tuple[Vector[S], Vector[S], Sequence[Vector[S]]]:
    """(w, alpha, d w / d u), in body axes."""
    w = moving.angular_velocity(body.name)
    alpha = tuple(moving.rate(c) for c in w)
    return w, alpha, virtual_work.partials(moving, w, speeds.symbols(moving.model))


def _planar(moving: Kinematics[S], body: Body) -> Iterator[tuple[S, ...]]:
    """The columns of m, mc_x, mc_y, I."""
    (x, y), partials = _origin(moving, body)
    (w,), (alpha,), spins = _spin(moving, body)
    pairs = list(zip(partials, (s[0] for s in spins), strict=True))
    yield tuple(p[0] * x + p[1] * y for p, _ in pairs)
    yield tuple(p[1] * alpha - p[0] * (w * w) + s * y for p, s in pairs)
    yield tuple(-(p[0] * alpha) - p[1] * (w * w) - s * x for p, s in pairs)
    yield tuple(s * alpha for _, s in pairs)


def _spatial(moving: Kinematics[S], body: Body) -> Iterator[tuple[S, ...]]:
    """The columns of m, m c and I."""
    a, partials = _origin(moving, body)
    w, alpha, spins = _spin(moving, body)
    yield tuple(dot(p, a) for p in partials)
    # F . p + (mc x a) . s  =  mc . (p x alpha + (p x w) x w + a x s)
    firsts = [
        add(add(cross(p, alpha), cross(cross(p, w), w)), cross(a, s))
        for p, s in zip(partials, spins, strict=True)
    ]
    yield from (tuple(first[k] for first in firsts) for k in range(3))
    # s . (I alpha + w x I w)  =  s . I alpha + (s x w) . I w
    turned = [(s, cross(s, w)) for s in spins]
    for i, j in TENSOR:
        yield tuple(_entry(s, alpha, i, j) + _entry(x, w, i, j) for s, x in turned)


def _entry(left: Vector[S], right: Vector[S], i: int, j: int) -> S:
    """left . (E right) with the symmetric E that is one at (i, j) and (j, i)."""
    return left[i] * right[j] if i == j else left[i] * right[j] + left[j] * right[i]


CARRIED = {2: _planar, 3: _spatial}
