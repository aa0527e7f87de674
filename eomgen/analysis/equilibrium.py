"""Statics by virtual work: equilibrium equations, all equilibria found, their stability and loads.

`equations(model)` gives Q_j + sum of lambda_a J_aj = 0 in closed form, `solve(model)` positions.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from itertools import combinations
from typing import Any

from eomgen.algebra import normal
from eomgen.algebra.closed import ClosedForm
from eomgen.algebra.normal import Form
from eomgen.analysis import equilibrium_given as given
from eomgen.analysis.equilibrium_equations import Substitution, equations, symbols_of
from eomgen.analysis.equilibrium_find import Found, Problem, find
from eomgen.analysis.equilibrium_given import Given, Number
from eomgen.analysis.equilibrium_polish import Root, decimal
from eomgen.analysis.equilibrium_polynomials import usage
from eomgen.analysis.equilibrium_records import Equilibria, Equilibrium, Stability, Statics
from eomgen.analysis.equilibrium_scene import scene
from eomgen.analysis.equilibrium_search import typical_slope
from eomgen.analysis.equilibrium_stability import null_space, stability
from eomgen.mechanics import constraints, lagrange, named_reactions
from eomgen.model import AXES, SPACES, Constraint, Model

__all__ = ["Equilibria", "Equilibrium", "Statics", "equations", "solve"]

MOST_CONTACTS = 4  # unilateral constraints of which every combination is tried
TOUCHING = 1e-25


def solve(
    model: Model,
    inputs: Mapping[str, Number] | None = None,
    time: Number = 0,
    parameters: Mapping[str, Number] | None = None,
) -> Equilibria:
    """The equilibria of a scene in its `range`; inputs that are not given are zero, and said so.

    Raises:
        UsageError: a name is unknown, a parameter has no value, a force none at rest.
    """
    values = given.given(model, inputs or {}, time, parameters or {})
    parts = [_Part.of(model, touching, values) for touching in _contacts(model)]
    found = _sorted(model, [e for part in parts for e in part.equilibria()])
    return Equilibria(
        found=tuple(found),
        method="; ".join(dict.fromkeys(part.said() for part in parts)),
        complete=all(part.found.complete for part in parts),
        inputs=values.inputs,
        time=values.time,
        arbitrary=_arbitrary(parts),
        notes=_notes(model, values, parts),
    )


def _arbitrary(parts: Sequence[_Part]) -> tuple[str, ...]:
    """The coordinates on which nothing depends, wherever there is an equilibrium."""
    choices = [part.found.arbitrary for part in parts if part.found.roots]
    first = choices[0] if choices else ()
    return tuple(name for name in first if all(name in others for others in choices))


def _contacts(model: Model) -> list[tuple[str, ...]]:
    """Every choice of unilateral constraints that may touch."""
    names = [c.name for c in model.constraints if c.kind == "unilateral"]
    most = len(names) if len(names) <= MOST_CONTACTS else 1
    return [chosen for n in range(most + 1) for chosen in combinations(names, n)]


@dataclass(frozen=True)
class _Part:
    """The scene with some unilateral constraints touching."""

    model: Model
    touching: tuple[str, ...]
    problem: Problem
    found: Found
    conservative: bool

    @staticmethod
    def of(model: Model, touching: tuple[str, ...], values: Given) -> _Part:
        """Solved."""
        closed = replace(model, constraints=tuple(_closed(c, touching) for c in model.constraints))
        statics = equations(closed)
        numeric = _numeric(statics, values)
        forces = [numeric.of(b.force) for b in statics.balances]
        forms = [numeric.of(b.total) for b in statics.balances]
        residuals = [numeric.of(r.residual) for r in statics.links if r.residual is not None]
        jacobian = [numeric.of(entry) for r in statics.links for entry in r.jacobian]
        seen = usage([*forces, *residuals, *jacobian])
        problem = Problem(
            model=closed,
            forms=tuple([*forms, *residuals]),
            held=frozenset().union(*(symbols_of(f) for f in (*forms, *residuals, *jacobian))),
            multipliers=tuple(r.multiplier for r in statics.links),
            regions=given.regions(closed, values, seen),
            scene=scene(closed, values.free),
            constants=dict(values.everything),
        )
        return _Part(closed, touching, problem, find(problem), _has_potential(closed, forces))

    def said(self) -> str:
        """How it was searched, and how many of what it found contacts do not admit."""
        said = f"touching {', '.join(self.touching)}: " * bool(self.touching) + self.found.method
        refused = sum(not self._admitted(r) for r in self.found.roots)
        return said + f", but for {refused} that the unilateral constraints refuse" * bool(refused)

    def equilibria(self) -> list[Equilibrium]:
        """Those that the unilateral constraints admit."""
        return [self._equilibrium(r) for r in self.found.roots if self._admitted(r)]

    def _admitted(self, root: Root) -> bool:
        """Gaps are not negative, contacts push."""
        scale = max((r.high - r.low for r in self.problem.regions), default=1.0)
        pushes = [
            v
            for n, v in zip(self.problem.scene.names, root.multipliers, strict=True)
            if n in self.touching
        ]
        load = max((abs(v) for v in root.multipliers), default=1)
        return all(g >= -TOUCHING * scale for g in root.numbers.gaps) and all(
            p >= -TOUCHING * load for p in pushes
        )

    def _equilibrium(self, root: Root) -> Equilibrium:
        spans = [r.high - r.low for r in self.problem.regions]
        names = [c.name for c in self.model.coordinates]
        load = max((abs(float(v)) for v in root.multipliers), default=0.0)
        triples = zip(names, root.coordinates, spans, strict=True)
        multipliers = {
            n: decimal(v, load)
            for n, v in zip(self.problem.scene.names, root.multipliers, strict=True)
        }
        _, rank = null_space(root.numbers.jacobian, len(names))
        return Equilibrium(
            coordinates={n: decimal(v, s) for n, v, s in triples},
            multipliers=multipliers,
            reactions=self._reactions(root, multipliers),
            stability=self._stability(root, multipliers),
            isolated=self.found.isolated or (root.regular and not self.found.arbitrary),
            contacts=self.touching,
            unique_loads=rank == len(root.multipliers),
        )

    def _reactions(
        self, root: Root, multipliers: Mapping[str, Decimal]
    ) -> dict[str, tuple[Decimal, ...]]:
        """Forces in world axes: lambda of two points that coincide, J' lambda on a body."""
        model = self.model
        found = {}
        for c in model.constraints:
            own = [v for n, v in multipliers.items() if n == c.name or n.startswith(f"{c.name}.")]
            if c.points is not None:
                found[c.reaction or c.name] = tuple(own)
        numbers = dict(zip(self.problem.scene.names, root.numbers.jacobian, strict=True))
        order = [c.name for c in model.coordinates]
        for name, (rows, axes) in _held_bodies(model).items():
            force = dict.fromkeys(AXES[: SPACES[model.space]], Decimal(0))
            for coordinate, axis in axes.items():
                j = order.index(coordinate)
                shares = (decimal(numbers[r][j]) * multipliers[r] for r in rows)
                force[axis] = sum(shares, Decimal(0))
            found[name] = tuple(force.values())
        return found

    def _stability(self, root: Root, multipliers: Mapping[str, Decimal]) -> Stability:
        typical = typical_slope(self.problem.scene, self.problem.box)
        decided = stability(self.problem.scene, root, self.conservative, typical)
        loose = [n for n in self.touching if multipliers[n] == 0]
        if decided.verdict != "stable" or not loose:
            return decided
        reason = f"undecided by energy: {', '.join(loose)} touches without a force"
        return Stability("undecided", reason, decided.eigenvalues)


def _closed(constraint: Constraint, touching: Sequence[str]) -> Constraint:
    return replace(constraint, kind="holonomic") if constraint.name in touching else constraint


def _numeric(statics: Statics, values: Given) -> Substitution:
    """Puts the numbers in."""
    algebra = ClosedForm(statics.balances[0].applied.ring)
    return Substitution(algebra, given.substituted(values, algebra))


def _has_potential(model: Model, forces: Sequence[Form]) -> bool:
    """Whether dQ_i/dq_j = dQ_j/dq_i with these inputs, decided."""
    algebra = ClosedForm(forces[0].ring)
    one = algebra.number(1)

    def slope(i: int, j: int) -> Form:
        return algebra.along(forces[i], {model.coordinates[j].symbol: one})

    pairs = combinations(range(len(forces)), 2)
    return all(normal.is_zero(slope(i, j) - slope(j, i)) for i, j in pairs)


def _held_bodies(model: Model) -> dict[str, tuple[tuple[str, ...], Mapping[str, str]]]:
    """Named reactions of relations on one body: (rows, coordinate -> axis of the world)."""
    named = [c for c in model.constraints if c.reaction and c.points is None]
    if not named:
        return {}
    kinematics = lagrange.closed_kinematics(model)
    rows = [r for r in constraints.rows(kinematics) if r.constraint in named]
    found = {}
    for c in named:
        own = [r for r in rows if r.constraint is c]
        body = named_reactions.body_of(kinematics, own) if own else None
        if body is not None and c.reaction is not None:
            found[c.reaction] = (tuple(r.name for r in own), body[1])
    return found


def _sorted(model: Model, found: Iterable[Equilibrium]) -> list[Equilibrium]:
    """By coordinates as declared; a position that is found twice once, with its contacts."""
    names = [c.name for c in model.coordinates]
    kept: dict[Any, Equilibrium] = {}
    for e in found:
        kept[tuple(float(e.coordinates[n]) for n in names)] = e
    return [kept[key] for key in sorted(kept)]


def _notes(model: Model, values: Given, parts: Sequence[_Part]) -> tuple[str, ...]:
    notes = list(equations(model).notes)
    if values.unset:
        notes.append(f"inputs not given are zero: {', '.join(values.unset)}")
    if len([c for c in model.constraints if c.kind == "unilateral"]) > MOST_CONTACTS:
        notes.append("unilateral constraints were tried one at a time, not together")
    notes += [n for part in parts for n in part.found.notes]
    return tuple(dict.fromkeys(notes))
