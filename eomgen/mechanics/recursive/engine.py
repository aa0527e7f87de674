"""The cheapest way to the accelerations of a tree, found by counting."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from eomgen.algebra import cost, ldl
from eomgen.algebra.cost import Cost
from eomgen.algebra.graph import Node
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive import articulated, loads, recursion, rods
from eomgen.mechanics.recursive.formulas import Clock
from eomgen.mechanics.recursive.lumping import lumped, moments
from eomgen.mechanics.recursive.records import GROUND, Solution, Tree
from eomgen.mechanics.recursive.recursion import Loads
from eomgen.mechanics.vectors import Vector

LARGEST_TRIED = 12  # coordinates of a tree for which every method is built and counted


# operations in space (twists of 6 numbers) and in the plane (3)
CARRIED = {6: 24, 3: 4}  # a wrench to the base: turned, shifted
MOVED = {6: 120, 3: 20}  # a body: its wrench, its inertia moved to the base


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


@dataclass(frozen=True)
class Task:
    """A tree, what is applied to it, and what every method needs of both."""

    kinematics: Kinematics[Node]
    tree: Tree
    loads: Loads

    @cached_property
    def wrenches(self) -> list[Vector[Node] | None]:
        """What every place needs for its terms of velocities, less what is applied to it."""
        return recursion.wrenches(self.tree, falling=True, loads=self.loads)


Solver = Callable[[Task], Solution | None]  # None: not for such a tree


def by_articulated_bodies(task: Task) -> Solution:
    """M^-1 (Q - h) without M; the wrenches of the bias go to the root with the solution's."""
    found = articulated.factor(task.tree)
    return articulated.solve(found, task.loads.forces, task.wrenches), found.pivots


def by_composite_inertias(task: Task) -> Solution:
    """M^-1 (Q - h) by L' D L of M, from the leaves to the root: no fill."""
    matrix = recursion.mass_matrix(task.tree)
    bias = recursion.gathered(task.tree, task.wrenches)
    order = task.tree.order
    rows = [[matrix[i][j] for j in order] for i in order]
    (solution,), pivots = ldl.solve(rows, [task.loads.forces[i] - bias[i] for i in order])
    found = dict(zip(order, solution, strict=True))
    return tuple(found[i] for i in range(len(order))), pivots


def by_tensions(task: Task) -> Solution | None:
    """The tensions of rods first."""
    return rods.solve(task.kinematics, task.tree, task.loads)


def with_composite_inertias(tree: Tree) -> int:
    """About the operations of M, of the bias and of L' D L.

    A coordinate and one above it take a row of L, substitutions, and a wrench carried between.
    """
    above = [0] * len(tree.places)
    total = 0
    for joint in tree.joints:
        depth, size = above[joint.base], tree.places[joint.places[0]].kind.size
        for _ in joint.coordinates:
            total += depth * (depth + 6 + CARRIED.get(size, 0))
            depth += 1
        for number in joint.places:
            above[number] = depth
            total += MOVED.get(size, 0) if tree.places[number].body else 0
    return total


def couplings(tree: Tree) -> int:
    """Operations between whatever hangs on the same place, and with what that hangs on."""
    hanging = Counter(joint.base for joint in tree.joints)
    return sum(count * count for base, count in hanging.items() if base != GROUND)


@dataclass(frozen=True)
class Method:
    """A way to the accelerations, and about how many operations it takes at least."""

    solve: Solver
    least: Callable[[Tree], int]


METHODS: dict[str, Method] = {
    "articulated bodies": Method(by_articulated_bodies, lambda tree: len(tree.order)),
    "composite inertias and L'DL": Method(by_composite_inertias, with_composite_inertias),
    "tensions of rods": Method(by_tensions, couplings),
}


def choose(kinematics: Kinematics[Node], tree: Tree) -> Engine:
    """The cheapest of all methods, by operations and the longest chain of them.

    Inertias are lumped unless that leaves more of them. On a large tree a method that must cost
    more is not built.

    Raises:
        SingularMassMatrix: a motion has no inertia whatever the state.
    """
    prepared = Clock(kinematics).constant_bits
    less = lumped(tree)
    pays = less is not tree and moments(less) <= moments(tree)
    chosen = less if pays else tree
    task = Task(kinematics, chosen, loads.of(kinematics, chosen))
    best: Engine | None = None
    for name, method in METHODS.items():
        if best and _is_hopeless(method, chosen, best.cost):
            continue
        solution = method.solve(task)
        if solution is None:
            continue
        found = cost.of(solution[0], prepared)
        if best is None or found.total < best.cost.total:
            best = Engine(name, pays, found, chosen, *solution)
    assert best is not None
    return best


def _is_hopeless(method: Method, tree: Tree, best: Cost) -> bool:
    """Whether a method takes more on a large tree, or no joint stands on another.

    Then the methods do not differ.
    """
    alone = all(joint.base == GROUND for joint in tree.joints)
    return len(tree.order) > LARGEST_TRIED and (alone or method.least(tree) >= best.total)
