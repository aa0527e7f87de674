"""Newton's and Euler's laws, component by component, and how the reactions are eliminated.

m a = F + R,   d(I w)/dt = M + L   for every body, with all forces, those between components too.

What holds a body to its parent is one unknown for each direction in which the joint does no work;
the third law gives it to the parent with the other sign. Where the joints do not tell (bodies that
one coordinate moves together, closed chains, bodies turning in space) the unknowns are the
resultants R, L of the constraint forces on each body. Either way

sum of (dv/dq') . (m a - F) + (dw/dq') . (d(I w)/dt - M) = 0

holds no reaction: ideal forces of constraint do no virtual work.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from eomgen.algebra import normal
from eomgen.algebra.normal import Form
from eomgen.mechanics import free_bodies_joints as joints
from eomgen.mechanics import free_bodies_loads as loads
from eomgen.mechanics import free_bodies_rows, lagrange, newton_euler, newton_euler_tree
from eomgen.mechanics.equations import Equation, reaction_name
from eomgen.mechanics.free_bodies_joints import Closed, Hinge, Share
from eomgen.mechanics.free_bodies_loads import Wrenches, less, plus
from eomgen.mechanics.free_bodies_rows import BodyRow
from eomgen.mechanics.newton_euler import Wrench
from eomgen.mechanics.vectors import add, dot, scale, subtract
from eomgen.model import Energy, Model


@dataclass(frozen=True)
class Unknown:
    """One unknown of what holds a body, and its value in terms of the motion."""

    symbol: sp.Symbol
    letter: str  # as `free_bodies_joints.Share`; R, L: of a resultant
    body: str
    held_by: str | None  # the parent; None: the world
    value: Form


@dataclass(frozen=True)
class FreeBodies:
    """Everything that the vector formalism shows."""

    rows: tuple[BodyRow, ...]
    unknowns: tuple[Unknown, ...]
    by_joints: bool  # else the unknowns are resultants
    work: tuple[Form, ...]  # of the resultants, per delta q_j; () by joints, where it vanishes
    other: tuple[Form, ...]  # what that work is: of what acts along coordinates
    equations: tuple[Equation, ...]  # one for each coordinate, without reactions


def derive(kinematics: Closed) -> FreeBodies:
    """The free-body equations of a scene with bodies and what is left without the reactions."""
    return by_joints(kinematics) or by_resultants(kinematics)


LARGEST = 6  # bodies of a scene whose forces between components are shown with any derivation


def short(model: Model) -> FreeBodies | None:
    """The forces between the components of a small scene; None of a large one or without bodies."""
    small = 0 < len(model.bodies) <= LARGEST and model.energy == Energy()
    is_solid = model.space == "solid" and any(b.inertia or b.frame.along for b in model.bodies)
    return by_joints(lagrange.closed_kinematics(model)) if small and not is_solid else None


def by_joints(kinematics: Closed) -> FreeBodies | None:
    """With an unknown for each direction that a joint holds; None where the joints do not tell."""
    hinges = hinges_of(kinematics)
    held = [joints.shares(kinematics, h) for h in hinges] if hinges else [None]
    given, tied = loads.applied(kinematics), loads.multiplied(kinematics)
    placed = [_placed(kinematics, hinges, found) for found in (given, tied)]
    if not _are_all(held) or not _are_all(placed) or not _is_counted(kinematics, hinges):
        return None
    applied, multiplied = placed
    assert applied is not None
    assert multiplied is not None
    pairs = [(h, s) for h, found in zip(hinges, held, strict=True) for s in found or ()]
    symbols = [sp.Symbol(reaction_name(s.letter, h.joint.body), real=True) for h, s in pairs]
    reactions = dict(multiplied)
    for (hinge, share), symbol in zip(pairs, symbols, strict=True):
        act_through(kinematics, hinge, _times(kinematics.algebra.of(symbol), share), reactions)
    rows = free_bodies_rows.of(kinematics, applied, reactions, loads.turning(kinematics))
    alone = {
        b.name: less(
            free_bodies_rows.inertia(kinematics, b), plus(applied[b.name], multiplied[b.name])
        )
        for b in kinematics.model.bodies
    }
    carried = newton_euler.carried(kinematics, alone, [h.joint for h in hinges])
    unknowns = tuple(
        Unknown(symbol, s.letter, h.joint.body, h.joint.parent, _value(carried, h, s))
        for (h, s), symbol in zip(pairs, symbols, strict=True)
    )
    equations = free_bodies_rows.eliminated(kinematics, rows, loads.nothing_along(kinematics))
    return FreeBodies(rows, unknowns, True, (), (), equations)


def _are_all(found: Sequence[object]) -> bool:
    return all(f is not None for f in found)


def hinges_of(kinematics: Closed) -> list[Hinge]:
    """The joints in closed form; none where bodies turn in space."""
    if kinematics.dimensions == 3 and any(kinematics.spin(b) for b in kinematics.model.bodies):
        return []
    turning = loads.turning(kinematics)
    tree = newton_euler_tree.joints(kinematics.model)
    return [joints.hinge(kinematics, joint, turning) for joint in tree]


def _is_counted(kinematics: Closed, hinges: Sequence[Hinge]) -> bool:
    """Whether the freedoms of the joints are those of the scene: no two bodies share one."""
    free = sum(len(joints.independent(list(h.twists.values()))) for h in hinges if h.twists)
    return free == len(loads.varied(kinematics))


def _placed(kinematics: Closed, hinges: Sequence[Hinge], found: loads.Loads) -> Wrenches | None:
    """The loads with those along coordinates acting through joints; None if one has no joint."""
    total = dict(found.on_bodies)
    for j, force in enumerate(found.along):
        if normal.is_zero(force):
            continue
        duals = ((h, joints.dual(kinematics, h, j)) for h in hinges)
        chosen = next(((h, d) for h, d in duals if d is not None), None)
        if chosen is None:
            return None
        act_through(kinematics, chosen[0], _times(force, chosen[1]), total)
    return None if found.lost else total


def _times(value: Form, share: Share) -> Share:
    return Share(share.letter, scale(value, share.force), value * share.moment)


def act_through(kinematics: Closed, hinge: Hinge, share: Share, total: Wrenches) -> None:
    """Adds a wrench on a body at its joint, and its opposite on the parent."""
    for name, turns, sign in (
        (hinge.joint.body, hinge.turns, 1),
        (hinge.joint.parent, hinge.parent_turns, -1),
    ):
        if name is not None:
            force = tuple(f * sign for f in share.force)
            moment = loads.nothing(kinematics).moment
            if turns:
                arm = subtract(hinge.place, kinematics.position(name))
                moment = add(newton_euler.lever(arm, force), (share.moment * sign,))
            total[name] = plus(total[name], Wrench(force, moment))


def _value(carried: Mapping[str, Wrench[Form]], hinge: Hinge, share: Share) -> Form:
    """The component of what the joint carries; the directions of a joint are orthonormal."""
    wrench = carried[hinge.joint.body]
    return wrench.moment[0] if share.letter == "M" else dot(wrench.force, share.force)


def by_resultants(kinematics: Closed) -> FreeBodies:
    """With the resultants of the constraint forces on each body as unknowns."""
    rows = free_bodies_rows.of(
        kinematics, loads.applied(kinematics).on_bodies, {}, free_bodies_rows.solid(kinematics)
    )
    symbols = [sp.Symbol(reaction_name(_letter(r), r.body), real=True) for r in rows]
    held = tuple(
        replace(row, reaction=kinematics.algebra.of(symbol))
        for row, symbol in zip(rows, symbols, strict=True)
    )
    unknowns = tuple(
        Unknown(symbol, _letter(row), row.body, None, row.inertia - row.applied)
        for row, symbol in zip(rows, symbols, strict=True)
    )
    given = loads.total(kinematics)
    other = subtract(given, free_bodies_rows.weighted(kinematics, held, "applied"))
    return FreeBodies(
        rows=held,
        unknowns=unknowns,
        by_joints=False,
        work=free_bodies_rows.weighted(kinematics, held, "reaction"),
        other=add(other, loads.constrained(kinematics)),
        equations=free_bodies_rows.eliminated(kinematics, held, other),
    )


def _letter(row: BodyRow) -> str:
    return f"{'L' if row.is_moment else 'R'}{row.axis}"
