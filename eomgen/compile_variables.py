"""The components of a program's arguments, as the spec describes them."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from eomgen.dimension import NONE, TIME, Dimension
from eomgen.mechanics import speeds
from eomgen.model import TIME as TIME_SYMBOL
from eomgen.model import Coordinate, Description, Model, Prescribed, Speed
from eomgen.program import Variable
from eomgen.spec.units import si_unit


def variable(name: str, description: Description, value: sp.Expr | None = None) -> Variable:
    """A component with what the spec says of it."""
    return Variable(name, _unit(description), description.about, value)


def _unit(description: Description, per: Dimension = NONE) -> str:
    """The SI unit per time where asked; an angle keeps its name; empty where none is stated."""
    if description.dimension is None:
        return ""
    if description.dimension == NONE and description.unit:
        return "rad" if per == NONE else f"rad/{si_unit(per)}"
    return si_unit(description.dimension / per)


def moving(model: Model, of: Coordinate | Prescribed) -> Variable:
    """A coordinate with its initial value."""
    return variable(of.name, of.description, model.initial.get(of.name))


def _known(model: Model) -> dict[sp.Symbol, sp.Expr]:
    """The coordinates, rates and parameters whose values the spec gives, at t = 0."""
    values: dict[sp.Symbol, sp.Expr] = {TIME_SYMBOL: sp.S.Zero}
    for c in model.coordinates:
        values |= {s: model.initial[s.name] for s in (c.symbol, c.rate) if s.name in model.initial}
    return values | {p.symbol: p.value for p in model.parameters if p.value is not None}


def _initial(model: Model, speed: Speed, known: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr | None:
    """The speed's value where that is known which it needs."""
    value = speeds.spelled_out(model, speed.formula).xreplace(known)
    return None if value.free_symbols else value


def of_speeds(model: Model) -> tuple[Variable, ...]:
    """The declared speeds, or one rate for each coordinate."""
    if model.speeds:
        known = _known(model)
        return tuple(
            variable(s.name, s.description, _initial(model, s, known)) for s in model.speeds
        )
    return tuple(
        Variable(
            c.rate.name,
            _unit(c.description, TIME),
            f"rate of {c.name}",
            model.initial.get(c.rate.name),
        )
        for c in model.coordinates
    )
