"""The table of formalisms: one row each, from the kinematics of a scene to its equations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from eomgen.algebra.normal import Form
from eomgen.errors import UsageError
from eomgen.mechanics import dalembert, first_kind, free_bodies, kane, lagrange, quasi_velocities
from eomgen.mechanics.equations import Equation, Equations
from eomgen.mechanics.kinematics import Kinematics
from eomgen.model import Model

Closed = Kinematics[Form]


class Steps(Protocol):
    """What a formalism shows on the way, in a record of its own."""

    @property
    def equations(self) -> tuple[Equation, ...]:
        """One for each coordinate, or for each speed."""


@dataclass(frozen=True)
class Principle:
    """One formalism.

    obstacle: why a scene has no such derivation; empty if it has. moving: the kinematics that it
    wants; in_speeds: whether its equations are those of the speeds already.
    """

    derive: Callable[[Closed], Steps]
    obstacle: Callable[[Model], str]
    moving: Callable[[Model], Closed] = lagrange.closed_kinematics
    in_speeds: bool = False


@dataclass(frozen=True)
class Worked:
    """The steps of a formalism, and the matrix form to which they lead."""

    name: str
    steps: Steps
    matrix: Equations[Form]


def _bodiless(model: Model) -> str:
    if not model.bodies:
        return "the scene has no bodies, its energies are given as formulas"
    return ""


def _formula(model: Model) -> str:
    if model.energy.kinetic != 0:
        return _bodiless(model) or "a part of T is given as a formula, of no known body"
    return _bodiless(model)


def _nothing(model: Model) -> str:
    return ""


PRINCIPLES = {
    "newton": Principle(free_bodies.derive, _formula),
    "dalembert": Principle(dalembert.derive, _formula),
    "lagrange": Principle(lagrange.Lagrangian, _nothing),
    "lagrange1": Principle(first_kind.derive, _bodiless),
    "kane": Principle(kane.derive, _formula, kane.kinematics_over_speeds, in_speeds=True),
}
NAMES = tuple(PRINCIPLES)


def applicable(model: Model) -> tuple[str, ...]:
    """The formalisms that a scene can be derived in, in the order of the table."""
    return tuple(name for name, p in PRINCIPLES.items() if not p.obstacle(model))


def worked(model: Model, name: str) -> Worked:
    """The derivation of a scene in one formalism.

    Raises:
        UsageError: the formalism does not apply to the scene.
    """
    principle = PRINCIPLES[name]
    if obstacle := principle.obstacle(model):
        others = ", ".join(applicable(model))
        raise UsageError(f"--method {name} does not apply: {obstacle}; those that do: {others}")
    kinematics = principle.moving(model)
    steps = principle.derive(kinematics)
    equations = steps.equations
    if not principle.in_speeds:
        _, equations = quasi_velocities.project(kinematics, equations)
    return Worked(name, steps, lagrange.matrix_form(kinematics, equations))
