"""Values of closed forms and of graph nodes at the same samples."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy as sp

from eomgen.algebra.arithmetic import FLOAT, Arithmetic, evaluate
from eomgen.algebra.closed import Evaluation
from eomgen.algebra.graph import Node
from eomgen.algebra.normal import Form
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError
from eomgen.program import Read


@dataclass(frozen=True)
class Bench:
    """A scene at one state: the values of its leaves, over one kind of number."""

    machine: Machine
    leaves: dict[Node, Any]
    arithmetic: Arithmetic

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


def benches(
    machine: Machine, samples: Samples, arithmetic: Arithmetic = FLOAT, most: int = 1_000_000
) -> Iterator[tuple[Bench, list[float]]]:
    """(the scene, accelerations of the speeds) at each of the samples."""
    leaves = leaves_of(machine)
    arguments = samples.arguments()
    for i in range(min(samples.count, most)):
        values = {
            leaf: arithmetic.number(arguments[leaf.datum.argument][leaf.datum.index][i])
            for leaf in leaves
        }
        yield Bench(machine, values, arithmetic), [column[i] for column in samples.accelerations]


States = Iterable[tuple[Bench, list[float]]]
IRREGULAR = (ValueError, ZeroDivisionError, OverflowError)  # a root or quotient is not defined


def over(states: States, error_of: Callable[[Bench, list[float]], float]) -> list[float]:
    """The errors at the states where everything is defined.

    Raises:
        CheckError: there is no such state.
    """
    errors = []
    for at, accelerations in states:
        with suppress(*IRREGULAR):
            errors.append(error_of(at, accelerations))
    if not errors:
        raise CheckError(
            "no regular state was found to check the equations at; give `range` for the "
            "coordinates, so that roots and quotients are defined there"
        )
    return errors
