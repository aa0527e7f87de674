"""The Python module that we ship behind the interface of `records.Engine`: no compiler needed."""

from __future__ import annotations

import numpy as np

from eomgen.integrators.methods import Method
from eomgen.integrators.steps import Steps
from eomgen.numerics import steps_python
from eomgen.numerics.compiled import load_python
from eomgen.numerics.records import (
    NOT_FINITE,
    SINGULAR,
    STOPPED,
    Arguments,
    Array,
    Function,
    Grid,
    Rows,
    Stopped,
)
from eomgen.render.code_context import coded
from eomgen.render.names import module
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment


class EnginePython:
    """Functions of a generated module, and steps in Python."""

    real = "double"

    def __init__(self, steps: Steps, given: Arguments) -> None:
        (text,) = render(coded(steps.program), TARGETS["python"], environment()).values()
        self.module = load_python(text, module(steps.name))
        self.steps, self.inputs = steps, given.inputs
        names = [p.name for p in steps.program.parameters]
        parameters = dict(zip(names, given.parameters, strict=True))
        self.model = self.module.prepare(parameters)

    def function(self, name: str) -> Function:
        """A function of the program; it raises `Stopped` where the mass matrix is singular."""
        function = getattr(self.module, name)

        def call(t: float, state: Array) -> Array:
            try:
                with np.errstate(all="ignore"):
                    found: Array = function(t, state, self.inputs, self.model)
            except np.linalg.LinAlgError as error:
                raise Stopped(SINGULAR) from error
            return found

        return call

    def sweep(self, name: str, times: Array, states: Array) -> Array:
        """Results (N, ...) of a function at many states, NaN where it has none."""
        call, shape = self.function(name), self.steps.program.function(name).shape
        results = np.full((len(times), *shape), np.nan)
        for k, (t, state) in enumerate(zip(times, states, strict=True)):
            try:
                results[k] = call(t, state)
            except Stopped:
                continue
        return results

    def march(self, method: Method, flow: str | None, state: Array) -> MarchPython:
        """Steps of a method from a state; `flow` names the function of energy and power."""
        return MarchPython(self, method, flow, state)

    def repeat(self, method: Method, state: Array, grid: Grid, times: int) -> Array:
        """Where the steps of a grid end, made `times` over from the same state: for their time."""
        for _ in range(times):
            march = MarchPython(self, method, None, state)
            march.advance(grid, 0, grid.count)
        return march.state


class MarchPython:
    """Steps in a loop of Python."""

    def __init__(
        self, engine: EnginePython, method: Method, flow: str | None, state: Array
    ) -> None:
        self.step = steps_python.step(engine.steps, method, engine.function)
        self.slope = engine.function("state_derivative")
        self.flow = None if flow is None else engine.function(flow)
        self.state, self.work = np.array(state, float), 0.0

    def advance(self, grid: Grid, first: int, count: int) -> Rows:
        """Steps first + 1 ... first + count of the grid; the work goes on from the last piece."""
        rows: list[tuple[float, Array, float]] = []
        tally: dict[int, tuple[int, int]] = {}
        for k in range(first, first + count):
            bits = self._made(grid.start + k * grid.step, grid.step)
            if bits & STOPPED:
                return _rows(rows, len(self.state), (k - first, bits, tally))
            for b in (1 << i for i in range(bits.bit_length()) if bits >> i & 1):
                seen, since = tally.get(b, (0, k + 1))
                tally[b] = (seen + 1, since)
            if (k + 1) % grid.every == 0:
                rows.append((grid.start + (k + 1) * grid.step, self.state, self.work))
        return _rows(rows, len(self.state), (count, 0, tally))

    def _made(self, t: float, h: float) -> int:
        """The bits of one step, which the state and the work have taken."""
        try:
            state, bits = self.step(t, h, self.state)
            if not np.all(np.isfinite(state)):
                return NOT_FINITE
            work = self.work + self._work(t, h, self.state, state)
        except Stopped as stopped:
            return stopped.bits
        self.state, self.work = state, work
        return bits

    def _work(self, t: float, h: float, before: Array, after: Array) -> float:
        """Simpson's rule, as in `templates/c/driver.c.j2`."""
        if self.flow is None:
            return 0.0
        slopes = self.slope(t, before) - self.slope(t + h, after)
        middle = (before + after) / 2 + h / 8 * slopes
        powers = (self.flow(t, before)[1], self.flow(t + h / 2, middle)[1])
        return float(h / 6 * (powers[0] + 4 * powers[1] + self.flow(t + h, after)[1]))


def _rows(
    rows: list[tuple[float, Array, float]],
    size: int,
    end: tuple[int, int, dict[int, tuple[int, int]]],
) -> Rows:
    steps, stopped, tally = end
    return Rows(
        np.array([r[0] for r in rows]),
        np.array([r[1] for r in rows]).reshape(len(rows), size),
        np.array([r[2] for r in rows]),
        steps,
        stopped,
        tally,
    )
