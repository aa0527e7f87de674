"""The power balance: what the loads without potential do is what the energy gains.

d/dt(sum p (u - y) - T + V) = P - dT/dt|(q,q') + dV/dt|q,   p = dT/du,  u = Y q' + y,

with P the power of everything without potential on the motion at frozen time. For a scene without
explicit time the left side is d(T + V)/dt (Jacobi's integral; Goldstein, Classical Mechanics, 2.7).
Potentials are on one side, forces on the other: each proves the other.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import sympy as sp

from eomgen.algebra.arithmetic import mpmath_arithmetic
from eomgen.algebra.graph import Node
from eomgen.checks.agreement import DECIDING_STATES, DIGITS, EXACT_TOLERANCE, FLOAT_TOLERANCE
from eomgen.checks.evaluation import Bench, benches, over, singly
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError
from eomgen.mechanics import efforts, speeds
from eomgen.mechanics.vectors import dot
from eomgen.model import TIME


def balance(machine: Machine, samples: Samples) -> float:
    """The worst relative error of the balance.

    Raises:
        CheckError: it does not hold.
    """
    terms = balance_terms(machine)
    error = max(over(benches(machine, samples), lambda at, _: imbalance(terms, at)))
    if error <= FLOAT_TOLERANCE:
        return error
    exact = singly(machine, samples, mpmath_arithmetic(DIGITS), DECIDING_STATES)
    error = max(over(exact, lambda at, _: imbalance(terms, at)))
    if error > EXACT_TOLERANCE:
        raise CheckError(
            f"power in is not the rate of the energy, relative error {error:.1e}: "
            "this is a defect of eomgen, nothing was written"
        )
    return error


def imbalance(terms: Sequence[Node], at: Bench) -> Any:
    """|sum of the terms| / sum of |terms|, 0 where all vanish."""
    values = at.nodes(terms)
    scale = sum(abs(v) for v in values)
    return abs(sum(values)) / (scale + (scale == 0))


def balance_terms(machine: Machine) -> list[Node]:
    """Terms that add up to zero on every motion."""
    kinetic, potential = machine.energy
    algebra, one = machine.kinematics.algebra, machine.kinematics.algebra.number(1)
    unknown = speeds.symbols(machine.model)
    relative = relative_speeds(machine)
    momenta = [algebra.along(kinetic, {symbol: one}) for symbol in unknown]
    energy = dot(momenta, relative) - kinetic
    motion = motion_of(machine)
    terms = [algebra.along(energy, {s: r}) for s, r in motion.items()]
    terms += [algebra.along(potential, {s: r}) for s, r in motion.items() if s != TIME]
    terms += [-power for power in _powers(machine, relative)]
    terms += [-power for power in _constraint_powers(machine)]
    terms.append(algebra.along(kinetic, {TIME: one}))
    terms += [p * e for p, e in zip(momenta, _explicit(machine), strict=True)]
    return terms


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
    for effort in everything:
        for symbol, speed in zip(speeds.symbols(machine.model), relative, strict=True):
            yield efforts.generalized_force(machine.kinematics, effort, symbol) * speed


def _constraint_powers(machine: Machine) -> list[Node]:
    """lambda J q' of every row: zero but where a constraint moves by itself (rheonomic)."""
    if not machine.kept:
        return []
    rows = machine.schur.rows
    pairs = zip(machine.linked.multipliers, rows, strict=True)
    relative = relative_speeds(machine)
    return [multiplier * dot(row.jacobian, relative) for multiplier, row in pairs]


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
