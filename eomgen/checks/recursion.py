"""Scenes too large for a closed form: two derivations on the graph, at random states.

Lagrange's equations by differentiating the energies, in reverse sweeps,

d/dt dT/dq' - dT/dq + dV/dq = Q,

against the recursion of Newton and Euler over the tree, for any accelerations; where speeds are
no rates of coordinates, d'Alembert's projection against it. And inverse after forward dynamics is
the identity. But for the projection this takes a time linear in the size of the scene.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any

from eomgen.algebra.arithmetic import mpmath_arithmetic
from eomgen.algebra.derive import direction, gradient
from eomgen.algebra.graph import Node
from eomgen.checks.agreement import (
    DECIDING_STATES,
    DIGITS,
    EXACT_TOLERANCE,
    FLOAT_TOLERANCE,
    Agreement,
)
from eomgen.checks.evaluation import Bench, benches, free_accelerations, over, singly
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError, UsageError
from eomgen.mechanics import efforts, virtual_work
from eomgen.mechanics.recursive import loads, recursion
from eomgen.mechanics.recursive.engine import Engine

PIVOT = 1e-12  # of the size of the inertia that it is a part of


@dataclass(frozen=True)
class Rows:
    """For each coordinate the terms of one derivation and the other's residual at free u'."""

    terms: tuple[tuple[Node, ...], ...]
    residuals: tuple[Node, ...]


def compare(machine: Machine, engine: Engine, samples: Samples) -> Agreement:
    """The agreement of the recursion with Lagrange's equations.

    Raises:
        CheckError: they differ, or no sampled state is regular.
    """
    rows = rows_of(machine, engine)
    return _held(machine, samples, lambda at: difference(rows, at), "differ")


def identity(machine: Machine, engine: Engine, samples: Samples) -> float:
    """How far inverse after forward dynamics is from the identity, in the norm of the forces.

    Raises:
        CheckError: it is not the identity.
    """
    kinematics, tree = machine.kinematics, engine.tree
    applied = loads.of(kinematics, tree)
    right = recursion.inverse_dynamics(tree, True, None, applied)
    left = recursion.inverse_dynamics(tree, True, engine.accelerations, applied)
    worst = _held(
        machine,
        samples,
        lambda at: _largest(at, at.nodes(left)) / _positive(_largest(at, at.nodes(right))),
        "are not inverse",
    )
    return worst.error


def _held(
    machine: Machine, samples: Samples, error_of: Callable[[Bench], Any], what: str
) -> Agreement:
    """The errors at all states; a large one is decided in 50 digits."""
    errors, digits = over(benches(machine, samples), lambda at, _: error_of(at)), 16
    if max(errors) > FLOAT_TOLERANCE:
        exact = singly(machine, samples, mpmath_arithmetic(DIGITS), DECIDING_STATES)
        errors, digits = over(exact, lambda at, _: error_of(at)), DIGITS
        if max(errors) > EXACT_TOLERANCE:
            raise CheckError(
                f"Lagrange's equations and the recursion {what}, relative error "
                f"{max(errors):.1e}: this is a defect of eomgen, nothing was written"
            )
    return Agreement(len(errors), max(errors), digits, proven=False)


def rows_of(machine: Machine, engine: Engine) -> Rows:
    """Both derivations over free accelerations."""
    second = free_accelerations(machine)
    terms = (projected if machine.model.speeds else lagrangian)(machine, second)
    applied = loads.of(machine.kinematics, engine.tree)
    residuals = recursion.inverse_dynamics(engine.tree, True, second, applied)
    return Rows(terms, residuals)


def projected(machine: Machine, second: Sequence[Node]) -> tuple[tuple[Node, ...], ...]:
    """The terms of d'Alembert's equations, for speeds that are no rates."""
    found = virtual_work.derive(machine.kinematics)
    rows = zip(found.mass_matrix, found.bias, found.generalized_forces, strict=True)
    return tuple(
        (*(m * a for m, a in zip(row, second, strict=True)), bias, -force)
        for row, bias, force in rows
    )


def lagrangian(machine: Machine, second: Sequence[Node]) -> tuple[tuple[Node, ...], ...]:
    """The terms of Lagrange's equations."""
    kinematics, model = machine.kinematics, machine.model
    algebra, graph = kinematics.algebra, kinematics.algebra.number(0).graph
    kinetic, potential = machine.energy
    places = [algebra.of(c.symbol) for c in model.coordinates]
    rates = [algebra.of(c.rate) for c in model.coordinates]
    flow = {algebra.of(s): r for s, r in kinematics.flow.derivatives.items()}
    moving = direction(graph, flow | dict(zip(rates, second, strict=True)))
    other = [*efforts.dissipative(kinematics), *efforts.nonconservative(kinematics)]
    return tuple(
        zip(
            map(moving, machine.momenta),
            (-slope for slope in gradient(kinetic, places)),
            gradient(potential, places),
            (-force for force in loads.generalized(kinematics, other)),
            strict=True,
        )
    )


def difference(rows: Rows, at: Bench) -> Any:
    """The largest difference of two rows over the size of the terms."""
    flat = [term for row in rows.terms for term in row]
    values = at.nodes([*flat, *rows.residuals])
    width = len(rows.terms[0])
    found = []
    for i, residual in enumerate(values[len(flat) :]):
        terms = values[i * width : (i + 1) * width]
        size = sum(abs(t) for t in terms) + abs(residual)
        found.append(abs(sum(terms) - residual) / _positive(size))
    return _largest(at, found)


def _largest(at: Bench, values: Sequence[Any]) -> Any:
    return reduce(at.arithmetic.functions["max"], [abs(v) for v in values])


def _positive(size: Any) -> Any:
    return size + (size == 0)


def pivots(machine: Machine, engine: Engine, samples: Samples) -> None:
    """Refuse a scene in which some motion has no inertia at any state.

    Raises:
        UsageError: E-MASS.
    """

    def least(at: Bench, _: list[Any]) -> Any:
        values = at.nodes([node for pair in engine.pivots for node in pair])
        shares = [p / s for p, s in zip(values[::2], values[1::2], strict=True)]
        return -_largest_signed(at, [-share for share in shares])

    if engine.pivots and max(over(benches(machine, samples), least)) <= PIVOT:
        raise UsageError(
            "E-MASS: the mass matrix is singular: some motion has no inertia; "
            "give every coordinate a mass or an inertia that it moves"
        )


def _largest_signed(at: Bench, values: Sequence[Any]) -> Any:
    return reduce(at.arithmetic.functions["max"], values)
