"""A motion as one HTML page that needs nothing else: canvas, slider, the places as numbers."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from html import escape
from math import sqrt
from typing import Any

from eomgen.render.templating import environment, fill

STEPS = 9999  # whole numbers that the largest extent is cut into
RIGID = 1e-6  # relative: a distance that changes less is that of a rigid link

Pair = tuple[int, int]


@dataclass(frozen=True)
class Disc:
    """A body: its place, the tips of its axes, its size from 0 to 1, and its name."""

    at: int
    tips: tuple[int, ...]
    size: float
    name: str


@dataclass(frozen=True)
class Sketch:
    """What to draw, by the numbers of places; `arms` are drawn where they are rigid."""

    bodies: tuple[Disc, ...]
    points: tuple[tuple[int, str], ...]
    rods: tuple[Pair, ...]
    arms: tuple[Pair, ...]
    springs: tuple[Pair, ...]
    dampers: tuple[Pair, ...]


def page(title: str, sketch: Sketch, times: Any, places: Any) -> str:
    """The page; places (frames, number of places, dimensions) [m]."""
    frames = places.tolist()
    numbers, low, unit = _whole(frames)
    kept = {**asdict(sketch), "arms": [a for a in sketch.arms if _is_rigid(frames, a)]}
    data = {
        "times": [round(float(t), 5) for t in times],
        "frames": numbers,
        "low": low,
        "unit": unit,
        "sketch": kept,
    }
    # a name of the spec cannot end the script
    text = json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")
    context = {"title": escape(title), "data": text}
    return fill(environment(), "html/animation.html.j2", context)


def _whole(frames: Sequence[Any]) -> tuple[list[list[int]], list[float], float]:
    """The places as whole multiples of a unit above the lowest corner."""
    size = len(frames[0][0])
    columns = [[p[k] for frame in frames for p in frame] for k in range(size)]
    low = [min(c) for c in columns]
    extent = max(max(c) - least for c, least in zip(columns, low, strict=True))
    unit = float(f"{(extent or 1.0) / STEPS:.6g}")
    numbers = [
        [round((v - low[k]) / unit) for place in frame for k, v in enumerate(place)]
        for frame in frames
    ]
    return numbers, [float(f"{v:.6g}") for v in low], unit


def _is_rigid(frames: Sequence[Any], arm: Pair) -> bool:
    """Whether two places keep their distance."""
    first, second = arm
    lengths = [
        sqrt(sum((a - b) ** 2 for a, b in zip(f[first], f[second], strict=True))) for f in frames
    ]
    return min(lengths) > 0 and max(lengths) - min(lengths) <= RIGID * max(lengths)
