"""What runs cost in time: shuffled, repeated, the minimum taken."""

from __future__ import annotations

import os
import platform
import random
import time
from collections.abc import Sequence
from dataclasses import replace
from math import ceil
from statistics import median

import numpy as np

from eomgen.chart.records import OK, Point
from eomgen.chart.runs import RATE, Plan
from eomgen.numerics import compiled
from eomgen.numerics.records import Grid

REPEATS = 5
LEAST = 0.004  # s that the steps of one repeat take together, at least
MANY = 0.02  # s, as foreseen, of a run of which no more is repeated
NOISY = 1.3  # median / minimum above which a point is timed again
TRIES = 3


def timed(
    pairs: Sequence[tuple[Plan, Point]], budget: float, seed: int
) -> tuple[tuple[Point, ...], bool]:
    """The points with their times, and whether the budget [s] was enough for all of them."""
    order = [i for i, (_, point) in enumerate(pairs) if point.status == OK]
    random.Random(seed).shuffle(order)
    points, end = [point for _, point in pairs], time.monotonic() + budget
    for place in order:
        if time.monotonic() > end:
            return tuple(points), False
        points[place] = _with_time(*pairs[place])
    return tuple(points), True


def _with_time(plan: Plan, point: Point) -> Point:
    times = 1
    while _spent(plan, times) < LEAST:
        times *= 2
    seconds = [_once(plan, times) for _ in range(REPEATS)]
    for _ in range(TRIES - 1):
        if median(seconds) <= NOISY * min(seconds):
            break
        seconds += [_once(plan, times) for _ in range(REPEATS)]
    return replace(point, seconds=min(seconds), median=median(seconds))


def _once(plan: Plan, times: int) -> float:
    """Seconds of CPU per simulated second."""
    return _spent(plan, times) / (times * _steps(plan) * plan.grid.step)


def _spent(plan: Plan, times: int) -> float:
    """Seconds of CPU for the steps of a plan `times` over, without rows."""
    engine, count = plan.variant.engines[plan.run.precision], _steps(plan)
    grid = Grid(plan.grid.start, plan.grid.step, count, count)
    with np.errstate(all="ignore"):
        start = time.thread_time()
        engine.repeat(plan.method, plan.variant.setup.start.state, grid, times)
        return time.thread_time() - start


def _steps(plan: Plan) -> int:
    """Every step takes the same statements, so the first of a long run stand for all."""
    return min(plan.grid.count, ceil(MANY / (plan.operations * RATE)))


def machine() -> dict[str, str]:
    """Where it was measured."""
    load = f"{os.getloadavg()[0]:.2f}" if hasattr(os, "getloadavg") else "unknown"
    return {
        "processor": _processor(),
        "compiler": " ".join(compiled.compiler()),
        "flags": " ".join(compiled.OPTIONS),
        "load": load,
        "python": platform.python_version(),
    }


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:  # noqa: PTH123
            lines = [line for line in file if line.startswith("model name")]
    except OSError:
        lines = []
    return lines[0].partition(":")[2].strip() if lines else platform.machine()
