"""Functions of the language on closed forms: what evaluates, what becomes a kernel, derivatives."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import isqrt

import sympy as sp

from eomgen.algebra import normal
from eomgen.algebra.normal import ONE, Form, Kernel, Ring, Wave, number, of_atom, split_content


def constant(form: Form) -> normal.Number | None:
    """The value of a form that is a rational number, else None."""
    if not form.terms:
        return 0
    return form.terms.get(ONE) if len(form.terms) == 1 else None


def kernel(name: str, *arguments: Form) -> Form:
    """The function as an opaque atom."""
    return of_atom(arguments[0].ring, Kernel(name, arguments))


def wave_of(angle: Form) -> Wave:
    """The angles of an argument, each term of it being one."""
    ring = angle.ring
    return tuple(sorted((ring.angle(key), c) for key, c in angle.terms.items()))


def _quarter_turns(angle: Form) -> tuple[Form, int]:
    """(rest, k) with angle = rest + k pi/2 and k the whole number of quarter turns."""
    ring = angle.ring
    key = next(iter(of_atom(ring, sp.pi).terms))
    quarters = Fraction(angle.terms.get(key, 0)) * 2
    whole = quarters.numerator // quarters.denominator
    return angle - of_atom(ring, sp.pi) * Fraction(whole, 2), whole % 4


def _wave(angle: Form, sine: bool) -> Form:
    ring = angle.ring
    rest, quarter = _quarter_turns(angle)
    # sin(x + pi/2) = cos x, cos(x + pi/2) = -sin x
    if quarter % 2:
        sine, quarter = not sine, quarter + (0 if sine else 1)
    sign = -1 if quarter % 4 >= 2 else 1
    wave, orientation = normal.oriented(wave_of(rest))
    if not wave:
        return number(ring, 0 if sine else sign)
    return Form(ring, {((), wave, sine): sign * (orientation if sine else 1)})


def sin(angle: Form) -> Form:
    """The sine, exact at multiples of pi/2."""
    return _wave(angle, True)


def cos(angle: Form) -> Form:
    """The cosine, exact at multiples of pi/2."""
    return _wave(angle, False)


def _root_of_number(value: Fraction) -> tuple[Fraction, int]:
    """(a, b) with sqrt(value) = a sqrt(b), b a whole number without square factors below 1000."""
    whole = value.numerator * value.denominator
    outside, inside = Fraction(1, value.denominator), whole
    root = isqrt(inside)
    if root * root == inside:
        return outside * root, 1
    for factor in range(2, 1000):
        while inside % factor**2 == 0:
            outside, inside = outside * factor, inside // factor**2
    return outside, inside


def sqrt(form: Form) -> Form:
    """The root; positive symbols and square numbers come out of it."""
    ring = form.ring
    if not form.terms:
        return form
    content, rest = split_content(form)
    (((monomial, _, _), c),) = content.terms.items()
    if c < 0:
        c, rest = -c, -rest
    outside, inside = _root_of_number(Fraction(c))
    result = number(ring, outside)
    inner = rest * inside
    for atom, exponent in monomial:
        what = ring.atoms[atom]
        positive = isinstance(what, sp.Symbol) and what.is_positive
        half, odd = divmod(exponent, 2) if positive else (0, exponent)
        result = result * of_atom(ring, what, half) if half else result
        inner = inner * of_atom(ring, what, odd) if odd else inner
    return result if inner.terms == {ONE: 1} else result * _squared_kernel("sqrt", inner, inner)


def _squared_kernel(name: str, argument: Form, square: Form) -> Form:
    """A kernel whose square is known to the ring."""
    result = kernel(name, argument)
    (((((atom, _),), _, _), _),) = result.terms.items()
    argument.ring.squares.setdefault(atom, square)
    return result


def absolute(form: Form) -> Form:
    """|form|; a positive symbol or number is its own."""
    value = constant(form)
    if value is not None:
        return number(form.ring, value if value > 0 else -value)
    if _is_positive(form):
        return form
    return _squared_kernel("abs", form, form * form)


def sign(form: Form) -> Form:
    """The sign; decided for numbers and positive symbols."""
    value = constant(form)
    if value is not None:
        return number(form.ring, (value > 0) - (value < 0))
    return number(form.ring, 1) if _is_positive(form) else kernel("sign", form)


def _is_positive(form: Form) -> bool:
    return bool(form.terms) and all(
        c > 0 and not wave and all(_positive_atom(form.ring.atoms[a]) for a, _ in monomial)
        for (monomial, wave, _), c in form.terms.items()
    )


def _positive_atom(atom: normal.Atom) -> bool:
    return atom.function in ("sqrt", "exp") if isinstance(atom, Kernel) else bool(atom.is_positive)


def _cosh(form: Form) -> Form:
    s = kernel("sinh", form)
    return _squared_kernel("cosh", form, s * s + 1)


def _zero_at_zero(name: str, at_zero: int = 0) -> Callable[[Form], Form]:
    """The kernel, but for its known value at zero."""

    def function(form: Form) -> Form:
        return kernel(name, form) if form.terms else number(form.ring, at_zero)

    return function


def _log(form: Form) -> Form:
    return number(form.ring, 0) if constant(form) == 1 else kernel("log", form)


FUNCTIONS: dict[str, Callable[..., Form]] = {
    "sin": sin,
    "cos": cos,
    "tan": lambda a: sin(a) / cos(a),
    "sqrt": sqrt,
    "abs": absolute,
    "sign": sign,
    "cosh": _cosh,
    "log": _log,
    "exp": _zero_at_zero("exp", 1),
    **{name: _zero_at_zero(name) for name in ("asin", "atan", "sinh", "tanh")},
    **{name: (lambda *a, name=name: kernel(name, *a)) for name in ("acos", "atan2", "min", "max")},
    "power": lambda a, b: kernel("power", a, b),
}


def apply(name: str, *arguments: Form) -> Form:
    """A function of the language on closed forms."""
    return FUNCTIONS[name](*arguments)


def _step(a: Form, b: Form) -> Form:
    """1 where a > b, 0 where a < b."""
    return (sign(a - b) + 1) * Fraction(1, 2)


# kernel -> its partial derivatives with respect to its arguments, the kernel itself coming first
DERIVATIVES: dict[str, Callable[..., tuple[Form, ...]]] = {
    "base": lambda f, a: (number(a.ring, 1),),
    "sqrt": lambda f, a: (normal.inverse(f) * Fraction(1, 2),),
    "abs": lambda f, a: (sign(a),),
    "sign": lambda f, a: (number(a.ring, 0),),
    "exp": lambda f, a: (f,),
    "log": lambda f, a: (normal.inverse(a),),
    "sinh": lambda f, a: (_cosh(a),),
    "cosh": lambda f, a: (kernel("sinh", a),),
    "tanh": lambda f, a: (1 - f * f,),
    "asin": lambda f, a: (normal.inverse(sqrt(1 - a * a)),),
    "acos": lambda f, a: (-normal.inverse(sqrt(1 - a * a)),),
    "atan": lambda f, a: (normal.inverse(1 + a * a),),
    "atan2": lambda f, y, x: (x / (x * x + y * y), -y / (x * x + y * y)),
    "min": lambda f, a, b: (_step(b, a), _step(a, b)),
    "max": lambda f, a, b: (_step(a, b), _step(b, a)),
    "power": lambda f, a, b: (b * f / a, f * kernel("log", a)),
}


def partials(ring: Ring, what: Kernel) -> tuple[Form, ...]:
    """D kernel / d argument for each argument."""
    return DERIVATIVES[what.function](of_atom(ring, what), *what.arguments)
