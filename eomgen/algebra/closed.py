"""The closed form as an algebra: SymPy formulas in, derivatives, values and SymPy out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial, reduce
from operator import add
from typing import Any

import sympy as sp

from eomgen.algebra import functions, normal
from eomgen.algebra.normal import Form, Kernel, Key, Ring, number, of_atom

SYMPY_FUNCTIONS: dict[Any, str] = {
    sp.sin: "sin", sp.cos: "cos", sp.tan: "tan", sp.asin: "asin", sp.acos: "acos",
    sp.atan: "atan", sp.atan2: "atan2", sp.sinh: "sinh", sp.cosh: "cosh", sp.tanh: "tanh",
    sp.exp: "exp", sp.log: "log", sp.Abs: "abs", sp.sign: "sign", sp.Min: "min", sp.Max: "max",
}  # fmt: skip


@dataclass
class ClosedForm:
    """The algebra; `bindings` replace symbols, every other symbol is itself."""

    ring: Ring = field(default_factory=Ring)
    bindings: Mapping[sp.Symbol, Form] = field(default_factory=dict)
    known: dict[sp.Expr, Form] = field(default_factory=dict)

    def number(self, value: normal.Number) -> Form:
        """The form of an exact rational number."""
        return number(self.ring, value)

    def apply(self, name: str, *operands: Form) -> Form:
        """A function of the language."""
        return functions.apply(name, *operands)

    def is_zero(self, value: Form) -> bool:
        """Decided for polynomials in symbols, roots, quotients, sines and cosines."""
        return normal.is_zero(value)

    def of(self, expression: sp.Expr) -> Form:
        """The form of a SymPy formula."""
        if expression not in self.known:
            self.known[expression] = self._of(expression)
        return self.known[expression]

    def _of(self, expression: sp.Expr) -> Form:
        if expression.is_Symbol:
            bound = self.bindings.get(expression)
            return of_atom(self.ring, expression) if bound is None else bound
        if not expression.args:
            return self._constant(expression)
        arguments = [self.of(a) for a in expression.args]
        if expression.is_Add:
            return normal.total(self.ring, arguments)
        if expression.is_Mul:
            return reduce(normal.multiply, arguments)
        if expression.is_Pow:
            return self._power(arguments[0], expression.exp)
        name = SYMPY_FUNCTIONS[expression.func]
        if name in ("min", "max"):
            return reduce(functions.FUNCTIONS[name], arguments)
        return self.apply(name, *arguments)

    def _constant(self, expression: sp.Expr) -> Form:
        if expression.is_Rational:
            return self.number(Fraction(expression.p, expression.q))
        constants = {sp.pi: lambda: of_atom(self.ring, sp.pi)}
        constants[sp.E] = lambda: functions.kernel("exp", self.number(1))
        return constants[expression]()

    def _power(self, base: Form, exponent: sp.Expr) -> Form:
        """base^exponent: whole and half powers are looked into, others are kernels."""
        if exponent.is_Integer:
            return base ** int(exponent)
        if exponent.is_Rational and exponent.q == 2:
            return functions.sqrt(base) ** int(exponent.p)
        return self.apply("power", base, self.of(exponent))

    def extended(self, bindings: Mapping[sp.Symbol, Form]) -> ClosedForm:
        """The same ring, with more symbols bound."""
        return ClosedForm(self.ring, {**self.bindings, **bindings})

    def along(self, value: Form, direction: Mapping[sp.Symbol, Form]) -> Form:
        """The sum of d value / d symbol * direction[symbol]."""
        moving = {
            a: direction[what]
            for a, what in enumerate(self.ring.atoms)
            if isinstance(what, sp.Symbol) and what in direction
        }
        return Along(self.ring, moving).form(value)

    def direction(self, rates: Mapping[sp.Symbol, Form]) -> Callable[[Form], Form]:
        """The derivative along one direction, as a function of the value."""
        return partial(self.along, direction=rates)


@dataclass
class Along:
    """Differentiates along one direction; `speeds` caches how fast atoms and angles move."""

    ring: Ring
    moving: Mapping[int, Form]
    atom_speeds: dict[int, Form] = field(default_factory=dict)
    angle_speeds: dict[int, Form] = field(default_factory=dict)
    wave_speeds: dict[normal.Wave, Form] = field(default_factory=dict)

    def form(self, value: Form) -> Form:
        """The derivative of a form, term by term."""
        parts = [p for key, c in value.terms.items() for p in self._term(key, c)]
        return normal.total(self.ring, parts)

    def _term(self, key: Key, c: normal.Number) -> list[Form]:
        monomial, wave, sine = key
        parts = []
        for atom, exponent in monomial:
            speed = self._atom(atom)
            if speed.terms:
                rest = normal._merge(monomial, ((atom, -1),))
                parts.append(Form(self.ring, {(rest, wave, sine): c * exponent}) * speed)
        if wave:
            # d cos a = -sin a da,  d sin a = cos a da
            speed = self._wave(wave)
            if speed.terms:
                turned = Form(self.ring, {(monomial, wave, not sine): c if sine else -c})
                parts.append(turned * speed)
        return parts

    def _atom(self, atom: int) -> Form:
        if atom not in self.atom_speeds:
            self.atom_speeds[atom] = self._atom_speed(atom)
        return self.atom_speeds[atom]

    def _atom_speed(self, atom: int) -> Form:
        what = self.ring.atoms[atom]
        if not isinstance(what, Kernel):
            return self.moving.get(atom, number(self.ring, 0))
        speeds = [self.form(a) for a in what.arguments]
        if not any(s.terms for s in speeds):
            return number(self.ring, 0)
        partials = functions.partials(self.ring, what)
        return normal.total(self.ring, (p * s for p, s in zip(partials, speeds, strict=True)))

    def _wave(self, wave: normal.Wave) -> Form:
        if wave not in self.wave_speeds:
            speeds = (self._angle(angle) * factor for angle, factor in wave)
            self.wave_speeds[wave] = normal.total(self.ring, speeds)
        return self.wave_speeds[wave]

    def _angle(self, angle: int) -> Form:
        if angle not in self.angle_speeds:
            self.angle_speeds[angle] = self._angle_speed(angle)
        return self.angle_speeds[angle]

    def _angle_speed(self, angle: int) -> Form:
        return self.form(Form(self.ring, {self.ring.angles[angle]: 1}))


@dataclass
class Evaluation:
    """Evaluates closed forms over another algebra; `values` per symbol; pi is `apply("pi")`.

    total: the sum of the terms of a form, where that is more than one addition after the other.
    """

    values: Mapping[sp.Symbol, Any]
    number: Callable[[normal.Number], Any]
    apply: Callable[..., Any]
    total: Callable[[list[Any]], Any] = partial(reduce, add)
    atoms: dict[tuple[int, int], Any] = field(default_factory=dict)
    waves: dict[tuple[Any, bool], Any] = field(default_factory=dict)

    def of(self, form: Form) -> Any:
        """The value of a form."""
        terms = [self._term(form.ring, key, c) for key, c in form.terms.items()]
        return self.total(terms) if terms else self.number(0)

    def _term(self, ring: Ring, key: Key, c: normal.Number) -> Any:
        monomial, wave, sine = key
        factors = [self._power(ring, a, e) for a, e in monomial]
        if wave:
            factors.append(self._wave(ring, wave, sine))
        if not factors:
            return self.number(c)
        product = reduce(lambda a, b: a * b, factors)
        return product if c == 1 else self.number(c) * product

    def _power(self, ring: Ring, atom: int, exponent: int) -> Any:
        if (atom, exponent) not in self.atoms:
            value = self._atom(ring, ring.atoms[atom])
            power = reduce(lambda a, b: a * b, [value] * abs(exponent))
            self.atoms[atom, exponent] = power if exponent > 0 else self.number(1) / power
        return self.atoms[atom, exponent]

    def _atom(self, ring: Ring, what: normal.Atom) -> Any:
        if what is sp.pi:
            return self.apply("pi")
        if not isinstance(what, Kernel):
            return self.values[what]
        arguments = [self.of(a) for a in what.arguments]
        return arguments[0] if what.function == "base" else self.apply(what.function, *arguments)

    def _wave(self, ring: Ring, wave: normal.Wave, sine: bool) -> Any:
        if (wave, sine) not in self.waves:
            angle = Form(ring, {ring.angles[a]: f for a, f in wave})
            self.waves[wave, sine] = self.apply("sin" if sine else "cos", self.of(angle))
        return self.waves[wave, sine]


_TO_SYMPY: dict[str, Any] = {name: function for function, name in SYMPY_FUNCTIONS.items()} | {
    "sqrt": sp.sqrt,
    "power": sp.Pow,
    "pi": lambda: sp.pi,
}


class _Symbols(dict[sp.Symbol, sp.Expr]):
    """Every symbol is its own value."""

    def __missing__(self, symbol: sp.Symbol) -> sp.Expr:
        return symbol


def to_sympy(form: Form) -> sp.Expr:
    """The form as a SymPy expression, for those who go on with SymPy."""
    return Evaluation(
        _Symbols(),
        lambda c: sp.Rational(Fraction(c).numerator, Fraction(c).denominator),
        lambda name, *a: _TO_SYMPY[name](*a),
    ).of(form)
