"""The page in plain text: one formula a line, long ones going on below their equals sign."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence

from eomgen.render import layout
from eomgen.render.style import Rows, Style
from eomgen.render.text import name, text

LINE = 96


def width(formula: str) -> float:
    """Columns of a terminal: combining marks take none, wide letters two."""
    wide = sum(unicodedata.east_asian_width(c) in "WF" for c in formula)
    return len(formula) + wide - sum(unicodedata.combining(c) > 0 for c in formula)


def printable(words: str) -> str:
    """A text of the user on one line, without control characters."""
    return " ".join("".join(c for c in words if c.isprintable() or c.isspace()).split())


def style() -> Style:
    """How plain text spells a page."""
    return Style(
        formula=text,
        symbol=name,
        words=printable,
        unit=printable,
        inline=str,
        number=str,
        index=lambda letter, *of: f"{letter}_{','.join(n.replace(' ', '_') for n in of)}",
        sub=lambda letter, symbol: f"{letter}_{symbol}",
        dotted=lambda name: f"{name}′",
        accelerated=lambda name: f"{name}″",
        after=lambda rate: f"{rate} (after)",
        before=lambda rate: f"{rate} (before)",
        size=lambda name: f"|{name}|",
        sign=lambda name: f"sign({name})",
        fraction=lambda above, below: f"{above}/{below}",
        partial=lambda what, by: f"∂{what}/∂{by}",
        gyroscopic=lambda name, axis: f"(ω_{name} × ∂L/∂ω_{name})_{axis}",
        rate=lambda what: f"d/dt({what})",
        display=display,
        pairs=lambda rows: display([equation for row in rows for equation in row]),
        equation=equation,
        at_least=lambda left, right: relation(f"{left} ≥ {right}"),
        matrix=matrix,
        fits=lambda rows: matrix_width(rows) <= LINE,
        remark=lambda words: f"({words})",
    )


def display(rows: Rows) -> str:
    """left = right, indented; what is too long goes on under the right side."""
    spelled = []
    for left, right in rows:
        indent = len(left) + 5
        first, *rest = layout.lines(right, max(LINE - indent, LINE / 2), width)
        spelled.append(f"  {left} = {first}")
        spelled += [" " * indent + line for line in rest]
    return "\n".join(spelled)


def equation(left: str, right: str) -> str:
    """One equation of motion, broken in its left side or between both."""
    found = layout.equation(left, right, _fitting, is_long=width(left) > LINE / 3)
    return _indented(found)


def relation(whole: str) -> str:
    """One relation, what is too long going on below."""
    return _indented(_fitting(whole))


def _fitting(formula: str) -> list[str]:
    return layout.lines(formula, LINE, width)


def _indented(lines: Sequence[str]) -> str:
    first, *rest = lines
    return "\n".join([f"  {first}", *(f"      {line}" for line in rest)])


def matrix(rows: Sequence[Sequence[str]]) -> str:
    """The rows between bars, in columns."""
    columns = [max(len(entry) for entry in column) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  [ " + "  ".join(e.ljust(w) for e, w in zip(row, columns, strict=True)) + " ]"
        for row in rows
    )


def matrix_width(rows: Sequence[Sequence[str]]) -> float:
    """Columns that the matrix takes."""
    return sum(max(len(e) for e in column) + 2 for column in zip(*rows, strict=True))
