r"""Names of Lagrange's multipliers: one is \lambda, several \lambda_{loop,x}, or \lambda_1, ..."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from eomgen.mechanics.equations import Derivation, multiplier_name
from eomgen.render import latex_names
from eomgen.render.latex_width import width
from eomgen.render.style import Style
from eomgen.render.tree import Function, Number, Power, Product, Sum, Symbol, Tree

WIDEST = 6.0  # figures of a multiplier that is named after its row

Aliases = Mapping[str, str]  # the symbol of a multiplier -> the name under which it is shown


def aliases(derivation: Derivation) -> Aliases:
    """How the multipliers are called: the shortest way that no name of the scene is taken by."""
    symbols = [multiplier_name(row.name) for row in derivation.constraints]
    taken = set(latex_names.table(derivation.model).values())
    for names in _proposals([row.name for row in derivation.constraints]):
        spelled = [latex_names.spelled(n) for n in names]
        if len(set(spelled)) == len(symbols) and taken.isdisjoint(spelled):
            return dict(zip(symbols, names, strict=True))
    return dict(zip(symbols, symbols, strict=True))


def _proposals(rows: list[str]) -> Iterator[list[str]]:
    """Names for all multipliers, the best first."""
    if len(rows) == 1:
        yield ["lambda"]
    named = ["lambda_" + row.replace(".", "_") for row in rows]
    numbered = [f"lambda_{i}" for i in range(1, len(rows) + 1)]
    is_long = any(width(latex_names.spelled(n)) > WIDEST for n in named)
    yield from (numbered, named) if is_long else (named, numbered)


def with_multipliers(style: Style, names: Aliases) -> Style:
    """The style that calls the multipliers so."""
    if not names:
        return style
    return replace(
        style,
        formula=lambda shown: style.formula(renamed(shown, names)),
        symbol=lambda name: style.symbol(names.get(name, name)),
    )


def renamed(shown: Tree, names: Aliases) -> Tree:
    """The tree with other names for some symbols."""
    match shown:
        case Symbol(name):
            return Symbol(names.get(name, name))
        case Function(name, arguments):
            return Function(name, tuple(renamed(a, names) for a in arguments))
        case Power(base, exponent):
            return Power(renamed(base, names), exponent)
        case Product(coefficient, factors, divisors):
            above, below = (tuple(renamed(f, names) for f in s) for s in (factors, divisors))
            return Product(coefficient, above, below)
        case Sum(terms):
            return Sum(tuple(renamed(t, names) for t in terms))
        case Number():
            return shown
