"""Lagrange in closed form against Newton-Euler on the graph: the promise of the tool."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial, reduce
from typing import Any

from eomgen.algebra.arithmetic import evaluate, mpmath_arithmetic
from eomgen.algebra.arithmetic import over as arithmetic_over
from eomgen.algebra.closed import ClosedForm, Evaluation
from eomgen.algebra.normal import Form, TooLarge
from eomgen.algebra.walk import below
from eomgen.checks.evaluation import Bench, benches, over, singly, symbol_of
from eomgen.checks.samples import Samples
from eomgen.compile import Machine
from eomgen.errors import CheckError
from eomgen.mechanics import lagrange
from eomgen.mechanics.equations import Derivation, Equations

FLOAT_TOLERANCE = 1e-9  # a larger disagreement in double is decided in 50 digits
DIGITS = 50
EXACT_TOLERANCE = 1e-30
DECIDING_STATES = 5
LARGEST_PROOF = 600  # nodes; and no intermediate form with more terms than this


@dataclass(frozen=True)
class Agreement:
    """How far two derivations differ: the worst relative error, and whether equality is proven."""

    states: int
    error: float
    digits: int
    proven: bool


def compare(derivation: Derivation, machine: Machine, samples: Samples) -> Agreement:
    """The agreement of the closed form with the graph.

    Raises:
        CheckError: they differ, or no sampled state is regular.
    """
    errors = over(benches(machine, samples), partial(worst, derivation))
    digits = 16
    if max(errors) > FLOAT_TOLERANCE:
        errors, digits = decided(derivation, machine, samples), DIGITS
    return Agreement(len(errors), max(errors), digits, proven(derivation, machine))


def decided(derivation: Derivation, machine: Machine, samples: Samples) -> list[float]:
    """The errors in 50 digits, for scenes where doubles lose too many.

    Raises:
        CheckError: the two derivations differ.
    """
    exact = singly(machine, samples, mpmath_arithmetic(DIGITS), DECIDING_STATES)
    errors = over(exact, partial(worst, derivation))
    if max(errors) > EXACT_TOLERANCE:
        raise CheckError(
            "Lagrange's equations and Newton-Euler's differ, relative error "
            f"{max(errors):.1e} in {DIGITS} digits: this is a defect of eomgen, "
            "nothing was written"
        )
    return errors


def worst(derivation: Derivation, at: Bench, accelerations: Sequence[Any]) -> Any:
    """The largest difference of the residuals M u' + h - Q over the size of their terms."""
    form = at.forms()
    graph = _values(at.machine.equations, at.nodes)
    closed = _values(derivation.matrix, lambda forms: [form(f) for f in forms])
    return reduce(
        at.arithmetic.functions["max"],
        [_relative(left, right, accelerations) for left, right in zip(graph, closed, strict=True)],
    )


Row = tuple[list[Any], Any, Any]  # a row of M, h, Q


def _values(equations: Equations[Any], evaluate: Callable[[Sequence[Any]], list[Any]]) -> list[Row]:
    size = len(equations.bias)
    flat = [entry for row in equations.mass_matrix for entry in row]
    values = evaluate([*flat, *equations.bias, *equations.generalized_forces])
    return [
        (values[i * size : (i + 1) * size], values[size**2 + i], values[size**2 + size + i])
        for i in range(size)
    ]


def _relative(left: Row, right: Row, accelerations: Sequence[Any]) -> Any:
    """|difference of the residuals| / (sum of the sizes of the terms), 0 where all vanish."""

    def residual(row: Row) -> Any:
        return sum(m * a for m, a in zip(row[0], accelerations, strict=True)) + row[1] - row[2]

    def size(row: Row) -> Any:
        return sum(abs(m * a) for m, a in zip(row[0], accelerations, strict=True)) + sum(
            abs(v) for v in row[1:]
        )

    scale = size(left) + size(right)
    return abs(residual(left) - residual(right)) / (scale + (scale == 0))


def proven(derivation: Derivation, machine: Machine) -> bool:
    """Whether the two derivations are equal in exact arithmetic; tried where they are small."""
    equations = machine.equations
    nodes = [*(e for row in equations.mass_matrix for e in row), *equations.bias]
    nodes += equations.generalized_forces
    if len(below(nodes)) > LARGEST_PROOF:
        return False
    matrix = derivation.matrix
    forms = [*(e for row in matrix.mass_matrix for e in row), *matrix.bias]
    forms += matrix.generalized_forces
    try:
        return _identical(machine, nodes, forms)
    except TooLarge:
        return False


def _identical(machine: Machine, nodes: Sequence[Any], forms: Sequence[Form]) -> bool:
    """The graph evaluated over the closed form, less the closed form, is zero."""
    algebra = ClosedForm()
    lagrange.normed(algebra, machine.model)
    arithmetic = arithmetic_over(algebra)
    arithmetic = replace(
        arithmetic, functions={**arithmetic.functions, "multiply": _bounded_product}
    )
    leaves = {node: algebra.of(symbol) for node, symbol in symbol_of(machine).items()}
    bindings = machine.kinematics.algebra.bindings
    values = dict(zip(bindings, evaluate(bindings.values(), leaves, arithmetic), strict=True))
    form = Evaluation(values, algebra.number, lambda name, *a: arithmetic.functions[name](*a)).of
    pairs = zip(evaluate(nodes, leaves, arithmetic), forms, strict=True)
    return all(algebra.is_zero(left - form(right)) for left, right in pairs)


def _bounded_product(left: Form, right: Form) -> Form:
    if len(left.terms) * len(right.terms) > LARGEST_PROOF:
        raise TooLarge  # states are compared instead
    return left * right
