"""Numbers of the forces between components: the reactions of joints by Newton-Euler."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from eomgen import compile_reactions
from eomgen.compile import Machine
from eomgen.evaluate import Engine, engine
from eomgen.mechanics import newton_euler, newton_euler_unknown
from eomgen.mechanics.newton_euler import JointReaction
from eomgen.model import Model
from eomgen.program import Program
from eomgen.states import State


def joints(
    machine: Machine, source: Program, model: Model, at: tuple[State, int]
) -> dict[str, Any]:
    """Force [N] and moment [N m] of the parent on each body, world axes, by name of the joint.

    at: (state, digits). Joints whose reaction cannot be told are listed with the reason.
    """
    state, digits = at
    functions = compile_reactions.functions(machine)
    chosen = engine("interpreter", replace(source, functions=functions), model, digits)
    found = newton_euler.reactions(machine)
    values = {f.name: chosen.call(f.name, state) for f in functions}
    return {
        **{r.name: _shown(chosen, r, values, i) for i, r in enumerate(found)},
        "unknown": {left.name: left.because for left in newton_euler_unknown.left_out(machine)},
    }


def _shown(
    chosen: Engine, reaction: JointReaction, values: dict[str, list[Any]], index: int
) -> dict[str, Any]:
    """One joint: where it acts and its components."""
    shown: dict[str, Any] = {"on": reaction.on, "about": reaction.about}
    parts = {
        "force": ("joint_forces", reaction.force),
        "moment": ("joint_moments", reaction.moment),
    }
    for name, (function, nodes) in parts.items():
        if nodes:
            own = values[function][index * len(nodes) : (index + 1) * len(nodes)]
            shown[name] = [chosen.shown(v) for v in own]
    if reaction.together_with:
        shown["together_with"] = list(reaction.together_with)
    return shown
