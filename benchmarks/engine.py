"""The engine against its peers, in one run: `python benchmarks/engine.py`.

Writes benchmarks/engine.md and benchmarks/engine.svg: how long it takes from a scene to C text,
what a call of that C costs, and how long it compiles. The peers are SymPy's KanesMethod, SymEngine,
CasADi, Pinocchio, MuJoCo and PyDy; those that are not installed are named and left out.
With --build FOLDER compiled libraries are kept for the next run; with --only the other parts are
not measured, and nothing is written.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import platform
import tempfile
from pathlib import Path

from lab import compiling, derivation, forward, picture

HERE = Path(__file__).parent
PEERS = ("sympy", "symengine", "casadi", "pinocchio", "mujoco", "pydy", "matplotlib")
PARTS = ("forward", "derivation", "compiling")
NEEDED = ("casadi",)  # the results of all others are compared with its results


def machine() -> str:
    """What the numbers were measured on."""
    return (
        f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}; "
        "trust the ratios."
    )


def report(folder: Path, parts: tuple[str, ...]) -> str:
    """The tables in Markdown; writes the plot where all parts are measured."""
    missing = [f"{name} is not installed" for name in PEERS if not importlib.util.find_spec(name)]
    columns = forward.measured(folder, missing) if "forward" in parts else {}
    times = derivation.measured(missing) if "derivation" in parts else {}
    compiled = compiling.measured(folder, missing) if "compiling" in parts else {}
    if parts == PARTS:
        picture.draw(times, columns, compiled, HERE / "engine.svg")
    worst = max((c.worst for c in columns.values()), default=0.0)
    lines = ["# The engine against its peers", "", machine(), "", "![plot](engine.svg)", ""]
    if columns:
        lines += ["## Forward dynamics in compiled code", "", FORWARD.format(worst=worst), ""]
        lines += [*forward.table(columns), "", *forward.winners(columns), ""]
    if times:
        lines += ["## From a scene to C text", "", DERIVATION, "", *derivation.table(times)]
    if compiled:
        lines += ["## Compiling", "", COMPILING, "", *compiling.table(compiled), ""]
    lines += ["## What is not in the tables", "", *(f"* {m}" for m in missing)]
    return "\n".join(lines) + "\n"


FORWARD = """\
Nanoseconds a call from a C loop over the same 64 random states: the least of interleaved runs in
random order, over every way to write it and every compiler (`gcc -O3 -march=native`, `gcc -O2`,
`clang -O3 -march=native`). All results agree to {worst:.0e} of the largest acceleration of a state
(asserted: 1e-11). The arms have joint axes z, y, x in turn, or axes parallel to nothing, and full
inertias; the tree is a free body (three slides, three turns) with four legs of six joints. A batch
is 64 states; its time is that of one, and its sines are its own, with and without `fast trig`.
Limbs that are alike fill the vectors of a single state too, so a batch gains less on the tree;
`limb after limb` is the code of one state without such vectors, which stands in the same file as
the batch. `AVX2`: without the wider vectors that `native` may have."""
DERIVATION = """\
Processor seconds, the least of up to three, of ours and CasADi's also of some rounds. Ours and
CasADi's end with the C of the accelerations (solution included), SymPy's and SymEngine's with the C
of M and f after `cse`. `ours, checked` starts from the text of the spec and makes every check that
the command line makes. A dash: not within two minutes. Exponents are fitted from n = 25 on.
Statements are those of the text; the cart's, solved for the tensions of its rods, is first cut into
parts at n = 100, and values that cross these are statements too."""
COMPILING = "All functions of our C of the skew arm, parameters not folded."


def main() -> None:
    """Measure, write, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=Path, help="folder for libraries, kept")
    parser.add_argument("--only", choices=PARTS, help="measure one part")
    chosen = parser.parse_args()
    if absent := [name for name in NEEDED if not importlib.util.find_spec(name)]:
        parser.error(f"needs {', '.join(absent)}; install it beside eomgen")
    with tempfile.TemporaryDirectory() as temporary:
        folder = chosen.build or Path(temporary)
        text = report(folder, (chosen.only,) if chosen.only else PARTS)
    if chosen.only is None:
        (HERE / "engine.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
