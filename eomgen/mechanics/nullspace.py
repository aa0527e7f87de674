"""Maggi's form: all coordinates, but only independent rates as speeds; no multipliers.

J_d u_d + J_i u_i + c = 0 is solved for the dependent speeds (rates, where the spec declares none);
the projection on the admissible virtual displacements is then d'Alembert's principle over the
independent speeds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from eomgen.algebra import elimination
from eomgen.algebra.arithmetic import FLOAT, evaluate, over
from eomgen.algebra.graph import LEAVES, Graph, Node
from eomgen.algebra.ldl import Pivots
from eomgen.algebra.lower import GraphAlgebra
from eomgen.algebra.walk import below
from eomgen.errors import UsageError
from eomgen.mechanics import constraints, machine, speeds
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.kinematics import Kinematics
from eomgen.model import TIME, Model, Speed


@dataclass(frozen=True)
class Reduced:
    """Kinematics over independent speeds, and the pivots that the dependent rates divide by."""

    kinematics: Kinematics[Node]
    pivots: Pivots
    determinant: Node  # of the block that was solved for them, but for its sign


def declared(model: Model) -> tuple[Speed, ...]:
    """The speeds of the spec, or the rates as speeds."""
    if model.speeds:
        return model.speeds
    return tuple(Speed(c.rate.name, c.rate, c.acceleration, c.rate) for c in model.coordinates)


def derive(
    model: Model, independent: Sequence[str], kept: Sequence[str], at: Mapping[str, Sequence[float]]
) -> Reduced:
    """Kinematics of a linked scene over its independent speeds, those of these names.

    kept: names of the independent rows, as many as there are dependent speeds; at: arguments of
    the program (`time`, `state`, `parameters`) where the order of elimination is chosen.
    """
    own = declared(model)
    small = replace(model, speeds=tuple(s for s in own if s.name in independent))
    bindings = machine.known(small)
    dependent = [s.symbol for s in own if s.name not in independent]
    graph = bindings[TIME].graph
    known = bindings | {s: graph.symbol(s.name) for s in dependent}
    trial = machine.moving(small, known, speeds.rates(model, GraphAlgebra(graph, known)))
    unknown = [s.symbol for s in own]
    rows = [r for r in constraints.rows(trial, unknown) if r.name in kept]
    columns = [unknown.index(s) for s in dependent]
    found, pivots, determinant = dependent_speeds(
        rows, columns, known, (dependent, _leaves(graph, at))
    )
    bindings |= found
    rates = speeds.rates(model, GraphAlgebra(graph, bindings))
    return Reduced(machine.moving(small, bindings, rates), pivots, determinant)


def dependent_speeds(
    rows: Sequence[Row[Node]],
    columns: Sequence[int],
    bindings: Mapping[sp.Symbol, Node],
    by: tuple[Sequence[sp.Symbol], Mapping[Node, float]],
) -> tuple[dict[sp.Symbol, Node], Pivots, Node]:
    """(dependent speeds over the independent ones, squared pivots with scales, their determinant).

    columns: of the dependent speeds in the rows; by: (their symbols, which are bound to leaves of
    their own; the numbers by which the order of elimination is chosen).
    """
    dependent, leaves = by
    matrix = [[row.jacobian[j] for j in columns] for row in rows]
    # J does not depend on the speeds
    order = elimination.order_of([evaluate(row, leaves, FLOAT) for row in matrix])
    if len(order.columns) < len(columns):
        names = ", ".join(str(symbol).removesuffix("'") for symbol in dependent)
        raise UsageError(
            f"W-PIVOT: the constraints do not determine the rates of {names} at the initial state; "
            "start elsewhere, give other coordinates `role: free`, or use multiplier"
        )
    # with the dependent speeds at zero the rate residual is J_i u_i + c
    residuals = [row.rate for row in rows]
    algebra = GraphAlgebra(residuals[0].graph, bindings)
    values = {a: a for a in below(residuals) if a.operator in LEAVES}
    values |= {bindings[s]: algebra.number(0) for s in dependent}
    rest = evaluate(residuals, values, over(algebra))
    (solution,), pivots, determinant = elimination.solve(matrix, [[-r for r in rest]], order)
    return dict(zip(dependent, solution, strict=True)), pivots, determinant


def _leaves(graph: Graph, at: Mapping[str, Sequence[float]]) -> dict[Node, float]:
    """Arguments of the program as the nodes that read them."""
    return {
        graph.read(argument, i): value
        for argument, values in at.items()
        for i, value in enumerate(values)
    }
