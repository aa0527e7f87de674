"""Long functions with limbs that are alike, specialised for their parameters.

The limbs are found before numbers take the place of parameters: a zero or a sign in one leg would
make it unlike the others.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from eomgen.algebra.alike import Rows, rows_of
from eomgen.algebra.assemble import assemble, written
from eomgen.algebra.graph import Node, below
from eomgen.algebra.ldl import SingularMassMatrix
from eomgen.algebra.lift import Lifted, lift
from eomgen.algebra.specialise import (
    ABOUT,
    is_fixed,
    is_written,
    literal,
    on_graph,
    specialised,
    target_of,
)
from eomgen.algebra.weave import woven
from eomgen.program import Expression, Function, Number, Program, Read


def side_by_side(program: Program, folded: Collection[str], longest: int) -> Program:
    """`specialised`, with limbs that are alike in loops in functions with more statements.

    Raises:
        UsageError, SingularMassMatrix: as `specialised`.
    """
    if len(folded) not in (0, len(program.parameters)):
        return specialised(program, folded)
    long = [len(f.statements) > longest for f in program.functions]
    if not any(long):
        return specialised(program, folded)
    free = len(program.parameters)
    target = target_of(program, program.parameters)
    found = [on_graph(f, target) for f in program.functions]
    rows = [_rows(each, free) if is_long else None for each, is_long in zip(found, long, strict=True)]
    if not any(rows):
        return specialised(program, folded)
    constants = _constants(found, [r for r in rows if r], free, bool(folded))
    prepare = assemble("prepare", ABOUT, (len(constants),), constants)
    if folded:
        given = _numbers(program, prepare, constants)
        found = [replace(each, pivots=_open(each, given)) for each in found]
        prepared, parameters = None, ()
    else:
        given = {a: Read("constants", i) for i, a in enumerate(constants)}
        prepared, parameters = prepare, program.parameters
    return replace(
        program,
        parameters=parameters,
        functions=tuple(_function(e, given, r) for e, r in zip(found, rows, strict=True)),
        prepare=prepared,
        folded=program.folded + (program.parameters if folded else ()),
    )


def _rows(each: Lifted, free: int) -> Rows | None:
    checks = [n for pair in each.pivots for n in pair]
    if any(n.operator == "solved" for n in below([*each.results, *checks])):
        return None
    return rows_of(each.results, checks, lambda n: is_fixed(n, free))


def _constants(
    found: Sequence[Lifted], rows: Sequence[Rows], free: int, all_of_them: bool
) -> list[Node]:
    """All fixed values that are read, those that rows read together one behind the other."""
    packs = [n for r in rows for pack in r.packs for n in pack]
    wanted = [a for e in found for a in (*e.results, *(n for pair in e.pivots for n in pair))]
    edge = below(wanted, stop=lambda a: is_fixed(a, free))
    both = dict.fromkeys([*packs, *(a for a in edge if all_of_them or not is_written(a))])
    return [a for a in both if is_fixed(a, free) and a.operator != "number"]


def _numbers(
    program: Program, prepare: Function, constants: Sequence[Node]
) -> Mapping[Node, Expression]:
    """What the constants are with the values of the spec."""
    values = lift(prepare, target_of(program, ())).results
    return {a: Number(literal(v)) for a, v in zip(constants, values, strict=True)}


def _open(each: Lifted, given: Mapping[Node, Expression]) -> tuple[tuple[Node, Node], ...]:
    """The pivots that are no positive numbers."""
    found = []
    for pivot, scale in each.pivots:
        match given.get(pivot):
            case Number(value):
                if value <= 0:
                    raise SingularMassMatrix("with the folded parameters", float(value))
            case _:
                found.append((pivot, scale))
    return tuple(found)


def _function(each: Lifted, given: Mapping[Node, Expression], rows: Rows | None) -> Function:
    if rows is None:
        return written(each.function, each.results, each.pivots, given)
    return woven(each.function, each.results, each.pivots, given, rows)
