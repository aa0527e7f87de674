"""Functions of a program as text: arguments, steps and results, for a template to lay out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from eomgen.algebra.unroll import unrolled
from eomgen.program import (
    ARGUMENTS,
    OPERATORS,
    Alike,
    Apply,
    Assign,
    Expression,
    Function,
    Number,
    Program,
    Read,
    RequirePositive,
    Solve,
    Statement,
    Value,
    in_lane,
    operands,
)
from eomgen.render.code import Names, expression
from eomgen.render.dialects import Dialect
from eomgen.render.grouped import apart, groups
from eomgen.render.lowered import atoms, expressions, lower, operations
from eomgen.render.names import escaped, prefix
from eomgen.render.parts import Part, divided

COUNTED = {"add": "+", "subtract": "-", "negate": "-", "multiply": "*", "divide": "/"}
READ = (*ARGUMENTS, "constants")
ROWS = ("state", "accelerations", "inputs")  # what differs between the states of a batch
WAVE_KINDS = {"sin": "sine", "cos": "cosine"}
LANE = "lane"  # the variable of loops over lanes
WORK = "work"  # the array of values that cross between the parts of a function
WAVES = "waves"  # the array of sines and cosines of a batch


@dataclass(frozen=True)
class Argument:
    """A local variable `code` that holds component `index`, called `name`, of `source`."""

    code: str
    source: str
    index: int
    name: str


@dataclass(frozen=True)
class Given:
    """An array that a loop over lanes reads; `fixed`: of literals."""

    name: str
    entries: tuple[str, ...]
    fixed: bool


@dataclass(frozen=True)
class Step:
    """One statement; `kind` says which fields are used.

    `assign`; `sine` or `cosine` of an expression, `pair`: both, the cosine called `other`;
    `require`; `solve`; `alike`: steps in a loop over lanes.
    """

    kind: str
    name: str = ""
    expression: str = ""
    other: str = ""
    scale: str = ""
    values: tuple[tuple[str, int], ...] = ()  # of a solve: the names that are read, and where
    matrix: tuple[str, ...] = ()
    right: tuple[str, ...] = ()
    size: int = 0  # of a solve: the number of equations; of a loop that of lanes
    given: tuple[Given, ...] = ()  # of a loop
    steps: tuple[Step, ...] = ()  # of a loop; of kind `assign`, or `keep` in an array
    kept: tuple[str, ...] = ()  # of a loop: arrays that it fills


@dataclass(frozen=True)
class Body:
    """Statements as text with all that they need: of a function, or of a part of one."""

    arguments: tuple[Argument, ...]
    steps: tuple[Step, ...]
    results: tuple[tuple[int, str], ...]  # where each goes, and what
    uses: tuple[str, ...]  # which of `READ` and `WORK` are read

    @property
    def can_fail(self) -> bool:
        """Whether a pivot is checked."""
        return any(step.kind in ("require", "solve") for step in self.steps)


@dataclass(frozen=True)
class Wave:
    """Sines and cosines of an argument, for all lanes in a loop of their own.

    They go to `slot` of `WAVES`, of a pair the cosine to the next.
    """

    kind: str
    source: str
    index: int
    slot: int

    @property
    def slots(self) -> int:
        """How many numbers there are."""
        return 2 if self.kind == "pair" else 1


@dataclass(frozen=True)
class Lanes:
    """A function, or a part of one, for many states: what waves it reads, and the rest."""

    waves: tuple[Wave, ...]
    body: Body

    @property
    def slots(self) -> int:
        """The length of `WAVES`."""
        return sum(w.slots for w in self.waves)


@dataclass(frozen=True)
class Routine:
    """A function as text; if it is long, `parts` compute it over an array of `slots` numbers."""

    name: str
    about: str
    shape: tuple[int, ...]
    body: Body
    parts: tuple[Body, ...]
    lanes: tuple[Lanes, ...]  # of a batch: for every part, or for the whole
    slots: int
    size: int  # the number of results
    operators: frozenset[str]
    operations: str  # such as `3 +  5 *  1 sin`
    takes: tuple[str, ...]  # which of `ARGUMENTS` a caller passes
    uses: tuple[str, ...]  # which of these are read
    can_fail: bool  # a pivot is checked


def routine(function: Function, program: Program, dialect: Dialect) -> Routine:
    """A function of the program as text, every argument that it reads in a variable of its own."""
    whole_function = lower(function if dialect.loops else unrolled(function))
    lowered, direct = apart(whole_function, groups(program))
    found = _survey(expressions(lowered))
    if direct and "constants" not in found.used:
        found = replace(found, used=(*found.used, "constants"))
    names = _names(lowered, found, program, dialect)
    names |= {Value(name): f"m->c{first}[{LANE}]" for name, first in direct.items()}
    text = _Text(dialect, names, _labels(program))
    cut = divided(lowered, dialect.longest)
    whole = Part(lowered.statements, (), tuple((e, i) for i, e in enumerate(lowered.results)))
    return Routine(
        lowered.name,
        lowered.about,
        lowered.shape,
        text.body(whole, found) if cut is None else Body((), (), (), found.used),
        () if cut is None else tuple(text.body(part, _survey_of(part)) for part in cut.parts),
        tuple(map(text.lanes, (whole,) if cut is None else cut.parts)) if dialect.lanes else (),
        0 if cut is None else cut.slots,
        len(lowered.results),
        frozenset(operations(lowered)),
        _counted(unrolled(whole_function)),
        function.arguments,
        found.used,
        _checks_pivots(function),
    )


@dataclass(frozen=True)
class _Survey:
    """What expressions read: arguments by declaration, without the time, and names of values."""

    reads: tuple[Read, ...]
    values: tuple[str, ...]
    used: tuple[str, ...]  # which of `READ`


def _survey(trees: Iterable[Expression]) -> _Survey:
    """All that is read, found in one pass."""
    reads: dict[tuple[str, int], Read] = {}
    values: dict[str, None] = {}
    for tree in trees:
        for atom in atoms(tree):
            if isinstance(atom, Value):
                values[atom.name] = None
            elif isinstance(atom, Read):
                reads[atom.argument, atom.index] = atom
    found = {argument for argument, _ in reads}
    given = [r for r in reads.values() if r.argument != "time"]
    given.sort(key=lambda r: (READ.index(r.argument), r.index))
    return _Survey(tuple(given), tuple(values), tuple(a for a in READ if a in found))


def _survey_of(part: Part) -> _Survey:
    inside = (e for s in part.statements for e in operands(s))
    return _survey([*inside, *(e for e, _ in part.stores)])


def _labels(program: Program) -> dict[str, list[str]]:
    """The names of the components of every argument in the specification."""
    prepared = program.prepare.results if program.prepare else ()
    return {
        "time": ["t"],
        "state": [v.name for v in program.coordinates + program.speeds],
        "accelerations": [f"{v.name}'" for v in program.speeds],
        "inputs": [v.name for v in program.inputs],
        "parameters": [v.name for v in program.parameters],
        "constants": [f"c{i}" for i in range(len(prepared))],
    }


def _names(
    function: Function, found: _Survey, program: Program, dialect: Dialect
) -> dict[Expression, str]:
    """The variable of everything that a function reads or computes."""
    given = _labels(program)
    arrays = _arrays(function)
    values = list(dict.fromkeys([*found.values, *arrays]))
    labels = [given[r.argument][r.index] for r in found.reads] + values
    codes = escaped(labels, dialect.reserved | _own_names(program, function))
    read: list[Expression] = [*found.reads, *map(Value, values)]
    names = dict(zip(read, codes, strict=True)) | {Read("time", 0): "t"}
    for array, lanes in arrays.items():
        code = names[Value(array)]
        names[Value(array)] = f"{code}[{LANE}]"
        names |= {Value(in_lane(array, k)): f"{code}[{k}]" for k in range(lanes)}
    return names


def _arrays(function: Function) -> dict[str, int]:
    """The values that have one entry for each lane, and how many."""
    loops = [s for s in function.statements if isinstance(s, Alike)]
    return {n: s.lanes for s in loops for n in (*(name for name, _ in s.given), *s.kept)}


def _own_names(program: Program, function: Function) -> frozenset[str]:
    """Names that our templates give to types, solvers and their arrays."""
    own = {f"{prefix(program.name)}_{kind}" for kind in ("real", "params", "model", "status")}
    for statement in function.statements:
        if isinstance(statement, Solve):
            place = statement.names[0]
            own |= {f"matrix_of_{place}", f"solution_of_{place}", f"solve_{statement.size}"}
    return frozenset(own)


def _checks_pivots(function: Function) -> bool:
    return any(isinstance(s, RequirePositive | Solve) for s in function.statements)


@dataclass(frozen=True)
class _Text:
    """How a function is spelled: the names of its values and the labels of its arguments."""

    dialect: Dialect
    names: Names
    labels: dict[str, list[str]]

    def of(self, tree: Expression) -> str:
        """An expression."""
        return expression(tree, self.dialect, self.names)

    def body(self, part: Part, found: _Survey) -> Body:
        """The statements of a function, or of a part of one, which read what was found."""
        arguments = tuple(
            Argument(self.names[r], r.argument, r.index, self.labels[r.argument][r.index])
            for r in found.reads
        )
        loads = tuple(Argument(self.names[v], WORK, slot, v.name) for v, slot in part.loads)
        return Body(
            arguments + loads,
            tuple(self.steps(part.statements)),
            tuple((place, self.of(e)) for e, place in part.stores),
            (*found.used, WORK),
        )

    def lanes(self, part: Part) -> Lanes:
        """The statements for many states, without the waves of arguments, which come first."""
        found: dict[Read, dict[str, str]] = {}
        rest: list[Statement] = []
        for statement in part.statements:
            match statement:
                case Assign(name, Apply("sin" | "cos" as wave, (Read() as angle,))) if (
                    angle.argument in ROWS and wave not in found.get(angle, {})
                ):
                    found.setdefault(angle, {})[wave] = name
                case _:
                    rest.append(statement)
        waves, read, slot = [], [], 0
        for angle, names in found.items():
            kind = "pair" if len(names) == 2 else WAVE_KINDS[next(iter(names))]
            waves.append(Wave(kind, angle.argument, angle.index, slot))
            for name in (names[w] for w in WAVE_KINDS if w in names):
                read.append(Argument(self.names[Value(name)], WAVES, slot, name))
                slot += 1
        left = replace(part, statements=tuple(rest))
        body = self.body(left, _survey_of(left))
        return Lanes(tuple(waves), replace(body, arguments=body.arguments + tuple(read)))

    def steps(self, statements: Sequence[Statement]) -> Iterator[Step]:
        """The statements in order; a sine and its cosine are one step where the dialect likes."""
        waiting: Statement | None = None
        for statement in statements:
            pair = _pair(waiting, statement) if self.dialect.pairs else None
            if pair is not None:
                sine, cosine, angle = pair
                yield Step("pair", self.names[sine], self.of(angle), self.names[cosine])
                waiting = None
                continue
            if waiting is not None:
                yield self.step(waiting)
            waiting = statement
        if waiting is not None:
            yield self.step(waiting)

    def bare(self, array: Value) -> str:
        """An array without the lane."""
        return self.names[array].removesuffix(f"[{LANE}]")

    def array(self, name: Value, entries: Sequence[Expression]) -> Given:
        """What a loop over lanes reads."""
        fixed = all(isinstance(e, Number) for e in entries)
        return Given(self.bare(name), tuple(map(self.of, entries)), fixed)

    def kept(self, statement: Assign, kept: Sequence[str]) -> Step:
        """An assignment in a loop over lanes."""
        kind = "keep" if statement.name in kept else "assign"
        return Step(kind, self.names[Value(statement.name)], self.of(statement.expression))

    def step(self, statement: Statement) -> Step:
        """One statement."""
        match statement:
            case Assign(name, Apply("sin" | "cos" as wave, (angle,))) if self.dialect.pairs:
                return Step(WAVE_KINDS[wave], self.names[Value(name)], self.of(angle))
            case Assign(name, tree):
                return Step("assign", self.names[Value(name)], self.of(tree))
            case RequirePositive(value, scale):
                return Step("require", self.names[value], scale=self.of(scale))
            case Alike(lanes, given, statements, kept):
                return Step(
                    "alike",
                    size=lanes,
                    given=tuple(self.array(Value(name), entries) for name, entries in given),
                    steps=tuple(self.kept(s, kept) for s in statements),
                    kept=tuple(self.bare(Value(name)) for name in kept),
                )
            case Solve(unknowns, matrix, right):
                places = [(Value(name), i) for i, name in enumerate(unknowns)]
                return Step(
                    "solve",
                    name=unknowns[0],
                    values=tuple((self.names[v], i) for v, i in places if v in self.names),
                    matrix=tuple(map(self.of, matrix)),
                    right=tuple(map(self.of, right)),
                    size=statement.size,
                )


def _pair(first: Statement | None, second: Statement) -> tuple[Value, Value, Expression] | None:
    """Sine, cosine and their angle, where two statements compute these."""
    match first, second:
        case Assign(a, Apply("sin", (x,))), Assign(b, Apply("cos", (y,))) if x == y:
            return Value(a), Value(b), x
        case Assign(a, Apply("cos", (x,))), Assign(b, Apply("sin", (y,))) if x == y:
            return Value(b), Value(a), x
    return None


def _counted(function: Function) -> str:
    """Operations in the order of `OPERATORS`; a system that a loop solves is named by its size."""
    counts: dict[str, int] = {}
    applied = operations(function)
    for operator in OPERATORS:
        if applied[operator] and operator != "pi":
            sign = COUNTED.get(operator, operator)
            counts[sign] = counts.get(sign, 0) + applied[operator]
    parts = [f"{n} {sign}" for sign, n in counts.items()]
    loops = [s for s in function.statements if isinstance(s, Solve)]
    return ", ".join(parts + [_loop(s) for s in loops]) or "none"


def _loop(solve: Solve) -> str:
    """A system in words."""
    columns = len(solve.right) // solve.size
    many = f" for {columns} right sides" if columns > 1 else ""
    return f"L D L' of {solve.size} x {solve.size}{many}"
