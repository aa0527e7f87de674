"""The methods that generated C can have: one row each.

`semi-euler`, its damped form and `verlet` are named by what they do with (q, u):
semi-euler  u+ = u + h u'(q, u),  q+ = q + h q'(q, u+);
semi-euler-damped  (M + h D) (u+ - u) = h (Q - bias),  q+ = q + h q'(q, u+),  D = -dQ/du;
verlet      q_m = q + h/2 u,  u+ = u + h u'(q_m),  q+ = q_m + h/2 u+  (position form, one force);
midpoint    of (q, p) where the momenta p = dT/du are canonical, else of the state.
"""

from __future__ import annotations

from dataclasses import dataclass

from eomgen.errors import UsageError
from eomgen.integrators.tableaus import DOPRI5, RK4, ROS2, Rosenbrock, Tableau

ALL = "all"
MIDPOINT_ITERATIONS = 6  # of a simplified Newton method; a fixed number, so a step has one cost


@dataclass(frozen=True)
class Method:
    """A fixed-step method; `kind` names how a step is made, in C and in Python."""

    name: str
    order: int
    kind: str
    about: str
    table: Tableau | Rosenbrock | None = None

    @property
    def spelled(self) -> str:
        """The name as part of a function's name."""
        return self.name.replace("-", "_")


METHODS = {
    m.name: m
    for m in (
        Method("semi-euler", 1, "semi_euler", "semi-implicit Euler, one evaluation"),
        Method(
            "semi-euler-damped",
            1,
            "semi_euler_damped",
            "semi-implicit Euler, implicit in the damping, one evaluation",
        ),
        Method("verlet", 2, "verlet", "Stormer-Verlet in position form, one evaluation"),
        Method("rk4", 4, "explicit", "Runge-Kutta of order 4, four evaluations", RK4),
        Method("dopri5", 5, "explicit", "Dormand-Prince of order 5 at a fixed step", DOPRI5),
        Method("rosenbrock2", 2, "rosenbrock", "Rosenbrock of order 2, L-stable", ROS2),
        Method("midpoint", 2, "midpoint", "implicit midpoint, Newton iterations of fixed number"),
    )
}


def chosen(names: tuple[str, ...]) -> tuple[Method, ...]:
    """The methods of these names, each once, in the order of the table; `all` are all.

    Raises:
        UsageError: there is no such method.
    """
    for name in names:
        if name not in METHODS and name != ALL:
            known = ", ".join([*METHODS, ALL])
            raise UsageError(f"there is no integrator {name!r}; there are {known}")
    return tuple(m for m in METHODS.values() if ALL in names or m.name in names)
