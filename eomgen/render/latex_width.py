r"""How wide a formula is printed, in figures: \frac{a}{b} is as wide as its wider part."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache

TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[^\s&]")

SCRIPT = 0.73  # size of an index
LETTERS = {  # of the italic alphabet, where they are not near to a figure
    **dict.fromkeys("ijlt", 0.7),
    **dict.fromkeys("mw", 1.7),
    **dict.fromkeys("ABCDEFGHJKLMNOPQRSTUVWXYZ", 1.4),
    **dict.fromkeys("()[]|.,'", 0.7),
    **dict.fromkeys("+-=", 2.5),
}
MACROS = {
    **dict.fromkeys((r"\sin", r"\cos", r"\tan", r"\ln", r"\min", r"\max"), 3.2),
    **dict.fromkeys((r"\arcsin", r"\arccos", r"\arctan"), 5.5),
    **dict.fromkeys((r"\left", r"\right", r"\Bigl", r"\Bigr"), 0.8),
    "\\\\": 0.0,
    r"\operatorname": 0.4, r"\quad": 2.0, r"\qquad": 4.0, r"\,": 0.35, r"\;": 0.6,
    r"\cdot": 1.4, r"\partial": 1.1,
}  # fmt: skip
WRAPPERS = frozenset(
    rf"\{name}"
    for name in (
        *("dot", "ddot", "bar", "hat", "tilde", "vec", "check", "breve", "overline", "underline"),
        *("mathrm", "mathbf", "mathit", "mathsf", "mathcal", "mathbb", "mathfrak", "boldsymbol"),
        *("widehat", "widetilde", "text"),
    )
)


@lru_cache(maxsize=4096)
def width(formula: str) -> float:
    """About how many figures wide the formula is printed."""
    tokens = TOKEN.findall(formula)
    total, at = 0.0, 0
    while at < len(tokens):
        wide, at = _unit(tokens, at)
        total += wide
    return total


def _unit(tokens: list[str], at: int) -> tuple[float, int]:
    """(width, end) of one letter, group, fraction or script; nothing at the end of the line."""
    if at >= len(tokens):
        return 0.0, at
    token = tokens[at]
    known = CONSTRUCTIONS.get(token)
    if known is not None:
        return known(tokens, at + 1)
    if token in WRAPPERS:
        return _unit(tokens, at + 1)
    return LETTERS.get(token, MACROS.get(token, 1.1 if token[0] == "\\" else 1.0)), at + 1


def _group(tokens: list[str], at: int) -> tuple[float, int]:
    """The inside of braces, from behind the first."""
    total = 0.0
    while at < len(tokens) and tokens[at] != "}":
        wide, at = _unit(tokens, at)
        total += wide
    return total, at + 1


def _script(tokens: list[str], at: int) -> tuple[float, int]:
    wide, end = _unit(tokens, at)
    return SCRIPT * wide, end


def _fraction(tokens: list[str], at: int) -> tuple[float, int]:
    above, at = _unit(tokens, at)
    below, at = _unit(tokens, at)
    return max(above, below) + 0.4, at


def _small_fraction(tokens: list[str], at: int) -> tuple[float, int]:
    wide, at = _fraction(tokens, at)
    return SCRIPT * wide, at


def _root(tokens: list[str], at: int) -> tuple[float, int]:
    wide, at = _unit(tokens, at)
    return wide + 1.6, at


CONSTRUCTIONS: dict[str, Callable[[list[str], int], tuple[float, int]]] = {
    "{": _group,
    "_": _script,
    "^": _script,
    r"\frac": _fraction,
    r"\tfrac": _small_fraction,
    r"\sqrt": _root,
}
