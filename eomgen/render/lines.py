"""Lines of text for templates: records laid out by patterns, broken at spaces where too long.

A template states what a line looks like, such as `const double %(name)s = %(expression)s;`; the
loop over thousands of statements runs here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

WIDTH = 100


def wrap(text: str, indent: int = 0, hanging: int = 4, width: int = WIDTH) -> str:
    """`text` broken at spaces; each line after the first starts `hanging` further right."""
    left, further = " " * indent, " " * (indent + hanging)
    if len(text) + indent <= width and "\n" not in text:
        return left + text
    lines, line = [], left
    for word in text.split():
        if len(line) + len(word) > width and line.strip():
            lines.append(line.rstrip())
            line = further
        line += word + " "
    return "\n".join([*lines, line.rstrip()])


def rows(
    items: Iterable[Any], pattern: str, indent: int, hanging: int = 4, width: int = WIDTH
) -> str:
    """A line for each item, a tuple or text, in the place of each `%s` of the pattern."""
    return "".join([wrap(pattern % item, indent, hanging, width) + "\n" for item in items])


def named(items: Iterable[Any], patterns: Mapping[str, str], kind: str, indent: int) -> str:
    """A line for each record, by the pattern of its field `kind`, never broken."""
    left, fields = " " * indent, map(vars, items)
    return "".join([f"{left}{patterns[each[kind]] % each}\n" for each in fields])


Macro = Callable[[Any], str]


def statements(
    items: Iterable[Any], patterns: Mapping[str, Sequence[str]], otherwise: Macro, indent: int
) -> str:
    """Each record by the lines of its `kind`, or by the macro `otherwise` where it has none."""
    left, made = " " * indent, []
    for each in items:
        for pattern in patterns.get(each.kind, ()):
            text = pattern % vars(each)
            fits = len(text) + indent <= WIDTH
            made.append(left + text if fits else wrap(text, indent))
            made.append("\n")
        if each.kind not in patterns:
            made.append(otherwise(each))
    return "".join(made)


def short_statements(
    items: Iterable[Any], patterns: Mapping[str, str], otherwise: Macro, indent: int, width: int
) -> str:
    """Each record by the line of its `kind`; by `otherwise` where it has none, or it is longer."""
    left, made = " " * indent, []
    for each in items:
        pattern = patterns.get(each.kind)
        line = left + pattern % vars(each) if pattern else ""
        made.append(f"{line}\n" if line and len(line) <= width else otherwise(each))
    return "".join(made)
