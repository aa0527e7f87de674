"""Long formulas in lines: broken before a plus or minus, outside of brackets if that can be."""

from __future__ import annotations

from collections.abc import Callable, Iterator

Width = Callable[[str], float]
Break = Callable[[str], list[str]]

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
    if width(formula) <= limit:
        return [formula]
    places = [*breaks(formula), (len(formula), 0)]
    starts = [0, *(at + 1 for at, _ in places)]
    widths = [width(formula[a : at + 1]) for a, (at, _) in zip(starts, places, strict=False)]
    result, start = [], 0
    while start < len(places):
        end = _end(widths, [depth for _, depth in places], start, limit)
        result.append(formula[starts[start] : places[end - 1][0]])
        start = end
    return result


def equation(left: str, right: str, fits: Break, *, is_long: bool) -> list[str]:
    """left = right in lines that `fits` makes; a right side is not torn where it need not be.

    is_long: the left side fills a line well enough to stand alone.
    """
    whole = fits(f"{left} = {right}")
    apart = [*fits(left), *fits(f"= {right}")]
    torn = not any(line.endswith(f"= {right}") for line in whole)
    return apart if torn and is_long and len(apart) <= len(whole) else whole


def _end(widths: list[float], depths: list[int], start: int, limit: float) -> int:
    """How far a line goes: to the last outer break that fills half of it, else to the last."""
    if sum(widths[start:]) <= limit:
        return len(widths)
    ends: list[tuple[int, float]] = []
    total = 0.0
    for i in range(start, len(widths)):
        total += widths[i]
        if total > limit and ends:
            break
        ends.append((i + 1, total))
    good = [end for end, filled in ends if filled >= limit / 2] or [end for end, _ in ends]
    outer = min(depths[end - 1] for end in good)
    return max(end for end in good if depths[end - 1] == outer)
