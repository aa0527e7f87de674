"""The constraint rows of a scene as numbers: values at a state, in doubles or in 50 digits.

The rows are linear in the rates q' whatever speeds the scene declares:  J(q, t) q' + b(q, t) = 0.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp

from eomgen.algebra.arithmetic import Arithmetic, evaluate, mpmath_arithmetic, over
from eomgen.algebra.graph import Node
from eomgen.compile import Machine
from eomgen.errors import UsageError
from eomgen.mechanics import constraints, machine
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.kinematics import Kinematics
from eomgen.model import Constraint, Model, Parameter
from eomgen.program import Read

DIGITS = 50
PRECISE = mpmath_arithmetic(DIGITS)
IRREGULAR = (ValueError, ZeroDivisionError, OverflowError)  # a root or quotient is not defined


@dataclass(frozen=True)
class State:
    """Numbers of one kind for everything that a row depends on; `parameters` are the free ones."""

    time: Any
    coordinates: tuple[Any, ...]
    rates: tuple[Any, ...]
    parameters: tuple[Any, ...]

    def read(self, leaf: Read) -> Any:
        """The value of an argument of the program; constraints read no inputs."""
        columns: dict[str, Sequence[Any]] = {
            "time": [self.time],
            "state": [*self.coordinates, *self.rates],
            "parameters": self.parameters,
        }
        return columns[leaf.argument][leaf.index]


@dataclass(frozen=True)
class Linkage:
    """The rows on a graph whose speeds are the rates q'; holonomic rows first, as declared."""

    kinematics: Kinematics[Node]
    rows: tuple[Row[Node], ...]
    gaps: tuple[tuple[str, Node], ...] = ()  # of unilateral constraints: name, gap >= 0

    @property
    def model(self) -> Model:
        """The scene, without its quasi-velocities."""
        return self.kinematics.model

    @cached_property
    def holonomic(self) -> tuple[Row[Node], ...]:
        """Rows that are stated between positions."""
        return tuple(r for r in self.rows if r.is_holonomic)

    @cached_property
    def drifts(self) -> tuple[Node, ...]:
        """The b of J q' + b for every row: the rate at q' = 0."""
        algebra = self.kinematics.algebra
        resting = {algebra.bindings[c.rate]: self.zero for c in self.model.coordinates}
        places = {leaf: leaf for leaf in self.leaves} | resting
        return tuple(evaluate([r.rate for r in self.rows], places, over(algebra)))

    @property
    def zero(self) -> Node:
        """The number 0 of the graph."""
        return self.kinematics.algebra.number(0)

    @cached_property
    def leaves(self) -> tuple[Node, ...]:
        """The arguments that rows may read."""
        bound = self.kinematics.algebra.bindings.values()
        return tuple(node for node in dict.fromkeys(bound) if isinstance(node.datum, Read))


def of(scene: Machine) -> Linkage:
    """The rows of a scene.

    Raises:
        UsageError: a constraint depends on an input.
    """
    model = scene.model
    for constraint in model.constraints:
        _refuse_inputs(model, constraint)
    kinematics, rows = scene.kinematics, scene.rows
    if model.speeds:
        kinematics = machine.graph_kinematics(without_speeds(model))
        rows = constraints.rows(kinematics)
    gaps = tuple(
        (c.name, gap)
        for c in model.constraints
        if c.kind == "unilateral"
        for gap in constraints.residuals_of(kinematics, c)
    )
    return Linkage(kinematics, tuple(sorted(rows, key=lambda r: not r.is_holonomic)), gaps)


def _refuse_inputs(model: Model, constraint: Constraint) -> None:
    inputs = {i.symbol: i.name for i in model.inputs}
    for residual in constraint.residuals:
        found = sorted(inputs[s] for s in residual.free_symbols & inputs.keys())
        if found:
            raise UsageError(
                f"constraint {constraint.name} depends on the input {found[0]}; a constraint may "
                "depend on time only through `t` or a prescribed motion"
            )


def without_speeds(model: Model) -> Model:
    """The model in the rates q' alone: quasi-velocities in rows are replaced by their formulas."""
    formulas = {s.symbol: s.formula for s in model.speeds}
    rows = tuple(
        replace(c, residuals=tuple(r.xreplace(formulas) for r in c.residuals))
        for c in model.constraints
    )
    return replace(model, speeds=(), constraints=rows)


def values(
    linkage: Linkage,
    nodes: Iterable[Node],
    state: State,
    arithmetic: Arithmetic,
) -> list[Any]:
    """The values of nodes at a state."""
    leaves = {
        leaf: arithmetic.number(state.read(leaf.datum))
        for leaf in linkage.leaves
        if leaf.datum.argument != "inputs"
    }
    return evaluate(nodes, leaves, arithmetic)


def matrix(
    linkage: Linkage, rows: Sequence[Sequence[Node]], state: State, arithmetic: Arithmetic
) -> list[list[Any]]:
    """The values of a matrix of nodes at a state."""
    flat = values(linkage, [entry for row in rows for entry in row], state, arithmetic)
    entries = iter(flat)
    return [[next(entries) for _ in row] for row in rows]


def jacobian(linkage: Linkage, state: State) -> list[list[Any]]:
    """J of every row in 50 digits."""
    return matrix(linkage, [row.jacobian for row in linkage.rows], state, PRECISE)


def free_parameters(linkage: Linkage) -> tuple[tuple[Any, ...], tuple[str, ...]]:
    """(values of the free parameters in 50 digits, names of those that the spec leaves open).

    An open parameter stands in with a fixed random number between 1 and 2, as in all checks.
    """
    chance = random.Random(f"parameters {linkage.model.name}")
    free = machine.free_parameters(linkage.model)
    open_ones = tuple(p.name for p in free if p.value is None)
    return tuple(_parameter(linkage, p, chance) for p in free), open_ones


def _parameter(linkage: Linkage, parameter: Parameter, chance: random.Random) -> Any:
    if parameter.value is None:
        return PRECISE.number(chance.uniform(1.0, 2.0))
    return constant(linkage, parameter.value, ())


def constant(linkage: Linkage, value: Any, parameters: Sequence[Any]) -> Any:
    """A formula of parameters, or a number, in 50 digits."""
    if not isinstance(value, sp.Expr):
        return PRECISE.number(value)
    node = linkage.kinematics.algebra.of(value)
    state = State(0, (), (), tuple(parameters))
    leaves = {
        leaf: state.read(leaf.datum)
        for leaf in linkage.leaves
        if leaf.datum.argument == "parameters" and leaf.datum.index < len(parameters)
    }
    return evaluate([node], leaves, PRECISE)[0]
