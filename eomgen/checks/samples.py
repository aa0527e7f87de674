"""Random states at which identities are compared: seeded, inside the declared range."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from eomgen.algebra.graph import Node
from eomgen.mechanics import machine, speeds
from eomgen.model import Coordinate, Model

COUNT = 50


@dataclass(frozen=True)
class Samples:
    """Arguments of a program's functions: for each component, `count` values.

    known: values of nodes at all samples, which one check leaves to the next.
    """

    count: int
    time: list[float]
    state: list[list[float]]  # coordinates, then speeds
    inputs: list[list[float]]
    parameters: list[list[float]]
    accelerations: list[list[float]]  # of the speeds
    exact: Samples | None = None  # the same in 50 digits, where floats are off the constraints
    known: dict[Node, Any] = field(default_factory=dict, init=False, repr=False, compare=False)

    def arguments(self) -> dict[str, list[list[float]]]:
        """The components by the names that `program.Read` uses."""
        return {
            "time": [self.time],
            "state": self.state,
            "inputs": self.inputs,
            "parameters": self.parameters,
        }


def draw(model: Model, count: int = COUNT, seed: int = 1) -> Samples:
    """Random samples of everything that an equation depends on."""
    chance = random.Random(f"{seed} {model.name}")
    unknown = speeds.symbols(model)

    def values(low: float, high: float) -> list[float]:
        return [chance.uniform(low, high) for _ in range(count)]

    given = constants(model)
    places = [values(*bounds(model, c, given)) for c in model.coordinates]
    _normalise(model, places)
    return Samples(
        count=count,
        time=values(0.0, 3.0),
        state=[
            *places,
            *(values(-2.0, 2.0) for _ in unknown),
        ],
        inputs=[values(-2.0, 2.0) for _ in model.inputs],
        parameters=[
            # near the spec's value, so that the identity is not tested at one point only
            values(*sorted((0.9 * given[p.symbol], 1.1 * given[p.symbol])))
            for p in machine.free_parameters(model)
        ],
        accelerations=[values(-2.0, 2.0) for _ in unknown],
    )


def _normalise(model: Model, places: list[list[float]]) -> None:
    """Give the quaternions among sampled coordinates the length 1."""
    index = {c.symbol: i for i, c in enumerate(model.coordinates)}
    for quaternion in model.quaternions:
        parts = [places[index[s]] for s in quaternion.symbols]
        for k, values in enumerate(zip(*parts, strict=True)):
            length = math.hypot(*values)
            for part in parts:
                part[k] /= length


def constants(model: Model) -> dict[sp.Symbol, float]:
    """Values of the free parameters; 1 to 2 for those that the spec leaves open."""
    chance = random.Random(f"parameters {model.name}")
    return {
        p.symbol: float(p.value) if p.value is not None else chance.uniform(1.0, 2.0)
        for p in machine.free_parameters(model)
    }


def bounds(
    model: Model, coordinate: Coordinate, given: Mapping[sp.Symbol, float]
) -> tuple[float, float]:
    """The declared range of a coordinate; else around the initial value, positive if declared."""
    if coordinate.name in model.range:
        low, high = (float(number(model, v, given)) for v in model.range[coordinate.name])
        return low, high
    if coordinate.positive:
        return 0.5, 2.0
    return -1.5, 1.5


def number(model: Model, value: sp.Expr, given: Mapping[sp.Symbol, float]) -> sp.Expr:
    """A constant formula of parameters as a number."""
    if not value.free_symbols:
        return value
    formulas = {p.symbol: p.formula for p in model.parameters if p.formula is not None}
    while value.free_symbols & formulas.keys():
        value = value.xreplace(formulas)
    return value.xreplace({s: sp.Float(given[s]) for s in value.free_symbols & given.keys()})
