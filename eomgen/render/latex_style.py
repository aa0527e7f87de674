r"""The page in LaTeX: align* rows, bmatrix, \partial, breaks after about a line's width."""

from __future__ import annotations

import re
from collections.abc import Sequence

from eomgen.model import Model
from eomgen.render import latex_names, layout
from eomgen.render.latex import bracketed, latex
from eomgen.render.latex_text import escaped, unit
from eomgen.render.latex_width import width
from eomgen.render.style import Rows, Style

LINE = 80.0  # figures of a line, its left side included
NUMBER = 5.0  # figures that the number of an equation takes
GAP = 4.0  # figures between two columns of equations
FIXED = {"left": r"\Bigl", "right": r"\Bigr"}
BLANK = r"\,"


def style(model: Model) -> Style:
    """How LaTeX spells the page of a model."""
    names = latex_names.table(model)
    return Style(
        formula=lambda tree: latex(tree, names),
        symbol=lambda name: names.get(name) or latex_names.unknown(name),
        words=escaped,
        unit=unit,
        inline=lambda formula: f"${formula}$",
        number=_number,
        index=lambda letter, *of: f"{letter}_{{{','.join(_index(n) for n in of)}}}",
        sub=lambda letter, symbol: f"{letter}_{{{symbol}}}",
        dotted=lambda name: latex_names.dotted(name, 1),
        accelerated=lambda name: latex_names.dotted(name, 2),
        after=lambda rate: f"{{{rate}}}^+",
        before=lambda rate: f"{{{rate}}}^-",
        size=lambda name: rf"\left|{name}\right|",
        sign=lambda name: rf"\operatorname{{sgn}}({name})",
        fraction=lambda above, below: rf"\frac{{{above}}}{{{below}}}",
        partial=lambda what, by: rf"\frac{{\partial {what}}}{{\partial {by}}}",
        gyroscopic=gyroscopic,
        rate=lambda what: rf"\frac{{d}}{{dt}} {bracketed(what)}",
        display=display,
        pairs=pairs,
        equation=equation,
        at_least=lambda left, right: relation(rf"{left} \ge {right}"),
        matrix=matrix,
        fits=lambda rows: matrix_width(rows) <= LINE - GAP,
        remark=lambda text: rf"\text{{{escaped(text)}}}",
    )


def _number(text: str) -> str:
    """1.5e-9 as a power of ten."""
    mantissa, mark, exponent = text.partition("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}" if mark else mantissa


def _index(name: str) -> str:
    """A body's or a point's name as an index: A, an upright word."""
    plain = re.fullmatch(r"[A-Za-z]\d*", name)
    if plain:
        return latex_names.spelled(name)
    words = (escaped(part) for part in re.split(r"[\s_]+", name))
    return rf"\mathrm{{{BLANK.join(words)}}}"


def gyroscopic(name: str, axis: str) -> str:
    """The component of w x dL/dw about an axis of the turned frame."""
    omega = rf"\boldsymbol{{\omega}}_{{{latex_names.spelled(name)}}}"
    return rf"\left({omega} \times \frac{{\partial L}}{{\partial {omega}}}\right)_{{{axis}}}"


def display(rows: Rows) -> str:
    """Rows for align*, a formula longer than a line going on below."""
    spelled = []
    indent = max((width(left) for left, _ in rows), default=0.0) + 2.5
    for left, right in rows:
        first, *rest = broken(right, LINE - indent)
        spelled.append(f"{left} &= {first}")
        spelled += [rf"&\quad {line}" for line in rest]
    return " \\\\\n".join(spelled)


def broken(formula: str, limit: float) -> list[str]:
    r"""Lines of a formula; \left( gives way to \Bigl( where a bracket must be broken."""
    found = layout.lines(formula, limit, width)
    if all(width(line) <= limit for line in found):
        return found
    loose = re.sub(r"\\(left|right)([()|])", lambda m: FIXED[m[1]] + m[2], formula)
    return layout.lines(loose, limit, width)


def pairs(rows: Sequence[Rows]) -> str:
    """Rows of one or two equations, beside each other where all of them fit."""
    columns = [[row[i] for row in rows if len(row) > i] for i in (0, 1)]
    wide = [max((width(e[side]) for e in c), default=0.0) for c in columns for side in (0, 1)]
    if sum(wide) + 5.0 + GAP > LINE:
        return display([equation for row in rows for equation in row])
    beside = (" & ".join(f"{left} &= {right}" for left, right in row) for row in rows)
    return " \\\\\n".join(beside)


def equation(left: str, right: str) -> str:
    """Rows of one numbered equation: left = right, broken in its left side or between both."""
    found = layout.equation(left, right, _fitting, is_long=width(left) > LINE / 3)
    return _aligned(found)


def relation(whole: str) -> str:
    """Rows of one relation, aligned at their left."""
    return _aligned(_fitting(whole))


def _fitting(formula: str) -> list[str]:
    """Lines that leave room for the number of an equation."""
    return broken(formula, LINE - NUMBER)


def _aligned(lines: Sequence[str]) -> str:
    first, *rest = lines
    # behind & TeX takes a minus for one between two terms
    first = re.sub("^-", "{-}", first)
    spelled = [f"& {first}", *(rf"&\quad {line}" for line in rest)]
    return " \\notag \\\\\n".join(spelled)


def matrix(rows: Sequence[Sequence[str]]) -> str:
    """The rows in square brackets."""
    inside = " \\\\\n".join(" & ".join(row) for row in rows)
    return f"\\begin{{bmatrix}}\n{inside}\n\\end{{bmatrix}}"


def matrix_width(rows: Sequence[Sequence[str]]) -> float:
    """About how many characters wide the matrix is printed."""
    columns = zip(*rows, strict=True)
    return sum(max(width(entry) for entry in column) + 2 for column in columns)
