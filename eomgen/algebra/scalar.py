"""The interface of the two algebras, so that the mechanics is written once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any, Protocol, Self, TypeVar

import sympy as sp


class Scalar(Protocol):
    """A value of either algebra; numbers mix in."""

    def __add__(self, other: Any) -> Self: ...
    def __radd__(self, other: Any) -> Self: ...
    def __sub__(self, other: Any) -> Self: ...
    def __rsub__(self, other: Any) -> Self: ...
    def __mul__(self, other: Any) -> Self: ...
    def __rmul__(self, other: Any) -> Self: ...
    def __truediv__(self, other: Any) -> Self: ...
    def __pow__(self, power: Any) -> Self: ...
    def __neg__(self) -> Self: ...


S = TypeVar("S", bound=Scalar)


class Algebra(Protocol[S]):
    """Makes scalars and differentiates them."""

    @property
    def bindings(self) -> Mapping[sp.Symbol, S]:
        """What symbols stand for."""

    def number(self, value: int | Fraction) -> S:
        """The scalar of an exact rational number."""

    def of(self, expression: sp.Expr) -> S:
        """The scalar of a formula of the spec."""

    def apply(self, name: str, *operands: S) -> S:
        """A function of the language, by its name."""

    def along(self, value: S, direction: Mapping[sp.Symbol, S]) -> S:
        """The directional derivative: sum of d value / d symbol * direction[symbol]."""

    def direction(self, rates: Mapping[sp.Symbol, S]) -> Callable[[S], S]:
        """The derivative along one direction, as a function of the value."""

    def extended(self, bindings: Mapping[sp.Symbol, S]) -> Algebra[S]:
        """The same algebra with more symbols bound to values."""

    def is_zero(self, value: S) -> bool:
        """Whether the value is zero as it stands."""
