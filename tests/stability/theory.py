"""What a fixed-step method does to a linear system y' = A y: growth of a step, largest step.

Hairer, Wanner, Solving Ordinary Differential Equations II, sections IV.2 and IV.3.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from eomgen.integrators.methods import Method
from eomgen.integrators.tableaus import Rosenbrock, Tableau

Array = np.ndarray[Any, np.dtype[Any]]
Map = Callable[[Method, Array, int], Array]
UNBOUNDED = np.inf
NEARLY = 1e-9  # an eigenvalue on the unit circle is not beyond it
TWICE = 1e-6  # a double eigenvalue 1, of a motion without stiffness, is known to half the digits
SCAN = 400  # steps tried for each factor of ten
DECADES = 4  # below and above 1 / |largest eigenvalue|
HALVINGS = 60


def polynomial(table: Tableau) -> Array:
    """Coefficients of R(z) = 1 + z b'1 + z^2 b'A1 + ..., the lowest first."""
    stages = len(table.b)
    a = np.zeros((stages, stages))
    for i, row in enumerate(table.a):
        a[i, :i] = [float(v) for v in row]
    powers, column = [1.0], np.ones(stages)
    for _ in range(stages):
        powers.append(float(np.dot([float(v) for v in table.b], column)))
        column = a @ column
    return np.array(powers)


def _explicit(method: Method, z: Array, places: int) -> Array:
    assert isinstance(method.table, Tableau)
    one, total = np.eye(len(z)), np.zeros_like(z)
    for coefficient in polynomial(method.table)[::-1]:
        total = total @ z + coefficient * one
    return total


def _semi_euler(method: Method, z: Array, places: int) -> Array:
    """u+ = u + h u'(q, u), q+ = q + h q'(q, u+)."""
    one = np.eye(len(z))
    faster, further = one.copy(), one.copy()
    faster[places:] += z[places:]
    further[:places] += z[:places]
    made: Array = further @ faster
    return made


def _verlet(method: Method, z: Array, places: int) -> Array:
    """Half a step of q, a step of u, half a step of q."""
    one = np.eye(len(z))
    faster, half = one.copy(), one.copy()
    faster[places:] += z[places:]
    half[:places] += z[:places] / 2
    made: Array = half @ faster @ half
    return made


def _rosenbrock(method: Method, z: Array, places: int) -> Array:
    """W k1 = z y, W k2 = z (y + k1) - 2 k1, W = 1 - gamma z."""
    assert isinstance(method.table, Rosenbrock)
    one = np.eye(len(z))
    w = one - method.table.gamma * z
    first = np.linalg.solve(w, z)
    second = np.linalg.solve(w, z @ (one + first) - 2 * first)
    made: Array = one + 1.5 * first + 0.5 * second
    return made


def _midpoint(method: Method, z: Array, places: int) -> Array:
    one = np.eye(len(z))
    made: Array = np.linalg.solve(one - z / 2, one + z / 2)
    return made


MAPS: dict[str, Map] = {
    "explicit": _explicit,
    "semi_euler": _semi_euler,
    "verlet": _verlet,
    "rosenbrock": _rosenbrock,
    "midpoint": _midpoint,
}
PARTED = ("semi_euler", "verlet")  # these treat q and u differently: no function of A alone


def amplification(method: Method, matrix: Array, places: int, step: float) -> Array:
    """The map of one step (n, n) of y' = A y; the first `places` of y are coordinates."""
    return MAPS[method.kind](method, step * np.asarray(matrix), places)


def growth(method: Method, matrix: Array, places: int, step: float) -> float:
    """The largest size of an eigenvalue of a step, motions left out that grow by themselves."""
    if method.kind in PARTED:
        found = np.linalg.eigvals(amplification(method, matrix, places, step))
        found = _without(found, np.exp(step * _growing(matrix)))
        return float(np.max(np.abs(found), initial=0.0))
    values = [amplification(method, np.array([[z]]), 0, step)[0, 0] for z in _decaying(matrix)]
    return float(np.max(np.abs(values), initial=0.0))


def _rounded(matrix: Array) -> Array:
    """Eigenvalues [1/s]; real parts that are rounding are zero."""
    values = np.linalg.eigvals(np.asarray(matrix)).astype(complex)
    size = np.max(np.abs(values), initial=0.0)
    values[np.abs(values) < 1e-7 * size] = 0  # of a motion without stiffness
    small = np.abs(values.real) < 1e-9 * size
    values[small] = 1j * values[small].imag
    return values


def _growing(matrix: Array) -> Array:
    values = _rounded(matrix)
    return values[values.real > 0]


def _decaying(matrix: Array) -> Array:
    values = _rounded(matrix)
    return values[values.real <= 0]


def _without(found: Array, unstable: Array) -> Array:
    """Without the nearest to each of some values."""
    left = list(found)
    for value in unstable:
        if left:
            left.pop(int(np.argmin([abs(v - value) for v in left])))
    return np.array(left)


def largest_step(method: Method, matrix: Array, places: int) -> float:
    """The step [s] from which a motion that should not grow does; infinite if there is none.

    Zero: it grows at every step that was tried.
    """
    fastest = float(np.max(np.abs(_rounded(matrix)), initial=0.0))
    if fastest == 0:
        return UNBOUNDED
    slack = TWICE if method.kind in PARTED else NEARLY

    def grows(step: float) -> bool:
        return growth(method, matrix, places, step) > 1 + slack

    steps = np.logspace(-DECADES, DECADES, 2 * DECADES * SCAN + 1) / fastest
    steps = steps[SCAN:] if method.kind != "explicit" else steps
    first = next((i for i, step in enumerate(steps) if grows(step)), None)
    if first is None:
        return UNBOUNDED
    return 0.0 if first == 0 else bisected(grows, float(steps[first - 1]), float(steps[first]))


def bisected(fails: Callable[[float], bool], good: float, bad: float) -> float:
    """Between a step that is good and one that is bad, to the last digit or `HALVINGS`."""
    for _ in range(HALVINGS):
        middle = (good + bad) / 2
        if not good < middle < bad:
            break
        good, bad = (good, middle) if fails(middle) else (middle, bad)
    return good
