"""Stability by the second variation of V on the admissible virtual displacements.

K = V_qq - sum lambda_a phi_a,qq, projected on the null space Z of J:  Z' K Z positive: V has a
minimum there (Lagrange, Dirichlet: stable); a negative direction: unstable; else undecided.
"""

from __future__ import annotations

from typing import Any

from eomgen.analysis.equilibrium_polish import Root, context
from eomgen.analysis.equilibrium_records import Stability
from eomgen.analysis.equilibrium_scene import Scene

ZERO = 1e-20  # of the largest second derivative
FLOOR = 1e-40  # SI; where no second derivative differs from zero at all
RIGID = "no admissible virtual displacement: nothing can move"


def null_space(rows: list[list[Any]], size: int) -> tuple[Any, int]:
    """(orthonormal rows that span the admissible displacements, rank of J)."""
    ctx = context()
    if not rows:
        return ctx.eye(size), 0
    # padded with zero rows, so that the decomposition has all `size` directions
    padded = rows + [[ctx.zero] * size for _ in range(size - len(rows))]
    _, values, directions = ctx.svd_r(ctx.matrix(padded))
    cut = max(values) * 1e-20
    rank = sum(1 for v in values if v > cut)
    return directions[rank:, :] if rank < size else ctx.matrix(0, size), rank


def second_variation(root: Root, size: int) -> tuple[list[Any], int]:
    """(eigenvalues of Z' K Z, rank of J)."""
    ctx = context()
    basis, rank = null_space(root.numbers.jacobian, size)
    if not basis.rows:
        return [], rank
    stiffness = -ctx.matrix(root.numbers.slopes)
    projected = basis * stiffness * basis.T
    return sorted(ctx.eigsy((projected + projected.T) / 2, eigvals_only=True)), rank


def stability(scene: Scene, root: Root, conservative: bool, typical: float) -> Stability:
    """Whether the equilibrium is stable, as far as the energy tells.

    typical: the size of second derivatives elsewhere, beside which those at the root may vanish.
    """
    values, rank = second_variation(root, len(scene.coordinates))
    zero = max(FLOOR, ZERO * max(typical, *(abs(v) for row in root.numbers.slopes for v in row)))
    shown = tuple(0.0 if abs(v) <= zero else float(v) for v in values)
    reason = _no_energy(scene, root, conservative or len(values) == 1, rank)
    if reason:
        return Stability("undecided", reason, shown)
    if not values:
        return Stability("stable", RIGID)
    return Stability(*_verdict(values, zero), shown)


def _no_energy(scene: Scene, root: Root, conservative: bool, rank: int) -> str:
    """Why the second variation does not decide; empty where it does."""
    if not all(scene.holonomic):
        return "undecided by energy: constraints between rates are no constraints on positions"
    if rank < _full_rank(scene):
        return "undecided by energy: the constraints lose rank here"
    if not conservative:
        return "undecided by energy: the applied forces have no potential; linearize instead"
    return ""


def _full_rank(scene: Scene) -> int:
    return min(len(scene.names), len(scene.coordinates))


def _verdict(values: list[Any], zero: Any) -> tuple[str, str]:
    """(verdict, reason) from the eigenvalues, ascending."""
    if values[0] < -zero:
        return "unstable", "V falls along an admissible virtual displacement"
    if values[0] > zero:
        return "stable", "V has a minimum among the admissible positions"
    return "undecided", "the second variation vanishes along an admissible virtual displacement"
