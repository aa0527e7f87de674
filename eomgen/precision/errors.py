"""Errors of functions against fifty digits."""

from __future__ import annotations

import numpy as np

from eomgen.algebra import decimals
from eomgen.algebra.arithmetic import Arithmetic
from eomgen.precision.engines import Measured
from eomgen.precision.exact import Exact
from eomgen.precision.records import EPSILONS, Array, FunctionErrors, Spread

VANISHING = frozenset(("constraint_residuals", "constraint_rates", "watch"))  # only signs matter
ZERO = 1e-30  # below this share of the others a result is zero but for fifty digits
ON_CONSTRAINTS = EPSILONS["float"]  # the same where links or quaternions hold but for rounding


def of_function(
    name: str, exact: Exact, engines: dict[str, Measured], arithmetic: Arithmetic, scales: Array
) -> FunctionErrors:
    """The errors of a function in every precision, relative to its `scales`."""
    defined = np.isfinite(exact.results.astype(float)).all(axis=0)
    spreads = {}
    for kind, measured in engines.items():
        gaps = _gaps(exact.results, measured(name), arithmetic)
        spreads[kind] = _spread(np.max(gaps / scales, axis=0), defined)
    return FunctionErrors(name, spreads, int(defined.sum()), name in VANISHING)


def _gaps(truth: Array, found: Array, arithmetic: Arithmetic) -> Array:
    """|found - truth|, the difference taken in all digits."""
    with arithmetic.quiet():
        gaps: Array = np.abs(decimals.exactly(found) - truth).astype(float)
    return gaps


def scales_of(name: str, results: Array, zero: float) -> Array:
    """What an error of each result is compared with at each state, (number of results, N).

    Its size at the state, or its median size over all states, whichever is larger: a result that
    passes zero has lost nothing by that. One below the share `zero` of the largest vanishes by
    itself and is compared with that one. What always vanishes has no scale: 1.
    """
    truth = results.astype(float)
    if name in VANISHING:
        return np.ones_like(truth)
    defined = np.isfinite(truth).all(axis=0)
    sizes = np.where(defined, np.abs(truth), 0.0)
    scales: Array = np.maximum(sizes, _medians(sizes, defined)[:, None])
    largest = scales.max(axis=0)
    scales = np.where(scales > zero * largest, scales, largest)
    return np.where(scales > 0, scales, 1.0)


def _medians(sizes: Array, defined: Array) -> Array:
    if not defined.any():
        return np.zeros(len(sizes))
    medians: Array = np.median(sizes[:, defined], axis=1)
    return medians


def _spread(errors: Array, defined: Array) -> Spread:
    """Worst and median where both the exact and the measured result are finite."""
    usable = np.flatnonzero(defined & np.isfinite(errors))
    failed = int(defined.sum()) - len(usable)
    if not len(usable):
        return Spread(0.0, 0.0, 0, failed)
    at = int(usable[np.argmax(errors[usable])])
    return Spread(float(errors[at]), float(np.median(errors[usable])), at, failed)
