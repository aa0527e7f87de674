"""The author's own claims, each tested on the derived motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

import sympy as sp

from eomgen.algebra.arithmetic import FLOAT, mpmath_arithmetic
from eomgen.algebra.graph import Node
from eomgen.algebra.scalar import Algebra
from eomgen.checks.agreement import DECIDING_STATES, DIGITS
from eomgen.checks.evaluation import IRREGULAR, Bench, benches, finite, over, singly
from eomgen.checks.power import imbalance, motion_of
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError
from eomgen.mechanics import motions, speeds
from eomgen.model import Claim

TOLERANCE = 1e-8


def check(machine: Machine, samples: Samples, freedom: int | None = None) -> int:
    """The number of claims that hold; `freedom`: degrees of freedom, where links were counted.

    Raises:
        CheckError: lists every claim that does not hold.
    """
    broken = [
        *_degrees_of_freedom(machine, freedom),
        *_of_no_mode(machine),
        *_equations(machine, samples),
        *_conserved(machine, samples),
        *_energies(machine, samples),
        *_equilibria(machine, samples),
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


def _degrees_of_freedom(machine: Machine, freedom: int | None) -> list[str]:
    stated, count = machine.model.expect.dof, len(speeds.symbols(machine.model))
    found = count if freedom is None else freedom
    if stated in (None, found):
        return []
    how = "one for each free coordinate" if freedom is None else "by the rank of the constraints"
    return [f"dof is {found}, {how}, not {stated}"]


def _of_no_mode(machine: Machine) -> list[str]:
    """Claims on the motion of a rough guide: it has one for each mode, and loses energy."""
    model = machine.model
    if not model.guides:
        return []
    held = {c.acceleration for c in model.coordinates}
    claims = [c for c in model.expect.equations if c.residual.free_symbols & held]
    return [
        f"`{claim.text}` is claimed of every motion, but {model.guides[0].name} has friction: "
        "stick and slip move differently; claim positions, rates or energies"
        for claim in (*claims, *model.expect.conserved)
    ]


def moving_algebra(machine: Machine) -> Algebra[Node]:
    """The scene's algebra with q'' and u' bound to the accelerations of the motion."""
    return machine.kinematics.algebra.extended(machine.motion)


def _equations(machine: Machine, samples: Samples) -> list[str]:
    claims = machine.model.expect.equations
    if not claims:
        return []
    algebra = moving_algebra(machine)
    return [
        f"the equation `{claim.text}` does not hold on the motion, relative error {error:.1e}"
        for claim in claims
        if (error := worst(machine, samples, _terms(algebra, claim))) > TOLERANCE
    ]


def _terms(algebra: Algebra[Node], claim: Claim) -> list[Node]:
    return [algebra.of(term) for term in summands(claim.residual)]


def summands(expression: sp.Expr) -> Sequence[sp.Expr]:
    """The terms of a sum."""
    terms: Sequence[sp.Expr] = sp.Add.make_args(sp.expand_mul(expression))
    return terms


def _conserved(machine: Machine, samples: Samples) -> list[str]:
    algebra, motion = machine.kinematics.algebra, motion_of(machine)
    lines = []
    for claim in machine.model.expect.conserved:
        value = algebra.of(claim.residual)
        changes = [
            algebra.along(term, {s: rate})
            for term in (algebra.of(t) for t in summands(claim.residual))
            for s, rate in motion.items()
        ]
        if (error := worst(machine, samples, changes)) > TOLERANCE:
            lines.append(f"`{claim.text}` is not conserved, relative change {error:.1e}")
        if not any(c is not value.graph.zero for c in changes):
            lines.append(f"`{claim.text}` is constant by itself: it claims nothing")
    return lines


def _energies(machine: Machine, samples: Samples) -> list[str]:
    expect = machine.model.expect
    kinetic, potential = machine.energy
    return [
        *_same(machine, samples, expect.kinetic, kinetic, constant=False),
        *_same(machine, samples, expect.potential, potential, constant=True),
    ]


def _same(
    machine: Machine, samples: Samples, claim: Claim | None, found: Node, *, constant: bool
) -> list[str]:
    """A line where the claim differs from what was found, up to a constant if that is free."""
    if claim is None:
        return []
    algebra = machine.kinematics.algebra
    pair = [algebra.of(claim.residual), -found]
    tests = [pair]
    if constant:
        directions = [m.direction for m in motions.of(machine.model, algebra)]
        tests = [[algebra.along(value, d) for value in pair] for d in directions]
    error = max(worst(machine, samples, terms) for terms in tests)
    return [f"`{claim.text}` is not the energy found, relative error {error:.1e}"] * (
        error > TOLERANCE
    )


def _equilibria(machine: Machine, samples: Samples) -> list[str]:
    return [
        line
        for position in machine.model.expect.equilibria
        for line in _equilibrium(machine, samples, position)
    ]


def _equilibrium(machine: Machine, samples: Samples, position: Mapping[str, sp.Expr]) -> list[str]:
    """Lines for the equations that do not vanish at rest in that position, without inputs."""
    model = machine.model
    missing = [c.name for c in model.coordinates if c.name not in position]
    if missing:
        return [f"the equilibrium says nothing of {', '.join(missing)}"]
    equations = machine.equations
    loads = [q - h for q, h in zip(equations.generalized_forces, equations.bias, strict=True)]
    typical, left = [0.0] * len(loads), [0.0] * len(loads)
    for at, _ in benches(machine, samples):
        rest = _at_rest(at, position)
        with at.arithmetic.quiet():
            typical = [max(a, *_sizes(v)) for a, v in zip(typical, at.nodes(loads), strict=True)]
            left = [max(a, *_sizes(v)) for a, v in zip(left, rest.nodes(loads), strict=True)]
    return [
        f"{_shown(position)} is not an equilibrium: the equation of {name} leaves {size:.3g}"
        for name, scale, size in zip(speeds.names(model), typical, left, strict=True)
        if size > TOLERANCE * scale
    ]


def _sizes(values: Any) -> list[float]:
    return [abs(v) for v in finite(values)]


def _at_rest(at: Bench, position: Mapping[str, sp.Expr]) -> Bench:
    """The scene in that position, with zero speeds and inputs."""
    model, algebra = at.machine.model, at.machine.kinematics.algebra
    values = at.nodes([algebra.of(position[c.name]) for c in model.coordinates])
    leaves = dict(at.leaves)
    leaves |= {algebra.of(c.symbol): v for c, v in zip(model.coordinates, values, strict=True)}
    for symbol in [*speeds.symbols(model), *(i.symbol for i in model.inputs)]:
        leaves[algebra.of(symbol)] = 0.0
    return Bench(at.machine, leaves, at.arithmetic)


def _shown(position: Mapping[str, sp.Expr]) -> str:
    return ", ".join(f"{name} = {value}" for name, value in position.items())


def worst(machine: Machine, samples: Samples, terms: Sequence[Node]) -> float:
    """The largest |sum of the terms| / sum of |terms| over the samples, decided in 50 digits.

    A single term that vanishes is round-off in doubles: it is all of its own size.
    """
    error = max(over(benches(machine, samples), lambda at, _: imbalance(terms, at)))
    return error if error <= TOLERANCE else _decided(machine, samples, terms)


def _decided(machine: Machine, samples: Samples, terms: Sequence[Node]) -> float:
    """The sum in 50 digits over the sizes of the terms in doubles."""
    exact = mpmath_arithmetic(DIGITS)
    precise = singly(machine, samples.exact or samples, exact, DECIDING_STATES)
    plain = singly(machine, samples, FLOAT, DECIDING_STATES)
    found = []
    for (fine, _), (rough, _) in zip(precise, plain, strict=True):
        with suppress(*IRREGULAR):
            left = float(abs(sum(fine.nodes(terms))))
            size = sum(abs(float(v)) for v in rough.nodes(terms))
            found.append(left / (size or 1.0))
    return max(found, default=1.0)
