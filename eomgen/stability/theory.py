"""What a fixed-step method does to a linear system y' = A y: growth of a step, largest step.

Hairer, Wanner, Solving Ordinary Differential Equations II, sections IV.2 and IV.3.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen.integrators.methods import Method
from eomgen.integrators.tableaus import Rosenbrock, Tableau

Array = np.ndarray[Any, np.dtype[Any]]
Map = Callable[[Method, Array, int, Array], Array]  # brake: h du'/du of what is implicit
UNBOUNDED = np.inf
NEARLY = 1e-9  # an eigenvalue on the unit circle is not beyond it
TWICE = 1e-6  # a double eigenvalue 1, of a motion without stiffness, is known to half the digits
SCAN = 400  # steps tried for each factor of ten
DECADES = 4  # below and above 1 / |largest eigenvalue|
HALVINGS = 35
MOST = 300.0  # of an exponent


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


def _one(z: Array) -> Array:
    """A unit matrix for each of a stack."""
    return np.broadcast_to(np.eye(z.shape[-1]), z.shape).copy()


def _explicit(method: Method, z: Array, places: int, brake: Array) -> Array:
    assert isinstance(method.table, Tableau)
    one, total = _one(z), np.zeros_like(z)
    for coefficient in polynomial(method.table)[::-1]:
        total = total @ z + coefficient * one
    return total


def _semi_euler(method: Method, z: Array, places: int, brake: Array) -> Array:
    """u+ = u + h u'(q, u), q+ = q + h q'(q, u+)."""
    faster, further = _one(z), _one(z)
    faster[..., places:, :] += z[..., places:, :]
    further[..., :places, :] += z[..., :places, :]
    made: Array = further @ faster
    return made


def _semi_euler_damped(method: Method, z: Array, places: int, brake: Array) -> Array:
    """The same with (1 - brake) (u+ - u) = h u'(q, u)."""
    faster, further = _one(z), _one(z)
    faster[..., places:, :] += np.linalg.solve(_one(brake) - brake, z[..., places:, :])
    further[..., :places, :] += z[..., :places, :]
    made: Array = further @ faster
    return made


def _verlet(method: Method, z: Array, places: int, brake: Array) -> Array:
    """Half a step of q, a step of u, half a step of q."""
    faster, half = _one(z), _one(z)
    faster[..., places:, :] += z[..., places:, :]
    half[..., :places, :] += z[..., :places, :] / 2
    made: Array = half @ faster @ half
    return made


def _rosenbrock(method: Method, z: Array, places: int, brake: Array) -> Array:
    """W k1 = z y, W k2 = z (y + k1) - 2 k1, W = 1 - gamma z."""
    assert isinstance(method.table, Rosenbrock)
    one = _one(z)
    w = one - method.table.gamma * z
    first = np.linalg.solve(w, z)
    second = np.linalg.solve(w, z @ (one + first) - 2 * first)
    made: Array = one + 1.5 * first + 0.5 * second
    return made


def _midpoint(method: Method, z: Array, places: int, brake: Array) -> Array:
    one = _one(z)
    made: Array = np.linalg.solve(one - z / 2, one + z / 2)
    return made


MAPS: dict[str, Map] = {
    "explicit": _explicit,
    "semi_euler": _semi_euler,
    "semi_euler_damped": _semi_euler_damped,
    "verlet": _verlet,
    "rosenbrock": _rosenbrock,
    "midpoint": _midpoint,
}
PARTED = (
    "semi_euler",
    "semi_euler_damped",
    "verlet",
)  # these treat q and u differently: no function of A alone


def multiplied(method: Method, values: Array, steps: Array) -> Array:
    """What a step (N,) multiplies each mode (m,) by, (N, m): R(h lambda)."""
    z = np.multiply.outer(np.asarray(steps), np.asarray(values, complex))
    z = z[..., None, None]
    made: Array = MAPS[method.kind](method, z, 0, z)[..., 0, 0]
    return made


def natural(values: Array, steps: Array) -> Array:
    """What a time (N,) multiplies each mode (m,) by, (N, m): e^(h lambda)."""
    z = np.multiply.outer(np.asarray(steps), np.asarray(values, complex))
    made: Array = np.exp(np.minimum(z.real, MOST) + 1j * z.imag)
    return made


@dataclass(frozen=True)
class Linear:
    """y' = A y, whose first `places` are coordinates.

    damping: du'/du by what damps, which a method may take implicitly; None: all of it damps.
    """

    matrix: Array
    places: int
    damping: Array | None = None

    @property
    def brake(self) -> Array:
        """What of du'/du is taken implicitly."""
        own = self.matrix[self.places :, self.places :]
        return own if self.damping is None else self.damping


def growth(method: Method, motion: Linear, step: float) -> float:
    """The largest size of an eigenvalue of a step, motions left out that grow by themselves."""
    return float(_growths(method, motion, np.array([step]))[0])


def _growths(method: Method, motion: Linear, steps: Array) -> Array:
    """The growth (N,) of each of some steps (N,)."""
    matrix = motion.matrix
    if method.kind not in PARTED:
        sizes = np.abs(multiplied(method, _decaying(matrix), steps))
        return np.asarray(np.max(sizes, axis=1, initial=0.0))
    z, brake = np.multiply.outer(steps, matrix), np.multiply.outer(steps, motion.brake)
    made = MAPS[method.kind](method, z, motion.places, brake)
    found = np.abs(_left(np.linalg.eigvals(made), steps, matrix))
    return np.asarray(np.max(found, axis=1, initial=0.0))


def _left(found: Array, steps: Array, matrix: Array) -> Array:
    """Eigenvalues of steps; those nearest to the motions that grow by themselves become zero."""
    left = found.astype(complex)
    rows = np.arange(len(steps))
    for value in natural(_growing(matrix), steps).T:
        left[rows, np.argmin(np.abs(left - value[:, None]), axis=1)] = 0
    return left


def rounded(matrix: Array) -> Array:
    """Eigenvalues [1/s]; real parts that are rounding are zero."""
    values = np.linalg.eigvals(np.asarray(matrix)).astype(complex)
    size = np.max(np.abs(values), initial=0.0)
    values[np.abs(values) < 1e-7 * size] = 0  # of a motion without stiffness
    small = np.abs(values.real) < 1e-9 * size
    values[small] = 1j * values[small].imag
    return values


def fastest(matrix: Array) -> float:
    """The largest |eigenvalue| [1/s]; zero where nothing oscillates, decays or grows."""
    return float(np.max(np.abs(rounded(matrix)), initial=0.0))


def accurate_step(method: Method, value: complex, span: float, tolerance: float) -> float:
    """The step [s] with which a mode is off by `tolerance` of its size at worst within a span [s].

    A step multiplies it by R(h lambda) instead of e^(h lambda); the errors of all steps add up
    while it lasts.
    """
    lasts = min(span, 1 / -value.real) if value.real < 0 else span

    def misses(step: float) -> bool:
        share = multiplied(method, np.array([value]), np.array([step]))[0, 0]
        there = natural(np.array([value]), np.array([step]))[0, 0]
        return not abs(share - there) * lasts <= tolerance * step * abs(there)

    high = span
    while misses(high):
        high /= 2
    return bisected(misses, high, 2 * high)


def _growing(matrix: Array) -> Array:
    values = rounded(matrix)
    return values[values.real > 0]


def _decaying(matrix: Array) -> Array:
    values = rounded(matrix)
    return values[values.real <= 0]


def largest_step(method: Method, motion: Linear, weak: float = 0.0) -> float:
    """The step [s] from which a motion that should not grow does; infinite if there is none.

    Zero: it grows at every step that was tried. weak: a growth in one step that does not count.
    """
    rate = fastest(motion.matrix)
    if rate == 0:
        return UNBOUNDED
    slack = weak or (TWICE if method.kind in PARTED else NEARLY)
    start = -DECADES if method.kind == "explicit" else 1 - DECADES
    good = 0.0
    for decade in range(start, DECADES):  # mostly the first that is beyond 1 / rate is the last
        steps = np.logspace(decade, decade + 1, SCAN + 1) / rate
        beyond = np.flatnonzero(_growths(method, motion, steps) > 1 + slack)
        if beyond.size:
            first = int(beyond[0])
            below = float(steps[first - 1]) if first else good
            return below and bisected(
                lambda h: growth(method, motion, h) > 1 + slack, below, float(steps[first])
            )
        good = float(steps[-1])
    return UNBOUNDED


def bisected(fails: Callable[[float], bool], good: float, bad: float) -> float:
    """Between a step that is good and one that is bad, to ten digits."""
    for _ in range(HALVINGS):
        middle = (good + bad) / 2
        if not good < middle < bad:
            break
        good, bad = (good, middle) if fails(middle) else (middle, bad)
    return good
