"""Long functions with limbs that are alike, specialised for their parameters.

The limbs are found before numbers take the place of parameters: a zero or a sign in one leg would
make it unlike the others.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from eomgen.algebra.alike import Rows, rows_of
from eomgen.algebra.assemble import assemble, written
from eomgen.algebra.graph import Node
from eomgen.algebra.ldl import SingularMassMatrix
from eomgen.algebra.lift import Lifted, lift
from eomgen.algebra.specialise import (
    ABOUT,
    is_fixed,
    is_written,
    literals,
    on_graph,
    specialised,
    target_of,
)
from eomgen.algebra.walk import below
from eomgen.algebra.weave import woven
from eomgen.program import Expression, Function, Number, Program, Read


def side_by_side(program: Program, folded: Collection[str], longest: int) -> Program:
    """`specialised`, with limbs that are alike in loops in functions with more statements.

    Raises:
        UsageError, SingularMassMatrix: as `specialised`.
    """
    found = _found(program, longest) if len(folded) in (0, len(program.parameters)) else []
    if not found or (folded and not any(each.rows for each in found)):
        return specialised(program, folded)
    constants = _constants(found, len(program.parameters), bool(folded))
    if not folded:
        return _prepared(program, found, constants)
    numbers = _numbers(program, constants)
    functions = tuple(_function(_open(each, numbers), numbers) for each in found)
    numbered = program.folded + program.parameters
    return replace(program, parameters=(), functions=functions, folded=numbered)


@dataclass(frozen=True)
class _Found:
    """A function on the graph, and its rows if there are any worth a loop."""

    lifted: Lifted
    rows: Rows | None

    @property
    def checks(self) -> list[Node]:
        """The pivots and their scales."""
        return [n for pair in self.lifted.pivots for n in pair]


def _found(program: Program, longest: int) -> list[_Found]:
    """Every function, with the rows of the long ones; nothing where none is long."""
    if all(len(f.statements) <= longest for f in program.functions):
        return []
    free = len(program.parameters)
    target = target_of(program, program.parameters)
    found = []
    for function in program.functions:
        each = on_graph(function, target)
        is_long = len(function.statements) > longest
        found.append(_Found(each, _rows(_Found(each, None), free) if is_long else None))
    return found


def _rows(each: _Found, free: int) -> Rows | None:
    """The rows of a function; none where it solves systems in a loop of their own."""
    if any(n.operator == "solved" for n in below([*each.lifted.results, *each.checks])):
        return None
    return rows_of(each.lifted.results, each.checks, lambda n: is_fixed(n, free))


def _constants(found: Sequence[_Found], free: int, every: bool) -> list[Node]:
    """Fixed values that are read, those that rows read together one behind the other.

    every: also those that are as good as their names.
    """
    packs = [n for each in found if each.rows for pack in each.rows.packs for n in pack]
    wanted = [a for each in found for a in (*each.lifted.results, *each.checks)]
    edge = below(wanted, stop=lambda a: is_fixed(a, free))
    both = dict.fromkeys([*packs, *(a for a in edge if every or not is_written(a))])
    return [a for a in both if is_fixed(a, free) and a.operator != "number"]


def _prepared(program: Program, found: Sequence[_Found], fixed: Sequence[Node]) -> Program:
    """Functions that read the constants of `prepare`, and numbers that need no parameter."""
    constants = [a for a in fixed if a.leaves]
    known = literals([a for a in fixed if not a.leaves])
    given: dict[Node, Expression] = {a: Number(value) for a, value in known.items()}
    given |= {a: Read("constants", i) for i, a in enumerate(constants)}
    functions = tuple(_function(each, given) for each in found)
    prepare = assemble("prepare", ABOUT, (len(constants),), constants) if constants else None
    return replace(program, functions=functions, prepare=prepare)


def _numbers(program: Program, constants: Sequence[Node]) -> dict[Node, Expression]:
    """What the constants are with the values of the spec."""
    prepare = assemble("prepare", ABOUT, (len(constants),), constants)
    values = lift(prepare, target_of(program, ())).results
    known = literals(values)
    return {a: Number(known[v]) for a, v in zip(constants, values, strict=True)}


def _open(each: _Found, given: Mapping[Node, Expression]) -> _Found:
    """The function without the pivots that are positive numbers."""
    open_ones = []
    for pivot, scale in each.lifted.pivots:
        match given.get(pivot):
            case Number(value) if value <= 0:
                raise SingularMassMatrix("with the folded parameters", float(value))
            case Number():
                continue
        open_ones.append((pivot, scale))
    return replace(each, lifted=replace(each.lifted, pivots=tuple(open_ones)))


def _function(each: _Found, given: Mapping[Node, Expression]) -> Function:
    """The function of a program again."""
    function, results, pivots = each.lifted.function, each.lifted.results, each.lifted.pivots
    if each.rows is None:
        return written(function, results, pivots, given)
    return woven(function, results, pivots, given, each.rows)
