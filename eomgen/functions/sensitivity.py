"""How the motion depends on its arguments.

With r(x, u') = M u' + h - Q = 0 the accelerations follow x by  M du'/dx = -dr/dx | u' fixed  (the
implicit function theorem): the inverse dynamics is differentiated, not the solution. Linked:

M du' - J' dlambda = -dr,   J du' = -ds,   s = J q'' + gamma.
"""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.algebra import ldl
from eomgen.algebra.cost import operations
from eomgen.algebra.graph import Node
from eomgen.algebra.jacobian import Rows, jacobian, substituted
from eomgen.algebra.ldl import Pivots
from eomgen.compile import LARGEST_UNROLLED
from eomgen.errors import UsageError
from eomgen.functions.motion import Motion
from eomgen.mechanics import multipliers


def state_derivative(motion: Motion, variables: Sequence[Node]) -> tuple[Rows, Pivots]:
    """d (q', u') / d variables, a row for each component of the state, and the pivots.

    Raises:
        UsageError: a constraint has friction, so that each mode has a motion of its own.
    """
    for guide in motion.machine.model.guides:
        raise UsageError(
            f"--functions: {guide.name} has friction: the state derivative is that of a mode, and "
            "has no Jacobian here"
        )
    rates = jacobian(motion.machine.rates, variables)
    found, pivots = accelerations(motion, variables)
    return rates + found, pivots


def accelerations(motion: Motion, variables: Sequence[Node]) -> tuple[Rows, Pivots]:
    """d u' / d variables by the cheaper of two routes, and the pivots that it divides by."""
    implicit = _implicit(motion, variables)
    if _in_a_loop(motion):
        return implicit
    solution, pivots = motion.machine.solution
    direct = (jacobian(solution, variables), pivots)
    return min(
        implicit, direct, key=lambda pair: operations(entry for row in pair[0] for entry in row)
    )


def _in_a_loop(motion: Motion) -> bool:
    """Whether the solution is opaque."""
    return motion.size > LARGEST_UNROLLED and not motion.machine.kept


def _implicit(motion: Motion, variables: Sequence[Node]) -> tuple[Rows, Pivots]:
    slopes = jacobian(motion.imbalance, variables)
    columns = [
        [-entry for entry in substituted(column, motion.solution)]
        for column in zip(*slopes, strict=True)
    ]
    solved, pivots = _solved(motion, columns)
    return [list(row) for row in zip(*solved, strict=True)], (*motion.machine.pivots, *pivots)


def _solved(motion: Motion, columns: Rows) -> tuple[Rows, Pivots]:
    """du' for every right side."""
    matrix = motion.machine.equations.mass_matrix
    if motion.machine.kept:
        return multipliers.responses(motion.machine.schur, motion.machine.inertia, columns)
    if _in_a_loop(motion):
        return ldl.solve_in_loop(matrix, *columns), ()
    return ldl.solve(matrix, *columns)
