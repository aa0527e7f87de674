"""The shipped code in fifty digits: every value that it computes, at every state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen import interpreter
from eomgen.algebra import decimals
from eomgen.algebra.arithmetic import Arithmetic
from eomgen.algebra.unroll import unrolled
from eomgen.errors import CheckError
from eomgen.precision.records import Array, Sampled
from eomgen.program import Function, Program
from eomgen.render.lowered import lower

DIGITS = 50
BLOCK = 100  # states at a time, for the memory
PROVEN = 20  # states at which the shipped code is compared with what was derived
SMALL = 1e-12  # SI; a result below is compared with this: it may be a zero of fifty digits
SAME = 1e-30  # relative; fifty digits less what the worst condition takes


@dataclass(frozen=True)
class Exact:
    """A function in fifty digits.

    function: as C has it, powers as products; values: by name, (N,) in double;
    results: (number of results, N), decimals; constants: what `prepare` made, in double.
    """

    function: Function
    values: Mapping[str, Array]
    results: Array
    constants: tuple[float, ...]


def plain(function: Function) -> Function:
    """A function as C computes it, with loops over lanes written out."""
    return lower(unrolled(function))


class Bench:
    """A program, its states, and what `prepare` makes of the parameters."""

    def __init__(self, shipped: Program, sampled: Sampled) -> None:
        """In `DIGITS` digits."""
        self.shipped, self.sampled = shipped, sampled
        self.arithmetic: Arithmetic = decimals.arithmetic(DIGITS)
        self.prepared: list[Any] = []
        with self.arithmetic.quiet():
            if shipped.prepare is not None:
                given = {"parameters": sampled.columns()["parameters"]}
                self.prepared = interpreter.run(shipped.prepare, given, self.arithmetic)

    def prepare(self) -> Exact | None:
        """The preparation itself, at one state."""
        if self.shipped.prepare is None:
            return None
        return self._traced(plain(self.shipped.prepare), [(0, 1)])

    def traced(self, function: Function) -> Exact:
        """Every value of a function."""
        starts = range(0, self.sampled.count, BLOCK)
        return self._traced(plain(function), [(i, i + BLOCK) for i in starts])

    def _traced(self, function: Function, blocks: list[tuple[int, int]]) -> Exact:
        values: dict[str, list[Array]] = {}
        results = []
        for first, last in blocks:
            memory, found = self.run(function, first, last)
            count = len(self.sampled.time[first:last])
            results.append(np.empty((len(found), count), object))
            for row, value in zip(results[-1], found, strict=True):
                row[:] = value
            for name, value in memory.items():
                values.setdefault(name, []).append(_spread(value, count))
        return Exact(
            function,
            {name: np.concatenate(parts) for name, parts in values.items()},
            np.concatenate(results, axis=1),
            tuple(float(c) for c in self.prepared),
        )

    def run(self, function: Function, first: int, last: int) -> tuple[dict[str, Any], list[Any]]:
        """(values by name, results) at some states."""
        columns = self.sampled.columns(first, last)
        given = {name: [decimals.exactly(v) for v in rows] for name, rows in columns.items()}
        with self.arithmetic.quiet():
            memory = interpreter.Memory({**given, "constants": self.prepared}, self.arithmetic)
            for statement in function.statements:
                memory.execute(statement)
            return memory.values, [memory.value(result) for result in function.results]

    def prove(self, derived: Program) -> None:
        """Compare the shipped program with the one that was derived and checked.

        Raises:
            CheckError: they differ in fifty digits.
        """
        for function in derived.functions:
            _, source = self.run(function, 0, PROVEN)
            _, made = self.run(plain(self.shipped.function(function.name)), 0, PROVEN)
            with self.arithmetic.quiet():
                error = _difference(source, made)
            if error > SAME:
                raise CheckError(
                    f"{function.name} as it is written and as it was derived differ, relative "
                    f"error {error:.1e}: this is a defect of eomgen"
                )


def _spread(value: Any, count: int) -> Array:
    found: Array = np.broadcast_to(np.asarray(value, float), (count,))
    return found


def _difference(source: list[Any], made: list[Any]) -> float:
    """The worst difference of results, relative to the largest at each state."""
    if not source:
        return 0.0
    pairs = zip(source, made, strict=True)
    gaps = [np.asarray(abs(a - b), float) for a, b in pairs]
    sizes = [np.asarray(abs(a), float) for a in source]
    gap, size = (np.max(np.broadcast_arrays(*rows), axis=0) for rows in (gaps, sizes))
    relative = gap / np.maximum(size, SMALL)
    return float(np.max(relative[np.isfinite(relative)], initial=0.0))
