"""The numbers that a search for equilibria starts from: what is given, and where to look."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Any

import sympy as sp

from eomgen.algebra.normal import Form
from eomgen.analysis.equilibrium_polynomials import Usage
from eomgen.dimension import FORCE, LENGTH, NONE
from eomgen.errors import UsageError
from eomgen.mechanics import machine
from eomgen.model import TIME, Coordinate, Model

REACH = 10  # lengths are searched up to so many times the size of the scene
Number = Any  # int, float, Fraction, Decimal or a SymPy number, which has no types


@dataclass(frozen=True)
class Given:
    """Exact values of everything that is no coordinate; `unset` inputs are taken as zero."""

    free: Mapping[sp.Symbol, sp.Expr]  # time, inputs, parameters without a formula
    everything: Mapping[sp.Symbol, sp.Expr]  # derived parameters and prescribed motions too
    inputs: Mapping[str, sp.Expr]
    time: sp.Expr
    unset: tuple[str, ...]

    def value(self, formula: sp.Expr) -> sp.Expr:
        """A formula of constants as a number."""
        return formula.xreplace(dict(self.everything))


@dataclass(frozen=True)
class Region:
    """Where a coordinate is searched; `declared` by the spec, or an angle within one turn."""

    low: float
    high: float
    periodic: bool
    declared: bool
    is_angle: bool
    positive: bool


def given(
    model: Model, inputs: Mapping[str, Number], time: Number, parameters: Mapping[str, Number]
) -> Given:
    """All values, exactly.

    Raises:
        UsageError: a name is unknown, or a parameter has no value.
    """
    _known("input", inputs, [i.name for i in model.inputs])
    settable = machine.free_parameters(model)
    _known("parameter", parameters, [p.name for p in settable])
    values: dict[sp.Symbol, sp.Expr] = {TIME: exact(time)}
    loads = {i.name: exact(inputs.get(i.name, 0)) for i in model.inputs}
    values |= {i.symbol: loads[i.name] for i in model.inputs}
    missing = [p.name for p in settable if p.value is None and p.name not in parameters]
    if missing:
        raise UsageError(
            f"statics needs numbers: {', '.join(missing)} has no value in the spec; give one"
        )
    for p in settable:
        values[p.symbol] = exact(parameters[p.name]) if p.name in parameters else p.value
    unset = tuple(i.name for i in model.inputs if i.name not in inputs)
    return Given(values, _derived(model, values), loads, values[TIME], unset)


def exact(value: Number) -> sp.Expr:
    """The number as a person wrote it: 0.1 is 1/10."""
    if isinstance(value, sp.Expr):
        return value
    fraction = Fraction(Decimal(repr(value))) if isinstance(value, float) else Fraction(value)
    return sp.Rational(fraction.numerator, fraction.denominator)


def _known(what: str, names: Iterable[str], allowed: Sequence[str]) -> None:
    for name in names:
        if name not in allowed:
            near = difflib.get_close_matches(name, allowed, 1, 0.6)
            hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(allowed) or '-'}"
            raise UsageError(f"unknown {what} {name!r}; {hint}")


def _derived(model: Model, values: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
    """Derived parameters and prescribed motions added; these stand still."""
    found = dict(values)
    waiting = {p.symbol: p.formula for p in model.parameters if p.formula is not None}
    while waiting:
        ready = [s for s, f in waiting.items() if f.free_symbols <= found.keys()]
        assert ready, "the spec reader refuses parameters that depend on each other in a circle"
        found |= {s: waiting.pop(s).xreplace(found) for s in ready}
    for known in model.prescribed:
        found[known.symbol] = known.formula.xreplace(found)
        found |= {known.rate: sp.S.Zero, known.acceleration: sp.S.Zero}
    return found


def regions(model: Model, values: Given, seen: Usage) -> tuple[Region, ...]:
    """Where every coordinate is searched."""
    reach = REACH * size(model, values)
    return tuple(_region(model, values, seen, c, reach) for c in model.coordinates)


def _region(
    model: Model, values: Given, seen: Usage, coordinate: Coordinate, reach: float
) -> Region:
    periodic = seen.is_periodic(coordinate.symbol)
    angle = _is_angle(coordinate, seen)
    positive = bool(coordinate.positive or coordinate.symbol.is_positive)
    if coordinate.name in model.range:
        low, high = (float(values.value(v)) for v in model.range[coordinate.name])
        return Region(low, high, periodic, True, angle, positive)
    half = float(sp.pi) if angle else reach
    return Region(0.0 if positive else -half, half, periodic, False, angle, positive)


def _is_angle(coordinate: Coordinate, seen: Usage) -> bool:
    """A plain number with a unit, or without units, what stands in sine and cosine alone."""
    if coordinate.description.dimension is not None:
        return coordinate.description.dimension == NONE
    return coordinate.symbol in seen.factors


def size(model: Model, values: Given) -> float:
    """The largest length that the spec names, or the sag of the weights on the softest spring."""
    lengths = [
        abs(float(values.everything[p.symbol]))
        for p in model.parameters
        if p.description.dimension in (None, LENGTH)
    ]
    lengths += [
        abs(float(values.value(v)))
        for c in model.coordinates
        for known in (model.initial, model.guess)
        if (v := known.get(c.name)) is not None and c.description.dimension in (None, LENGTH)
    ]
    sag = _sag(model, values)
    return max([*lengths, sag]) or 1.0


def _sag(model: Model, values: Given) -> float:
    """All weights and inputs on the softest spring."""
    stiffness = [
        float(values.everything[p.symbol])
        for p in model.parameters
        if p.description.dimension == FORCE / LENGTH
    ]
    soft = [k for k in stiffness if k > 0]
    masses = (values.value(b.mass) for b in model.bodies)
    constant = sum(abs(float(m)) for m in masses if not m.free_symbols)
    pull = [abs(float(v)) for g in model.gravity if not (v := values.value(g)).free_symbols]
    loads = sum(abs(float(v)) for v in values.inputs.values())
    return (constant * max(pull, default=0.0) + loads) / min(soft) if soft else 0.0


def substituted(values: Given, algebra: Any) -> dict[sp.Symbol, Form]:
    """The values as closed forms."""
    return {s: algebra.of(v) for s, v in values.everything.items()}
