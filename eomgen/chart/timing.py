"""What runs cost in time: shuffled, repeated, the minimum taken."""

from __future__ import annotations

import os
import platform
import random
import time
from collections.abc import Sequence
from dataclasses import replace
from statistics import median

import numpy as np

from eomgen.chart.records import OK, Point
from eomgen.chart.runs import Plan
from eomgen.numerics import compiled
from eomgen.numerics.records import Grid

REPEATS = 5
LEAST = 0.02  # s that the steps of one repeat take together
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
    seconds = [_once(plan) for _ in range(REPEATS)]
    for _ in range(TRIES - 1):
        if median(seconds) <= NOISY * min(seconds):
            break
        seconds += [_once(plan) for _ in range(REPEATS)]
    return replace(point, seconds=min(seconds), median=median(seconds))


def _once(plan: Plan) -> float:
    """Seconds of CPU per simulated second: enough steps to be measured, none written."""
    setup, count = plan.variant.setup, 0
    engine = plan.variant.engines[plan.run.precision]
    whole = Grid(plan.grid.start, plan.grid.step, plan.grid.count, plan.grid.count)
    spent = 0.0
    with np.errstate(all="ignore"):
        while spent < LEAST / REPEATS:
            march = engine.march(plan.method, None, setup.start.state)
            start = time.perf_counter()
            march.advance(whole, 0, whole.count)
            spent += time.perf_counter() - start
            count += 1
    return spent / (count * whole.count * whole.step)


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
