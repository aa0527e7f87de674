"""The one-page compiler: spec text -> model -> two derivations -> checks -> program.

text ─ spec.read ─► Model ─┬─ lagrange.derive ─► Derivation (closed form) ─┐
                           └─ compile.machine_of ─► Machine (graph) ───────┴─ checks ─► Report
                                                       └─ compile.program ─► Program
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from eomgen import compile
from eomgen.checks import agreement, dimensions, expectations, gimbal, mass, power, samples
from eomgen.mechanics import lagrange, speeds
from eomgen.mechanics.equations import Derivation
from eomgen.model import Model
from eomgen.program import Program
from eomgen.spec import read
from eomgen.wanted import AUTO, Wanted

if TYPE_CHECKING:
    from eomgen.mechanics.principles import Worked
    from eomgen.study_linked import LinkedStudy


@dataclass(frozen=True)
class Report:
    """What was checked, and how well it held."""

    agreement: agreement.Agreement
    power: float  # worst relative error of the power balance
    terms: int  # whose dimension was checked; 0 where the spec states no units
    claims: int  # of the author, all found to hold
    projected: bool  # bodies were projected; else both routes start from the author's energies
    formulations: tuple[str, ...] = ()  # of a linked scene, found to agree
    principles: tuple[str, ...] = ()  # formalisms that were compared, where one was asked for
    warnings: tuple[str, ...] = ()  # what is true and yet may surprise


@dataclass(frozen=True)
class Study:
    """A scene that was derived twice and found consistent."""

    model: Model
    derivation: Derivation
    machine: compile.Machine
    program: Program
    report: Report
    links: LinkedStudy | None = None  # where the scene has constraints
    worked: Worked | None = None  # the formalism that was asked for

    @property
    def is_worked_apart(self) -> bool:
        """Whether a formalism was asked for that is not the one shown as ever.

        That is Lagrange's, of the first kind for a linked set of coordinates.
        """
        usual = {"lagrange", "lagrange1"} if self.derivation.constraints else {"lagrange"}
        return self.worked is not None and self.worked.name not in usual

    @property
    def compiled(self) -> compile.Machine:
        """What the program was made of: of a linked scene, the chosen formulation."""
        return self.machine if self.links is None else self.links.chosen.machine

    @property
    def freedom(self) -> int:
        """The degrees of freedom."""
        if self.links is None:
            return len(speeds.symbols(self.model))
        return self.links.scene.report.freedom.degrees_of_freedom


def of_text(text: str | bytes, file: str, wanted: Wanted = AUTO) -> Study:
    """The study of a spec; `wanted` matters where it has constraints.

    Raises:
        SpecError: the spec has mistakes, all are listed.
        UsageError: the scene cannot be derived as it is described.
        CheckError: something derived would not be true; nothing may be printed.
    """
    return of_model(read(text, file), wanted)


def of_model(model: Model, wanted: Wanted = AUTO) -> Study:
    """The study of a model; raises as `of_text`."""
    if model.constraints:
        # imported where it is needed: the analysis of constraints brings NumPy
        from eomgen import study_linked

        return _by(_linked(study_linked.of_model(model, wanted)), wanted.method)
    return _by(_free(model), wanted.method)


def _free(model: Model) -> Study:
    """The study of a scene that has no constraints."""
    derivation = lagrange.derive(model)
    machine = compile.machine_of(model)
    report = checked(derivation, machine)
    return Study(model, derivation, machine, compile.program(machine), report)


def _by(study: Study, method: str | None) -> Study:
    """The study with the formalism that was asked for, all that apply compared."""
    if method is None:
        return study
    # only a user who asks for a formalism waits for all of them
    from eomgen.checks import principles

    drawn = samples.draw(study.model)
    found = principles.compare(study.derivation, study.machine, drawn, method)
    report = replace(study.report, agreement=found.agreement, principles=found.names)
    return replace(study, report=report, worked=found.worked)


def machine_of(text: str | bytes, file: str, wanted: Wanted = AUTO) -> compile.Machine:
    """The scene on the graph, for whoever has a check of its own; what is linked is studied.

    Raises:
        SpecError, UsageError, CheckError: as `of_text`.
    """
    model = read(text, file)
    return of_model(model, wanted).compiled if model.constraints else compile.machine_of(model)


def _linked(links: LinkedStudy) -> Study:
    """The study of a linked scene."""
    report = Report(
        agreement=links.agreement,
        power=links.power,
        terms=links.terms,
        claims=links.claims,
        projected=bool(links.derivation.model.bodies),
        formulations=links.formulations,
        warnings=gimbal.warnings(links.derivation.model),
    )
    model = links.derivation.model
    return Study(model, links.derivation, links.machine, links.program(), report, links)


def checked(derivation: Derivation, machine: compile.Machine) -> Report:
    """The report of everything that is checked.

    Raises:
        CheckError: one of the checks fails.
    """
    drawn = samples.draw(derivation.model)
    mass.check(machine, drawn)
    return Report(
        terms=dimensions.check(derivation),
        agreement=agreement.compare(derivation, machine, drawn),
        power=power.balance(machine, drawn),
        claims=expectations.check(machine, drawn),
        projected=bool(derivation.model.bodies),
        warnings=gimbal.warnings(derivation.model),
    )
