"""Long formulas in lines: broken before a plus or minus, outside of brackets if that can be."""

from __future__ import annotations

from collections.abc import Callable, Iterator

Width = Callable[[str], float]

OPENING, CLOSING = "([{", ")]}"


def breaks(formula: str) -> Iterator[tuple[int, int]]:
    r"""(position of the blank before a sign, depth in round brackets) where a line may end.

    Never inside of braces, of square brackets or of \left ... \right.
    """
    round_depth = fixed_depth = 0
    for i, c in enumerate(formula):
        tall = formula.endswith((r"\left", r"\right"), 0, i)
        if c in "([{|" and formula.endswith(r"\left", 0, i):
            fixed_depth += 1
        elif c in ")]}|" and formula.endswith(r"\right", 0, i):
            fixed_depth -= 1
        elif c in "[{" and not tall:
            fixed_depth += 1
        elif c in "]}" and not tall:
            fixed_depth -= 1
        elif c in "()":
            round_depth += 1 if c == "(" else -1
        elif c == " " and not fixed_depth and formula[i + 1 : i + 3] in ("+ ", "- ", "\u2212 "):
            yield i, round_depth


def lines(formula: str, limit: float, width: Width) -> list[str]:
    """The formula in lines of at most `limit`, as far as its signs allow."""
    result = []
    while width(formula) > limit:
        at = _best(formula, limit, width)
        if at is None:
            break
        result.append(formula[:at])
        formula = formula[at + 1 :]
    return [*result, formula]


def _best(formula: str, limit: float, width: Width) -> int | None:
    """The last break that fits, an outer one if it fills half of the line; else the first."""
    places = list(breaks(formula))
    fitting = [(i, depth) for i, depth in places if width(formula[:i]) <= limit]
    good = [(i, depth) for i, depth in fitting if width(formula[:i]) >= limit / 2]
    for candidates in (good, fitting):
        if candidates:
            outer = min(depth for _, depth in candidates)
            return max(i for i, depth in candidates if depth == outer)
    return places[0][0] if places else None
