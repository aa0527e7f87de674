"""Functions of the reactions of joints: forces and moments that hold bodies to each other."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.algebra.assemble import assemble
from eomgen.algebra.graph import Node
from eomgen.compile import Machine
from eomgen.mechanics import newton_euler, newton_euler_unknown
from eomgen.mechanics.newton_euler import JointReaction
from eomgen.program import Function


def functions(m: Machine) -> tuple[Function, ...]:
    """`joint_forces` and, off the line, `joint_moments`: one row for each joint that is known."""
    found = newton_euler.reactions(m)
    if not found:
        return ()
    names, rest = ", ".join(_named(r) for r in found), _left_out(m)
    forces = f"forces of the parent on the body [N], world axes, one row each: {names}{rest}"
    made = [_function(m, "joint_forces", forces, [r.force for r in found])]
    if found[0].moment:
        points = ", ".join(f"{r.name} about {r.about}" for r in found)
        moments = (
            f"moments of the parent on the body [N m], world axes, one row each: {points}{rest}"
        )
        made.append(_function(m, "joint_moments", moments, [r.moment for r in found]))
    return tuple(made)


def _named(reaction: JointReaction) -> str:
    if not reaction.together_with:
        return reaction.name
    return f"{reaction.name} (with what ties it to {' and '.join(reaction.together_with)})"


def _left_out(m: Machine) -> str:
    """The joints that are not known."""
    names = ", ".join(left.name for left in newton_euler_unknown.left_out(m))
    return f"; not determined: {names}" if names else ""


def _function(m: Machine, name: str, about: str, rows: Sequence[Sequence[Node]]) -> Function:
    values = [entry for row in rows for entry in row]
    return assemble(name, about, (len(rows), len(rows[0])), values, m.solution[1])
