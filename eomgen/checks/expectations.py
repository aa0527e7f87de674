"""The author's own claims, each tested on the derived motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp

from eomgen.algebra.graph import Node
from eomgen.algebra.scalar import Algebra
from eomgen.checks.evaluation import Bench, bench
from eomgen.checks.power import motion_of
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError
from eomgen.mechanics import speeds
from eomgen.model import Claim

TOLERANCE = 1e-8


def check(machine: Machine, samples: Samples) -> int:
    """The number of claims that hold.

    Raises:
        CheckError: lists every claim that does not hold.
    """
    at = bench(machine, samples)
    broken = [
        *_degrees_of_freedom(machine),
        *_equations(machine, at),
        *_conserved(machine, at),
        *_energies(machine, at),
        *_equilibria(machine, at),
    ]
    if broken:
        raise CheckError("\n".join(f"expect: {line}" for line in broken))
    return count(machine)


def count(machine: Machine) -> int:
    """How many claims the spec makes."""
    expect = machine.model.expect
    single = (expect.dof, expect.kinetic, expect.potential)
    listed = (expect.equations, expect.equilibria, expect.conserved)
    return sum(c is not None for c in single) + sum(len(c) for c in listed)


def _degrees_of_freedom(machine: Machine) -> list[str]:
    stated, found = machine.model.expect.dof, len(machine.model.coordinates)
    if stated in (None, found):
        return []
    return [f"dof is {found}, one for each free coordinate, not {stated}"]


def moving_algebra(machine: Machine) -> Algebra[Node]:
    """The scene's algebra with q'' bound to the accelerations of the motion."""
    pairs = zip(machine.model.coordinates, machine.accelerations, strict=True)
    return machine.kinematics.algebra.extended({c.acceleration: a for c, a in pairs})


def _equations(machine: Machine, at: Bench) -> list[str]:
    claims = machine.model.expect.equations
    if not claims:
        return []
    algebra = moving_algebra(machine)
    return [
        f"the equation `{claim.text}` does not hold on the motion, relative error {error:.1e}"
        for claim in claims
        if (error := worst([algebra.of(term) for term in summands(claim.residual)], at)) > TOLERANCE
    ]


def summands(expression: sp.Expr) -> Sequence[sp.Expr]:
    """The terms of a sum."""
    terms: Sequence[sp.Expr] = sp.Add.make_args(sp.expand_mul(expression))
    return terms


def _conserved(machine: Machine, at: Bench) -> list[str]:
    algebra, motion = machine.kinematics.algebra, motion_of(machine)
    lines = []
    for claim in machine.model.expect.conserved:
        value = algebra.of(claim.residual)
        changes = [
            algebra.along(term, {s: rate})
            for term in (algebra.of(t) for t in summands(claim.residual))
            for s, rate in motion.items()
        ]
        if (error := worst(changes, at)) > TOLERANCE:
            lines.append(f"`{claim.text}` is not conserved, relative change {error:.1e}")
        if not any(c is not value.graph.zero for c in changes):
            lines.append(f"`{claim.text}` is constant by itself: it claims nothing")
    return lines


def _energies(machine: Machine, at: Bench) -> list[str]:
    expect = machine.model.expect
    kinetic, potential = machine.energy
    return [
        *_same(machine, at, expect.kinetic, kinetic, constant=False),
        *_same(machine, at, expect.potential, potential, constant=True),
    ]


def _same(
    machine: Machine, at: Bench, claim: Claim | None, found: Node, *, constant: bool
) -> list[str]:
    """A line where the claim differs from what was found, up to a constant if that is free."""
    if claim is None:
        return []
    algebra = machine.kinematics.algebra
    pair = [algebra.of(claim.residual), -found]
    tests = [pair]
    if constant:
        one = algebra.number(1)
        state = [c.symbol for c in machine.model.coordinates]
        tests = [[algebra.along(value, {q: one}) for value in pair] for q in state]
    error = max(worst(terms, at) for terms in tests)
    return [f"`{claim.text}` is not the energy found, relative error {error:.1e}"] * (
        error > TOLERANCE
    )


def _equilibria(machine: Machine, at: Bench) -> list[str]:
    return [
        line
        for position in machine.model.expect.equilibria
        for line in _equilibrium(machine, at, position)
    ]


def _equilibrium(machine: Machine, at: Bench, position: Mapping[str, sp.Expr]) -> list[str]:
    """Lines for the equations that do not vanish at rest in that position, without inputs."""
    model, algebra = machine.model, machine.kinematics.algebra
    missing = [c.name for c in model.coordinates if c.name not in position]
    if missing:
        return [f"the equilibrium says nothing of {', '.join(missing)}"]
    equations = machine.equations
    loads = [q - h for q, h in zip(equations.generalized_forces, equations.bias, strict=True)]
    values = at.nodes([algebra.of(position[c.name]) for c in model.coordinates])
    still = dict(at.leaves)
    for coordinate, value in zip(model.coordinates, values, strict=True):
        still[algebra.of(coordinate.symbol)] = value + 0 * at.leaves[algebra.of(coordinate.symbol)]
    for symbol in [*speeds.symbols(model), *(i.symbol for i in model.inputs)]:
        still[algebra.of(symbol)] = 0 * at.leaves[algebra.of(symbol)]
    rest = Bench(machine, still, at.arithmetic)
    typical, found = at.nodes(loads), rest.nodes(loads)
    return [
        f"{_shown(position)} is not an equilibrium: the equation of {name} leaves {size:.3g}"
        for name, scale, load in zip(speeds.names(model), typical, found, strict=True)
        if (size := float(np.max(np.abs(load)))) > TOLERANCE * float(np.max(np.abs(scale)))
    ]


def _shown(position: Mapping[str, sp.Expr]) -> str:
    return ", ".join(f"{name} = {value}" for name, value in position.items())


def worst(terms: Sequence[Node], at: Bench) -> float:
    """|sum| over the largest sum of |terms| of all states: 0 where the terms vanish."""
    with np.errstate(all="ignore"):
        values = np.array([v + np.zeros(at.size) for v in at.nodes(terms)])
        scale = np.abs(values).sum(axis=0)
        error = np.abs(values.sum(axis=0)) / (scale + (scale == 0))
    finite = error[np.isfinite(error)]
    return float(finite.max()) if finite.size else float("inf")
