"""A program with the step functions that are made for it: what targets of integrators render."""

from __future__ import annotations

from dataclasses import dataclass, replace

from eomgen.integrators.methods import MIDPOINT_ITERATIONS, Method
from eomgen.integrators.tableaus import Tableau
from eomgen.program import Program


@dataclass(frozen=True)
class Steps:
    """`program` has every function that the steps call; which of them it has says how they work."""

    program: Program
    methods: tuple[Method, ...]
    compensated: bool = False  # a sum of increments that keeps what rounding loses

    @property
    def name(self) -> str:
        """The stem of the files."""
        return self.program.name

    def has(self, function: str) -> bool:
        """Whether the program has a function."""
        return any(f.name == function for f in self.program.functions)

    @property
    def is_canonical(self) -> bool:
        """Whether the midpoint rule runs on momenta."""
        return self.has("momenta")

    @property
    def projects_positions(self) -> bool:
        """Whether positions can be off: a row holds between them, or a quaternion has a length."""
        return self.has("project_positions") and (
            self.residuals > 0 or not self.has("constraint_residuals")
        )

    @property
    def residuals(self) -> int:
        """The number of rows between positions."""
        found = (f for f in self.program.functions if f.name == "constraint_residuals")
        return next((f.shape[0] for f in found), 0)

    @property
    def size(self) -> int:
        """Length of the state."""
        return len(self.program.coordinates) + len(self.program.speeds)

    def completing(self, program: Program) -> Program:
        """A program with what the steps call."""
        known = {f.name for f in program.functions}
        called = {name for method in self.methods for name in self.calls(method)} - known
        more = tuple(f for f in self.program.functions if f.name in called)
        return replace(program, functions=program.functions + more)

    def calls(self, method: Method) -> dict[str, int]:
        """How often one step calls each function of the program."""
        return CALLS[method.kind](self, method) | _ending(self)


def _explicit(steps: Steps, method: Method) -> dict[str, int]:
    assert isinstance(method.table, Tableau)
    return {"state_derivative": len(method.table.b)}


def _semi_euler(steps: Steps, method: Method) -> dict[str, int]:
    return {"accelerations": 1} | ({"rates": 1} if steps.has("rates") else {})


def _semi_euler_damped(steps: Steps, method: Method) -> dict[str, int]:
    return _semi_euler(steps, method) | {"damping_jacobian": 1}


def _verlet(steps: Steps, method: Method) -> dict[str, int]:
    return {"accelerations": 1}


def _rosenbrock(steps: Steps, method: Method) -> dict[str, int]:
    return {"state_jacobian": 1, "state_derivative": 2}


def _midpoint(steps: Steps, method: Method) -> dict[str, int]:
    if not steps.is_canonical:
        return {"state_jacobian": 1, "state_derivative": MIDPOINT_ITERATIONS}
    return {
        "momenta": 2,
        "state_jacobian": 1,
        "momentum_rates": MIDPOINT_ITERATIONS,
        "rates_of_momenta": MIDPOINT_ITERATIONS + 1,
    }


CALLS = {
    "explicit": _explicit,
    "semi_euler": _semi_euler,
    "semi_euler_damped": _semi_euler_damped,
    "verlet": _verlet,
    "rosenbrock": _rosenbrock,
    "midpoint": _midpoint,
}


def _ending(steps: Steps) -> dict[str, int]:
    """After every step: back to the constraints, and the check that it worked."""
    positions = ["constraint_margin", "project_positions", "constraint_residuals"]
    wanted = positions if steps.projects_positions else []
    return {name: 1 for name in (*wanted, "project_rates") if steps.has(name)}
