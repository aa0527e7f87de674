"""The one-page compiler: spec text -> model -> two derivations -> checks -> program.

text ─ spec.read ─► Model ─┬─ lagrange.derive ─► Derivation (closed form) ─┐
                           └─ compile.machine_of ─► Machine (graph) ───────┴─ checks ─► Report
                                                       └─ compile.program ─► Program
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from eomgen import compile
from eomgen.algebra.normal import TooLarge
from eomgen.checks import (
    agreement,
    dimensions,
    expectations,
    gimbal,
    mass,
    power,
    recursion,
    samples,
)
from eomgen.errors import UsageError
from eomgen.mechanics import lagrange, speeds
from eomgen.mechanics.equations import Derivation
from eomgen.model import Model
from eomgen.program import Program
from eomgen.spec import read
from eomgen.wanted import AUTO, Wanted

if TYPE_CHECKING:
    from eomgen.mechanics.principles import Worked
    from eomgen.study_linked import LinkedStudy


# degrees of freedom; above, a scene is proven on the graph unless notes are asked for
LARGEST_CLOSED = {"line": 40, "plane": 16, "solid": 6}


@dataclass(frozen=True)
class Report:
    """What was checked, and how well it held."""

    agreement: agreement.Agreement
    power: float  # worst relative error of the power balance
    terms: int  # whose dimension was checked; 0 where the spec states no units
    claims: int  # of the author, all found to hold
    routes: str  # which two derivations were compared, a key of `outputs.WORDS`
    formulations: tuple[str, ...] = ()  # of a linked scene, found to agree
    principles: tuple[str, ...] = ()  # formalisms that were compared, where one was asked for
    warnings: tuple[str, ...] = ()  # what is true and yet may surprise
    identity: float | None = None  # of inverse after forward dynamics, where that was checked


@dataclass(frozen=True)
class Study:
    """A scene that was derived twice and found consistent."""

    model: Model
    closed: Derivation | None  # None: it is too large for a closed form, and nobody asked for one
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
        if self.worked is None:
            return False
        usual = {"lagrange", "lagrange1"} if self.derivation.constraints else {"lagrange"}
        return self.worked.name not in usual

    @property
    def derivation(self) -> Derivation:
        """The closed form, for whoever asked for notes."""
        assert self.closed is not None
        return self.closed

    @property
    def engine(self) -> str:
        """How the program finds accelerations, where it goes over a tree of joints."""
        return self.program.engine

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
    return _by(_free(model, wanted), wanted.method)


def _free(model: Model, wanted: Wanted) -> Study:
    """The study of a scene that has no constraints."""
    machine = compile.machine_of(model)
    derivation = _closed(machine, wanted)
    report = recursed(machine) if derivation is None else checked(derivation, machine)
    return Study(model, derivation, machine, _program(machine, wanted), report)


def _program(machine: compile.Machine, wanted: Wanted) -> Program:
    """The program with the functions that are wanted; all where one is made of others."""
    is_plain = {*wanted.functions} <= {*compile.wanted(machine.model)}
    return compile.program(machine, wanted.functions if is_plain else ())


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


def _closed(machine: compile.Machine, wanted: Wanted) -> Derivation | None:
    """The closed form; None where the recursion can be proven instead and nobody reads notes.

    Raises:
        UsageError: it is too large, and was asked for, or there is no recursion.
    """
    model = machine.model
    needed = wanted.notes or machine.engine is None
    if not needed and len(speeds.symbols(model)) > LARGEST_CLOSED[model.space]:
        return None
    try:
        return lagrange.derive(model)
    except TooLarge as fault:
        if needed:
            raise UsageError(f"{fault}; {_need(machine)}") from fault
        return None


def _need(machine: compile.Machine) -> str:
    """Why a closed form cannot be done without, or how it can."""
    if machine.engine is None:
        return f"no recursion takes its place: {machine.tree}"
    return "only notes need it, and `generate -t c -t python` writes none"


def recursed(machine: compile.Machine) -> Report:
    """The report of a scene without a closed form.

    Raises:
        CheckError: one of the checks fails.
    """
    engine, drawn = machine.engine, samples.draw(machine.model)
    assert engine is not None
    recursion.pivots(machine, engine, drawn)
    return Report(
        terms=0,
        agreement=recursion.compare(machine, engine, drawn),
        power=power.balance(machine, drawn),
        claims=expectations.check(machine, drawn),
        routes="projection" if machine.model.speeds else "recursion",
        warnings=gimbal.warnings(machine.model),
        identity=recursion.identity(machine, engine, drawn),
    )


def _routes(model: Model) -> str:
    """Bodies were projected; else both routes start from the author's energies."""
    return "routes" if model.bodies else "energies"


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
        routes=_routes(links.derivation.model),
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
        routes=_routes(derivation.model),
        warnings=gimbal.warnings(derivation.model),
    )
