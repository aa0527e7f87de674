"""Ours against SymPy's own mechanics, in one run, as ratios: `python benchmarks/derivation.py`.

Writes benchmarks/derivation.md. Times are medians of interleaved repeats; only the ratios mean
anything, the machine is named so that they can be judged.
"""

from __future__ import annotations

import os
import platform
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import perf_counter

from scenes import cart_with_pendulums, lagranges_method
from sympy.core.cache import clear_cache
from sympy.physics.mechanics.models import n_link_pendulum_on_cart

from eomgen.mechanics import lagrange
from eomgen.spec import read
from eomgen.study import of_text

HERE = Path(__file__).parent
EOMGEN = [sys.executable, "-m", "eomgen.cli"]
SPEC = HERE.parent / "specs" / "slider_pendulum.yaml"


def seconds(action: Callable[[], object]) -> float:
    """Wall time of one call, with SymPy's cache empty as in a fresh process."""
    clear_cache()
    start = perf_counter()
    action()
    return perf_counter() - start


def run(command: list[str]) -> Callable[[], object]:
    """A whole process, its output thrown away."""
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": ""}
    return lambda: subprocess.run(command, check=True, capture_output=True, env=environment)


def medians(actions: dict[str, Callable[[], object]], repeats: int) -> dict[str, float]:
    """The median time of each action, the actions taking turns after one warm-up."""
    for action in actions.values():
        action()
    times: dict[str, list[float]] = {name: [] for name in actions}
    for _ in range(repeats):
        for name, action in actions.items():
            times[name].append(seconds(action))
    return {name: statistics.median(found) for name, found in times.items()}


def processes(folder: str) -> dict[str, float]:
    """Whole commands against the import that SymPy's mechanics costs."""
    python = [sys.executable, "-c"]
    return medians(
        {
            "import": run([*python, "import sympy.physics.mechanics"]),
            "generate": run([*EOMGEN, "generate", str(SPEC), "-o", folder]),
            "help": run([*EOMGEN, "--help"]),
        },
        7,
    )


def derivations(count: int) -> dict[str, float]:
    """Cart with pendulums: fully reduced by us, unsimplified by SymPy."""
    text = cart_with_pendulums(count)
    model = read(text, "cart.yaml")
    return medians(
        {
            "ours": lambda: lagrange.derive(model),
            "read": lambda: lagrange.derive(read(text, "cart.yaml")),
            "checked": lambda: of_text(text, "cart.yaml"),
            "kane": lambda: n_link_pendulum_on_cart(count, cart_force=True),
            "lagrange": lambda: lagranges_method(count),
        },
        5,
    )


def report() -> str:
    """The result tables in Markdown."""
    with tempfile.TemporaryDirectory() as folder:
        whole = processes(folder)
    rows = [
        "# Derivation: ours against SymPy's mechanics",
        "",
        f"{platform.machine()}, Python {platform.python_version()}, {os.cpu_count()} cores; "
        "medians of interleaved repeats. Trust the ratios.",
        "",
        "| whole process | s | ratio to the import |",
        "|---|---|---|",
        *(f"| {name} | {t:.3f} | {t / whole['import']:.2f} |" for name, t in whole.items()),
        "",
        "`import` is a bare `import sympy.physics.mechanics`; `generate` writes notes, C and",
        "Python of the slider with pendulum, all checks included.",
        "",
        "| cart with n pendulums | ours, reduced [s] | with reading the spec [s] | with all checks"
        " and the program [s] | KanesMethod [s] | LagrangesMethod [s] | Kane / ours |"
        " Lagrange / ours |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for count in (2, 4, 8):
        t = derivations(count)
        rows.append(
            f"| {count} | {t['ours']:.4f} | {t['read']:.4f} | {t['checked']:.4f} | "
            f"{t['kane']:.3f} | {t['lagrange']:.3f} | {t['kane'] / t['ours']:.0f} | "
            f"{t['lagrange'] / t['ours']:.0f} |"
        )
    rows += [
        "",
        "Ours is fully reduced (canonical normal form); SymPy's equations are formed and left.",
    ]
    return "\n".join(rows) + "\n"


if __name__ == "__main__":
    text = report()
    (HERE / "derivation.md").write_text(text, encoding="utf-8")
    print(text)
