"""Where else to look: which coordinates are angles, how far a search spreads, where it starts."""

from __future__ import annotations

import random
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

from eomgen.algebra.arithmetic import FLOAT
from eomgen.analysis import linkage as linkages
from eomgen.analysis.linkage import PRECISE, Linkage, State

RESTARTS = 40
SIZED = 6  # starts at which rows are sized
WIDEST = 3.0  # of the starts, in units of the reach
NEARLY = 1e-6  # so that -pi is printed as pi
TURN = 2 * PRECISE.functions["pi"]()


def reach(linkage: Linkage, state: State) -> tuple[float, ...]:
    """How far a search spreads each coordinate: 1 for an angle, else the scene's own size."""
    coordinates = linkage.model.coordinates
    sizes = [abs(float(v)) for v in state.coordinates]

    def size(i: int) -> float:
        dimension = coordinates[i].description.dimension
        like = [
            s
            for c, s in zip(coordinates, sizes, strict=True)
            if c.description.dimension == dimension
        ]
        return max(like) or 1.0

    return tuple(1.0 if p else size(i) for i, p in enumerate(periodic(linkage, state)))


def row_sizes(linkage: Linkage, state: State) -> list[float]:
    """The largest |J_ij| of each row near a state: what its entries there are compared with."""
    rows = [row.jacobian for row in linkage.rows]
    sizes = [0.0] * len(rows)
    for start in starts(linkage, state, range(len(state.coordinates)))[:SIZED]:
        with suppress(*linkages.IRREGULAR):
            at = replace(state, coordinates=tuple(start))
            found = linkages.matrix(linkage, rows, at, FLOAT)
            sizes = [max(s, *(abs(v) for v in row)) for s, row in zip(sizes, found, strict=True)]
    return sizes


def periodic(linkage: Linkage, state: State) -> tuple[bool, ...]:
    """Which coordinates are angles: adding 2 pi changes no row."""
    chance = random.Random("periodic")
    nodes = [entry for row in linkage.rows for entry in (*row.jacobian, row.rate)]
    nodes += [r.residual for r in linkage.holonomic if r.residual is not None]
    x = [v + PRECISE.number(chance.uniform(0.1, 0.2)) for v in state.coordinates]
    rates = tuple(PRECISE.number(chance.uniform(1, 2)) for _ in x)

    def at(coordinates: Sequence[Any]) -> list[Any]:
        moved = replace(state, coordinates=tuple(coordinates), rates=rates)
        return linkages.values(linkage, nodes, moved, PRECISE)

    try:
        before = at(x)
        shifted = [at([*x[:i], x[i] + TURN, *x[i + 1 :]]) for i in range(len(x))]
    except linkages.IRREGULAR:
        return (False,) * len(x)
    return tuple(
        all(abs(a - b) < 1e-30 for a, b in zip(before, after, strict=True)) for after in shifted
    )


def starts(linkage: Linkage, state: State, movable: Sequence[int]) -> list[Sequence[Any]]:
    """The state itself, then random ones around it, nearest first."""
    chance = random.Random(f"restarts {linkage.model.name}")
    spread = reach(linkage, state)
    starts: list[Sequence[Any]] = [state.coordinates]
    for k in range(RESTARTS if movable else 0):
        share = WIDEST * (k + 1) / RESTARTS
        start = list(state.coordinates)
        for i in movable:
            start[i] = start[i] + PRECISE.number(chance.uniform(-1, 1) * share * spread[i])
        starts.append(start)
    return starts


def same(
    left: Sequence[Any], right: Sequence[Any], angles: Sequence[bool], within: float = 1e-9
) -> bool:
    """Whether two positions are one, angles up to whole turns."""
    differences = [
        (d - TURN * round(d / TURN)) if is_angle else d
        for d, is_angle in zip(
            (a - b for a, b in zip(left, right, strict=True)), angles, strict=True
        )
    ]
    return all(abs(d) < within for d in differences)


def principal(values: Sequence[Any], angles: Sequence[bool]) -> list[Any]:
    """Angles above -pi, up to pi."""
    return [
        v - TURN * round((v - NEARLY) / TURN) if is_angle else v
        for v, is_angle in zip(values, angles, strict=True)
    ]
