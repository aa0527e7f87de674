"""A scene in motion: its arguments as nodes, and what must vanish for chosen accelerations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from eomgen.algebra.graph import Node
from eomgen.compile import Machine
from eomgen.mechanics import machine as machines
from eomgen.mechanics import multipliers, regressor, speeds
from eomgen.mechanics.regressor import Inertial
from eomgen.mechanics.vectors import dot, subtract


@dataclass(frozen=True)
class Motion:
    """A scene whose accelerations may be chosen; everything is derived when first asked for."""

    machine: Machine

    def argument(self, name: str, count: int) -> tuple[Node, ...]:
        """The components of an argument of `program.ARGUMENTS`."""
        graph = self.machine.kinematics.algebra.number(0).graph
        return tuple(graph.read(name, i) for i in range(count))

    @property
    def size(self) -> int:
        """The number of speeds."""
        return len(speeds.names(self.machine.model))

    @property
    def state(self) -> tuple[Node, ...]:
        """Coordinates, then speeds."""
        return self.argument("state", len(self.machine.model.coordinates) + self.size)

    @property
    def inputs(self) -> tuple[Node, ...]:
        """The inputs."""
        return self.argument("inputs", len(self.machine.model.inputs))

    @property
    def parameters(self) -> tuple[Node, ...]:
        """The parameters that a caller may set."""
        return self.argument("parameters", len(machines.free_parameters(self.machine.model)))

    @property
    def accelerations(self) -> tuple[Node, ...]:
        """The accelerations u' that a caller chooses."""
        return self.argument("accelerations", self.size)

    @cached_property
    def inverse_dynamics(self) -> tuple[Node, ...]:
        """M u' + h - Q."""
        return self.machine.inverse_dynamics(self.accelerations)

    @cached_property
    def inertial(self) -> tuple[Inertial[Node], ...]:
        """The inertial parameters with their columns of the regressor."""
        return regressor.columns(self.machine.kinematics, self.accelerations)

    @cached_property
    def rest(self) -> tuple[Node, ...]:
        """What the regressor leaves of the inverse dynamics."""
        return regressor.rest(self.machine.kinematics, self.accelerations)

    @cached_property
    def multipliers(self) -> tuple[Node, ...]:
        """A leaf for each independent row."""
        graph = self.machine.kinematics.algebra.number(0).graph
        return tuple(graph.symbol(f"lambda {name}") for name in self.machine.kept)

    @cached_property
    def imbalance(self) -> tuple[Node, ...]:
        """M u' + h - Q - J' lambda, then J q'' + gamma of the independent rows."""
        if not self.machine.kept:
            return self.inverse_dynamics
        rows = self.machine.schur.rows
        held = tuple(
            dot(c, self.multipliers) for c in zip(*(r.jacobian for r in rows), strict=True)
        )
        rate = self.machine.baumgarte
        second = (
            dot(r.jacobian, self.accelerations) + r.gamma + multipliers.stabilised(r, rate)
            for r in rows
        )
        return (*subtract(self.inverse_dynamics, held), *second)

    @cached_property
    def solution(self) -> Mapping[Node, Node]:
        """The accelerations and multipliers of the free motion, by their leaves."""
        found = self.machine.solution[0]
        forces = self.machine.linked.multipliers if self.machine.kept else ()
        leaves = (*self.accelerations, *self.multipliers)
        return dict(zip(leaves, (*found, *forces), strict=True))
