"""The plot beside the tables: time against size, both logarithmic."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter, ScalarFormatter

from lab.derivation import SERIES, Times
from lab.derive_one import WHO
from lab.forward import Column

CARTS = {"cart+2": 2, "cart+4": 4, "cart+8": 8, "cart+16": 16}
TICKS = (1, 2, 5, 10, 20, 50, 100, 200, 500)
DECADES = 100  # an axis that spans less has ticks between its powers of ten
SHOWN = ("cart", "skew arm", "masses")
# Okabe and Ito, told apart by the colour-blind; a second round has another marker
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00")
LOOKS = [{"color": c, "marker": m, "linestyle": s} for m, s in ("o-", "s:") for c in COLOURS]


def draw(times: Times, columns: dict[str, Column], compiled: dict[int, float], to: Path) -> None:
    """An SVG that is the same for the same numbers."""
    mpl.use("svg")
    mpl.rcParams.update({"svg.hashsalt": "eomgen", "font.size": 8, "axes.grid": True})
    from matplotlib import pyplot

    figure, grid = pyplot.subplots(2, 3, figsize=(11, 7.2), layout="constrained")
    *axes, spare = grid.flat
    for axis, scene in zip(axes, SHOWN, strict=False):
        _derivation(axis, times, scene)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=6)
    _forward(axes[-2], columns)
    _compiled(axes[-1], compiled)
    for axis in axes:
        axis.set(xscale="log", yscale="log")
        for one in (axis.xaxis, axis.yaxis):
            one.set_minor_formatter(NullFormatter())
            low, high = one.get_view_interval()
            if one is axis.xaxis or high < DECADES * low:
                one.set_ticks([t for t in TICKS if low <= t <= high])
                one.set_major_formatter(ScalarFormatter())
    spare.set_axis_off()
    spare.legend(*axes[-2].get_legend_handles_labels(), loc="center", title="forward dynamics")
    figure.savefig(to, metadata={"Date": None})
    pyplot.close(figure)


def _derivation(axis: Axes, times: Times, scene: str) -> None:
    for who, look in zip(WHO, LOOKS, strict=False):
        found = [
            (c, times[who, scene, c].seconds) for c in SERIES[scene] if (who, scene, c) in times
        ]
        points = [(c, s) for c, s in found if s is not None]
        if points:
            axis.plot(*zip(*points, strict=True), label=who, ms=3, **look)
    axis.set(title=f"{scene}: to C text", xlabel="n", ylabel="processor seconds")


def _forward(axis: Axes, columns: dict[str, Column]) -> None:
    rows = dict.fromkeys(row for c in columns.values() for row in c.times)
    for row, look in zip(rows, LOOKS, strict=False):
        points = [
            (n, columns[name].times[row][0])
            for name, n in CARTS.items()
            if name in columns and row in columns[name].times
        ]
        if points:
            axis.plot(*zip(*points, strict=True), label=row, ms=3, **look)
    axis.set(title="cart: forward dynamics", xlabel="pendulums", ylabel="ns a call")


def _compiled(axis: Axes, compiled: dict[int, float]) -> None:
    if compiled:
        axis.plot(list(compiled), list(compiled.values()), "o-", ms=3, color=COLOURS[0])
    axis.set(title="gcc -O2 of a spatial chain", xlabel="joints", ylabel="processor seconds")
