"""Functions that integrators call beside the standard ones: Jacobian, momenta, pivot guard."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce

import sympy as sp

from eomgen.algebra import ldl
from eomgen.algebra.arithmetic import evaluate, over
from eomgen.algebra.assemble import assemble
from eomgen.algebra.elementary import maximum, minimum
from eomgen.algebra.graph import LEAVES, Node
from eomgen.algebra.walk import below
from eomgen.checks import damping, separable
from eomgen.compile import LARGEST_UNROLLED, Machine, solved
from eomgen.errors import UsageError
from eomgen.functions import table
from eomgen.functions.motion import Motion
from eomgen.integrators.methods import Method
from eomgen.mechanics import multipliers, speeds
from eomgen.model import TIME
from eomgen.program import Function


@dataclass(frozen=True)
class Scene:
    """The machine that is integrated, and the one over all coordinates that knows the rows."""

    machine: Machine
    rows: Machine

    @property
    def is_canonical(self) -> bool:
        """Whether p = dT/dq' are momenta of free coordinates: the midpoint rule is symplectic."""
        return not self.machine.model.speeds and not self.machine.kept

    @property
    def has_positions(self) -> bool:
        """Whether an independent row holds between positions, so that these can drift."""
        is_eliminated = not self.machine.model.constraints
        return not is_eliminated and any(
            r.residual is not None for r in self.rows.rows if r.name in self.rows.kept
        )


def functions(scene: Scene, methods: Sequence[Method]) -> tuple[Function, ...]:
    """What these methods need of a scene beside its standard functions.

    Raises:
        UsageError: a method is not what it should be for this scene.
    """
    kinds = {m.kind for m in methods}
    for guide in scene.rows.model.guides if methods else ():
        raise UsageError(
            f"--integrator: {guide.name} has friction on both sides: the motion is that of a mode, "
            "stick or slip, so that a step needs events; call the functions of the modes instead"
        )
    for method in methods:
        if said := refusal(scene, method):
            raise UsageError(said)
    wanted = [f for kind, names in NEEDS.items() if kind in kinds for f in names]
    found = [FUNCTIONS[name](scene) for name in dict.fromkeys((*ALWAYS, *wanted))]
    return tuple(f for f in found if f is not None)


# kind of a method -> what a scene has against it, and how that is said
OBSTACLES: dict[str, tuple[Callable[[Machine], str], str]] = {
    "verlet": (
        separable.obstacle,
        "E-SYM: {name} is not symplectic for this model ({why}); "
        "expect energy drift of order h; use rk4",
    ),
    "semi_euler_damped": (
        damping.obstacle,
        "E-DAMP: {name} needs applied forces that damp and are linear in the speeds ({why}); "
        "use semi-euler or rosenbrock2",
    ),
}


def refusal(scene: Scene, method: Method) -> str:
    """Why a method is not what it should be for this scene, with the remedy; empty if it is."""
    if method.kind not in OBSTACLES:
        return ""
    find, words = OBSTACLES[method.kind]
    why = find(scene.machine)
    return words.format(name=method.name, why=why) if why else ""


def offers(scene: Scene, method: Method) -> bool:
    """Whether a method is what it should be for this scene."""
    return not refusal(scene, method)


def state_jacobian(m: Machine) -> Function:
    """d (q', u') / d (q, u)."""
    return table.ROWS["state_jacobian"].build(Motion(m))


def _jacobian(scene: Scene) -> Function:
    return state_jacobian(scene.machine)


def _rates(scene: Scene) -> Function | None:
    """q' as a function of its own, where it is not u."""
    m = scene.machine
    if not m.model.speeds:
        return None
    return assemble("rates", "q', the rates of the coordinates", (len(m.rates),), m.rates, m.pivots)


def _damping_jacobian(scene: Scene) -> Function:
    """-M^-1 D, or what the constraints leave of it: du'/du by the applied forces alone."""
    m = scene.machine
    columns = list(zip(*damping.matrix(m), strict=True))
    if m.kept:
        still = [m.kinematics.algebra.number(0)] * len(m.schur.rows)
        found, pivots = multipliers.responses(m.schur, m.inertia, [[*c, *still] for c in columns])
    elif len(columns) > LARGEST_UNROLLED:
        found, pivots = ldl.solve_in_loop(m.mass_matrix, *columns), ()
    else:
        found, pivots = ldl.solve(m.mass_matrix, *columns)
    entries = [-entry for row in zip(*found, strict=True) for entry in row]
    about = "-M^-1 D, D = -dQ/du: the derivatives of u' by u through the applied forces alone"
    shape = (len(columns), len(columns))
    return assemble("damping_jacobian", about, shape, entries, m.pivots + pivots)


def _momentum(m: Machine) -> list[Node]:
    """p = dT/dq'."""
    algebra, one = m.kinematics.algebra, m.kinematics.algebra.number(1)
    return [algebra.along(m.energy[0], {s: one}) for s in speeds.symbols(m.model)]


def _momenta(scene: Scene) -> Function | None:
    if not scene.is_canonical:
        return None
    values = _momentum(scene.machine)
    return assemble("momenta", "p = dT/dq', the canonical momenta", (len(values),), values)


def _momentum_rates(scene: Scene) -> Function | None:
    """p' = M q'' + (dp/dt at constant q') = Q - h + ..."""
    if not scene.is_canonical:
        return None
    m, algebra = scene.machine, scene.machine.kinematics.algebra
    flow: dict[sp.Symbol, Node] = dict(m.kinematics.flow.rates)
    flow[TIME] = algebra.number(1)
    values = [
        q - h + algebra.along(p, flow)
        for p, q, h in zip(
            _momentum(m), m.equations.generalized_forces, m.equations.bias, strict=True
        )
    ]
    return assemble("momentum_rates", "p' = dL/dq + Q", (len(values),), values)


def _rates_of_momenta(scene: Scene) -> Function | None:
    """q' = M^-1 (p - p at rest)."""
    if not scene.is_canonical:
        return None
    m, algebra = scene.machine, scene.machine.kinematics.algebra
    symbols = speeds.symbols(m.model)
    given = [algebra.of(s) for s in symbols]
    # p = M q' + c where c does not depend on q'
    momenta = _momentum(m)
    leaves = {node: node for node in below(momenta) if node.operator in LEAVES}
    rest = evaluate(momenta, leaves | dict.fromkeys(given, algebra.number(0)), over(algebra))
    right = [p - c for p, c in zip(given, rest, strict=True)]
    solution, pivots = solved(m.equations.mass_matrix, right)
    about = "q' where the state holds the momenta p in the place of the speeds"
    return assemble("rates_of_momenta", about, (len(solution),), solution, pivots)


def _guard(scene: Scene) -> Function | None:
    """How far the rows are from losing their rank."""
    if not scene.has_positions:
        return None
    pivots: list[Node] = []
    if len(scene.rows.kept) < 2:  # nothing to compare with
        return None
    ldl.factor(scene.rows.schur.matrix, lambda row, pivot, scale: pivots.append(pivot))
    value = reduce(minimum, pivots) / reduce(maximum, pivots)
    about = (
        "smallest over largest pivot of S = J M^-1 J': near zero, or no number, where the "
        "constraints lose rank and positions are not to be projected"
    )
    return assemble("constraint_margin", about, (1,), [value])


Build = Callable[[Scene], Function | None]
FUNCTIONS: dict[str, Build] = {
    "state_jacobian": _jacobian,
    "rates": _rates,
    "damping_jacobian": _damping_jacobian,
    "momenta": _momenta,
    "momentum_rates": _momentum_rates,
    "rates_of_momenta": _rates_of_momenta,
    "constraint_margin": _guard,
}
ALWAYS = ("constraint_margin",)
NEEDS = {  # kind of a method -> functions, where the scene has them
    "semi_euler": ("rates",),
    "semi_euler_damped": ("rates", "damping_jacobian"),
    "rosenbrock": ("state_jacobian",),
    "midpoint": ("state_jacobian", "momenta", "momentum_rates", "rates_of_momenta"),
}
