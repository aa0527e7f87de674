"""Errors of functions against fifty digits."""

from __future__ import annotations

import numpy as np

from eomgen.algebra import decimals
from eomgen.algebra.arithmetic import Arithmetic
from eomgen.precision.engines import Measured
from eomgen.precision.exact import Exact
from eomgen.precision.records import Array, FunctionErrors, Spread

VANISHING = frozenset(("constraint_residuals", "constraint_rates"))  # zero on the constraints
NOTHING = 1e-30  # below this share of the others a result is zero but for fifty digits


def of_function(
    name: str, exact: Exact, engines: dict[str, Measured], arithmetic: Arithmetic
) -> FunctionErrors:
    """The errors of a function in every precision.

    The error of a result is relative to its size at the state or its median size over all states,
    whichever is larger: a result that passes zero has lost nothing by that.
    """
    truth = exact.results.astype(float)
    defined = np.isfinite(truth).all(axis=0)
    absolute = name in VANISHING
    scale = np.ones_like(truth) if absolute else _scales(truth, defined)
    spreads = {}
    for kind, measured in engines.items():
        found = measured(name)
        errors = np.max(_gaps(exact.results, found, arithmetic) / scale, axis=0, initial=0.0)
        spreads[kind] = _spread(errors, defined)
    return FunctionErrors(name, spreads, int(defined.sum()), absolute)


def _gaps(truth: Array, found: Array, arithmetic: Arithmetic) -> Array:
    """|found - truth|, the difference taken in all digits."""
    with arithmetic.quiet():
        gaps: Array = np.abs(np.frompyfunc(decimals.Decimal, 1, 1)(found) - truth).astype(float)
    return gaps


def _scales(truth: Array, defined: Array) -> Array:
    """What each result is compared with at each state."""
    sizes = np.where(defined, np.abs(truth), 0.0)
    scales: Array = np.maximum(sizes, _medians(sizes, defined)[:, None])
    largest = scales.max(axis=0, initial=0.0)
    scales = np.where(scales > NOTHING * largest, scales, largest)
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
