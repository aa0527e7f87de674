"""The chart as a LaTeX page that draws itself with pgfplots from the CSV."""

from __future__ import annotations

from collections.abc import Iterable
from math import inf
from typing import Any

from eomgen.chart.draw import COLOURS, PANELS, Panel
from eomgen.chart.front import recommended, sentence
from eomgen.chart.records import PRECISIONS, Chart, Combination
from eomgen.chart.tables import series
from eomgen.render.latex_text import escaped
from eomgen.render.templating import environment, fill

CSV = "chart.csv"
MARKS = {  # and how they are turned
    "semi-euler": ("triangle*", 180), "semi-euler-damped": ("triangle*", 90),
    "verlet": ("triangle*", 0), "rk4": ("*", 0), "dopri5": ("square*", 0),
    "rosenbrock2": ("diamond*", 0), "midpoint": ("pentagon*", 0),
}  # fmt: skip


def as_latex(chart: Chart) -> str:
    """The text of the page."""
    return fill(environment(), "latex/chart.tex.j2", context(chart))


def context(chart: Chart) -> dict[str, Any]:
    """What the template sees."""
    is_timed = any(p.seconds is not None for p in chart.good)
    runs = _series(chart)
    return {
        "title": escaped(chart.title),
        "horizon": f"{chart.horizon:g}",
        "csv": CSV,
        "sentence": escaped(sentence(chart)),
        "cost": "seconds" if is_timed else "operations",
        "cost_words": "CPU seconds per simulated second" if is_timed else "weighted operations",
        "target": f"{chart.sweep.target!r}",
        "reference": f"{chart.reference.error!r}",
        "colours": [(name, colour.removeprefix("#").upper()) for name, colour in COLOURS.items()],
        "panels": [_panel(chart, panel, runs) for panel in PANELS if panel.is_worth(chart)],
        "series": [{"key": key, "name": _name(run)} for key, run in runs.items()],
        "styles": {key: _style(run) for key, run in runs.items()},
        "digest": chart.digest,
    }


def _panel(chart: Chart, panel: Panel, runs: Iterable[str]) -> dict[str, Any]:
    """A panel with the lines that it shows: what is zero has no place on a logarithm."""
    drawn = {series(p) for p in chart.good if 0 < panel.value(p.errors) < inf}
    best = recommended(chart)
    return {
        "title": panel.title,
        "column": panel.column,
        "is_judged": panel.is_judged,
        "series": [key for key in runs if key in drawn],
        "recommended": f"({best.cost!r}, {panel.value(best.errors)!r})" if best else "",
    }


def _series(chart: Chart) -> dict[str, Combination]:
    """Each line with one of its runs, in the order of the legend of the pictures."""
    orders = (list(COLOURS), list(MARKS), list(PRECISIONS))
    found = {series(p): p.run for p in chart.good}

    def place(key: str) -> list[int]:
        run = found[key]
        names = (run.formulation, run.integrator, run.precision)
        return [order.index(name) for order, name in zip(orders, names, strict=True)]

    return {key: found[key] for key in sorted(found, key=place)}


def _name(run: Combination) -> str:
    return escaped(f"{run.name}{', float' if run.precision == 'f32' else ''}")


def _style(run: Combination) -> str:
    """How pgfplots draws a line."""
    mark, angle = MARKS[run.integrator]
    line = "dashed" if run.precision == "f32" else "solid"
    options = f"mark options={{solid, fill={run.formulation}, rotate={angle}}}"
    return f"color={run.formulation}, mark={mark}, mark size=1.8pt, {line}, {options}"
