"""The C that we ship behind the interface of `records.Engine`."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

import numpy as np

from eomgen.integrators.methods import Method
from eomgen.integrators.steps import Steps
from eomgen.numerics import compiled
from eomgen.numerics.records import Arguments, Array, Function, Grid, Rows, Stopped
from eomgen.render.code_context import coded
from eomgen.render.names import prefix
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment

BITS = 32


class EngineC:
    """Functions and steps of a compiled library."""

    def __init__(self, steps: Steps, given: Arguments, real: str = "double") -> None:
        """Compile, or load what was compiled before.

        Raises:
            UsageError: there is no compiler, or it fails.
        """
        templates = environment()
        files = {
            **render(coded(steps.program), TARGETS["c"], templates),
            **render(steps, TARGETS["c-steps"], templates),
            **render(steps, TARGETS["c-driver"], templates),
        }
        self.steps, self.real = steps, real
        self.library = compiled.build_cached(files, steps.program, real).library
        self.kind: Any = compiled.REALS[real]
        self.inputs = self._array(given.inputs)
        self.parameters = self._array(given.parameters)

    def _array(self, values: Sequence[float]) -> Array:
        """The numbers as the code has them; never empty, so that there is an address."""
        return np.array([*values, 0.0], self.kind)

    def symbol(self, name: str) -> Any:
        """A function of the library."""
        return self.library[f"{prefix(self.steps.name)}_{name}"]

    def function(self, name: str) -> Function:
        """A function of the program over its own buffers."""
        shape = self.steps.program.function(name).shape
        state, result = np.zeros(self.steps.size, self.kind), np.zeros(shape, self.kind)
        symbol = self.symbol(name)
        symbol.argtypes = [self.kind, *[ctypes.c_void_p] * 4]
        arrays = (state, self.inputs, self.parameters, result)
        addresses = [a.ctypes.data for a in arrays]

        def call(t: float, at: Array) -> Array:
            state[:] = at
            status = symbol(t, *addresses)
            if status:
                raise Stopped(status)
            return result.copy()

        call.buffers = arrays  # type: ignore[attr-defined]  # what the addresses point to
        return call

    def sweep(self, name: str, times: Array, states: Array) -> Array:
        """Results (N, ...) of a function at many states, NaN where it has none."""
        shape = self.steps.program.function(name).shape
        width = int(np.prod(shape))
        times, states = np.array(times, self.kind), np.ascontiguousarray(states, self.kind)
        results = np.full((len(times), *shape), np.nan, self.kind)
        answers = np.zeros(len(times), ctypes.c_int)
        run = self.run(Grid(0.0, 1.0, 0))
        symbol = self.symbol("sweep")
        symbol.restype = None
        symbol(
            self.symbol(name),
            ctypes.byref(run),
            ctypes.c_long(len(times)),
            ctypes.c_long(width),
            *(pointer(a) for a in (times, states, results, answers)),
        )
        return results.astype(float)

    def run(self, grid: Grid, work: float = 0.0) -> Any:
        """The record `run` of the driver."""
        fields = [("inputs", ctypes.c_void_p), ("p", ctypes.c_void_p), ("t0", self.kind)]
        fields += [("h", self.kind), ("every", ctypes.c_long), ("work", ctypes.c_double)]
        record = type("Run", (ctypes.Structure,), {"_fields_": fields})
        places = (self.inputs.ctypes.data, self.parameters.ctypes.data)
        return record(*places, grid.start, grid.step, grid.every, work)

    def march(self, method: Method, flow: str | None, state: Array) -> MarchC:
        """Steps of a method from a state; `flow` names the function of energy and power."""
        return MarchC(self, method, flow, state)

    def repeat(self, method: Method, state: Array, grid: Grid, times: int) -> Array:
        """Where the steps of a grid end, made `times` over from the same state: for their time."""
        run, start = self.run(grid), np.array(state, self.kind)
        end, symbol = np.zeros_like(start), self.symbol("repeat")
        symbol.restype = None
        symbol(
            self.symbol(_step(method)),
            ctypes.byref(run),
            ctypes.c_long(grid.count),
            ctypes.c_long(times),
            *(pointer(a) for a in (start, end)),
        )
        return end.astype(float)


class MarchC:
    """Steps in a loop of C."""

    def __init__(self, engine: EngineC, method: Method, flow: str | None, state: Array) -> None:
        self.engine, self.work = engine, 0.0
        self.step = engine.symbol(_step(method))
        self.flow = None if flow is None else engine.symbol(flow)
        self.state = np.array(state, engine.kind)
        self.carry = np.zeros_like(self.state)

    def advance(self, grid: Grid, first: int, count: int) -> Rows:
        """Steps first + 1 ... first + count of the grid; the work goes on from the last piece."""
        kind = self.engine.kind
        size = (first + count) // grid.every - first // grid.every
        rows, works = np.zeros((size, len(self.state)), kind), np.zeros(size)
        tally, stopped = np.zeros(2 * BITS, ctypes.c_long), np.zeros(1, ctypes.c_uint)
        run = self.engine.run(grid, self.work)
        symbol = self.engine.symbol("drive")
        symbol.restype = ctypes.c_long
        done = symbol(
            self.step,
            self.flow,
            ctypes.byref(run),
            ctypes.c_long(first),
            ctypes.c_long(count),
            *(pointer(a) for a in (self.state, self.carry, rows, works, tally, stopped)),
        )
        self.work = run.work
        full = (first + done) // grid.every - first // grid.every
        numbers = (first // grid.every + 1 + np.arange(full)) * grid.every
        found = {1 << b: (int(tally[b]), int(tally[BITS + b])) for b in range(BITS) if tally[b]}
        return Rows(
            grid.start + numbers * grid.step, rows[:full].astype(float), works[:full],
            done, int(stopped[0]), found,
        )  # fmt: skip


def _step(method: Method) -> str:
    """The name of the function of a step."""
    return f"prepared_step_{method.spelled}"


def pointer(array: Array) -> ctypes.c_void_p:
    """The address of an array."""
    return ctypes.c_void_p(array.ctypes.data)
