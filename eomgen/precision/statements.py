"""The local error of every statement in float: what it loses itself, of exact operands.

Its operands are the fifty-digit values rounded to float, and its result is compared with its own
fifty-digit value: nothing is inherited from earlier statements, and cancellation shows.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from eomgen import interpreter
from eomgen.precision.engines import arrays_of
from eomgen.precision.exact import Exact
from eomgen.precision.records import Array, Sampled, StatementErrors
from eomgen.program import Apply, Assign, Program, Solve, Value
from eomgen.render.dialects import C
from eomgen.render.names import prefix
from eomgen.render.routines import variables

SHOWN = 10
SMALLEST = 2.0**-126  # of float, but for subnormal numbers
FLOAT = arrays_of("float")


@dataclass(frozen=True)
class _Local:
    """The local errors of one place in the C: (N,), NaN where there is no value."""

    function: str
    target: str  # what stands before the equals sign
    worst: float
    median: float
    at: int


def worst_of(
    shipped: Program, traced: dict[str, Exact], sampled: Sampled, text: str
) -> tuple[StatementErrors, ...]:
    """The `SHOWN` statements with the largest local errors, worst first.

    traced: functions by name, and `prepare`; text: the C. Statements that functions share count
    once.
    """
    found = [e for name, exact in traced.items() for e in _of_function(shipped, name, exact, sampled)]
    found.sort(key=lambda e: (-e.worst, -e.median))
    alike: dict[tuple[float, float, int], list[_Local]] = {}
    for each in found:
        alike.setdefault((each.worst, each.median, each.at), []).append(each)
    sections = _sections(text, shipped)
    return tuple(_shown(same, sections, text) for same in list(alike.values())[:SHOWN])


def _of_function(
    shipped: Program, name: str, exact: Exact, sampled: Sampled
) -> Iterator[_Local]:
    """The local errors of a function's statements and of its results."""
    names = variables(exact.function, shipped, C)
    columns = sampled.columns() if name != "prepare" else {"parameters": sampled.parameters}
    with FLOAT.quiet():
        memory = interpreter.Memory({**columns, "constants": exact.constants}, FLOAT)
        rounded = {v: FLOAT.number(a) for v, a in exact.values.items()}
        memory.values = dict(rounded)
        for statement in exact.function.statements:
            match statement:
                case Assign(value, Apply() as expression):
                    errors = _errors(memory.value(expression), exact.values[value])
                    yield _local(name, names[Value(value)], errors)
                case Solve(values, _, _):
                    memory.execute(statement)
                    for value in (v for v in values if Value(v) in names):
                        errors = _errors(memory.values[value], exact.values[value])
                        yield _local(name, names[Value(value)], errors)
                    memory.values = dict(rounded)
        for index, result in enumerate(exact.function.results):
            if isinstance(result, Apply):
                truth = exact.results[index].astype(float)
                target = f"m->c{index}" if name == "prepare" else f"result[{index}]"
                yield _local(name, target, _errors(memory.value(result), truth))


def _errors(found: Any, truth: Array) -> Array:
    """|found - truth| / |truth|, at most 1: no digit is right; what float cannot hold is 0."""
    value = np.asarray(found, float)
    nothing = (np.abs(truth) < SMALLEST) & (np.abs(value) < SMALLEST)
    relative = np.abs(value - truth) / np.where(truth != 0, np.abs(truth), SMALLEST)
    errors: Array = np.where(nothing, 0.0, np.minimum(relative, 1.0))
    return errors


def _local(function: str, target: str, errors: Array) -> _Local:
    usable = np.flatnonzero(np.isfinite(errors))
    if not len(usable):
        return _Local(function, target, 0.0, 0.0, 0)
    at = int(usable[np.argmax(errors[usable])])
    return _Local(function, target, float(errors[at]), float(np.median(errors[usable])), at)


def _sections(text: str, shipped: Program) -> dict[str, tuple[int, int]]:
    """Where the statements of every function stand in the C, with those of its parts."""
    start = text.index(f"void {prefix(shipped.name)}_prepare(")
    end = text.index("\n}\n", start)
    sections = {"prepare": (0, end)}
    for function in shipped.functions:
        start, end = end, text.index(f"return {prefix(shipped.name)}_prepared_{function.name}(", end)
        sections[function.name] = (start, end)
    return sections


def _shown(
    same: list[_Local], sections: dict[str, tuple[int, int]], text: str
) -> StatementErrors:
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
    elif not target.startswith("m->"):
        spelled = rf"const \w+ {spelled}"
    found = re.compile(rf"\b{spelled} =\s").search(text, start, end)
    assert found, f"{target} is not in the C"
    return found.start()
