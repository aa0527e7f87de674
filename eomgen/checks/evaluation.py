"""Values of closed forms and of graph nodes at the same samples."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import isfinite
from typing import Any

import sympy as sp

from eomgen.algebra.arithmetic import FLOAT, NUMPY, Arithmetic, complete
from eomgen.algebra.closed import Evaluation
from eomgen.algebra.graph import Node
from eomgen.algebra.normal import Form
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError
from eomgen.mechanics import speeds
from eomgen.program import Read


@dataclass(frozen=True)
class Bench:
    """A scene at a state, or at many: values of its leaves, over one kind of number."""

    machine: Machine
    leaves: dict[Node, Any]
    arithmetic: Arithmetic
    known: dict[Node, Any] = field(default_factory=dict)  # every value is computed once

    def __post_init__(self) -> None:
        self.known.update(self.leaves)

    def nodes(self, nodes: Sequence[Node]) -> list[Any]:
        """Values of graph nodes."""
        complete(self.known, nodes, self.arithmetic)
        return [self.known[node] for node in nodes]

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


def free_accelerations(machine: Machine) -> tuple[Node, ...]:
    """u' as free symbols, for identities that hold whatever they are."""
    graph = machine.kinematics.algebra.number(0).graph
    return tuple(graph.symbol(f"{s.name}'") for s in speeds.symbols(machine.model))


def symbol_of(machine: Machine) -> dict[Node, sp.Symbol]:
    """The symbol of every argument."""
    bindings = machine.kinematics.algebra.bindings
    return {node: s for s, node in bindings.items() if isinstance(node.datum, Read)}


LARGEST_SINGLY = 600  # nodes of a scene that is evaluated state by state, without NumPy
States = Iterable[tuple[Bench, list[Any]]]


def benches(machine: Machine, samples: Samples) -> States:
    """(the scene, accelerations of the speeds) at each of the samples; large scenes at all."""
    if len(machine.kinematics.algebra.number(0).graph.nodes) <= LARGEST_SINGLY:
        return singly(machine, samples, FLOAT, samples.count)
    columns = [NUMPY.number(column) for column in samples.accelerations]
    everything = _bench(machine, samples.arguments(), columns, NUMPY)
    return [(replace(everything, known=samples.known), columns)]


def singly(
    machine: Machine, samples: Samples, arithmetic: Arithmetic, count: int
) -> Iterator[tuple[Bench, list[Any]]]:
    """(the scene, accelerations of the speeds) at the first samples, one by one."""
    for i in range(min(samples.count, count)):
        arguments = {
            name: [column[i] for column in columns] for name, columns in samples.arguments().items()
        }
        accelerations = [arithmetic.number(column[i]) for column in samples.accelerations]
        yield _bench(machine, arguments, accelerations, arithmetic), accelerations


def _bench(
    machine: Machine,
    arguments: Mapping[str, Sequence[Any]],
    accelerations: Sequence[Any],
    arithmetic: Arithmetic,
) -> Bench:
    leaves = {
        leaf: arithmetic.number(arguments[leaf.datum.argument][leaf.datum.index])
        for leaf in machine.leaves
    }
    leaves |= zip(free_accelerations(machine), accelerations, strict=True)
    return Bench(machine, leaves, arithmetic)


IRREGULAR = (ValueError, ZeroDivisionError, OverflowError)  # a root or quotient is not defined


def over(states: States, error_of: Callable[[Bench, list[Any]], Any]) -> list[float]:
    """The errors at the states where everything is defined.

    Raises:
        CheckError: there is no such state.
    """
    errors: list[float] = []
    for at, accelerations in states:
        with suppress(*IRREGULAR), at.arithmetic.quiet():
            errors += finite(error_of(at, accelerations))
    if not errors:
        raise CheckError(
            "no regular state was found to check the equations at; give `range` for the "
            "coordinates, so that roots and quotients are defined there"
        )
    return errors


def finite(values: Any) -> list[float]:
    """The finite ones among the values of one state, or of all states at once."""
    found = values.tolist() if hasattr(values, "tolist") else values
    return [float(v) for v in (found if isinstance(found, list) else [found]) if isfinite(v)]
