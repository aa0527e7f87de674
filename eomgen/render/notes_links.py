"""What is known of the constraints of a scene: plain data that the notes show beside a derivation.

The room of the analysis decides it. Whoever fills this record writes

    def links(report: cards.Report) -> Links

Field by field: `growth` of a card is `report.integrability.growth` where the card is not holonomic,
else (); its `hidden` has one entry for each of its rows; `combined` is made of
`report.integrability.combinations`; `displacements` is `report.freedom.basis.formulas`.
"""

from __future__ import annotations

from dataclasses import dataclass

from eomgen.algebra.normal import Form


@dataclass(frozen=True)
class LinkCard:
    """One constraint: its three answers and its forms, one form for each of its rows."""

    name: str
    text: str  # as it was written
    rows: tuple[str, ...]
    is_bilateral: bool
    is_scleronomic: bool
    is_holonomic: bool  # it holds between positions, or can be integrated
    is_stated_in_rates: bool  # then a residual is the rate itself
    residuals: tuple[Form, ...]  # = 0, or the gap >= 0
    rates: tuple[Form, ...]
    virtual: tuple[Form, ...]  # linear in the virtual displacements, at frozen time
    hidden: tuple[Form | None, ...] = ()  # a constant of every motion, found behind a rate row
    growth: tuple[int, ...] = ()  # dimensions of the admissible directions with their brackets
    redundant: tuple[str, ...] = ()  # rows that follow from other rows


@dataclass(frozen=True)
class Combination:
    """Rows that can be integrated together though none of them can alone."""

    rows: tuple[str, ...]
    relation: Form  # a constant of every motion


@dataclass(frozen=True)
class Links:
    """The constraints of a scene, and how much they leave free."""

    cards: tuple[LinkCard, ...]
    coordinates: int
    rank: int  # of all rows
    degrees_of_freedom: int
    minimal_coordinates: int
    states: int  # admissible states at which the rank was found
    independent: tuple[str, ...]  # coordinates whose virtual displacements are a basis
    displacements: tuple[tuple[str, Form], ...] | None = None  # of the others; None: not known
    combined: tuple[Combination, ...] = ()
    is_time_counted: bool = False  # the dimensions of `growth` count the time as a coordinate
    warnings: tuple[str, ...] = ()  # with their codes
    sentences: tuple[str, ...] = ()  # in the language of the page: the formulation, and why
