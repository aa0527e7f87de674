"""Configurations at which the rows lose rank: phi(q) = 0, J' l = 0, l' l = 1, solved by Newton.

Such points are exceptions of special dimensions; they are looked for from several admissible
states, so one that no search runs into is not reported.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from eomgen.algebra.arithmetic import FLOAT, Arithmetic
from eomgen.algebra.derive import gradient
from eomgen.algebra.graph import Node
from eomgen.analysis import linkage as linkages
from eomgen.analysis import newton, sweep
from eomgen.analysis.linkage import Linkage, State
from eomgen.analysis.neighbourhood import periodic, principal, row_sizes, same, starts
from eomgen.mechanics.vectors import dot

SEARCHES = 12  # from starts that are not admissible
MOST = 3  # that are listed
SINGULAR = 1e-6  # smallest over largest singular value of the scaled rows
INVOLVED = 1e-4  # share of a row in the combination that vanishes
DISTINCT = 1e-3
ZERO = 5e-7  # is printed as 0


@dataclass(frozen=True)
class Singularity:
    """A configuration at which the rows are not independent."""

    rows: tuple[str, ...]  # those that depend on each other there
    coordinates: tuple[tuple[str, float], ...]

    def __str__(self) -> str:
        """The warning, with its code."""
        where = ", ".join(f"{n} = {0 if abs(v) < ZERO else v:.6g}" for n, v in self.coordinates)
        lose = "constraints {} lose" if len(self.rows) > 1 else "constraint {} loses"
        return (
            f"W-SING: {lose.format(', '.join(self.rows))} rank near {where}. "
            "Eliminated coordinates are unsafe there, and reaction forces are not unique."
        )


@dataclass(frozen=True)
class Search:
    """The rows that are looked at, their usual sizes, and the equations of a singular point."""

    linkage: Linkage
    kept: tuple[int, ...]
    sizes: newton.Floats
    shares: tuple[Node, ...]  # l
    equations: sweep.Sweep  # phi, J' l, l' l - 1, then their derivatives by (q, l)


def find(linkage: Linkage, states: Sequence[State], kept: Sequence[int]) -> tuple[Singularity, ...]:
    """Singular configurations inside `range`, nearest to the first state first."""
    if not kept:
        return ()
    angles = periodic(linkage, states[0])
    search = _search(linkage, states[0], tuple(kept))
    found: list[tuple[float, ...]] = []
    for state in _seeds(linkage, states):
        point = _singular_point(search, state)
        if point is None or not _is_inside(linkage, point, state):
            continue
        point = tuple(float(v) for v in principal(point, angles))
        if not any(same(point, other, angles, DISTINCT) for other in found):
            found.append(point)
    middle = [float(v) for v in states[0].coordinates]
    found.sort(key=lambda p: (round(_distance(p, middle), 6), p))
    return tuple(_described(search, states[0], point) for point in found[:MOST])


def _distance(left: Sequence[float], right: Sequence[float]) -> float:
    return sum((a - b) ** 2 for a, b in zip(left, right, strict=True))


def _seeds(linkage: Linkage, states: Sequence[State]) -> list[State]:
    """Admissible states, and a few that are not: Newton closes them on its way."""
    wide = starts(linkage, states[0], range(len(states[0].coordinates)))[1:]
    wide = wide[:: max(1, len(wide) // SEARCHES)]
    return [*states, *(replace(states[0], coordinates=tuple(x)) for x in wide)]


def _search(linkage: Linkage, state: State, kept: tuple[int, ...]) -> Search:
    """The equations (phi, J' l, l' l - 1) = 0 over (q, l)."""
    graph, bindings = linkage.zero.graph, linkage.kinematics.algebra.bindings
    rows = [linkage.rows[i] for i in kept]
    shares = tuple(graph.symbol(f"share of {row.name}") for row in rows)
    # dropped rows too: elsewhere than here the kept ones need not imply them
    residuals = [row.residual for row in linkage.holonomic if row.residual is not None]
    columns = zip(*(row.jacobian for row in rows), strict=True)
    residuals += [dot(shares, column) for column in columns] + [dot(shares, shares) - 1]
    unknown = [*(bindings[c.symbol] for c in linkage.model.coordinates), *shares]
    slopes = [entry for r in residuals for entry in gradient(r, unknown)]
    sizes = row_sizes(linkage, state)
    equations = sweep.of([*residuals, *slopes])
    return Search(linkage, kept, np.array([sizes[i] for i in kept]), shares, equations)


def _problem(search: Search, state: State) -> newton.Problem:
    """The equations at the time of a state."""
    count = len(state.coordinates)
    size = count + len(search.shares)

    def problem(x: Sequence[Any], arithmetic: Arithmetic) -> newton.Rows:
        at = replace(state, coordinates=tuple(x[:count]))
        more = dict(zip(search.shares, x[count:], strict=True))
        found = search.equations.at(at, arithmetic, more)
        rows = len(found) // (size + 1)
        rest = found[rows:]
        return found[:rows], [rest[size * i : size * (i + 1)] for i in range(rows)]

    return problem


def _singular_point(search: Search, state: State) -> tuple[float, ...] | None:
    """The coordinates of a nearby singular point."""
    try:
        share = np.linalg.svd(_scaled(search, state))[0][:, -1] / search.sizes
    except linkages.IRREGULAR:
        return None
    start = [*(float(v) for v in state.coordinates), *share / np.linalg.norm(share)]
    found = newton.roughly(_problem(search, state), start)
    if found is None:
        return None
    point = tuple(float(v) for v in found[: len(state.coordinates)])
    values = np.linalg.svd(_scaled(search, replace(state, coordinates=point)), compute_uv=False)
    return point if values[-1] < SINGULAR * values[0] else None


def _scaled(search: Search, state: State) -> newton.Floats:
    """J of the kept rows over their usual sizes."""
    rows = [search.linkage.rows[i].jacobian for i in search.kept]
    slope = np.array(linkages.matrix(search.linkage, rows, state, FLOAT), dtype=float)
    return np.asarray(slope / search.sizes[:, None])


def _is_inside(linkage: Linkage, point: Sequence[float], state: State) -> bool:
    """Whether every coordinate with a declared range is in it."""
    for coordinate, value in zip(linkage.model.coordinates, point, strict=True):
        if coordinate.name in linkage.model.range:
            ends = linkage.model.range[coordinate.name]
            low, high = (float(linkages.constant(linkage, e, state.parameters)) for e in ends)
            if not low - ZERO <= value <= high + ZERO:
                return False
    return True


def _described(search: Search, state: State, point: tuple[float, ...]) -> Singularity:
    """The point with the rows whose combination vanishes there."""
    scaled = _scaled(search, replace(state, coordinates=point))
    share = np.abs(np.linalg.svd(scaled)[0][:, -1])
    rows = [search.linkage.rows[i].name for i in search.kept]
    involved = tuple(n for n, s in zip(rows, share, strict=True) if s > INVOLVED)
    names = (c.name for c in search.linkage.model.coordinates)
    return Singularity(involved, tuple(zip(names, point, strict=True)))
