"""A program made faster for its parameters: some folded into the code, the rest prepared once.

Folding binds a parameter to its number and rebuilds every function on a graph, where constants
meet exactly. Preparing moves what depends on parameters alone to a function of its own, whose
results the others read as `constants`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from eomgen.algebra import cancellation, fixed, half_angles
from eomgen.algebra.arithmetic import evaluate, mpmath_arithmetic
from eomgen.algebra.assemble import assemble, written
from eomgen.algebra.graph import Graph, Node
from eomgen.algebra.ldl import SingularMassMatrix
from eomgen.algebra.lift import Lifted, Target, lift
from eomgen.algebra.lower import GraphAlgebra
from eomgen.algebra.terms import Products
from eomgen.algebra.walk import below
from eomgen.errors import UsageError
from eomgen.program import Expression, Function, Number, Program, Read, Variable

LITERAL_DIGITS = 60  # of a constant that is not rational, such as the sine of a parameter
ABOUT = "everything that depends on the parameters alone"


def with_values(program: Program) -> frozenset[str]:
    """The names of the parameters that the spec gives a value."""
    return frozenset(p.name for p in program.parameters if p.value is not None)


def specialised(program: Program, folded: Collection[str] = ()) -> Program:
    """The program with these parameters as numbers in its code, and the rest prepared.

    Raises:
        UsageError: a folded parameter makes a value infinite or undefined.
        SingularMassMatrix: with the folded values some motion has no inertia.
    """
    free = tuple(p for p in program.parameters if p.name not in folded)
    target = target_of(program, free)
    lifted = [on_graph(function, target) for function in program.functions]
    constants, given = _constants(lifted, len(free))
    return replace(
        program,
        parameters=free,
        functions=tuple(_assembled(each, given) for each in lifted),
        prepare=assemble("prepare", ABOUT, (len(constants),), constants) if constants else None,
        folded=program.folded + tuple(p for p in program.parameters if p.name in folded),
    )


def target_of(program: Program, free: tuple[Variable, ...]) -> Target:
    """A new graph whose first leaves are the free parameters; the others are numbers."""
    graph = Graph()
    places = {p.name: graph.read("parameters", i) for i, p in enumerate(free)}
    algebra = GraphAlgebra(graph, {})
    given = {
        Read("parameters", i): places.get(p.name) or algebra.of(p.value)
        for i, p in enumerate(program.parameters)
    }
    count = len(free)
    positive = [places[p.name] for p in free if p.value is not None and p.value.is_positive]

    def is_fixed(node: Node) -> bool:
        return not node.leaves >> count

    build = cancellation.builders(fixed.builders(is_fixed), is_fixed, positive)
    return Target(graph, build, given)


def on_graph(function: Function, target: Target) -> Lifted:
    """The function on the graph, without the pivots that are positive numbers."""
    try:
        found = lift(function, target)
    except ZeroDivisionError as error:
        raise UsageError(
            f"{function.name} divides by zero with the folded parameters; "
            "give them other values, or generate without --fold"
        ) from error
    pivots = tuple(p for p in found.pivots if not _is_positive(p[0]))
    return _halved(replace(found, pivots=pivots), target)


def _halved(found: Lifted, target: Target) -> Lifted:
    """The function with half angles where these keep digits."""
    nodes = [*found.results, *(n for pair in found.pivots for n in pair)]
    made = half_angles.replaced(nodes, target.build, Products())
    if made is None:
        return found
    pivots = tuple((made[a], made[b]) for a, b in found.pivots)
    return replace(found, results=tuple(made[a] for a in found.results), pivots=pivots)


def _is_positive(pivot: Node) -> bool:
    """Whether a pivot is known to be positive; one that never is is an error."""
    if pivot.leaves:
        return False
    value = literal(pivot)
    if value <= 0:
        raise SingularMassMatrix("with the folded parameters", float(value))
    return True


def _constants(lifted: Iterable[Lifted], free: int) -> tuple[list[Node], dict[Node, Expression]]:
    """The largest values that are fixed and must be computed, and what is written for each.

    A value without any argument is written as the number that it is.
    """
    wanted = [a for each in lifted for a in (*each.results, *(n for p in each.pivots for n in p))]
    edge = [a for a in below(wanted, stop=lambda a: is_fixed(a, free)) if is_fixed(a, free)]
    computed = [a for a in edge if not is_written(a)]
    known = literals([a for a in computed if not a.leaves])
    numbers: dict[Node, Expression] = {a: Number(value) for a, value in known.items()}
    constants = [a for a in computed if a.leaves]
    return constants, numbers | {a: Read("constants", i) for i, a in enumerate(constants)}


def is_fixed(node: Node, free: int) -> bool:
    """Whether a value depends on parameters alone: these are the first leaves of the graph."""
    return not node.leaves >> free


def is_written(node: Node) -> bool:
    """Whether a fixed value is as good as its name: an argument, a number, or minus one."""
    if node.operator == "negate":
        node = node.operands[0]
    return node.operator in ("read", "number")


def literal(node: Node) -> Fraction:
    """A value without arguments as a number, exact or to `LITERAL_DIGITS`; raises as `literals`."""
    return literals([node])[node]


def literals(nodes: Sequence[Node]) -> dict[Node, Fraction]:
    """Values without arguments as numbers, all computed at once.

    What is left of a sum that is zero shrinks with more digits: it is written as zero.

    Raises:
        UsageError: one is not real and finite.
    """
    try:
        rough, fine = (
            [_exact(value) for value in evaluate(nodes, {}, mpmath_arithmetic(digits))]
            for digits in (LITERAL_DIGITS, 2 * LITERAL_DIGITS)
        )
    except (ValueError, ZeroDivisionError, OverflowError) as error:
        raise UsageError(
            f"a formula without coordinates is not real and finite: {error}; "
            "mend the formula or the values of its parameters"
        ) from error
    least = Fraction(1, 10 ** (LITERAL_DIGITS // 2))
    values = [
        a if abs(b) > least * abs(a) else Fraction(0) for a, b in zip(rough, fine, strict=True)
    ]
    pairs = zip(nodes, values, strict=True)
    return {a: a.datum if a.operator == "number" else value for a, value in pairs}


def _exact(value: Any) -> Fraction:
    """A number of mpmath as the fraction that it is."""
    mantissa, exponent = abs(value).man_exp
    size = Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
    return -size if value < 0 else size


def _assembled(each: Lifted, given: Mapping[Node, Expression]) -> Function:
    """The function of a program again."""
    return written(each.function, each.results, each.pivots, given)
