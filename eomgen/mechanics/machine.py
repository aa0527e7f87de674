"""The scene on the graph: every symbol of the model bound to an argument of the program."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from eomgen.algebra.graph import Graph, Node
from eomgen.algebra.lower import GraphAlgebra
from eomgen.mechanics import speeds
from eomgen.mechanics.kinematics import Flow, Kinematics
from eomgen.model import TIME, Model, Parameter


def free_parameters(model: Model) -> tuple[Parameter, ...]:
    """Parameters that a caller may set; the others follow from them by a formula."""
    return tuple(p for p in model.parameters if p.formula is None)


def graph_kinematics(model: Model) -> Kinematics[Node]:
    """Kinematics on a new graph, over time, state = (coordinates, speeds), inputs, parameters.

    Raises:
        UsageError: declared speeds are not independent.
    """
    bindings = known(model)
    rates = speeds.rates(model, GraphAlgebra(bindings[TIME].graph, bindings))
    return moving(model, bindings, rates)


def known(model: Model) -> dict[sp.Symbol, Node]:
    """What every symbol but the rates stands for, on a new graph."""
    graph = Graph()
    bindings = _arguments(model, graph)
    _bind_derived(model, graph, bindings)
    _bind_prescribed(model, graph, bindings)
    return bindings


def moving(
    model: Model, bindings: dict[sp.Symbol, Node], rates: Sequence[Node]
) -> Kinematics[Node]:
    """Kinematics with these rates q' of the coordinates, over the speeds of the model."""
    graph = bindings[TIME].graph
    pairs = zip(model.coordinates, rates, strict=True)
    algebra = GraphAlgebra(graph, bindings | {c.rate: rate for c, rate in pairs})
    flow = {c.symbol: r for c, r in zip(model.coordinates, rates, strict=True)}
    spins = {s: algebra.of(s) for q in model.quaternions for s in q.speeds}
    return Kinematics(model, algebra, Flow(flow, {**flow, TIME: graph.one}, spins))


def _arguments(model: Model, graph: Graph) -> dict[sp.Symbol, Node]:
    """Leaves: arguments of the program."""
    state = [*(c.symbol for c in model.coordinates), *speeds.symbols(model)]
    bindings = {symbol: graph.read("state", i) for i, symbol in enumerate(state)}
    bindings[TIME] = graph.read("time", 0)
    for i, argument in enumerate(model.inputs):
        bindings[argument.symbol] = graph.read("inputs", i)
    for i, parameter in enumerate(free_parameters(model)):
        bindings[parameter.symbol] = graph.read("parameters", i)
    return bindings


def _bind_derived(model: Model, graph: Graph, bindings: dict[sp.Symbol, Node]) -> None:
    """Derived parameters by their formulas, in an order that has the names of each known."""
    waiting = {p.symbol: p.formula for p in model.parameters if p.formula is not None}
    while waiting:
        ready = {s: f for s, f in waiting.items() if f.free_symbols <= bindings.keys()}
        for symbol, formula in ready.items():
            bindings[symbol] = GraphAlgebra(graph, bindings).of(formula)
            del waiting[symbol]
        assert ready, "the spec reader refuses parameters that depend on each other in a circle"


def _bind_prescribed(model: Model, graph: Graph, bindings: dict[sp.Symbol, Node]) -> None:
    """Prescribed motions w(t) by their formulas, w' and w'' by differentiation in time."""
    for known in model.prescribed:
        algebra = GraphAlgebra(graph, bindings)
        bindings[known.symbol] = algebra.of(known.formula)
        bindings[known.rate] = algebra.along(bindings[known.symbol], {TIME: graph.one})
        bindings[known.acceleration] = algebra.along(bindings[known.rate], {TIME: graph.one})
