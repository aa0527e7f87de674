"""How a formula moves: its partial derivatives, its rate, its second rate with every q'' = 0."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from eomgen.algebra.graph import Node
from eomgen.mechanics import motions, speeds
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive.records import NoTree
from eomgen.mechanics.vectors import Vector, add, scale
from eomgen.model import TIME


@dataclass(frozen=True)
class Moving:
    """A vector of formulas in the coordinates and the time."""

    values: Vector[Node]
    columns: Mapping[int, Vector[Node]]  # d values / d q, by the number of the coordinate
    rate: Vector[Node]
    drift: Vector[Node]

    @property
    def is_still(self) -> bool:
        """Whether nothing moves it."""
        zero = self.values[0].graph.zero
        return not self.columns and all(r is zero for r in (*self.rate, *self.drift))


@dataclass(frozen=True)
class Clock:
    """The coordinates, speeds and the time of a scene, as leaves of its graph."""

    kinematics: Kinematics[Node]

    @cached_property
    def numbers(self) -> dict[sp.Symbol, int]:
        """The number of each speed."""
        return {s: i for i, s in enumerate(speeds.symbols(self.kinematics.model))}

    @cached_property
    def movers(self) -> tuple[tuple[int, sp.Symbol, Node, Node], ...]:
        """(number of the speed, symbol, leaf, rate) of each coordinate that is no quaternion's.

        The time comes last, as number -1.
        """
        algebra, numbers = self.kinematics.algebra, self.numbers
        found = [
            (numbers[c.rate], c.symbol, algebra.of(c.symbol), algebra.of(c.rate))
            for c in motions.plain(self.kinematics.model)
        ]
        return (*found, (-1, TIME, algebra.of(TIME), algebra.number(1)))

    @cached_property
    def _places_of_bits(self) -> dict[int, tuple[int, sp.Symbol, Node, Node]]:
        return {mover[2].leaves.bit_length(): mover for mover in self.movers}

    @cached_property
    def _moving_bits(self) -> int:
        return sum(leaf.leaves for _, _, leaf, _ in self.movers)

    @cached_property
    def constant_bits(self) -> int:
        """The leaves that are parameters: beside movers nothing else may be in a position."""
        algebra = self.kinematics.algebra
        symbols = (p.symbol for p in self.kinematics.model.parameters)
        bits = 0
        for symbol in symbols:
            bits |= algebra.of(symbol).leaves
        return bits

    def moved_by(self, value: Node) -> list[tuple[int, sp.Symbol, Node, Node]]:
        """What moves a value, by declaration.

        Raises:
            NoTree: it depends on something else, such as a rate or an input.
        """
        if value.leaves & ~self._moving_bits & ~self.constant_bits:
            raise NoTree("a position depends on more than coordinates, time and parameters")
        found, bits = [], value.leaves & self._moving_bits
        while bits:
            found.append(self._places_of_bits[bits.bit_length()])
            bits &= ~(1 << (bits.bit_length() - 1))
        # the time last, so that sums are in the order of the declaration
        return sorted(found, key=lambda mover: (mover[0] < 0, mover[0]))

    def moving(self, formulas: Sequence[sp.Expr]) -> Moving:
        """The motion of formulas of the spec."""
        return self.motion(self.kinematics.vector(tuple(formulas)))

    def motion(self, values: Vector[Node]) -> Moving:
        """The motion of values."""
        movers = {m[0]: m for v in values for m in self.moved_by(v)}
        chosen = (
            [m for m in self.movers if m[0] in movers] if len(movers) > 1 else [*movers.values()]
        )
        zero = (values[0].graph.zero,) * len(values)
        rate, drift, first = zero, zero, {}
        for number, symbol, _, speed in chosen:
            first[number] = self.along(values, symbol)
            rate = add(rate, scale(speed, first[number]))
        for i, (number, _, _, speed) in enumerate(chosen):
            for other, symbol, _, second in chosen[: i + 1]:
                # the mixed derivative counts twice
                factor = speed * second * (1 if other == number else 2)
                drift = add(drift, scale(factor, self.along(first[number], symbol)))
        first.pop(-1, None)
        return Moving(values, first, rate, drift)

    def along(self, values: Vector[Node], symbol: sp.Symbol) -> Vector[Node]:
        """d values / d symbol."""
        algebra = self.kinematics.algebra
        one = algebra.number(1)
        return tuple(algebra.along(v, {symbol: one}) for v in values)
