"""Competitors on the same states: are the results equal, and what does a call cost."""

from __future__ import annotations

import ctypes
import random
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lab.build import Source, library

STATES, REPEATS, SAMPLE = 64, 25, 1e6  # SAMPLE: nanoseconds that one measurement should last
TOLERANCE = 1e-11
Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Entry:
    """A loaded function with its own arrays: states (64, nx), inputs (64, nu), results (64, n)."""

    run: Any
    states: Array
    inputs: Array
    results: Array


def loop(folder: Path) -> Any:
    """The timing loop in C."""
    text = (Path(__file__).parent / "native" / "loop.c").read_text(encoding="utf-8")
    made = library(Source({"loop.c": text}, "loop.c"), ("gcc", "-O2"), folder)
    function = ctypes.CDLL(str(made)).nanoseconds
    pointer, number = ctypes.c_void_p, ctypes.c_int
    function.argtypes = [pointer, *[pointer, number] * 3, number, number]
    function.restype = ctypes.c_double
    return function


def nanoseconds(timer: Any, entry: Entry, rounds: int) -> float:
    """One measurement: nanoseconds a state."""
    arrays = [
        argument
        for array in (entry.states, entry.inputs, entry.results)
        for argument in (array.ctypes.data, array.shape[1])
    ]
    address = ctypes.cast(entry.run, ctypes.c_void_p)
    time = timer(address, *arrays, len(entry.states), rounds)
    return float(time) * len(entry.states) / STATES


def minima(timer: Any, entries: Mapping[str, Entry], repeats: int = REPEATS) -> dict[str, float]:
    """The least time of each entry [ns a state], all of them taking turns in random order."""
    first = {name: nanoseconds(timer, entry, 4) for name, entry in entries.items()}
    rounds = {name: max(1, int(SAMPLE / (STATES * t))) for name, t in first.items()}
    best = dict.fromkeys(entries, float("inf"))
    order, shuffle = list(entries), random.Random(1)
    for _ in range(repeats):
        shuffle.shuffle(order)
        for name in order:
            best[name] = min(best[name], nanoseconds(timer, entries[name], rounds[name]))
    return best


def difference(results: Array, reference: Array) -> float:
    """The largest error in any state, relative to that state's largest acceleration."""
    scale = np.abs(reference).max(axis=1, keepdims=True)
    return float((np.abs(results - reference) / scale).max())
