"""What the templates of C and Python are given: text, numbers and records of these."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import sympy as sp

from eomgen.program import OPERATORS, Program, Solve, Variable
from eomgen.render.code import number
from eomgen.render.dialects import C_FUNCTIONS, PYTHON, C, Dialect
from eomgen.render.names import escaped, prefix
from eomgen.render.routines import routine


@dataclass(frozen=True)
class Symbol:
    """A scalar of the interface: its name in the spec, in the code, and its value as a literal."""

    name: str
    code: str
    unit: str
    about: str
    value: str | None


def symbols(variables: tuple[Variable, ...], reserved: frozenset[str]) -> tuple[Symbol, ...]:
    """The variables as a target writes them."""
    codes = escaped((v.name for v in variables), reserved)
    return tuple(
        Symbol(v.name, code, v.unit, v.about, None if v.value is None else number(v.value))
        for v, code in zip(variables, codes, strict=True)
    )


def interface(program: Program, dialect: Dialect) -> dict[str, Any]:
    """What every code template is given: plain text and numbers only."""
    reserved = dialect.reserved_members
    functions = tuple(routine(f, program, dialect) for f in program.functions)
    used = frozenset[str]().union(*(f.operators for f in functions))
    statements = [s for f in program.functions for s in f.statements]
    return {
        "name": program.name,
        "prefix": prefix(program.name),
        "title": program.title,
        "digest": program.digest,
        "version": program.version,
        "engine": program.engine,
        "coordinates": symbols(program.coordinates, reserved),
        "speeds": symbols(program.speeds, reserved),
        "inputs": symbols(program.inputs, reserved),
        "parameters": symbols(program.parameters, reserved),
        "outputs": symbols(program.outputs, reserved),
        "functions": functions,
        "operators": tuple(o for o in OPERATORS if o in used),
        "solve_sizes": tuple(sorted({s.size for s in statements if isinstance(s, Solve)})),
        "pivots": any(f.can_fail for f in functions),
        "in_motion": any("accelerations" in f.takes for f in functions),
    }


def c(program: Program) -> dict[str, object]:
    """The names of the C templates: `interface` and the functions of <math.h> that are called."""
    context = interface(program, C)
    used = {*context["operators"], *(["abs"] if context["pivots"] else [])}
    calls = [(C.calls[o], f, OPERATORS[o]) for o, f in C_FUNCTIONS.items() if o in used]
    unknown = tuple(v.name for v in program.parameters if v.value is None)
    open_codes = dict(zip(unknown, escaped(unknown, C.reserved), strict=True))
    return context | {
        "math": tuple(calls),
        "open_codes": tuple(open_codes.values()),  # arguments of the function that sets parameters
        "defaults": tuple(
            open_codes[v.name] if v.value is None else _c_constant(v.value)
            for v in program.parameters
        ),
        "initial_state": _initial_state(program, _c_constant),
    }


def _c_constant(value: sp.Expr) -> str:
    text = number(value)
    sign = text[:1] if text.startswith("-") else ""
    return sign + C.number.format(text.removeprefix("-"))


def _initial_state(program: Program, text: Callable[[sp.Expr], str]) -> tuple[str, ...] | None:
    """The initial values, or None where the spec leaves one open."""
    values = [v.value for v in program.coordinates + program.speeds]
    known = [text(v) for v in values if v is not None]
    return tuple(known) if len(known) == len(values) else None


def python(program: Program) -> dict[str, object]:
    """The names of the Python templates."""
    context = interface(program, PYTHON)
    locals_ = {a.code for f in context["functions"] for a in f.arguments}
    return context | {
        "initial_state": _initial_state(program, number),
        "ambiguous": not locals_.isdisjoint("lOI"),  # to a linter
    }
