"""How long a spring or damper is and how fast that changes."""

from __future__ import annotations

import sympy as sp

from eomgen.algebra.scalar import S
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.vectors import Vector, dot, subtract
from eomgen.model import Damper, Spring

Element = Spring | Damper


def span(kinematics: Kinematics[S], element: Element) -> Vector[S]:
    """From the first end to the second, in world axes [m]."""
    assert element.between
    first, second = element.between
    return subtract(kinematics.position(second), kinematics.position(first))


def length(kinematics: Kinematics[S], element: Element) -> S:
    """The distance of the two ends, or the formula that the element acts along."""
    if element.along is not None:
        return kinematics.algebra.of(element.along)
    along = span(kinematics, element)
    if len(along) == 1:
        return along[0]  # on a line the distance keeps its sign: second end minus first
    return kinematics.algebra.apply("sqrt", dot(along, along))


def elongation(kinematics: Kinematics[S], spring: Spring) -> S:
    """Length minus free length."""
    if spring.free_length == 0:
        return length(kinematics, spring)
    return length(kinematics, spring) - kinematics.algebra.of(spring.free_length)


def elongation_rate(kinematics: Kinematics[S], element: Element) -> S:
    """The time derivative of the length."""
    if element.along is not None:
        return kinematics.rate(kinematics.algebra.of(element.along))
    along = span(kinematics, element)
    moving = tuple(kinematics.rate(c) for c in along)
    if len(along) == 1:
        return moving[0]
    return dot(along, moving) / length(kinematics, element)


def formula_of(kinematics: Kinematics[S], spring: Spring, formula: sp.Expr) -> S:
    """A formula in the elongation, with the elongation put in."""
    e = elongation(kinematics, spring)
    return kinematics.algebra.extended({spring.elongation: e}).of(formula)


def law_of(kinematics: Kinematics[S], damper: Damper, formula: sp.Expr) -> S:
    """A formula in the elongation rate, with the rate put in."""
    v = elongation_rate(kinematics, damper)
    return kinematics.algebra.extended({damper.elongation_rate: v}).of(formula)
