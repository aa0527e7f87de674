"""The scene over its independent coordinates only, the others bound to their formulas."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite, pi

import sympy as sp

from eomgen.algebra.arithmetic import FLOAT, evaluate, over
from eomgen.algebra.graph import LEAVES, Graph, Node
from eomgen.algebra.ldl import Pivots
from eomgen.algebra.lower import GraphAlgebra
from eomgen.algebra.walk import below
from eomgen.mechanics import constraints, machine, nullspace
from eomgen.mechanics.kinematics import Flow, Kinematics
from eomgen.mechanics.minimal import Elimination
from eomgen.mechanics.nullspace import Reduced
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
        chosen.append(Chosen(found.coordinate, found.branches[best], best, found.discriminant))
    return tuple(chosen)


def _distance(found: Elimination, branch: sp.Expr, values: Mapping[sp.Symbol, float]) -> float:
    """How far a branch is from the coordinate's value, angles modulo a full turn."""
    difference = abs(measure(branch)(values) - values[found.coordinate.symbol])
    if found.coordinate.description.unit != "rad" or not isfinite(difference):
        return difference
    return min(difference, abs((difference + pi) % (2 * pi) - pi))


def measure(formula: sp.Expr) -> Callable[[Mapping[sp.Symbol, float]], float]:
    """The formula as a function of the values of its symbols; infinite where it is not defined."""
    graph = Graph()
    symbols = sorted(formula.free_symbols, key=str)
    leaves = {symbol: graph.symbol(symbol.name) for symbol in symbols}
    node = GraphAlgebra(graph, leaves).of(formula)

    def value(values: Mapping[sp.Symbol, float]) -> float:
        try:
            return float(evaluate([node], {n: values[s] for s, n in leaves.items()}, FLOAT)[0])
        except (ValueError, ZeroDivisionError):
            return inf

    return value


def derive(
    model: Model,
    chosen: Sequence[Chosen],
    kept: Sequence[str],
    values: Mapping[sp.Symbol, float],
) -> Reduced:
    """Kinematics over the independent coordinates and their rates.

    The dependent rates follow from the rows, J_d q'_d + J_i q'_i + c = 0: what the formulas of the
    positions would become by differentiation is several times as long.

    kept: names of the independent rows; values: of every coordinate and parameter and the time at
    an admissible state, by which the order of elimination is chosen.
    """
    dependent = [c.coordinate for c in chosen]
    free = tuple(c for c in model.coordinates if c not in dependent)
    small = replace(model, coordinates=free, constraints=())
    bindings = machine.known(small)
    graph = bindings[TIME].graph
    places, rates, pivots, determinant = _over_leaves(model, dependent, kept, (bindings, values))
    for link in chosen:
        bindings[link.coordinate.symbol] = GraphAlgebra(graph, bindings).of(link.formula)
    # the leaves that stood for dependent coordinates give way to their formulas
    nodes = [*rates.values(), *(node for pair in pivots for node in pair), determinant]
    put: dict[Node, Node] = {a: a for a in below(nodes) if a.operator in LEAVES}
    put |= {leaf: bindings[symbol] for symbol, leaf in places.items()}
    found = iter(evaluate(nodes, put, over(GraphAlgebra(graph, bindings))))
    bindings |= {symbol: next(found) for symbol in rates}
    own = {c.symbol: bindings[c.rate] for c in free}
    flow = {c.symbol: bindings[c.rate] for c in model.coordinates}
    algebra = GraphAlgebra(graph, bindings)
    checked = tuple((next(found), next(found)) for _ in pivots)
    moving = Kinematics(small, algebra, Flow(own, {**flow, TIME: graph.one}))
    return Reduced(moving, checked, next(found))


def _over_leaves(
    model: Model,
    dependent: Sequence[Coordinate],
    kept: Sequence[str],
    known: tuple[Mapping[sp.Symbol, Node], Mapping[sp.Symbol, float]],
) -> tuple[dict[sp.Symbol, Node], dict[sp.Symbol, Node], Pivots, Node]:
    """(dependent coordinates as leaves, rates over these, pivots, determinant).

    Leaves, for sqrt(a)^2 would be a.
    """
    bindings, values = known
    graph = bindings[TIME].graph
    places = {c.symbol: graph.symbol(c.name) for c in dependent}
    moving = {c.rate: graph.symbol(c.rate.name) for c in dependent}
    everything = {**bindings, **places, **moving}
    trial = machine.moving(model, everything, [everything[c.rate] for c in model.coordinates])
    rows = [r for r in constraints.rows(trial) if r.name in kept]
    leaves = {n: values[s] for s, n in everything.items() if n.operator in LEAVES and s in values}
    columns = [j for j, c in enumerate(model.coordinates) if c in dependent]
    unknown = [model.coordinates[j].rate for j in columns]
    found = nullspace.dependent_speeds(rows, columns, everything, (unknown, leaves))
    return places, *found
