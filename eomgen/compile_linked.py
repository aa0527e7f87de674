"""Functions of a linked scene: residuals, Jacobian, multipliers, projection on the constraints."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from eomgen.algebra.assemble import assemble
from eomgen.algebra.graph import Node
from eomgen.compile import Machine
from eomgen.mechanics import multipliers
from eomgen.model import Model
from eomgen.program import Function


def _residuals(m: Machine) -> Function:
    about = "residuals of the holonomic constraints, zero where they hold"
    values = [r.residual for r in m.rows if r.residual is not None]
    return assemble("constraint_residuals", about, (len(values),), values, m.pivots)


def _rates(m: Machine) -> Function:
    about = "rate residuals of all constraints, zero where they hold"
    values = [row.rate for row in m.rows]
    return assemble("constraint_rates", about, (len(values),), values, m.pivots)


def _jacobian(m: Machine) -> Function:
    about = "J, d rate residual / d u, one row for each constraint"
    shape = (len(m.rows), len(m.speeds))
    entries = [entry for row in m.rows for entry in row.jacobian]
    return assemble("constraint_jacobian", about, shape, entries, m.pivots)


def _multipliers(m: Machine) -> Function:
    about = "lambda of M q'' + h = Q + J' lambda, for the independent rows"
    values = m.linked.multipliers
    return assemble("multipliers", about, (len(values),), values, m.linked.pivots)


def _project_positions(m: Machine) -> Function:
    about = "q - M^-1 J' S^-1 phi: one Newton step to the constraints, in the metric of M"
    # a nonholonomic row leaves the positions as they are
    residuals = [_or_zero(row.residual, row.rate) for row in m.schur.rows]
    bindings = m.kinematics.algebra.bindings
    still = [m.kinematics.algebra.number(0)] * len(m.speeds)
    moved, pivots = multipliers.projected(m.schur, still, residuals)
    steps = zip(m.model.coordinates, m.turned(moved), strict=True)
    values = [bindings[c.symbol] + step for c, step in steps]
    return assemble("project_positions", about, (len(values),), values, pivots)


def _or_zero(value: Node | None, other: Node) -> Node:
    return other.graph.zero if value is None else value


def _project_rates(m: Machine) -> Function:
    about = "u - M^-1 J' S^-1 (J u + ...): the nearest admissible speeds, in the metric of M"
    values, pivots = multipliers.projected(m.schur, m.speeds, [r.rate for r in m.schur.rows])
    return assemble("project_rates", about, (len(values),), values, pivots)


Build = Callable[[Machine], Function]
FUNCTIONS: dict[str, Build] = {
    "constraint_residuals": _residuals,
    "constraint_rates": _rates,
    "constraint_jacobian": _jacobian,
    "multipliers": _multipliers,
    "project_positions": _project_positions,
    "project_rates": _project_rates,
}
# these read no rates: they serve every state that has q
OVER_POSITIONS = ("constraint_jacobian", "project_positions")
OVER_OWN_RATES = ("constraint_residuals", "constraint_rates")


def functions(m: Machine, names: Sequence[str] = tuple(FUNCTIONS)) -> tuple[Function, ...]:
    """The functions of a linked scene with independent rows."""
    return tuple(FUNCTIONS[name](m) for name in names)


def dependent_functions(m: Machine, model: Model) -> tuple[Function, ...]:
    """All coordinates and their rates over the independent ones, of a minimal formulation."""
    bindings = m.kinematics.algebra.bindings
    size = (len(model.coordinates),)
    places = [bindings[c.symbol] for c in model.coordinates]
    rates = [bindings[c.rate] for c in model.coordinates]
    about = "all coordinates of the spec over the independent ones"
    return (
        assemble("all_coordinates", about, size, places),
        assemble("all_rates", f"rates of {about}", size, rates),
    )
