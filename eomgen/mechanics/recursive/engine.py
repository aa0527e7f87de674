"""The cheapest way to the accelerations of a tree, found by counting."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

from eomgen.algebra import cost, ldl
from eomgen.algebra.cost import Cost
from eomgen.algebra.graph import Node
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive import articulated, loads, recursion, rods
from eomgen.mechanics.recursive.formulas import Clock
from eomgen.mechanics.recursive.lumping import lumped
from eomgen.mechanics.recursive.records import GROUND, Solution, Tree
from eomgen.mechanics.recursive.recursion import Loads

LARGEST_TRIED = 12  # coordinates of a tree for which every combination is built and counted


@dataclass(frozen=True)
class Engine:
    """Accelerations of a tree, how they were found and what they cost."""

    method: str
    lumped: bool
    cost: Cost  # per call; what depends on parameters only is free
    tree: Tree
    accelerations: tuple[Node, ...]
    pivots: ldl.Pivots

    @property
    def said(self) -> str:
        """One short phrase."""
        how = ", inertias lumped" if self.lumped else ""
        chain = f"longest chain {self.cost.cycles} cycles"
        return f"{self.method}{how}, {self.cost.operations} operations, {chain}"


Solver = Callable[[Kinematics[Node], Tree, Loads], Solution | None]  # None: not for such a tree


def by_articulated_bodies(_: Kinematics[Node], tree: Tree, applied: Loads) -> Solution:
    """M^-1 (Q - h) without M; the wrenches of the bias go to the root with the solution's."""
    found = articulated.factor(tree)
    wrenches = recursion.wrenches(tree, falling=True, loads=applied)
    return articulated.solve(found, applied.forces, wrenches), found.pivots


def by_composite_inertias(_: Kinematics[Node], tree: Tree, applied: Loads) -> Solution:
    """M^-1 (Q - h) by L' D L of M, from the leaves to the root: no fill."""
    matrix = recursion.mass_matrix(tree)
    right = [-row for row in recursion.inverse_dynamics(tree, falling=True, loads=applied)]
    order = tree.order
    rows = [[matrix[i][j] for j in order] for i in order]
    (solution,), pivots = ldl.solve(rows, [right[i] for i in order])
    found = dict(zip(order, solution, strict=True))
    return tuple(found[i] for i in range(len(order))), pivots


def factorisation(tree: Tree) -> int:
    """Operations of L' D L alone: a row for each coordinate above, and the two substitutions."""
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


def couplings(tree: Tree) -> int:
    """Operations between whatever hangs on the same place, and with what that hangs on."""
    hanging = Counter(joint.base for joint in tree.joints)
    return sum(count * count for base, count in hanging.items() if base != GROUND)


@dataclass(frozen=True)
class Method:
    """A way to the accelerations, and how many operations it takes at least."""

    solve: Solver
    least: Callable[[Tree], int]  # zero where no joint stands on another


METHODS: dict[str, Method] = {
    "articulated bodies": Method(by_articulated_bodies, lambda tree: len(tree.order)),
    "composite inertias and L'DL": Method(by_composite_inertias, factorisation),
    "tensions of rods": Method(rods.solve, couplings),
}


def choose(kinematics: Kinematics[Node], tree: Tree) -> Engine:
    """The cheapest of all methods x {lumped, not}, by operations and the longest chain of them.

    A large tree is lumped in any case, and a method that must cost more is not built.

    Raises:
        SingularMassMatrix: a motion has no inertia whatever the state.
    """
    prepared = Clock(kinematics).constant_bits
    applied = loads.of(kinematics, tree)
    best: Engine | None = None
    for variant in _variants(tree):
        for name, method in METHODS.items():
            if best and name != best.method and _is_hopeless(method, variant, best.cost):
                continue
            solution = method.solve(kinematics, variant, applied)
            if solution is None:
                continue
            found = cost.of(solution[0], prepared)
            if best is None or found.total < best.cost.total:
                best = Engine(name, variant is not tree, found, variant, *solution)
    assert best is not None
    return best


def _variants(tree: Tree) -> list[Tree]:
    """The tree with lumped inertias, where there are any, and a small one as it is too."""
    less = lumped(tree)
    if all(a is b for a, b in zip(less.places, tree.places, strict=True)):
        return [tree]
    return [less, tree] if len(tree.order) <= LARGEST_TRIED else [less]


def _is_hopeless(method: Method, tree: Tree, best: Cost) -> bool:
    """Whether a method takes more on a large tree, or no joint stands on another.

    Then the methods do not differ.
    """
    return len(tree.order) > LARGEST_TRIED and not 0 < method.least(tree) < best.total
