"""What a checked study becomes: files by target, a summary, and the words of the check line."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil, log10
from pathlib import Path
from typing import Any

from eomgen.errors import EomgenError, UsageError
from eomgen.integrators.steps import Steps
from eomgen.mechanics import free_bodies
from eomgen.mechanics.contact_forms import ContactForms
from eomgen.mechanics.free_bodies import FreeBodies
from eomgen.program import Program
from eomgen.render.code_context import Style, coded
from eomgen.render.notes import Notes
from eomgen.render.notes_links import Links
from eomgen.render.targets import TARGETS, Named, render
from eomgen.render.templating import environment
from eomgen.spec.report import escaped
from eomgen.study import Report, Study


@dataclass(frozen=True)
class Wish:
    """What the user asked for."""

    targets: tuple[str, ...]
    language: str = "en"
    templates: Path | None = None
    steps: bool = False
    functions: tuple[str, ...] = ()  # of C and Python; (): the standard ones
    integrators: tuple[str, ...] = ()
    compensated: bool = False
    style: Style = Style()
    stability: tuple[str, ...] | None = None  # inputs NAME=VALUE of its findings in the C header


def _notes(study: Study, wish: Wish) -> Named:
    line = check_line(study.report, wish.language)
    shown: Links | None = None
    touching: tuple[ContactForms, ...] = ()
    if study.links is not None:
        from eomgen.output_links import contacts, links

        touching = contacts(study.machine)
        shown = links(study.links.scene.report, study.links.chosen, wish.language)
    worked = study.worked if study.is_worked_apart else None
    free = _free_bodies(study, wish)
    return Notes(study.derivation, wish.language, line, wish.steps, shown, worked, free, touching)


def _free_bodies(study: Study, wish: Wish) -> FreeBodies | None:
    """What holds the bodies, where the notes show it: Newton's page does, the text with steps."""
    if study.worked is not None and isinstance(study.worked.steps, FreeBodies):
        return study.worked.steps
    return free_bodies.short(study.model) if wish.steps or "latex" in wish.targets else None


def _program(study: Study, wish: Wish) -> Named:
    return coded(_chosen(study, wish), wish.style)


def _c_program(study: Study, wish: Wish) -> Named:
    if wish.stability is None:
        return _program(study, wish)
    from eomgen.stability import header, make, records

    found = make.findings(study, records.Wish(inputs=wish.stability))
    return replace(coded(_chosen(study, wish), wish.style), remarks=header.remarks(found))


def _chosen(study: Study, wish: Wish) -> Program:
    """The program with the functions that were asked for, and those that integrators call."""
    steps = _steps(study, wish) if wish.integrators else None
    program = study.program if steps is None else steps.program
    if not wish.functions:
        return program
    from eomgen.functions import table

    chosen = table.select(program, study.compiled, wish.functions)
    return chosen if steps is None else steps.completing(chosen)


def _steps(study: Study, wish: Wish) -> Steps:
    from eomgen import stepping

    return stepping.of(study, wish.integrators, compensated=wish.compensated)


SUBJECTS: dict[str, Callable[[Study, Wish], Named]] = {
    "latex": _notes,
    "text": _notes,
    "c": _c_program,
    "c-steps": _steps,
    "python": _program,
}


def rendered(study: Study, wish: Wish) -> dict[str, str]:
    """File name -> text for every target that was asked for.

    Raises:
        UsageError: a template of the user is wrong, or a function is unknown.
    """
    if wish.functions and not {"c", "python"} & {*wish.targets}:
        raise UsageError("--functions: only C and Python have functions; add -t c or -t python")
    templates = environment(wish.templates)
    made: dict[str, str] = {}
    for target in dict.fromkeys(wish.targets):
        made |= render(SUBJECTS[target](study, wish), TARGETS[_page(study, target)], templates)
    return made


def _page(study: Study, target: str) -> str:
    """The row of the table of targets: that of the formalism, where it has pages of its own."""
    method = study.worked.name if study.is_worked_apart and study.worked is not None else ""
    return f"{target}-{method}" if f"{target}-{method}" in TARGETS else target


TITLES = {
    "newton": "Newton",
    "dalembert": "d'Alembert",
    "lagrange": "Lagrange",
    "lagrange1": "{lagrange1}",
    "kane": "Kane",
}
WORDS = {
    "en": {
        "checked": "checked",
        "routes": "Lagrange = Newton-Euler",
        "lagrange1": "Lagrange of the first kind",
        "energies": "Lagrange in closed form = Lagrange on the graph",
        "recursion": "Lagrange by differentiation = recursive Newton-Euler",
        "projection": "d'Alembert = recursive Newton-Euler",
        "identity": "inverse after forward dynamics = identity below {error}",
        "proven": "identical in exact arithmetic and",
        "states": "at {states} random states, worst relative error below {error}",
        "digits": " (in {digits} digits)",
        "power": "power balance below {error}",
        "terms": "dimensions of {terms} terms",
        "claims": "claims of the author: {claims}",
        "formulations": "formulations {names} at admissible states",
    },
    "es": {
        "checked": "comprobado",
        "routes": "Lagrange = Newton-Euler",
        "lagrange1": "Lagrange de primera especie",
        "energies": "Lagrange en forma cerrada = Lagrange en el grafo",
        "recursion": "Lagrange por derivación = Newton-Euler recursivo",
        "projection": "d'Alembert = Newton-Euler recursivo",
        "identity": "dinámica inversa tras la directa = identidad hasta {error}",
        "proven": "idénticas en aritmética exacta y",
        "states": "en {states} estados aleatorios, peor error relativo menor que {error}",
        "digits": " (con {digits} dígitos)",
        "power": "balance de potencia menor que {error}",
        "terms": "dimensiones de {terms} términos",
        "claims": "afirmaciones del autor: {claims}",
        "formulations": "formulaciones {names} en estados admisibles",
    },
}


def check_line(report: Report, language: str) -> str:
    """How the tool knows that what it prints is true, in one line."""
    words, found = WORDS[language], report.agreement
    states = words["states"].format(states=found.states, error=bound(found.error))
    digits = words["digits"].format(digits=found.digits) if found.digits > 16 else ""
    proven = f"{words['proven']} " if found.proven else ""
    routes = _routes(report, words)
    parts = [
        f"{routes}, {proven}{states}{digits}",
        words["power"].format(error=bound(report.power)),
    ]
    if report.identity is not None:
        parts.append(words["identity"].format(error=bound(report.identity)))
    if len(report.formulations) > 1:
        parts.append(words["formulations"].format(names=" = ".join(report.formulations)))
    if report.terms:
        parts.append(words["terms"].format(terms=report.terms))
    if report.claims:
        parts.append(words["claims"].format(claims=report.claims))
    return f"{words['checked']}: " + "; ".join(parts)


def _routes(report: Report, words: dict[str, str]) -> str:
    """What was compared with what."""
    if len(report.principles) > 1:
        return " = ".join(TITLES[name].format(**words) for name in report.principles)
    return words[report.routes]


def bound(error: float) -> str:
    """A power of ten above the error: the last bits differ between machines, this does not."""
    return f"1e{ceil(log10(max(error, 1e-15)))}"


def summary(spec: str, study: Study, format_: str) -> str:
    """One line, or one JSON object, for a spec that passed."""
    return SUMMARIES[format_](spec, study)


def _text_summary(spec: str, study: Study) -> str:
    count = study.freedom
    freedom = f"{count} degree{'s' if count != 1 else ''} of freedom"
    words = [freedom, *_linked_words(study), *_engine_words(study)]
    said = "; ".join([*words, check_line(study.report, "en")])
    return "\n    ".join([f"{spec}: {said}", *_initial_words(study), *study.report.warnings])


def _initial_words(study: Study) -> tuple[str, ...]:
    """How far the initial state was moved to the constraints, and other assembly modes."""
    if study.links is None:
        return ()
    from eomgen.analysis.admissible import describe

    return describe(study.machine, study.links.scene.report.initial)


def _engine_words(study: Study) -> list[str]:
    """How accelerations are computed."""
    return [f"engine: {study.engine}"] if study.engine else []


def _linked_words(study: Study) -> list[str]:
    """The formulation of a linked scene and the warnings on its constraints."""
    if study.links is None:
        return []
    chosen = study.links.chosen
    return [f"{chosen.name} ({chosen.why})", *study.links.scene.report.freedom.warnings]


def _json_summary(spec: str, study: Study) -> str:
    report = study.report
    return json.dumps(
        {
            "file": spec,
            "degrees_of_freedom": study.freedom,
            "states": report.agreement.states,
            "relative_error": report.agreement.error,
            "proven": report.agreement.proven,
            "power_balance": report.power,
            "terms": report.terms,
            "claims": report.claims,
            "engine": study.engine,
            **_warnings(study),
            **_linked_json(study),
        }
    )


def _warnings(study: Study) -> dict[str, list[str]]:
    """What is true and yet may surprise; a free scene without any says nothing."""
    linked = () if study.links is None else study.links.scene.report.freedom.warnings
    found = [*study.report.warnings, *linked]
    return {"warnings": found} if found or study.links is not None else {}


def _linked_json(study: Study) -> dict[str, Any]:
    """The cards of a linked scene, and what was decided."""
    if study.links is None:
        return {}
    from eomgen.analysis.cards import to_json

    freedom = study.links.scene.report.freedom
    return {
        "formulation": study.links.chosen.name,
        "formulations": list(study.links.formulations),
        "coordinates": freedom.coordinates,
        "minimal_coordinates": freedom.minimal_coordinates,
        "independent": list(freedom.basis.independent),
        "constraints": [to_json(card) for card in study.links.scene.report.cards],
    }


def _github_summary(spec: str, study: Study) -> str:
    return f"::notice file={escaped(spec, ':,')}::{escaped(check_line(study.report, 'en'))}"


SUMMARIES: dict[str, Callable[[str, Study], str]] = {
    "text": _text_summary,
    "json": _json_summary,
    "github": _github_summary,
}


def complaint(error: EomgenError, format_: str, source: str) -> str:
    """A mistake without a place in the text, one line for each."""
    return COMPLAINTS[format_](str(error), source)


COMPLAINTS: dict[str, Callable[[str, str], str]] = {
    "text": lambda message, source: "\n".join(
        f"{source}: error: {line}" for line in message.splitlines()
    ),
    "json": lambda message, source: json.dumps(
        [{"file": source, "message": line} for line in message.splitlines()], ensure_ascii=False
    ),
    "github": lambda message, source: "\n".join(
        f"::error file={escaped(source, ':,')}::{escaped(line)}" for line in message.splitlines()
    ),
}
