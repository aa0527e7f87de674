"""The power balance: what the loads without potential do is what the energy gains.

d/dt(sum p (u - y) - T + V) = P - dT/dt|(q,q') + dV/dt|q,   p = dT/du,  u = Y q' + y,

with P the power of everything without potential on the motion at frozen time. For a scene without
explicit time the left side is d(T + V)/dt (Jacobi's integral; Goldstein, Classical Mechanics, 2.7).
Potentials are on one side, forces on the other: each proves the other.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import reduce
from typing import Any

import sympy as sp

from eomgen.algebra.arithmetic import mpmath_arithmetic
from eomgen.algebra.derive import direction, gradient
from eomgen.algebra.graph import Node
from eomgen.checks.agreement import DECIDING_STATES, DIGITS, EXACT_TOLERANCE, FLOAT_TOLERANCE
from eomgen.checks.evaluation import Bench, benches, over, singly
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError
from eomgen.mechanics import efforts, speeds
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.vectors import dot
from eomgen.model import TIME


def balance(machine: Machine, samples: Samples) -> float:
    """The worst relative error of the balance, and of the energies that are written.

    Raises:
        CheckError: it does not hold.
    """
    sums = [balance_terms(machine), *_written(machine)]

    def worst(at: Bench, _: Sequence[Any]) -> Any:
        return reduce(at.arithmetic.functions["max"], [imbalance(terms, at) for terms in sums])

    error = max(over(benches(machine, samples), worst))
    if error <= FLOAT_TOLERANCE:
        return error
    exact = singly(machine, samples, mpmath_arithmetic(DIGITS), DECIDING_STATES)
    error = max(over(exact, worst))
    if error > EXACT_TOLERANCE:
        raise CheckError(
            f"power in is not the rate of the energy, relative error {error:.1e}: "
            "this is a defect of eomgen, nothing was written"
        )
    return error


def _written(machine: Machine) -> list[list[Node]]:
    """T and V as they are written, less those that are balanced."""
    pairs = zip(machine.short_energy, machine.energy, strict=True)
    return [[short, -known] for short, known in pairs if short is not known]


def imbalance(terms: Sequence[Node], at: Bench) -> Any:
    """|sum of the terms| / sum of |terms|, 0 where all vanish."""
    values = at.nodes(terms)
    scale = sum(abs(v) for v in values)
    return abs(sum(values)) / (scale + (scale == 0))


def balance_terms(machine: Machine) -> list[Node]:
    """Terms that add up to zero on every motion; each gradient is one reverse sweep."""
    algebra, potential = machine.kinematics.algebra, machine.energy[1]
    motion = motion_of(machine)
    slopes = gradient(inertial_energy(machine), [algebra.of(s) for s in motion])
    terms = [slope * rate for slope, rate in zip(slopes, motion.values(), strict=True)]
    moving = [s for s in motion if s != TIME]
    slopes = gradient(potential, [algebra.of(s) for s in moving])
    terms += [slope * motion[s] for slope, s in zip(slopes, moving, strict=True)]
    terms += [-power for power in _powers(machine, relative_speeds(machine))]
    terms += [-power for power in _constraint_powers(machine)]
    return terms + _explicit_terms(machine)


def inertial_energy(machine: Machine) -> Node:
    """sum p (u - y) - T: the kinetic energy, but where it depends on the time explicitly."""
    return dot(machine.momenta, relative_speeds(machine)) - machine.energy[0]


def flow(machine: Machine) -> tuple[Node, Node]:
    """(E, P): the energy sum p (u - y) - T + V, T + V without explicit time, and what it gains.

    P is the power of everything without potential, of constraints that move by themselves, and of
    what depends on the time explicitly.
    """
    algebra, potential = machine.kinematics.algebra, machine.energy[1]
    powers = [*_powers(machine, relative_speeds(machine)), *_moving_powers(machine)]
    powers += [-term for term in _explicit_terms(machine)]
    powers.append(algebra.along(potential, {TIME: algebra.number(1)}))
    total = sum(powers, algebra.number(0))
    return inertial_energy(machine) + potential, total


def _explicit_terms(machine: Machine) -> list[Node]:
    """dT/dt at constant q and u, and p dy/dt: zero where nothing depends on the time."""
    algebra, one = machine.kinematics.algebra, machine.kinematics.algebra.number(1)
    pairs = zip(machine.momenta, _explicit(machine), strict=True)
    return [algebra.along(machine.energy[0], {TIME: one}), *(p * e for p, e in pairs)]


def motion_of(machine: Machine) -> dict[sp.Symbol, Node]:
    """The time derivative of every coordinate, speed and the time, on the motion."""
    flow = dict(machine.kinematics.flow.derivatives)
    return flow | dict(zip(speeds.symbols(machine.model), machine.solution[0], strict=True))


def relative_speeds(machine: Machine) -> list[Node]:
    """u - y: what is left of the speeds without their terms free of rates."""
    model, algebra = machine.model, machine.kinematics.algebra
    if not model.speeds:
        return list(machine.rates)
    still = dict.fromkeys((c.rate for c in model.coordinates), sp.S.Zero)
    return [algebra.of(s.symbol) - algebra.of(s.formula.xreplace(still)) for s in model.speeds]


def _powers(machine: Machine, relative: Sequence[Node]) -> Iterable[Node]:
    """Force . velocity of every effort without potential, at frozen time."""
    everything = [
        *efforts.dissipative(machine.kinematics),
        *efforts.nonconservative(machine.kinematics),
    ]
    algebra = machine.kinematics.algebra
    leaves = [algebra.of(s) for s in speeds.symbols(machine.model)]
    along = direction(algebra.number(0).graph, dict(zip(leaves, relative, strict=True)))
    for effort in everything:
        yield dot(effort.force, [along(v) for v in effort.velocity])


def _constraint_powers(machine: Machine) -> list[Node]:
    """lambda J q' of every row: zero but where a constraint moves by itself (rheonomic)."""
    if not machine.kept:
        return []
    rows = machine.schur.rows
    pairs = zip(machine.linked.multipliers, rows, strict=True)
    relative = relative_speeds(machine)
    return [multiplier * dot(row.jacobian, relative) for multiplier, row in pairs]


def _moving_powers(machine: Machine) -> list[Node]:
    """lambda J q' of the rows that depend on the time; of the others it is zero."""
    if not machine.kept:
        return []
    algebra, one = machine.kinematics.algebra, machine.kinematics.algebra.number(1)
    pairs = zip(_constraint_powers(machine), machine.schur.rows, strict=True)
    return [
        power
        for power, row in pairs
        if not algebra.is_zero(row.rate - dot(row.jacobian, machine.rates))
        and not algebra.is_zero(explicit_rate(row, machine, one))
    ]


def explicit_rate(row: Row[Node], machine: Machine, one: Node) -> Node:
    """The rate of a row while nothing moves but the time; of a rate constraint its free term."""
    algebra = machine.kinematics.algebra
    if row.residual is not None:
        return algebra.along(row.residual, {TIME: one})
    return row.rate - dot(row.jacobian, machine.rates)


def _explicit(machine: Machine) -> list[Node]:
    """The partial time derivative of each speed's formula at fixed q and q'."""
    model, algebra = machine.model, machine.kinematics.algebra
    if not model.speeds:
        return [algebra.number(0)] * len(model.coordinates)
    moving: dict[Any, Any] = {TIME: sp.S.One}
    for known in model.prescribed:
        moving |= {known.symbol: known.rate, known.rate: known.acceleration}
    return [
        algebra.of(sp.Add(*(sp.diff(s.formula, x) * rate for x, rate in moving.items())))
        for s in model.speeds
    ]
