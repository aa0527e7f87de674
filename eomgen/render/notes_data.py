"""The data of a scene as rows of tables: parameters, coordinates, motions, inputs."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import sympy as sp

from eomgen.algebra.closed import ClosedForm
from eomgen.model import Coordinate, Description, Input, Parameter, Prescribed, Speed
from eomgen.render import arrange
from eomgen.render.notes_page import Page

Row = Mapping[str, str]

COHERENT = frozenset(  # each counts 1 in SI
    ("kg", "m", "s", "A", "K", "rad", "Hz", "N", "Nm", "J", "W", "Pa", "V", "C", "F", "H", "T")
    + ("Ohm", "\u03a9")
)
LONGEST = 12  # figures of a decimal number that is written out


def parameter(page: Page, given: Parameter) -> Row:
    """Symbol, meaning, and the value in SI or the formula."""
    row = _row(page, given.symbol.name, given.description)
    if given.value is None:
        return {**row, "unit": "", "value": closed(page, given.formula) if given.formula else ""}
    unit = page.style.unit(si_unit(given.description))
    return {**row, "unit": unit, "value": number(page, given.value)}


def coordinate(page: Page, given: Coordinate | Input) -> Row:
    """Symbol, meaning and unit."""
    return _row(page, given.symbol.name, given.description)


def motion(page: Page, given: Prescribed | Speed) -> Row:
    """Symbol, meaning, unit and formula."""
    row = _row(page, given.symbol.name, given.description)
    return {**row, "value": closed(page, given.formula)}


def _row(page: Page, symbol: str, described: Description) -> dict[str, str]:
    return {
        "symbol": page.style.symbol(symbol),
        "meaning": page.style.words(described.about),
        "unit": page.style.unit(described.unit),
    }


def closed(page: Page, expression: sp.Expr) -> str:
    """A formula of the spec."""
    return page.style.formula(arrange.motion(page.arranger, ClosedForm().of(expression)))


def si_unit(described: Description) -> str:
    """The unit of a value in SI: the author's own where it is coherent, else base units."""
    letters = "".join(c if c.isalpha() or c in "%\u00b0" else " " for c in described.unit)
    if all(name in COHERENT for name in letters.split()):
        return described.unit
    base = str(described.dimension) if described.dimension is not None else described.unit
    return "" if base == "1" else base


def number(page: Page, value: sp.Expr) -> str:
    """An exact value: a decimal number where it is a short one, else a formula."""
    if not value.is_Rational:
        return closed(page, value)
    exact = Fraction(int(value.p), int(value.q))
    decimal = repr(float(exact)).removesuffix(".0")
    if len(decimal) <= LONGEST and Fraction(decimal) == exact:
        return page.style.number(decimal)
    return closed(page, value)


def tables(page: Page) -> dict[str, Any]:
    """All tables of the page by name; an empty one is an empty tuple."""
    model = page.derivation.model
    return {
        "parameters": tuple(parameter(page, p) for p in model.parameters),
        "coordinates": tuple(coordinate(page, c) for c in model.coordinates),
        "speeds": tuple(motion(page, s) for s in model.speeds if s.symbol != s.formula),
        "prescribed": tuple(motion(page, p) for p in model.prescribed),
        "inputs": tuple(coordinate(page, i) for i in model.inputs),
    }
