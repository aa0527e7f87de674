"""What is measured, and what was found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[Any]]
EPSILONS = {"float": 2.0**-23, "double": 2.0**-52}  # as <float.h> has them


@dataclass(frozen=True)
class Sampled:
    """States as the shipped code is given them, every number exact in float.

    time (N,), state (n, N), inputs (m, N); parameters (p,), the same at every state.
    """

    wanted: int
    time: Array
    state: Array
    inputs: Array
    parameters: Array

    @property
    def count(self) -> int:
        """The number N of states."""
        return len(self.time)

    def columns(self, first: int = 0, last: int | None = None) -> dict[str, list[Any]]:
        """The arguments of a program by name, an array over states for each component."""
        return {
            "time": [self.time[first:last]],
            "state": [row[first:last] for row in self.state],
            "inputs": [row[first:last] for row in self.inputs],
            "parameters": list(self.parameters),
        }


@dataclass(frozen=True)
class Spread:
    """Errors of a function in one precision over the states where it is defined.

    failed: at how many of these the code has no value.
    """

    worst: float
    median: float
    at: int  # the state of the worst
    failed: int


@dataclass(frozen=True)
class FunctionErrors:
    """The errors of a function, relative to its results, or absolute where these are zero."""

    name: str
    spreads: dict[str, Spread]  # by precision
    states: int  # at which it is defined
    absolute: bool

    @property
    def condition(self) -> float:
        """The worst error in double in units of its epsilon; below 1 nothing is lost."""
        return self.spreads["double"].worst / EPSILONS["double"]


@dataclass(frozen=True)
class StatementErrors:
    """Local errors in float of one statement: relative to its value, as far as results miss it."""

    functions: tuple[str, ...]  # that hold it
    line: int  # of the C file
    source: str  # as it stands there
    worst: float
    median: float
    at: int  # the state of the worst

    @property
    def amplification(self) -> float:
        """The worst local error in units of float's epsilon."""
        return self.worst / EPSILONS["float"]


@dataclass(frozen=True)
class Report:
    """The whole measurement."""

    sampled: Sampled
    names: tuple[str, ...]  # of the components of the state
    inputs: tuple[str, ...]
    timed: bool  # whether anything depends on the time
    engine: str  # what computed in float and double
    file: str  # of the C
    functions: tuple[FunctionErrors, ...]
    statements: tuple[StatementErrors, ...]
    condition: float | None  # of the mass matrix scaled to ones on its diagonal, the worst
    warnings: tuple[str, ...]
