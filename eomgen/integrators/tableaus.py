"""Coefficients of one-step methods, exact, checked where they are made."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import sqrt


def _row(*entries: str) -> tuple[Fraction, ...]:
    return tuple(Fraction(e) for e in entries)


@dataclass(frozen=True)
class Tableau:
    """An explicit Runge-Kutta method: k_i = f(t + c_i h, y + h sum a_ij k_j), y + h sum b_i k_i."""

    order: int
    a: tuple[tuple[Fraction, ...], ...]  # row i has i entries
    b: tuple[Fraction, ...]
    c: tuple[Fraction, ...]

    def __post_init__(self) -> None:
        assert len(self.a) == len(self.b) == len(self.c)
        assert all(len(row) == i for i, row in enumerate(self.a))
        assert all(sum(row) == c for row, c in zip(self.a, self.c, strict=True))
        assert sum(self.b) == 1


@dataclass(frozen=True)
class Rosenbrock:
    """Two stages, linearly implicit, one matrix W = 1 - gamma h J for both.

    W k_1 = h f(t, y),  W k_2 = h f(t + h, y + k_1) - 2 k_1,  y + 3/2 k_1 + 1/2 k_2.

    Order 2 for any J and gamma; L-stable where gamma^2 - 2 gamma + 1/2 = 0.
    Source: Verwer, Spee, Blom, Hundsdorfer, SIAM J. Sci. Comput. 20 (1999), method ROS2.
    """

    order: int
    gamma: float


# Kutta's method; Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, table II.1.2
RK4 = Tableau(
    order=4,
    a=((), _row("1/2"), _row("0", "1/2"), _row("0", "0", "1")),
    b=_row("1/6", "1/3", "1/3", "1/6"),
    c=_row("0", "1/2", "1/2", "1"),
)
# Dormand and Prince, order 5 without the error estimate; ibid., table II.5.2
DOPRI5 = Tableau(
    order=5,
    a=(
        (),
        _row("1/5"),
        _row("3/40", "9/40"),
        _row("44/45", "-56/15", "32/9"),
        _row("19372/6561", "-25360/2187", "64448/6561", "-212/729"),
        _row("9017/3168", "-355/33", "46732/5247", "49/176", "-5103/18656"),
    ),
    b=_row("35/384", "0", "500/1113", "125/192", "-2187/6784", "11/84"),
    c=_row("0", "1/5", "3/10", "4/5", "8/9", "1"),
)
# gamma = 1 - 1/sqrt(2): the smaller error constant of the two
ROS2 = Rosenbrock(order=2, gamma=1 - 1 / sqrt(2))
