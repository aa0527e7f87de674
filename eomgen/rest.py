"""Statics: a spec and its loads -> equilibrium equations and equilibria, as text or JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import sympy as sp

from eomgen.analysis import equilibrium, equilibrium_text
from eomgen.errors import UsageError
from eomgen.mechanics import machine
from eomgen.model import Model
from eomgen.spec import read
from eomgen.states import exact


@dataclass(frozen=True)
class Load:
    """Values as `NAME=VALUE`, and a time, as the command line gives them."""

    inputs: tuple[str, ...] = ()
    parameters: tuple[str, ...] = ()
    time: str = "0"


def report(text: str | bytes, file: str, load: Load, format_: str) -> str:
    """The equilibrium equations and the equilibria of a spec.

    Raises:
        SpecError: the spec has mistakes.
        UsageError: a value is no number or names nothing; the scene has no statics.
        CheckError: an equilibrium fails its independent check.
    """
    model = read(text, file)
    inputs = _values(load.inputs, [i.name for i in model.inputs], "input")
    parameters = _values(load.parameters, _free(model), "parameter")
    statics = equilibrium.equations(model)
    found = equilibrium.solve(model, inputs, _number(load.time, "time"), parameters)
    if format_ == "json":
        both = {"statics": statics.to_json(), "equilibria": found.to_json()}
        return json.dumps(both, indent=2, ensure_ascii=False)
    return "\n".join(equilibrium_text.lines(statics, found))


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
