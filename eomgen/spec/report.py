"""Faults as text for people, JSON for programs, and annotations for GitHub."""

import json
import unicodedata
from collections.abc import Callable, Iterable

from eomgen.errors import Fault

Faults = Iterable[Fault]
WIDEST = 160  # characters of a source line that are shown


def render(faults: Faults, format: str) -> str:
    """The faults as `text`, `json` or `github`."""
    return FORMATS[format](faults)


def text(faults: Faults) -> str:
    """One block for each fault: place and message, the line, a caret below."""
    return "\n".join(_block(fault) for fault in faults)


def _block(fault: Fault) -> str:
    place = f"{fault.location.file}:{fault.location.line}:{fault.location.column}"
    hint = f"; {fault.hint}" if fault.hint else ""
    head = f"{place}: error {fault.code}: {fault.message}{hint}"
    if not fault.source.strip():
        return _visible(head)
    source, column = _cut(fault.source, fault.location.column - 1)
    margin = "".join("\t" if c == "\t" else " " * _width(c) for c in source[:column])
    return f"{_visible(head)}\n    {_visible(source)}\n    {margin}^"


def _cut(source: str, column: int) -> tuple[str, int]:
    """The part of a long line that holds the column, and the column in it."""
    start = max(0, column - WIDEST // 2) if len(source) > WIDEST else 0
    return source[start : start + WIDEST], min(column - start, WIDEST)


def _width(character: str) -> int:
    if unicodedata.combining(character):
        return 0
    return 2 if unicodedata.east_asian_width(character) in "WF" else 1


def _visible(line: str) -> str:
    """No control character of a stranger's file reaches the terminal."""
    return "".join(c if c.isprintable() or c == "\t" else "\ufffd" for c in line)


def as_json(faults: Faults) -> str:
    """A list of objects, one for each fault."""
    rows = [
        {
            "file": fault.location.file,
            "line": fault.location.line,
            "column": fault.location.column,
            "code": fault.code,
            "message": fault.message,
            "hint": fault.hint,
            "source": fault.source,
        }
        for fault in faults
    ]
    return json.dumps(rows, indent=2, ensure_ascii=True)


def github(faults: Faults) -> str:
    """Workflow commands that annotate the lines of a pull request."""
    return "\n".join(_command(fault) for fault in faults)


def _command(fault: Fault) -> str:
    hint = f"; {fault.hint}" if fault.hint else ""
    properties = {
        "file": fault.location.file,
        "line": str(fault.location.line),
        "col": str(fault.location.column),
        "title": fault.code,
    }
    listed = ",".join(f"{key}={escaped(value, ':,')}" for key, value in properties.items())
    return f"::error {listed}::{escaped(fault.message + hint)}"


def escaped(text: str, also: str = "") -> str:
    """Percent-encoding of what would end a command or a property."""
    return "".join(f"%{ord(c):02X}" if c in "%\r\n" + also else c for c in text)


FORMATS: dict[str, Callable[[Faults], str]] = {"text": text, "json": as_json, "github": github}
