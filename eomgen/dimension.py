"""Physical dimensions: exact exponents of kg, m, s, A and K; an angle is a plain number."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from operator import add, sub

BASE = ("kg", "m", "s", "A", "K")


@dataclass(frozen=True)
class Dimension:
    """Exponents of `BASE`, in that order; most are integers, which are ten times faster."""

    exponents: tuple[Fraction | int, ...] = (0,) * 5

    def __mul__(self, other: Dimension) -> Dimension:
        """The dimension of a product."""
        return Dimension(tuple(map(add, self.exponents, other.exponents)))

    def __truediv__(self, other: Dimension) -> Dimension:
        """The dimension of a quotient."""
        return Dimension(tuple(map(sub, self.exponents, other.exponents)))

    def __pow__(self, power: Fraction | int) -> Dimension:
        """The dimension of a power."""
        if power.denominator == 1:
            power = power.numerator
        return Dimension(tuple([a * power for a in self.exponents]))

    def __str__(self) -> str:
        """SI text such as `kg m^2 s^-2`; `1` for a plain number."""
        named = [(u, e) for u, e in zip(BASE, self.exponents, strict=True) if e]
        return " ".join(u if e == 1 else f"{u}^{e}" for u, e in named) or "1"


def _base(index: int) -> Dimension:
    return Dimension(tuple(int(i == index) for i in range(len(BASE))))


NONE = Dimension()
MASS, LENGTH, TIME, CURRENT, TEMPERATURE = (_base(i) for i in range(len(BASE)))
FORCE = MASS * LENGTH / TIME**2
ENERGY = FORCE * LENGTH
