"""The motion that runs are compared with: two ways to it, and how far they differ."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil, log

import numpy as np

from eomgen import simulate
from eomgen.chart.records import Reference
from eomgen.chart.variants import Variant
from eomgen.errors import CheckError
from eomgen.integrators.methods import METHODS
from eomgen.numerics import integrate
from eomgen.numerics.adaptive import Tolerances
from eomgen.numerics.records import Array, Grid
from eomgen.simulate_method import Choice, eigenvalues, stiff

OUTPUTS = 240  # times at which runs are compared: many divisors
THRESHOLD = 1e-3  # SI; a quantity that stays below it is compared with it
TIGHT = Tolerances(3e-13, 1e-15)
TIGHT_STIFF = Tolerances(1e-11, 1e-14)
NEARBY = Tolerances(1e-11, 1e-13)
FINER = 64.0  # steps of the second way for each radian of the fastest mode
MOST_STEPS = 4_000_000
NUDGE = 1e-8  # of the first coordinate, to see whether neighbours part
SATURATED = 0.1  # of the largest distance
PARTED = 1e3  # how far neighbours part where it is chaos
DUST = 1e-15
SAMPLED = 12


@dataclass(frozen=True)
class Motion:
    """Coordinates and rates (N, n) and outputs (N, k) over times (N,), and their sizes."""

    times: Array
    places: Array
    rates: Array
    outputs: Array
    modes: Array  # eigenvalues [1/s] at some of the times

    @property
    def scales(self) -> tuple[Array, Array]:
        """What errors are divided by: the largest value of each coordinate and rate."""
        return size_of(self.places), size_of(self.rates)


def size_of(values: Array) -> Array:
    """The largest value of each column, at least the threshold."""
    found: Array = np.max(np.abs(values), axis=0, initial=THRESHOLD)
    return found


def difference(one: Motion, other: Motion) -> float:
    """The largest relative difference of coordinates and rates."""
    places, rates = one.scales
    return float(
        max(
            np.max(np.abs(one.places - other.places) / places),
            np.max(np.abs(one.rates - other.rates) / rates),
        )
    )


def output_times(start: float, horizon: float) -> Array:
    """Equal times from the start to the end."""
    return start + horizon / OUTPUTS * np.arange(OUTPUTS + 1)


def of(variants: Sequence[Variant], horizon: float) -> tuple[Motion, Reference]:
    """The reference motion: an adaptive method, against small fixed steps elsewhere.

    Raises:
        CheckError: a way does not arrive.
    """
    first, last = variants[0], variants[-1]
    times = output_times(first.setup.start.time, horizon)
    motion, how = _adaptive(first, times)
    check, other = _fixed(last, times, motion.modes)
    about = (f"{first.name}, {how}", f"{last.name}, {other}")
    return motion, Reference(about, max(difference(motion, check), DUST))


def _adaptive(variant: Variant, times: Array) -> tuple[Motion, str]:
    choice = _chosen(variant, times[-1] - times[0], TIGHT, TIGHT_STIFF)
    return motion_of(variant, choice, times), f"{choice.method} rtol {choice.limits.rtol:g}"


def _chosen(variant: Variant, span: float, calm: Tolerances, stiffly: Tolerances) -> Choice:
    """The adaptive method for a scene, with the tolerances of one that is stiff or is not."""
    if stiff(eigenvalues(variant.setup), span).size:
        return Choice("radau", "", limits=stiffly)
    return Choice("dop853", "", limits=calm)


def motion_of(variant: Variant, choice: Choice, times: Array) -> Motion:
    """The motion of an adaptive method.

    Raises:
        CheckError: it does not arrive.
    """
    idle = replace(variant.setup, flow=None)  # no run is compared with the work of the reference
    found = list(simulate.rows(idle, choice, times))
    reached = np.concatenate([r.times for r in found])
    if len(reached) < len(times):
        raise CheckError(
            f"the reference stops at t = {reached[-1]:.6g} s: there is nothing to compare with; "
            "take a shorter --horizon"
        )
    states = np.concatenate([r.states for r in found])
    return _motion(variant, reached, states, _modes(variant, reached, states))


def _motion(variant: Variant, times: Array, states: Array, modes: Array) -> Motion:
    """The motion of a variant through these states."""
    places, rates = variant.places(times, states)
    return Motion(times, places, rates, variant.outputs(times, states), modes)


def _modes(variant: Variant, times: Array, states: Array) -> Array:
    """Eigenvalues at a dozen of the states: how fast a mode is changes on the way."""
    chosen = np.linspace(0, len(times) - 1, SAMPLED).astype(int)
    found = [
        eigenvalues(replace(variant.setup, start=replace(variant.setup.start, time=t, state=y)))
        for t, y in zip(times[chosen], states[chosen], strict=True)
    ]
    return np.concatenate(found)


def _fixed(variant: Variant, times: Array, modes: Array) -> tuple[Motion, str]:
    span = times[-1] - times[0]
    fastest = max(float(np.max(np.abs(modes), initial=0.0)), 20 / span)
    gap = span / OUTPUTS
    every = max(1, min(ceil(FINER * fastest * gap), MOST_STEPS // OUTPUTS))
    grid = Grid(times[0], gap / every, OUTPUTS * every, every)
    found = integrate.run(variant.setup.engine, METHODS["dopri5"], variant.setup.start.state, grid)
    if found.stopped or len(found.times) < len(times):
        raise CheckError(
            "the second way to the reference stops; take a shorter --horizon, "
            "or other --formulations"
        )
    return _motion(variant, found.times, found.states, modes), f"dopri5 h = {grid.step:.3g} s"


def trusted_horizon(variant: Variant, horizon: float, target: float) -> tuple[float, str]:
    """(horizon, words): shorter where neighbours part so fast that no comparison is worth it.

    t* = ln(target / 1e-15) / lambda, with lambda from two runs that start 1e-8 apart.
    """
    times = output_times(variant.setup.start.time, horizon)
    start = variant.setup.start
    moved = start.state.copy()
    moved[0] += NUDGE
    near = replace(variant, setup=replace(variant.setup, start=replace(start, state=moved)))
    choice = _chosen(variant, horizon, NEARBY, NEARBY)
    one, other = motion_of(variant, choice, times), motion_of(near, choice, times)
    apart = np.max(np.abs(one.places - other.places) / one.scales[0], axis=1)
    if np.max(apart) < PARTED * apart[0]:
        return horizon, ""
    place = int(np.argmax(apart >= SATURATED * np.max(apart)))  # then they only wander
    rate = log(float(apart[place] / apart[0])) / (times[place] - times[0])
    trusted = log(target / DUST) / rate
    said = f"I-CHAOS: lambda = {rate:.2g}/s; comparisons valid to {trusted:.3g} s"
    return min(horizon, trusted), said
