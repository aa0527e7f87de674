"""Which equations a linked scene becomes: minimal, null space or multipliers, and why."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from eomgen.algebra.arithmetic import FLOAT
from eomgen.algebra.closed import ClosedForm, Evaluation
from eomgen.algebra.normal import Form
from eomgen.analysis.admissible import Admissible
from eomgen.analysis.cards import Report
from eomgen.compile import Machine
from eomgen.errors import UsageError
from eomgen.mechanics import constraints, lagrange, minimal, minimal_graph, nullspace
from eomgen.mechanics.minimal import Elimination, Residual
from eomgen.model import Model

NAMES = ("auto", "minimal", "nullspace", "multiplier")
LEAST_DISCRIMINANT = 0.05  # of its largest value over the sampled states


@dataclass(frozen=True)
class Linked:
    """A linked scene with everything that a choice looks at."""

    machine: Machine  # over all coordinates and rates, with the independent rows
    report: Report

    @property
    def model(self) -> Model:
        """The scene."""
        return self.machine.model

    @property
    def asks_reactions(self) -> bool:
        """Whether the author asks for a constraint force."""
        return any(c.reaction for c in self.model.constraints)

    def decided(self) -> dict[str, Any]:
        """Initial values in 50 digits that the spec states or the constraints decide.

        A coordinate with an initial value or a guess; the rate of a dependent coordinate where
        the independent rates are stated.
        """
        stated = self.model.initial.keys() | self.model.guess.keys()
        independent = self.report.freedom.basis.independent
        rates = {c.name: c.rate.name for c in self.model.coordinates}
        follows = all(rates[name] in stated for name in independent)
        state = self.report.initial.state
        found: dict[str, Any] = {}
        places = zip(self.model.coordinates, state.coordinates, state.rates, strict=True)
        for c, place, rate in places:
            if c.name in stated:
                found[c.name] = place
            if c.rate.name in stated or (follows and c.name not in independent):
                found[c.rate.name] = rate
        return found


@dataclass(frozen=True)
class Formulation:
    """A machine whose accelerations are those of the linked scene."""

    name: str
    why: str
    machine: Machine


def linked(machine: Machine, report: Report) -> Linked:
    """The scene with its independent rows."""
    kept = tuple(r.name for r in machine.rows if r.name not in report.freedom.dropped)
    return Linked(replace(machine, kept=kept), report)


def choose(scene: Linked, wanted: str = "auto") -> Formulation:
    """The formulation that was asked for, or the first of the ladder that fits.

    Raises:
        UsageError: what was asked for does not exist for this scene; it says why.
    """
    if wanted != "auto":
        return MAKERS[wanted](scene)
    if not scene.machine.kept:
        return replace(MAKERS["multiplier"](scene), why="no constraint is bilateral")
    if scene.asks_reactions:
        return replace(MAKERS["multiplier"](scene), why="reactions are asked for")
    for name in ("minimal", "nullspace"):
        try:
            return MAKERS[name](scene)
        except UsageError:
            continue
    return replace(MAKERS["multiplier"](scene), why="the rank of the constraints changes")


def available(scene: Linked) -> tuple[Formulation, ...]:
    """Every formulation that exists for the scene."""
    found = []
    for maker in MAKERS.values():
        try:
            found.append(maker(scene))
        except UsageError:
            continue
    return tuple(found)


def _multiplier(scene: Linked) -> Formulation:
    return Formulation("multiplier", "it was asked for", scene.machine)


def _refuse_free(scene: Linked, name: str) -> None:
    if not scene.machine.kept:
        raise UsageError(f"{name}: no bilateral constraint reduces this scene; use multiplier")


def _nullspace(scene: Linked) -> Formulation:
    _refuse_free(scene, "nullspace")
    if scene.report.freedom.singularities:
        raise UsageError("nullspace: the constraints lose rank inside `range`; use multiplier")
    basis = scene.report.freedom.basis
    at = _arguments(scene, scene.report.initial, basis.independent)
    found = nullspace.derive(scene.model, basis.independent, scene.machine.kept, at)
    why = f"constant rank; the speeds are the rates of {', '.join(basis.independent) or 'nothing'}"
    return Formulation("nullspace", why, Machine(found.kinematics, (), found.pivots))


def _arguments(
    scene: Linked, state: Admissible, independent: Sequence[str]
) -> dict[str, list[float]]:
    """The arguments of a program over all coordinates and the independent rates."""
    names = [c.name for c in scene.model.coordinates]
    rates = [state.state.rates[names.index(n)] for n in names if n in independent]
    return {
        "time": [float(state.state.time)],
        "state": [float(v) for v in (*state.state.coordinates, *rates)],
        "parameters": [float(v) for v in state.state.parameters],
    }


def _minimal(scene: Linked) -> Formulation:
    _refuse_free(scene, "minimal")
    if any(c.kind == "nonholonomic" for c in scene.model.constraints):
        raise UsageError("minimal: a nonholonomic constraint eliminates no coordinate")
    found = _eliminations(scene)
    _refuse_dead_points(scene, found)
    try:
        chosen = minimal_graph.choose(found, _values(scene, scene.report.initial))
    except ValueError as error:
        raise UsageError(f"minimal: {error}") from error
    names = ", ".join(c.coordinate.name for c in chosen)
    branches = [
        f"{c.coordinate.name}: {minimal.BRANCHES[c.branch]:+d}" for c in chosen if c.discriminant
    ]
    tail = f", branch {', '.join(branches)}" if branches else ""
    machine = Machine(minimal_graph.kinematics(scene.model, chosen))
    return Formulation("minimal", f"{names} eliminated in closed form{tail}", machine)


def _eliminations(scene: Linked) -> tuple[Elimination, ...]:
    """Formulas for the dependent coordinates.

    Raises:
        UsageError: some coordinate cannot be solved for.
    """
    kinematics = lagrange.closed_kinematics(scene.model)
    algebra = kinematics.algebra
    assert isinstance(algebra, ClosedForm)
    rows = [r for r in constraints.rows(kinematics) if r.name in scene.machine.kept]
    residuals = [Residual((r.name,), r.residual) for r in rows if r.residual is not None]
    dependent = scene.report.freedom.basis.dependent
    chosen = [c for c in scene.model.coordinates if c.name in dependent]
    symbols = [c.symbol for c in scene.model.coordinates]
    found = minimal.eliminations(algebra, residuals, chosen, symbols)
    if found is None:
        raise UsageError("minimal: the constraints cannot be solved in closed form; use nullspace")
    return found


def _refuse_dead_points(scene: Linked, found: Sequence[Elimination]) -> None:
    """A formula whose root nearly vanishes in the sampled range is not safe."""
    for elimination in found:
        if elimination.discriminant is None:
            continue
        sizes = [
            _number(elimination.discriminant, scene, state)
            for state in (scene.report.initial, *scene.report.states)
        ]
        if min(sizes) < LEAST_DISCRIMINANT * max(abs(s) for s in sizes):
            raise UsageError(
                f"minimal: W-DEAD: {elimination.coordinate.name} has a dead point inside `range`; "
                "narrow the range or use nullspace"
            )


def _values(scene: Linked, state: Admissible) -> dict[object, float]:
    """Values of the symbols of a configuration."""
    bindings = scene.machine.kinematics.algebra.bindings
    leaves = {
        node: float(state.state.read(node.datum))
        for node in scene.machine.leaves
        if node.datum.argument != "inputs"
    }
    return {s: leaves[node] for s, node in bindings.items() if node in leaves}


def _number(form: Form, scene: Linked, state: Admissible) -> float:
    apply = Evaluation(_values(scene, state), float, lambda name, *a: FLOAT.functions[name](*a)).of
    return float(apply(form))


MAKERS: dict[str, Callable[[Linked], Formulation]] = {
    "minimal": _minimal,
    "nullspace": _nullspace,
    "multiplier": _multiplier,
}
