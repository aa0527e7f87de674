"""What the templates of C and Python are given: text, numbers and records of these."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from eomgen.algebra.specialise import specialised, with_values
from eomgen.algebra.specialise_alike import side_by_side
from eomgen.program import OPERATORS, Expression, Program, Read, Solve, Variable
from eomgen.render.code import Names, expression, number
from eomgen.render.dialects import C_FUNCTIONS, PLAIN, PYTHON, C, Dialect
from eomgen.render.grouped import codes, groups
from eomgen.render.lowered import content
from eomgen.render.names import escaped, prefix
from eomgen.render.naming import components
from eomgen.render.records import Routine
from eomgen.render.routines import routine

WAVES = ("pair", "sine", "cosine")
MANY_LANES, FEW_LANES = 32, 16  # multiples of the numbers in 64 bytes
FEW_SLOTS = 100  # values that wait for another loop
LONGEST_FORMULA = 60  # characters of a comment


@dataclass(frozen=True)
class Symbol:
    """A scalar of the interface: its name in the spec, in the code, and its value as a literal."""

    name: str
    code: str
    unit: str
    about: str
    value: str | None

    @property
    def meaning(self) -> str:
        """What it is, for a comment."""
        about = f": {self.about}" if self.about else ""
        return f"{self.name}{about}{f' [{self.unit}]' if self.unit else ''}"


def symbols(variables: tuple[Variable, ...], reserved: frozenset[str]) -> tuple[Symbol, ...]:
    """The variables as a target writes them."""
    codes = escaped((v.name for v in variables), reserved)
    return tuple(
        Symbol(v.name, code, v.unit, v.about, None if v.value is None else number(v.value))
        for v, code in zip(variables, codes, strict=True)
    )


@dataclass(frozen=True)
class Style:
    """How the code of a program is written; all but `fold` is about C."""

    fold: bool = False  # parameters with a value are numbers in the code
    fast_trig: bool = False  # an own sine and cosine instead of those of <math.h>
    batch: bool = False  # every function also for many states at once
    longest: int = C.longest  # statements of a function that is not cut into parts


@dataclass(frozen=True)
class Constant:
    """A number that a header defines; a `truth` is 0 or 1, everything else is of its real type."""

    name: str
    value: str
    about: str
    truth: bool = False


@dataclass(frozen=True)
class Remarks:
    """What is known of a scene beside its code: lines of a comment, and numbers to program with."""

    lines: tuple[str, ...] = ()
    constants: tuple[Constant, ...] = ()


@dataclass(frozen=True)
class Code:
    """A program and how it is written, the subject of the targets C and Python."""

    program: Program
    style: Style = Style()
    remarks: Remarks = Remarks()  # of the C header

    @property
    def name(self) -> str:
        """The stem of the files."""
        return self.program.name


def coded(program: Program, style: Style = Style()) -> Code:
    """The program as it is shipped: what depends on parameters alone is folded or prepared.

    Raises:
        UsageError, SingularMassMatrix: with the folded values something is not defined.
    """
    folded = with_values(program) if style.fold else frozenset[str]()
    if style.batch:
        # its lanes are the states
        return Code(specialised(program, folded), style)
    return Code(side_by_side(program, folded, style.longest), style)


def _code(subject: Program | Code) -> Code:
    return subject if isinstance(subject, Code) else Code(subject)


def interface(program: Program, dialect: Dialect) -> dict[str, Any]:
    """What every code template is given: plain text and numbers only."""
    reserved = dialect.reserved_members
    given = components(program, dialect)
    functions = tuple(routine(f, program, dialect, given) for f in program.functions)
    prepare = None if program.prepare is None else routine(program.prepare, program, dialect, given)
    everything = functions if prepare is None else (*functions, prepare)
    used = frozenset[str]().union(*(f.operators for f in everything))
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
        "folded": symbols(program.folded, frozenset()),
        "outputs": symbols(program.outputs, reserved),
        "functions": functions,
        "prepare": prepare,
        "constants": _constants(program),
        "constant_fields": _fields(program),
        "operators": tuple(o for o in OPERATORS if o in used),
        "solve_sizes": tuple(sorted({s.size for s in statements if isinstance(s, Solve)})),
        "pivots": any(f.can_fail for f in functions),
        "in_motion": any("accelerations" in f.takes for f in functions),
    }


def _constants(program: Program) -> tuple[Symbol, ...]:
    """What `prepare` computes, described by its formula where that is short."""
    if program.prepare is None:
        return ()
    names: Names = {Read("parameters", i): p.name for i, p in enumerate(program.parameters)}
    formulas = [_formula(e, names) for e in program.prepare.results]
    named = enumerate(zip(codes(len(formulas), groups(program)), formulas, strict=True))
    return tuple(Symbol(f"c{i}", code, "", text, None) for i, (code, text) in named)


def _fields(program: Program) -> tuple[Symbol, ...]:
    """The constants as members of a struct: groups are arrays."""
    known = groups(program)
    found = []
    for i, symbol in enumerate(_constants(program)):
        if i in known:
            found.append(replace(symbol, code=f"c{i}[{known[i]}]", about=""))
        elif "[" not in symbol.code:
            found.append(symbol)
    return tuple(found)


def _formula(tree: Expression, names: Names) -> str:
    """An expression over parameters as text; empty where it reads named values or is long."""
    if content((tree,)).values:
        return ""
    text = expression(tree, PLAIN, names)
    return text if len(text) <= LONGEST_FORMULA else ""


def c(subject: Program | Code) -> dict[str, object]:
    """The names of the C templates: `interface`, the style, what of <math.h> is called."""
    code = _code(subject)
    program = code.program
    context = interface(program, replace(C, lanes=code.style.batch, longest=code.style.longest))
    waves = _waves([*context["functions"], *filter(None, [context["prepare"]])])
    lane_waves = _lane_waves(context["functions"])
    own_waves = bool(lane_waves or (waves and code.style.fast_trig))
    used = {*context["operators"], *(["abs"] if context["pivots"] or own_waves else [])}
    used |= {"sin", "cos"} if waves and code.style.fast_trig else set()
    calls = [(C.calls[o], f, OPERATORS[o]) for o, f in C_FUNCTIONS.items() if o in used]
    unknown = tuple(v.name for v in program.parameters if v.value is None)
    open_codes = dict(zip(unknown, escaped(unknown, C.reserved), strict=True))
    prepare, constants = context["prepare"], context["constants"]
    prepared = () if prepare is None else prepare.parts or (prepare.body,)
    return context | {
        "prepared": tuple(
            tuple((constants[i].code, text) for i, text in body.results) for body in prepared
        ),
        "remarks": code.remarks.lines,
        "defined": code.remarks.constants,
        "fast_trig": code.style.fast_trig,
        "batch": code.style.batch,
        "waves": waves,
        "lane_waves": lane_waves,
        "lanes": _lanes(context["functions"]),
        "lane_systems": _lane_systems(context["functions"]),
        "own_waves": own_waves,
        "math": tuple(calls),
        "open_codes": tuple(open_codes.values()),  # arguments of the function that sets parameters
        "defaults": tuple(
            (symbol.code, open_codes[v.name] if v.value is None else _c_constant(v.value))
            for symbol, v in zip(context["parameters"], program.parameters, strict=True)
        ),
        "initial_state": _initial_state(program, _c_constant),
    }


def _waves(functions: Iterable[Routine]) -> tuple[str, ...]:
    """The kinds of steps that compute a sine or cosine at one state."""
    found = {s.kind for f in functions for body in (f.body, *f.parts) for s in body.steps}
    return tuple(kind for kind in WAVES if kind in found)


def _lanes(functions: Iterable[Routine]) -> int:
    """How many states are computed side by side; fewer where their values would leave the cache."""
    most = max((f.lanes.slots for f in functions if f.lanes), default=0)
    return MANY_LANES if most <= FEW_SLOTS else FEW_LANES


def _lane_waves(functions: Iterable[Routine]) -> tuple[str, ...]:
    """The same in batches."""
    lanes = [f.lanes for f in functions if f.lanes is not None]
    first = {wave.kind for each in lanes for wave in each.waves}
    found = first | {s.kind for each in lanes for body in each.bodies for s in body.steps}
    return tuple(kind for kind in WAVES if kind in found)


def _lane_systems(functions: Iterable[Routine]) -> tuple[int, ...]:
    """The sizes of systems that are solved for many states at once."""
    bodies = [body for f in functions if f.lanes for body in f.lanes.bodies]
    return tuple(sorted({b.elimination.size for b in bodies if b.elimination}))


def _c_constant(value: sp.Expr) -> str:
    text = number(value)
    sign = text[:1] if text.startswith("-") else ""
    return sign + C.number.format(text.removeprefix("-"))


def _initial_state(program: Program, text: Callable[[sp.Expr], str]) -> tuple[str, ...] | None:
    """The initial values, or None where the spec leaves one open."""
    values = [v.value for v in program.coordinates + program.speeds]
    known = [text(v) for v in values if v is not None]
    return tuple(known) if len(known) == len(values) else None


def python(subject: Program | Code) -> dict[str, object]:
    """The names of the Python templates."""
    program = _code(subject).program
    context = interface(program, PYTHON)
    locals_ = {a.code for f in context["functions"] for a in f.body.arguments}
    return context | {
        "initial_state": _initial_state(program, number),
        "ambiguous": not locals_.isdisjoint("lOI"),  # to a linter
    }
