"""Maggi's form: all coordinates, but only independent rates as speeds; no multipliers.

J_d q'_d + J_i q'_i + c = 0 is solved for the dependent rates; the projection on the admissible
virtual displacements is then d'Alembert's principle over the independent speeds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from eomgen.algebra import elimination
from eomgen.algebra.arithmetic import FLOAT, evaluate, over
from eomgen.algebra.graph import LEAVES, Graph, Node, below
from eomgen.algebra.ldl import Pivots
from eomgen.algebra.lower import GraphAlgebra
from eomgen.mechanics import constraints, machine
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.kinematics import Kinematics
from eomgen.model import TIME, Coordinate, Model, Speed


@dataclass(frozen=True)
class Reduced:
    """Kinematics over independent speeds, and the pivots that the dependent rates divide by."""

    kinematics: Kinematics[Node]
    pivots: Pivots


def reduced_model(model: Model, independent: Sequence[str]) -> Model:
    """The model with the rates of the independent coordinates as its speeds."""
    chosen = [c for c in model.coordinates if c.name in independent]
    speeds = tuple(Speed(c.rate.name, c.rate, c.acceleration, c.rate) for c in chosen)
    return replace(model, speeds=speeds)


def derive(
    model: Model, independent: Sequence[str], kept: Sequence[str], at: Mapping[str, Sequence[float]]
) -> Reduced:
    """Kinematics of a linked scene over the rates of its independent coordinates.

    kept: names of the independent rows, as many as there are dependent coordinates; at: arguments
    of the program (`time`, `state`, `parameters`) where the order of elimination is chosen.
    """
    small = reduced_model(model, independent)
    bindings = machine.known(small)
    dependent = [c for c in model.coordinates if c.name not in independent]
    graph = bindings[TIME].graph
    leaves = {c.rate: graph.symbol(c.rate.name) for c in dependent}
    algebra = GraphAlgebra(graph, bindings | leaves)
    everything = [algebra.of(c.rate) for c in model.coordinates]
    trial = machine.moving(small, bindings | leaves, everything)
    rows = [r for r in constraints.rows(trial) if r.name in kept]
    found, pivots = dependent_rates(trial, rows, dependent, _leaves(graph, at))
    rates = [found.get(c.rate, algebra.of(c.rate)) for c in model.coordinates]
    return Reduced(machine.moving(small, bindings, rates), pivots)


def dependent_rates(
    trial: Kinematics[Node],
    rows: Sequence[Row[Node]],
    dependent: Sequence[Coordinate],
    leaves: Mapping[Node, float],
) -> tuple[dict[sp.Symbol, Node], Pivots]:
    """The dependent rates over the independent ones, and the squared pivots with their scales.

    trial: kinematics whose rates of the dependent coordinates are leaves of their own; leaves: the
    numbers by which the order of elimination is chosen.
    """
    names = [c.name for c in trial.model.coordinates]
    columns = [names.index(c.name) for c in dependent]
    matrix = [[row.jacobian[j] for j in columns] for row in rows]
    # J does not depend on the rates
    order = elimination.order_of([evaluate(row, leaves, FLOAT) for row in matrix])
    # with the dependent rates at zero the rate residual is J_i q'_i + c
    residuals = [row.rate for row in rows]
    values = {a: a for a in below(residuals) if a.operator in LEAVES}
    values |= {trial.algebra.of(c.rate): trial.algebra.number(0) for c in dependent}
    rest = evaluate(residuals, values, over(trial.algebra))
    (solution,), pivots = elimination.solve(matrix, [[-r for r in rest]], order)
    return {c.rate: rate for c, rate in zip(dependent, solution, strict=True)}, pivots


def _leaves(graph: Graph, at: Mapping[str, Sequence[float]]) -> dict[Node, float]:
    """Arguments of the program as the nodes that read them."""
    return {
        graph.read(argument, i): value
        for argument, values in at.items()
        for i, value in enumerate(values)
    }
