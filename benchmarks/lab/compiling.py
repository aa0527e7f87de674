"""How long gcc -O2 takes for our C of a spatial chain."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage

from lab.derivation import exponent
from lab.ours import Missing, files
from lab.spec_text import spec
from lab.trees import skew_arm

COUNTS = (10, 20, 30, 40, 60)
LIMIT = 300  # seconds
COMMAND = ("gcc", "-std=c99", "-O2", "-c", "scene.c")


def measured(folder: Path, missing: list[str]) -> dict[int, float]:
    """Joints -> processor seconds of the compiler."""
    found: dict[int, float] = {}
    for count in COUNTS:
        try:
            made = files(spec(skew_arm(count)), ())
            found[count] = _seconds(made, folder / f"chain_{count}")
        except (Missing, subprocess.TimeoutExpired) as reason:
            missing.append(f"compile time, {count} joints: {reason}")
            break
    return found


def _seconds(made: dict[str, str], folder: Path) -> float:
    if folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)
    for name, text in made.items():
        (folder / name).write_text(text, encoding="utf-8")
    before = getrusage(RUSAGE_CHILDREN).ru_utime
    subprocess.run(COMMAND, cwd=folder, check=True, timeout=LIMIT)
    return getrusage(RUSAGE_CHILDREN).ru_utime - before


def table(times: dict[int, float]) -> list[str]:
    """One line of seconds and the fitted exponent."""
    if not times:
        return ["Nothing of ours could be compiled."]
    fitted = exponent([(float(n), t) for n, t in times.items()])
    return [
        f"| joints | {' | '.join(map(str, times))} | exponent |",
        "|---" * (len(times) + 2) + "|",
        f"| `{' '.join(COMMAND)}`, s | {' | '.join(f'{t:.2f}' for t in times.values())} | "
        f"{'-' if fitted is None else f'{fitted:.2f}'} |",
    ]
