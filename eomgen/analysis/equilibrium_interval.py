"""All roots of one equation in one unknown, proven by interval arithmetic (Moore; Krawczyk).

A box holds no root where f(X) excludes 0, and one at most where f'(X) does; then the signs of f
at its ends tell. Every other box is split. The equation may hold any function that has intervals.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import mpmath

from eomgen.algebra.arithmetic import Arithmetic
from eomgen.analysis.equilibrium_scene import Scene

MOST_BOXES = 4000
NARROWEST = 1e-9  # share of the region; a box that is still open may hold a multiple root
SPLIT = 0.4837  # not the middle, where roots like to lie
MARGIN = 0.0013  # beyond the region, so that roots on its edge are seen
FUNCTIONS = ("sin", "cos", "sqrt", "exp", "log")


class NotProven(Exception):
    """A function without intervals, or too many boxes."""


@dataclass(frozen=True)
class Proof:
    """Starting points, one for each proven root, and the boxes that stayed open."""

    roots: tuple[float, ...]
    unresolved: tuple[float, ...]


@cache
def intervals() -> Arithmetic:
    """Interval arithmetic of 25 digits."""
    context = mpmath.ctx_iv.MPIntervalContext()
    context.dps = 25

    def number(value: Any) -> Any:
        if isinstance(value, Fraction):
            return context.mpf(value.numerator) / value.denominator
        return context.convert(value)

    functions: dict[str, Callable[..., Any]] = {
        "add": operator.add,
        "subtract": operator.sub,
        "multiply": operator.mul,
        "divide": operator.truediv,
        "negate": operator.neg,
        "pi": lambda: +context.pi,
        "tan": lambda a: context.sin(a) / context.cos(a),
        **{name: getattr(context, name) for name in FUNCTIONS},
    }
    return Arithmetic(number, functions)


def prove(scene: Scene, low: float, high: float) -> Proof:
    """All roots of the only balance between two bounds.

    Raises:
        NotProven: the equation has a function without intervals, or takes too many boxes.
    """
    margin = MARGIN * (high - low)
    waiting = [(low - margin, high + margin)]
    roots, unresolved, boxes = [], [], 0
    while waiting:
        left, right = waiting.pop()
        boxes += 1
        if boxes > MOST_BOXES:
            raise NotProven
        count = _count(scene, left, right)
        if count is None and right - left < NARROWEST * (high - low):
            unresolved.append((left + right) / 2)
        elif count is None:
            middle = left + SPLIT * (right - left)
            waiting += [(middle, right), (left, middle)]
        elif count:
            roots.append(_bisected(scene, left, right))
    return Proof(tuple(roots), tuple(unresolved))


def _count(scene: Scene, left: float, right: float) -> int | None:
    """0 or 1 where that is proven."""
    value, slope = _values(scene, left, right)
    if value is None or 0 not in value:
        return None if value is None else 0
    if slope is None or 0 in slope:
        return None
    first, last = (_sign(scene, x) for x in (left, right))
    return None if 0 in (first, last) else int(first != last)


def _values(scene: Scene, left: float, right: float) -> tuple[Any, Any]:
    """f and f' over a box; None where they have no value."""
    try:
        box = intervals().number([left, right])
        found = scene.at([box], [], intervals())
    except (ValueError, ZeroDivisionError, mpmath.libmp.ComplexResult):
        return None, None
    except KeyError as error:
        raise NotProven from error
    return found.balances[0], found.slopes[0][0]


def _sign(scene: Scene, x: float) -> int:
    """The sign of f at a point, 0 where it is not proven."""
    value, _ = _values(scene, x, x)
    if value is None or 0 in value:
        return 0
    return 1 if value.a > 0 else -1


def _bisected(scene: Scene, left: float, right: float) -> float:
    """The middle of a box with one root, narrowed for Newton's method."""
    first = _sign(scene, left)
    for _ in range(40):
        middle = left + SPLIT * (right - left)
        sign = _sign(scene, middle)
        if sign == 0:
            return middle
        left, right = (middle, right) if sign == first else (left, middle)
    return (left + right) / 2
