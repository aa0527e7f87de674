"""Statics in plain text, until the displays take it over."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal
from math import degrees

from eomgen.algebra.closed import to_sympy
from eomgen.algebra.normal import Form
from eomgen.analysis.equilibrium_records import Balance, Equilibria, Equilibrium, Statics
from eomgen.dimension import NONE
from eomgen.mechanics.equations import virtual_name
from eomgen.model import Model

ORIGINS = ("gravity", "elastic", "other", "damping")  # on the left, hence with a minus in Q


def lines(statics: Statics, equilibria: Equilibria) -> list[str]:
    """Virtual work, equilibrium equations, equilibria with stability and loads, one line each."""
    return [
        "Virtual work",
        f"  dW = {_work(statics)}",
        "Equilibrium equations",
        *(f"  {b.name}: {_formula(b.total)} = 0{_origins(b)}" for b in statics.balances),
        *(f"  {r.name}: {_formula(r.residual)} = 0" for r in statics.links if r.residual),
        f"Equilibria: {len(equilibria.found)} found ({equilibria.method})",
        *(f"  any value of {name}" for name in equilibria.arbitrary),
        *(line for e in equilibria.found for line in _equilibrium(statics.model, e)),
        *(f"  note: {note}" for note in dict.fromkeys(statics.notes + equilibria.notes)),
    ]


def _work(statics: Statics) -> str:
    """(Q_1) delta q_1 + ..."""
    shares = [
        f"({_formula(b.force)}) {virtual_name(b.name)}" for b in statics.balances if b.force.terms
    ]
    return " + ".join(shares) or "0"


def _formula(form: Form | None) -> str:
    return "" if form is None else str(to_sympy(form))


def _origins(balance: Balance) -> str:
    """Which part comes from where, if there is more than one."""
    parts = [(name, -getattr(balance, name)) for name in ORIGINS]
    parts += [("applied", balance.applied), ("constraints", balance.reaction)]
    held = [f"{name} {_formula(form)}" for name, form in parts if form.terms]
    return f"   [{'; '.join(held)}]" if len(held) > 1 else ""


def _equilibrium(model: Model, found: Equilibrium) -> list[str]:
    """The position and its verdict, then the loads."""
    contact = f" touching {', '.join(found.contacts)}" if found.contacts else ""
    alone = "" if found.isolated else "; not isolated"
    first = f"  {_position(model, found.coordinates)}{contact}: {found.stability.verdict}"
    result = [f"{first} ({found.stability.reason}{alone})"]
    if found.multipliers:
        unique = "" if found.unique_loads else " (not unique)"
        values = ", ".join(f"lambda {n} = {_number(v)}" for n, v in found.multipliers.items())
        result.append(f"    {values}{unique}")
    for name, force in found.reactions.items():
        result.append(f"    {name} = [{', '.join(map(_number, force))}] N on the first point")
    return result


def _position(model: Model, values: Mapping[str, Decimal]) -> str:
    return ", ".join(
        f"{c.name} = {_number(values[c.name])}{_turned(c.description.dimension, values[c.name])}"
        for c in model.coordinates
    )


def _turned(dimension: object, value: Decimal) -> str:
    """An angle in degrees too."""
    return f" rad ({degrees(float(value)):.6g} deg)" if dimension == NONE else ""


def _number(value: Decimal) -> str:
    return f"{float(value):.10g}"
