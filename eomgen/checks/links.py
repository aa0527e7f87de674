"""Linked scenes: rows in both algebras are the same, and all formulations agree."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from eomgen.algebra.arithmetic import FLOAT
from eomgen.analysis import linkage
from eomgen.analysis.admissible import Admissible
from eomgen.analysis.linkage import State
from eomgen.checks.evaluation import Bench, benches, over
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError
from eomgen.formulation import Formulation, Linked
from eomgen.mechanics import speeds
from eomgen.mechanics.equations import ConstraintRow, Derivation

TOLERANCE = 1e-10
SAME_PLACE = 1e-6  # of coordinates in one assembly mode


def rows(derivation: Derivation, machine: Machine, samples: Samples) -> float:
    """The worst relative difference of J and gamma between closed form and graph.

    Raises:
        CheckError: they differ.
    """
    error = max(over(benches(machine, samples), lambda at, _: _row_error(derivation, at)))
    if error > TOLERANCE:
        raise CheckError(
            f"the constraint rows of closed form and graph differ, relative error {error:.1e}: "
            "this is a defect of eomgen, nothing was written"
        )
    return error


def _row_error(derivation: Derivation, at: Bench) -> Any:
    form = at.forms()
    worst: Any = 0.0
    for closed, row in zip(derivation.constraints, at.machine.rows, strict=True):
        graph = at.nodes([*row.jacobian, row.gamma])
        values = [form(f) for f in _forms(closed)]
        scale = sum(abs(v) for v in (*graph, *values))
        difference = sum(abs(a - b) for a, b in zip(graph, values, strict=True))
        worst = at.arithmetic.functions["max"](worst, difference / (scale + (scale == 0)))
    return worst


def _forms(row: ConstraintRow) -> list[Any]:
    return [*row.jacobian, row.gamma]


def samples_of(scene: Linked, states: Sequence[Admissible], drawn: Samples) -> Samples:
    """Admissible states as samples, with the inputs and accelerations of random ones."""
    exact = _columns(scene, states, drawn, lambda value: value)
    return replace(_columns(scene, states, drawn, float), exact=exact)


def _columns(
    scene: Linked, states: Sequence[Admissible], drawn: Samples, number: Callable[[Any], Any]
) -> Samples:
    count, size = len(states), len(scene.model.coordinates)
    found = [s.state for s in states]
    moving = [[number(v) for v in speeds_of(scene, s.state)] for s in states]
    return Samples(
        count=count,
        time=[number(s.time) for s in found],
        state=[
            *([number(s.coordinates[j]) for s in found] for j in range(size)),
            *([row[j] for row in moving] for j in range(len(drawn.accelerations))),
        ],
        inputs=[column[:count] for column in drawn.inputs],
        parameters=[[number(s.parameters[k]) for s in found] for k in range(len(drawn.parameters))],
        accelerations=[column[:count] for column in drawn.accelerations],
    )


def speeds_of(scene: Linked, state: State) -> Sequence[Any]:
    """The speeds of a state whose rates are known."""
    algebra = scene.links.kinematics.algebra
    nodes = [algebra.of(s.formula) for s in scene.model.speeds]
    return linkage.values(scene.links, nodes, state, linkage.PRECISE) if nodes else state.rates


def formulations_agree(
    scene: Linked, formulations: Sequence[Formulation], samples: Samples
) -> float:
    """The worst relative difference of accelerations at admissible states.

    Raises:
        CheckError: two formulations differ.
    """
    worst, compared = 0.0, set()
    for i in range(samples.count):
        own = [f for f in formulations if is_in_mode(scene, f, samples, i)]
        compared |= {f.name for f in own}
        found = {f.name: accelerations(scene, f, samples, i) for f in own}
        reference = found.pop("multiplier")
        scale = max(*map(abs, reference.values()), _free_size(scene, samples, i)) or 1.0
        for name, values in found.items():
            error = max(abs(v - reference[q]) for q, v in values.items()) / scale
            worst = max(worst, error)
            if not error <= TOLERANCE:
                raise CheckError(
                    f"formulation {name} and multiplier differ at an admissible state, relative "
                    f"error {error:.1e}: this is a defect of eomgen, nothing was written"
                )
    for formulation in formulations:
        if formulation.name not in compared:
            raise CheckError(
                f"no admissible state was found in the assembly mode of {formulation.name}; "
                "give `guess` or `range` values nearer to the initial state"
            )
    return worst


def is_in_mode(scene: Linked, formulation: Formulation, samples: Samples, index: int) -> bool:
    """Whether a formulation has the coordinates of a state: an elimination has one assembly mode.

    An angle may differ by whole turns.
    """
    symbols = [c.symbol for c in scene.model.coordinates]
    bindings = formulation.machine.kinematics.algebra.bindings
    if not all(s in bindings for s in symbols):
        return True
    values = dict(zip(symbols, (column[index] for column in samples.state), strict=False))
    model = formulation.machine.model
    rates = [0.0] * len(speeds.symbols(model))
    at = _at(
        formulation.machine,
        samples,
        index,
        [*(values[c.symbol] for c in model.coordinates), *rates],
    )
    places = at.nodes([bindings[s] for s in symbols])
    return all(
        abs(math.remainder(float(place) - values[s], 2 * math.pi)) < SAME_PLACE
        or abs(float(place) - values[s]) < SAME_PLACE
        for place, s in zip(places, symbols, strict=True)
    )


def _free_size(scene: Linked, samples: Samples, index: int) -> float:
    """How fast the scene would accelerate without its constraints: the size of what cancels."""
    state = [column[index] for column in samples.state]
    free = _at(scene.machine, samples, index, state).nodes(scene.machine.schur.free)
    return max(abs(float(v)) for v in free)


def accelerations(
    scene: Linked, formulation: Formulation, samples: Samples, index: int
) -> dict[str, float]:
    """q'' by coordinate, for the coordinates that the formulation has."""
    model = formulation.machine.model
    names = [c.symbol for c in scene.model.coordinates] + [*speeds.symbols(scene.model)]
    values = dict(zip(names, (column[index] for column in samples.state), strict=True))
    own = [c.name for c in model.coordinates]
    state = [values[s] for s in (*(c.symbol for c in model.coordinates), *speeds.symbols(model))]
    at = _at(formulation.machine, samples, index, state)
    found = at.nodes(formulation.machine.accelerations)
    return {name: float(value) for name, value in zip(own, found, strict=True)}


def _at(machine: Machine, samples: Samples, index: int, state: Sequence[float]) -> Bench:
    arguments = {n: [c[index] for c in columns] for n, columns in samples.arguments().items()}
    arguments["state"] = list(state)
    leaves = {n: arguments[n.datum.argument][n.datum.index] for n in machine.leaves}
    return Bench(machine, leaves, FLOAT)
