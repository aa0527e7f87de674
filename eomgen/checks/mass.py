"""The mass matrix is positive definite: every motion has inertia."""

from __future__ import annotations

from typing import Any

from eomgen.algebra import ldl
from eomgen.algebra.arithmetic import FLOAT
from eomgen.checks.evaluation import Bench, singly
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import UsageError
from eomgen.mechanics import speeds

TOLERANCE = 1e-12
STATES = 3


def check(machine: Machine, samples: Samples) -> None:
    """Refuse a scene in which some admissible motion has no inertia at any of the first states.

    Raises:
        UsageError: E-MASS, with the direction of that motion.
    """
    states = [at for at, _ in singly(machine, samples, FLOAT, STATES)]
    if all(_is_singular(at) for at in states):
        raise UsageError(_said(states[0]))


def _matrix(at: Bench) -> list[list[float]]:
    rows = at.machine.inertia
    return [[float(v) for v in at.nodes(row)] for row in rows]


def _is_singular(at: Bench) -> bool:
    def positive(row: int, pivot: Any, scale: Any) -> None:
        if not pivot > TOLERANCE * abs(scale):
            raise ldl.SingularMassMatrix(f"in row {row + 1}", pivot)

    try:
        ldl.factor(_matrix(at), positive)
    except ldl.SingularMassMatrix:
        return True
    return False


def _said(at: Bench) -> str:
    import numpy as np

    matrix = np.array(_matrix(at))
    _, directions = np.linalg.eigh(matrix)
    direction = directions[:, 0] / np.max(np.abs(directions[:, 0]))
    model = at.machine.model
    shares = [
        f"{name} {value:+.3g}"
        for name, value in zip(speeds.names(model), direction, strict=True)
        if abs(value) > 1e-6
    ]
    return (
        f"E-MASS: the mass matrix is singular: the motion {', '.join(shares)} has no inertia; "
        "give it a mass or an inertia, or remove a coordinate"
        + " (no constraint decides it)"
        * bool(at.machine.kept)
    )
