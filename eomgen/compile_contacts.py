"""Functions of a scene with contacts: gaps, impacts, and of each mode its motion and events."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from eomgen.algebra.assemble import assemble
from eomgen.algebra.graph import Node
from eomgen.compile import Machine
from eomgen.mechanics import contacts, contacts_conditions, contacts_modes, contacts_motion
from eomgen.mechanics.contacts import Contact
from eomgen.mechanics.contacts_modes import FLIGHT, Mode
from eomgen.mechanics.contacts_motion import Motion
from eomgen.mechanics.motions import holds_motion
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
    def motions(self) -> dict[str, Motion]:
        """The motion in every mode."""
        return {m.name: contacts_motion.motion(self.machine, self.contacts, m) for m in self.modes}

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
        found = scene.motions[mode.name]
        if mode.name != FLIGHT:
            yield _accelerations(mode, found)
            yield _forces(scene, mode, found)
            yield from _surface_forces(scene, mode, found)
            yield from _multipliers(scene, mode, found)
            yield from _outputs(scene, mode, found)
        yield _events(scene, mode, found)
        yield _conditions(scene, mode, found)
        yield from _jam(mode, found)


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


def _surface_forces(scene: Touching, mode: Mode, found: Motion) -> Iterator[Function]:
    """Normal force and friction in newtons."""
    zero = found.accelerations[0].graph.zero
    touches = [(c.name, c.touch) for c in scene.contacts if c.touch is not None]
    if not touches:
        return
    values = [
        force
        for name, touch in touches
        for force in (
            touch.steepness * found.normal.get(name, zero),
            *found.friction.get(name, [zero] * len(touch.slips)),
        )
    ]
    about = (
        f"forces on the touching point in the mode {mode.name}, along the normal and each tangent "
        f"[N], one row each: {', '.join(name for name, _ in touches)}"
    )
    shape = (len(touches), len(values) // len(touches))
    yield assemble(f"surface_forces_{mode.name}", about, shape, values, found.pivots)


def _multipliers(scene: Touching, mode: Mode, found: Motion) -> Iterator[Function]:
    """Multipliers, where there is no motion without a mode."""
    if scene.machine.model.guides:
        values = list(found.multipliers.values())
        about = f"lambda of the independent rows in the mode {mode.name}"
        yield assemble(f"multipliers_{mode.name}", about, (len(values),), values, found.pivots)


def _outputs(scene: Touching, mode: Mode, found: Motion) -> Iterator[Function]:
    """Outputs, where they tell of accelerations."""
    machine = scene.machine
    if holds_motion(machine.model):
        pairs = zip(machine.model.coordinates, found.accelerations, strict=True)
        outputs = machine.outputs_with({c.acceleration: a for c, a in pairs})
        about = f"the outputs of the spec in the mode {mode.name}"
        yield assemble(f"outputs_{mode.name}", about, (len(outputs),), outputs, found.pivots)


def _conditions(scene: Touching, mode: Mode, found: Motion) -> Function:
    """What tells at a state whether the mode is the motion."""
    conditions = contacts_conditions.conditions(scene.contacts, mode, found)
    values = [v for c in conditions for v in c.values]
    listed = ", ".join(c.name + " and its rates" * (len(c.values) > 1) for c in conditions)
    about = f"what begins the mode {mode.name}: {listed}"
    return assemble(f"conditions_{mode.name}", about, (len(values),), values, found.pivots)


def _jam(mode: Mode, found: Motion) -> Iterator[Function]:
    """Painleve's paradox, where a contact slides."""
    values = [*found.jam.margins, *([] if found.jam.fitting is None else [found.jam.fitting])]
    if not values:
        return
    about = (
        f"margins of the mode {mode.name}, one for each sliding contact: where one is not positive "
        "friction jams and the forces are not determined (Painleve's paradox)"
    )
    if found.jam.fitting is not None:
        about += "; then how many normal forces satisfy the mode"
    yield assemble(f"jam_{mode.name}", about, (len(values),), values, found.jam.pivots)


def _listed(found: Sequence[Contact]) -> str:
    return ", ".join(c.name for c in found)
