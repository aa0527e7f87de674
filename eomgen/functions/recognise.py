"""Numbers of 50 digits as exact formulas: rational, or polynomials in a few parameters."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations_with_replacement
from math import prod
from typing import Any

import mpmath
import sympy as sp

from eomgen.analysis.linkage import DIGITS, PRECISE

Relations = dict[int, dict[int, Any]]  # dependent column -> its multiples of columns that stay
Entries = dict[tuple[int, int], Any]
CLOSE = PRECISE.number(10) ** -30  # relative; relations are good to some 40 digits
LARGEST_DENOMINATOR = 10**12
LARGEST_FACTOR = 10**4  # in a polynomial; less where many monomials could add up by chance
NEARBY = PRECISE.number(Fraction(101, 100))
MOST_PARAMETERS = 4  # in one coefficient
DEGREE = 2


@dataclass(frozen=True)
class Coefficient:
    """A number of 50 digits and its exact formula, where one was found.

    general: the formula holds for all values of the parameters, not only for those of the spec.
    """

    value: Any
    formula: sp.Expr | None
    general: bool = False

    @property
    def text(self) -> str:
        """The formula as the language writes it, or the number."""
        return repr(float(self.value)) if self.formula is None else _written(self.formula)

    def times(self, name: str) -> str:
        """`+ l_1 m(fore)`: the sign, the coefficient unless it is one, the name."""
        formula = self.formula
        negative = self.value < 0 if formula is None else formula.could_extract_minus_sign()
        size = self.opposite if negative else self
        factor = "" if size.text == "1" else f"{size.text} "
        return f"{'-' if negative else '+'} {factor}{name}"

    @property
    def opposite(self) -> Coefficient:
        """The coefficient with the other sign."""
        formula = None if self.formula is None else -self.formula
        return replace(self, value=-self.value, formula=formula)


def _written(formula: sp.Expr) -> str:
    """The formula as the language writes it: `l_1^2/2`, `(a + b)`, `1/r^2`."""
    above, below = formula.as_numer_denom()
    text = f"({above})" if above.is_Add else str(above)
    if below != 1:
        text += f"/({below})" if below.is_Add or below.is_Mul else f"/{below}"
    return text.replace("**", "^")


@dataclass(frozen=True)
class Trial:
    """Relations that can be asked for at any parameters.

    names: index -> symbol of those that may matter; values: of all, `known` by the spec.
    """

    names: Mapping[int, sp.Symbol]
    values: Sequence[Any]
    known: bool  # else random numbers stand in for some
    relations: Callable[[Sequence[Any]], Relations]


def recognised(trial: Trial) -> dict[int, dict[int, Coefficient]]:
    """The relations at the spec's values, with formulas where some are found.

    A polynomial of degree 2 in up to 4 parameters, or the reciprocal of one, is found by integer
    relations (PSLQ) at random parameters and kept if it gives the number at the spec's values too.
    """
    here = trial.relations(trial.values)
    entries = _entries(here)
    general = _general(trial, here) if trial.names else {}
    found: dict[int, dict[int, Coefficient]] = {j: {} for j in here}
    for (j, i), formula in general.items():
        value = entries.get((j, i), PRECISE.number(0))
        if formula is not None and _holds(trial, formula, value):
            found[j][i] = Coefficient(value, formula, general=True)
    for (j, i), value in entries.items():
        if i not in found[j]:
            found[j][i] = Coefficient(value, rational(value), general=not trial.names)
    return {j: dict(sorted(shares.items())) for j, shares in found.items()}


def rational(value: Any) -> sp.Expr | None:
    """The fraction that a number is to 30 digits; None where it is none of a small denominator."""
    near = Fraction(mpmath.nstr(value, DIGITS)).limit_denominator(LARGEST_DENOMINATOR)
    if abs(PRECISE.number(near) - value) > CLOSE * abs(value):
        return None
    return sp.Rational(near.numerator, near.denominator)


def _entries(relations: Relations) -> Entries:
    return {(j, i): value for j, shares in relations.items() for i, value in shares.items()}


def _general(trial: Trial, here: Relations) -> dict[tuple[int, int], sp.Expr | None]:
    """Formulas at random parameters; none where other columns depend there."""
    chance = random.Random("parameters of relations")
    # 50 random digits: no relation holds there by chance
    parts = [PRECISE.number(Fraction(chance.randint(1, 10**50), 10**51)) for _ in trial.values]
    away = [v + part * (abs(v) or 1) for v, part in zip(trial.values, parts, strict=True)]
    relations = trial.relations(away)
    if relations.keys() != here.keys():
        return {}
    there = _entries(relations)
    relevant: dict[tuple[int, int], list[int]] = {entry: [] for entry in there}
    for index in trial.names:
        changed = [v * NEARBY if i == index else v for i, v in enumerate(away)]
        moved = _entries(trial.relations(changed))
        for entry, value in there.items():
            if abs(moved.get(entry, 0) - value) > CLOSE * abs(value):
                relevant[entry].append(index)
    return {
        entry: polynomial(value, {trial.names[i]: away[i] for i in relevant[entry]})
        for entry, value in there.items()
    }


def _holds(trial: Trial, formula: sp.Expr, value: Any) -> bool:
    """Whether a formula gives the number at the spec's parameters."""
    given = {s: sp.Float(str(trial.values[i]), DIGITS) for i, s in trial.names.items()}
    there = PRECISE.number(str(sp.N(formula.xreplace(given), DIGITS)))
    return bool(abs(there - value) <= CLOSE * (abs(value) + CLOSE))


def polynomial(value: Any, parameters: Mapping[sp.Symbol, Any]) -> sp.Expr | None:
    """The polynomial, or the reciprocal of one, that gives the value at these parameters."""
    if not parameters:
        return rational(value)
    if len(parameters) > MOST_PARAMETERS:
        return None
    found = _combination(value, parameters)
    if found is not None:
        return found
    below = _combination(1 / value, parameters)
    return None if below is None else 1 / below


def _combination(value: Any, parameters: Mapping[sp.Symbol, Any]) -> sp.Expr | None:
    """Small rational multiples of monomials that add up to the value."""
    monomials = list(_monomials(parameters))
    numbers = [prod((parameters[s] for s in m), start=PRECISE.number(1)) for m in monomials]
    largest = min(LARGEST_FACTOR, 10 ** ((DIGITS - 10) // len(monomials)))
    with mpmath.workdps(DIGITS - 5):
        found = mpmath.pslq([value, *numbers], maxcoeff=largest, maxsteps=10**4)
    if not found or not found[0]:
        return None
    pairs = zip(found[1:], monomials, strict=True)
    return sp.Add(*(sp.Rational(-c, found[0]) * sp.Mul(*m) for c, m in pairs))


def _monomials(parameters: Mapping[sp.Symbol, Any]) -> Iterator[tuple[sp.Symbol, ...]]:
    for degree in range(DEGREE + 1):
        yield from combinations_with_replacement(parameters, degree)
