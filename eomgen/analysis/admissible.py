"""Admissible states: positions that satisfy the holonomic rows, rates that satisfy all rows.

phi(q, t) = 0,   J u = -b(q, t).   What the author calls known stays where the rest can follow.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from eomgen.analysis import linkage as linkages
from eomgen.analysis import newton
from eomgen.analysis.linkage import PRECISE, Linkage, State
from eomgen.analysis.neighbourhood import periodic, principal, reach, same, starts
from eomgen.analysis.problems import position_problem, rate_problem
from eomgen.compile import Machine
from eomgen.errors import UsageError

MOVED = PRECISE.number(10) ** -12  # less is not worth a word
CONTRADICTS = 1e-4  # a row is named when its residual is no less than this share of the largest

DEPENDENT = 1e-9  # of the largest singular value: columns depend on each other
BESIDE = 1e-2  # how far from a solution a search starts to see whether it is alone
RETURNED = 0.3  # of that distance

TRIES = 20
NARROW = 0.2
FASTEST = 2.0  # rates before they are made admissible
LATEST = 3.0  # s
Box = tuple[float, float, bool]  # low, high, and whether the author declared it


@dataclass(frozen=True)
class Move:
    """How far one coordinate or rate was moved; `known` where the author had given its value."""

    name: str
    start: Any
    found: Any
    known: bool

    @property
    def distance(self) -> Any:
        """|found - start|."""
        return abs(self.found - self.start)


@dataclass(frozen=True)
class Admissible:
    """An admissible state in 50 digits, how it was reached, and what else fits the known values."""

    state: State
    moves: tuple[Move, ...] = ()  # coordinates, then rates, of those that moved
    others: tuple[tuple[Any, ...], ...] = ()  # coordinates in other assembly modes
    stand_ins: tuple[str, ...] = ()  # parameters without a value, for which a number stands in

    @property
    def distance(self) -> Any:
        """The largest distance that a known value was moved."""
        return max((m.distance for m in self.moves if m.known), default=PRECISE.number(0))


def positions(
    machine: Machine,
    guess: Mapping[str, Any] | None = None,
    given: Mapping[str, Any] | None = None,
    time: Any = 0,
) -> Admissible:
    """The admissible state nearest to the given one; by default the spec's own at t = 0.

    given: known values by name, `q` or `q'`; guess: where the search for the others starts, from
    zero where it says nothing. Known values move only where the rows cannot hold otherwise.

    Raises:
        UsageError: there is no admissible state.
    """
    linkage = linkages.of(machine)
    model = linkage.model
    parameters, stand_ins = linkages.free_parameters(linkage)
    known = dict(model.initial if given is None else given)
    starts = {**(model.guess if guess is None else guess), **known}
    state = _started(linkage, starts, time, parameters)
    names = [c.name for c in model.coordinates]
    rates = [c.rate.name for c in model.coordinates]
    placed = _placed(linkage, state, [i for i, n in enumerate(names) if n not in known])
    moving = _moving(linkage, placed, [i for i, n in enumerate(rates) if n not in known])
    moves = [
        *_moves(names, state.coordinates, moving.coordinates, known),
        *_moves(rates, state.rates, moving.rates, known),
    ]
    if known:
        _refuse_penetration(linkage, moving)
    free = [i for i, n in enumerate(names) if n not in known]
    return Admissible(moving, tuple(moves), _others(linkage, moving, free), stand_ins)


def _started(
    linkage: Linkage, starts: Mapping[str, Any], time: Any, parameters: tuple[Any, ...]
) -> State:
    """Where a search starts: zero where nothing is said."""
    values = {n: linkages.constant(linkage, v, parameters) for n, v in starts.items()}
    zero, coordinates = PRECISE.number(0), linkage.model.coordinates
    return State(
        linkages.constant(linkage, time, parameters),
        tuple(values.get(c.name, zero) for c in coordinates),
        tuple(values.get(c.rate.name, zero) for c in coordinates),
        parameters,
    )


def _refuse_penetration(linkage: Linkage, state: State) -> None:
    """A gap below zero is not admissible, and no search can say how far to open it."""
    for name, gap in negative_gaps(linkage, state):
        raise UsageError(
            f"the initial state violates the unilateral constraint {name}: its gap is "
            f"{float(gap):.6g}, below zero; give `initial` values with a gap of zero or more"
        )


def negative_gaps(linkage: Linkage, state: State) -> list[tuple[str, Any]]:
    """Name and gap of the unilateral constraints that are violated."""
    gaps = linkages.values(linkage, [gap for _, gap in linkage.gaps], state, PRECISE)
    pairs = zip((name for name, _ in linkage.gaps), gaps, strict=True)
    return [(name, gap) for name, gap in pairs if gap < -MOVED]


def describe(machine: Machine, found: Admissible) -> tuple[str, ...]:
    """Sentences on how far the state was moved and what else fits the known values."""
    names = [c.name for c in machine.model.coordinates]
    lines = []
    for known, words in ((True, "known values moved"), (False, "dependent values found")):
        moved = [
            f"{m.name} {_short(m.start)} -> {_short(m.found)}"
            for m in found.moves
            if m.known == known
        ]
        if moved:
            lines.append(f"{words}: {', '.join(moved)}")
    for other in found.others:
        where = ", ".join(f"{n} = {_short(v)}" for n, v in zip(names, other, strict=True))
        lines.append(f"another assembly mode: {where}")
    if found.stand_ins:
        lines.append(f"parameters without a value stand in at random: {', '.join(found.stand_ins)}")
    return tuple(lines)


def _short(value: Any) -> str:
    return f"{0 if abs(value) < MOVED else float(value):.6g}"


def _moves(
    names: Sequence[str], before: Sequence[Any], after: Sequence[Any], known: Mapping[str, Any]
) -> list[Move]:
    pairs = zip(names, before, after, strict=True)
    moves = [Move(name, old, new, name in known) for name, old, new in pairs]
    return [m for m in moves if m.distance > MOVED]


def _placed(linkage: Linkage, state: State, free: Sequence[int]) -> State:
    """The state with coordinates that satisfy the holonomic rows.

    Raises:
        UsageError: no coordinates do.
    """
    problem = position_problem(linkage, state)
    everything = range(len(state.coordinates))
    outcomes = []
    for movable in (free, everything):
        for start in starts(linkage, state, movable):
            outcome = newton.close(problem, start, movable)
            if outcome.closed:
                return replace(state, coordinates=outcome.values)
            outcomes.append(outcome)
    raise UsageError(_contradiction(linkage, outcomes, [r.name for r in linkage.holonomic]))


def _moving(linkage: Linkage, state: State, free: Sequence[int]) -> State:
    """The state with rates that satisfy all rows; the system is linear.

    Raises:
        UsageError: no rates do.
    """
    problem = rate_problem(linkage, state)
    outcomes = []
    for movable in (free, range(len(state.rates))):
        outcome = newton.close(problem, state.rates, movable)
        if outcome.closed:
            return replace(state, rates=outcome.values)
        outcomes.append(outcome)
    raise UsageError(_contradiction(linkage, outcomes, [r.name for r in linkage.rows]))


def _contradiction(
    linkage: Linkage, outcomes: Sequence[newton.Outcome], names: Sequence[str]
) -> str:
    """The rows that cannot hold together: those that keep a residual at the best point found."""
    reached = [o for o in outcomes if o.residuals]
    if not reached:
        return (
            f"constraints {', '.join(names)} are not defined at the initial state; "
            "give `initial` or `guess` where their roots and quotients are"
        )
    best = min(reached, key=lambda o: sum(r * r for r in o.residuals))
    sizes = {n: abs(r) for n, r in zip(names, best.residuals, strict=True)}
    largest = max(sizes.values())
    kept = [n for n, r in sizes.items() if r >= largest * CONTRADICTS]
    listed = ", ".join(f"{n} (residual {float(sizes[n]):.3g})" for n in kept)
    others = ", ".join(_beside(linkage, kept[0], names)) if len(kept) == 1 else ""
    return (
        f"no admissible state was found: {listed} cannot be satisfied together"
        f"{' with ' * bool(others)}{others}; "
        "mend the constraints, or give `initial` and `guess` nearer to a state that satisfies them"
    )


def _beside(linkage: Linkage, name: str, names: Sequence[str]) -> list[str]:
    """Other rows that hold a coordinate of this one."""
    held = {
        r.name: {j for j, entry in enumerate(r.jacobian) if entry is not linkage.zero}
        for r in linkage.rows
    }
    return [n for n in names if n != name and held[n] & held[name]]


def _others(linkage: Linkage, state: State, free: Sequence[int]) -> tuple[tuple[Any, ...], ...]:
    """Other positions with the same known coordinates, where these leave isolated ones."""
    if not linkage.holonomic or not free or not _is_isolated(linkage, state, free):
        return ()
    problem = position_problem(linkage, state)
    angles = periodic(linkage, state)
    found = [state.coordinates]
    for start in starts(linkage, state, free)[1:]:
        outcome = newton.close(problem, start, free)
        if not outcome.closed or any(same(outcome.values, f, angles) for f in found):
            continue
        # one of a continuum says nothing
        if _is_isolated(linkage, replace(state, coordinates=outcome.values), free):
            found.append(outcome.values)
    return tuple(tuple(principal(v, angles)) for v in found[1:])


def _is_isolated(linkage: Linkage, state: State, free: Sequence[int]) -> bool:
    """Whether the rows determine the free coordinates, with the others as they are.

    Where their columns depend on each other at this state it may be a double solution, as at a dead
    point, or one of a continuum: a search from beside it comes back, or stays beside it.
    """
    rows = [r.jacobian for r in linkage.holonomic]
    slope = linkages.matrix(linkage, rows, state, PRECISE)
    columns = np.array([[float(row[i]) for i in free] for row in slope])
    _, sizes, directions = np.linalg.svd(columns)
    rank = int(np.sum(sizes > DEPENDENT * sizes[0])) if sizes[0] > 0 else 0
    loose = [side * d for d in directions[rank:] for side in (BESIDE, -BESIDE)]
    problem = position_problem(linkage, state)
    return all(_comes_back(problem, state, free, moved) for moved in loose)


def _comes_back(
    problem: newton.Problem, state: State, free: Sequence[int], moved: Sequence[float]
) -> bool:
    """Whether a search that starts beside a solution finds nothing but that solution."""
    start = list(state.coordinates)
    for i, step in zip(free, moved, strict=True):
        start[i] = start[i] + PRECISE.number(float(step))
    outcome = newton.close(problem, start, free)
    gone = max(abs(v - w) for v, w in zip(outcome.values, state.coordinates, strict=True))
    return not outcome.closed or gone < RETURNED * BESIDE


def draw(
    machine: Machine, count: int = 5, seed: int = 1, first: Admissible | None = None
) -> tuple[Admissible, ...]:
    """Random admissible states: inside `range` where it is declared, else around the initial one.

    first: the initial state, where it was found before.

    Raises:
        UsageError: there is no admissible state, or none was found inside `range`.
    """
    first = positions(machine) if first is None else first
    linkage = linkages.of(machine)
    chance = random.Random(f"{seed} {linkage.model.name}")
    boxes = boxes_of(linkage, first.state)
    drawn: list[Admissible] = []
    for attempt in range(TRIES * count):
        if len(drawn) == count:
            break
        # the search narrows where wide states do not close
        share = 1.0 if attempt < TRIES * count // 2 else NARROW
        state = _random(linkage, first.state, boxes, chance, share)
        if state is not None:
            drawn.append(Admissible(state, stand_ins=first.stand_ins))
    if len(drawn) < count:
        raise UsageError(
            f"only {len(drawn)} of {count} random admissible states were found inside `range`; "
            "widen it, or give `initial` values inside it"
        )
    return tuple(drawn)


def boxes_of(linkage: Linkage, state: State) -> list[Box]:
    """Where each coordinate is drawn: its range, else around the initial state."""
    boxes: list[Box] = []
    spread = reach(linkage, state)
    for c, value, size in zip(linkage.model.coordinates, state.coordinates, spread, strict=True):
        if c.name in linkage.model.range:
            low, high = linkage.model.range[c.name]
            ends = [linkages.constant(linkage, v, state.parameters) for v in (low, high)]
            boxes.append((float(ends[0]), float(ends[1]), True))
        else:
            boxes.append((float(value) - size, float(value) + size, False))
    return boxes


def _random(
    linkage: Linkage, middle: State, boxes: Sequence[Box], chance: random.Random, share: float
) -> State | None:
    """A random admissible state; None where the search ends elsewhere."""
    start = []
    for (low, high, _), value in zip(boxes, middle.coordinates, strict=True):
        near = chance.uniform(low, high)
        start.append(PRECISE.number(near * share + float(value) * (1 - share)))
    rates = tuple(PRECISE.number(chance.uniform(-FASTEST, FASTEST)) for _ in start)
    state = replace(middle, time=PRECISE.number(chance.uniform(0.0, LATEST)), rates=rates)
    outcome = newton.close(position_problem(linkage, state), start, range(len(start)))
    if not outcome.closed or not _is_inside(outcome.values, boxes):
        return None
    state = replace(state, coordinates=outcome.values)
    outcome = newton.close(rate_problem(linkage, state), rates, range(len(rates)))
    if not outcome.closed or negative_gaps(linkage, state):
        return None
    return replace(state, rates=outcome.values)


def _is_inside(values: Sequence[Any], boxes: Sequence[Box]) -> bool:
    pairs = zip(values, boxes, strict=True)
    return all(not declared or low <= v <= high for v, (low, high, declared) in pairs)
