"""Line charts as SVG: panels over one time axis, ticks at round numbers, readable in print."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from math import ceil, floor, isfinite, log10

WIDTH, PANEL = 760, 250  # pixels: the page, one panel with its gap
LEFT, RIGHT, TOP, BOTTOM, HEAD = 78, 24, 34, 22, 40  # margins of a panel; of the title
# Okabe and Ito: told apart by the colour-blind, and by dashes in black and white
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
DASHES = ("", "7 3", "2 2.5", "9 3 2 3", "12 4", "4 2 1 2", "1 2")
TICKS = 6
GREY = "#d8d8d8"
MOST_POINTS = 4000  # of a line; more cannot be seen
SWATCH, CHARACTER = 26, 7.2  # of a legend


@dataclass(frozen=True)
class Line:
    """A quantity by name over the times of its panel."""

    name: str
    values: Sequence[float]


@dataclass(frozen=True)
class Panel:
    """Lines of one unit."""

    unit: str
    times: Sequence[float]
    lines: tuple[Line, ...]


@dataclass(frozen=True)
class Axis:
    """Numbers from low to high on pixels from start to stop, with ticks a step apart."""

    low: float
    high: float
    step: float
    start: float
    stop: float

    def place(self, value: float) -> float:
        """The pixel of a number."""
        share = (value - self.low) / (self.high - self.low)
        return self.start + share * (self.stop - self.start)

    def ticks(self) -> list[float]:
        """The multiples of the step on the axis."""
        first, last = ceil(self.low / self.step - 1e-9), floor(self.high / self.step + 1e-9)
        return [k * self.step for k in range(first, last + 1)]

    def label(self, tick: float) -> str:
        """A tick with the digits that its step needs."""
        largest = max(abs(self.low), abs(self.high))
        if largest >= 1e5 or largest < 1e-3:
            return f"{tick:.{max(0, floor(log10(largest)) - floor(log10(self.step)))}e}"
        return f"{tick:.{max(0, -floor(log10(self.step)))}f}".replace("-", "\u2212")


def round_step(span: float) -> float:
    """1, 2 or 5 times a power of ten, so that a span has at most `TICKS` of them."""
    power = floor(log10(span / TICKS))
    return next(
        float(f"{digit}e{power}") for digit in (1, 2, 5, 10) if digit * 10.0**power * TICKS >= span
    )


def axis(values: Sequence[float], start: float, stop: float, *, tight: bool) -> Axis:
    """An axis that holds the values; to the next tick, or as tight as they are."""
    known = [v for v in values if isfinite(v)] or [0.0]
    low, high = min(known), max(known)
    if high - low <= 1e-12 * max(abs(low), abs(high)) or high == low:
        margin = 0.5 * abs(low) or 1.0
        low, high = low - margin, high + margin
    step = round_step(high - low)
    if not tight:
        low, high = floor(low / step + 1e-9) * step, ceil(high / step - 1e-9) * step
    return Axis(low, high, step, start, stop)


def lines(title: str, panels: Sequence[Panel]) -> str:
    """The chart as one SVG file."""
    height, words = HEAD + PANEL * len(panels) + BOTTOM, escape(title)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" '
        f'viewBox="0 0 {WIDTH} {height}" font-family="Helvetica, Arial, sans-serif" '
        'font-size="13">',
        f"<title>{words}</title>",
        f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
        f'<text x="{WIDTH / 2:g}" y="24" text-anchor="middle" font-size="16">{words}</text>',
    ]
    for number, panel in enumerate(panels):
        parts += _panel(panel, HEAD + PANEL * number, is_last=number == len(panels) - 1)
    return "\n".join([*parts, "</svg>", ""])


def _panel(panel: Panel, top: int, *, is_last: bool) -> list[str]:
    """Frame, grid, lines and legend of one panel."""
    everything = [v for line in panel.lines for v in line.values]
    across = axis(panel.times, LEFT, WIDTH - RIGHT, tight=True)
    up = axis(everything, top + PANEL - BOTTOM, top + TOP, tight=False)
    parts = [*_grid(across, up, labels=is_last)]
    if panel.unit:
        parts.append(_turned(f"[{panel.unit}]", 16, (up.start + up.stop) / 2))
    for number, line in enumerate(panel.lines):
        parts.append(_path(panel.times, line.values, (across, up), number))
    parts += _legend(panel.lines, top + TOP - 12)
    if is_last:
        middle = (across.start + across.stop) / 2
        parts.append(
            f'<text x="{middle:g}" y="{up.start + 36:g}" text-anchor="middle">t [s]</text>'
        )
    return parts


def _grid(across: Axis, up: Axis, *, labels: bool) -> list[str]:
    parts = []
    for tick in across.ticks():
        x = across.place(tick)
        parts.append(_rule(x, up.start, x, up.stop))
        if labels:
            text = across.label(tick)
            parts.append(
                f'<text x="{x:.1f}" y="{up.start + 17:g}" text-anchor="middle">{text}</text>'
            )
    for tick in up.ticks():
        y = up.place(tick)
        parts.append(_rule(across.start, y, across.stop, y))
        parts.append(
            f'<text x="{LEFT - 7}" y="{y + 4.5:.1f}" text-anchor="end">{up.label(tick)}</text>'
        )
    wide, high = across.stop - across.start, up.start - up.stop
    frame = f'x="{across.start:g}" y="{up.stop:g}" width="{wide:g}" height="{high:g}"'
    return [*parts, f'<rect {frame} fill="none" stroke="#444"/>']


def _rule(x: float, y: float, to_x: float, to_y: float) -> str:
    return f'<path d="M{x:.1f} {y:.1f}L{to_x:.1f} {to_y:.1f}" stroke="{GREY}"/>'


def _turned(text: str, x: float, y: float) -> str:
    turn = f'transform="rotate(-90 {x:g} {y:g})"'
    return f'<text x="{x:g}" y="{y:g}" text-anchor="middle" {turn}>{escape(text)}</text>'


def _stroke(number: int) -> str:
    dash = DASHES[number % len(DASHES)]
    extra = f' stroke-dasharray="{dash}"' if dash else ""
    colour = COLOURS[number % len(COLOURS)]
    return f'fill="none" stroke="{colour}" stroke-width="1.7" stroke-linejoin="round"{extra}'


def _path(
    times: Sequence[float], values: Sequence[float], axes: tuple[Axis, Axis], number: int
) -> str:
    """A line, broken where it has no value."""
    across, up = axes
    words, pen = [], "M"
    for t, v in _thinned(times, values):
        if isfinite(v):
            words.append(f"{pen}{across.place(t):.2f} {up.place(v):.2f}")
            pen = "L"
        else:
            pen = "M"
    return f'<path d="{"".join(words)}" {_stroke(number)}/>'


def _thinned(times: Sequence[float], values: Sequence[float]) -> list[tuple[float, float]]:
    """Of many points the lowest and the highest of each share, in order: peaks stay."""
    pairs = list(zip(times, values, strict=True))
    if len(pairs) <= MOST_POINTS:
        return pairs
    share = ceil(2 * len(pairs) / MOST_POINTS)
    kept = []
    for start in range(0, len(pairs), share):
        block = pairs[start : start + share]
        ends = {min(range(len(block)), key=lambda i: block[i][1])}
        ends.add(max(range(len(block)), key=lambda i: block[i][1]))
        kept += [block[i] for i in sorted(ends)]
    return kept


def _legend(found: Sequence[Line], y: float) -> list[str]:
    """Swatches and names in a row above the panel."""
    parts, x = [], float(LEFT)
    for number, line in enumerate(found):
        parts.append(f'<path d="M{x:.1f} {y:g}h{SWATCH}" {_stroke(number)}/>')
        parts.append(f'<text x="{x + SWATCH + 6:.1f}" y="{y + 4.5:g}">{escape(line.name)}</text>')
        x += SWATCH + 24 + CHARACTER * len(line.name)
    return parts
