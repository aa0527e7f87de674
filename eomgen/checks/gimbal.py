"""Where a body's angles are singular: W-GIMBAL, with the remedy."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan2, degrees, hypot, pi

import sympy as sp

from eomgen.checks.samples import constants, number
from eomgen.mechanics.vectors import cross, dot
from eomgen.model import Body, Coordinate, Model, Turn

NEAR = 5 * pi / 180  # rad from the singular angle


def warnings(model: Model) -> tuple[str, ...]:
    """A line for each body whose three turns lose one near a place in the declared range.

    With the axes a, b, c and the middle angle q the rates do not follow from the angular velocity
    where det(q) = a . R(b, q) (b x c) vanishes.
    Without a declared range the middle angle may be anything.
    """
    return tuple(line for body in model.bodies for line in _of_body(model, body))


def _of_body(model: Model, body: Body) -> Iterator[str]:
    turns = body.frame.turns
    for first, middle, last in zip(turns, turns[1:], turns[2:], strict=False):
        if all(isinstance(t, Turn) and t.angle.is_Symbol for t in (first, middle, last)):
            assert isinstance(middle, Turn)
            coordinate = next((c for c in model.coordinates if c.symbol == middle.angle), None)
            if coordinate is not None:
                yield from _near(model, body, coordinate, _zeros(first, middle, last))


def _zeros(*turns: object) -> list[float]:
    """The angles in (-pi, pi] at which the determinant vanishes; it is A + B sin q + C cos q."""
    a, b, c = (_unit(t.axis) for t in turns if isinstance(t, Turn))
    normal = cross(b, c)  # across b: R(b, q) n = cos(q) n + sin(q) b x n
    cosine, sine = dot(a, normal), dot(a, cross(b, normal))
    if hypot(cosine, sine) < 1e-12:
        return []  # two neighbouring axes are parallel: not a matter of the angle
    root = atan2(-cosine, sine)
    return sorted({round(r - 2 * pi if r > pi else r, 12) for r in (root, root + pi)})


def _unit(axis: tuple[sp.Expr, ...]) -> tuple[float, ...]:
    """The axis with length 1."""
    numbers = [float(x) for x in axis]
    return tuple(x / hypot(*numbers) for x in numbers)


def _near(model: Model, body: Body, middle: Coordinate, zeros: list[float]) -> Iterator[str]:
    """The first singular angle that the range comes near, in words."""
    given = constants(model)
    bounds = model.range.get(middle.name)
    low, high = (-pi, pi) if bounds is None else (float(number(model, v, given)) for v in bounds)
    for zero in zeros:
        turns = round((((low + high) / 2) - zero) / (2 * pi))
        place = zero + 2 * pi * turns
        if low - NEAR < place < high + NEAR:
            where = "its range" if bounds else "no range is declared"
            yield (
                f"W-GIMBAL: the turns of '{body.name}' are singular at {middle.name} = "
                f"{degrees(place):.6g} deg ({where}); use a quaternion, or declare a range "
                "that stays away from it"
            )
            return
