"""How well the motion is determined: condition numbers, and positions at which M is singular."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import degrees

import numpy as np

from eomgen.integrators.methods import Method
from eomgen.model import Coordinate
from eomgen.numerics.records import Array
from eomgen.simulate_setup import Setup
from eomgen.stability.places import drawn, is_angle, regions
from eomgen.stability.records import Condition, Place, Rounding

EPSILONS = {"float": float(np.finfo(np.float32).eps), "double": float(np.finfo(float).eps)}
SHARE = 0.1  # error of M^-1 f, measured on chains: cond(M) eps / 10
SEEDS = 4  # of the worst states, from where a singular one is looked for
LOOKED = 256
VANISHING = 1e-9  # smallest eigenvalue of M over its usual size
HALVINGS = 60
NEARLY = 1e-6
SIDE = 0.05  # of a region: beside a singular state, to see which coordinates matter


def of(setup: Setup, places: Sequence[Place]) -> tuple[Condition, ...]:
    """The worst condition numbers over some places: of M, and of S = J M^-1 J' of multipliers."""
    times = np.array([p.time for p in places])
    states = np.array([p.state for p in places])
    found = [("M", _inertia(setup, times, states))]
    rows = _rows(setup, times, states)
    if rows is not None:
        inner = np.array([_schur(m, j) for m, j in zip(found[0][1], rows, strict=True)])
        found.append(("J M^-1 J'", inner))
    return tuple(_worst(name, matrices, places) for name, matrices in found if matrices.size)


def _inertia(setup: Setup, times: Array, states: Array) -> Array:
    """M (N, n, n), or M + w J'J where that stands for it; nothing above the largest M written."""
    if not setup.steps.has("mass_matrix"):
        return np.zeros((0, 0, 0))
    matrices = setup.engine.sweep("mass_matrix", times, states)
    weight, rows = float(setup.study.compiled.weight), _rows(setup, times, states)
    if weight and rows is not None:
        matrices = matrices + weight * np.swapaxes(rows, 1, 2) @ rows
    return matrices


def _rows(setup: Setup, times: Array, states: Array) -> Array | None:
    """J (N, m, n) of the multipliers."""
    if not setup.study.compiled.kept:
        return None
    return setup.engine.sweep("constraint_jacobian", times, states)


def _schur(mass: Array, rows: Array) -> Array:
    if not (np.all(np.isfinite(mass)) and np.all(np.isfinite(rows))):
        return np.full((len(rows),) * 2, np.nan)
    made: Array = rows @ np.linalg.pinv(mass, hermitian=True) @ rows.T
    return made


def _worst(name: str, matrices: Array, places: Sequence[Place]) -> Condition:
    values = [condition(m) for m in matrices]
    k = int(np.argmax(values))
    return Condition(name, values[k], places[k].name)


def condition(matrix: Array) -> float:
    """Of a symmetric matrix whose diagonal is made 1 by units: no choice of units makes it better.

    Infinite where it is not positive definite. Higham, Accuracy and Stability of Numerical
    Algorithms, theorem 7.5 (van der Sluis).
    """
    diagonal = np.diag(matrix)
    if not np.all(np.isfinite(matrix)) or not np.all(diagonal > 0):
        return float("inf")
    values = np.linalg.eigvalsh(matrix / np.sqrt(np.outer(diagonal, diagonal)))
    return float(values[-1] / values[0]) if values[0] > 0 else float("inf")


def rounding(
    found: Sequence[Condition], methods: Sequence[Method], rate: float
) -> tuple[Rounding, ...]:
    """What float and double cost; `rate`: of the fastest mode that is to be resolved [1/s].

    Truncation h^p meets rounding eps / h, in units of 1/rate, at h = eps^(1/(p+1)).
    """
    worst = max((c.value for c in found), default=1.0)
    return tuple(
        Rounding(
            real,
            SHARE * worst * eps,
            {m.name: float(eps ** (1 / (m.order + 1)) / rate) for m in methods} if rate else {},
        )
        for real, eps in EPSILONS.items()
    )


def singular_mass(setup: Setup) -> str:
    """A warning where M is singular inside the regions of a free scene; empty if none was found.

    Searched from the worst of random states by shrinking steps along the coordinates.
    """
    areas = regions(setup.study.model, setup.start)
    if setup.study.links is not None or not areas or not setup.steps.has("mass_matrix"):
        return ""
    states = np.array(list(drawn(setup, areas, LOOKED)))
    matrices = _inertia(setup, np.full(len(states), setup.start.time), states)
    sizes = np.nanmax(np.diagonal(matrices, axis1=1, axis2=2), axis=0)

    def smallest(many: Array) -> Array:
        found = _inertia(setup, np.full(len(many), setup.start.time), many)
        scaled = found / np.sqrt(np.outer(sizes, sizes))
        values = [np.linalg.eigvalsh(m)[0] if np.all(np.isfinite(m)) else 0.0 for m in scaled]
        return np.array(values)

    if not np.all(sizes > 0):
        return ""
    order = np.argsort(smallest(states))[:SEEDS]
    index = {c.name: i for i, c in enumerate(setup.steps.program.coordinates)}
    box = [(index[c.name], low, high) for c, low, high in areas]
    for state in states[order]:
        found, value = _descended(smallest, state, box)
        if value < VANISHING:
            moved = [_moved(found, i, SIDE * (high - low), (low, high)) for i, low, high in box]
            pairs = zip(areas, box, smallest(np.array(moved)), strict=True)
            return _said([(a[0], found[b[0]]) for a, b, beside in pairs if beside > VANISHING])
    return ""


def _descended(
    smallest: Callable[[Array], Array], state: Array, box: Sequence[tuple[int, float, float]]
) -> tuple[Array, float]:
    """The state nearest below with the smallest value: steps along each coordinate, halved."""
    value = float(smallest(state[None])[0])
    size = 0.25
    for _ in range(HALVINGS):
        trials = np.array([
            _moved(state, i, sign * size * (high - low), (low, high))
            for i, low, high in box
            for sign in (1, -1)
        ])  # fmt: skip
        values = smallest(trials)
        best = int(np.argmin(values))
        if values[best] < value:
            state, value = trials[best], float(values[best])
        else:
            size /= 2
    return state, value


def _moved(state: Array, index: int, change: float, ends: tuple[float, float]) -> Array:
    moved = state.copy()
    moved[index] = min(max(moved[index] + change, ends[0]), ends[1])
    return moved


def _said(involved: Sequence[tuple[Coordinate, float]]) -> str:
    parts = []
    for c, value in involved:
        value = 0.0 if abs(value) < NEARLY else value
        parts.append(
            f"{c.name} = {degrees(value):.4g} deg" if is_angle(c) else f"{c.name} = {value:.4g}"
        )
    return (
        f"W-MASS: M is singular near {', '.join(parts)}: these coordinates lose a motion there; "
        "declare a `range` that stays away, or choose other coordinates"
    )
