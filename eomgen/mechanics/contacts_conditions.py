"""When a mode is the motion: what must be zero, and what must not be negative, at a state.

The events of a mode end it; its conditions begin it. Where a gap is zero its rate decides whether
it opens, and where that is zero too its second rate; where a slip speed is zero its rate decides
whether it begins to slide.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from eomgen.algebra.graph import Node
from eomgen.mechanics import contacts_motion
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.contacts import Contact
from eomgen.mechanics.contacts_modes import FORCE, GAP, OPEN, RESERVE, SPEED, STICK, Mode, State
from eomgen.mechanics.contacts_motion import WATCHED, Motion
from eomgen.mechanics.contacts_touch import Slip
from eomgen.mechanics.vectors import dot

ZERO, AT_LEAST, ABOVE = "= 0", ">= 0", "> 0"


@dataclass(frozen=True)
class Condition:
    """One condition; of several values the first that is not zero is meant."""

    name: str
    relation: str  # ZERO, AT_LEAST or ABOVE
    values: tuple[Node, ...]


def conditions(contacts: Sequence[Contact], mode: Mode, found: Motion) -> list[Condition]:
    """All conditions of a mode, contact by contact."""
    return [
        Condition(f"{condition.name} of {contact.name}", condition.relation, condition.values)
        for contact, (_, state) in zip(contacts, mode.states, strict=True)
        for condition in _of_contact(contact, state, found)
    ]


def _of_contact(contact: Contact, state: State, found: Motion) -> Iterator[Condition]:
    if state is OPEN:
        rates = (contact.row.rate, _rate(contact.row, found))
        yield Condition(GAP, ABOVE, (contact.gap, *rates))
        return
    if contact.one_sided:
        yield Condition(GAP, ZERO, (contact.gap,))
        yield Condition(f"{GAP} rate", ZERO, (contact.row.rate,))
        yield Condition(FORCE, AT_LEAST, (found.normal[contact.name],))
    if state is STICK:
        yield from (Condition(SPEED, ZERO, (slip.speed,)) for slip in _slips(contact))
        yield Condition(RESERVE, AT_LEAST, (WATCHED[RESERVE](contact, state, found),))
    elif SPEED in state.watched:
        yield Condition(SPEED, ABOVE, tuple(_sliding(contact, state, found)))


def _slips(contact: Contact) -> tuple[Slip, ...]:
    assert contact.touch is not None
    return contact.touch.slips


def _sliding(contact: Contact, state: State, found: Motion) -> Iterator[Node]:
    """The slip speed in the mode's direction; in a plane its rate too."""
    assert contact.touch is not None
    yield contacts_motion.slip_speed(contact.touch, state)
    if state.direction:
        yield state.direction * _rate(contact.touch.slips[0], found)


def _rate(row: Row[Node] | Slip, found: Motion) -> Node:
    """J q'' + gamma."""
    return dot(row.jacobian, found.accelerations) + row.gamma
