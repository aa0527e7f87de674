"""The modes of a scene with contacts: which are closed, which stick, which slide, in words.

Everything that a mode's events watch is positive inside it: a mode ends where one falls to zero.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

from eomgen.algebra.graph import Node
from eomgen.errors import UsageError
from eomgen.mechanics import contacts_states, contacts_touch
from eomgen.mechanics.contacts import Contact, Scene, bilateral

LARGEST = 3  # contacts whose modes are listed: with friction in a plane these are 64
FLIGHT = "flight"


@dataclass(frozen=True)
class State:
    """What one contact can do."""

    name: str
    equations: str  # in words; {what} is the gap, or the residual of a two-sided constraint
    watched: tuple[str, ...]  # quantities that are positive, each an event
    direction: int = 0  # of slip along the tangent, in a plane


FORCE, RESERVE, SPEED, GAP = "normal force", "friction reserve", "slip speed", "gap"
OPEN = State(FLIGHT, "no force", (GAP,))
CLOSED = State("contact", "{what}'' = 0, normal force without friction", (FORCE,))
STICK = State(
    "stick", "{what}'' = 0 and no slip, |F_t| below mu N (the friction reserve)", (FORCE, RESERVE)
)
PLUS = State("slip_plus", "{what}'' = 0 and F_t = -mu N along the tangent", (FORCE, SPEED), 1)
MINUS = State("slip_minus", "{what}'' = 0 and F_t = mu N along the tangent", (FORCE, SPEED), -1)
SLIDE = State("slip", "{what}'' = 0 and F_t = -mu N v_t / |v_t|", (FORCE, SPEED))


@dataclass(frozen=True)
class Mode:
    """The state of every contact, in their order."""

    name: str
    states: tuple[tuple[str, State], ...]  # contact -> state
    meaning: str
    events: tuple[str, ...]  # what is watched, as "gap of floor"

    @property
    def active(self) -> tuple[str, ...]:
        """Contacts that are closed."""
        return tuple(name for name, state in self.states if state is not OPEN)

    @property
    def sticking(self) -> tuple[str, ...]:
        """Contacts that stick."""
        return tuple(name for name, state in self.states if state is STICK)


def states_of(contact: Contact) -> tuple[State, ...]:
    """What a contact can do: flight first, where it can open."""
    closed: tuple[State, ...] = (CLOSED,)
    if contact.touch is not None:
        closed = (STICK, PLUS, MINUS) if len(contact.touch.slips) == 1 else (STICK, SLIDE)
    return (OPEN, *closed) if contact.one_sided else closed


def watched(contact: Contact, state: State) -> tuple[str, ...]:
    """The quantities of a contact that end a mode; a two-sided one may press either way."""
    return tuple(q for q in state.watched if contact.one_sided or q != FORCE)


def modes(scene: Scene, contacts: Sequence[Contact]) -> tuple[Mode, ...]:
    """Every mode whose forces are determined, flight first.

    Raises:
        UsageError: there are too many contacts, or two modes would have one name.
    """
    return tuple(m for m in _all(contacts) if _is_determined(scene, contacts, m))


def left_out(scene: Scene, contacts: Sequence[Contact]) -> tuple[Mode, ...]:
    """Modes whose closed contacts depend on each other at every state that was looked at.

    Two walls that face each other are not closed together; the sticking corners of one block are,
    but how they share the load is not determined.
    """
    return tuple(m for m in _all(contacts) if not _is_determined(scene, contacts, m))


def _all(contacts: Sequence[Contact]) -> tuple[Mode, ...]:
    if len(contacts) > LARGEST:
        names = ", ".join(c.name for c in contacts)
        raise UsageError(
            f"the modes of {len(contacts)} contacts ({names}) are too many: at most {LARGEST} "
            "constraints may be unilateral or have friction"
        )
    choices = product(*(states_of(c) for c in contacts))
    found = tuple(_mode(contacts, choice) for choice in choices) if contacts else ()
    if twice := [name for name, count in Counter(m.name for m in found).items() if count > 1]:
        raise UsageError(f"two modes would be called {twice[0]}: rename one of the constraints")
    return found


def _mode(contacts: Sequence[Contact], choice: Sequence[State]) -> Mode:
    pairs = list(zip(contacts, choice, strict=True))
    closed = [(c, s) for c, s in pairs if s is not OPEN]
    words = [_words(c, s) for c, s in pairs]
    events = [f"{quantity} of {c.name}" for c, s in pairs for quantity in watched(c, s)]
    return Mode(
        name=_name(contacts, closed),
        states=tuple((c.name, s) for c, s in pairs),
        meaning="; ".join(words),
        events=tuple(events),
    )


def _words(contact: Contact, state: State) -> str:
    what = "gap" if contact.one_sided else "residual"
    return f"{contact.name}: {state.equations.format(what=what)}"


def _name(contacts: Sequence[Contact], closed: Sequence[tuple[Contact, State]]) -> str:
    """The state, with the contact before it where there are several."""
    if not closed:
        return FLIGHT
    if len(contacts) == 1:
        return closed[0][1].name
    return "_".join(f"{spelled(c.name)}_{s.name}" for c, s in closed)


def spelled(name: str) -> str:
    """A name as part of a function's name."""
    return re.sub(r"\W", "_", name, flags=re.ASCII)


def _is_determined(scene: Scene, contacts: Sequence[Contact], mode: Mode) -> bool:
    """Whether the rows that hold in a mode are independent somewhere."""
    rows = list(_rows(scene, contacts, mode))
    if not rows:
        return True
    size = len(rows[0])
    found = contacts_states.values(scene.kinematics, [entry for row in rows for entry in row])
    return any(
        contacts_touch.rank([v[i : i + size] for i in range(0, len(v), size)]) == len(rows)
        for v in found
    )


def _rows(scene: Scene, contacts: Sequence[Contact], mode: Mode) -> Iterator[tuple[Node, ...]]:
    """J, G of the closed contacts, and the slip rows of those that stick."""
    yield from (row.jacobian for row in bilateral(scene))
    for contact, (_, state) in zip(contacts, mode.states, strict=True):
        if contact.one_sided and state is not OPEN:
            yield contact.row.jacobian
        if state is STICK and contact.touch is not None:
            yield from (slip.jacobian for slip in contact.touch.slips)
