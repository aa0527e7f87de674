"""Equations on the graph -> Program: what was asked for, sliced from what it needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import sympy as sp

from eomgen import __version__
from eomgen.algebra import ldl
from eomgen.algebra.assemble import assemble
from eomgen.algebra.derive import gradient
from eomgen.algebra.graph import Node
from eomgen.compile_variables import moving, of_speeds, variable
from eomgen.mechanics import (
    constraints,
    energies,
    machine,
    motions,
    multipliers,
    speeds,
    virtual_work,
)
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.equations import Contribution, Equations
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive import build, engine, gravity, loads, recursion
from eomgen.mechanics.recursive.engine import Engine
from eomgen.mechanics.recursive.lumping import lumped
from eomgen.mechanics.recursive.records import NoTree, Tree
from eomgen.mechanics.vectors import Matrix, Vector, dot
from eomgen.model import Coordinate, Model
from eomgen.program import Function, Program, Read

LARGEST_MATRIX = 32  # equations; above, the n^2 entries of M are written only if asked for
LARGEST_UNROLLED = 12  # equations; above, L D L' runs in a loop


@dataclass(frozen=True)
class Machine:
    """A scene on the graph with its equations, each derived once when first asked for."""

    kinematics: Kinematics[Node]
    kept: tuple[str, ...] = ()  # names of the independent rows, with a multiplier each
    pivots: ldl.Pivots = ()  # that the rates divide by
    baumgarte: Fraction = Fraction(0)  # alpha [1/s] of stabilised rows; zero: none
    weight: Fraction = Fraction(0)  # w, where M + w J'J has to stand for a singular M
    eliminated: tuple[Coordinate, ...] = ()  # of the spec, bound to formulas in the others

    @property
    def model(self) -> Model:
        """The scene."""
        return self.kinematics.model

    @cached_property
    def leaves(self) -> tuple[Node, ...]:
        """The arguments of the program, as nodes."""
        bound = self.kinematics.algebra.bindings.values()
        return tuple(node for node in dict.fromkeys(bound) if isinstance(node.datum, Read))

    @cached_property
    def tree(self) -> Tree | NoTree:
        """The tree of joints, or why there is none."""
        try:
            return build.tree_of(self.kinematics)
        except NoTree as reason:
            return reason

    @cached_property
    def engine(self) -> Engine | None:
        """The way to the accelerations of a tree without links; None: by the mass matrix."""
        if isinstance(self.tree, NoTree) or self.kept:
            return None
        return engine.choose(self.kinematics, self.tree)

    @cached_property
    def equations(self) -> Equations[Node]:
        """M, h, Q: by recursion over a tree, by d'Alembert's principle where there is none."""
        if isinstance(self.tree, NoTree):
            return virtual_work.derive(self.kinematics)
        return Equations(self.mass_matrix, self.bias, self.generalized_forces)

    @cached_property
    def _lumped(self) -> Tree | None:
        """The tree that the recursion goes over."""
        if isinstance(self.tree, NoTree):
            return None
        return lumped(self.tree) if self.engine is None else self.engine.tree

    @cached_property
    def mass_matrix(self) -> Matrix[Node]:
        """M, which a large tree needs for nothing else."""
        tree = self._lumped
        return self.equations.mass_matrix if tree is None else recursion.mass_matrix(tree)

    @cached_property
    def bias(self) -> Vector[Node]:
        """H of M u' + h = Q."""
        tree = self._lumped
        return self.equations.bias if tree is None else recursion.inverse_dynamics(tree, False)

    @cached_property
    def generalized_forces(self) -> Vector[Node]:
        """Q of M u' + h = Q."""
        tree = self._lumped
        if tree is None:
            return self.equations.generalized_forces
        return loads.generalized_forces(self.kinematics, tree)

    def inverse_dynamics(self, accelerations: Sequence[Node]) -> Vector[Node]:
        """M u' + h - Q for these u': by recursion, or by d'Alembert's principle."""
        tree = self._lumped
        if tree is None:
            return virtual_work.inverse_dynamics(self.kinematics, accelerations)
        applied = loads.of(self.kinematics, tree)
        return recursion.inverse_dynamics(tree, True, accelerations, applied)

    @cached_property
    def energy(self) -> tuple[Node, Node]:
        """T and V."""
        return (
            self._total(energies.kinetic(self.kinematics)),
            self._total(energies.potential(self.kinematics)),
        )

    @cached_property
    def short_energy(self) -> tuple[Node, Node]:
        """The same T and V in fewer operations, where there is a tree of frames."""
        if isinstance(self.tree, NoTree) or self._lumped is None:
            return self.energy
        return gravity.shortest(self.kinematics, self.tree, self._lumped, self.energy)

    def _total(self, shares: Sequence[Contribution[Node]]) -> Node:
        return sum((s.value for s in shares), self.kinematics.algebra.number(0))

    @cached_property
    def momenta(self) -> tuple[Node, ...]:
        """dT/du."""
        return tuple(gradient(self.energy[0], self.speeds))

    @cached_property
    def rows(self) -> tuple[Row[Node], ...]:
        """Every row of the bilateral constraints."""
        return constraints.rows(self.kinematics, speeds.symbols(self.model))

    @cached_property
    def schur(self) -> multipliers.Schur:
        """The Schur complement of the independent rows."""
        return multipliers.schur(self.equations, self.independent_rows, self.weight)

    @property
    def independent_rows(self) -> list[Row[Node]]:
        """The rows with a multiplier each."""
        return [r for r in self.rows if r.name in self.kept]

    @cached_property
    def inertia(self) -> tuple[tuple[Node, ...], ...]:
        """What is divided by: M, or M + w J'J."""
        return multipliers.inertia(self.equations, self.independent_rows, self.weight)

    @cached_property
    def linked(self) -> multipliers.Solution:
        """Accelerations and multipliers of a linked scene."""
        return multipliers.solve(self.schur, self.baumgarte)

    @cached_property
    def solution(self) -> tuple[tuple[Node, ...], ldl.Pivots]:
        """u' by the engine of a tree, or M^-1 (Q - h), or with multipliers of kept rows."""
        if self.kept:
            return self.linked.accelerations, self.linked.pivots
        if self.engine is not None:
            return self.engine.accelerations, self.pivots + self.engine.pivots
        matrix, bias = self.equations.mass_matrix, self.equations.bias
        right = [q - h for q, h in zip(self.equations.generalized_forces, bias, strict=True)]
        solution, pivots = solved(matrix, right)
        return solution, self.pivots + pivots

    @cached_property
    def rates(self) -> tuple[Node, ...]:
        """q'."""
        return tuple(self.kinematics.flow.rates[c.symbol] for c in self.model.coordinates)

    @cached_property
    def accelerations(self) -> tuple[Node, ...]:
        """q'' = (dq'/du) u' + the rate of q' with u' = 0."""
        if not self.model.speeds:
            return self.solution[0]
        coasting = (self.kinematics.rate(r) for r in self.rates)
        return tuple(a + c for a, c in zip(self.turned(self.solution[0]), coasting, strict=True))

    @cached_property
    def partial_rates(self) -> tuple[tuple[Node, ...], ...]:
        """N = dq'/du of declared speeds, a row for each coordinate."""
        algebra, one = self.kinematics.algebra, self.kinematics.algebra.number(1)
        return tuple(
            tuple(algebra.along(r, {s.symbol: one}) for s in self.model.speeds) for r in self.rates
        )

    def turned(self, values: Sequence[Node]) -> tuple[Node, ...]:
        """From speeds to coordinates: N * values; the values themselves where the speeds are q'."""
        if not self.model.speeds:
            return tuple(values)
        return tuple(dot(row, values) for row in self.partial_rates)

    @property
    def speeds(self) -> tuple[Node, ...]:
        """The speeds u."""
        return tuple(self.kinematics.algebra.of(s) for s in speeds.symbols(self.model))

    @cached_property
    def outputs(self) -> tuple[Node, ...]:
        """The author's own formulas."""
        holds_motion = motions.holds_motion(self.model, self.eliminated)
        return self.outputs_with(self.motion if holds_motion else {})

    def outputs_with(self, motion: Mapping[sp.Symbol, Node]) -> tuple[Node, ...]:
        """The author's own formulas over these q'' and u'; none where no formula holds one."""
        algebra = self.kinematics.algebra.extended(motion)
        return tuple(algebra.of(o.formula) for o in self.model.outputs)

    @cached_property
    def motion(self) -> dict[sp.Symbol, Node]:
        """q'' and u' on the motion, by their symbols."""
        pairs = list(zip(self.model.coordinates, self.accelerations, strict=True))
        own = zip(self.model.speeds, self.solution[0], strict=bool(self.model.speeds))
        found = {s.rate: a for s, a in own} | {c.acceleration: a for c, a in pairs}
        if not self.eliminated:
            return found
        # d/dt of the rates that follow from the others
        algebra = self.kinematics.algebra
        flow = {**self.kinematics.flow.derivatives, **{c.rate: a for c, a in pairs}}
        follow = {c.acceleration: algebra.along(algebra.of(c.rate), flow) for c in self.eliminated}
        return found | follow


def solved(
    matrix: Sequence[Sequence[Node]], right: Sequence[Node]
) -> tuple[tuple[Node, ...], ldl.Pivots]:
    """x of A x = b, unrolled up to `LARGEST_UNROLLED`, else in a loop that checks its pivots."""
    if len(right) > LARGEST_UNROLLED:
        (solution,) = ldl.solve_in_loop(matrix, right)
        return tuple(solution), ()
    (solution,), pivots = ldl.solve(matrix, right)
    return tuple(solution), pivots


def machine_of(model: Model) -> Machine:
    """The scene on a new graph.

    Raises:
        UsageError: declared speeds are not independent.
    """
    return Machine(machine.graph_kinematics(model))


Build = Callable[[Machine], Function]


def _flat(rows: Sequence[Sequence[Node]]) -> list[Node]:
    return [entry for row in rows for entry in row]


def _mass_matrix(m: Machine) -> Function:
    n = len(m.mass_matrix)
    about = "M of M u' + h = Q"
    return assemble("mass_matrix", about, (n, n), _flat(m.mass_matrix))


def _bias(m: Machine) -> Function:
    about = "h of M u' + h = Q: inertia terms without accelerations"
    return assemble("bias", about, (len(m.bias),), m.bias)


def _generalized_forces(m: Machine) -> Function:
    about = "Q of M u' + h = Q: everything applied"
    forces = m.generalized_forces
    return assemble("generalized_forces", about, (len(forces),), forces)


def _accelerations_function(m: Machine) -> Function:
    about = "u' = M^-1 (Q - h), the derivatives of the speeds"
    solution, pivots = m.solution
    return assemble("accelerations", about, (len(solution),), solution, pivots)


def _coordinate_accelerations(m: Machine) -> Function:
    about = "q'', the second derivatives of the coordinates"
    results = m.accelerations
    return assemble("coordinate_accelerations", about, (len(results),), results, m.solution[1])


def _state_derivative(m: Machine) -> Function:
    about = "(q', u'), the derivative of the state"
    solution, pivots = m.solution
    results = [*m.rates, *solution]
    return assemble("state_derivative", about, (len(results),), results, pivots)


def _project_positions(m: Machine) -> Function:
    about = "the coordinates with every quaternion divided by its length"
    results = motions.normalised(m.model, m.kinematics.algebra)
    return assemble("project_positions", about, (len(results),), results)


def _energy(m: Machine) -> Function:
    return assemble("energy", "kinetic and potential energy [J]", (2,), m.short_energy)


def _outputs(m: Machine) -> Function:
    return assemble(
        "outputs", "the outputs of the spec", (len(m.outputs),), m.outputs, m.solution[1]
    )


FUNCTIONS: dict[str, Build] = {
    "mass_matrix": _mass_matrix,
    "bias": _bias,
    "generalized_forces": _generalized_forces,
    "accelerations": _accelerations_function,
    "coordinate_accelerations": _coordinate_accelerations,
    "state_derivative": _state_derivative,
    "project_positions": _project_positions,
    "energy": _energy,
    "outputs": _outputs,
}


def wanted(model: Model) -> tuple[str, ...]:
    """The functions of a model: q'' apart only where the speeds are not q', M of few of them."""
    few = len(speeds.symbols(model)) <= LARGEST_MATRIX
    unneeded: set[str] = set() if few else {"mass_matrix"}
    unneeded |= set() if model.speeds else {"coordinate_accelerations"}
    unneeded |= set() if model.quaternions else {"project_positions"}
    return tuple(f for f in FUNCTIONS if f not in unneeded)


def program(m: Machine, names: Sequence[str] = ()) -> Program:
    """The program of a scene.

    names: the only functions of `wanted` that it is to have; (): all of them.

    Raises:
        SingularMassMatrix: some motion has no inertia whatever the state.
    """
    model = m.model
    return Program(
        name=model.name,
        title=next(iter(model.title.values())),
        digest=model.digest,
        version=__version__,
        coordinates=tuple(moving(model, c) for c in model.coordinates),
        speeds=of_speeds(model),
        inputs=tuple(variable(i.name, i.description) for i in model.inputs),
        parameters=tuple(
            variable(p.name, p.description, p.value) for p in machine.free_parameters(model)
        ),
        outputs=tuple(variable(o.name, o.description) for o in model.outputs),
        functions=tuple(FUNCTIONS[f](m) for f in wanted(model) if not names or f in names),
        engine="" if m.engine is None else m.engine.said,
    )
