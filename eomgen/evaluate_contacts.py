"""Numbers of contacts: gaps, and in each mode the motion, its forces, and whether it holds."""

from __future__ import annotations

from typing import Any

from eomgen.compile_contacts import Touching
from eomgen.errors import CheckError
from eomgen.evaluate import Engine, Result
from eomgen.mechanics import contacts_conditions, contacts_modes
from eomgen.mechanics.contacts_conditions import ABOVE, AT_LEAST, ZERO, Condition
from eomgen.mechanics.contacts_modes import FLIGHT, Mode
from eomgen.mechanics.motions import holds_motion
from eomgen.states import State

NOTHING = 1e-9  # SI; what counts as zero

PARADOX = "friction jams (Painleve's paradox): "
NONE_FITS = f"{PARADOX}no normal force satisfies this mode, so it has no motion"
MANY_FIT = f"{PARADOX}{{count}} normal forces satisfy this mode, so its motion is not unique"
NOT_UNIQUE = f"{PARADOX}the forces of the sliding contacts are not determined"
SEVERAL = f"{PARADOX}{{names}} hold at once, and nothing tells which is the motion"
NO_MOTION = (
    f"{PARADOX}no mode holds: rigid bodies with Coulomb friction have no motion here but a jump of "
    "the rates"
)


def contacts(chosen: Engine, scene: Touching, state: State) -> Result:
    """Gaps, their rates, and for every mode accelerations, forces, events and conditions.

    `holds` lists the modes whose conditions are met; `because` says why where it is not one. The
    accelerations beside this record are those of flight.
    """
    open_ = [c.name for c in scene.one_sided]
    result: Result = {}
    if open_:
        result["gaps"] = _named(chosen, state, "gaps", open_)
        result["gap_rates"] = _named(chosen, state, "gap_rates", open_)
    result["modes"] = {m.name: _mode(chosen, scene, m, state) for m in scene.modes}
    result["holds"] = [name for name, found in result["modes"].items() if found.get("holds")]
    if len(result["holds"]) != 1:
        result["because"] = _why(scene, result["modes"], result["holds"])
    return result


def _why(scene: Touching, modes: dict[str, Any], holding: list[str]) -> str:
    """Why not exactly one mode holds."""
    if holding:
        return SEVERAL.format(names=" and ".join(holding))
    if any(found.get("undetermined", "").startswith(PARADOX) for found in modes.values()):
        return NO_MOTION
    unclear = contacts_modes.left_out(scene.machine, scene.contacts)
    if unclear:
        listed = ", ".join(m.name for m in unclear)
        return f"no mode holds whose forces are determined; those of {listed} are not"
    return "no mode holds: the state is off a contact, or slip begins in a direction that is free"


def _mode(chosen: Engine, scene: Touching, mode: Mode, state: State) -> Result:
    """One mode; `undetermined` where its forces are not."""
    found: Result = {"meaning": mode.meaning}
    try:
        jam = _jam(chosen, scene, mode, state)
        if jam:
            found |= jam
        if "undetermined" not in found:
            found |= _motion(chosen, scene, mode, state)
    except CheckError as error:
        found["undetermined"] = str(error)
    return found


def _jam(chosen: Engine, scene: Touching, mode: Mode, state: State) -> Result:
    """Margins against Painleve's paradox, and what it means where one is not positive."""
    jam = scene.motions[mode.name].jam
    if not jam.margins:
        return {}
    values = chosen.call(f"jam_{mode.name}", state)
    margins = values[: len(jam.margins)]
    found: Result = {"margins": [chosen.shown(v) for v in margins]}
    if min(margins) > 0:
        return found
    count = None if jam.fitting is None else round(float(values[-1]))
    if count is None:
        return {**found, "undetermined": NOT_UNIQUE}
    return {**found, "undetermined": MANY_FIT.format(count=count) if count else NONE_FITS}


def _motion(chosen: Engine, scene: Touching, mode: Mode, state: State) -> Result:
    """Accelerations, forces, events and conditions."""
    model, name = scene.machine.model, mode.name
    found: Result = {}
    if name != FLIGHT:
        coordinates = [c.name for c in model.coordinates]
        names = [c.name for c in scene.contacts]
        found["accelerations"] = _named(chosen, state, f"accelerations_{name}", coordinates)
        found["contact_forces"] = _named(chosen, state, f"contact_forces_{name}", names)
        found |= _forces(chosen, scene, mode, state)
        if holds_motion(model):
            outputs = [o.name for o in model.outputs]
            found["outputs"] = _named(chosen, state, f"outputs_{name}", outputs)
    found["events"] = _named(chosen, state, f"events_{name}", list(mode.events))
    found["conditions"] = _conditions(chosen, scene, mode, state)
    found["holds"] = all(c["holds"] for c in found["conditions"].values())
    return found


def _forces(chosen: Engine, scene: Touching, mode: Mode, state: State) -> Result:
    """Normal force and friction in newtons, by contact."""
    touches = [(c.name, c.touch) for c in scene.contacts if c.touch is not None]
    if not touches:
        return {}
    values = iter(chosen.call(f"surface_forces_{mode.name}", state))
    return {
        "surface_forces": {
            name: {
                "on": touch.point,
                "normal": chosen.shown(next(values)),
                "friction": [chosen.shown(next(values)) for _ in touch.slips],
            }
            for name, touch in touches
        }
    }


def _conditions(chosen: Engine, scene: Touching, mode: Mode, state: State) -> Result:
    """Values, relation and whether it is met, by the name of each condition."""
    motion = scene.motions[mode.name]
    values = iter(chosen.call(f"conditions_{mode.name}", state))
    found: Result = {}
    for condition in contacts_conditions.conditions(scene.contacts, mode, motion):
        own = [next(values) for _ in condition.values]
        found[condition.name] = {
            "values": [chosen.shown(v) for v in own],
            "must_be": condition.relation,
            "holds": _is_met(condition, own),
        }
    return found


def _is_met(condition: Condition, values: list[Any]) -> bool:
    """Of several values the first that is not zero decides."""
    value = next((v for v in values if abs(v) > NOTHING), 0)
    return {ZERO: value == 0, AT_LEAST: value >= 0, ABOVE: value > 0}[condition.relation]


def _named(chosen: Engine, state: State, function: str, names: list[str]) -> dict[str, Any]:
    values = chosen.call(function, state)
    return {n: chosen.shown(v) for n, v in zip(names, values, strict=True)}
