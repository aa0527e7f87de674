"""Applied forces on a tree: moments as wrenches on places, everything else by one reverse sweep."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from eomgen.algebra import cost
from eomgen.algebra.derive import pullback
from eomgen.algebra.graph import Node
from eomgen.mechanics import efforts, speeds
from eomgen.mechanics.efforts import Effort
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive import gravity, recursion
from eomgen.mechanics.recursive.formulas import Clock
from eomgen.mechanics.recursive.records import GROUND, Place, PlanarFrame, SpatialFrame, Tree
from eomgen.mechanics.recursive.recursion import Loads
from eomgen.mechanics.recursive.steps import back
from eomgen.mechanics.vectors import Vector, add, dot, transform, transpose
from eomgen.model import Moment


def of(kinematics: Kinematics[Node], tree: Tree) -> Loads:
    """Everything applied but the weights."""
    forces = generalized(kinematics, list(_beside_the_tree(kinematics, tree)))
    wrenches: dict[int, Vector[Node]] = {}
    for moment in kinematics.model.moments:
        if _is_on_tree(tree, moment):
            _apply(kinematics, tree, moment, (wrenches, forces))
    return Loads(wrenches, tuple(forces))


def generalized_forces(kinematics: Kinematics[Node], tree: Tree) -> tuple[Node, ...]:
    """Q of everything applied, the weights included."""
    applied, zero = of(kinematics, tree), kinematics.algebra.number(0)
    wrenches: list[Vector[Node] | None] = [None] * len(tree.places)
    for number, wrench in applied.wrenches.items():
        wrenches[number] = wrench
    parts = (
        applied.forces,
        recursion.gathered(tree, wrenches),
        _weights(kinematics, tree),
    )
    return tuple(sum(row, zero) for row in zip(*parts, strict=True))


def _weights(kinematics: Kinematics[Node], tree: Tree) -> Sequence[Node]:
    """Of the weights, in the fewest operations: velocities swept back, or h x g of frames."""
    swept = generalized(kinematics, list(efforts.weights(kinematics)))
    if not gravity.is_of_frames(tree):
        return swept
    prepared = Clock(kinematics).constant_bits
    both = (swept, gravity.weights(tree))
    return min(both, key=lambda rows: cost.operations(rows, prepared))


def generalized(kinematics: Kinematics[Node], applied: Sequence[Effort[Node]]) -> list[Node]:
    """Sum of force . d velocity / d q' for every speed: the velocities swept back once."""
    rates = [kinematics.algebra.of(s) for s in speeds.symbols(kinematics.model)]
    weighted = [
        (velocity, force)
        for effort in applied
        for velocity, force in zip(effort.velocity, effort.force, strict=True)
    ]
    return pullback(weighted, rates) if weighted else [kinematics.algebra.number(0)] * len(rates)


def _beside_the_tree(kinematics: Kinematics[Node], tree: Tree) -> Iterator[Effort[Node]]:
    """Everything but weights and the moments on frames of the tree."""
    yield from efforts.elastic(kinematics)
    yield from efforts.dissipative(kinematics)
    yield from efforts.forces(kinematics)
    for moment in kinematics.model.moments:
        if not _is_on_tree(tree, moment):
            yield efforts.moment_of(kinematics, moment)


def _is_on_tree(tree: Tree, moment: Moment) -> bool:
    """Whether everything that feels a moment has axes of its own in the tree."""
    names = [n for n in (moment.on, moment.source) if n is not None]
    kinds = [tree.places[tree.frames[n]].kind for n in names if n in tree.frames]
    return len(kinds) == len(names) and all(
        isinstance(k, PlanarFrame | SpatialFrame) for k in kinds
    )


Found = tuple[dict[int, Vector[Node]], list[Node]]  # wrenches and forces, to be added to


def _apply(kinematics: Kinematics[Node], tree: Tree, moment: Moment, found: Found) -> None:
    """A moment on a body; between a body and one that it stands on it reaches no further."""
    wrenches, forces = found
    last = tree.frames[moment.on]
    first = GROUND if moment.source is None else tree.frames[moment.source]
    path = list(_path(tree, last, first))
    if moment.source is not None and (path or first == last):
        wrench = _wrench(kinematics, tree, moment, moment.on)
        for place in path:
            for c, column in place.columns.items():
                forces[c] = forces[c] + dot(column, wrench)
            wrench = back(place.steps, wrench)
        return
    _put(wrenches, last, _wrench(kinematics, tree, moment, moment.on))
    if moment.source is not None:
        reaction = _wrench(kinematics, tree, moment, moment.source)
        _put(wrenches, first, tuple(-w for w in reaction))


def _put(wrenches: dict[int, Vector[Node]], number: int, wrench: Vector[Node]) -> None:
    before = wrenches.get(number)
    wrenches[number] = wrench if before is None else add(before, wrench)


def _path(tree: Tree, last: int, first: int) -> Iterator[Place]:
    """The places from `last` down to `first`, which is not among them; none where it is no base."""
    on_way = []
    while last not in (first, GROUND):
        on_way.append(tree.places[last])
        last = tree.places[last].base
    return iter(on_way if last == first else ())


def _wrench(kinematics: Kinematics[Node], tree: Tree, moment: Moment, name: str) -> Vector[Node]:
    """The moment in the axes of a body's place."""
    vector, zero = kinematics.vector(moment.components), kinematics.algebra.number(0)
    if kinematics.dimensions == 3 and moment.axes != name:
        world = kinematics.to_world(vector, moment.axes)
        vector = transform(transpose(kinematics.axes(name)), world)
    if name in tree.turned:
        vector = transform(transpose(tree.turned[name]), vector)
    size = tree.places[tree.frames[name]].kind.size
    return (*vector, *(zero,) * (size - len(vector)))
