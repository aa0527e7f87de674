"""The measurement in words, and as JSON has it."""

from __future__ import annotations

from typing import Any

from eomgen.precision.records import FunctionErrors, Report, Spread, StatementErrors

MOST_NUMBERS = 8  # of a state in words
HEADER = ("function", "float worst", "median", "double worst", "median", "condition")


def text(report: Report) -> str:
    """The table of functions, the worst statements with their states, warnings."""
    lines = [_said(report), "", *_table([HEADER, *map(_row, report.functions)])]
    lines += _notes(report)
    lines += ["", f"largest local errors in float, lines of {report.file}"]
    for number, each in enumerate(report.statements, 1):
        lines += _statement(report, number, each)
    return "\n".join([*lines, *_after_a_gap(report.warnings)])


def _after_a_gap(lines: tuple[str, ...]) -> tuple[str, ...]:
    return ("", *lines) if lines else ()


def _said(report: Report) -> str:
    count, wanted = report.sampled.count, report.sampled.wanted
    few = "" if count == wanted else f" (of {wanted} wanted)"
    return f"precision: {report.engine} against 50 digits at {count} states{few}"


def _row(row: FunctionErrors) -> tuple[str, ...]:
    name = row.name + (" (absolute)" if row.absolute else "")
    spreads = [row.spreads[kind] for kind in ("float", "double")]
    cells = [f"{v:.1e}" for s in spreads for v in (s.worst, s.median)]
    return (name, *cells, "" if row.absolute else f"{row.condition:.1e}")


def _table(rows: list[tuple[str, ...]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        "  ".join(
            c.ljust(w) if i == 0 else c.rjust(w)
            for i, (c, w) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def _notes(report: Report) -> list[str]:
    """What the table cannot say."""
    lines = []
    if report.condition is not None:
        lines.append(
            f"condition of the mass matrix, scaled to ones on its diagonal: {report.condition:.1e}"
        )
    for row in report.functions:
        undefined = report.sampled.count - row.states
        if undefined:
            lines.append(f"{row.name} is not defined at {undefined} of the states")
        for kind, spread in row.spreads.items():
            if spread.failed:
                lines.append(f"{row.name} has no value in {kind} at {spread.failed} states more")
    return lines


def _statement(report: Report, number: int, each: StatementErrors) -> list[str]:
    places = ", ".join(each.functions)
    where = _state(report, each.at)
    return [
        f"{number:>2}. {each.worst:.1e} (median {each.median:.1e}, {each.amplification:.0f} eps) "
        f"in {places}",
        f"      {each.line}: {each.source}",
        f"      at {where}" if each.functions != ("prepare",) else "      of the parameters alone",
    ]


def _state(report: Report, at: int) -> str:
    numbers = [f"{name} = {value:.6g}" for name, value in _numbers(report, at).items()]
    more = len(numbers) - MOST_NUMBERS
    shown = ", ".join(numbers[:MOST_NUMBERS])
    return f"{shown}, ... ({more} more)" if more > 0 else shown


def _numbers(report: Report, at: int) -> dict[str, float]:
    """Everything that a state is, by name."""
    sampled = report.sampled
    values = [*sampled.state[:, at], *sampled.inputs[:, at]]
    names = report.names + report.inputs
    if report.timed:
        names, values = (*names, "t"), [*values, sampled.time[at]]
    return dict(zip(names, map(float, values), strict=True))


def json_of(report: Report) -> dict[str, Any]:
    """The same as a JSON object."""
    return {
        "engine": report.engine,
        "states": report.sampled.count,
        "states_wanted": report.sampled.wanted,
        "condition_of_mass_matrix": report.condition,
        "functions": [_function_json(report, row) for row in report.functions],
        "file": report.file,
        "statements": [_statement_json(report, each) for each in report.statements],
        "warnings": list(report.warnings),
    }


def _function_json(report: Report, row: FunctionErrors) -> dict[str, Any]:
    spreads = {kind: _spread_json(report, s) for kind, s in row.spreads.items()}
    condition = None if row.absolute else row.condition
    return {
        "name": row.name, "states": row.states, "absolute": row.absolute,
        "condition": condition, **spreads,
    }  # fmt: skip


def _spread_json(report: Report, spread: Spread) -> dict[str, Any]:
    return {
        "worst": spread.worst,
        "median": spread.median,
        "failed": spread.failed,
        "at": _numbers(report, spread.at),
    }


def _statement_json(report: Report, each: StatementErrors) -> dict[str, Any]:
    return {
        "functions": list(each.functions),
        "line": each.line,
        "source": each.source,
        "worst": each.worst,
        "median": each.median,
        "at": _numbers(report, each.at),
    }
