"""Whether the applied forces damp and are linear in the speeds: an implicit step needs it."""

from __future__ import annotations

import numpy as np

from eomgen.algebra.arithmetic import FLOAT
from eomgen.algebra.graph import Node
from eomgen.checks import samples
from eomgen.checks.evaluation import singly
from eomgen.checks.separable import depends
from eomgen.compile import Machine
from eomgen.mechanics import speeds

STATES = 5
DRIVEN = 1e-9  # of the largest entry of D


def matrix(machine: Machine) -> tuple[tuple[Node, ...], ...]:
    """D = -dQ/du of everything applied, (n, n)."""
    algebra = machine.kinematics.algebra
    one = algebra.number(1)
    columns = [
        [-algebra.along(q, {s: one}) for q in machine.generalized_forces]
        for s in speeds.symbols(machine.model)
    ]
    return tuple(zip(*columns, strict=True))


def obstacle(machine: Machine) -> str:
    """Why the forces are no linear damping, in words; empty if they are."""
    unknown, rows = speeds.symbols(machine.model), matrix(machine)
    entries = [entry for row in rows for entry in row]
    # by its form: a coefficient may be zero for the parameters of the spec
    if all(machine.kinematics.algebra.is_zero(entry) for entry in entries):
        return "no force depends on the speeds"
    for name, symbol in zip(speeds.names(machine.model), unknown, strict=True):
        if depends(machine, entries, symbol):
            return f"the forces are not linear in {name}"
    for at, _ in singly(machine, samples.draw(machine.model), FLOAT, STATES):
        found = np.array([[float(v) for v in at.nodes(row)] for row in rows])
        if np.linalg.eigvalsh(found + found.T)[0] < -DRIVEN * np.max(np.abs(found)):
            return "they drive some motion instead"
    return ""
