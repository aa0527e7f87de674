"""Joints whose reaction Newton-Euler's equations of the bodies do not tell, and why."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from eomgen.mechanics import newton_euler_loads, newton_euler_tree, speeds
from eomgen.mechanics.newton_euler_loads import Scene, Unplaced
from eomgen.mechanics.newton_euler_tree import Joint


@dataclass(frozen=True)
class LeftOut:
    """A joint whose reaction is not known, and why."""

    name: str  # parent/body
    on: str  # the body
    because: tuple[str, ...]


@dataclass(frozen=True)
class _Cause:
    """Why the joints of some bodies are not known."""

    why: str
    bodies: frozenset[str]


def name_of(joint: Joint) -> str:
    """`parent/body`, as slider/bob; world/slider."""
    return f"{joint.parent or 'world'}/{joint.body}"


def left_out(scene: Scene) -> tuple[LeftOut, ...]:
    """The joints whose reaction is not known, parents first."""
    tree = newton_euler_tree.joints(scene.kinematics.model)
    causes = [
        *_loads(scene, tree),
        *_loops(tree),
        *_dependent(scene, tree),
        *_contacts(scene, tree),
    ]
    found = []
    for joint in tree:
        because = tuple(dict.fromkeys(c.why for c in causes if joint.body in c.bodies))
        if because:
            found.append(LeftOut(name_of(joint), joint.body, because))
    return tuple(found)


def _loads(scene: Scene, tree: Sequence[Joint]) -> Iterator[_Cause]:
    """Loads that act on what hangs on a joint, nobody knows where."""
    for load in newton_euler_loads.unplaced(scene):
        yield _Cause(load.why, _touched(tree, load))


def _touched(tree: Sequence[Joint], load: Unplaced) -> frozenset[str]:
    """Bodies whose joint a load may act through.

    Along coordinates that count against the parent it acts inside the joint; else all joints above
    may feel it too: an angle against the world may be turned by the world.
    """
    parents = {j.body: j.parent for j in tree}
    found: set[str] = set()
    for joint in tree:
        if joint.own & load.coordinates or joint.body in load.bodies:
            found.add(joint.body)
            if not (load.along and joint.is_relative):
                found.update(newton_euler_tree.above(parents, joint.body))
    return frozenset(found)


def _loops(tree: Sequence[Joint]) -> Iterator[_Cause]:
    """Bodies that two others place: a loop without a constraint."""
    parents = {j.body: j.parent for j in tree}
    hanging = {
        joint.body: {
            j.body
            for j in tree
            if joint.body in (j.body, *newton_euler_tree.above(parents, j.body))
        }
        for joint in tree
    }
    for joint in tree:
        if len(joint.placed_by) > 1:
            loop = {joint.body, *joint.placed_by}
            # a joint above the whole loop does not feel it
            cut = (n for n, on in hanging.items() if on & loop and not loop <= on)
            yield _Cause(
                f"{joint.body} is placed by {' and '.join(joint.placed_by)}", frozenset(cut)
            )


def _dependent(scene: Scene, tree: Sequence[Joint]) -> Iterator[_Cause]:
    """Constraints that depend on others: how they share the load is not determined."""
    if not scene.kept:
        return
    used = {row.name: _coordinates(scene, row.jacobian) for row in scene.rows}
    for name in (n for n in used if n not in scene.kept):
        reached: frozenset[sp.Symbol] = frozenset()
        wider = used[name]
        while wider != reached:
            reached = wider
            wider = reached.union(*(u for u in used.values() if u & reached))
        touched = _touched(tree, Unplaced(name, "", reached))
        yield _Cause(f"the constraint {name} depends on others", touched)


def _contacts(scene: Scene, tree: Sequence[Joint]) -> Iterator[_Cause]:
    """What presses or rubs in some modes only: the accelerations here are those without it."""
    model = scene.kinematics.model
    for guide in model.guides:
        why = f"every acceleration depends on whether {guide.name} sticks or slides"
        yield _Cause(why, frozenset(j.body for j in tree))
    for constraint in model.constraints:
        if constraint.kind == "unilateral":
            related = newton_euler_tree.related_by(model, constraint)
            touched = _touched(tree, Unplaced(constraint.name, "", related))
            yield _Cause(f"the force of {constraint.name} depends on the contact", touched)


def _coordinates(scene: Scene, jacobian: Sequence[object]) -> frozenset[sp.Symbol]:
    """The coordinates that the speeds of a row move."""
    kinematics = scene.kinematics
    zero, moving = kinematics.algebra.number(0), 0
    for symbol, entry in zip(speeds.symbols(kinematics.model), jacobian, strict=True):
        moving |= 0 if entry is zero else kinematics.algebra.of(symbol).leaves
    return frozenset(symbol for symbol, r in kinematics.flow.rates.items() if r.leaves & moving)
