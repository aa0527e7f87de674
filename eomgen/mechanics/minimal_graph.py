"""The scene over its independent coordinates only, the others bound to their formulas."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi

import sympy as sp

from eomgen.algebra.arithmetic import FLOAT
from eomgen.algebra.closed import Evaluation, to_sympy
from eomgen.algebra.graph import Node
from eomgen.algebra.lower import GraphAlgebra
from eomgen.algebra.normal import Form
from eomgen.mechanics import machine
from eomgen.mechanics.kinematics import Flow, Kinematics
from eomgen.mechanics.minimal import Elimination
from eomgen.model import TIME, Coordinate, Model


@dataclass(frozen=True)
class Chosen:
    """A dependent coordinate with the formula of its branch."""

    coordinate: Coordinate
    formula: sp.Expr
    branch: int  # index into the branches
    discriminant: sp.Expr | None


def choose(
    eliminations: Sequence[Elimination], values: Mapping[sp.Symbol, float]
) -> tuple[Chosen, ...]:
    """The branch of each formula that meets the values of the coordinates.

    Raises:
        ValueError: no branch meets them: the values are not admissible.
    """
    chosen = []
    for found in eliminations:
        errors = [_distance(found, branch, values) for branch in found.branches]
        best = min(range(len(errors)), key=errors.__getitem__)
        if errors[best] > 1e-6:
            raise ValueError(f"{found.coordinate.name} is on no branch of its formula")
        limit = None if found.discriminant is None else to_sympy(found.discriminant)
        formula = to_sympy(found.branches[best])
        chosen.append(Chosen(found.coordinate, formula, best, limit))
    return tuple(chosen)


def _distance(found: Elimination, branch: Form, values: Mapping[sp.Symbol, float]) -> float:
    """How far a branch is from the coordinate's value, angles modulo a full turn."""
    evaluate = Evaluation(values, float, lambda name, *a: FLOAT.functions[name](*a)).of
    try:
        difference = abs(float(evaluate(branch)) - values[found.coordinate.symbol])
    except (ValueError, ZeroDivisionError):
        return float("inf")
    turned = abs((difference + pi) % (2 * pi) - pi)
    return min(difference, turned) if found.coordinate.description.unit == "rad" else difference


def kinematics(model: Model, chosen: Sequence[Chosen]) -> Kinematics[Node]:
    """Kinematics over the independent coordinates and their rates."""
    dependent = [c.coordinate for c in chosen]
    free = tuple(c for c in model.coordinates if c not in dependent)
    small = replace(model, coordinates=free, constraints=())
    bindings = machine.known(small)
    graph = bindings[TIME].graph
    rates = {c.symbol: bindings[c.rate] for c in free}
    flow: dict[sp.Symbol, Node] = {**rates, TIME: graph.one}
    for link in chosen:
        algebra = GraphAlgebra(graph, bindings)
        bindings[link.coordinate.symbol] = algebra.of(link.formula)
        position = bindings[link.coordinate.symbol]
        bindings[link.coordinate.rate] = GraphAlgebra(graph, bindings).along(position, flow)
    return Kinematics(small, GraphAlgebra(graph, bindings), Flow(rates, flow))
