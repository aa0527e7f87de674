"""The chart as a LaTeX page that draws itself with pgfplots from the CSV."""

from __future__ import annotations

from typing import Any

from eomgen.chart.draw import COLOURS, PANELS
from eomgen.chart.front import sentence
from eomgen.chart.records import Chart
from eomgen.chart.tables import series
from eomgen.render.latex_text import escaped
from eomgen.render.templating import environment, fill

CSV = "chart.csv"
COLUMNS = ("positions", "rates", "outputs", "energy", "constraint")  # beside `PANELS`
MARKS = {
    "semi-euler": "triangle*, mark options={rotate=180}",
    "semi-euler-damped": "triangle*, mark options={rotate=90}", "verlet": "triangle*", "rk4": "*",
    "dopri5": "square*", "rosenbrock2": "diamond*", "midpoint": "pentagon*",
}  # fmt: skip
JUDGED = 2  # panels that the target is drawn in


def as_latex(chart: Chart) -> str:
    """The text of the page."""
    return fill(environment(), "latex/chart.tex.j2", context(chart))


def context(chart: Chart) -> dict[str, Any]:
    """What the template sees."""
    is_timed = any(p.seconds is not None for p in chart.good)
    shown = [
        (title, column)
        for (title, value), column in zip(PANELS, COLUMNS, strict=True)
        if any(value(p.errors) > 0 for p in chart.good)
    ]
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
        "panels": [
            {
                "title": title,
                "column": column,
                "is_judged": number < JUDGED,
                "is_last": number == len(shown) - 1,
            }
            for number, (title, column) in enumerate(shown)
        ],
        "series": _series(chart),
        "digest": chart.digest,
    }


def _series(chart: Chart) -> list[dict[str, str]]:
    """Each line once, in the order of the runs."""
    found: dict[str, dict[str, str]] = {}
    for point in chart.good:
        run = point.run
        found.setdefault(
            series(point),
            {
                "key": series(point),
                "name": escaped(f"{run.name}{', float' if run.precision == 'f32' else ''}"),
                "colour": run.formulation,
                "mark": MARKS[run.integrator],
                "line": "dashed" if run.precision == "f32" else "solid",
            },
        )
    return list(found.values())
