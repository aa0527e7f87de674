"""Which equations a linked scene becomes: minimal, null space or multipliers, and why."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.algebra.closed import ClosedForm, Evaluation
from eomgen.algebra.graph import Node, below
from eomgen.algebra.normal import Form
from eomgen.analysis import linkage
from eomgen.analysis.admissible import Admissible
from eomgen.analysis.cards import Report
from eomgen.compile import Machine
from eomgen.errors import UsageError
from eomgen.mechanics import constraints, lagrange, minimal, minimal_graph, nullspace
from eomgen.mechanics.minimal import Elimination, Residual
from eomgen.mechanics.minimal_graph import Chosen
from eomgen.model import TIME, Model
from eomgen.wanted import AUTO, Wanted

DEAD_POINT_SAMPLES = 200
LEAST_DISCRIMINANT = 0.05  # of its largest value over the sampled states

DUST = 1e-40  # below the round-off of 50 digits


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
    def touches(self) -> bool:
        """Whether a constraint is one-sided: contact and flight need all coordinates."""
        return any(c.kind == "unilateral" for c in self.model.constraints)

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
                found[c.name] = _without_dust(place)
            if c.rate.name in stated or (follows and c.name not in independent):
                found[c.rate.name] = _without_dust(rate)
        return found


def _without_dust(value: Any) -> Any:
    """The value, or zero where only the round-off of 50 digits is left of it."""
    return value if abs(value) > DUST else type(value)(0)


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


def choose(scene: Linked, wanted: Wanted = AUTO) -> Formulation:
    """The formulation that was asked for, or the first of the ladder that fits.

    Raises:
        UsageError: what was asked for does not exist for this scene; it says why.
    """
    if wanted.baumgarte:
        return _stabilised(scene, wanted.baumgarte)
    if wanted.formulation != "auto":
        return MAKERS[wanted.formulation](scene)
    if scene.touches:
        return replace(MAKERS["multiplier"](scene), why="contact and flight, over all coordinates")
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


def _stabilised(scene: Linked, alpha: Fraction) -> Formulation:
    """Multipliers with Baumgarte's terms."""
    if not scene.machine.kept:
        raise UsageError("--baumgarte: the scene has no bilateral constraint to stabilise")
    why = f"Baumgarte alpha = {float(alpha):g}/s was asked for: it injects or removes energy"
    return Formulation("multiplier", why, replace(scene.machine, baumgarte=alpha))


def _multiplier(scene: Linked) -> Formulation:
    return Formulation("multiplier", "it was asked for", scene.machine)


def _refuse_free(scene: Linked, name: str) -> None:
    if scene.touches:
        raise UsageError(f"{name}: a one-sided constraint needs all coordinates; use multiplier")
    if not scene.machine.kept:
        raise UsageError(f"{name}: no bilateral constraint reduces this scene; use multiplier")
    if not scene.report.freedom.basis.independent:
        raise UsageError(f"{name}: the constraints hold everything fast; use multiplier")


def _nullspace(scene: Linked) -> Formulation:
    _refuse_free(scene, "nullspace")
    if scene.report.freedom.singularities:
        raise UsageError("nullspace: the constraints lose rank inside `range`; use multiplier")
    basis = scene.report.freedom.basis
    _refuse_turning_block(scene)
    at = _arguments(scene, scene.report.initial, basis.independent)
    found = nullspace.derive(scene.model, basis.independent, scene.machine.kept, at)
    why = f"constant rank; the speeds are the rates of {', '.join(basis.independent) or 'nothing'}"
    return Formulation("nullspace", why, Machine(found.kinematics, (), found.pivots))


def _refuse_turning_block(scene: Linked) -> None:
    """Dependent rates cannot be solved for where the determinant of their block changes sign."""
    names = [c.name for c in scene.model.coordinates]
    dependent = scene.report.freedom.basis.dependent
    columns = [names.index(n) for n in dependent]
    links = linkage.of(scene.machine)
    kept = [i for i, row in enumerate(links.rows) if row.name in scene.machine.kept]
    sizes = []
    for state in (scene.report.initial, *scene.report.states):
        rows = linkage.jacobian(links, state.state)
        block = [[float(rows[i][j]) for j in columns] for i in kept]
        sizes.append(float(np.linalg.det(np.array(block))))
    if min(sizes) * max(sizes) <= 0:
        raise UsageError(
            f"nullspace: W-PIVOT: {', '.join(dependent)} cannot stay dependent over the range; "
            "give other coordinates `role: free`, narrow the range, or use multiplier"
        )


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
    try:
        chosen = minimal_graph.choose(found, _values(scene, scene.report.initial))
    except ValueError as error:
        raise UsageError(f"minimal: {error}") from error
    _refuse_dead_points(scene, found, chosen)
    names = ", ".join(c.coordinate.name for c in chosen)
    rooted = [c for c in chosen if c.discriminant is not None]
    branches = ", ".join(f"{c.coordinate.name}: {minimal.BRANCHES[c.branch]:+d}" for c in rooted)
    tail = f", branch {branches}" if branches else ""
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
    # what a coefficient may not hold: it could vanish somewhere, or at some time
    symbols = [TIME, *(c.symbol for c in scene.model.coordinates)]
    symbols += [known.symbol for known in scene.model.prescribed]
    found = minimal.eliminations(algebra, residuals, chosen, symbols)
    if found is None:
        raise UsageError("minimal: the constraints cannot be solved in closed form; use nullspace")
    return found


def _refuse_dead_points(
    scene: Linked, found: Sequence[Elimination], chosen: Sequence[Chosen]
) -> None:
    """A formula whose root nearly vanishes somewhere in the range is not safe."""
    chance = random.Random(scene.model.name)
    sizes: dict[str, list[float]] = {e.coordinate.name: [] for e in found if e.discriminant}
    for _ in range(DEAD_POINT_SAMPLES):
        values = _values(scene, scene.report.initial) | _independent(scene, chance)
        for elimination, link in zip(found, chosen, strict=True):
            if elimination.discriminant is not None:
                size = _number(elimination.discriminant, values)
                sizes[elimination.coordinate.name].append(size)
                if size < 0:
                    break
            formula = elimination.branches[link.branch]
            values[elimination.coordinate.symbol] = _number(formula, values)
    for name, seen in sizes.items():
        if min(seen) < LEAST_DISCRIMINANT * max(abs(s) for s in seen):
            raise UsageError(
                f"minimal: W-DEAD: {name} has a dead point inside `range`; "
                "narrow the range or use nullspace"
            )


def _independent(scene: Linked, chance: random.Random) -> dict[Any, float]:
    """Random independent coordinates: in the declared range, else between the sampled states."""
    names = [c.name for c in scene.model.coordinates]
    states = [scene.report.initial, *scene.report.states]
    parameters = scene.report.initial.state.parameters
    drawn: dict[Any, float] = {}
    for name in scene.report.freedom.basis.independent:
        j = names.index(name)
        ends = [float(s.state.coordinates[j]) for s in states]
        if name in scene.model.range:
            ends = [
                float(linkage.constant(linkage.of(scene.machine), v, parameters))
                for v in scene.model.range[name]
            ]
        drawn[scene.model.coordinates[j].symbol] = chance.uniform(min(ends), max(ends))
    return drawn


def _values(scene: Linked, state: Admissible) -> dict[Any, float]:
    """Values of the symbols of a configuration."""
    bindings = scene.machine.kinematics.algebra.bindings
    leaves = {
        node: float(state.state.read(node.datum))
        for node in scene.machine.leaves
        if node.datum.argument != "inputs"
    }
    bound = {s: node for s, node in bindings.items() if _known(node, leaves)}
    return dict(zip(bound, evaluate(bound.values(), leaves, FLOAT), strict=True))


def _known(node: Node, leaves: Mapping[Node, float]) -> bool:
    return all(a in leaves for a in below([node]) if a.operator == "read")


def _number(form: Form, values: Mapping[Any, float]) -> float:
    """The value of a form, infinite where it is not defined."""
    try:
        return float(Evaluation(values, float, lambda n, *a: FLOAT.functions[n](*a)).of(form))
    except (ValueError, ZeroDivisionError):
        return float("inf")


MAKERS: dict[str, Callable[[Linked], Formulation]] = {
    "minimal": _minimal,
    "nullspace": _nullspace,
    "multiplier": _multiplier,
}
