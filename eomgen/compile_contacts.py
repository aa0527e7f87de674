"""Functions of a scene with contacts: gaps, impacts, and of each mode its motion and events."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from eomgen.algebra.assemble import assemble
from eomgen.algebra.graph import Node
from eomgen.compile import Machine
from eomgen.mechanics import contacts, contacts_modes, contacts_motion
from eomgen.mechanics.contacts import Contact
from eomgen.mechanics.contacts_modes import FLIGHT, Mode
from eomgen.mechanics.contacts_motion import Motion
from eomgen.program import Function


@dataclass(frozen=True)
class Touching:
    """A scene with its contacts and modes, each derived once when first asked for."""

    machine: Machine

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """The contacts, as declared."""
        return contacts.of(self.machine)

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """The modes whose forces are determined."""
        return contacts_modes.modes(self.machine, self.contacts)

    @cached_property
    def one_sided(self) -> tuple[Contact, ...]:
        """The contacts that can open."""
        return tuple(c for c in self.contacts if c.one_sided)


def functions(m: Machine) -> tuple[Function, ...]:
    """Every function of the contacts of a scene; none where it has none.

    Raises:
        UsageError: friction has no point to act on, or there are too many contacts.
    """
    scene = Touching(m)
    return (*_gaps(scene), *_contact_forces(scene), *_impacts(scene), *_motions(scene))


def _gaps(scene: Touching) -> Iterator[Function]:
    """Gaps and gap rates of the one-sided contacts."""
    found = scene.one_sided
    if not found:
        return
    pivots, names = scene.machine.pivots, _listed(found)
    about = f"gaps, not negative where the scene may be: {names}"
    yield assemble("gaps", about, (len(found),), [c.gap for c in found], pivots)
    about = f"rates of the gaps: {names}"
    yield assemble("gap_rates", about, (len(found),), [c.row.rate for c in found], pivots)


def _contact_forces(scene: Touching) -> Iterator[Function]:
    """lambda_N of all contacts together, where they can be closed together."""
    found = scene.one_sided
    closed = tuple(c.name for c in scene.contacts)
    if not found or not any(m.active == closed for m in scene.modes):
        return
    forces, pivots = contacts.normal_forces(scene.machine, found)
    about = (
        f"lambda_N of M q'' + h = Q + J' lambda + G' lambda_N, not negative, while all are closed, "
        f"without friction: {_listed(found)}; newtons where the gap is a distance"
    )
    yield assemble("contact_forces", about, (len(found),), forces, pivots)


def _impacts(scene: Touching) -> Iterator[Function]:
    """The impact map of every contact that has a restitution."""
    for contact in scene.one_sided:
        if contact.restitution is None:
            continue
        values, pivots = contacts.impact(scene.machine, contact)
        about = (
            f"rates after the impact of {contact.name}, for a gap rate below zero: "
            "q' + M^-1 (J' P + G' p), the gap rate times -restitution, the impulse without friction"
        )
        name = f"impact_{contacts_modes.spelled(contact.name)}"
        yield assemble(name, about, (len(values),), values, pivots)


def _motions(scene: Touching) -> Iterator[Function]:
    """Accelerations, forces and events of every mode; flight has the scene's own accelerations."""
    for mode in scene.modes:
        found = contacts_motion.motion(scene.machine, scene.contacts, mode)
        if mode.name != FLIGHT:
            yield _accelerations(mode, found)
            yield _forces(scene, mode, found)
        yield _events(scene, mode, found)


def _accelerations(mode: Mode, found: Motion) -> Function:
    about = f"u' in the mode {mode.name}: {mode.meaning}"
    values = found.accelerations
    return assemble(f"accelerations_{mode.name}", about, (len(values),), values, found.pivots)


def _forces(scene: Touching, mode: Mode, found: Motion) -> Function:
    zero = found.accelerations[0].graph.zero
    values = [found.normal.get(c.name, zero) for c in scene.contacts]
    about = f"lambda_N of each contact in the mode {mode.name}: {_listed(scene.contacts)}"
    return assemble(f"contact_forces_{mode.name}", about, (len(values),), values, found.pivots)


def _events(scene: Touching, mode: Mode, found: Motion) -> Function:
    values: list[Node] = contacts_motion.events(scene.contacts, mode, found)
    what = ", ".join(mode.events)
    about = f"positive in the mode {mode.name}, which ends where one falls to zero: {what}"
    return assemble(f"events_{mode.name}", about, (len(values),), values, found.pivots)


def _listed(found: Sequence[Contact]) -> str:
    return ", ".join(c.name for c in found)
