"""What other forms of sums, roots and arcs are worth: errors in float, and operations.

One command: python benchmarks/precision.py [-o FILE]. The expressions are those of
`tests/cancelling.py`; scenes are those of `specs/`.
"""

from __future__ import annotations

import argparse
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

import cancelling  # noqa: E402
from scenes import SHIPPED, program_of  # noqa: E402

from eomgen.algebra import cancellation, half_angles  # noqa: E402
from eomgen.render.code_context import coded  # noqa: E402
from eomgen.render.lowered import lower, operations  # noqa: E402

OPTION = (
    ("as it stands", lambda x, y, a: np.sqrt(x * x + y * y) - a),
    ("(x^2 + y^2 - a^2)/(r + a)", lambda x, y, a: (x * x + y * y - a * a) / (np.hypot(x, y) + a)),
    ("((x - a)(x + a) + y^2)/(r + a)", lambda x, y, a: _along(x, y, a)),
)
PLACES = {"along x": 0.0, "5 degrees off": 5.0, "45 degrees off": 45.0}


def _along(x, y, a):
    return ((x - a) * (x + a) + y * y) / (np.hypot(x, y) + a)


class Context:
    """Stands for pytest's monkeypatch: the rules are switched off inside."""

    @contextmanager
    def context(self):
        """What is set inside is set back."""
        before = cancellation.builders, half_angles.replaced
        yield self
        cancellation.builders, half_angles.replaced = before

    def setattr(self, where, name, value):
        """As setattr."""
        setattr(where, name, value)


def expressions() -> list[str]:
    """Worst relative error in float near the cancellation, and operations, before and after."""
    lines = [
        "| expression | near (x, y) | error before | after | operations before | after |",
        "|---|---|---|---|---|---|",
    ]
    for name, case in cancelling.CASES.items():
        of = cancelling.program(case)
        forms = cancelling.plainly(of, Context()), cancelling.written(of)
        errors = [max(cancelling.error(form, s) for s in case.near) for form in forms]
        before, after = (f"{min(1.0, e * cancelling.EPSILON):.0e}" for e in errors)
        counts = " | ".join(_counted(form) for form in forms)
        near = ", ".join(f"({x:.6g}, {y:.6g})" for x, y in case.near)
        lines.append(f"| `{name}` | {near} | {before} | {after} | {counts} |")
    return lines


def _counted(form) -> str:
    found = cancelling.applied(form)
    waves = {n: c for n, c in found.items() if n not in ("add", "subtract", "multiply", "negate")}
    plain = sum(found.values()) - sum(waves.values())
    return ", ".join([f"{plain} + - *", *(f"{c} {n}" for n, c in sorted(waves.items()))])


def springs() -> list[str]:
    """Error of a length less its natural length a, relative to it, 1e-4 a beyond a, in float."""
    rows = [name for name, _ in OPTION]
    lines = [
        "| r - a, r^2 = x^2 + y^2 | " + " | ".join(PLACES) + " |",
        "|---|" + "---|" * len(PLACES),
    ]
    for name, form in zip(rows, (form for _, form in OPTION), strict=True):
        cells = " | ".join(f"{_spring(form, degrees):.0e}" for degrees in PLACES.values())
        lines.append(f"| `{name}` | {cells} |")
    return lines


def _spring(form, degrees: float) -> float:
    """The median over states near the natural length."""
    a = np.float32(0.5)
    stretched = 0.5 * (1 + 1e-4 * np.linspace(0.5, 1.5, 201))
    angle = np.radians(degrees)
    x = (stretched * np.cos(angle)).astype(np.float32)
    y = (stretched * np.sin(angle)).astype(np.float32)
    truth = np.hypot(x.astype(np.longdouble), y.astype(np.longdouble)) - 0.5
    return float(np.median(np.abs((form(x, y, a) - truth) / truth)))


def scenes() -> list[str]:
    """Operations of all functions of a shipped scene, before and after."""
    lines = ["| scene | before | after |", "|---|---|---|"]
    same = []
    for name in SHIPPED:
        of = program_of(name)
        with Context().context():
            cancellation.builders = lambda inner, fixed, positive: inner
            half_angles.replaced = lambda nodes, build, products: None
            before = _all(coded(of).program)
        after = _all(coded(of).program)
        if before == after:
            same.append(name)
        else:
            lines.append(f"| {name} | {before} | {after} |")
    return [*lines, "", f"The same as before: {', '.join(same)}."]


def _all(program) -> int:
    return sum(sum(operations(lower(f)).values()) for f in program.functions)


def table() -> list[str]:
    """The rules on sums."""
    lines = ["| pattern | written as | why |", "|---|---|---|"]
    return lines + [f"| `{r.pattern}` | `{r.rewrite}` | {r.reason} |" for r in cancellation.RULES]


PAGE = {
    "The rules on sums": table,
    "Expressions: error in float near the cancellation, operations": expressions,
    "A spring in the plane: what pays": springs,
    "Operations of shipped scenes": scenes,
}
NOTES = {
    "The rules on sums": """\
Roots and arcs: `sqrt(x^2)` is `|x|`; `sqrt(a^2 - b^2)` is `sqrt((a - b)(a + b))`; `acos` and `asin`
of a ratio are `atan2` of its sides, and the angle of a triangle by its sides is Kahan's half angle.
In a rotation about a skew axis 1 - cos(x) stays: beside sin(x) it loses nothing that counts.""",
    "A spring in the plane: what pays": """\
The second form gains nothing: its own difference loses the digits. The third keeps them only where
the spring lies nearly along x, and x itself is exact; joints compute it with a rounding that costs
as much. So a length is rewritten where a coordinate counts from the natural length, as in the table
above, and stays elsewhere: use such coordinates, or double.""",
}


def main() -> None:
    """Print the page, or write it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=Path)
    chosen = parser.parse_args()
    parts = ["# Digits kept in float, measured"]
    for title, made in PAGE.items():
        parts += ["", f"## {title}", "", *made()]
        parts += ["", NOTES[title]] if title in NOTES else []
    text = "\n".join(parts) + "\n"
    if chosen.output is None:
        print(text, end="")  # noqa: T201
    else:
        chosen.output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
