"""Roots of the equilibrium equations, by the first method that applies.

Exact elimination where they are polynomials, interval arithmetic where there is one unknown, else
Newton's method from many starts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp

from eomgen.algebra.normal import Form
from eomgen.analysis import equilibrium_elimination as elimination
from eomgen.analysis import equilibrium_interval as interval
from eomgen.analysis import equilibrium_polish as polish
from eomgen.analysis import equilibrium_polynomials as polynomials
from eomgen.analysis.equilibrium_given import REACH, Region
from eomgen.analysis.equilibrium_polish import Root
from eomgen.analysis.equilibrium_scene import Scene
from eomgen.analysis.equilibrium_search import Box, Hit, Search, search
from eomgen.errors import CheckError
from eomgen.model import Model

LARGEST_SYSTEM = 64  # product of degrees up to which elimination is tried
MOST_EQUATIONS = 12  # of that system
FAMILY = 8  # more singular roots than this are members of a family
SHOWN_OF_FAMILY = 3
SAME = 1e-18  # roots nearer than this share of the region are one
EDGE = 1e-20  # of a turn
ROUGH = 1e-6  # slack at the bounds before a root is polished


@dataclass(frozen=True)
class Problem:
    """Everything that a search for equilibria needs."""

    model: Model
    forms: tuple[Form, ...]  # balances and residuals, zero in equilibrium, without parameters
    held: frozenset[sp.Symbol]  # symbols that occur
    multipliers: tuple[sp.Symbol, ...]
    regions: tuple[Region, ...]
    scene: Scene
    constants: dict[sp.Symbol, sp.Expr]  # values of everything but coordinates

    @property
    def free(self) -> tuple[int, ...]:
        """The coordinates that anything depends on."""
        pairs = enumerate(self.model.coordinates)
        return tuple(k for k, c in pairs if c.symbol in self.held)

    @property
    def arbitrary(self) -> tuple[str, ...]:
        """The others, by name."""
        pairs = enumerate(self.model.coordinates)
        return tuple(c.name for k, c in pairs if k not in self.free)

    @property
    def box(self) -> Box:
        """The regions as arrays."""
        turn = 2 * np.pi
        return Box(
            np.array([r.low for r in self.regions]),
            np.array([r.high for r in self.regions]),
            np.array([turn if r.periodic else 0.0 for r in self.regions]),
        )


@dataclass(frozen=True)
class Found:
    """Roots, in the words of the method that found them."""

    roots: tuple[Root, ...]
    method: str
    complete: bool
    isolated: bool  # even a singular root stands alone
    arbitrary: tuple[str, ...]
    notes: tuple[str, ...] = ()


def find(problem: Problem) -> Found:
    """All roots inside the regions, as far as the method sees."""
    try:
        return _eliminated(problem)
    except polynomials.NotPolynomial as reason:
        return _proven(problem) or _searched(problem, f"no polynomials: {reason}")
    except elimination.NotFinite:
        return _searched(problem, "the equations have infinitely many complex solutions")
    except elimination.TooMany:
        return _searched(problem, "too many complex solutions for exact elimination")


def _eliminated(problem: Problem) -> Found:
    """By exact elimination."""
    unknowns = [problem.model.coordinates[k].symbol for k in problem.free]
    system = polynomials.system(problem.forms, [*unknowns, *problem.multipliers])
    if len(system.polynomials) > MOST_EQUATIONS or polynomials.bezout(system) > LARGEST_SYSTEM:
        raise elimination.TooMany
    if not system.polynomials:
        return _anywhere(problem)
    solutions = elimination.solve(system.polynomials)
    if not system.is_exact and not solutions.real:
        return _searched(problem, "rounding irrational constants proves no absence of roots")
    points = _points(problem, system, solutions)
    roots = _kept(problem, points)
    return Found(
        roots=roots,
        method=_exactly(system, solutions.complex_count, len(points), len(points) - len(roots)),
        complete=system.is_exact or all(p.regular for p in points),
        isolated=not problem.arbitrary,
        arbitrary=problem.arbitrary,
    )


def _exactly(system: polynomials.System, every: int, real: int, outside: int) -> str:
    """What exact elimination has proven."""
    said = "exact elimination: "
    if not every:
        said += "the equations contradict each other, so there is no equilibrium"
    else:
        said += f"of {every} complex solutions {real} are equilibria"
    if outside:
        said += f", {outside} of these outside the range"
    if not system.is_exact:
        said += f"; irrational constants were rounded to {polynomials.ROUNDED_DIGITS} digits"
    return said


def _anywhere(problem: Problem) -> Found:
    """Nothing depends on any coordinate, and all forces vanish."""
    start = _start(problem)
    point = polish.checked(problem.scene, start, [0] * len(problem.multipliers), problem.free)
    assert point is not None
    method = "every position is an equilibrium"
    return Found((point,), method, True, False, problem.arbitrary)


def _start(problem: Problem) -> list[Any]:
    """Zero for every coordinate, or the middle of its region where zero is outside."""
    return [0.0 if r.low <= 0 <= r.high else (r.low + r.high) / 2 for r in problem.regions]


def _points(
    problem: Problem, system: polynomials.System, solutions: elimination.Solutions
) -> list[Root]:
    """Real solutions with the right sign of every root, each checked on the graph."""
    ctx = polish.context()
    points = []
    for values in solutions.real:
        if any(values[i] < -1e-30 for i in system.roots):
            continue  # the other sign of a square root
        q = [ctx.convert(v) for v in _start(problem)]
        for k in problem.free:
            q[k] = _value(system, problem.model.coordinates[k].symbol, values)
        loads = [_value(system, m, values) for m in problem.multipliers]
        point = polish.checked(problem.scene, q, loads, problem.free)
        if point is None and not system.is_exact:
            point = polish.root(problem.scene, q, loads, problem.free)
        if point is None and system.is_exact:
            raise CheckError(
                "a root of the closed form is none of the graph: the two derivations disagree"
            )
        if point is not None:
            points.append(_polished(problem, point))
    return points


def _polished(problem: Problem, point: Root) -> Root:
    """The same root in all digits where Newton's method adds some."""
    if not point.regular:
        return point
    return polish.root(problem.scene, point.coordinates, point.multipliers, problem.free) or point


def _value(system: polynomials.System, symbol: sp.Symbol, values: Sequence[Any]) -> Any:
    """A coordinate or multiplier from a solution."""
    ctx = polish.context()
    if symbol in system.angles:
        c, s = (ctx.convert(values[i]) for i in system.angles[symbol])
        return ctx.atan2(s, c)
    return ctx.convert(values[system.lengths[symbol]])


def _proven(problem: Problem) -> Found | None:
    """By interval arithmetic; None where that does not apply."""
    if len(problem.regions) != 1 or problem.multipliers:
        return None
    (region,) = problem.regions
    try:
        proof = interval.prove(problem.scene, region.low, region.high)
    except interval.NotProven:
        return None
    starts = [*proof.roots, *proof.unresolved]
    points = [polish.root(problem.scene, [x], [], problem.free) for x in starts]
    roots = _kept(problem, [p for p in points if p is not None])
    said = f"interval arithmetic: every root{_within(problem)} is among these"
    near = ", ".join(f"{x:.6g}" for x in proof.unresolved[:3])
    if near:
        said += f", but roots closer than {interval.NARROWEST:g} of the range are not told apart "
        said += f"near {near}"
    return Found(roots, said, not near, not near, ())


def _searched(problem: Problem, why: str) -> Found:
    """From many starts."""
    found = search(problem.scene, problem.box, problem.free, _given(problem))
    regular, singular = _sorted_hits(problem, found)
    # a degenerate root that stands alone is found again and again, a member of a family once
    family = len(singular) > FAMILY or sum(h.count == 1 for h in singular) > 1
    chosen = [*regular, *singular[: SHOWN_OF_FAMILY if family else None]]
    points = [
        polish.root(problem.scene, list(h.coordinates), list(h.multipliers), problem.free)
        for h in chosen
    ]
    notes = (f"the equilibria form a continuous family, {SHOWN_OF_FAMILY} members are shown",)
    return Found(
        roots=_kept(problem, [p for p in points if p is not None]),
        method=_words(problem, found, (regular, singular), why),
        complete=False,
        isolated=not family and not problem.arbitrary,
        arbitrary=problem.arbitrary,
        notes=notes if family else (),
    )


def _given(problem: Problem) -> list[float]:
    """The initial and guessed values, which close the loops; else the middle of the region."""
    model = problem.model
    known = {**model.guess, **model.initial}
    constants = problem.constants
    return [
        float(known[c.name].xreplace(constants)) if c.name in known else (r.low + r.high) / 2
        for c, r in zip(model.coordinates, problem.regions, strict=True)
    ]


def _sorted_hits(problem: Problem, found: Search) -> tuple[list[Hit], list[Hit]]:
    """(regular hits, singular hits) inside the regions, or so near that digits must tell."""
    groups: tuple[list[Hit], list[Hit]] = ([], [])
    ctx = polish.context()
    for hit in found.hits:
        q = [ctx.convert(float(v)) for v in hit.coordinates]
        loads = [ctx.convert(float(v)) for v in hit.multipliers]
        numbers = polish.numbers_at(problem.scene, q, loads)
        if numbers is not None and _inside(problem, q, ROUGH) is not None:
            regular = polish.is_regular(problem.scene, numbers, problem.free)
            groups[0 if regular else 1].append(hit)
    return groups


def _words(problem: Problem, found: Search, groups: tuple[list[Hit], list[Hit]], why: str) -> str:
    """How it was searched and what that is worth."""
    hits = groups[0] or groups[1]
    outside = len(found.hits) - len(groups[0]) - len(groups[1])
    beyond = f", {outside} were found outside the range" if outside else ""
    said = f"{why}; searched by Newton's method from {found.starts} starts{_within(problem)}; "
    if not hits:
        return said + f"no root was found{beyond}; roots may have been missed"
    rarest, last = min(h.count for h in hits), max(h.first for h in hits)
    times = "once" if rarest == 1 else f"{rarest} times"
    return said + (
        f"each root was found at least {times}, the {found.starts - last} starts after start "
        f"{last} found no new one, {found.failed} led to none{beyond}; roots may have been missed"
    )


def _within(problem: Problem) -> str:
    """The region of lengths that the spec does not bound."""
    wide = {r.high for r in problem.regions if not r.declared and not r.is_angle}
    return f" within {max(wide):.3g} ({REACH} times the size of the scene)" if wide else ""


def _kept(problem: Problem, points: Sequence[Root]) -> tuple[Root, ...]:
    """The points inside the regions, angles turned into them, equal ones once."""
    kept: list[Root] = []
    for point in points:
        q = _inside(problem, point.coordinates)
        if q is None or any(_same(problem, q, other.coordinates) for other in kept):
            continue
        kept.append(Root(q, point.multipliers, point.numbers, point.regular))
    return tuple(kept)


def _inside(problem: Problem, q: Sequence[Any], slack: float = 1e-15) -> tuple[Any, ...] | None:
    """The coordinates within their regions; None where one is outside."""
    found = []
    for region, value in zip(problem.regions, q, strict=True):
        turned = _turned(region, value) if region.periodic else value
        if not _contains(region, turned, slack):
            return None
        found.append(turned)
    return tuple(found)


def _turned(region: Region, value: Any) -> Any:
    """The angle by whole turns into (low, high], or the nearest to it."""
    ctx = polish.context()
    turn, high = 2 * ctx.pi, ctx.pi if not region.declared else ctx.mpf(region.high)
    slack = EDGE * turn
    return value - turn * ctx.ceil((value - high - slack) / turn)


def _contains(region: Region, value: Any, slack: float) -> bool:
    """Whether a value lies in the region; lengths that the spec does not bound lie anywhere."""
    if region.positive and not value > 0:
        return False
    if not region.declared and not region.is_angle:
        return True
    # the bounds are floats
    edge = slack * max(abs(region.low), abs(region.high))
    return bool(region.low - edge <= value <= region.high + edge)


def _same(problem: Problem, a: Sequence[Any], b: Sequence[Any]) -> bool:
    triples = zip(problem.regions, a, b, strict=True)
    return all(abs(x - y) <= SAME * (r.high - r.low) for r, x, y in triples)
