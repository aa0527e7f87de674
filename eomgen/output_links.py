"""What the analysis decided of a scene's constraints, as the record that the notes show."""

from __future__ import annotations

import re

from eomgen.analysis.cards import Card, Report
from eomgen.compile import Machine
from eomgen.formulation import Formulation
from eomgen.mechanics import contact_forms
from eomgen.mechanics import contacts as mechanics_contacts
from eomgen.mechanics.contact_forms import ContactForms
from eomgen.render.notes_links import Combination, LinkCard, Links

SENTENCES = {
    "en": "Formulation of the generated code: {name} ({why}).",
    "es": "Formulación del código generado: {name} ({why}).",
}

REASONS = {  # language -> (a part of `Formulation.why`, the same in that language)
    "es": (
        ("reactions are asked for", "se piden reacciones"),
        ("it was asked for", "así se ha pedido"),
        ("`simulate` of the spec asks for it", "lo pide `simulate` en la especificación"),
        ("contact and flight, over all coordinates", "contacto y vuelo, en todas las coordenadas"),
        (
            "stick and slip, over all coordinates",
            "adherencia y deslizamiento, en todas las coordenadas",
        ),
        ("constant rank", "rango constante"),
        ("the speeds are the rates of (.+)", r"las velocidades independientes son las de \1"),
        ("the speeds are (.+)", r"las velocidades son \1"),
        (
            "(.+) eliminated in closed form, branch (.+)",
            r"en forma cerrada se eliminan \1, rama \2",
        ),
        ("(.+) eliminated in closed form", r"en forma cerrada se eliminan \1"),
        (
            "M is singular where the constraints decide: (.+) stands for it",
            r"M es singular donde deciden las ligaduras: la sustituye \1",
        ),
        (
            "Baumgarte alpha = (.+) was asked for: it injects or removes energy",
            r"se ha pedido Baumgarte con alfa = \1: aporta o quita energía",
        ),
        ("the constraints lose rank inside `range`", "las ligaduras pierden rango en `range`"),
        ("no bilateral constraint reduces this scene", "ninguna ligadura bilateral la reduce"),
        ("the constraints hold everything fast", "las ligaduras no dejan moverse nada"),
    ),
}

WARNINGS = {  # language -> (a warning of the analysis, the same in that language)
    "es": (
        (
            r"W-RANK: constraint (.+) depends on (.+) \(rank (\d+) of (\d+)\); dropped\. "
            r"Reaction forces of (.+) are not unique\.",
            r"W-RANK: la ligadura \1 depende de \2 (rango \3 de \4); se omite. "
            r"Las fuerzas de reacción de \5 no son únicas.",
        ),
        (
            r"W-SING: constraint (.+) loses rank near (.+)\. "
            r"Eliminated coordinates are unsafe there, and reaction forces are not unique\.",
            r"W-SING: la ligadura \1 pierde rango cerca de \2. "
            r"Allí no conviene eliminar coordenadas, y las fuerzas de reacción no son únicas.",
        ),
        (
            r"W-SING: constraints (.+) lose rank near (.+)\. "
            r"Eliminated coordinates are unsafe there, and reaction forces are not unique\.",
            r"W-SING: las ligaduras \1 pierden rango cerca de \2. "
            r"Allí no conviene eliminar coordenadas, y las fuerzas de reacción no son únicas.",
        ),
    ),
}


def reason(why: str, language: str) -> str:
    """Why a formulation was chosen; a part without a translation stays as the tool says it."""
    return "; ".join(_said(part, REASONS.get(language, ())) for part in why.split("; "))


def _said(part: str, table: tuple[tuple[str, str], ...]) -> str:
    for pattern, there in table:
        found = re.fullmatch(pattern, part)
        if found:
            return found.expand(there)
    return part


def links(report: Report, chosen: Formulation, language: str) -> Links:
    """The record of a scene's constraints."""
    freedom = report.freedom
    said = SENTENCES[language].format(name=chosen.name, why=reason(chosen.why, language))
    return Links(
        cards=tuple(_card(card, report) for card in report.cards),
        coordinates=freedom.coordinates,
        rank=freedom.rank,
        degrees_of_freedom=freedom.degrees_of_freedom,
        minimal_coordinates=freedom.minimal_coordinates,
        states=freedom.states,
        independent=freedom.basis.independent,
        displacements=freedom.basis.formulas,
        combined=tuple(
            Combination(tuple(row for row, _ in found.shares), found.relation)
            for found in report.integrability.combinations
        ),
        is_time_counted=report.integrability.with_time,
        warnings=tuple(_said(w, WARNINGS.get(language, ())) for w in freedom.warnings),
        sentences=(said,),
    )


def _card(card: Card, report: Report) -> LinkCard:
    relations = {row: h.relation for h in card.hidden for row, _ in h.shares}
    return LinkCard(
        name=card.name,
        text=card.text,
        rows=card.rows,
        is_bilateral=card.is_bilateral,
        is_scleronomic=card.is_scleronomic,
        is_holonomic=card.is_holonomic,
        is_stated_in_rates=card.kind == "nonholonomic",
        residuals=card.residuals,
        rates=card.rates,
        virtual=card.virtual,
        hidden=tuple(relations.get(row) for row in card.rows),
        growth=() if card.is_holonomic or not card.is_bilateral else report.integrability.growth,
        redundant=card.redundant,
    )


def contacts(machine: Machine) -> tuple[ContactForms, ...]:
    """The one-sided constraints in closed form, with the points where friction acts."""
    found = mechanics_contacts.of(machine)
    points = {c.name: c.touch.point for c in found if c.touch is not None}
    return contact_forms.of(machine.model, points)
