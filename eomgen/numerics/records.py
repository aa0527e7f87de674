"""What a run is given and what it returns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from eomgen.integrators.methods import Method

Array = np.ndarray[Any, np.dtype[Any]]
Function = Callable[[float, Array], Array]  # (time, state) -> results, a new array

# bits of what a step answers, as in every generated header
SINGULAR, NOT_FINITE, NEWTON, UNPROJECTED, RESIDUAL = 0x1, 0x100, 0x200, 0x400, 0x800
STOPPED = 0x1FF
WORDS = {
    SINGULAR: "the mass matrix is singular, or the constraints lose rank",
    NOT_FINITE: "the state is no longer finite",
    NEWTON: "the iterations of the implicit method left a residual; take a smaller step",
    UNPROJECTED: "the constraints nearly lose rank: positions were not projected",
    RESIDUAL: "the constraints are off by more than the tolerance after the projection",
}


@dataclass(frozen=True)
class Arguments:
    """Inputs and parameters, in the order of the program."""

    inputs: tuple[float, ...] = ()
    parameters: tuple[float, ...] = ()


@dataclass(frozen=True)
class Grid:
    """Steps of size `step` from `start`, `count` of them, and a row after `every` of them."""

    start: float
    step: float
    count: int
    every: int = 1


@dataclass(frozen=True)
class Event:
    """What happened to a contact at a time [s], in words."""

    time: float
    contact: str
    what: str


@dataclass(frozen=True)
class Rows:
    """Times (N,), states (N, n), the work (N,) [J] done by what has no potential, impacts included.

    tally: bit -> (steps that answered it, the first of them); stopped: the bits of a step that
    could not be made, 0 if all were; steps: how many were.
    """

    times: Array
    states: Array
    works: Array
    steps: int = 0
    stopped: int = 0
    tally: Mapping[int, tuple[int, int]] = field(default_factory=dict)
    events: tuple[Event, ...] = ()
    lost: float = 0.0  # energy that impacts took [J]
    mode: str = ""  # of the contacts, where there are any


class Stopped(Exception):
    """A function of the program has no value at this state."""

    def __init__(self, bits: int) -> None:
        super().__init__(words(bits))
        self.bits = bits


def words(bits: int) -> str:
    """The meaning of status bits."""
    return "; ".join(text for bit, text in WORDS.items() if bits & bit) or f"status {bits:#x}"


class March(Protocol):
    """Steps from a state that it keeps, piece by piece."""

    def advance(self, grid: Grid, first: int, count: int) -> Rows:
        """Steps first + 1 ... first + count of the grid; the work goes on from the last piece."""


class Engine(Protocol):
    """The generated code, loaded, with its inputs and parameters."""

    real: str

    def function(self, name: str) -> Function:
        """A function of the program; it raises `Stopped`."""

    def sweep(self, name: str, times: Array, states: Array) -> Array:
        """Results (N, ...) of a function at many states, NaN where it has none."""

    def march(self, method: Method, flow: str | None, state: Array) -> March:
        """Steps of a method from a state; `flow` names the function of energy and power."""

    def repeat(self, method: Method, state: Array, grid: Grid, times: int) -> Array:
        """Where the steps of a grid end, made `times` over from the same state: for their time."""
