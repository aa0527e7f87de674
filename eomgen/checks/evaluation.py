"""Values of closed forms and of graph nodes at the same samples."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy as sp

from eomgen.algebra.arithmetic import NUMPY, Arithmetic, evaluate
from eomgen.algebra.closed import Evaluation
from eomgen.algebra.graph import Node
from eomgen.algebra.normal import Form
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.program import Read


@dataclass(frozen=True)
class Bench:
    """A scene with the values of its leaves, over one kind of number."""

    machine: Machine
    leaves: dict[Node, Any]
    arithmetic: Arithmetic

    @property
    def size(self) -> int:
        """The number of samples."""
        return max((len(v) for v in self.leaves.values() if getattr(v, "shape", ())), default=1)

    def nodes(self, nodes: Sequence[Node]) -> list[Any]:
        """Values of graph nodes."""
        return evaluate(nodes, self.leaves, self.arithmetic)

    def forms(self) -> Callable[[Form], Any]:
        """A function that evaluates closed forms; every symbol has the value of its node."""
        bindings = self.machine.kinematics.algebra.bindings
        symbols = list(bindings)
        values = dict(zip(symbols, self.nodes([bindings[s] for s in symbols]), strict=True))
        return Evaluation(
            values,
            lambda c: self.arithmetic.number(Fraction(c)),
            lambda name, *a: self.arithmetic.functions[name](*a),
        ).of


def leaves_of(machine: Machine) -> list[Node]:
    """The arguments of the program, as nodes."""
    bound = machine.kinematics.algebra.bindings.values()
    return [node for node in dict.fromkeys(bound) if isinstance(node.datum, Read)]


def symbol_of(machine: Machine) -> dict[Node, sp.Symbol]:
    """The symbol of every argument."""
    bindings = machine.kinematics.algebra.bindings
    return {node: s for s, node in bindings.items() if isinstance(node.datum, Read)}


def bench(machine: Machine, samples: Samples, arithmetic: Arithmetic = NUMPY) -> Bench:
    """The scene at the samples: one value per component, an array over all of them in NumPy."""
    arguments = samples.arguments()
    leaves = {
        node: arithmetic.number(arguments[node.datum.argument][node.datum.index])
        for node in leaves_of(machine)
    }
    return Bench(machine, leaves, arithmetic)
