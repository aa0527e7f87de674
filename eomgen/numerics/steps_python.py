"""The steps of `templates/c/steps.c.j2` over functions of NumPy: without a compiler, and as oracle.

Each stepper is the increment of the state over one step, before it goes back to the constraints.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from eomgen.integrators.methods import MIDPOINT_ITERATIONS, Method
from eomgen.integrators.steps import Steps
from eomgen.integrators.tableaus import Rosenbrock, Tableau
from eomgen.numerics.records import (
    NEWTON,
    NOT_FINITE,
    RESIDUAL,
    UNPROJECTED,
    Array,
    Function,
)

EULERS = ("semi_euler", "semi_euler_damped")  # their rates are a function where speeds are others
LEAST_MARGIN = 1e-4  # of the pivots: below, positions are not projected
TOLERANCE = 1e-9  # of constraints after a projection, and of Newton's last correction
Call = Callable[[str], Function]
Increment = Callable[[Method, Call, float, float, Array], tuple[Array, int]]


def step(
    steps: Steps, method: Method, call: Call
) -> Callable[[float, float, Array], tuple[Array, int]]:
    """(t, h, state) -> (next state, bits); `call` gives the functions of the program."""
    increment = INCREMENTS[_kind(steps, method)]

    def make(t: float, h: float, state: Array) -> tuple[Array, int]:
        change, bits = increment(method, call, t, h, state)
        state, more = admissible(steps, call, t + h, state + change)
        return state, bits | more

    return make


def _kind(steps: Steps, method: Method) -> str:
    """Which of `INCREMENTS` a method is for this program."""
    if method.kind == "midpoint" and steps.is_canonical:
        return "midpoint of momenta"
    is_apart = method.kind in EULERS and steps.has("rates")
    return f"{method.kind} of speeds" if is_apart else method.kind


def admissible(steps: Steps, call: Call, t: float, state: Array) -> tuple[Array, int]:
    """The state back on the constraints: one Newton step in positions, a linear solve in rates."""
    bits = 0
    size = len(steps.program.coordinates)
    if steps.projects_positions:
        guard = call("constraint_margin")(t, state)[0] if steps.has("constraint_margin") else 1.0
        if guard >= LEAST_MARGIN:
            state = np.concatenate([call("project_positions")(t, state), state[size:]])
        else:
            bits |= UNPROJECTED
    if steps.has("project_rates"):
        state = np.concatenate([state[:size], call("project_rates")(t, state)])
    if steps.residuals and not np.all(np.abs(call("constraint_residuals")(t, state)) <= TOLERANCE):
        bits |= RESIDUAL
    return state, bits if np.all(np.isfinite(state)) else NOT_FINITE


def _explicit(method: Method, call: Call, t: float, h: float, y: Array) -> tuple[Array, int]:
    assert isinstance(method.table, Tableau)
    f = call("state_derivative")
    slopes: list[Array] = []
    for row, node in zip(method.table.a, method.table.c, strict=True):
        trial = y + h * sum((float(a) * k for a, k in zip(row, slopes, strict=False)), 0 * y)
        slopes.append(f(t + float(node) * h, trial))
    return h * sum((float(b) * k for b, k in zip(method.table.b, slopes, strict=True)), 0 * y), 0


def _semi_euler(method: Method, call: Call, t: float, h: float, y: Array) -> tuple[Array, int]:
    n = len(y) // 2
    change = h * call("accelerations")(t, y)
    return np.concatenate([h * (y[n:] + change), change]), 0


def _semi_euler_speeds(
    method: Method, call: Call, t: float, h: float, y: Array
) -> tuple[Array, int]:
    return _moved(call, t, h, y, h * call("accelerations")(t, y))


def _moved(call: Call, t: float, h: float, y: Array, change: Array) -> tuple[Array, int]:
    """The coordinates go on with the rates that the changed speeds give."""
    n = len(y) - len(change)
    trial = np.concatenate([y[:n], y[n:] + change])
    return np.concatenate([h * call("rates")(t, trial), change]), 0


def _damped(call: Call, t: float, h: float, y: Array) -> Array:
    """(1 + h M^-1 D)^-1 h u'."""
    jacobian = call("damping_jacobian")(t, y)
    try:
        return np.linalg.solve(
            np.eye(len(jacobian)) - h * jacobian, h * call("accelerations")(t, y)
        )
    except np.linalg.LinAlgError:
        return np.full(len(jacobian), np.nan)


def _semi_euler_damped(
    method: Method, call: Call, t: float, h: float, y: Array
) -> tuple[Array, int]:
    change = _damped(call, t, h, y)
    return np.concatenate([h * (y[len(change) :] + change), change]), 0


def _semi_euler_damped_speeds(
    method: Method, call: Call, t: float, h: float, y: Array
) -> tuple[Array, int]:
    return _moved(call, t, h, y, _damped(call, t, h, y))


def _verlet(method: Method, call: Call, t: float, h: float, y: Array) -> tuple[Array, int]:
    n = len(y) // 2
    middle = np.concatenate([y[:n] + 0.5 * h * y[n:], y[n:]])
    change = h * call("accelerations")(t + 0.5 * h, middle)
    return np.concatenate([h * (y[n:] + 0.5 * change), change]), 0


def _solver(call: Call, t: float, scale: float, y: Array) -> Callable[[Array], Array]:
    """(1 - scale J)^-1."""
    try:
        inverse = np.linalg.inv(np.eye(len(y)) - scale * call("state_jacobian")(t, y))
    except np.linalg.LinAlgError:
        inverse = np.full((len(y),) * 2, np.nan)
    return lambda right: inverse @ right


def _rosenbrock(method: Method, call: Call, t: float, h: float, y: Array) -> tuple[Array, int]:
    assert isinstance(method.table, Rosenbrock)
    f, solve = call("state_derivative"), _solver(call, t, method.table.gamma * h, y)
    first = solve(h * f(t, y))
    second = solve(h * f(t + h, y + first) - 2 * first)
    return 1.5 * first + 0.5 * second, 0


def _midpoint(method: Method, call: Call, t: float, h: float, y: Array) -> tuple[Array, int]:
    f, solve = call("state_derivative"), _solver(call, t, 0.5 * h, y)

    def left(gain: Array) -> Array:
        return 0.5 * h * f(t + 0.5 * h, y + gain) - gain

    gain, bits = _newton(left, solve, y)
    return 2 * gain, bits


def _midpoint_momenta(
    method: Method, call: Call, t: float, h: float, y: Array
) -> tuple[Array, int]:
    n, solve = len(y) // 2, _solver(call, t, 0.5 * h, y)
    momenta, force, rates = call("momenta"), call("momentum_rates"), call("rates_of_momenta")
    start = momenta(t, y)

    def left(gain: Array) -> Array:
        middle = y + gain
        trial = np.concatenate([middle[:n], start + 0.5 * h * force(t + 0.5 * h, middle)])
        wanted = np.concatenate([0.5 * h * middle[n:], rates(t + 0.5 * h, trial) - y[n:]])
        return wanted - gain

    gain, bits = _newton(left, solve, y)
    end = np.concatenate([y[:n] + 2 * gain[:n], 2 * momenta(t + 0.5 * h, y + gain) - start])
    return np.concatenate([2 * gain[:n], rates(t + h, end) - y[n:]]), bits


def _newton(
    left: Callable[[Array], Array], solve: Callable[[Array], Array], y: Array
) -> tuple[Array, int]:
    """The gain that leaves nothing, after a fixed number of iterations."""
    gain = correction = 0 * y
    for _ in range(MIDPOINT_ITERATIONS):
        correction = solve(left(gain))
        gain = gain + correction
    last = np.max(np.abs(correction) / (1 + np.abs(y + gain)))
    return gain, 0 if last <= TOLERANCE else NEWTON


INCREMENTS: dict[str, Increment] = {
    "explicit": _explicit,
    "semi_euler": _semi_euler,
    "semi_euler of speeds": _semi_euler_speeds,
    "semi_euler_damped": _semi_euler_damped,
    "semi_euler_damped of speeds": _semi_euler_damped_speeds,
    "verlet": _verlet,
    "rosenbrock": _rosenbrock,
    "midpoint": _midpoint,
    "midpoint of momenta": _midpoint_momenta,
}
