"""The local error of every statement in float: what it loses itself, and how much of it arrives.

Its operands are the fifty-digit values rounded to float, and its result is compared with its own
fifty-digit value: nothing is inherited from earlier statements, and cancellation shows. A value
that passes zero, or that vanishes on the constraints, loses digits that no result misses: counted
is the error relative to the value or that which reaches the results, whichever is smaller.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen import interpreter
from eomgen.algebra.arithmetic import NUMPY, Arithmetic
from eomgen.precision.engines import arrays_of
from eomgen.precision.exact import Exact
from eomgen.precision.reach import Sweep, reach, seeds
from eomgen.precision.records import Array, Sampled, StatementErrors
from eomgen.program import (
    Alike,
    Apply,
    Assign,
    Expression,
    Program,
    Read,
    Solve,
    Value,
    in_lane,
)
from eomgen.render.dialects import C
from eomgen.render.grouped import codes, groups
from eomgen.render.lowered import lower
from eomgen.render.names import prefix
from eomgen.render.naming import variables

SHOWN = 10
SMALLEST = 2.0**-126  # of float, but for subnormal numbers
FLOAT = arrays_of("float")
Reaches = Mapping[Expression, Array]


@dataclass(frozen=True)
class Traced:
    """A function in fifty digits, and what errors of its results are compared with."""

    exact: Exact
    scales: Array  # (number of results, N)


@dataclass(frozen=True)
class _Local:
    """The local errors of one place in the C: (N,), NaN where there is no value."""

    function: str
    target: str  # what stands before the equals sign
    worst: float
    median: float
    at: int
    whole: float  # of all errors, by which the same statement of another function is known


def worst_of(
    shipped: Program, traced: Mapping[str, Traced], sampled: Sampled, text: str
) -> tuple[StatementErrors, ...]:
    """The `SHOWN` statements with the largest local errors, worst first.

    traced: functions by name, and `prepare`; text: the C. Statements that functions share count
    once.
    """
    sweeps = {name: _adjoints(each, sampled) for name, each in traced.items() if name != "prepare"}
    if "prepare" in traced:
        sweeps["prepare"] = _of_constants(traced["prepare"], sampled, list(sweeps.values()))
    found = [
        local
        for name, each in traced.items()
        for local in _of_function(shipped, name, each, (sampled, sweeps[name]))
    ]
    found.sort(key=lambda e: (-e.worst, -e.median))
    alike: dict[float, list[_Local]] = {}
    for each in (e for e in found if e.worst > 0):
        alike.setdefault(each.whole, []).append(each)
    sections = _sections(text, shipped)
    return tuple(_shown(same, sections, text) for same in list(alike.values())[:SHOWN])


def _arguments(name: str, exact: Exact, sampled: Sampled) -> dict[str, Any]:
    """What a function reads."""
    if name == "prepare":
        return {"parameters": list(sampled.parameters)}
    return {**sampled.columns(), "constants": list(exact.constants)}


def _adjoints(traced: Traced, sampled: Sampled) -> Reaches:
    """How far each value reaches into the results of its function, (N,) each."""
    memory = _memory(traced.exact, _arguments("", traced.exact, sampled), NUMPY)
    adjoints = Sweep(memory).back(traced.exact.function, seeds(traced.scales))
    size = len(traced.scales)
    return {e: reach(a, size) for e, a in adjoints.items()}


def _of_constants(traced: Traced, sampled: Sampled, functions: list[Reaches]) -> Reaches:
    """How far each value of `prepare` reaches into the results of any function, (1,) each."""
    count = len(traced.exact.constants)
    largest = np.zeros(count)
    for reaches in functions:
        for i in range(count):
            found = reaches.get(Read("constants", i), np.zeros(1))
            largest[i] = max(largest[i], np.nanmax(found, initial=0.0))
    memory = _memory(traced.exact, _arguments("prepare", traced.exact, sampled), NUMPY)
    started = [np.eye(count)[:, i : i + 1] * largest[i] for i in range(count)]
    adjoints = Sweep(memory).back(traced.exact.function, started)
    made: dict[Expression, Array] = {Read("constants", i): largest[i : i + 1] for i in range(count)}
    return made | {e: np.abs(a).max(axis=0) for e, a in adjoints.items()}


def _memory(
    exact: Exact, arguments: Mapping[str, Any], arithmetic: Arithmetic
) -> interpreter.Memory:
    """All values of a function, rounded to those of an arithmetic."""
    memory = interpreter.Memory(arguments, arithmetic)
    memory.values = {name: arithmetic.number(v) for name, v in exact.values.items()}
    return memory


def _of_function(
    shipped: Program, name: str, traced: Traced, beside: tuple[Sampled, Reaches]
) -> Iterator[_Local]:
    """The local errors of a function's statements and of its results."""
    exact, (sampled, reaches) = traced.exact, beside
    names = _targets(shipped, name)
    constants = [f"m->{code}" for code in codes(len(exact.function.results), groups(shipped))]
    nowhere = np.zeros(1)

    def local(value: str, found: Any) -> _Local:
        truth, reached = exact.values[value], reaches.get(Value(value), nowhere)
        return _local(name, names[value], (found, truth, reached))

    def last(index: int, found: Any) -> _Local:
        truth = exact.results[index].astype(float)
        if name == "prepare":
            reached = reaches[Read("constants", index)]
            return _local(name, constants[index], (found, truth, reached))
        return _local(name, f"result[{index}]", (found, truth, 1 / traced.scales[index]))

    with FLOAT.quiet():
        memory = _memory(exact, _arguments(name, exact, sampled), FLOAT)
        rounded = dict(memory.values)
        for statement in exact.function.statements:
            match statement:
                case Assign(value, Apply() as expression):
                    yield local(value, memory.value(expression))
                case Solve(values, _, _):
                    memory.execute(statement)
                    solution, memory.values = memory.values, dict(rounded)
                    yield from (local(v, solution[v]) for v in values if v in names)
        for index, result in enumerate(exact.function.results):
            if isinstance(result, Apply):
                yield last(index, memory.value(result))


def _targets(shipped: Program, name: str) -> dict[str, str]:
    """What stands before the equals sign of each value; in a loop over lanes all have the same."""
    source = shipped.prepare if name == "prepare" else shipped.function(name)
    assert source is not None
    lowered = lower(source)
    names = variables(lowered, shipped, C)
    found = {value: code for value, code in names.items() if isinstance(value, str)}
    for statement in lowered.statements:
        if isinstance(statement, Alike):
            each = ((s.name, k) for s in statement.statements for k in range(statement.lanes))
            found |= {in_lane(value, k): found[value] for value, k in each}
    return found


def _local(function: str, target: str, numbers: tuple[Any, Array, Array]) -> _Local:
    """The errors of a place; numbers: what float makes of it, the truth, how far errors reach.

    Counted is the error relative to the value, at most 1, or what reaches the results if less.
    """
    found, truth, reached = numbers
    gap = np.abs(np.asarray(found, float) - truth)
    relative = np.minimum(gap / np.maximum(np.abs(truth), SMALLEST), 1.0)
    errors = np.minimum(relative, gap * reached)
    usable = np.flatnonzero(np.isfinite(errors))
    if not len(usable):
        return _Local(function, target, 0.0, 0.0, 0, 0.0)
    at = int(usable[np.argmax(errors[usable])])
    worst, median = float(errors[at]), float(np.median(errors[usable]))
    return _Local(function, target, worst, median, at, float(np.sum(gap[usable])))


def _sections(text: str, shipped: Program) -> dict[str, tuple[int, int]]:
    """Where the statements of every function stand in the C, with those of its parts."""
    start = text.index(f"void {prefix(shipped.name)}_prepare(")
    end = text.index("\n}\n", start)
    sections = {"prepare": (0, end)}
    for function in shipped.functions:
        start, end = (
            end,
            text.index(f"return {prefix(shipped.name)}_prepared_{function.name}(", end),
        )
        sections[function.name] = (start, end)
    return sections


def _shown(same: list[_Local], sections: dict[str, tuple[int, int]], text: str) -> StatementErrors:
    """The statement with its source, of the first function that holds it."""
    first = same[0]
    place = _find(first.target, text, *sections[first.function])
    source = " ".join(text[place : text.index(";", place) + 1].split())
    functions = tuple(dict.fromkeys(e.function for e in same))
    line = text.count("\n", 0, place) + 1
    return StatementErrors(functions, line, source, first.worst, first.median, first.at)


def _find(target: str, text: str, start: int, end: int) -> int:
    """Where a variable or a result gets its value; a part of a long function has its own array."""
    spelled = re.escape(target)
    if target.startswith("result"):
        spelled = f"(?:{spelled}|{re.escape(target.replace('result', 'work'))})"
    elif not target.startswith("m->") and not target.endswith("[lane]"):
        spelled = rf"const \w+ {spelled}"
    found = re.compile(rf"\b{spelled} =\s").search(text, start, end)
    assert found, f"{target} is not in the C"
    return found.start()
