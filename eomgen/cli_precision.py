"""`check --precision`: the measurement behind the summary of a spec."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from eomgen.precision.records import Report
    from eomgen.study import Study


def measured(study: Study, summary: str, format_: str) -> str:
    """The summary of a spec with the precision of its code, as asked.

    Raises:
        CheckError: the code cannot be measured, or is not what was derived.
    """
    from eomgen.precision import measure

    return FORMATS[format_](summary, measure.of(study))


def _text(summary: str, report: Report) -> str:
    from eomgen.precision import show

    lines = show.text(report).splitlines()
    return "\n".join([summary, *(f"    {line}".rstrip() for line in lines)])


def _json(summary: str, report: Report) -> str:
    from eomgen.precision import show

    return json.dumps({**json.loads(summary), "precision": show.json_of(report)})


def _github(summary: str, report: Report) -> str:
    """The warnings as annotations of the same file."""
    from eomgen.spec.report import escaped

    head, *_ = summary.split("::notice ", 1)[1].split("::", 1)
    return "\n".join([summary, *(f"::warning {head}::{escaped(w)}" for w in report.warnings)])


FORMATS = {"text": _text, "json": _json, "github": _github}
