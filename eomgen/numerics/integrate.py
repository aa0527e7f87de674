"""Fixed-step runs: the steps that we ship, in pieces, so that a caller can look in between."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import floor

import numpy as np

from eomgen.errors import UsageError
from eomgen.integrators.methods import Method
from eomgen.numerics.records import Array, Engine, Grid, Rows

PIECE = 20_000  # steps of a piece at most
MOST_STEPS = 1_000_000_000
NEARLY = 1e-9  # of a step: the last one may miss the end by so much


def run(engine: Engine, method: Method, state: Array, grid: Grid, flow: str | None = None) -> Rows:
    """All rows of a run at once, the state at the start among them.

    flow: the function of energy and power whose work is summed; None: works are zero.
    """
    first = Rows(np.array([grid.start]), np.array([state], float), np.zeros(1))
    return joined([first, *pieces(engine, method, state, grid, flow)])


def grid_of(span: tuple[float, float], step: float, every: int) -> Grid:
    """Whole steps from the start to the end, or the last one before it.

    Raises:
        UsageError: there would be too many.
    """
    start, end = span
    if (end - start) / step > MOST_STEPS:
        raise UsageError(
            f"{(end - start) / step:.3g} steps are too many: at most {MOST_STEPS:.0e}; "
            "take a larger step or a shorter time"
        )
    return Grid(start, step, floor((end - start) / step + NEARLY), every)


def pieces(
    engine: Engine, method: Method, state: Array, grid: Grid, flow: str | None = None
) -> Iterator[Rows]:
    """The rows of a run, piece by piece; the last has `stopped` where a step could not be made."""
    march = engine.march(method, flow, state)
    size = PIECE if engine.real and grid.every < PIECE else grid.every
    done = 0
    while done < grid.count:
        made = march.advance(grid, done, min(size, grid.count - done))
        done += made.steps
        yield made
        if made.stopped:
            return


def joined(parts: Iterable[Rows]) -> Rows:
    """One record of several in a row."""
    found = list(parts)
    tally: dict[int, tuple[int, int]] = {}
    for part in found:
        for bit, (count, first) in part.tally.items():
            seen, since = tally.get(bit, (0, first))
            tally[bit] = (seen + count, since)
    return Rows(
        np.concatenate([p.times for p in found]),
        np.concatenate([p.states for p in found]),
        np.concatenate([p.works for p in found]),
        sum(p.steps for p in found),
        found[-1].stopped,
        tally,
        tuple(event for p in found for event in p.events),
        sum(p.lost for p in found),
    )
