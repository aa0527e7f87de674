"""Functions of a program as text: arguments, steps and results, for a template to lay out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from eomgen.algebra.unroll import unrolled
from eomgen.program import (
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
)
from eomgen.render.code import Names, expression
from eomgen.render.dialects import Dialect
from eomgen.render.grouped import apart
from eomgen.render.lanes import (
    Load,
    Store,
    in_place,
    longest_body,
    runs,
    waves,
    without,
)
from eomgen.render.lowered import Lowered, content, lowered, operations, surveyed
from eomgen.render.naming import LANE, Components, Survey, names_of, own_names, survey
from eomgen.render.pairs import WAVE_KINDS, groups, pair
from eomgen.render.parts import Part, divided, whole
from eomgen.render.records import (
    WORK,
    Argument,
    Body,
    Given,
    Lanes,
    Loop,
    Pair,
    Requirement,
    Routine,
    Step,
    System,
)
from eomgen.render.sparing import sparing

COUNTED = {"add": "+", "subtract": "-", "negate": "-", "multiply": "*", "divide": "/"}
IN_MODEL = {"parameters": "m->p.{}", "constants": "m->{}"}  # how parts of functions read it


def routine(function: Function, program: Program, dialect: Dialect, given: Components) -> Routine:
    """A function of the program as text, every argument that it reads in a variable of its own."""
    plain = lowered(function if dialect.loops else unrolled(function))
    short, direct = apart(plain.function, given.groups)
    found = surveyed(short) if direct else plain
    everything = whole(found)
    read = survey(everything.content)
    if direct and "constants" not in read.used:
        read = replace(read, used=(*read.used, "constants"))
    names = names_of(short, read, given, dialect.reserved | own_names(program, short))
    names |= {name: f"m->c{first}[{LANE}]" for name, first in direct.items()}
    text = _Text(dialect, names, given)
    at_once = function is program.prepare
    longest = min(dialect.longest, dialect.once) if at_once else dialect.longest
    cut = divided(found, longest, at_once)
    is_long = cut is not None or len(short.statements) > dialect.repeated
    base = _base(function, program) if is_long else None
    return Routine(
        function.name,
        function.about,
        function.shape,
        _lead(text, function, base, read) if cut or base else text.body(everything, read),
        () if cut is None or base else tuple(text.parts(cut.parts)),
        text.lanes(found) if dialect.lanes else None,
        0 if cut is None else cut.slots,
        len(function.results),
        frozenset(everything.content.operators),
        _counted(plain.function, Counter(everything.content.operators)),
        function.arguments,
        read.used,
        _checks_pivots(function),
        "" if base is None else base.name,
    )


def _base(function: Function, program: Program) -> Function | None:
    """An earlier function of the same statements whose results come last, behind arguments."""
    for other in program.functions:
        if other.name == function.name:
            return None
        ahead = _ahead(function, other)
        if (
            other.arguments == function.arguments
            and other.results == function.results[ahead:]
            and all(isinstance(e, Read) for e in function.results[:ahead])
            and other.statements == function.statements
        ):
            return other
    return None


def _ahead(function: Function, base: Function | None) -> int:
    """How many results stand before those of the base."""
    return 0 if base is None else max(0, len(function.results) - len(base.results))


def _lead(text: _Text, function: Function, base: Function | None, read: Survey) -> Body:
    """What stands beside the parts: the results before those of the base."""
    ahead = function.results[: _ahead(function, base)]
    results = tuple((e, i) for i, e in enumerate(ahead))
    part = Part((), (), (), results, content(ahead))
    return replace(text.body(part, survey(part.content)), uses=read.used)


def _checks_pivots(function: Function) -> bool:
    return any(isinstance(s, RequirePositive | Solve) for s in function.statements)


@dataclass(frozen=True)
class _Text:
    """How a function is spelled: the names of its values and the labels of its arguments."""

    dialect: Dialect
    names: Names
    given: Components

    def of(self, tree: Expression) -> str:
        """An expression."""
        return expression(tree, self.dialect, self.names)

    def argument(self, read: Read) -> Argument:
        """The variable of a component."""
        source, index = read.argument, read.index
        label, member = self.given.labels[source][index], self.given.members[source][index]
        return Argument(self.names[read], source, index, label, member)

    def body(self, part: Part, found: Survey) -> Body:
        """The statements of a function, or of a part of one, which read what was found."""
        return Body(
            tuple(map(self.argument, found.reads)),
            tuple(self.steps(part.statements)),
            tuple((slot, self.of(e)) for e, slot in part.stores),
            tuple((place, self.of(e)) for e, place in part.results),
            (*found.used, *([WORK] if part.loads or part.stores else [])),
        )

    def lanes(self, found: Lowered) -> Lanes:
        """The statements for many states."""
        first = waves(found)
        names: dict[Expression | str, str] = dict(self.names)
        for wave in first:
            names.update((read, names[name]) for name, read in wave.reads.items())
        text = replace(self, names=names)
        rest = sparing(without(found, first))
        cut = divided(rest, longest_body(rest, self.dialect.longest), in_place=True)
        parts = (whole(rest),) if cut is None else cut.parts
        return Lanes(
            first,
            tuple(map(text.lane_body, parts)),
            len(rest.function.results) if cut is None else cut.slots,
            runs(rest.content.reads),
        )

    def lane_body(self, part: Part) -> Body:
        """The statements of a part for one lane, with all that it reads and writes in place."""
        places = {name: f"{WORK}[{slot}][{LANE}]" for name, slot in part.loads}
        used: dict[str, None] = {}
        steps = []
        for event in in_place(part):
            match event:
                case Load(Read() as read):
                    used[read.argument] = None
                    if read.argument != "time":
                        steps.append(Step("assign", self.names[read], self.row(read)))
                case Load(str() as name):
                    steps.append(Step("assign", self.names[name], places[name]))
                case Store(tree, place):
                    steps.append(Step("store", str(place), self.of(tree)))
                case tuple():
                    steps.extend(self.steps(event))
        return Body((), tuple(steps), (), (), tuple(used), part.elimination)

    def row(self, read: Read) -> str:
        """Where the lane of an argument stands."""
        if read.argument in IN_MODEL:
            return IN_MODEL[read.argument].format(self.given.members[read.argument][read.index])
        return f"{read.argument}[{read.index}][{LANE}]"

    def parts(self, parts: Iterable[Part]) -> Iterator[Body]:
        """The statements of parts, which read the model and `WORK` where they need them."""
        names, members = dict(self.names), self.given.members
        for part in parts:
            found = survey(part.content)
            placed: dict[Expression | str, str] = {
                r: IN_MODEL[r.argument].format(members[r.argument][r.index])
                for r in found.reads
                if r.argument in IN_MODEL
            }
            placed |= {name: f"{WORK}[{slot}]" for name, slot in part.loads}
            names.update(placed)
            own = tuple(r for r in found.reads if r not in placed)
            yield replace(self, names=names).body(part, replace(found, reads=own))
            names.update((name, self.names[name]) for name in placed)

    def steps(self, statements: Sequence[Statement]) -> Iterator[Step]:
        """The statements in order; a sine and its cosine are one step where the dialect likes."""
        for group in groups(statements) if self.dialect.pairs else ((s,) for s in statements):
            both = pair(*group) if len(group) == 2 else None
            if both is None:
                yield from map(self.step, group)
            else:
                sine, cosine, angle = both
                yield Pair("pair", self.names[sine], self.of(angle), self.names[cosine])

    def bare(self, array: str) -> str:
        """An array without the lane."""
        return self.names[array].removesuffix(f"[{LANE}]")

    def array(self, name: str, entries: Sequence[Expression]) -> Given:
        """What a loop over lanes reads."""
        fixed = all(isinstance(e, Number) for e in entries)
        return Given(self.bare(name), tuple(map(self.of, entries)), fixed)

    def kept(self, statement: Assign, kept: Sequence[str]) -> Step:
        """An assignment in a loop over lanes."""
        kind = "keep" if statement.name in kept else "assign"
        return Step(kind, self.names[statement.name], self.of(statement.expression))

    def step(self, statement: Statement) -> Step:
        """One statement."""
        match statement:
            case Assign(name, tree):
                return self.assigned(self.names[name], tree)
            case RequirePositive(value, scale):
                return Requirement("require", self.names[value.name], scale=self.of(scale))
            case Alike(lanes, given, statements, kept):
                return Loop(
                    "alike",
                    size=lanes,
                    given=tuple(self.array(name, entries) for name, entries in given),
                    steps=tuple(self.kept(s, kept) for s in statements),
                    kept=tuple(self.bare(name) for name in kept),
                )
            case Solve(unknowns, matrix, right):
                return System(
                    "solve",
                    name=unknowns[0],
                    values=self.solution(unknowns),
                    matrix=tuple(map(self.of, matrix)),
                    right=tuple(map(self.of, right)),
                    size=statement.size,
                )

    def assigned(self, code: str, tree: Expression) -> Step:
        """The variable `code` of an expression."""
        if self.dialect.pairs and isinstance(tree, Apply) and tree.operator in WAVE_KINDS:
            return Step(WAVE_KINDS[tree.operator], code, self.of(tree.operands[0]))
        return Step("assign", code, self.of(tree))

    def solution(self, unknowns: Sequence[str]) -> tuple[tuple[str, int], ...]:
        """The names of what is read of a solution, and where it stands."""
        return tuple((self.names[x], i) for i, x in enumerate(unknowns) if x in self.names)


def _counted(function: Function, applied: Counter[str]) -> str:
    """Operations in the order of `OPERATORS`; a system that a loop solves is named by its size."""
    counts: dict[str, int] = {}
    flat = unrolled(function)
    applied = applied if flat is function else operations(flat)
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
