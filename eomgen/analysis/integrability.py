"""Whether rate constraints can be integrated, decided; and what they say between positions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import sympy as sp

from eomgen.algebra.closed import ClosedForm
from eomgen.algebra.normal import Form, TooLarge, total
from eomgen.analysis import admissible, antiderivative, brackets, elimination, rank
from eomgen.analysis import linkage as linkages
from eomgen.analysis.admissible import Admissible
from eomgen.analysis.brackets import Covectors
from eomgen.analysis.linkage import PRECISE, Linkage, State
from eomgen.analysis.virtual import closed_rows
from eomgen.compile import Machine
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.vectors import dot
from eomgen.model import TIME, Model

STATES = 3
LARGEST_DENOMINATOR = 1000
RATIONAL = PRECISE.number(10) ** -20


@dataclass(frozen=True)
class Hidden:
    """A relation phi = constant behind rates: d phi/dt = factor * sum of share * row.

    constants: coordinates that no admissible motion changes; phi takes them as constants.
    """

    shares: tuple[tuple[str, Fraction], ...]  # row -> share
    factor: Form
    relation: Form  # phi
    constants: tuple[str, ...] = ()


@dataclass(frozen=True)
class Verdict:
    """What was decided of one nonholonomic row."""

    row: str
    growth: tuple[int, ...]  # of the row alone, beside the holonomic rows
    is_integrable_alone: bool
    is_integrable: bool  # beside all other rows
    hidden: Hidden | None  # None where it cannot be integrated, or no closed form was found


@dataclass(frozen=True)
class Integrability:
    """What was decided of all rate constraints together."""

    growth: tuple[int, ...]
    with_time: bool  # the time counts as one coordinate
    hidden: int  # the number of relations between positions that the rate constraints imply
    verdicts: tuple[Verdict, ...]
    combinations: tuple[Hidden, ...]  # of rows without a closed form of their own

    def verdict(self, row: str) -> Verdict:
        """What was decided of a row."""
        return next(v for v in self.verdicts if v.row == row)


@dataclass(frozen=True)
class Study:
    """What a decision needs."""

    linkage: Linkage
    covectors: Covectors
    kept: tuple[int, ...]
    states: tuple[State, ...]

    @property
    def holonomic(self) -> tuple[int, ...]:
        """The kept rows between positions."""
        return tuple(i for i in self.kept if self.linkage.rows[i].is_holonomic)

    @property
    def rates(self) -> tuple[int, ...]:
        """All rate rows, kept or not."""
        rows = self.linkage.rows
        return tuple(i for i in range(len(rows)) if not rows[i].is_holonomic)


def decide(machine: Machine, states: Sequence[Admissible] | None = None) -> Integrability:
    """Which rate constraints can be integrated, by the growth of brackets at admissible states.

    Raises:
        UsageError: there is no admissible state.
    """
    linkage = linkages.of(machine)
    drawn = admissible.draw(machine, STATES) if states is None else tuple(states)
    study = Study(
        linkage,
        brackets.covectors(linkage),
        rank.kept_rows(linkage, drawn),
        tuple(s.state for s in drawn[:STATES]),
    )
    if not study.rates:
        # relations between positions leave directions that close among themselves (Frobenius)
        left = len(study.covectors.symbols) - len(study.kept)
        return Integrability((left,), study.covectors.with_time, 0, (), ())
    together = brackets.growth(linkage, study.covectors, study.kept, study.states)
    verdicts = tuple(_verdict(study, i, together) for i in study.rates)
    return Integrability(
        growth=together.dimensions,
        with_time=together.with_time,
        hidden=len(study.covectors.symbols) - len(study.holonomic) - together.dimensions[-1],
        verdicts=verdicts,
        combinations=_combinations(study, together, verdicts),
    )


def _verdict(study: Study, i: int, together: brackets.Growth) -> Verdict:
    linkage, covector = study.linkage, study.covectors.rows[i]
    company = (*study.holonomic, *((i,) if i in study.kept else ()))
    alone = brackets.growth(linkage, study.covectors, company, study.states)
    is_alone = brackets.annihilates(linkage, covector, alone, study.states)
    is_integrable = is_alone or brackets.annihilates(linkage, covector, together, study.states)
    name = linkage.rows[i].name
    hidden = _hidden(study, ((name, Fraction(1)),), together) if is_integrable else None
    return Verdict(name, alone.dimensions, is_alone, is_integrable, hidden)


def _combinations(
    study: Study, together: brackets.Growth, verdicts: Sequence[Verdict]
) -> tuple[Hidden, ...]:
    """Sums with constant shares that can be integrated, of kept rows that were not."""
    left = {v.row for v in verdicts if v.hidden is None}
    rows = [i for i in study.kept if study.linkage.rows[i].name in left]
    if len(rows) < 2:
        return ()
    names = [study.linkage.rows[i].name for i in rows]
    found: list[Hidden] = []
    for shares in [*_exact_shares(study, rows), *_constant_shares(study, rows, together)]:
        parts = tuple((n, s) for n, s in zip(names, shares, strict=True) if s)
        hidden = _hidden(study, parts, together)
        if hidden is not None and all(hidden.shares != h.shares for h in found):
            found.append(hidden)
    return tuple(found)


def _exact_shares(study: Study, rows: Sequence[int]) -> list[list[Fraction]]:
    """Rational c with sum c_i d(row_i) = 0: the sum of the rows is an exact one-form."""
    along = study.linkage.kinematics.algebra.along
    symbols, one = study.covectors.symbols, study.linkage.zero + 1
    covectors = [study.covectors.rows[i] for i in rows]
    curls = [
        tuple(
            along(row[j], {symbols[k]: one}) - along(row[k], {symbols[j]: one})
            for j in range(len(symbols))
            for k in range(j)
        )
        for row in covectors
    ]
    equations: list[list[Any]] = []
    for matrix in brackets.numbers(study.linkage, curls, study.states):
        equations += [list(column) for column in zip(*matrix, strict=True)]
    return _null_shares(equations, len(rows))


def _constant_shares(
    study: Study, rows: Sequence[int], together: brackets.Growth
) -> list[list[Fraction]]:
    """Rational c with  sum c_i row_i . Z = 0  for every field Z reached, at every state."""
    covectors = [study.covectors.rows[i] for i in rows]
    equations: list[list[Any]] = []
    for matrix in brackets.numbers(study.linkage, [*covectors, *together.fields], study.states):
        values, fields = matrix[: len(rows)], matrix[len(rows) :]
        equations += [[dot(row, field) for row in values] for field in fields]
    return _null_shares(equations, len(rows))


def _null_shares(equations: Sequence[Sequence[Any]], size: int) -> list[list[Fraction]]:
    """The rational ones among the null vectors, one for each column without a pivot."""
    # equations that hold whatever the shares are made of round-off only
    chosen = [e for e in equations if max(abs(v) for v in e) > RATIONAL]
    chosen = [chosen[i] for i, _ in elimination.full(chosen).pivots]
    pivots = elimination.pivot_columns(chosen, range(size), 0) if chosen else ()
    free = [j for j in range(size) if j not in pivots]
    square = [[row[j] for j in pivots] for row in chosen]
    solved = elimination.solved(square, [[-row[j] for j in free] for row in chosen])
    result = []
    for k, own in enumerate(free):
        entries = {own: PRECISE.number(1)} | {j: solved[i][k] for i, j in enumerate(pivots)}
        shares = [_rational(entries.get(j, PRECISE.number(0))) for j in range(size)]
        if all(s is not None for s in shares):
            result.append([s for s in shares if s is not None])
    return result


def _rational(value: Any) -> Fraction | None:
    """The small fraction that a number of 50 digits is; None where it is none."""
    near = Fraction(float(value)).limit_denominator(LARGEST_DENOMINATOR)
    return near if abs(PRECISE.number(near) - value) < RATIONAL else None


def _hidden(
    study: Study, shares: tuple[tuple[str, Fraction], ...], together: brackets.Growth
) -> Hidden | None:
    """Phi with d phi/dt = factor * sum of share * row, where the closed form finds it."""
    fast = _frozen(study, together)
    for model in _spellings(study.linkage.model):
        try:
            algebra, rows = closed_rows(model)
            by_name = {row.name: row for row in rows}
            one_form = _one_form(algebra, model, [(by_name[n], s) for n, s in shares])
            found = antiderivative.integrated(algebra, one_form)
            if found is not None:
                return Hidden(shares, *found)
            slow = [(v, entry) for v, entry in one_form if v not in fast]
            found = antiderivative.integrated(algebra, slow) if fast else None
        except TooLarge:
            continue
        if found is not None:
            return Hidden(
                shares, *found, tuple(c.name for c in model.coordinates if c.symbol in fast)
            )
    return None


def _spellings(model: Model) -> list[Model]:
    """The model with prescribed motions as symbols, then with their formulas in time."""
    if not model.prescribed:
        return [model]
    formulas: dict[sp.Symbol, sp.Expr] = {}
    for known in model.prescribed:
        formula = known.formula.xreplace(formulas)
        speed = sp.diff(formula, TIME)
        formulas |= {known.symbol: formula, known.rate: speed}
        formulas[known.acceleration] = sp.diff(speed, TIME)
    explicit = tuple(
        replace(c, residuals=tuple(r.xreplace(formulas) for r in c.residuals))
        for c in model.constraints
    )
    return [model, replace(model, prescribed=(), constraints=explicit)]


def _one_form(
    algebra: ClosedForm, model: Model, parts: Sequence[tuple[Row[Form], Fraction]]
) -> list[tuple[sp.Symbol, Form]]:
    """The rates' sum as a one-form in coordinates, prescribed motions and time."""
    rate = total(algebra.ring, [row.rate * share for row, share in parts])
    moving = [(c.symbol, c.rate) for c in model.coordinates]
    moving += [(p.symbol, p.rate) for p in model.prescribed]
    one = algebra.number(1)
    entries = [(symbol, algebra.along(rate, {velocity: one})) for symbol, velocity in moving]
    pairs = zip(entries, moving, strict=True)
    spent = [entry * algebra.of(velocity) for (_, entry), (_, velocity) in pairs]
    return [*entries, (TIME, rate - total(algebra.ring, spent))]


def _frozen(study: Study, together: brackets.Growth) -> set[sp.Symbol]:
    """Coordinates that no admissible motion changes: they count as constants."""
    symbols = study.covectors.symbols
    matrices = brackets.numbers(study.linkage, together.fields, study.states)
    return {
        s
        for j, s in enumerate(symbols)
        if together.fields and all(abs(row[j]) < RATIONAL for m in matrices for row in m)
    }
