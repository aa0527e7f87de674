"""The runs of a chart: steps that meet the output times, errors on them, operations."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil, isfinite

import numpy as np

from eomgen.chart.records import OK, Combination, Errors, Point, Sweep
from eomgen.chart.reference import OUTPUTS, Motion, size_of
from eomgen.chart.variants import Variant
from eomgen.integrators.methods import Method
from eomgen.numerics import integrate
from eomgen.numerics.records import NEWTON, NOT_FINITE, SINGULAR, Array, Grid, Rows
from eomgen.render.steps_cost import cost
from eomgen.simulate_method import stiff

STEPS = 8  # each half of the one before
SLOWEST = 25.0  # radians over the run: where nothing oscillates
LARGEST = 2.0  # radians of the fastest mode that a step may turn, at first
DIVISORS = tuple(k for k in range(1, OUTPUTS // 10 + 1) if OUTPUTS % k == 0)
WEIGHTS = {"add": 1, "subtract": 1, "multiply": 1, "negate": 1, "divide": 20, "sqrt": 20, "pi": 0}
FUNCTION = 40  # a sine, and any other
FAR, ENERGY, CONSTRAINT = 0.3, 0.1, 1e-2  # errors above which a run has failed
RATE = 2e-9  # seconds for one weighted operation, to foresee what takes too long
IMPLICIT = {"rosenbrock", "midpoint"}


@dataclass(frozen=True)
class Plan:
    """A run that is to be made: its grid, and every how many output times it has a row."""

    run: Combination
    variant: Variant
    method: Method
    grid: Grid
    stride: int
    operations: float  # of one step, weighted


def weighted(found: Counter[str]) -> float:
    """Flops, where a division counts 20 and a sine 40 (a microcontroller is not far from it)."""
    return float(sum(n * WEIGHTS.get(operator, FUNCTION) for operator, n in found.items()))


def plans(variant: Variant, precision: str, sweep: Sweep, motion: Motion) -> Iterator[Plan]:
    """The runs of a variant in one precision, largest steps first."""
    steps, horizon = variant.setup.steps, float(motion.times[-1] - motion.times[0])
    for method in variant.methods:
        if sweep.integrators and method.name not in sweep.integrators:
            continue
        operations = weighted(cost(steps, method))
        for step in _steps(method, sweep, motion):
            grid, stride = _grid(variant.setup.start.time, horizon, step)
            run = Combination(
                variant.name, method.name, method.order, precision, grid.step, steps.size,
                variant.projects,
            )  # fmt: skip
            yield Plan(run, variant, method, grid, stride, operations)


def _steps(method: Method, sweep: Sweep, motion: Motion) -> list[float]:
    """Steps in a geometric row, each once after they were fitted to the output times."""
    horizon = float(motion.times[-1] - motion.times[0])
    if sweep.steps is not None:
        high, low, count = sweep.steps
        wanted: Array = np.geomspace(high, low, count)
    else:
        wanted = LARGEST / _fastest(method, motion.modes, horizon) * 0.5 ** np.arange(STEPS)
    fitted = [_grid(0.0, horizon, h)[0].step for h in wanted]
    return sorted(set(fitted), reverse=True)


def _fastest(method: Method, modes: Array, horizon: float) -> float:
    """Of the modes that the method has to resolve: an implicit one leaves out what decays."""
    if method.kind in IMPLICIT:
        modes = modes[~np.isin(modes, stiff(modes, horizon))]
    return max(float(np.max(np.abs(modes), initial=0.0)), SLOWEST / horizon)


def _grid(start: float, horizon: float, step: float) -> tuple[Grid, int]:
    """Whole steps between output times, or whole output times between steps."""
    gap = horizon / OUTPUTS
    if step <= gap * 1.0001:
        every = ceil(gap / step - 1e-9)
        return Grid(start, gap / every, OUTPUTS * every, every), 1
    stride = max(k for k in DIVISORS if k * gap <= step * 1.0001)
    return Grid(start, gap * stride, OUTPUTS // stride, 1), stride


def made(plan: Plan, reference: Motion, known: float) -> Point:
    """The point of a run; known: the error of the reference."""
    variant, run = plan.variant, plan.run
    engine = variant.engines[run.precision]
    flow = None if variant.setup.is_conserved else variant.setup.flow
    with np.errstate(all="ignore"):
        found = integrate.run(engine, plan.method, variant.setup.start.state, plan.grid, flow)
        errors = measured(plan, found, reference)
    status = _status(found, errors, plan.grid)
    resolved = errors.judged > 10 * known
    return Point(run, status, errors, plan.operations / run.step, resolved=resolved)


def missing(plan: Plan) -> Point:
    """The point of a run that was not made."""
    none = float("nan")
    errors = Errors(none, none, none, none, none)
    return Point(plan.run, "timeout", errors, plan.operations / plan.run.step)


def foreseen(plan: Plan) -> float:
    """About how many seconds a run will take."""
    return plan.operations * plan.grid.count * RATE


def measured(plan: Plan, found: Rows, reference: Motion) -> Errors:
    """Maxima over the output times that the run has reached."""
    variant, precision = plan.variant, plan.run.precision
    count = len(found.times)
    places, rates = variant.places(found.times, found.states, precision)
    outputs = variant.outputs(found.times, found.states, precision)
    rows = slice(None, count * plan.stride, plan.stride)
    return Errors(
        positions=_off(places, reference.places, rows),
        rates=_off(rates, reference.rates, rows),
        outputs=_off(outputs, reference.outputs, rows),
        energy=_energy(variant, found),
        constraint=_constraint(variant, found, places),
    )


def _off(found: Array, reference: Array, rows: slice) -> float:
    """The largest error over the size of its column; NaN where there is no column."""
    if not reference.shape[1]:
        return float("nan")
    return _largest(np.abs(found - reference[rows]) / size_of(reference))


def _largest(values: Array) -> float:
    """The largest value; infinite where one is none."""
    return float(np.max(values)) if np.all(np.isfinite(values)) else float("inf")


def _energy(variant: Variant, found: Rows) -> float:
    """|E - E0 - W| over the largest kinetic energy and the span of the potential one."""
    if variant.setup.flow is None:
        return float("nan")
    engine = variant.engines["f64"]  # the energy itself must not add errors of its own
    both = engine.sweep("energy", found.times, found.states)
    stored = engine.sweep(variant.setup.flow, found.times, found.states)[:, 0]
    scale = float(np.max(both[:, 0]) + np.ptp(both[:, 1]))
    error = _largest(np.abs(stored - stored[0] - found.works))
    return error / scale if scale > 0 else error


def _constraint(variant: Variant, found: Rows, places: Array) -> float:
    """The largest position residual over the size of the coordinates."""
    if not variant.setup.steps.has("constraint_residuals"):
        return 0.0
    values = variant.engines["f64"].sweep("constraint_residuals", found.times, found.states)
    if not values.size:
        return 0.0
    return _largest(np.abs(values)) / float(np.max(size_of(places)))


def _status(found: Rows, errors: Errors, grid: Grid) -> str:
    """The first thing that is wrong with a run."""
    if found.stopped & SINGULAR:
        return "singular"
    if found.stopped & NOT_FINITE or found.steps < grid.count or not isfinite(errors.judged):
        return "nan"
    if errors.judged > FAR:
        return "diverged"
    if found.tally.get(NEWTON):
        return "newton"
    if errors.constraint > CONSTRAINT:
        return "constraint"
    if errors.energy > ENERGY:
        return "energy"
    return OK
