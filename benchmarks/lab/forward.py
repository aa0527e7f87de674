"""Forward dynamics: every contestant on every column, equal results first, then the least times."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lab import by_hand, casadi_c, engines, ours, pydy_c, timing
from lab.contestants import Contestant, accelerations, built, sample
from lab.timing import TOLERANCE, Entry, difference
from lab.trees import COLUMNS, Tree

REFERENCE = "CasADi"


@dataclass
class Column:
    """The least time [ns] of each row, with the variant and compiler that took it."""

    times: dict[str, tuple[float, str]] = field(default_factory=dict)
    worst: float = 0.0  # difference between any two results


def everyone(name: str, tree: Tree, missing: list[str]) -> list[Contestant]:
    """All contestants of a column."""
    return [
        *ours.contestants(tree, missing),
        *casadi_c.contestants(tree),
        *by_hand.contestants(tree),
        *engines.pinocchio(tree),
        *engines.mujoco(tree),
        *pydy_c.contestants(name, missing),
    ]


def column(name: str, folder: Path, missing: list[str]) -> Column:
    """One column; raises AssertionError where two results differ."""
    tree = COLUMNS[name]()
    entered: dict[tuple[str, str], tuple[Contestant, Entry]] = {}
    for who, compiler, entry in built(everyone(name, tree, missing), sample(tree), folder):
        entered[who.row, f"{who.variant}, {compiler}"] = who, entry
    timer = timing.loop(folder)
    best = timing.minima(timer, {key: entry for key, (_, entry) in entered.items()})
    return Column(_least(best), _agreement(entered, tree))


def _least(best: dict[Any, float]) -> dict[str, tuple[float, str]]:
    times: dict[str, tuple[float, str]] = {}
    for (row, variant), time in best.items():
        times[row] = min(times.get(row, (float("inf"), "")), (time, variant))
    return times


def _agreement(entered: dict[tuple[str, str], tuple[Contestant, Entry]], tree: Tree) -> float:
    found = {key: accelerations(who, entry, tree) for key, (who, entry) in entered.items()}
    reference = next(found[key] for key in found if key[0] == REFERENCE)
    worst = 0.0
    for key, results in found.items():
        error = difference(results, reference)
        assert error < TOLERANCE, f"{key} differs by {error:.1e} on {tree.name}"
        worst = max(worst, error)
    return worst


def measured(folder: Path, missing: list[str]) -> dict[str, Column]:
    """All columns."""
    return {name: column(name, folder, missing) for name in COLUMNS}


def table(columns: dict[str, Column]) -> list[str]:
    """Rows in Markdown, then how ours stands to CasADi and Pinocchio."""
    rows = list(dict.fromkeys(row for c in columns.values() for row in c.times))
    lines = [f"| ns a call | {' | '.join(columns)} |", "|---" * (len(columns) + 1) + "|"]
    lines += [f"| {row} | {' | '.join(_cell(c, row) for c in columns.values())} |" for row in rows]
    for first, second in RATIOS:
        cells = [_ratio(c, first, second) for c in columns.values()]
        lines.append(f"| {first} / {second} | {' | '.join(cells)} |")
    return lines


RATIOS = (
    ("ours, folded", "CasADi"),
    ("ours, folded", "Pinocchio, clang"),
    ("ours, run-time parameters", "ours, folded"),
    ("ours, folded", "ours, batch, folded"),
    ("ours, folded, fast trig", "ours, batch, folded, fast trig"),
    ("ours, folded, limb after limb", "ours, batch, folded"),
    ("ours, folded", "ours, batch, folded, AVX2"),
    ("ours, folded, limb after limb, AVX2", "ours, batch, folded, AVX2"),
    ("the same, fast trig, AVX2", "ours, batch, folded, AVX2"),
)


def _cell(c: Column, row: str) -> str:
    return f"{c.times[row][0]:.0f}" if row in c.times else "-"


def _ratio(c: Column, first: str, second: str) -> str:
    if first not in c.times or second not in c.times:
        return "-"
    return f"{c.times[first][0] / c.times[second][0]:.2f}"


def winners(columns: dict[str, Column]) -> list[str]:
    """Which way of writing it, and which compiler, each number is from."""
    rows = list(dict.fromkeys(row for c in columns.values() for row in c.times))
    return [
        f"* {row}: "
        + "; ".join(f"{name}: {c.times[row][1]}" for name, c in columns.items() if row in c.times)
        for row in rows
    ]
