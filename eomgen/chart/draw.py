"""The chart as a picture: panels over one cost, for the screen and for print."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from importlib import import_module
from math import inf, isfinite
from typing import Any

from eomgen.chart.front import front, recommended
from eomgen.chart.records import OK, Chart, Errors, Point
from eomgen.errors import UsageError

# Okabe and Ito: told apart by the colour-blind
COLOURS = {"minimal": "#0072b2", "nullspace": "#d55e00", "multiplier": "#009e73"}
MARKERS = {
    "semi-euler": "v", "semi-euler-damped": "<", "verlet": "^", "rk4": "o", "dopri5": "s",
    "rosenbrock2": "D", "midpoint": "P",
}  # fmt: skip
LINES = {"f64": "-", "f32": (0, (4, 2))}
LEGEND = 7  # entries of a line
LEAST = 1e-17  # errors below it are drawn there: a logarithm has no zero
Value = Callable[[Errors], float]
PANELS: tuple[tuple[str, Value], ...] = (
    ("largest error of positions, relative", lambda e: e.positions),
    ("largest error of rates, relative", lambda e: e.rates),
    ("largest error of outputs, relative", lambda e: e.outputs),
    ("largest error of energy, relative", lambda e: e.energy),
    ("largest residual of constraints, relative", lambda e: e.constraint),
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
        figure = _figure(pyplot, chart)
        files = {}
        for kind, more in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 160})):
            stream = io.BytesIO()
            figure.savefig(stream, format=kind, **more)
            files[kind] = stream.getvalue()
        pyplot.close(figure)
    return files


def _figure(pyplot: Any, chart: Chart) -> Any:
    panels = [(t, v) for t, v in PANELS if _is_worth(chart, v)]
    rows = (len(panels) + 1) // 2
    figure, grid = pyplot.subplots(
        rows, 2, figsize=(10.5, 3.6 * rows + 1.3), sharex=True, squeeze=False
    )
    axes = [axis for line in grid for axis in line]
    for number, (axis, (title, value)) in enumerate(zip(axes, panels, strict=False)):
        _panel(axis, chart, value, is_judged=number < 2)
        axis.set_title(title, fontsize=9, loc="left")
    for axis in axes[len(panels) :]:
        axis.set_visible(False)
    for axis in axes[len(panels) - 2 : len(panels)]:
        axis.set_xlabel(_cost_words(chart))
        axis.tick_params(labelbottom=True)
    figure.suptitle(f"{chart.title}: {chart.horizon:g} s", fontsize=12)
    handles = _legend(pyplot, chart)
    figure.legend(handles=handles, loc="lower center", ncols=LEGEND, frameon=False, fontsize=8)
    lines = (len(handles) + LEGEND - 1) // LEGEND
    figure.tight_layout(rect=(0, 0.3 * (lines + 0.4) / figure.get_size_inches()[1], 1, 1))
    return figure


def _is_worth(chart: Chart, value: Value) -> bool:
    """Whether a panel has something to show."""
    return any(isfinite(value(p.errors)) and value(p.errors) > 0 for p in chart.good)


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


def _panel(axis: Any, chart: Chart, value: Value, *, is_judged: bool) -> None:
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(visible=True, which="major", color="#dddddd", linewidth=0.6)
    axis.set_axisbelow(True)
    for points in _series(chart):
        _drawn_series(axis, points, value)
    if is_judged:
        _judgement(axis, chart, value)
    _failures(axis, chart)


def _drawn_series(axis: Any, points: Sequence[Point], value: Value) -> None:
    good = [p for p in points if p.status == OK and 0 < value(p.errors) < inf]
    if not good:
        return
    run = good[0].run
    colour = COLOURS[run.formulation]
    x, y = [p.cost for p in good], [max(value(p.errors), LEAST) for p in good]
    axis.plot(x, y, color=colour, linestyle=LINES[run.precision], linewidth=0.8, alpha=0.8)
    for point, across, up in zip(good, x, y, strict=True):
        face = colour if point.resolved else "white"
        axis.plot(
            across, up, MARKERS[run.integrator], color=colour, markerfacecolor=face, markersize=4.5
        )


def _judgement(axis: Any, chart: Chart, value: Value) -> None:
    """The front, the target, what the reference resolves, what is recommended."""
    best = _descending(front(chart.points))
    axis.plot(
        [p.cost for p in best], [max(value(p.errors), LEAST) for p in best],
        color="black", linewidth=1.6, zorder=1,
    )  # fmt: skip
    low = axis.get_ylim()[0]
    axis.axhspan(low, chart.sweep.target, color="#eeeeee", zorder=0)
    axis.axhline(chart.reference.error, color="#888888", linewidth=0.8, linestyle=":")
    axis.set_ylim(bottom=low)
    choice = recommended(chart)
    if choice is not None:
        axis.plot(
            choice.cost, max(value(choice.errors), LEAST), "o", markersize=13,
            markerfacecolor="none", color="black", markeredgewidth=1.2,
        )  # fmt: skip


def _descending(points: Sequence[Point]) -> list[Point]:
    """The points of a line that only falls: of those that count as equal, the more accurate."""
    kept: list[Point] = []
    for point in points:
        if not kept or point.errors.judged < kept[-1].errors.judged:
            kept.append(point)
    return kept


def _failures(axis: Any, chart: Chart) -> None:
    """Crosses at the right edge, in the colour of the formulation, one for each failed run."""
    failed = [p for p in chart.points if p.status not in (OK, "timeout")]
    for number, point in enumerate(failed):
        height = 0.97 - 0.94 * (number / max(len(failed) - 1, 1))
        axis.plot(
            0.985, height, "x", color=COLOURS[point.run.formulation], markersize=3.5,
            transform=axis.transAxes,
        )  # fmt: skip


def _legend(pyplot: Any, chart: Chart) -> list[Any]:
    """Colours, markers, lines that occur."""
    line = import_module("matplotlib.lines").Line2D
    runs = [p.run for p in chart.points]
    names = [n for n in COLOURS if n in {r.formulation for r in runs}]
    handles = [line([], [], color=COLOURS[n], linewidth=3, label=n) for n in names]
    methods = [n for n in MARKERS if n in {r.integrator for r in runs}]
    style = {"color": "#444444", "linestyle": ""}
    handles += [line([], [], marker=MARKERS[n], label=n, **style) for n in methods]
    if len({r.precision for r in runs}) > 1:
        handles += [
            line([], [], color="#444444", linestyle=LINES["f64"], label="double"),
            line([], [], color="#444444", linestyle=LINES["f32"], label="float"),
        ]
    handles += [
        line([], [], color="black", linewidth=1.6, label="front"),
        line([], [], marker="o", markersize=10, markerfacecolor="none", color="black",
             linestyle="", label="recommended"),
        line([], [], marker="x", label="failed", **style),
    ]  # fmt: skip
    if any(not p.resolved for p in chart.good):
        handles.append(
            line([], [], marker="o", markerfacecolor="white", label="not resolved", **style)
        )
    return handles
