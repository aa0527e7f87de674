"""Base parameters as text and as JSON."""

from __future__ import annotations

from math import ceil, log10
from typing import Any

import mpmath

from eomgen.functions.base import Base, BaseParameter
from eomgen.mechanics.regressor import Inertial

UNITS = {0: "kg", 1: "kg m", 2: "kg m^2"}  # by the power of length
SHOWN = 6  # digits in the text
LEAST_ERROR = 1e-50


def text(base: Base) -> str:
    """The list for the terminal."""
    lines = [
        f"Inertial parameters: {len(base.parameters)}",
        f"Base parameters: {len(base.base)} (rank in 50 digits at {base.states} random states)",
    ]
    for place, (parameter, value) in enumerate(_valued(base), 1):
        unit = UNITS[base.parameters[parameter.kept].moment]
        shown = f"[{unit}]" if value is None else f"= {mpmath.nstr(value, SHOWN)} {unit}"
        lines.append(f"  {place:>2}  {base.name(parameter)} {shown}")
    names = [base.parameters[i].name for i in base.without_effect]
    lines.append(f"Without effect: {', '.join(names) or 'none'}")
    lines += _at_these_values(base)
    power = ceil(log10(max(base.error, LEAST_ERROR)))
    lines.append(f"checked: Y theta + rest = M u' + h - Q there, relative error below 1e{power}")
    return "\n".join(lines)


def _valued(base: Base) -> list[tuple[BaseParameter, Any]]:
    """Each base parameter with its value, None where the spec leaves parameters open."""
    return list(zip(base.base, base.values or [None] * len(base.base), strict=True))


def _at_these_values(base: Base) -> list[str]:
    """A warning where a coefficient is known for the spec's own parameters only."""
    special = any(not c.general for p in base.base for _, c in p.terms)
    note = "Numbers among the coefficients hold for the values of the parameters in the spec only."
    return [note] if special else []


def as_json(base: Base) -> dict[str, Any]:
    """The same as a record; numbers as doubles."""
    return {
        "inertial_parameters": [_inertial(p) for p in base.parameters],
        "base_parameters": [
            {
                "name": base.name(parameter),
                "column": base.parameters[parameter.kept].name,
                "value": None if value is None else float(value),
                "terms": _terms(base, parameter),
            }
            for parameter, value in _valued(base)
        ],
        "without_effect": [base.parameters[i].name for i in base.without_effect],
        "states": base.states,
        "error": base.error,
    }


def _inertial(parameter: Inertial[Any]) -> dict[str, Any]:
    return {"name": parameter.name, "unit": UNITS[parameter.moment]}


def _terms(base: Base, parameter: BaseParameter) -> list[dict[str, Any]]:
    return [
        {
            "parameter": base.parameters[j].name,
            "coefficient": coefficient.text,
            "value": float(coefficient.value),
            "general": coefficient.general,
        }
        for j, coefficient in parameter.terms
    ]
