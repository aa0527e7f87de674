"""The chart as JSON, CSV and Markdown."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import asdict
from math import isfinite
from typing import Any

from eomgen import __version__
from eomgen.chart.front import front, milliseconds, recommended, sentence
from eomgen.chart.records import FAILURES, OK, SCHEMA, Chart, Point

COLUMNS = (
    "formulation", "integrator", "order", "precision", "step", "states", "projects", "status",
    "resolved", "front", "positions", "rates", "outputs", "energy", "constraint", "operations",
    "seconds", "median", "series",
)  # fmt: skip


def rows(chart: Chart) -> list[dict[str, Any]]:
    """All points by column."""
    best = front(chart.points)
    return [row(point, is_on_front=point in best) for point in chart.points]


def row(point: Point, *, is_on_front: bool) -> dict[str, Any]:
    """A point by column; a number that is none is None."""
    errors = {k: v if isfinite(v) else None for k, v in asdict(point.errors).items()}
    found = {
        **asdict(point.run),
        **errors,
        "status": point.status,
        "resolved": point.resolved,
        "front": is_on_front,
        "operations": point.operations,
        "seconds": point.seconds,
        "median": point.median,
        "series": series(point),
    }
    return {name: found[name] for name in COLUMNS}


def series(point: Point) -> str:
    """Runs with the same name lie on one line of a drawing."""
    run = point.run
    return f"{run.formulation}-{run.integrator}-{run.precision}" if point.status == OK else "failed"


def as_json(chart: Chart) -> str:
    """Everything."""
    best, found = recommended(chart), rows(chart)
    return json.dumps(
        {
            "schema": SCHEMA,
            "eomgen": __version__,
            "title": chart.title,
            "spec": chart.digest,
            "sweep": asdict(chart.sweep),
            "horizon": chart.horizon,
            "reference": asdict(chart.reference),
            "recommendation": sentence(chart),
            "recommended": None if best is None else found[chart.points.index(best)],
            "remarks": list(chart.remarks),
            "machine": chart.machine,
            "runs": found,
        },
        indent=1,
    )


def as_csv(chart: Chart) -> str:
    """One row for each run, in SI; empty where there is no number."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
    writer.writeheader()
    for values in rows(chart):
        writer.writerow({k: "" if v is None else _cell(v) for k, v in values.items()})
    return stream.getvalue()


def _cell(value: Any) -> Any:
    return (
        repr(value) if isinstance(value, float) else int(value) if value in (True, False) else value
    )


def as_markdown(chart: Chart) -> str:
    """The recommendation, the front, the failures."""
    lines = [
        f"# {chart.title}: accuracy against cost",
        "",
        sentence(chart),
        "",
        f"Reference: {chart.reference.about[0]} against {chart.reference.about[1]}, "
        f"difference {chart.reference.error:.1e}.",
        *(f"{remark}." for remark in chart.remarks),
        "",
        "| on the front | step | precision | error of positions | of rates | of outputs | energy |"
        " constraint | operations / s | CPU s / s |",
        "|---|---|---|---|---|---|---|---|---|---|",
        *(_line(p) for p in front(chart.points)),
        "",
    ]
    failed = [p for p in chart.points if p.status != OK]
    if failed:
        lines += ["| failed | step | precision | why |", "|---|---|---|---|"]
        lines += [
            f"| {p.run.name} | {milliseconds(p.run.step)} | {p.run.precision} "
            f"| {FAILURES[p.status]} |"
            for p in failed
        ]
        lines.append("")
    lines.append(", ".join(f"{k}: {v}" for k, v in chart.machine.items()) + ".")
    return "\n".join([*lines, ""])


def _line(point: Point) -> str:
    e = point.errors
    cells = (
        point.run.name,
        milliseconds(point.run.step),
        point.run.precision,
        *(_number(v) for v in (e.positions, e.rates, e.outputs, e.energy, e.constraint)),
        f"{point.operations:.3g}",
        "-" if point.seconds is None else f"{point.seconds:.2e}",
    )
    return f"| {' | '.join(cells)} |"


def _number(value: float) -> str:
    return f"{value:.1e}" if isfinite(value) else "-"
