"""Energy and power as functions of a program: what a simulation balances at its end."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from eomgen.algebra.assemble import assemble
from eomgen.algebra.elementary import absolute
from eomgen.algebra.graph import Node, sqrt
from eomgen.checks import power
from eomgen.compile import Machine
from eomgen.compile_contacts import Touching
from eomgen.mechanics import multipliers
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.contacts import Contact, bilateral
from eomgen.mechanics.contacts_modes import SPEED, Mode
from eomgen.mechanics.contacts_motion import Motion
from eomgen.mechanics.vectors import dot
from eomgen.program import Function

FRICTIONLESS = "frictionless_accelerations"
ABOUT = "energy [J], T + V without explicit time, and the power [W] that changes it"


def functions(machine: Machine, touching: Touching | None = None) -> tuple[Function, ...]:
    """`energy_flow` of a scene, and of every mode of its contacts."""
    stored, supplied = power.flow(machine)
    plain = assemble("energy_flow", ABOUT, (2,), [stored, supplied], machine.solution[1])
    if touching is None:
        return (plain,)
    return (plain, *_modes(touching, stored, supplied))


def projections(touching: Touching) -> Iterator[Function]:
    """Of every mode: positions with its gaps closed, and rates with which they stay closed."""
    m = touching.machine
    coordinates = [m.kinematics.algebra.of(c.symbol) for c in m.model.coordinates]
    zero = m.kinematics.algebra.number(0)
    for mode in touching.modes:
        if not mode.active:
            continue
        contacts = [c for c in touching.contacts if c.name in mode.active]
        rows = [*bilateral(m), *(c.row for c in contacts if c.one_sided)]
        places = [zero if row.residual is None else row.residual for row in rows]
        values, pivots = multipliers.projected(
            multipliers.schur(m.equations, rows), coordinates, places
        )
        about = f"positions with the contacts of the mode {mode.name} closed"
        yield assemble(f"project_positions_{mode.name}", about, (len(values),), values, pivots)
        rows += [row for c in contacts if c.name in mode.sticking for row in _slip_rows(c)]
        values, pivots = multipliers.projected(
            multipliers.schur(m.equations, rows), m.rates, [row.rate for row in rows]
        )
        about = f"rates with which the contacts of the mode {mode.name} stay as they are"
        yield assemble(f"project_rates_{mode.name}", about, (len(values),), values, pivots)


def _slip_rows(contact: Contact) -> Iterator[Row[Node]]:
    """The slip velocity of a contact as rows between rates."""
    for slip in contact.touch.slips if contact.touch is not None else ():
        row = contact.row
        yield replace(row, residual=None, rate=slip.speed, jacobian=slip.jacobian, gamma=slip.gamma)


def frictionless(machine: Machine) -> Function:
    """What would move a scene whose constraints have friction if they had none."""
    values, pivots = machine.solution
    about = "u' without friction: the direction in which a slip in space begins"
    return assemble(FRICTIONLESS, about, (len(values),), values, pivots)


def is_conserved(machine: Machine) -> bool:
    """Whether no power changes the energy, by its form."""
    return machine.kinematics.algebra.is_zero(power.flow(machine)[1])


def _modes(touching: Touching, stored: Node, supplied: Node) -> Iterator[Function]:
    """The same with the friction of sliding contacts, and the force of contacts that move."""
    machine = touching.machine
    for mode in touching.modes:
        found, total = touching.motions[mode.name], supplied
        for contact in touching.contacts:
            for share in _contact_powers(machine, contact, mode, found):
                total = total + share
        pivots = (*machine.solution[1], *found.pivots)
        yield assemble(f"energy_flow_{mode.name}", ABOUT, (2,), [stored, total], pivots)


def _contact_powers(
    machine: Machine, contact: Contact, mode: Mode, found: Motion
) -> Iterator[Node]:
    """lambda_N G q' where the surface moves, and -mu N |v_t| where the contact slides."""
    pressed = found.normal.get(contact.name)
    if pressed is None:
        return
    one = machine.kinematics.algebra.number(1)
    if contact.one_sided and not machine.kinematics.algebra.is_zero(
        power.explicit_rate(contact.row, machine, one)
    ):
        yield pressed * dot(contact.row.jacobian, machine.rates)
    if contact.touch is not None and SPEED in dict(mode.states)[contact.name].watched:
        slips = [slip.speed for slip in contact.touch.slips]
        speed = absolute(slips[0]) if len(slips) == 1 else sqrt(dot(slips, slips))
        force = contact.touch.friction * contact.touch.steepness * absolute(pressed)
        yield -(force * speed)
