"""What statics returns: equilibrium equations in closed form, the equilibria found, their words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import sympy as sp

from eomgen.algebra.closed import to_sympy
from eomgen.algebra.normal import Form
from eomgen.mechanics.equations import Contribution, Equation
from eomgen.model import Constraint, Model


@dataclass(frozen=True)
class Balance:
    """The equilibrium equation of one coordinate, each term by its origin.

    elastic + gravity + other + damping = applied + reaction;  Q = applied - everything on the left.
    """

    name: str  # of the coordinate
    elastic: Form  # dV/dq of springs
    gravity: Form  # dV/dq of weights
    other: Form  # dV/dq of the potential given as a formula
    damping: Form  # dD/dq' at rest
    applied: Form  # virtual work of what has no potential, at rest
    reaction: Form  # sum of lambda_a J_aj

    @property
    def force(self) -> Form:
        """Q of all applied forces."""
        return self.applied - self.elastic - self.gravity - self.other - self.damping

    @property
    def total(self) -> Form:
        """Q + sum of lambda_a J_aj, zero in equilibrium."""
        return self.force + self.reaction

    @property
    def equation(self) -> Equation:
        """The same as a record that the displays know: nothing of inertia, reactions at right."""
        return Equation(
            name=self.name,
            inertia=self.total * 0,
            damping=self.damping,
            elastic=self.elastic,
            gravity=self.gravity,
            other=self.other,
            applied=self.applied + self.reaction,
        )


@dataclass(frozen=True)
class Link:
    """One row of the constraints, at frozen time: sum of J_j delta q_j = 0."""

    name: str
    constraint: Constraint
    residual: Form | None  # None for a nonholonomic row
    jacobian: tuple[Form, ...]
    multiplier: sp.Symbol


@dataclass(frozen=True)
class Statics:
    """The virtual work of all applied forces at rest, and the equilibrium equations."""

    model: Model
    work: tuple[Contribution[Form], ...]  # shares of dW, linear in the virtual displacements
    balances: tuple[Balance, ...]
    links: tuple[Link, ...]
    conservative: bool  # the applied forces at rest have a potential: dQ_i/dq_j = dQ_j/dq_i
    notes: tuple[str, ...]  # what is left out or frozen

    def to_json(self) -> dict[str, Any]:
        """Formulas as text."""
        return {
            "virtual_work": {s.name: _text(s.value) for s in self.work},
            "generalized_forces": {b.name: _text(b.force) for b in self.balances},
            "equations": {b.name: f"{_text(b.total)} = 0" for b in self.balances},
            "constraints": {
                r.name: f"{_text(r.residual)} = 0" for r in self.links if r.residual is not None
            },
            "conservative": self.conservative,
            "notes": list(self.notes),
        }


def _text(form: Form) -> str:
    return str(to_sympy(form))


@dataclass(frozen=True)
class Stability:
    """The answer of the second variation on the admissible virtual displacements."""

    verdict: str  # stable, unstable, undecided
    reason: str
    eigenvalues: tuple[float, ...] = ()  # of the projected second variation, SI, ascending


@dataclass(frozen=True)
class Equilibrium:
    """One position of rest; values are SI with 30 digits."""

    coordinates: Mapping[str, Decimal]
    multipliers: Mapping[str, Decimal]  # by the name of the row
    reactions: Mapping[str, tuple[Decimal, ...]]  # force [N] in world axes: on the first of two
    # points, or where a relation is named on the one body whose Cartesian coordinates it holds
    stability: Stability
    isolated: bool = True
    contacts: tuple[str, ...] = ()  # unilateral constraints that touch
    unique_loads: bool = True  # whether the multipliers are determined

    def to_json(self) -> dict[str, Any]:
        """Floats, with all digits beside them."""
        return {
            "coordinates": {n: float(v) for n, v in self.coordinates.items()},
            "digits": {n: str(v) for n, v in self.coordinates.items()},
            "multipliers": {n: float(v) for n, v in self.multipliers.items()},
            "reactions": {n: [float(c) for c in v] for n, v in self.reactions.items()},
            "contacts": list(self.contacts),
            "isolated": self.isolated,
            "unique_loads": self.unique_loads,
            "stability": self.stability.verdict,
            "reason": self.stability.reason,
            "eigenvalues": list(self.stability.eigenvalues),
        }


@dataclass(frozen=True)
class Equilibria:
    """Every equilibrium found, how they were searched, and what may be missing."""

    found: tuple[Equilibrium, ...]
    method: str
    complete: bool  # no other equilibrium exists in the region, up to what `method` says
    inputs: Mapping[str, sp.Expr]
    time: sp.Expr
    arbitrary: tuple[str, ...] = ()  # coordinates of which nothing depends
    notes: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """All of it, ready for `json.dumps`."""
        return {
            "equilibria": [e.to_json() for e in self.found],
            "method": self.method,
            "complete": self.complete,
            "inputs": {n: float(v) for n, v in self.inputs.items()},
            "time": float(self.time),
            "arbitrary": list(self.arbitrary),
            "notes": list(self.notes),
        }
