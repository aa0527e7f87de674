"""Motions without inertia that the constraints forbid: a massless link is no defect of a scene.

M u' + h = Q + J' lambda with J u' + gamma = 0 has one solution where M is positive on J u = 0, that
is where M + w J'J is positive for some w > 0 (Benzi, Golub and Liesen, Numerical solution of saddle
point problems, Acta Numerica 2005).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from math import log10

import numpy as np
import numpy.typing as npt

from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.analysis.admissible import Admissible
from eomgen.compile import Machine

Floats = npt.NDArray[np.float64]
SINGULAR = 1e-12  # least over largest eigenvalue of M with a unit diagonal


def regular(machine: Machine, states: Sequence[Admissible]) -> Machine:
    """The machine, with a weight where M is singular at every state and M + w J'J is at none.

    A machine whose M + w J'J is singular too is left as it is: it is refused later, by name.
    """
    found = [matrices(machine, state) for state in states]
    if not all(_is_singular(mass) for mass, _ in found):
        return machine
    weight = _weight(*found[0])
    if any(_is_singular(mass + float(weight) * (j.T @ j)) for mass, j in found):
        return machine
    return replace(machine, weight=weight)


def matrices(machine: Machine, state: Admissible) -> tuple[Floats, Floats]:
    """M and J of the independent rows at a state; neither depends on the speeds."""
    at = {
        "time": [float(state.state.time)],
        "state": [*(float(v) for v in state.state.coordinates), *[0.0] * len(machine.speeds)],
        "parameters": [float(v) for v in state.state.parameters],
    }
    leaves = {
        leaf: at[leaf.datum.argument][leaf.datum.index]
        for leaf in machine.leaves
        if leaf.datum.argument in at
    }
    mass = [evaluate(row, leaves, FLOAT) for row in machine.equations.mass_matrix]
    slopes = [evaluate(row.jacobian, leaves, FLOAT) for row in machine.independent_rows]
    return np.array(mass), np.array(slopes).reshape(len(slopes), len(mass))


def _is_singular(matrix: Floats) -> bool:
    """Whether a motion has no inertia, each coordinate counted in its own unit."""
    scale = np.sqrt(np.diag(matrix).clip(min=0.0))
    if not np.all(scale > 0):
        return True
    least = np.linalg.eigvalsh(matrix / np.outer(scale, scale))[0]
    return bool(least <= SINGULAR)


def _weight(mass: Floats, slopes: Floats) -> Fraction:
    """A power of ten that gives J'J the size of M."""
    sizes = np.max(np.abs(mass)) / np.max(np.abs(slopes.T @ slopes))
    return Fraction(10) ** round(log10(sizes))
