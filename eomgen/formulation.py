"""Which equations a linked scene becomes: minimal, null space or multipliers, and why."""

from __future__ import annotations

import random
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from eomgen import compile_watch
from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.algebra.closed import ClosedForm
from eomgen.algebra.graph import Node
from eomgen.algebra.walk import below
from eomgen.analysis import augmented, linkage, virtual
from eomgen.analysis.admissible import Admissible
from eomgen.analysis.cards import Report
from eomgen.analysis.elimination import Matrix
from eomgen.analysis.linkage import Linkage
from eomgen.compile import Machine
from eomgen.compile_watch import Block
from eomgen.errors import UsageError
from eomgen.mechanics import constraints, lagrange, minimal, minimal_graph, nullspace
from eomgen.mechanics.minimal import Elimination, Residual
from eomgen.mechanics.minimal_graph import Chosen, measure
from eomgen.model import TIME, Coordinate, Model, Speed
from eomgen.program import Read
from eomgen.wanted import AUTO, Wanted

DEAD_POINT_SAMPLES = 200
LEAST_DISCRIMINANT = 0.05  # of its largest value over the sampled states

DUST = 1e-40  # below the round-off of 50 digits
Values = dict[Any, float]  # of the symbols of a configuration
Measure = Callable[[Values], float]
Measured = tuple[Coordinate, Measure, Measure | None]


@dataclass(frozen=True)
class Linked:
    """A linked scene with everything that a choice looks at."""

    machine: Machine  # over all coordinates and rates, with the independent rows
    report: Report

    @property
    def model(self) -> Model:
        """The scene."""
        return self.machine.model

    @cached_property
    def links(self) -> Linkage:
        """The rows as numbers."""
        return linkage.of(self.machine)

    @cached_property
    def made(self) -> dict[str, Formulation | UsageError]:
        """Every formulation, or why the scene does not have it."""
        return {name: _attempt(maker, self) for name, maker in MAKERS.items()}

    @property
    def touches(self) -> bool:
        """Whether a constraint is one-sided or rough: its modes need all coordinates."""
        return any(c.kind == "unilateral" or c.rubs for c in self.model.constraints)

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
        return found | self._decided_speeds(found)

    def _decided_speeds(self, rates: Mapping[str, Any]) -> dict[str, Any]:
        """Declared speeds whose formulas hold known rates only."""
        unknown = {c.rate for c in self.model.coordinates if c.rate.name not in rates}
        known = [s for s in self.model.speeds if not s.formula.free_symbols & unknown]
        nodes = [self.links.kinematics.algebra.of(s.formula) for s in known]
        values = linkage.values(self.links, nodes, self.report.initial.state, linkage.PRECISE)
        return {s.name: _without_dust(v) for s, v in zip(known, values, strict=True)}


def _without_dust(value: Any) -> Any:
    """The value, or zero where only the round-off of 50 digits is left of it."""
    return value if abs(value) > DUST else type(value)(0)


@dataclass(frozen=True)
class Formulation:
    """A machine whose accelerations are those of the linked scene."""

    name: str
    why: str
    machine: Machine
    block: Block | None = None  # what gives the dependent speeds
    near: str = ""  # a coordinate that has a dead point not far from where the scene was seen


def linked(machine: Machine, report: Report) -> Linked:
    """The scene with its independent rows."""
    kept = tuple(r.name for r in machine.rows if r.name not in report.freedom.dropped)
    found = Linked(replace(machine, kept=kept), report)
    if not kept or found.touches:
        return found
    return Linked(augmented.regular(found.machine, (report.initial, *report.states)), report)


def choose(scene: Linked, wanted: Wanted = AUTO) -> Formulation:
    """The formulation that was asked for, or the first of the ladder that fits.

    Raises:
        UsageError: what was asked for does not exist for this scene; it says why.
    """
    if wanted.baumgarte:
        return _stabilised(scene, wanted.baumgarte)
    if wanted.formulation != "auto":
        return _asked(scene, wanted.formulation)
    if scene.model.simulation.formulation is not None:
        found = _asked(scene, scene.model.simulation.formulation)
        return replace(found, why="`simulate` of the spec asks for it")
    if scene.touches:
        modes = "stick and slip" if scene.model.guides else "contact and flight"
        return _multiplier_because(scene, f"{modes}, over all coordinates")
    if scene.asks_reactions:
        return _multiplier_because(scene, "reactions are asked for")
    reduced = [f for f in available(scene) if f.name != "multiplier" and not f.near]
    return reduced[0] if reduced else _multiplier_because(scene, _why_not(scene))


def _asked(scene: Linked, name: str) -> Formulation:
    found = scene.made[name]
    if isinstance(found, UsageError):
        raise found
    return found


def _why_not(scene: Linked) -> str:
    """Why nothing smaller than multipliers will do."""
    reason = str(scene.made["nullspace"]).removeprefix("nullspace: ")
    return reason.removesuffix("; use multiplier")


def available(scene: Linked) -> tuple[Formulation, ...]:
    """Every formulation that exists for the scene."""
    return tuple(f for f in scene.made.values() if isinstance(f, Formulation))


def _attempt(maker: Callable[[Linked], Formulation], scene: Linked) -> Formulation | UsageError:
    try:
        return maker(scene)
    except UsageError as error:
        return error


def _stabilised(scene: Linked, alpha: Fraction) -> Formulation:
    """Multipliers with Baumgarte's terms."""
    if not scene.machine.kept:
        raise UsageError("--baumgarte: the scene has no bilateral constraint to stabilise")
    why = f"Baumgarte alpha = {float(alpha):g}/s was asked for: it injects or removes energy"
    return Formulation("multiplier", why, replace(scene.machine, baumgarte=alpha))


def _multiplier(scene: Linked) -> Formulation:
    return _multiplier_because(scene, "it was asked for")


def _multiplier_because(scene: Linked, why: str) -> Formulation:
    if scene.machine.weight:
        weight = float(scene.machine.weight)
        why += f"; M is singular where the constraints decide: M + {weight:g} J'J stands for it"
    return Formulation("multiplier", why, scene.machine)


def _refuse_free(scene: Linked, name: str) -> None:
    if scene.touches:
        what = "a constraint with friction" if scene.model.guides else "a one-sided constraint"
        raise UsageError(f"{name}: {what} needs all coordinates; use multiplier")
    if not scene.machine.kept:
        raise UsageError(f"{name}: no bilateral constraint reduces this scene; use multiplier")
    if not scene.report.freedom.basis.independent:
        raise UsageError(f"{name}: the constraints hold everything fast; use multiplier")


def _nullspace(scene: Linked) -> Formulation:
    _refuse_free(scene, "nullspace")
    if scene.report.freedom.singularities:
        raise UsageError("nullspace: the constraints lose rank inside `range`; use multiplier")
    states = (scene.report.initial, *scene.report.states)
    matrices = [augmented.matrices(scene.machine, s)[1].tolist() for s in states]
    own = nullspace.declared(scene.model)
    columns = _dependent_columns(scene, matrices)
    _refuse_turning_block(matrices, columns, [own[j] for j in columns])
    independent = [s.name for j, s in enumerate(own) if j not in columns]
    at = _arguments(scene.report.initial)
    found = nullspace.derive(scene.model, independent, scene.machine.kept, at)
    what = "are" if scene.model.speeds else "are the rates of"
    names = ", ".join(n.removesuffix("'") for n in independent)
    why = f"constant rank; the speeds {what} {names}"
    return Formulation("nullspace", why, *_reduced(scene, found))


def _reduced(scene: Linked, found: nullspace.Reduced) -> tuple[Machine, Block]:
    """The machine over independent speeds, and the block that it is watched by."""
    values = _values(scene, scene.report.initial)
    bindings = found.kinematics.algebra.bindings
    leaves = {n: values.get(s, 0.0) for s, n in bindings.items() if isinstance(n.datum, Read)}
    block = compile_watch.block(found.determinant, found.pivots, leaves)
    left = found.kinematics.model.coordinates
    eliminated = tuple(c for c in scene.model.coordinates if c not in left)
    return Machine(found.kinematics, (), found.pivots, eliminated=eliminated), block


def _dependent_columns(scene: Linked, matrices: Sequence[Matrix]) -> list[int]:
    """The speeds to solve for: rates of dependent coordinates, or what serves best anywhere."""
    if scene.model.speeds:
        return virtual.dependent_columns(matrices)
    names = [c.name for c in scene.model.coordinates]
    return [names.index(n) for n in scene.report.freedom.basis.dependent]


def _refuse_turning_block(
    matrices: Sequence[Matrix], columns: Sequence[int], dependent: Sequence[Speed]
) -> None:
    """Dependent rates cannot be solved for where the determinant of their block changes sign."""
    blocks = ([[row[j] for j in columns] for row in m] for m in matrices)
    sizes = [float(np.linalg.det(np.array(block))) for block in blocks]
    if min(sizes) * max(sizes) <= 0:
        names = ", ".join(s.name.removesuffix("'") for s in dependent)
        raise UsageError(
            f"nullspace: W-PIVOT: {names} cannot stay dependent over the range; "
            "give other coordinates `role: free`, narrow the range, or use multiplier"
        )


def _arguments(state: Admissible) -> dict[str, list[float]]:
    """The arguments of a program, without speeds."""
    return {
        "time": [float(state.state.time)],
        "state": [float(v) for v in state.state.coordinates],
        "parameters": [float(v) for v in state.state.parameters],
    }


def _minimal(scene: Linked) -> Formulation:
    _refuse_free(scene, "minimal")
    if scene.model.speeds:
        raise UsageError("minimal: the declared speeds move all coordinates; use nullspace")
    if any(c.kind == "nonholonomic" for c in scene.model.constraints):
        raise UsageError("minimal: a nonholonomic constraint eliminates no coordinate")
    found, values = _eliminations(scene), _values(scene, scene.report.initial)
    try:
        chosen = minimal_graph.choose(found, values)
    except ValueError as error:
        raise UsageError(f"minimal: {error}") from error
    measured = _measured(chosen)
    if dead := _dead_point(scene, measured, values, reach=0):
        raise UsageError(
            f"minimal: W-DEAD: {dead} has a dead point inside `range`; "
            "narrow the range or use nullspace"
        )
    near = _dead_point(scene, measured, values, reach=1)
    names = ", ".join(c.coordinate.name for c in chosen)
    rooted = [c for c in chosen if c.discriminant is not None]
    branches = ", ".join(f"{c.coordinate.name}: {minimal.BRANCHES[c.branch]:+d}" for c in rooted)
    tail = f", branch {branches}" if branches else ""
    reduced = minimal_graph.derive(scene.model, chosen, scene.machine.kept, values)
    why = f"{names} eliminated in closed form{tail}"
    return Formulation("minimal", why, *_reduced(scene, reduced), near)


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


def _measured(chosen: Sequence[Chosen]) -> list[Measured]:
    """The eliminated coordinates with their formulas, and what stands under a root of these."""
    return [
        (
            c.coordinate,
            measure(c.formula),
            None if c.discriminant is None else measure(c.discriminant),
        )
        for c in chosen
    ]


def _dead_point(scene: Linked, measured: Sequence[Measured], start: Values, reach: int) -> str:
    """The coordinate whose root nearly vanishes in a span: its formula is not safe; else empty."""
    chance, spans = random.Random(scene.model.name), _spans(scene, reach)
    sizes: dict[str, list[float]] = defaultdict(list)
    for _ in range(DEAD_POINT_SAMPLES):
        values = start | {symbol: chance.uniform(*span) for symbol, span in spans.items()}
        for coordinate, formula, discriminant in measured:
            if discriminant is not None:
                size = discriminant(values)
                sizes[coordinate.name].append(size)
                if size < 0:
                    break
            values[coordinate.symbol] = formula(values)
    unsafe = (
        name
        for name, seen in sizes.items()
        if min(seen) < LEAST_DISCRIMINANT * max(abs(s) for s in seen)
    )
    return next(unsafe, "")


def _spans(scene: Linked, reach: int) -> dict[Any, tuple[float, float]]:
    """Where independent coordinates are: in the declared range, else between sampled states.

    reach: how many times as far again what has no range may go to either side.
    """
    names = [c.name for c in scene.model.coordinates]
    states = [scene.report.initial.state, *(s.state for s in scene.report.states)]
    found: dict[Any, tuple[float, float]] = {}
    for name in scene.report.freedom.basis.independent:
        j = names.index(name)
        ends = [float(s.coordinates[j]) for s in states]
        further = reach * (max(ends) - min(ends))
        if name in scene.model.range:
            parameters, further = states[0].parameters, 0.0
            given = scene.model.range[name]
            ends = [float(linkage.constant(scene.links, v, parameters)) for v in given]
        found[scene.model.coordinates[j].symbol] = min(ends) - further, max(ends) + further
    return found


def _values(scene: Linked, state: Admissible) -> Values:
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


MAKERS: dict[str, Callable[[Linked], Formulation]] = {
    "minimal": _minimal,
    "nullspace": _nullspace,
    "multiplier": _multiplier,
}
