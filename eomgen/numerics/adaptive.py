"""Runs with a step that follows the error: SciPy and SUNDIALS over the functions that we ship."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from eomgen.errors import CheckError, UsageError
from eomgen.numerics.records import UNPROJECTED, Array, Engine, Function, Rows, Stopped

SCIPY = {"dop853": "DOP853", "lsoda": "LSODA", "radau": "Radau"}
SUNDIALS = "cvode"
NAMES = (*SCIPY, SUNDIALS)
HALVINGS, AGREED = 6, 1e-9  # of a step whose work is integrated
ROUNDING = float(np.finfo(float).eps)
IMPLICIT = ("lsoda", "radau")
Project = Callable[[float, Array], tuple[Array, int]]
Dense = Callable[[float], Array]


@dataclass(frozen=True)
class Problem:
    """y' = f(t, y), where y goes after every step, and what works on it."""

    slope: Function
    jacobian: Function | None = None
    project: Project | None = None
    flow: Function | None = None  # energy and power


@dataclass(frozen=True)
class Tolerances:
    """The error of a step is held below atol + rtol |y|; steps are at most `largest` [s]."""

    rtol: float
    atol: float
    largest: float = float("inf")


def problem(engine: Engine, project: Project | None, flow: str | None) -> Problem:
    """The scene of an engine."""
    return Problem(
        engine.function("state_derivative"),
        engine.function("state_jacobian"),
        project,
        None if flow is None else engine.function(flow),
    )


class Stepper:
    """SciPy's solver of one method, step by step, with the state projected after each."""

    def __init__(
        self, name: str, given: Problem, span: tuple[float, float], state: Array, limits: Tolerances
    ) -> None:
        """Start at span[0].

        Raises:
            UsageError: SciPy is not installed.
        """
        self.given, self.bits = given, 0
        more = {"jac": given.jacobian} if name in IMPLICIT and given.jacobian else {}
        self.slope = given.slope if name in IMPLICIT else self._patient
        self.solver: Any = getattr(scipy_integrate(name), SCIPY[name])(
            self.slope, span[0], np.array(state, float), span[1],
            rtol=limits.rtol, atol=limits.atol, max_step=limits.largest, **more,
        )  # fmt: skip

    def _patient(self, t: float, state: Array) -> Array:
        """NaN where a trial has no value: an explicit method then takes a smaller step."""
        try:
            return self.given.slope(t, state)
        except Stopped as stopped:
            self.bits = stopped.bits
            return np.full(len(state), np.nan)

    def advance(self) -> tuple[float, float, Dense, int]:
        """One step: from, to, the state in between, and the bits of the projection.

        Raises:
            Stopped: the equations have no value there.
            CheckError: the step would be smaller than the distance of two numbers.
        """
        with np.errstate(invalid="ignore", over="ignore"):
            message = self.solver.step()
        if self.solver.status == "failed":
            if self.bits:
                raise Stopped(self.bits)
            raise CheckError(f"at t = {self.solver.t:.9g} s the solver gives up: {message}")
        dense: Dense = self.solver.dense_output()
        return self.solver.t_old, self.solver.t, dense, self._project()

    def _project(self) -> int:
        if self.given.project is None:
            return 0
        state, bits = self.given.project(self.solver.t, self.solver.y)
        self.solver.y = state
        self.solver.f = self.slope(self.solver.t, state)
        return bits

    @property
    def is_finished(self) -> bool:
        """Whether the end is reached."""
        return bool(self.solver.status != "running")


def scipy_integrate(name: str) -> Any:
    """The module `scipy.integrate`.

    Raises:
        UsageError: it is not installed.
    """
    try:
        return import_module("scipy.integrate")
    except ImportError as error:
        raise UsageError(
            f"the method {name} needs SciPy: pip install 'eomgen[simulate]', or take a fixed step, "
            "such as --method rk4 --step 0.001"
        ) from error


# abscissae and weights of Gauss and Legendre on [-1, 1]: exact to degree 7
NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)


def work_of(flow: Function | None, start: float, end: float, dense: Dense) -> float:
    """The integral of the power from start to end.

    Halved until both halves agree with the whole: forces may change faster than the motion does.
    """
    if flow is None or end <= start:
        return 0.0
    return _halved(flow, dense, (start, end), _gauss(flow, dense, start, end), HALVINGS)


def _halved(
    flow: Function, dense: Dense, span: tuple[float, float], whole: tuple[float, float], left: int
) -> float:
    """The integral over a span; whole: it by one rule, and how far halves may be off it."""
    middle = (span[0] + span[1]) / 2
    halves = ((span[0], middle), (middle, span[1]))
    found = [_gauss(flow, dense, *half) for half in halves]
    total, near = found[0][0] + found[1][0], found[0][1] + found[1][1]
    if not abs(total - whole[0]) > near or left == 0:
        return total
    pairs = zip(halves, found, strict=True)
    return sum(_halved(flow, dense, half, one, left - 1) for half, one in pairs)


def _gauss(flow: Function, dense: Dense, start: float, end: float) -> tuple[float, float]:
    """The integral of the power by one rule, and how near to it is near enough.

    Power that is zero but for rounding agrees with nothing: the energy's own rounding bounds it.
    """
    half, middle = (end - start) / 2, (end + start) / 2
    energies, powers = np.array([flow(t, dense(t)) for t in middle + half * NODES]).T
    near = AGREED * half * np.dot(WEIGHTS, np.abs(powers)) + ROUNDING * np.max(np.abs(energies))
    return float(half * np.dot(WEIGHTS, powers)), float(near)


def pieces(
    name: str, given: Problem, outputs: Array, state: Array, limits: Tolerances
) -> Iterator[Rows]:
    """The rows at outputs[1:], as they come; the run starts at outputs[0]."""
    if name == SUNDIALS:
        yield from _sundials(given, outputs, state, limits)
        return
    stepper = Stepper(name, given, (outputs[0], outputs[-1]), state, limits)
    done, work, steps = 1, 0.0, 0
    while not stepper.is_finished:
        try:
            start, end, dense, bits = stepper.advance()
            until = int(np.searchsorted(outputs, end, side="right"))
            times, steps = outputs[done:until], steps + 1
            states = table([_placed(given, t, dense(t)) for t in times], len(state))
            works = [work + work_of(given.flow, start, t, dense) for t in times]
            work += work_of(given.flow, start, end, dense)
        except Stopped as stopped:
            none = np.zeros(0)
            yield Rows(none, table([], len(state)), none, stopped=stopped.bits)
            return
        tally = {UNPROJECTED: (1, steps)} if bits & UNPROJECTED else {}
        yield Rows(times, states, np.array(works), 1, 0, tally)
        done = until


def table(states: list[Array], size: int) -> Array:
    """States as rows; none make a table of `size` columns."""
    return np.array(states).reshape(len(states), size)


def _placed(given: Problem, t: float, state: Array) -> Array:
    return state if given.project is None else given.project(t, state)[0]


def _sundials(given: Problem, outputs: Array, state: Array, limits: Tolerances) -> Iterator[Rows]:
    """CVODE from output to output, the work as one more unknown."""
    solver = _cvode(given, limits)
    solver.init_step(outputs[0], np.array([*state, 0.0]))
    for t in outputs[1:]:
        found = solver.step(t, tstop=outputs[-1])
        if not found.success:
            raise CheckError(f"at t = {found.t:.9g} s CVODE gives up: {found.message}")
        y = np.array(found.y)
        yield Rows(np.array([t]), y[None, :-1], y[-1:], 1)


def _cvode(given: Problem, limits: Tolerances) -> Any:
    try:
        module = import_module("sksundae.cvode")
    except ImportError as error:
        raise UsageError(
            "the method cvode needs scikit-sundae: pip install 'eomgen[sundials]'"
        ) from error

    def slope(t: float, y: Array, result: Array) -> None:
        result[:-1] = given.slope(t, y[:-1])
        result[-1] = 0.0 if given.flow is None else given.flow(t, y[:-1])[1]

    options: dict[str, Any] = {"max_num_steps": 1_000_000}
    if np.isfinite(limits.largest):
        options["max_step"] = limits.largest
    return module.CVODE(slope, rtol=limits.rtol, atol=limits.atol, **options)
