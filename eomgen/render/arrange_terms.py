"""A closed form as flat terms: number * powers of parameters * powers of what moves."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

import sympy as sp

from eomgen.algebra.normal import Atom, Form, Kernel, Monomial, Ring, atoms_of
from eomgen.render import arrange_waves
from eomgen.render.arrange_order import PI, Kind, Order, Rank
from eomgen.render.arrange_waves import Ripple
from eomgen.render.tree import Function, Symbol, Tree, power

Powers = tuple[tuple[int, int], ...]  # (factor, exponent) in the order of the factors' ranks


class Term(NamedTuple):
    """number * parameters * motion."""

    number: Fraction
    parameters: Powers
    motion: Powers


@dataclass
class Factors:
    """Everything that is raised to a power in the forms of one ring: its rank and its tree.

    Numbers of factors are those of this table; `by_key` finds the atoms and waves already met.
    """

    ring: Ring
    order: Order
    argument: Callable[[Factors, Form], Tree]  # what arranges the inside of a function
    ranks: list[Rank] = field(default_factory=list)
    trees: list[Tree] = field(default_factory=list)
    by_key: dict[Hashable, int] = field(default_factory=dict)
    ripples: dict[int, Ripple] = field(default_factory=dict)  # factor that is a sine -> its wave
    flipped: dict[Ripple, bool] = field(default_factory=dict)
    monomials: dict[Monomial, tuple[Powers, Powers, dict[Ripple, int]]] = field(
        default_factory=dict
    )
    keys: dict[Powers, tuple[object, ...]] = field(default_factory=dict)  # sort keys of motions
    waves: set[int] = field(default_factory=set)  # sines and cosines
    squares: dict[int, Form] = field(default_factory=dict)  # factor that is a root -> its square

    def add(self, key: Hashable, rank: Rank, tree: Tree) -> int:
        """The number of a new factor."""
        self.by_key[key] = len(self.ranks)
        self.ranks.append(rank)
        self.trees.append(tree)
        return self.by_key[key]

    def sort(self, powers: Iterable[tuple[int, int]]) -> Powers:
        """Powers in the order of a product."""
        return tuple(sorted((p for p in powers if p[1]), key=self.place))

    def place(self, item: tuple[int, int]) -> tuple[Rank, int]:
        """The sort key of a power."""
        return self.ranks[item[0]], item[0]

    def kind(self, factor: int) -> Kind:
        """What a factor is."""
        return self.ranks[factor][0]

    def is_function(self, factor: int) -> bool:
        """Whether a factor is a sine, a cosine or a tangent."""
        shown = self.trees[factor]
        return isinstance(shown, Function) and shown.name in ("sin", "cos", "tan")

    def tangent(self, sine: int) -> tuple[int, int] | None:
        """(cosine, tangent) of a sine's argument, if the factor is one whose cosine was met."""
        ripple = self.ripples.get(sine)
        cosine = self.by_key.get((False, ripple[1])) if ripple else None
        if cosine is None:
            return None
        shown = self.trees[sine]
        assert isinstance(shown, Function)
        known = self.by_key.get(("tan", sine))
        tangent = Function("tan", shown.arguments)
        return cosine, self.add(
            ("tan", sine), self.ranks[sine], tangent
        ) if known is None else known

    def tree(self, powers: Powers) -> tuple[Tree, ...]:
        """Powers with positive exponents, as displayed; an even power of a root is none."""
        return tuple(self._power(f, e) for f, e in powers)

    def _power(self, factor: int, exponent: int) -> Tree:
        shown = self.trees[factor]
        if factor in self.squares and exponent % 2 == 0:
            assert isinstance(shown, Function)
            return power(shown.arguments[0], exponent // 2)
        return power(shown, exponent)


def flat(factors: Factors, form: Form) -> list[Term]:
    """The terms of a form, every trigonometric polynomial in its shortest spelling."""
    groups: dict[Monomial, dict[Ripple, Fraction]] = {}
    for (monomial, wave, sine), c in form.terms.items():
        groups.setdefault(monomial, {})[sine, wave] = Fraction(c)
    phases = _phases(factors.ring)
    total: dict[tuple[Powers, Powers], Fraction] = {}
    for monomial, waves in groups.items():
        parameters, motion, below = _monomial(factors, monomial)
        for powers, c in arrange_waves.shortest(waves, below, phases).items():
            key, number = _with_waves(factors, (parameters, motion), powers, Fraction(c))
            total[key] = total.get(key, Fraction(0)) + number
    return [Term(number, *key) for key, number in total.items() if number]


def _with_waves(
    factors: Factors,
    split: tuple[Powers, Powers],
    powers: tuple[tuple[Ripple, int], ...],
    number: Fraction,
) -> tuple[tuple[Powers, Powers], Fraction]:
    """((parameters, motion), number) times the powers of sines and cosines."""
    parameters, motion = list(split[0]), list(split[1])
    for ripple, exponent in powers:
        factor = wave_factor(factors, ripple)
        if factors.flipped[ripple] and exponent % 2:
            number = -number
        constant = factors.kind(factor) <= Kind.PARAMETER
        (parameters if constant else motion).append((factor, exponent))
    return (factors.sort(parameters), factors.sort(motion)), number


def _monomial(factors: Factors, monomial: Monomial) -> tuple[Powers, Powers, dict[Ripple, int]]:
    """(parameters, motion, denominators that are a sine or a cosine)."""
    known = factors.monomials.get(monomial)
    if known is None:
        parameters: list[tuple[int, int]] = []
        motion: list[tuple[int, int]] = []
        below: dict[Ripple, int] = {}
        for atom, exponent in monomial:
            ripple = _single_wave(factors.ring.atoms[atom])
            if ripple:
                below[ripple] = -exponent
                continue
            factor = atom_factor(factors, atom)
            constant = factors.kind(factor) <= Kind.PARAMETER
            (parameters if constant else motion).append((factor, exponent))
        known = factors.sort(parameters), factors.sort(motion), below
        factors.monomials[monomial] = known
    return known


def _single_wave(what: Atom) -> Ripple | None:
    """The sine or cosine of one angle that a `base` stands for."""
    if isinstance(what, Kernel) and what.function == "base" and len(what.arguments[0].terms) == 1:
        ((monomial, wave, sine),) = what.arguments[0].terms
        if not monomial and len(wave) == 1:
            return sine, wave
    return None


def _phases(ring: Ring) -> frozenset[int]:
    """Angles that are multiples of pi."""
    pi = ring.index.get(sp.pi)
    angle = ring.angle_index.get((((pi, 1),), (), False)) if pi is not None else None
    return frozenset() if angle is None else frozenset({angle})


def atom_factor(factors: Factors, atom: int) -> int:
    """The factor of an atom of the ring."""
    known = factors.by_key.get(atom)
    if known is not None:
        return known
    what = factors.ring.atoms[atom]
    if isinstance(what, Kernel):
        return _kernel(factors, atom, what)
    if what is sp.pi:
        return factors.add(atom, PI, Symbol("pi"))
    return factors.add(atom, factors.order.rank(what), Symbol(what.name))


def _kernel(factors: Factors, atom: int, what: Kernel) -> int:
    """The factor of a function; `base` is shown as the sum that it stands for."""
    arguments = tuple(factors.argument(factors, a) for a in what.arguments)
    ranks = [r for a in what.arguments for r in _ranks(factors, a)]
    tree = arguments[0] if what.function == "base" else Function(what.function, arguments)
    factor = factors.add(atom, _function_rank(ranks, 10**6 + len(factors.ranks)), tree)
    if what.function == "sqrt":
        factors.squares[factor] = what.arguments[0]
    return factor


def _ranks(factors: Factors, form: Form) -> list[Rank]:
    """The ranks of the symbols of a form, those inside of functions too."""
    return sorted({factors.ranks[atom_factor(factors, a)] for a in atoms_of(form)})


def _function_rank(ranks: list[Rank], tie: int) -> Rank:
    """After all symbols if anything in it moves, else after all parameters."""
    places = tuple(n for kind, where, _ in ranks for n in (int(kind), *where))
    if all(kind <= Kind.PARAMETER for kind, _, _ in ranks):
        return Kind.PARAMETER, (10**6, *places), tie
    return Kind.FUNCTION, places, tie


def wave_factor(factors: Factors, ripple: Ripple) -> int:
    """The factor of a sine or cosine, its first declared angle positive."""
    known = factors.by_key.get(ripple)
    if known is not None:
        return known
    sine, wave = ripple
    ring = factors.ring
    angles = [(_ranks(factors, Form(ring, {ring.angles[a]: 1})), a, f) for a, f in wave]
    first = min(angles, key=lambda item: (item[0] == [PI], *item[:2]))
    sign = -1 if first[2] < 0 else 1
    argument = Form(ring, {ring.angles[a]: sign * f for a, f in wave})
    tie = 2 * int(2 * sum(abs(Fraction(f)) for _, f in wave)) + (not sine)
    ranks = sorted({rank for ranks, _, _ in angles for rank in ranks})
    tree = Function("sin" if sine else "cos", (factors.argument(factors, argument),))
    factors.flipped[ripple] = sine and sign < 0
    factor = factors.add(ripple, _function_rank(ranks, tie), tree)
    factors.waves.add(factor)
    if sine:
        factors.ripples[factor] = ripple
    return factor
