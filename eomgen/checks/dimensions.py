"""Every term of every derived equation has the same dimension."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from eomgen.algebra.closed import to_sympy
from eomgen.algebra.normal import Form, Kernel, Key, Monomial, Ring
from eomgen.dimension import ENERGY, NONE, TIME, Dimension
from eomgen.errors import CheckError
from eomgen.mechanics.equations import Derivation, Equation
from eomgen.mechanics.quasi_velocities import PARTS
from eomgen.model import TIME as t
from eomgen.model import Coordinate, Input, Model, Parameter, Prescribed

Dimensions = Mapping[sp.Symbol, Dimension | None]


def of_symbols(model: Model) -> dict[sp.Symbol, Dimension | None]:
    """The dimension of every symbol; None where the spec leaves it open."""
    found: dict[sp.Symbol, Dimension | None] = {t: TIME, sp.pi: NONE}
    constants: list[Parameter | Input] = [*model.parameters, *model.inputs]
    for constant in constants:
        found[constant.symbol] = constant.description.dimension
    everything: list[Coordinate | Prescribed] = [*model.coordinates, *model.prescribed]
    for moving in everything:
        dimension = moving.description.dimension
        found[moving.symbol] = dimension
        found[moving.rate] = dimension and dimension / TIME
        found[moving.acceleration] = dimension and dimension / TIME**2
    for speed in model.speeds:
        dimension = speed.description.dimension
        found[speed.symbol] = dimension
        found[speed.rate] = dimension and dimension / TIME
    return found


@dataclass(frozen=True)
class Term:
    """One term with its dimension."""

    form: Form
    dimension: Dimension

    def __str__(self) -> str:
        """The term and its dimension."""
        return f"{to_sympy(self.form)} is [{self.dimension}]"


def check(derivation: Derivation) -> int:
    """The number of terms that were checked.

    Raises:
        CheckError: two terms of one equation, or of an energy, have different dimensions.
    """
    if not derivation.model.with_units:
        return 0
    known = of_symbols(derivation.model)
    checked = 0
    for equation in derivation.equations:
        checked += agree(f"the equation of {equation.name}", terms(known, *parts(equation)))
    energies = (derivation.kinetic_energy, derivation.potential_energy)
    for name, energy in zip(("kinetic energy", "potential energy"), energies, strict=True):
        checked += agree(f"the {name}", terms(known, energy), ENERGY)
    return checked


def parts(equation: Equation) -> Iterator[Form]:
    """The shares of an equation."""
    return (getattr(equation, part) for part in PARTS)


def terms(known: Dimensions, *forms: Form) -> Iterator[Term]:
    """The terms whose dimension is known."""
    found: dict[Monomial, Dimension | None] = {}  # many terms differ in their waves only
    for form in forms:
        for key, c in form.terms.items():
            if key[0] not in found:
                found[key[0]] = of_key(known, form.ring, key)
            dimension = found[key[0]]
            if dimension is not None:
                yield Term(Form(form.ring, {key: c}), dimension)


def agree(where: str, found: Iterator[Term], wanted: Dimension | None = None) -> int:
    """The number of terms; all have one dimension.

    Raises:
        CheckError: names the two terms that disagree.
    """
    first: Term | None = None
    count = 0
    for count, term in enumerate(found, 1):  # noqa: B007 (the count is the result)
        first = first or term
        if term.dimension != first.dimension:
            raise CheckError(f"{where} adds unlike terms: {first}, but {term}")
        if wanted is not None and term.dimension != wanted:
            raise CheckError(f"{where} should be [{wanted}], but {term}")
    return count


def of_key(known: Dimensions, ring: Ring, key: Key) -> Dimension | None:
    """The dimension of a term; a sine or cosine is a plain number."""
    result = NONE
    for atom, exponent in key[0]:
        dimension = of_atom(known, ring, atom)
        if dimension is None:
            return None
        result = result * dimension**exponent
    return result


SAME = ("base", "abs", "min", "max")  # kernels that have the dimension of their argument


def of_atom(known: Dimensions, ring: Ring, atom: int) -> Dimension | None:
    """The dimension of a symbol or kernel."""
    what = ring.atoms[atom]
    if not isinstance(what, Kernel):
        return known.get(what)
    inner = next(terms(known, what.arguments[0]), None)
    if what.function == "power" or inner is None:
        return None
    if what.function == "sqrt":
        return inner.dimension ** Fraction(1, 2)
    return inner.dimension if what.function in SAME else NONE
