"""Largest stable steps of the C that we ship, by bisection.

At a state of rest a step h is stable where no eigenvalue of the derivative of the step (central
differences) is beyond the unit circle, motions left out that grow, or drift, by themselves: that
is the limit of infinitely many small steps. In motion it is stable where a run of `RUN` steps
stays finite and its kinetic energy, in the second half, below `BLOWN` times that of a fine run.
"""

from __future__ import annotations

from collections.abc import Callable
from math import log

import numpy as np

from eomgen.integrators.methods import Method
from eomgen.numerics import integrate
from eomgen.numerics.records import STOPPED, Array, Grid, Rows
from eomgen.simulate_setup import Setup
from eomgen.stability import theory
from eomgen.stability.records import Place

RUN = 2000  # steps
BLOWN = 100.0  # times the kinetic energy
WEAK = log(BLOWN) / 2 / RUN  # growth of a step with which a run does not get so far
SLACK = 1e-6  # beyond the unit circle: below it lies the rounding of differences
DRIFT = 1e-3  # a double eigenvalue 1, of motions of constant rate, is known to half the digits
NUDGE = 1e-5
FINE = 16  # times smaller is the step of the run that is compared with
DECADES = 2  # tried above 1 / |fastest| where no limit is predicted
DOUBLINGS = 12
PRECISION = 1e-4


def largest_step(setup: Setup, method: Method, place: Place, predicted: float) -> float | None:
    """The step [s] from which the C is not stable at a place; infinite if none was found.

    None where nothing can be told: nothing oscillates, or no fine run is there to compare with.
    """
    fastest = theory.fastest(place.matrix)
    if fastest == 0:
        return None
    guess = predicted if 0 < predicted < np.inf else 1 / fastest
    with np.errstate(all="ignore"):
        fails = (
            _at_rest(setup, method, place)
            if place.at_rest
            else _moving(setup, method, place, guess)
        )
        return None if fails is None else _searched(fails, guess, 10.0**DECADES / fastest)


def _searched(fails: Callable[[float], bool], guess: float, most: float) -> float:
    """Between the largest step that is good and the first that is bad, found by factors of two."""
    good, bad = guess / 2, guess * 2
    for _ in range(DOUBLINGS):
        if not fails(good):
            break
        good, bad = good / 2, good
    else:
        return 0.0
    while not fails(bad):
        good, bad = bad, bad * 2
        if bad > most:
            return np.inf
    while bad > good * (1 + PRECISION):
        middle = (good + bad) / 2
        good, bad = (good, middle) if fails(middle) else (middle, bad)
    return good


def derivative(setup: Setup, method: Method, place: Place, step: float) -> Array:
    """The derivative (n, n) of one step of the C by the state, by central differences."""
    columns = []
    for i, value in enumerate(place.state):
        size = NUDGE * (1 + abs(value))
        ends = []
        for sign in (1, -1):
            state = place.state.copy()
            state[i] += sign * size
            made = integrate.run(setup.engine, method, state, Grid(place.time, step, 1))
            if made.stopped & STOPPED:
                return np.full((len(place.state),) * 2, np.nan)
            ends.append(made.states[-1])
        columns.append((ends[0] - ends[1]) / (2 * size))
    return np.array(columns).T


def _at_rest(setup: Setup, method: Method, place: Place) -> Callable[[float], bool]:
    def fails(step: float) -> bool:
        matrix = derivative(setup, method, place, step)
        if not np.all(np.isfinite(matrix)):
            return True
        found = _own(method, place.matrix, step, np.linalg.eigvals(matrix))
        return bool(np.max(np.abs(found), initial=0.0) > 1 + SLACK)

    return fails


def _own(method: Method, matrix: Array, step: float, found: Array) -> Array:
    """Eigenvalues of a step without drifts, and without those nearest to what grows by itself."""
    values = theory.rounded(matrix)
    growing = values[values.real > 0]
    steps = np.array([step])
    is_parted = method.kind in theory.PARTED
    gone = (
        theory.natural(growing, steps) if is_parted else theory.multiplied(method, growing, steps)
    )
    left = [v for v in found if abs(v - 1) > DRIFT]
    for value in gone[0]:
        if left:
            left.pop(int(np.argmin([abs(v - value) for v in left])))
    return np.array(left)


def _moving(
    setup: Setup, method: Method, place: Place, guess: float
) -> Callable[[float], bool] | None:
    """Whether a run fails; None where the run that it is compared with does."""
    for finer in (1, FINE, FINE**2):
        usual = _kinetic(setup, _run(setup, method, place, guess / finer, FINE))
        if usual < np.inf:
            break
    if not 0 < usual < np.inf:
        return None
    return lambda step: (
        not (_kinetic(setup, _run(setup, method, place, step, 1), RUN // 2) <= BLOWN * usual)
    )


def _run(setup: Setup, method: Method, place: Place, step: float, parts: int) -> Rows:
    """A row for each of `RUN` steps, which are made in so many parts."""
    grid = Grid(place.time, step / parts, RUN * parts, parts)
    return integrate.run(setup.engine, method, place.state, grid)


def _kinetic(setup: Setup, rows: Rows, since: int = 0) -> float:
    """The largest kinetic energy [J] from a row on; infinite where the run stops before its end."""
    if rows.stopped & STOPPED:
        return float(np.inf)
    late = slice(since, None)
    found = setup.engine.sweep("energy", rows.times[late], rows.states[late])[:, 0]
    return float(np.max(found)) if np.all(np.isfinite(found)) else float(np.inf)
