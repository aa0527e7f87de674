r"""The page in LaTeX: align* rows, bmatrix, \partial, breaks after about a line's width."""

from __future__ import annotations

import re
from collections.abc import Sequence

from eomgen.model import Model
from eomgen.render import latex_names, layout
from eomgen.render.latex import bracketed, latex
from eomgen.render.latex_text import escaped, unit
from eomgen.render.style import Rows, Style

LINE = 88.0  # printed characters of a line, its left side included
WIDEST = 78.0  # of a matrix

WRAPPED = re.compile(r"\\(?:d?dot|mathrm|mathbf|bar|hat|vec|tilde|text|boldsymbol)\{([^{}]*)\}")
SCRIPT = re.compile(r"[_^](?:\{([^{}]*)\}|(\\[A-Za-z]+|.))")
FRACTION = re.compile(r"\\[td]?frac(?:\{([^{}]*)\}\{([^{}]*)\}|(\d)(\d))")
ROOT = re.compile(r"\\sqrt\{([^{}]*)\}")
BLANK = r"\,"
MACRO = re.compile(r"\\(?:left|right|quad|,)")


def width(formula: str) -> float:
    """About how many characters wide the formula is printed."""
    scripts = 0.0
    previous = ""
    while previous != formula:
        previous = formula
        formula = WRAPPED.sub(r"\1", formula)
        formula = FRACTION.sub(_wider, formula)
        formula = ROOT.sub(r"x\1", formula)
        found = SCRIPT.search(formula)
        if found and not set(found.group(1) or "") & {"\\"}:
            scripts += 0.65 * _characters(found.group(1) or found.group(2))
            formula = formula[: found.start()] + formula[found.end() :]
    return scripts + _characters(formula)


def _wider(found: re.Match[str]) -> str:
    return max((g for g in found.groups() if g is not None), key=_characters)


def _characters(text: str) -> float:
    """Letters and figures, wide signs with their gaps; blanks are not printed."""
    plain = MACRO.sub("", text)
    plain = re.sub(r"\\(sin|cos|tan|ln|min|max|sgn|arc\w+)", "fun", plain)
    plain = re.sub(r"\\[A-Za-z]+", "x", plain)
    signs = sum(plain.count(sign) for sign in (" + ", " - ", "="))
    return len(re.sub(r"[\s{}&\\]", "", plain)) + 1.2 * signs


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
        partial=lambda what, by: rf"\frac{{\partial {what}}}{{\partial {by}}}",
        rate=lambda what: rf"\frac{{d}}{{dt}} {bracketed(what)}",
        display=display,
        equation=equation,
        matrix=matrix,
        fits=lambda rows: matrix_width(rows) <= WIDEST,
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


def display(rows: Rows) -> str:
    """Rows for align*, a formula longer than a line going on below."""
    spelled = []
    for left, right in rows:
        indent = width(left)
        first, *rest = layout.lines(right, LINE - indent, width)
        spelled.append(f"{left} &= {first}")
        spelled += [rf"&\quad {line}" for line in rest]
    return " \\\\\n".join(spelled)


def equation(left: str, right: str) -> str:
    """Rows of one numbered equation: left = right, broken in its left side."""
    first, *rest = layout.lines(f"{left} = {right}", LINE, width)
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
