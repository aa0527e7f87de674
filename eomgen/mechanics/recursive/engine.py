"""The cheapest way to the accelerations of a tree, found by counting."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf

from eomgen.algebra import cost, ldl
from eomgen.algebra.cost import Cost
from eomgen.algebra.graph import Node
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive import articulated, loads, recursion, rods
from eomgen.mechanics.recursive.formulas import Clock
from eomgen.mechanics.recursive.lumping import lumped, moments
from eomgen.mechanics.recursive.records import GROUND, Joint, Solution, Tree
from eomgen.mechanics.recursive.recursion import Loads
from eomgen.mechanics.vectors import Vector

LARGEST_TRIED = 6  # coordinates of a tree for which every method is built and counted
# operations in space (twists of 6 numbers) and in the plane (3)
MOVED = {6: 120, 3: 10}  # a body: its wrench, its inertia moved to the base
CARRIED = {6: 24, 3: 4}  # a wrench to the base: turned, shifted
ELIMINATED = {6: 200, 3: 20}  # a joint: its row, what is left moved to the base, two substitutions


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


def _bodies(tree: Tree) -> int:
    """About the operations of each body alone, which every method has."""
    sizes = [place.kind.size for place in tree.places if place.body is not None]
    return sum(MOVED.get(size, 0) for size in sizes)


def least_articulated(tree: Tree) -> int:
    """About the operations that eliminate every joint."""
    standing = [joint for joint in tree.joints if joint.base != GROUND]
    return _bodies(tree) + sum(_per(tree, joint, ELIMINATED) + 8 for joint in standing)


def _per(tree: Tree, joint: Joint, operations: Mapping[int, int]) -> int:
    return operations.get(tree.places[joint.places[0]].kind.size, 0)


def least_composite(tree: Tree) -> int:
    """About the operations of M, of the bias and of L' D L.

    A coordinate and one above it take a row of L, substitutions, and a wrench carried between.
    """
    above = [0] * len(tree.places)
    total = _bodies(tree)
    for joint in tree.joints:
        depth = above[joint.base]
        for _ in joint.coordinates:
            total += depth * (depth + 6 + _per(tree, joint, CARRIED))
            depth += 1
        for number in joint.places:
            above[number] = depth
    return total


def least_tensions(tree: Tree) -> int:
    """Operations between whatever hangs on the same place, and with what that hangs on."""
    hanging = Counter(joint.base for joint in tree.joints)
    return sum(count * count for base, count in hanging.items() if base != GROUND)


@dataclass(frozen=True)
class Method:
    """A way to the accelerations, and about how many operations it takes at least."""

    solve: Solver
    least: Callable[[Tree], int]


METHODS: dict[str, Method] = {
    "articulated bodies": Method(by_articulated_bodies, least_articulated),
    "composite inertias and L'DL": Method(by_composite_inertias, least_composite),
    "tensions of rods": Method(by_tensions, least_tensions),
}


def choose(kinematics: Kinematics[Node], tree: Tree) -> Engine:
    """The cheapest of all methods, by operations and the longest chain of them.

    Inertias are lumped unless that leaves more of them. Of a large tree what promises to be
    cheapest is built first, and what must cost more is not built.

    Raises:
        SingularMassMatrix: a motion has no inertia whatever the state.
    """
    prepared = Clock(kinematics).constant_bits
    less = lumped(tree)
    pays = less is not tree and moments(less) <= moments(tree)
    chosen = less if pays else tree
    task = Task(kinematics, chosen, loads.of(kinematics, chosen))
    promised = _promised(chosen)
    best: Engine | None = None
    for name in sorted(METHODS, key=promised.__getitem__):
        if best and promised[name] >= best.cost.total:
            continue
        solution = METHODS[name].solve(task)
        if solution is None:
            continue
        found = cost.of(solution[0], prepared)
        if best is None or found.total < best.cost.total:
            best = Engine(name, pays, found, chosen, *solution)
    assert best is not None
    return best


def _promised(tree: Tree) -> Mapping[str, float]:
    """About the operations of each method; nothing of a small tree, where all are built.

    Where no joint stands on another, the methods do not differ, and the first is as good as any.
    """
    if len(tree.order) <= LARGEST_TRIED:
        return dict.fromkeys(METHODS, 0)
    if all(joint.base == GROUND for joint in tree.joints):
        return {name: inf if i else 0 for i, name in enumerate(METHODS)}
    return {name: method.least(tree) for name, method in METHODS.items()}
