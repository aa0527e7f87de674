"""The compiler's page for linked scenes: cards, freedom, formulation, checks, program."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from eomgen import compile, compile_contacts, compile_linked, compile_watch, formulation
from eomgen.analysis import cards
from eomgen.checks import agreement, dimensions, expectations, links, mass, power, samples
from eomgen.compile import Machine
from eomgen.formulation import Formulation, Linked
from eomgen.mechanics import lagrange, motions
from eomgen.mechanics.equations import Derivation
from eomgen.model import Model
from eomgen.program import Function, Program, Variable
from eomgen.wanted import AUTO, Wanted


@dataclass(frozen=True)
class LinkedStudy:
    """A linked scene that was derived in every formulation that it has, all found to agree."""

    derivation: Derivation
    scene: Linked
    chosen: Formulation
    formulations: tuple[str, ...]
    agreement: agreement.Agreement
    power: float
    terms: int
    claims: int

    @property
    def machine(self) -> Machine:
        """Over all coordinates and rates, with multipliers."""
        return self.scene.machine

    def program(self) -> Program:
        """The program of the chosen formulation."""
        return program(self.scene, self.chosen)

    def full_program(self) -> Program:
        """The program with multipliers, which answers for every coordinate."""
        return program(self.scene, formulation.choose(self.scene, Wanted("multiplier")))


def of_model(model: Model, wanted: Wanted = AUTO) -> LinkedStudy:
    """The study of a model with constraints.

    Raises:
        UsageError: the constraints cannot be imposed, or the formulation does not exist.
        CheckError: something derived would not be true.
    """
    derivation = lagrange.derive(model)
    plain = compile.machine_of(model)
    scene = formulation.linked(plain, cards.report(plain))
    everything = formulation.available(scene)
    drawn = samples.draw(model)
    mass.check(scene.machine, drawn)
    admissible = links.samples_of(scene, scene.report.states, drawn)
    links.rows(derivation, scene.machine, drawn)
    links.formulations_agree(scene, everything, admissible)
    freedom = scene.report.freedom.degrees_of_freedom
    return LinkedStudy(
        derivation=derivation,
        scene=scene,
        chosen=formulation.choose(scene, wanted),
        formulations=tuple(f.name for f in everything),
        agreement=agreement.compare(derivation, scene.machine, drawn),
        power=power.balance(scene.machine, drawn),
        terms=dimensions.check(derivation),
        claims=expectations.check(scene.machine, admissible, freedom),
    )


Extra = Callable[[Linked, Formulation], tuple[Function, ...]]


def _with_multipliers(scene: Linked, chosen: Formulation) -> tuple[Function, ...]:
    bilateral = compile_linked.functions(chosen.machine) if scene.machine.kept else ()
    return (*bilateral, *compile_contacts.functions(scene.machine))


def _with_rates(scene: Linked, chosen: Formulation) -> tuple[Function, ...]:
    return (
        *compile_linked.functions(chosen.machine, compile_linked.OVER_OWN_RATES),
        *compile_linked.functions(scene.machine, compile_linked.OVER_POSITIONS),
    )


def _with_dependents(scene: Linked, chosen: Formulation) -> tuple[Function, ...]:
    return compile_linked.dependent_functions(chosen.machine, scene.model)


EXTRAS: dict[str, Extra] = {
    "multiplier": _with_multipliers,
    "nullspace": _with_rates,
    "minimal": _with_dependents,
}


def program(scene: Linked, chosen: Formulation) -> Program:
    """The program of a formulation: the standard functions, and those of its constraints."""
    made = compile.program(chosen.machine)
    values = scene.decided()
    return replace(
        made,
        coordinates=_initialised(made.coordinates, values),
        speeds=_initialised(made.speeds, values),
        functions=_moving(
            scene, made.functions + EXTRAS[chosen.name](scene, chosen) + _watch(chosen)
        ),
    )


def _watch(chosen: Formulation) -> tuple[Function, ...]:
    found = compile_watch.function(chosen.machine, chosen.block)
    return () if found is None else (found,)


def _moving(scene: Linked, functions: tuple[Function, ...]) -> tuple[Function, ...]:
    """Without the accelerations that a rough guide has in no mode: those without its friction."""
    if not scene.model.guides:
        return functions
    smooth = {"accelerations", "state_derivative", "multipliers"}
    if motions.holds_motion(scene.model):
        smooth.add("outputs")
    return tuple(f for f in functions if f.name not in smooth)


def _initialised(variables: tuple[Variable, ...], values: dict[str, Any]) -> tuple[Variable, ...]:
    """The variables with the admissible initial state as their values."""
    return tuple(
        replace(v, value=sp.Float(str(values[v.name]), 50) if v.name in values else None)
        for v in variables
    )
