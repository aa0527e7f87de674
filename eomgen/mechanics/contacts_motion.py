"""The motion in a mode: accelerations, normal and friction forces, and what its events watch.

M q'' + h = Q + C x,   R q'' + gamma = 0,   hence   (R M^-1 C) x = -gamma - R M^-1 (Q - h).

R has a row for every two-sided constraint, closed contact and sticking tangent, C a column for the
force of each. C = R' but where a contact slides: there friction stands beside the normal force,
G' - mu |d gap / d r| (d v_t / d q')', so the matrix is not symmetric. It is eliminated in a fixed
order, sliding contacts last: a pivot of these that is not positive is a state where friction
jams (Painleve's paradox), and the program stops with `singular` there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from eomgen.algebra import ldl
from eomgen.algebra.elementary import absolute, sign
from eomgen.algebra.graph import Node, sqrt
from eomgen.errors import UsageError
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.contacts import Contact, Scene, bilateral
from eomgen.mechanics.contacts_modes import (
    FORCE,
    GAP,
    OPEN,
    RESERVE,
    SPEED,
    STICK,
    Mode,
    State,
    watched,
)
from eomgen.mechanics.contacts_touch import Slip, Touch
from eomgen.mechanics.vectors import dot

Name = tuple[str, int]  # row or contact, and 0: normal; 1, 2: along a tangent
Column = tuple[Node, ...]


@dataclass(frozen=True)
class Press:
    """One unknown force and the row that it keeps."""

    name: Name
    row: Row[Node] | Slip
    column: Column  # generalized force per unit of the unknown
    drag: Column = ()  # a sliding two-sided constraint: - drag |unknown| comes in
    slides: bool = False


@dataclass(frozen=True)
class Jam:
    """Whether friction jams: where a margin is not positive the forces are not determined."""

    margins: tuple[Node, ...] = ()  # the pivot of each sliding contact, in 1/kg for a distance
    fitting: Node | None = None  # how many normal forces satisfy the mode, where one contact slides
    pivots: ldl.Pivots = ()  # all others


@dataclass(frozen=True)
class Motion:
    """The solution in a mode with every pivot that it divides by."""

    accelerations: tuple[Node, ...]
    normal: Mapping[str, Node]  # contact -> lambda_N, where it is closed
    friction: Mapping[str, tuple[Node, ...]]  # contact with friction -> F_t on the tangents [N]
    multipliers: Mapping[str, Node]  # two-sided row -> its lambda
    pivots: ldl.Pivots
    jam: Jam


def motion(scene: Scene, contacts: Sequence[Contact], mode: Mode) -> Motion:
    """Accelerations and forces in a mode.

    Raises:
        UsageError: more than one two-sided constraint slides.
    """
    presses = _presses(scene, contacts, mode)
    found, accelerations, pivots, jam = _solved(scene, presses)
    states = dict(mode.states)
    touches = tuple(p for c in contacts if c.touch is not None for p in c.touch.pivots)
    return Motion(
        accelerations,
        {name: found[name, 0] for name in mode.active},
        {
            c.name: tuple(_along(c, c.touch, states[c.name], found))
            for c in contacts
            if c.touch is not None and c.name in mode.active
        },
        {row.name: found[row.name, 0] for row in bilateral(scene)},
        pivots + touches,
        replace(jam, pivots=jam.pivots + touches),
    )


def _along(
    contact: Contact, touch: Touch, state: State, found: Mapping[Name, Node]
) -> Iterator[Node]:
    """F_t along each tangent: what holds where it sticks, -mu |N| v_t / |v_t| where it slides."""
    if state is STICK:
        yield from (found[contact.name, k + 1] for k in range(len(touch.slips)))
        return
    limit = touch.friction * _normal(contact, touch, found[contact.name, 0])
    if state.direction:
        yield -(state.direction * limit)
        return
    yield from (-(limit * slip.speed / slip_speed(touch, state)) for slip in touch.slips)


def _normal(contact: Contact, touch: Touch, pressed: Node) -> Node:
    """|N| in newtons: the force of a one-sided contact is not negative in its modes."""
    return touch.steepness * (pressed if contact.one_sided else absolute(pressed))


def _presses(scene: Scene, contacts: Sequence[Contact], mode: Mode) -> list[Press]:
    """All unknown forces: symmetric ones, then sliding contacts, last a sliding constraint."""
    states = dict(mode.states)
    sliding = [c for c in contacts if c.touch is not None and SPEED in states[c.name].watched]
    guides = [c for c in sliding if not c.one_sided]
    if len(guides) > 1:
        raise UsageError(
            f"the constraints {' and '.join(c.name for c in guides)} both have friction: the side "
            "on which each presses is not found in closed form; give friction to one of them"
        )
    names = [c.name for c in guides]
    presses = [Press((r.name, 0), r, r.jacobian) for r in bilateral(scene) if r.name not in names]
    for contact in contacts:
        if contact not in sliding:
            presses += _at_rest(contact, states[contact.name])
    return presses + [_sliding(c, states[c.name]) for c in (*_one_sided(sliding), *guides)]


def _one_sided(contacts: Sequence[Contact]) -> Iterator[Contact]:
    return (c for c in contacts if c.one_sided)


def _at_rest(contact: Contact, state: State) -> Iterator[Press]:
    """The normal force of a closed contact, and what holds it where it sticks."""
    if contact.one_sided and state is not OPEN:
        yield Press((contact.name, 0), contact.row, contact.row.jacobian)
    if contact.touch is not None and state is STICK:
        for k, slip in enumerate(contact.touch.slips):
            yield Press((contact.name, k + 1), slip, slip.jacobian)


def _sliding(contact: Contact, state: State) -> Press:
    """The normal force of a sliding contact with the friction that it brings."""
    assert contact.touch is not None
    touch, row = contact.touch, contact.row
    drag = tuple(touch.friction * touch.steepness * d for d in _direction(touch, state))
    if contact.one_sided:
        column = tuple(g - d for g, d in zip(row.jacobian, drag, strict=True))
        return Press((contact.name, 0), row, column, slides=True)
    return Press((contact.name, 0), row, row.jacobian, drag, slides=True)


def _direction(touch: Touch, state: State) -> Column:
    """The generalized force of a unit force along the slip velocity."""
    if state.direction:
        return tuple(state.direction * d for d in touch.slips[0].jacobian)
    speed = slip_speed(touch, state)
    columns = zip(*(slip.jacobian for slip in touch.slips), strict=True)
    return tuple(dot([slip.speed for slip in touch.slips], c) / speed for c in columns)


def slip_speed(touch: Touch, state: State) -> Node:
    """The slip speed, counted in the mode's direction in a plane; |v_t| in solid space."""
    if state.direction:
        return state.direction * touch.slips[0].speed
    return _length([slip.speed for slip in touch.slips])


def _length(components: Sequence[Node]) -> Node:
    return absolute(components[0]) if len(components) == 1 else sqrt(dot(components, components))


def _solved(
    scene: Scene, presses: Sequence[Press]
) -> tuple[dict[Name, Node], tuple[Node, ...], ldl.Pivots, Jam]:
    """The unknown forces by name and q''."""
    matrix, load = scene.equations.mass_matrix, scene.equations.generalized_forces
    load = tuple(q - h for q, h in zip(load, scene.equations.bias, strict=True))
    drags = [p.drag for p in presses if p.drag]
    solved, pivots = ldl.solve(matrix, load, *(p.column for p in presses), *drags)
    free, columns, drag = solved[0], solved[1 : len(presses) + 1], solved[len(presses) + 1 :]
    system = [[dot(p.row.jacobian, c) for c in columns] for p in presses]
    right = [-p.row.gamma - dot(p.row.jacobian, free) for p in presses]
    fitting: Node | None
    if drag:
        rub = [dot(p.row.jacobian, drag[0]) for p in presses]
        unknowns, more, fitting = _two_sided(system, right, rub)
        free = [f - d * absolute(unknowns[-1]) for f, d in zip(free, drag[0], strict=True)]
    else:
        (unknowns,), more = eliminated(system, right)
        fitting = (1 + sign(unknowns[-1])) / 2 if unknowns else None
    accelerations = tuple(_plus(f, [c[i] for c in columns], unknowns) for i, f in enumerate(free))
    found = dict(zip((p.name for p in presses), unknowns, strict=True))
    sliding = sum(p.slides for p in presses)
    steady = (*pivots, *more[: len(more) - sliding])
    margins = tuple(margin for margin, _ in more[len(more) - sliding :])
    jam = Jam(margins, fitting if sliding == 1 else None, checked(steady))
    return found, accelerations, checked((*pivots, *more)), jam


def checked(pivots: ldl.Pivots) -> ldl.Pivots:
    """Those that a program has to look at: a number was looked at here."""
    return tuple(p for p in pivots if p[0].operator != "number")


def _plus(value: Node, left: Sequence[Node], right: Sequence[Node]) -> Node:
    """Value + left . right, of any length."""
    return value + dot(left, right) if left else value


def _two_sided(
    matrix: Sequence[Sequence[Node]], right: Sequence[Node], rub: Sequence[Node]
) -> tuple[list[Node], ldl.Pivots, Node]:
    """(x, pivots, how many x there are) of  A x - rub |x_last| = b.

    With s the sign of x_last its reduced equation is  (a - s r) x_last = b: where a > |r| that sign
    is the one of b and the solution is the only one; else there are two or none.
    """
    lead, last = [row[:-1] for row in matrix[:-1]], matrix[-1]
    sides = (right[:-1], [row[-1] for row in matrix[:-1]], rub[:-1])
    (others, stiff, rubbed), pivots = eliminated(lead, *sides)
    ends = zip((right[-1], last[-1], rub[-1]), (others, stiff, rubbed), strict=True)
    b, a, r = (_plus(end, last[:-1], [-v for v in side]) for end, side in ends)
    margin = a - absolute(r)
    x = b / (margin + (absolute(r) - sign(b) * r))
    solution = [o - s * x + d * absolute(x) for o, s, d in zip(others, stiff, rubbed, strict=True)]
    fitting = (2 + sign(b * (a - r)) - sign(b * (a + r))) / 2
    return [*solution, x], (*pivots, (margin, last[-1])), fitting


def eliminated(
    matrix: Sequence[Sequence[Node]], *rights: Sequence[Node]
) -> tuple[list[list[Node]], ldl.Pivots]:
    """The solutions of A x = b for every b, from the first row to the last, pivots positive."""
    size = len(matrix)
    rows = [[*row, *(b[i] for b in rights)] for i, row in enumerate(matrix)]
    pivots = []
    for k in range(size):
        pivots.append((_positive(rows[k][k]), matrix[k][k]))
        for i in range(k + 1, size):
            factor = rows[i][k] / rows[k][k]
            rows[i][k + 1 :] = [
                a - factor * b for a, b in zip(rows[i][k + 1 :], rows[k][k + 1 :], strict=True)
            ]
    solutions = [_substituted(rows, size + j) for j in range(len(rights))]
    return solutions, tuple(pivots)


def _positive(pivot: Node) -> Node:
    """The pivot, unless it is a number that is not positive."""
    if pivot.operator == "number" and pivot.datum <= 0:
        raise UsageError(
            "the contact forces are not determined whatever the state: friction jams "
            "(Painleve's paradox); lower its coefficient"
        )
    return pivot


def _substituted(rows: Sequence[Sequence[Node]], side: int) -> list[Node]:
    """The solution of the triangular system for one right side."""
    found: list[Node] = []
    for k in reversed(range(len(rows))):
        rest = [-v for v in rows[k][k + 1 : len(rows)]]
        found.insert(0, _plus(rows[k][side], rest, found) / rows[k][k])
    return found


def events(contacts: Sequence[Contact], mode: Mode, found: Motion) -> list[Node]:
    """What the mode's events watch, in their order: positive inside the mode."""
    return [
        WATCHED[quantity](contact, state, found)
        for contact, (_, state) in zip(contacts, mode.states, strict=True)
        for quantity in watched(contact, state)
    ]


def _reserve(contact: Contact, state: State, found: Motion) -> Node:
    """mu N - |F_t|."""
    assert contact.touch is not None
    limit = contact.touch.friction * _normal(contact, contact.touch, found.normal[contact.name])
    return limit - _length(found.friction[contact.name])


def _speed(contact: Contact, state: State, found: Motion) -> Node:
    assert contact.touch is not None
    return slip_speed(contact.touch, state)


WATCHED: dict[str, Callable[[Contact, State, Motion], Node]] = {
    GAP: lambda contact, state, found: contact.gap,
    FORCE: lambda contact, state, found: found.normal[contact.name],
    RESERVE: _reserve,
    SPEED: _speed,
}
