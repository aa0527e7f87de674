"""The record of the constraints that the notes show, filled from what the analysis decides."""

from eomgen.analysis import cards
from eomgen.render.notes_links import Combination, LinkCard, Links


def links(report):
    freedom, decided = report.freedom, report.integrability
    return Links(
        cards=tuple(_card(c, report) for c in report.cards),
        coordinates=freedom.coordinates,
        rank=freedom.rank,
        degrees_of_freedom=freedom.degrees_of_freedom,
        minimal_coordinates=freedom.minimal_coordinates,
        states=freedom.states,
        independent=freedom.basis.independent,
        displacements=freedom.basis.formulas,
        combined=tuple(
            Combination(tuple(row for row, _ in h.shares), h.relation) for h in decided.combinations
        ),
        is_time_counted=decided.with_time,
        warnings=freedom.warnings,
    )


def _card(card, report):
    verdicts = {v.row: v for v in report.integrability.verdicts}
    found = [verdicts[r].hidden for r in card.rows if r in verdicts]
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
        hidden=tuple(h.relation if h else None for h in found),
        growth=() if card.is_holonomic else report.integrability.growth,
        redundant=card.redundant,
    )


def of_machine(machine):
    return links(cards.report(machine))
