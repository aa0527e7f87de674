"""What people wrote, made safe for LaTeX: nothing of a title, a remark or a unit is a macro."""

from __future__ import annotations

import re

from eomgen.latex_name import GREEK
from eomgen.render.latex_names import latin_letters

SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "\u00b0": r"\ensuremath{^\circ}",
    "\u00b2": r"\ensuremath{^2}",
    "\u00b3": r"\ensuremath{^3}",
    "\u00b5": r"\ensuremath{\mu}",
    "\u00b7": r"\ensuremath{\cdot}",
    "\u00d7": r"\ensuremath{\times}",
    "\u2212": r"\ensuremath{-}",
    "\u2192": r"\ensuremath{\to}",
    "\u2264": r"\ensuremath{\le}",
    "\u2265": r"\ensuremath{\ge}",
    "\u2248": r"\ensuremath{\approx}",
    "\u221e": r"\ensuremath{\infty}",
}
# what fontenc T1 with inputenc utf8 prints: ASCII, Western and Central European letters, quotes
PRINTED = re.compile(
    "[ -~\u00a1\u00a3\u00a7\u00ab\u00bb\u00bf-\u017e\u2013\u2014\u2018-\u201e\u2026]"
)
UNIT = re.compile(r"[A-Za-z]+|\d+|\*\*|[\^+*/().% -]|[\u00b0\u00b5\u03bc\u03a9\u00b7]")
UNIT_SIGNS = {
    "*": r"\,", " ": r"\,", "\u00b7": r"\,", "**": "^", "%": r"\%", "\u00b0": r"{}^\circ",
    "\u00b5": r"\mu ", "\u03bc": r"\mu ", "\u03a9": r"\Omega ", "Ohm": r"\Omega ",
}  # fmt: skip


def escaped(text: str) -> str:
    """The text as LaTeX prints it word for word, white space as single blanks."""
    return "".join(_character(c) for c in " ".join(text.split()))


def _character(character: str) -> str:
    if character in SPECIAL:
        return SPECIAL[character]
    if PRINTED.fullmatch(character):
        return character
    letter = latin_letters(character)
    if letter in GREEK:
        return rf"\ensuremath{{\{letter}}}"
    # no font of the page has it: its code point says what was there
    return f"[U+{ord(character):04X}]"


def unit(text: str) -> str:
    r"""A unit in math mode: N*s/m is \mathrm{N\,s/m}, m/s^2 is \mathrm{m/s^{2}}."""
    plain = re.sub(r"\s*([*/^()])\s*", r"\1", " ".join(text.split()))
    tokens = UNIT.findall(plain)
    if "".join(tokens) != plain:
        return rf"\text{{{escaped(text)}}}"
    spelled = "".join(UNIT_SIGNS.get(t, t) for t in tokens)
    raised = re.sub(r"\^([+-]?\d+)", r"^{\1}", spelled)
    # half an exponent or two in a row would stop TeX
    if re.search(r"\^(?!\{)|\}\^", raised):
        return rf"\text{{{escaped(text)}}}"
    return rf"\mathrm{{{raised}}}" if raised else ""
