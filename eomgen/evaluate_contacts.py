"""Numbers of one-sided constraints: gaps, and the motion in each mode."""

from __future__ import annotations

from typing import Any

from eomgen.compile_contacts import Touching
from eomgen.evaluate import Engine
from eomgen.mechanics.contacts_modes import FLIGHT, Mode
from eomgen.model import Model
from eomgen.states import State


def contacts(chosen: Engine, scene: Touching, model: Model, state: State) -> dict[str, Any]:
    """Gaps, their rates, and for every mode accelerations, contact forces and events.

    The accelerations beside this record are those of flight.
    """
    open_ = [c.name for c in scene.one_sided]
    result: dict[str, Any] = {
        "gaps": _named(chosen, state, "gaps", open_),
        "gap_rates": _named(chosen, state, "gap_rates", open_),
    }
    result["modes"] = {m.name: _mode(chosen, scene, m, (model, state)) for m in scene.modes}
    return result


def _mode(chosen: Engine, scene: Touching, mode: Mode, at: tuple[Model, State]) -> dict[str, Any]:
    model, state = at
    found: dict[str, Any] = {"meaning": mode.meaning}
    if mode.name != FLIGHT:
        coordinates = [c.name for c in model.coordinates]
        names = [c.name for c in scene.contacts]
        found["accelerations"] = _named(chosen, state, f"accelerations_{mode.name}", coordinates)
        found["contact_forces"] = _named(chosen, state, f"contact_forces_{mode.name}", names)
    found["events"] = _named(chosen, state, f"events_{mode.name}", list(mode.events))
    return found


def _named(chosen: Engine, state: State, function: str, names: list[str]) -> dict[str, Any]:
    values = chosen.call(function, state)
    return {n: chosen.shown(v) for n, v in zip(names, values, strict=True)}
