"""Which factor and which term comes first: ranks of the names of a model, by declaration."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum

import sympy as sp

from eomgen.mechanics import motions
from eomgen.mechanics.equations import jump_name, virtual_name
from eomgen.model import TIME, Coordinate, Model, Prescribed


class Kind(IntEnum):
    """What a factor is; the factors of a product stand in this order."""

    CONSTANT = 0  # pi
    PARAMETER = 1
    TIME = 2
    COORDINATE = 3
    INPUT = 4
    ACCELERATION = 5
    RATE = 6
    FUNCTION = 7
    VIRTUAL = 8


Rank = tuple[Kind, tuple[int, ...], int]  # kind, declared places, tie break

PI: Rank = (Kind.CONSTANT, (0,), 0)


@dataclass
class Order:
    """Rank of every symbol; a name that the model does not know ranks as an input, as first seen.

    nonzero: names that an equation may be divided by; accelerations: coordinate or speed -> the
    name of its acceleration.
    """

    ranks: dict[str, Rank] = field(default_factory=dict)
    nonzero: frozenset[str] = frozenset()
    accelerations: Mapping[str, str] = field(default_factory=dict)

    def rank(self, symbol: sp.Symbol) -> Rank:
        """The rank of a symbol."""
        known = self.ranks.get(symbol.name)
        if known is None:
            known = self.ranks[symbol.name] = (Kind.INPUT, (1000 + len(self.ranks),), 0)
        return known


def of_model(model: Model) -> Order:
    """The order in which a model declares its names."""
    ranks: dict[str, Rank] = {TIME.name: (Kind.TIME, (0,), 0)}
    for kind, symbols in _declared(model):
        for place, symbol in enumerate(symbols):
            ranks[symbol.name] = (kind, (place,), 0)
    for place, name in enumerate(motions.displacements(model)):
        ranks[virtual_name(name)] = (Kind.VIRTUAL, (place,), 0)
    for place, coordinate in enumerate(model.coordinates):
        ranks[jump_name(coordinate.name)] = (Kind.VIRTUAL, (place,), 0)
    own = {c.name: c.acceleration.name for c in model.coordinates}
    own |= {s.name: s.rate.name for s in model.speeds}
    return Order(ranks, frozenset(_nonzero(model)), own)


def _declared(model: Model) -> Iterator[tuple[Kind, Iterable[sp.Symbol]]]:
    places: list[Coordinate | Prescribed] = [*model.coordinates, *model.prescribed]
    yield Kind.PARAMETER, [p.symbol for p in model.parameters]
    yield Kind.COORDINATE, [p.symbol for p in places]
    yield Kind.INPUT, [i.symbol for i in model.inputs]
    yield Kind.RATE, [*(p.rate for p in places), *(s.symbol for s in model.speeds)]
    yield Kind.ACCELERATION, [*(p.acceleration for p in places), *(s.rate for s in model.speeds)]


def _nonzero(model: Model) -> Iterator[str]:
    """Parameters, unless their value is zero; coordinates that never vanish where they range."""
    for parameter in model.parameters:
        if parameter.value is None or not parameter.value.is_zero:
            yield parameter.symbol.name
    for coordinate in model.coordinates:
        low, high = model.range.get(coordinate.name, (sp.S.Zero, sp.S.Zero))
        if coordinate.positive or low.is_positive or high.is_negative:
            yield coordinate.symbol.name
