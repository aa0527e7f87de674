"""How a page is spelled, in LaTeX or in plain text: the one thing in which the two differ."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from eomgen.render.tree import Tree

Rows = Sequence[tuple[str, str]]  # (left side, right side) of equations below each other


@dataclass(frozen=True)
class Style:
    """Spells trees, names, derivatives and displays; every function returns finished text."""

    formula: Callable[[Tree], str]
    symbol: Callable[[str], str]  # the name of a symbol: s, s', delta s
    words: Callable[[str], str]  # a text of the user
    unit: Callable[[str], str]
    inline: Callable[[str], str]  # a formula inside of a sentence
    number: Callable[[str], str]  # a decimal number
    index: Callable[..., str]  # T, bob: T_bob; names of bodies and points
    sub: Callable[[str, str], str]  # Q, spelled symbol: Q_s
    dotted: Callable[[str], str]  # x_bob: its rate
    accelerated: Callable[[str], str]  # x_bob: its second rate
    after: Callable[[str], str]  # a rate after an impact
    before: Callable[[str], str]  # and before it
    size: Callable[[str], str]  # |F_t|
    sign: Callable[[str], str]  # the sign of v_t
    fraction: Callable[[str, str], str]  # v_t / |v_t|
    partial: Callable[[str, str], str]  # dL/ds
    rate: Callable[[str], str]  # d/dt (...)
    gyroscopic: Callable[[str, str], str]  # (w x dL/dw) of a quaternion, about one of its axes
    display: Callable[[Rows], str]  # equations below each other, long ones broken
    pairs: Callable[[Sequence[Rows]], str]  # equations beside each other
    equation: Callable[[str, str], str]  # left = right, broken anywhere
    at_least: Callable[[str, str], str]  # left >= right, broken anywhere
    matrix: Callable[[Sequence[Sequence[str]]], str]
    fits: Callable[[Sequence[Sequence[str]]], bool]  # whether a matrix goes on a line
    remark: Callable[[str], str]  # words in place of a formula
