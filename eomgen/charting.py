"""A request for a chart -> the chart, its files, its words, and the spec that remembers it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from eomgen import files
from eomgen.chart import draw, make, page, tables
from eomgen.chart.front import milliseconds, recommended, sentence
from eomgen.chart.records import Chart, Point, Sweep
from eomgen.errors import CheckError, UsageError
from eomgen.simulate_setup import inputs_of
from eomgen.spec import read
from eomgen.study import Study

KEY = "simulate:"
OURS = re.compile(r"^simulate: \{method: [a-z0-9-]+, step: [0-9.e+-]+ s(, formulation: [a-z]+)?\}$")


def sweep(wishes: dict[str, Any]) -> Sweep:
    """The sweep that the options describe."""
    return Sweep(
        target=wishes["target_error"],
        budget=wishes["budget_us"],
        horizon=wishes["horizon"],
        formulations=wishes["formulations"],
        integrators=wishes["integrators"],
        precisions=wishes["precisions"],
        steps=wishes["steps"],
        seconds=wishes["seconds"],
    )


def made(study: Study, wanted: Sweep, state: str, inputs: Sequence[str]) -> Chart:
    """The chart; raises as `make.chart`."""
    return make.chart(study, wanted, state, inputs_of(inputs))


def texts(found: Chart) -> dict[str, str]:
    """File name -> text."""
    return {
        "chart.json": tables.as_json(found),
        "chart.csv": tables.as_csv(found),
        "chart.md": tables.as_markdown(found),
        "chart.tex": page.as_latex(found),
    }


def write(found: Chart, folder: Path, *, force: bool) -> Iterator[Path]:
    """Every file of the chart; the tables even where the pictures cannot be drawn.

    Raises:
        UsageError: files are in the way that are no chart of ours, or matplotlib is missing.
    """
    tabled = texts(found)
    names = [*tabled, "chart.svg", "chart.png"]
    taken = [str(folder / name) for name in names if (folder / name).exists()]
    if taken and not force and not _is_ours(folder):
        raise UsageError(f"{', '.join(taken)}: in the way; choose another folder, or --force")
    yield from files.write_all(folder, tabled, force=True)
    for kind, data in draw.drawn(found).items():
        path = folder / f"chart.{kind}"
        path.write_bytes(data)
        yield path


def _is_ours(folder: Path) -> bool:
    """Whether a chart of ours lies in the folder."""
    try:
        return bool(json.loads((folder / "chart.json").read_text(encoding="utf-8"))["eomgen"])
    except (OSError, ValueError, KeyError, TypeError):
        return False


def words(found: Chart) -> Iterator[str]:
    """What is said at the end."""
    yield from found.remarks
    failed = len(found.points) - len(found.good)
    yield f"{len(found.points)} runs, {failed} of them failed or left out; listed in chart.md"
    yield sentence(found)


def line(point: Point) -> str:
    """The recommendation as the spec states it."""
    return (
        f"{KEY} {{method: {point.run.integrator}, step: {point.run.step!r} s, "
        f"formulation: {point.run.formulation}}}"
    )


def apply(found: Chart, spec: Path) -> str:
    """Write the recommendation into the spec: at its end, or over the line that was ours.

    Raises:
        CheckError: nothing is recommended.
        UsageError: the spec has a `simulate` of its own.
    """
    best = recommended(found)
    if best is None:
        raise CheckError("no run meets the target, so nothing was written into the spec")
    text = files.read(str(spec)).decode()
    lines = text.split("\n")
    own = [i for i, row in enumerate(lines) if row.startswith(KEY)]
    if own and not OURS.match(lines[own[0]].rstrip("\r")):
        raise UsageError(f"{spec}:{own[0] + 1}: has a 'simulate' of its own; edit or remove it")
    if own:
        lines[own[0]] = line(best)
        new = "\n".join(lines)
    else:
        new = text + ("" if text.endswith("\n") else "\n") + line(best) + "\n"
    read(new, str(spec))  # it must still be a spec
    files.put({spec: new})
    return f"{spec}: simulate with {best.run.name}, h = {milliseconds(best.run.step)}"
