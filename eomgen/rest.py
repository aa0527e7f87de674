"""Statics: a spec and its loads -> equilibrium equations and equilibria, as documents or JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import sympy as sp

from eomgen.analysis import equilibrium
from eomgen.analysis.equilibrium_equations import FROZEN, MOVING
from eomgen.analysis.equilibrium_records import Balance, Equilibria, Equilibrium, Statics
from eomgen.errors import UsageError
from eomgen.mechanics import machine
from eomgen.model import Model
from eomgen.render.statics import StaticsLink, StaticsNotes, StaticsRow
from eomgen.render.statics_tables import Rest
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment
from eomgen.spec import read
from eomgen.states import exact


@dataclass(frozen=True)
class Load:
    """Values as `NAME=VALUE`, and a time, as the command line gives them."""

    inputs: tuple[str, ...] = ()
    parameters: tuple[str, ...] = ()
    time: str = "0"


@dataclass(frozen=True)
class Sheet:
    """The document that is asked for: `text` or `latex`."""

    target: str = "text"
    language: str = "en"
    templates: Path | None = None


@dataclass(frozen=True)
class Solved:
    """The equations of a scene and its equilibria; the model has the parameters that were given."""

    model: Model
    statics: Statics
    found: Equilibria


def solved(text: str | bytes, file: str, load: Load) -> Solved:
    """The equilibrium equations and the equilibria of a spec.

    Raises:
        SpecError: the spec has mistakes.
        UsageError: a value is no number or names nothing; the scene has no statics.
        CheckError: an equilibrium fails its independent check.
    """
    model = read(text, file)
    if model.quaternions:
        raise UsageError("statics needs turns by angles: a quaternion has no small set of them")
    inputs = _values(load.inputs, [i.name for i in model.inputs], "input")
    parameters = _values(load.parameters, _free(model), "parameter")
    statics = equilibrium.equations(model)
    found = equilibrium.solve(model, inputs, _number(load.time, "time"), parameters)
    valued = (replace(p, value=parameters.get(p.name, p.value)) for p in model.parameters)
    return Solved(replace(model, parameters=tuple(valued)), statics, found)


def as_json(answer: Solved) -> str:
    """Both as one JSON object."""
    both = {"statics": answer.statics.to_json(), "equilibria": answer.found.to_json()}
    return json.dumps(both, indent=2, ensure_ascii=False)


def rendered(answer: Solved, sheet: Sheet) -> dict[str, str]:
    """File name -> text.

    Raises:
        UsageError: a template of the user is wrong.
    """
    target = TARGETS[f"statics-{sheet.target}"]
    return render(notes(answer, sheet.language), target, environment(sheet.templates))


def notes(answer: Solved, language: str) -> StaticsNotes:
    """The record that the displays know."""
    statics, found = answer.statics, answer.found
    return StaticsNotes(
        model=answer.model,
        work=statics.work,
        rows=tuple(_row(balance) for balance in statics.balances),
        links=tuple(StaticsLink(r.name, r.residual, r.jacobian) for r in statics.links),
        equilibria=tuple(_rest(one) for one in found.found),
        method=found.method,
        complete=found.complete,
        language=language,
        arbitrary=found.arbitrary,
        inputs=found.inputs,
        time=found.time if {MOVING, FROZEN} & {*found.notes} else None,
        notes=tuple(dict.fromkeys(statics.notes + found.notes)),
    )


def _row(balance: Balance) -> StaticsRow:
    """What stands on the left of a balance is a force with the other sign."""
    parts = (
        ("weights", -balance.gravity),
        ("springs", -balance.elastic),
        ("potential_given", -balance.other),
        ("dampers", -balance.damping),
        ("applied", balance.applied),
    )
    held = tuple((origin, part) for origin, part in parts if part.terms)
    return StaticsRow(balance.name, held, balance.force, balance.reaction)


def _rest(one: Equilibrium) -> Rest:
    return Rest(
        coordinates=one.coordinates,
        verdict=one.stability.verdict,
        reason=one.stability.reason,
        multipliers=one.multipliers,
        reactions=one.reactions,
        contacts=one.contacts,
        is_isolated=one.isolated,
        are_loads_unique=one.unique_loads,
    )


def _free(model: Model) -> list[str]:
    return [p.name for p in machine.free_parameters(model)]


def _values(given: Iterable[str], known: list[str], what: str) -> Mapping[str, sp.Expr]:
    """The numbers by name."""
    found = {}
    for entry in given:
        name, sign, value = entry.partition("=")
        if not sign or name not in known:
            listed = ", ".join(known) or "none"
            raise UsageError(f"--{what} {entry}: write NAME=VALUE; the names are: {listed}")
        found[name] = _number(value, f"--{what} {name}")
    return found


def _number(text: str, what: str) -> sp.Expr:
    value = exact(text)
    if value is None:
        raise UsageError(f"{what}: {text[:40]!r} is not a finite decimal number")
    return value
