"""The two problems of an admissible state, for Newton's method: positions, then rates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from eomgen.algebra.arithmetic import Arithmetic
from eomgen.analysis import newton, sweep
from eomgen.analysis.linkage import Linkage, State


def position_problem(linkage: Linkage, state: State) -> newton.Problem:
    """phi and its Jacobian in the coordinates, everything else as in `state`."""
    rows = linkage.holonomic
    nodes = [*(r.residual for r in rows if r.residual is not None)]
    nodes += [entry for row in rows for entry in row.jacobian]

    evaluate = sweep.of(nodes).at

    def problem(x: Sequence[Any], arithmetic: Arithmetic) -> newton.Rows:
        at = replace(state, coordinates=tuple(x))
        return _split(evaluate(at, arithmetic), len(rows), len(x))

    return problem


def rate_problem(linkage: Linkage, state: State) -> newton.Problem:
    """J u + b and J, over the rates, at the positions of `state`."""
    nodes = [r.rate for r in linkage.rows]
    nodes += [entry for row in linkage.rows for entry in row.jacobian]

    evaluate = sweep.of(nodes).at

    def problem(x: Sequence[Any], arithmetic: Arithmetic) -> newton.Rows:
        at = replace(state, rates=tuple(x))
        return _split(evaluate(at, arithmetic), len(linkage.rows), len(x))

    return problem


def _split(found: list[Any], rows: int, columns: int) -> newton.Rows:
    rest = found[rows:]
    return found[:rows], [rest[columns * i : columns * (i + 1)] for i in range(rows)]
