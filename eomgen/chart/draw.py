"""The chart as a picture: panels over one cost, for the screen and for print."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from math import inf, isfinite
from typing import Any

from eomgen.chart.front import front, recommended
from eomgen.chart.records import OK, PRECISIONS, Chart, Errors, Point
from eomgen.errors import UsageError

# Okabe and Ito: told apart by the colour-blind
COLOURS = {"minimal": "#0072b2", "nullspace": "#d55e00", "multiplier": "#009e73"}
MARKERS = {
    "semi-euler": "v", "semi-euler-damped": "<", "verlet": "^", "rk4": "o", "dopri5": "s",
    "rosenbrock2": "D", "midpoint": "P",
}  # fmt: skip
MET, GREY = "#eeeeee", "#444444"
LINES = {"f64": "-", "f32": (0, (4, 2))}
LEGEND = 7  # entries of a line
LEAST = 1e-17  # errors below it are drawn there: a logarithm has no zero
STRIP = 0.03  # of the width of a panel: a column of failed runs at its right edge


@dataclass(frozen=True)
class Panel:
    """One error over the cost; column: its name in `Errors` and in the tables."""

    column: str
    title: str
    is_judged: bool = False  # compared with the target

    def value(self, errors: Errors) -> float:
        """The error of this panel."""
        found: float = getattr(errors, self.column)
        return found

    def is_worth(self, chart: Chart) -> bool:
        """Whether the panel has something to show."""
        return any(isfinite(v) and v > 0 for v in (self.value(p.errors) for p in chart.good))


PANELS = (
    Panel("positions", "largest error of positions, relative", is_judged=True),
    Panel("rates", "largest error of rates, relative", is_judged=True),
    Panel("outputs", "largest error of outputs, relative"),
    Panel("energy", "largest error of energy, relative"),
    Panel("constraint", "largest residual of constraints, relative"),
)


def drawn(chart: Chart) -> dict[str, bytes]:
    """SVG and PNG.

    Raises:
        UsageError: matplotlib is not installed.
    """
    try:
        matplotlib = import_module("matplotlib")
    except ImportError as error:
        raise UsageError(
            "the pictures need matplotlib: pip install 'eomgen[plot]'; the tables are written"
        ) from error
    matplotlib.use("Agg")
    from matplotlib import pyplot

    settings = {"svg.hashsalt": chart.digest, "font.size": 9, "svg.fonttype": "path"}
    with matplotlib.rc_context(settings):
        made = figure(pyplot, chart)
        files = {}
        for kind, more in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 160})):
            stream = io.BytesIO()
            made.savefig(stream, format=kind, **more)
            files[kind] = stream.getvalue()
        pyplot.close(made)
    return files


def figure(pyplot: Any, chart: Chart) -> Any:
    """The panels and their legend, drawn by the pyplot that is given."""
    panels = [p for p in PANELS if p.is_worth(chart)]
    rows = (len(panels) + 1) // 2
    made, grid = pyplot.subplots(
        rows, 2, figsize=(10.5, 3.6 * rows + 1.3 * (len(panels) % 2 == 0)),
        sharex=True, squeeze=False,
    )  # fmt: skip
    axes = [axis for line in grid for axis in line]
    for axis, panel in zip(axes, panels, strict=False):
        _panel(axis, chart, panel)
        axis.set_title(panel.title, fontsize=9, loc="left")
        axis.tick_params(labelbottom=True)
    for axis in axes[len(panels) - 2 : len(panels)]:
        axis.set_xlabel(_cost_words(chart))
    low, high = axes[0].get_xlim()
    axes[0].set_xlim(low, high * (high / low) ** (STRIP * (len(_failed(chart)) + 0.5)))
    made.suptitle(f"{chart.title}: {chart.horizon:g} s", fontsize=12)
    _key(made, axes[len(panels) :], [*_kinds(chart), *_signs(chart)])
    return made


def _key(made: Any, spare: Sequence[Any], handles: Sequence[Any]) -> None:
    """The legend: where a panel is spare, else below all."""
    style = {"frameon": False, "fontsize": 8}
    if spare:
        spare[0].set_axis_off()
        spare[0].legend(handles=handles, loc="center", ncols=2, labelspacing=1.0, **style)
        made.tight_layout()
        return
    made.legend(handles=handles, loc="lower center", ncols=LEGEND, **style)
    lines = (len(handles) + LEGEND - 1) // LEGEND
    made.tight_layout(rect=(0, 0.2 * (lines + 1) / made.get_size_inches()[1], 1, 1))


def _cost_words(chart: Chart) -> str:
    if all(p.seconds is None for p in chart.good):
        return "weighted operations per simulated second"
    return "CPU seconds per simulated second"


def _series(chart: Chart) -> list[list[Point]]:
    """Runs that differ in the step only, in the order of cost."""
    found: dict[tuple[str, str], list[Point]] = {}
    for point in chart.points:
        found.setdefault((point.run.name, point.run.precision), []).append(point)
    return [sorted(points, key=lambda p: -p.run.step) for points in found.values()]


def _panel(axis: Any, chart: Chart, panel: Panel) -> None:
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(visible=True, which="major", color="#dddddd", linewidth=0.6)
    axis.set_axisbelow(True)
    for points in _series(chart):
        _drawn_series(axis, points, panel)
    if panel.is_judged:
        _judgement(axis, chart, panel)
    _failures(axis, chart)


def _drawn_series(axis: Any, points: Sequence[Point], panel: Panel) -> None:
    good = [p for p in points if p.status == OK and 0 < panel.value(p.errors) < inf]
    if not good:
        return
    run = good[0].run
    colour = COLOURS[run.formulation]
    x, y = [p.cost for p in good], [max(panel.value(p.errors), LEAST) for p in good]
    axis.plot(x, y, color=colour, linestyle=LINES[run.precision], linewidth=0.8, alpha=0.8)
    for point, across, up in zip(good, x, y, strict=True):
        face = colour if point.resolved else "white"
        axis.plot(
            across, up, MARKERS[run.integrator], color=colour, markerfacecolor=face, markersize=4.5
        )


def _judgement(axis: Any, chart: Chart, panel: Panel) -> None:
    """The front, the target, what the reference resolves, what is recommended."""
    best = _descending(front(chart.points))
    axis.plot(
        [p.cost for p in best], [max(panel.value(p.errors), LEAST) for p in best],
        color="black", linewidth=1.6, zorder=1,
    )  # fmt: skip
    low = axis.get_ylim()[0]
    axis.axhspan(low, chart.sweep.target, color=MET, zorder=0)
    axis.axhline(chart.reference.error, color="#888888", linewidth=0.8, linestyle=":")
    axis.set_ylim(bottom=low)
    choice = recommended(chart)
    if choice is not None:
        axis.plot(
            choice.cost, max(panel.value(choice.errors), LEAST), "o", markersize=13,
            markerfacecolor="none", color="black", markeredgewidth=1.2,
        )  # fmt: skip


def _descending(points: Sequence[Point]) -> list[Point]:
    """The points of a line that only falls: of those that count as equal, the more accurate."""
    kept: list[Point] = []
    for point in points:
        if not kept or point.errors.judged < kept[-1].errors.judged:
            kept.append(point)
    return kept


def _failed(chart: Chart) -> dict[str, int]:
    """How many runs of each formulation failed, of those with any."""
    failed = [p.run.formulation for p in chart.points if p.status not in (OK, "timeout")]
    return {name: failed.count(name) for name in COLOURS if name in failed}


def _failures(axis: Any, chart: Chart) -> None:
    """Crosses at the right edge: a column for each formulation, a cross for each failed run."""
    for place, (name, count) in enumerate(reversed(_failed(chart).items())):
        heights = [0.97 - 0.94 * number / max(count - 1, 1) for number in range(count)]
        axis.plot(
            [1 - STRIP * (place + 0.6)] * count, heights, "x", color=COLOURS[name], markersize=3,
            transform=axis.transAxes,
        )  # fmt: skip


def _entry(label: str, **style: Any) -> Any:
    """An entry of the legend."""
    return import_module("matplotlib.lines").Line2D([], [], label=label, **style)


def _kinds(chart: Chart) -> Iterator[Any]:
    """Colours, markers, lines that occur."""
    formulations = {p.run.formulation for p in chart.points}
    integrators = {p.run.integrator for p in chart.good}
    precisions = {p.run.precision for p in chart.points}
    for name in (n for n in COLOURS if n in formulations):
        yield _entry(name, color=COLOURS[name], linewidth=3)
    for name in (n for n in MARKERS if n in integrators):
        yield _entry(name, marker=MARKERS[name], color=GREY, linestyle="")
    if len(precisions) > 1:
        for name, word in PRECISIONS.items():
            yield _entry(word, color=GREY, linestyle=LINES[name])


def _signs(chart: Chart) -> Iterator[Any]:
    """What else is drawn."""
    point = {"color": GREY, "linestyle": ""}
    yield _entry("front", color="black", linewidth=1.6)
    ring = {"marker": "o", "markersize": 10, "markerfacecolor": "none"}
    yield _entry("recommended", color="black", linestyle="", **ring)
    yield _entry("target met", color=MET, linewidth=8)
    yield _entry("error of the reference", color="#888888", linewidth=0.8, linestyle=":")
    yield _entry(f"failed ({sum(_failed(chart).values())})", marker="x", **point)
    if any(not p.resolved for p in chart.good):
        yield _entry("not resolved", marker="o", markerfacecolor="white", **point)
