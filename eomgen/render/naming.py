"""What functions read, and what it is called: in the specification, the interface, the code."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from eomgen.program import (
    ARGUMENTS,
    Alike,
    Expression,
    Function,
    Program,
    Read,
    Solve,
    in_lane,
)
from eomgen.render.dialects import Dialect
from eomgen.render.grouped import Groups, codes, groups
from eomgen.render.lowered import Content, content, expressions
from eomgen.render.names import escaped, prefix

READ = (*ARGUMENTS, "constants")
LANE = "lane"  # the variable of loops over lanes


@dataclass(frozen=True)
class Components:
    """The names of the components of every argument: of the specification, of the interface."""

    labels: dict[str, list[str]]
    members: dict[str, Sequence[str]]
    groups: Groups


def components(program: Program, dialect: Dialect) -> Components:
    """The names of the components of a program's arguments."""
    prepared = program.prepare.results if program.prepare else ()
    labels = {
        "time": ["t"],
        "state": [v.name for v in program.coordinates + program.speeds],
        "accelerations": [f"{v.name}'" for v in program.speeds],
        "inputs": [v.name for v in program.inputs],
        "parameters": [v.name for v in program.parameters],
        "constants": [f"c{i}" for i in range(len(prepared))],
    }
    members = {k: escaped(v, dialect.reserved_members) for k, v in labels.items()}
    known = groups(program)
    return Components(labels, {**members, "constants": codes(len(prepared), known)}, known)


@dataclass(frozen=True)
class Survey:
    """What expressions read: arguments by declaration, without the time, and values."""

    reads: tuple[Read, ...]
    values: tuple[str, ...]
    used: tuple[str, ...]  # which of `READ`


def survey(inside: Content) -> Survey:
    """All that is read, each once."""
    reads = {*inside.reads}
    found = {r.argument for r in reads}
    given = [r for r in reads if r.argument != "time"]
    given.sort(key=lambda r: (READ.index(r.argument), r.index))
    values = dict.fromkeys(inside.values)
    return Survey(tuple(given), tuple(values), tuple(a for a in READ if a in found))


def names_of(
    function: Function, found: Survey, given: Components, reserved: frozenset[str]
) -> dict[Expression | str, str]:
    """The variable of everything that a function reads or computes."""
    arrays = _arrays(function)
    values = list(dict.fromkeys([*found.values, *arrays]))
    labels = [given.labels[r.argument][r.index] for r in found.reads]
    read: list[Expression | str] = [*found.reads, *values]
    names = dict(zip(read, escaped([*labels, *values], reserved), strict=True))
    for array, lanes in arrays.items():
        code = names[array]
        names[array] = f"{code}[{LANE}]"
        names |= {in_lane(array, k): f"{code}[{k}]" for k in range(lanes)}
    return names | {Read("time", 0): "t"}


def variables(lowered: Function, program: Program, dialect: Dialect) -> dict[Expression | str, str]:
    """The variable of everything that a lowered function reads or computes in a program's code."""
    read = survey(content(expressions(lowered)))
    reserved = dialect.reserved | own_names(program, lowered)
    return names_of(lowered, read, components(program, dialect), reserved)


def _arrays(function: Function) -> dict[str, int]:
    """The values that have one entry for each lane, and how many."""
    loops = [s for s in function.statements if isinstance(s, Alike)]
    return {n: s.lanes for s in loops for n in (*(name for name, _ in s.given), *s.kept)}


def own_names(program: Program, function: Function) -> frozenset[str]:
    """Names that our templates give to types, solvers and their arrays."""
    own = {f"{prefix(program.name)}_{kind}" for kind in ("real", "params", "model", "status")}
    for statement in function.statements:
        if isinstance(statement, Solve):
            place = statement.names[0]
            own |= {f"matrix_of_{place}", f"solution_of_{place}", f"solve_{statement.size}"}
    return frozenset(own)
