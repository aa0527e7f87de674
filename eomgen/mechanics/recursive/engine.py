"""The cheapest way to the accelerations of a tree, found by counting."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from eomgen.algebra import cost, ldl
from eomgen.algebra.graph import Node
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive import articulated, loads, recursion
from eomgen.mechanics.recursive.lumping import lumped
from eomgen.mechanics.recursive.records import Tree
from eomgen.mechanics.recursive.recursion import Loads

LARGEST_TRIED = 12  # coordinates of a tree for which every combination is built and counted


@dataclass(frozen=True)
class Engine:
    """Accelerations of a tree, how they were found and what they cost."""

    method: str
    lumped: bool
    operations: int  # weighted, per call; what depends on parameters only is free
    tree: Tree
    accelerations: tuple[Node, ...]
    pivots: ldl.Pivots

    @property
    def said(self) -> str:
        """One short phrase."""
        how = ", inertias lumped" if self.lumped else ""
        return f"{self.method}{how}, {self.operations} operations"


Solver = Callable[[Tree, Loads], tuple[tuple[Node, ...], ldl.Pivots]]


def by_articulated_bodies(tree: Tree, applied: Loads) -> tuple[tuple[Node, ...], ldl.Pivots]:
    """M^-1 (Q - h) without M; the wrenches of the bias go to the root with the solution's."""
    found = articulated.factor(tree)
    wrenches = recursion.wrenches(tree, falling=True, loads=applied)
    return articulated.solve(found, applied.forces, wrenches), found.pivots


def by_composite_inertias(tree: Tree, applied: Loads) -> tuple[tuple[Node, ...], ldl.Pivots]:
    """M^-1 (Q - h) by L' D L of M, from the leaves to the root: no fill."""
    matrix = recursion.mass_matrix(tree)
    right = [-row for row in recursion.inverse_dynamics(tree, falling=True, loads=applied)]
    order = tree.order
    rows = [[matrix[i][j] for j in order] for i in order]
    (solution,), pivots = ldl.solve(rows, [right[i] for i in order])
    found = dict(zip(order, solution, strict=True))
    return tuple(found[i] for i in range(len(order))), pivots


METHODS: dict[str, Solver] = {
    "articulated bodies": by_articulated_bodies,
    "composite inertias and L'DL": by_composite_inertias,
}


def choose(kinematics: Kinematics[Node], tree: Tree) -> Engine:
    """The cheapest of {articulated bodies, composite inertias} x {lumped, not}.

    A large tree is lumped in any case, and a factorisation that must cost more is not built.

    Raises:
        SingularMassMatrix: a motion has no inertia whatever the state.
    """
    prepared = _prepared(kinematics)
    applied = loads.of(kinematics, tree)
    variants = [(True, lumped(tree))]
    if len(tree.order) <= LARGEST_TRIED:
        variants.append((False, tree))
    best: Engine | None = None
    for is_lumped, variant in variants:
        for method, solver in METHODS.items():
            if best and method != best.method and _is_hopeless(variant, best.operations):
                continue
            solution, pivots = solver(variant, applied)
            count = cost.operations(solution, prepared)
            if best is None or count < best.operations:
                best = Engine(method, is_lumped, count, variant, solution, pivots)
    assert best is not None
    return best


def _prepared(kinematics: Kinematics[Node]) -> int:
    """The leaves that are parameters."""
    bits = 0
    for p in kinematics.model.parameters:
        bits |= kinematics.algebra.of(p.symbol).leaves
    return bits


def _is_hopeless(tree: Tree, operations: int) -> bool:
    """Whether L' D L of a large mass matrix alone takes more, or no joint stands on another."""
    return len(tree.order) > LARGEST_TRIED and not 0 < _factorisation(tree) < operations


def _factorisation(tree: Tree) -> int:
    """Operations of L' D L alone: a row for each coordinate above, and the two substitutions.

    Zero where no joint stands on another: then the methods do not differ.
    """
    above = [0] * len(tree.places)
    total = 0
    for joint in tree.joints:
        depth = above[joint.base]
        for _ in joint.coordinates:
            total += depth * (depth + 1) + 5 * depth
            depth += 1
        for number in joint.places:
            above[number] = depth
    return total
