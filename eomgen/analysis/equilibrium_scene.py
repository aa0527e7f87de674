"""A scene at rest on the graph: balances, residuals and their derivatives as numbers.

This is d'Alembert's route over the second algebra, so that whatever the closed form finds is
checked by another derivation.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import sympy as sp

from eomgen.algebra.arithmetic import Arithmetic, evaluate
from eomgen.algebra.graph import Node
from eomgen.analysis.equilibrium_equations import frozen
from eomgen.mechanics import constraints, machine, virtual_work
from eomgen.mechanics.kinematics import Kinematics
from eomgen.model import TIME, Model

DIGITS = 100  # in which roots are polished: 30 digits are left of a triple root


@dataclass(frozen=True)
class Numbers:
    """The system F(q, lambda) = 0 at one or many points, with its derivatives.

    F = (Q_j + sum lambda_a J_aj for each coordinate, phi_a for each holonomic row).
    """

    balances: list[Any]
    residuals: list[Any]
    gaps: list[Any]  # of unilateral constraints
    jacobian: list[list[Any]]  # J, a row for each row of the constraints
    slopes: list[list[Any]]  # d balance_i / d q_j; minus the second variation


@dataclass(frozen=True)
class Scene:
    """Nodes of everything in `Numbers`, and the exact values of what is given."""

    coordinates: tuple[Node, ...]
    multipliers: tuple[Node, ...]
    names: tuple[str, ...]  # of the rows, one multiplier each
    holonomic: tuple[bool, ...]  # for each row
    balances: tuple[Node, ...]
    residuals: tuple[Node, ...]
    gaps: tuple[Node, ...]
    jacobian: tuple[tuple[Node, ...], ...]
    slopes: tuple[tuple[Node, ...], ...]
    constants: Mapping[Node, sp.Expr]

    def at(
        self, coordinates: Sequence[Any], multipliers: Sequence[Any], arithmetic: Arithmetic
    ) -> Numbers:
        """All numbers at a point, or at an array of points."""
        leaves = {n: number_of(v, arithmetic) for n, v in self.constants.items()}
        leaves |= dict(zip(self.coordinates, coordinates, strict=True))
        leaves |= dict(zip(self.multipliers, multipliers, strict=True))
        groups = [self.balances, self.residuals, self.gaps, *self.jacobian, *self.slopes]
        values = iter(evaluate([n for g in groups for n in g], leaves, arithmetic))
        taken = [[next(values) for _ in g] for g in groups]
        rows = len(self.jacobian)
        return Numbers(taken[0], taken[1], taken[2], taken[3 : 3 + rows], taken[3 + rows :])


def number_of(value: sp.Expr, arithmetic: Arithmetic) -> Any:
    """An exact constant in an arithmetic."""
    if value.is_Rational:
        return arithmetic.number(Fraction(int(value.p), int(value.q)))
    return arithmetic.number(str(sp.N(value, DIGITS + 10)))


Values = Mapping[sp.Symbol, sp.Expr]  # of time, inputs and free parameters


def scene(model: Model, values: Values) -> Scene:
    """The scene at rest, with numbers for everything but coordinates and multipliers."""
    kinematics = _resting(model)
    algebra, graph = kinematics.algebra, kinematics.algebra.number(0).graph
    rates = [c.rate for c in model.coordinates]
    rows = constraints.rows(kinematics)
    multipliers = tuple(graph.symbol(f"lambda {row.name}") for row in rows)
    balances = list(virtual_work.generalized_forces(kinematics, rates))
    for row, multiplier in zip(rows, multipliers, strict=True):
        balances = [b + multiplier * entry for b, entry in zip(balances, row.jacobian, strict=True)]
    one = algebra.number(1)
    symbols = [c.symbol for c in model.coordinates]
    constants: dict[Node, sp.Expr] = {algebra.of(s): v for s, v in values.items()}
    constants |= {algebra.of(r): sp.S.Zero for r in rates}
    return Scene(
        coordinates=tuple(algebra.of(s) for s in symbols),
        multipliers=multipliers,
        names=tuple(row.name for row in rows),
        holonomic=tuple(row.is_holonomic for row in rows),
        balances=tuple(balances),
        residuals=tuple(row.residual for row in rows if row.residual is not None),
        gaps=tuple(
            constraints.residuals_of(kinematics, c)[0]
            for c in model.constraints
            if c.kind == "unilateral"
        ),
        jacobian=tuple(row.jacobian for row in rows),
        slopes=tuple(tuple(algebra.along(b, {s: one}) for s in symbols) for b in balances),
        constants=constants,
    )


def _resting(model: Model) -> Kinematics[Node]:
    """Kinematics over q and q' (declared speeds or not), with prescribed motions standing still."""
    model = replace(model, speeds=())
    bindings = machine.known(model)
    still = {
        s: bindings[TIME].graph.zero for p in model.prescribed for s in (p.rate, p.acceleration)
    }
    rates = [bindings[c.rate] for c in model.coordinates]
    return frozen(machine.moving(model, bindings | still, rates))
