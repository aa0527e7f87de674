r"""Tree -> LaTeX for amsmath and KaTeX: \tfrac12, \cos\varphi, \sin^2\theta, \dot{s}."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction

from eomgen.mechanics.equations import JUMP, virtual_name
from eomgen.render.latex_names import spelled
from eomgen.render.latex_width import width
from eomgen.render.tree import Function, Number, Power, Product, Sum, Symbol, Tree, split_sign

Names = Mapping[str, str]

RAISED = {
    "sin": r"\sin", "cos": r"\cos", "tan": r"\tan",
    "sinh": r"\sinh", "cosh": r"\cosh", "tanh": r"\tanh",
}  # fmt: skip
SPELLED = RAISED | {
    "asin": r"\arcsin", "acos": r"\arccos", "atan": r"\arctan", "log": r"\ln",
    "atan2": r"\operatorname{atan2}", "sign": r"\operatorname{sgn}", "min": r"\min",
    "max": r"\max",
}  # fmt: skip
WIDE = 48.0  # figures of what cannot be broken: a fraction's sides, the inside of a root
ONE = Fraction(1)
VIRTUAL = virtual_name("")
TALL = re.compile(r"\\(?:frac|sqrt|left)")


def latex(shown: Tree, names: Names) -> str:
    """The formula on one line."""
    return _join([_signed(negative, part) for negative, part in parts(shown, names)])


def parts(shown: Tree, names: Names) -> list[tuple[bool, str]]:
    """(negative, LaTeX) of every term at the top."""
    terms = shown.terms if isinstance(shown, Sum) else (shown,)
    return [(negative, _positive(rest, names)) for negative, rest in map(split_sign, terms)]


def _signed(negative: bool, part: str) -> str:
    return f"-{part}" if negative else f"+{part}"


def _join(signed: list[str]) -> str:
    return " ".join([signed[0].removeprefix("+"), *(f"{s[0]} {s[1:]}" for s in signed[1:])])


def _positive(shown: Tree, names: Names) -> str:
    """A tree without a sign."""
    match shown:
        case Number(value):
            return number(value)
        case Symbol(name):
            return names[name] if name in names else spelled(name)
        case Function():
            return _function(shown, "", names)
        case Power():
            return _power(shown, names)
        case Product():
            return _product(shown, names)
        case Sum():
            return bracketed(latex(shown, names))


def number(value: Fraction) -> str:
    r"""7, \tfrac12, \tfrac{1}{12}."""
    if value.denominator == 1:
        return str(value.numerator)
    above, below = str(value.numerator), str(value.denominator)
    if len(above) == len(below) == 1:
        return rf"\tfrac{above}{below}"
    return rf"\tfrac{{{above}}}{{{below}}}"


def bracketed(inside: str) -> str:
    """The inside in round brackets that are as tall as it needs."""
    return rf"\left({inside}\right)" if TALL.search(inside) else f"({inside})"


def _product(shown: Product, names: Names) -> str:
    """Factors side by side; a quotient as one fraction, unless that is too wide for a line."""
    if not shown.divisors:
        return _side_by_side(shown.coefficient, shown.factors, names)
    number_above, number_below = (
        Fraction(n) for n in (shown.coefficient.numerator, shown.coefficient.denominator)
    )
    below = _side_by_side(number_below, shown.divisors, names)
    if width(below) > WIDE:
        inverses = [_inverse(d, names) for d in shown.divisors]
        return " ".join([_side_by_side(shown.coefficient, shown.factors, names), *inverses])
    above = _side_by_side(number_above, shown.factors, names)
    if width(above) <= WIDE:
        return rf"\frac{{{above}}}{{{below}}}"
    return rf"\frac{{{number(number_above)}}}{{{below}}} {_side_by_side(ONE, shown.factors, names)}"


def _inverse(divisor: Tree, names: Names) -> str:
    """(...)^{-1}, which can be broken where a denominator cannot."""
    base, exponent = (
        (divisor.base, divisor.exponent) if isinstance(divisor, Power) else (divisor, 1)
    )
    return f"{bracketed(latex(base, names))}^{{-{exponent}}}"


def _side_by_side(coefficient: Fraction, factors: tuple[Tree, ...], names: Names) -> str:
    if len(factors) == 1 and coefficient == 1 and isinstance(factors[0], Sum):
        return latex(factors[0], names)
    spelled_out = [] if coefficient == 1 and factors else [number(coefficient)]
    for i, factor in enumerate(factors):
        gap = r"\," if spelled_out and _stands_off(factor, factors[i - 1 : i]) else ""
        spelled_out.append(gap + _positive(factor, names))
    return " ".join(spelled_out)


def _stands_off(factor: Tree, before: tuple[Tree, ...]) -> bool:
    """Whether a thin space keeps the factor apart: delta s, what follows a cosine."""
    if isinstance(factor, Symbol) and factor.name.startswith((VIRTUAL, JUMP)):
        return True
    return isinstance(factor, Sum | Symbol) and any(isinstance(b, Function) for b in before)


def _power(shown: Power, names: Names) -> str:
    base = shown.base
    if isinstance(base, Function):
        if base.name in RAISED:
            return _function(base, f"^{_script(str(shown.exponent))}", names)
        if base.name == "sqrt" and shown.exponent % 2:
            inside = latex(base.arguments[0], names)
            return rf"{bracketed(inside)}^{{{shown.exponent}/2}}"
        inside = _function(base, "", names)
        return f"{bracketed(inside)}^{_script(str(shown.exponent))}"
    inside = _positive(base, names)
    # a name that has a prime or an exponent of its own takes another only in braces
    if isinstance(base, Symbol) and re.search(r"['^]", inside):
        inside = f"{{{inside}}}"
    if isinstance(base, Product):
        inside = bracketed(inside)
    return f"{inside}^{_script(str(shown.exponent))}"


def _script(text: str) -> str:
    return text if len(text) == 1 else f"{{{text}}}"


def _function(shown: Function, exponent: str, names: Names) -> str:
    arguments = [latex(a, names) for a in shown.arguments]
    match shown.name:
        case "sqrt" if width(arguments[0]) > WIDE:
            return f"{bracketed(arguments[0])}^{{1/2}}"
        case "sqrt":
            return rf"\sqrt{{{arguments[0]}}}"
        case "abs":
            return rf"\left|{arguments[0]}\right|"
        case "exp" if width(arguments[0]) > WIDE / 3:
            return rf"\exp{bracketed(arguments[0])}"
        case "exp":
            return f"e^{{{arguments[0]}}}"
        case "power":
            base = shown.arguments[0]
            inside = arguments[0] if isinstance(base, Symbol) else bracketed(arguments[0])
            return f"{{{inside}}}^{{{arguments[1]}}}"
    spelled_out = SPELLED[shown.name] + exponent
    if shown.name in RAISED and _is_bare(shown.arguments[0]):
        gap = " " if arguments[0][0].isalnum() and not exponent else ""
        return f"{spelled_out}{gap}{arguments[0]}"
    return spelled_out + bracketed(", ".join(arguments))


def _is_bare(argument: Tree) -> bool:
    """Whether the argument of a sine needs no brackets: one symbol or a multiple of one."""
    match argument:
        case Symbol():
            return True
        case Product(coefficient, factors, ()):
            plain = coefficient > 0 and coefficient.denominator == 1
            return plain and all(isinstance(f, Symbol) for f in factors)
    return False
