"""Findings as text for a person and as JSON for tools."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from math import isfinite
from typing import Any

from eomgen.stability.measured import BLOWN, DECADES, RUN
from eomgen.stability.records import Findings, Limit, Mode

SCHEMA = 1  # version of the JSON
HEAD = ("method", "predicted", "by the C", "ratio", "run from the start", "ratio", "where")


def text(found: Findings) -> str:
    """The page for a terminal."""
    parts = [
        [found.title, f"formulation: {found.formulation}{_inputs(found)}"],
        [f"looked at: {'; '.join(found.looked)}"],
        ["", "Modes", *_modes(found)],
        ["", "Largest stable step [s]", *_table(found.limits), *_criteria()],
        ["", "Accuracy", *_conditions(found)],
        ["", *found.warnings, *found.notes] if found.warnings or found.notes else [],
        ["", "Not reported", *(f"  {line}" for line in found.omitted)] if found.omitted else [],
    ]
    return "\n".join(line for part in parts for line in part) + "\n"


def _inputs(found: Findings) -> str:
    named = ", ".join(f"{name} = {value:.6g}" for name, value in found.inputs)
    return f"; inputs: {named}" if named else ""


def _modes(found: Findings) -> Iterator[str]:
    width = max((len(s.fastest.place) for s in found.spectra), default=0)
    for s in found.spectra:
        stiff = "; stiff" if s.stiff else ""
        yield (f"  {s.fastest.place:<{width}}  fastest {s.fastest}, slowest {s.slowest}{stiff}")
    if not found.spectra:
        yield "  nothing oscillates, decays or grows"


def _table(limits: Sequence[Limit]) -> Iterator[str]:
    """Columns as wide as what they hold."""
    rows = [HEAD, *(_row(limit) for limit in limits)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEAD))]
    for row in rows:
        cells = [f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)]
        yield f"  {'  '.join(cells)}".rstrip()


def _row(x: Limit) -> tuple[str, ...]:
    return (
        x.method, step(x.predicted), step(x.measured), _ratio(x.ratio), step(x.run),
        _ratio(x.run_ratio), x.place,
    )  # fmt: skip


def step(value: float | None) -> str:
    """A step in seconds."""
    if value is None:
        return "-"
    return f"{value:.4g}" if isfinite(value) else "none"


def _ratio(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def _criteria() -> Iterator[str]:
    yield "  predicted: by the eigenvalues, the smallest of all places, which is `where`"
    yield "  by the C: there, by bisection; at rest nothing may grow, in motion as for a run"
    yield f"  run: {RUN} steps, finite, the kinetic energy below {BLOWN:g} times that of a fine run"
    yield f"  none: no limit, tried up to {10**DECADES}/omega of the fastest mode"


def _conditions(found: Findings) -> Iterator[str]:
    for c in found.conditions:
        yield f"  cond({c.matrix}) <= {c.value:.3g} (at {c.place}; whatever the units)"
    for one in found.rounding:
        floors = ", ".join(f"{name} {value:.2g}" for name, value in one.floors.items())
        yield f"  {one.real}: accelerations to {one.error:.0e}" + (
            f"; rounding rules below the steps [s] {floors}" if floors else ""
        )


def as_json(found: Findings) -> str:
    """One object; steps without a limit are the word "none"."""
    return json.dumps(_object(found), indent=2, ensure_ascii=False) + "\n"


def _object(found: Findings) -> dict[str, Any]:
    return {
        "eomgen": "stability",
        "schema": SCHEMA,
        "title": found.title,
        "formulation": found.formulation,
        "horizon": found.horizon,
        "inputs": dict(found.inputs),
        "looked_at": list(found.looked),
        "modes": [
            {
                "place": s.fastest.place,
                "fastest": _mode(s.fastest),
                "slowest": _mode(s.slowest),
                "stiff": s.stiff,
            }
            for s in found.spectra
        ],
        "fastest": None if found.fastest is None else _mode(found.fastest),
        "largest_steps": [_limit(x) for x in found.limits],
        "accurate_step": found.accurate,
        "conditions": [
            {"matrix": c.matrix, "value": _number(c.value), "place": c.place}
            for c in found.conditions
        ],
        "rounding": [
            {"real": r.real, "error": _number(r.error), "least_steps": r.floors}
            for r in found.rounding
        ],
        "warnings": list(found.warnings),
        "notes": list(found.notes),
        "not_reported": list(found.omitted),
    }


def _mode(one: Mode) -> dict[str, Any]:
    return {
        "place": one.place,
        "eigenvalue": [one.value.real, one.value.imag],
        "rate": one.rate,
        "damping_ratio": one.damping_ratio,
    }


def _limit(x: Limit) -> dict[str, Any]:
    return {
        "method": x.method,
        "place": x.place,
        "predicted": _number(x.predicted),
        "measured": _number(x.measured),
        "ratio": x.ratio,
        "run": _number(x.run),
        "run_ratio": x.run_ratio,
    }


def _number(value: float | None) -> float | str | None:
    """JSON knows no infinity."""
    return value if value is None or isfinite(value) else "none"
