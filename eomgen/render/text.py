"""Tree -> Unicode text that every terminal shows: φ″, s′², ½ k (s − l_0)², √(x² + y²)."""

from __future__ import annotations

import re
from fractions import Fraction

from eomgen.mechanics.equations import JUMP, virtual_name
from eomgen.render.tree import Function, Number, Power, Product, Sum, Symbol, Tree, split_sign

MINUS = "\u2212"
SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
PRIMES = {1: "′", 2: "″"}
VULGAR = {Fraction(1, 2): "½", Fraction(1, 4): "¼", Fraction(3, 4): "¾"}
GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "varepsilon": "ε",
    "zeta": "ζ", "eta": "η", "theta": "θ", "vartheta": "ϑ", "iota": "ι", "kappa": "κ",
    "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "omicron": "ο", "pi": "π", "rho": "ρ",
    "sigma": "σ", "tau": "τ", "upsilon": "υ", "phi": "φ", "varphi": "φ", "chi": "χ", "psi": "ψ",
    "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ", "Lambda": "Λ", "Xi": "Ξ", "Pi": "Π",
    "Sigma": "Σ", "Upsilon": "Υ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω",
}  # fmt: skip
NAMES = {"sqrt": "√", "log": "ln"}
RAISED = ("sin", "cos", "tan", "sinh", "cosh", "tanh")  # sin²θ, not (sin θ)²
VIRTUAL = virtual_name("")


def name(spelling: str) -> str:
    """A name of the spec: theta_1' as θ_1′, delta s as δs, the change of a rate as Δs′."""
    if spelling.startswith(VIRTUAL):
        return "δ" + name(spelling.removeprefix(VIRTUAL))
    if spelling.startswith(JUMP):
        return "Δ" + name(f"{spelling.removeprefix(JUMP)}'")
    plain = spelling.rstrip("'")
    primes = len(spelling) - len(plain)
    words = re.sub(r"[^\W\d_]+", lambda found: GREEK.get(found.group(), found.group()), plain)
    return words + PRIMES.get(primes, "′" * primes)


def text(shown: Tree) -> str:
    """The formula on one line."""
    match shown:
        case Number(value):
            return _signed(value < 0, _number(abs(value)))
        case Symbol(spelling):
            return name(spelling)
        case Function():
            return _function(shown, "")
        case Power():
            return _power(shown)
        case Product():
            negative, rest = split_sign(shown)
            return _signed(negative, _product(rest) if isinstance(rest, Product) else text(rest))
        case Sum(terms):
            return terms_joined(terms)


def terms_joined(terms: tuple[Tree, ...]) -> str:
    """The terms with + and − between them."""
    parts = [(negative, text(rest)) for negative, rest in map(split_sign, terms)]
    first = _signed(*parts[0])
    return first + "".join(f" {MINUS if minus else '+'} {t}" for minus, t in parts[1:])


def _signed(negative: bool, shown: str) -> str:
    return MINUS + shown if negative else shown


def _number(value: Fraction) -> str:
    return VULGAR.get(value, str(value))


def _product(shown: Product) -> str:
    """Factors by spaces; what is divided by stands behind the stroke, in brackets if need be."""
    number = [_number(shown.coefficient)] if shown.coefficient != 1 else []
    above = " ".join(number + [_factor(f) for f in shown.factors]) or "1"
    if not shown.divisors:
        return above
    below = " ".join(_factor(d) for d in shown.divisors)
    return f"{above}/({below})" if " " in _outside(below) else f"{above}/{below}"


def _outside(shown: str) -> str:
    """The text without what stands in brackets."""
    while (shorter := re.sub(r"\([^()]*\)", "", shown)) != shown:
        shown = shorter
    return shown


def _factor(shown: Tree) -> str:
    """A factor; sums and products in brackets."""
    return f"({text(shown)})" if isinstance(shown, Sum | Product) else text(shown)


def _power(shown: Power) -> str:
    """cos² φ, (s − l_0)²; a function that takes no exponent stands in brackets."""
    exponent = str(shown.exponent).translate(SUPERSCRIPTS)
    base = shown.base
    if isinstance(base, Function) and base.name in RAISED:
        return _function(base, exponent)
    bare = isinstance(base, Function) and base.name in ("sqrt", "abs")
    inside = f"({text(base)})" if isinstance(base, Function) and not bare else _factor(base)
    return inside + exponent


def _function(shown: Function, exponent: str) -> str:
    """cos φ, sin²θ, cos(q1 − q2), √(x² + y²), |v|."""
    arguments = ", ".join(text(a) for a in shown.arguments)
    if shown.name == "abs":
        return f"|{arguments}|"
    if shown.name == "power":
        base, power = shown.arguments
        return f"{_factor(base)}^({text(power)})"
    spelled = NAMES.get(shown.name, shown.name) + exponent
    if shown.name in RAISED and isinstance(shown.arguments[0], Symbol):
        return f"{spelled} {arguments}"
    return f"{spelled}({arguments})"
