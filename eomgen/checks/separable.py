"""Whether M is constant and the forces depend on positions only, exactly: Verlet needs it."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from eomgen.algebra.arithmetic import mpmath_arithmetic
from eomgen.algebra.graph import Node
from eomgen.checks import samples
from eomgen.checks.agreement import DECIDING_STATES, DIGITS, EXACT_TOLERANCE
from eomgen.checks.evaluation import over, singly
from eomgen.compile import Machine
from eomgen.mechanics import speeds
from eomgen.model import TIME


def obstacle(machine: Machine) -> str:
    """What M or the forces depend on though they should not, in words; empty if on nothing."""
    if machine.kept:
        return "the constraint forces depend on the rates"
    if machine.model.speeds:
        return "the speeds are not the rates of the coordinates"
    matrix = [entry for row in machine.equations.mass_matrix for entry in row]
    for symbol in (*(c.symbol for c in machine.model.coordinates), TIME):
        if depends(machine, matrix, symbol):
            return f"M depends on {symbol}"
    pairs = zip(machine.equations.generalized_forces, machine.equations.bias, strict=True)
    loads = [force - bias for force, bias in pairs]
    for name, symbol in zip(rates(machine), speeds.symbols(machine.model), strict=True):
        if depends(machine, loads, symbol):
            return f"the forces depend on {name}"
    return ""


def rates(machine: Machine) -> list[str]:
    """The names of the rates of the coordinates."""
    return [c.rate.name for c in machine.model.coordinates]


def depends(machine: Machine, nodes: Sequence[Node], symbol: sp.Symbol) -> bool:
    """Whether a derivative by the symbol is not zero: by its form, or else in 50 digits."""
    algebra = machine.kinematics.algebra
    slopes = [algebra.along(node, {symbol: algebra.number(1)}) for node in nodes]
    left = [s for s in slopes if not algebra.is_zero(s)]
    if not left:
        return False
    drawn = samples.draw(machine.model)
    states = singly(machine, drawn, mpmath_arithmetic(DIGITS), DECIDING_STATES)
    worst = max(over(states, lambda at, _: max(abs(v) for v in at.nodes(left))))
    return worst > EXACT_TOLERANCE
