"""Many states for a measurement: inside the declared ranges, on the constraints, exact in float."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import sympy as sp

from eomgen.algebra.arithmetic import NUMPY
from eomgen.algebra.graph import Node
from eomgen.analysis import linkage as linkages
from eomgen.analysis.admissible import boxes_of
from eomgen.analysis.linkage import Linkage, State
from eomgen.checks import samples
from eomgen.errors import CheckError
from eomgen.formulation import Linked
from eomgen.mechanics import machine, speeds
from eomgen.precision.records import Array, Sampled
from eomgen.study import Study

STEPS = 25  # of Newton's method
CLOSED = 1e-9  # what a residual may be
ROUND_OFF = 1e-13
SHARES = (1.0, 1.0, 1.0, 0.5, 0.5, 0.2, 0.2, 0.2)  # of the box, one batch after the other
LATEST = 3.0  # [s]
FASTEST = 2.0  # of rates and inputs


def draw(study: Study, count: int) -> Sampled:
    """So many random states for the program of a study, always the same ones; fewer if rare.

    Raises:
        CheckError: no state was found.
    """
    drawn = samples.draw(study.model, count)
    if study.links is None:
        time, state = np.array(drawn.time), np.array(drawn.state)
    else:
        time, state = _on_constraints(study, study.links.scene, count)
    inputs = np.array(drawn.inputs).reshape(len(study.model.inputs), count)[:, : len(time)]
    given = samples.constants(study.model)
    parameters = [given[p.symbol] for p in machine.free_parameters(study.model)]
    exact = (_in_float(a) for a in (time, state, inputs, np.array(parameters, float)))
    return Sampled(count, *exact)


def _in_float(values: Array) -> Array:
    """The nearest numbers that float has, so that every precision is given the same state."""
    return values.astype(np.float32).astype(float)


def _on_constraints(study: Study, scene: Linked, count: int) -> tuple[Array, Array]:
    """(times, states of the program) on the constraints, in doubles."""
    linkage, first = scene.links, scene.report.initial.state
    chance, boxes = random.Random(f"precision {linkage.model.name}"), boxes_of(linkage, first)
    own = study.compiled.model
    wanted = [*(c.symbol for c in own.coordinates), *speeds.symbols(own)]
    rows: list[Array] = []
    for share in SHARES:
        if sum(len(r) for r in rows) >= count:
            break
        at = _rated(linkage, _placed(linkage, _starts(linkage, first, (chance, share, count))))
        values = _values(scene, at)
        found = np.stack([at.time, *(values[s] for s in wanted)], axis=1)
        rows.append(found[_is_admissible(linkage, at, boxes)])
    kept = np.concatenate(rows)[:count]
    if not len(kept):
        raise CheckError(
            "no admissible state was found to measure at; give `range` or `initial` values "
            "nearer to states that satisfy the constraints"
        )
    return kept[:, 0], kept[:, 1:].T


def _starts(linkage: Linkage, first: State, how: tuple[random.Random, float, int]) -> State:
    """Random states in the box of each coordinate, or in that share of it about the first state."""
    chance, share, count = how

    def uniform(low: float, high: float) -> Array:
        return np.array([chance.uniform(low, high) for _ in range(count)])

    boxes = zip(boxes_of(linkage, first), first.coordinates, strict=True)
    return State(
        uniform(0.0, LATEST),
        tuple(uniform(low, high) * share + float(q) * (1 - share) for (low, high, _), q in boxes),
        tuple(uniform(-FASTEST, FASTEST) for _ in first.rates),
        tuple(float(p) for p in first.parameters),
    )


def _placed(linkage: Linkage, state: State) -> State:
    """The states moved to the positions of the constraints by Newton's method."""
    rows = linkage.holonomic
    residuals = [r.residual for r in rows if r.residual is not None]
    for _ in range(STEPS if rows else 0):
        found = _columns(linkage, [*residuals, *(a for r in rows for a in r.jacobian)], state)
        if (np.abs(found[:, : len(rows)]) < ROUND_OFF).all():
            break
        moved = _least_change(found, len(rows))
        places = zip(state.coordinates, moved, strict=True)
        state = replace(state, coordinates=tuple(q + step for q, step in places))
    return state


def _rated(linkage: Linkage, state: State) -> State:
    """The states with rates that satisfy every row, J q' + b = 0, which is linear in them."""
    rows = linkage.rows
    if not rows:
        return state
    nodes = [*(r.rate for r in rows), *(a for r in rows for a in r.jacobian)]
    moved = _least_change(_columns(linkage, nodes, state), len(rows))
    return replace(state, rates=tuple(v + step for v, step in zip(state.rates, moved, strict=True)))


def _columns(linkage: Linkage, nodes: list[Node], state: State) -> Array:
    """Values (N, number of nodes)."""
    with NUMPY.quiet():
        found = linkages.values(linkage, nodes, state, NUMPY)
    return np.stack([np.broadcast_to(v, state.time.shape) for v in found], axis=-1)


def _least_change(found: Array, rows: int) -> Array:
    """-J^+ r for every state, (n, N); zero where it is not finite."""
    finite = np.asarray(np.isfinite(found).all(axis=1))
    usable = np.where(finite[:, None], found, 0.0)
    slopes = usable[:, rows:].reshape(len(found), rows, -1)
    steps: Array = -np.einsum("kij,kj->ik", np.linalg.pinv(slopes, rcond=1e-11), usable[:, :rows])
    return steps


def _is_admissible(linkage: Linkage, state: State, boxes: list[tuple[float, float, bool]]) -> Array:
    """At which states the rows hold, no gap is negative and the declared ranges are kept."""
    held = [r.rate for r in linkage.rows]
    held += [r.residual for r in linkage.holonomic if r.residual is not None]
    gaps = [gap for _, gap in linkage.gaps]
    found = _columns(linkage, held + gaps, state) if held + gaps else np.zeros((len(state.time), 0))
    kept: Array = np.abs(found[:, : len(held)]).max(axis=1, initial=0.0) < CLOSED
    kept = kept & (found[:, len(held) :] >= 0).all(axis=1)
    for values, (low, high, declared) in zip(state.coordinates, boxes, strict=True):
        kept = kept & ((values >= low) & (values <= high) if declared else np.isfinite(values))
    return kept


def _values(scene: Linked, state: State) -> dict[sp.Symbol, Array]:
    """Coordinates and speeds of the whole scene by their symbols."""
    model = scene.model
    moving = state.rates
    if model.speeds:
        algebra = scene.links.kinematics.algebra
        nodes = [algebra.of(s.formula) for s in model.speeds]
        moving = tuple(_columns(scene.links, nodes, state).T)
    symbols = [*(c.symbol for c in model.coordinates), *speeds.symbols(model)]
    return dict(zip(symbols, (*state.coordinates, *moving), strict=True))
