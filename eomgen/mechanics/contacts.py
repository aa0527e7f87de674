"""Contacts on the graph: gap, gap rate, normal force, impact, and where friction acts.

One-sided:  M q'' + h = Q + J' lambda + G' lambda_N,  gap >= 0,  lambda_N >= 0,  gap lambda_N = 0,
with G = d gap / d q. A contact is open (lambda_N = 0) or closed (gap'' = 0). A two-sided constraint
with friction is a contact that is never open; its force has either sign.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from eomgen.algebra.graph import Node
from eomgen.algebra.ldl import Pivots
from eomgen.errors import UsageError
from eomgen.mechanics import constraints, contacts_touch, multipliers
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.contacts_touch import Touch
from eomgen.mechanics.equations import Equations
from eomgen.mechanics.kinematics import Kinematics
from eomgen.model import Constraint


class Scene(Protocol):
    """A scene on the graph with its equations: a `compile.Machine`."""

    @property
    def kinematics(self) -> Kinematics[Node]:
        """Where things are and how they move."""

    @property
    def equations(self) -> Equations[Node]:
        """M, h, Q."""

    @property
    def rows(self) -> tuple[Row[Node], ...]:
        """Every row of the two-sided constraints."""

    @property
    def kept(self) -> tuple[str, ...]:
        """Names of the independent rows among them."""


@dataclass(frozen=True)
class Contact:
    """A one-sided constraint, or a two-sided one with friction."""

    row: Row[Node]  # residual: the gap; rate: the gap rate; jacobian: G; G q'' + gamma = gap''
    restitution: Node | None  # e; None: the spec does not say what an impact does
    touch: Touch | None  # where friction acts; None: without friction

    @property
    def name(self) -> str:
        """The constraint's."""
        return self.row.constraint.name

    @property
    def one_sided(self) -> bool:
        """Whether it can open."""
        return self.row.constraint.kind == "unilateral"

    @property
    def gap(self) -> Node:
        """The gap of a one-sided one, in the unit of its formula."""
        assert self.row.residual is not None
        return self.row.residual


def of(scene: Scene) -> tuple[Contact, ...]:
    """The contacts of a scene, as declared.

    Raises:
        UsageError: friction has no point to act on, or the scene has speeds of its own.
    """
    model = scene.kinematics.model
    found = [c for c in model.constraints if c.kind == "unilateral" or c.rubs]
    if found and model.speeds:
        raise UsageError("speeds beside contacts are not supported: leave `speeds` out")
    return tuple(_contact(scene, c) for c in found)


def _contact(scene: Scene, constraint: Constraint) -> Contact:
    kinematics = scene.kinematics
    if constraint.kind == "nonholonomic" or constraint.points is not None:
        raise UsageError(
            f"the friction of {constraint.name} is not supported: it needs a surface; "
            "write one relation between positions, holonomic or unilateral"
        )
    (row,) = constraints.of(kinematics, constraint)
    if constraint.kind == "holonomic" and row.name not in scene.kept:
        raise UsageError(
            f"the friction of {constraint.name} is not determined: the constraint depends on "
            "others, so its normal force is not unique; leave one of them out"
        )
    e = constraint.restitution
    return Contact(
        row,
        None if e is None else kinematics.algebra.of(e),
        contacts_touch.of(kinematics, row) if constraint.rubs else None,
    )


def bilateral(scene: Scene) -> list[Row[Node]]:
    """The independent rows of the two-sided constraints."""
    return [row for row in scene.rows if row.name in scene.kept]


def normal_forces(scene: Scene, closed: Sequence[Contact]) -> tuple[tuple[Node, ...], Pivots]:
    """lambda_N of each contact while all of these are closed, without friction."""
    rows = bilateral(scene)
    both = [*rows, *(c.row for c in closed if c.one_sided)]
    solution = multipliers.solve(multipliers.schur(scene.equations, both))
    return solution.multipliers[len(rows) :], solution.pivots


def impact(scene: Scene, contact: Contact) -> tuple[tuple[Node, ...], Pivots]:
    """q'+ = q' + M^-1 (J' P + G' p) with gap'+ = -e gap' and J q'+ + ... = 0 (Newton's law).

    The positions do not change; the impulse is normal, without friction; other contacts give none.
    """
    assert contact.restitution is not None
    rows = bilateral(scene)
    system = multipliers.schur(scene.equations, [*rows, contact.row])
    # a Newton step takes a residual r to zero, so gap' + e gap' takes gap' to -e gap'
    residuals = [*(row.rate for row in rows), (1 + contact.restitution) * contact.row.rate]
    coordinates = scene.kinematics.model.coordinates
    rates = [scene.kinematics.flow.rates[c.symbol] for c in coordinates]
    return multipliers.projected(system, rates, residuals)
