"""What a formalism returns: the matrix form, and for Lagrange every step on the way to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic

from eomgen.algebra.normal import Form
from eomgen.algebra.scalar import S
from eomgen.model import Model


@dataclass(frozen=True)
class Equations(Generic[S]):
    """M(q) u' + h(q, u, t) = Q(q, u, t, inputs), one row for each speed u (u = q' by default)."""

    mass_matrix: tuple[tuple[S, ...], ...]
    bias: tuple[S, ...]  # h: inertia terms without accelerations
    generalized_forces: tuple[S, ...]  # Q: everything applied, conservative or not


@dataclass(frozen=True)
class Contribution(Generic[S]):
    """One named share of a sum: the kinetic energy of `bob`, the potential energy of `spring 1`.

    kind: `translation`, `rotation`, `gravity`, `spring`, `damper`, `force`, `moment`, `formula`.
    """

    name: str
    kind: str
    value: S


@dataclass(frozen=True)
class Place:
    """Where a named point or mass centre is and how fast it moves, in world axes."""

    name: str
    position: tuple[Form, ...]  # [m]
    velocity: tuple[Form, ...]  # [m/s]


@dataclass(frozen=True)
class Spin:
    """The angular velocity of a body that has inertia: one component in a plane (about z)...

    ...three in solid space, in body axes. [rad/s]
    """

    name: str
    angular_velocity: tuple[Form, ...]


@dataclass(frozen=True)
class LagrangeRow:
    """Lagrange's equation of one coordinate q, each partial derivative kept.

    d/dt(dL/dq') - dL/dq + dD/dq' = Q
    """

    name: str
    momentum: Form  # dL/dq'
    momentum_rate: Form  # d/dt(dL/dq')
    slope: Form  # dL/dq
    dissipation: Form  # dD/dq'
    force: Form  # Q, by virtual work, of what has neither potential nor dissipation function
    gyroscopic: Form | None = None  # of a turn: the component of w x dL/dw, beside d/dt(dL/dw)


@dataclass(frozen=True)
class Equation:
    """One equation: inertia + damping + elastic + gravity + other = applied + reaction."""

    name: str  # the coordinate, or the speed
    inertia: Form  # terms with and without accelerations, from T
    damping: Form  # from D
    elastic: Form  # from the potential of springs
    gravity: Form  # from the potential of weights
    other: Form  # from the potential given as a formula
    applied: Form  # Q, on the right
    reaction: Form | None = None  # J' lambda of a linked scene, on the right too


@dataclass(frozen=True)
class ConstraintRow:
    """One scalar constraint in closed form: residual = 0, rate = 0, virtual = 0."""

    name: str
    residual: Form | None  # None where the author states it between rates
    rate: Form
    virtual: Form  # sum of J_j delta q_j, at frozen time
    jacobian: tuple[Form, ...]
    gamma: Form  # J q'' + gamma = 0


@dataclass(frozen=True)
class Derivation:
    """Everything that a page of lecture notes shows, in the order in which it shows it."""

    model: Model
    places: tuple[Place, ...]  # points that matter and mass centres, as declared
    spins: tuple[Spin, ...]
    kinetic: tuple[Contribution[Form], ...]
    potential: tuple[Contribution[Form], ...]
    dissipation: tuple[Contribution[Form], ...]
    virtual_work: tuple[Contribution[Form], ...]  # values linear in the virtual displacements
    kinetic_energy: Form
    potential_energy: Form
    dissipation_function: Form
    rows: tuple[LagrangeRow, ...]
    equations: tuple[Equation, ...]
    matrix: Equations[Form]
    constraints: tuple[ConstraintRow, ...] = ()
    rates: tuple[Form, ...] = ()  # q' in terms of the speeds; empty where the speeds are q'


def virtual_name(coordinate: str) -> str:
    """The name of the symbol of a coordinate's virtual displacement."""
    return f"delta {coordinate}"


JUMP = "jump "  # what the names of changes of rates begin with


def jump_name(coordinate: str) -> str:
    """The name of the symbol of the change of a coordinate's rate in an impact."""
    return f"{JUMP}{coordinate}"


def multiplier_name(row: str) -> str:
    """The name of the symbol of a row's Lagrange multiplier."""
    return f"lambda {row}"


REACTION = "reaction "  # what the names of these symbols begin with


def reaction_name(letter: str, body: str) -> str:
    """The name of the symbol of a force or moment that holds a body."""
    return f"{REACTION}{letter} {body}"
