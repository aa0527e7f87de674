r"""LaTeX of names: theta_1 is \theta_1, m_cart has an upright word as index, rates carry dots.

A spec may override the LaTeX of a name.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Mapping

from eomgen.latex_name import GREEK, checked
from eomgen.mechanics import motions
from eomgen.mechanics.equations import jump_name, virtual_name
from eomgen.model import Coordinate, Input, Model, Parameter, Prescribed

LIKE_LATIN = {
    "omicron": "o", "Alpha": "A", "Beta": "B", "Epsilon": "E", "Zeta": "Z", "Eta": "H",
    "Iota": "I", "Kappa": "K", "Mu": "M", "Nu": "N", "Omicron": "O", "Rho": "P", "Tau": "T",
    "Chi": "X",
}  # fmt: skip
DOTS = ("", r"\dot", r"\ddot")


def spelled(name: str) -> str:
    """The LaTeX of a name by its spelling: l1 and l_1 are l_1, m_cart has an upright index."""
    plain = name.strip("_")
    found = re.fullmatch(r"([^\W\d_]+)(\d*)((?:_\w+)?)", plain)
    if not found:
        return rf"\mathrm{{{plain.replace('_', ' ')}}}"
    word, digits, rest = found.groups()
    indices = [i for i in (digits, *rest.split("_")) if i]
    shown = ",".join(_index(i) for i in indices)
    if not indices:
        return _word(word)
    return (
        f"{_word(word)}_{shown}" if len(shown) == 1 or _one(shown) else f"{_word(word)}_{{{shown}}}"
    )


def _one(shown: str) -> bool:
    """Whether TeX takes it as one token."""
    return re.fullmatch(r"\w|\\[A-Za-z]+", shown) is not None


def _index(text: str) -> str:
    """One index: a digit string, a letter, a Greek letter, or an upright word."""
    return text if text.isdecimal() else _word(text)


def _word(word: str) -> str:
    """A single letter, a Greek letter, or an upright word."""
    word = "".join(latin_letters(c) for c in word)
    if word in GREEK:
        return rf"\{word}"
    word = LIKE_LATIN.get(word, word)
    return word if len(word) == 1 else rf"\mathrm{{{word}}}"


def latin_letters(character: str) -> str:
    """A Greek character by its name, other letters without their accents."""
    name = unicodedata.name(character, "")
    found = re.fullmatch(r"GREEK (SMALL|CAPITAL) LETTER (\w+)", name)
    if found:
        letter = found[2].lower().replace("lamda", "lambda")
        return letter if found[1] == "SMALL" else letter.capitalize()
    return unicodedata.normalize("NFD", character)[0]


def dotted(name: str, dots: int) -> str:
    r"""\dot{q}_1: the dots stand over the letter, not over its index."""
    if not dots:
        return name
    letter = re.match(r"\\(?:[a-z]+)\{[^{}]*\}|\\[A-Za-z]+|.", name)
    assert letter is not None
    body = letter.group()
    return f"{DOTS[dots]}{{{body}}}{name[len(body) :]}"


def unknown(name: str) -> str:
    """A name that is no symbol of the model: delta W, omega."""
    bare = name.removeprefix(virtual_name(""))
    return spelled(name) if bare == name else rf"\delta {spelled(bare)}"


def table(model: Model) -> Mapping[str, str]:
    """The LaTeX of every symbol of a model by the symbol's name."""
    names = {"t": "t", "pi": r"\pi"}
    for symbol, spelling, dots in _symbols(model):
        names[symbol] = dotted(spelling, dots)
    for c in model.coordinates:
        names[virtual_name(c.name)] = rf"\delta {names[c.symbol.name]}"
        names[jump_name(c.name)] = rf"\Delta {names[c.rate.name]}"
    for q in model.quaternions:
        for i, axis in enumerate(motions.AXES):
            name = motions.turn_name(q, i)
            names[name] = rf"\pi_{{{spelled(q.name)},{axis}}}"
            names[virtual_name(name)] = rf"\delta {names[name]}"
    return names


def _symbols(model: Model) -> Iterator[tuple[str, str, int]]:
    """(symbol, LaTeX of its name, number of dots)."""
    plain: list[Parameter | Input] = [*model.parameters, *model.inputs]
    places: list[Coordinate | Prescribed] = [*model.coordinates, *model.prescribed]
    for record in plain:
        yield record.symbol.name, of_record(record.name, record.description.latex), 0
    for place in places:
        spelling = of_record(place.name, place.description.latex)
        yield place.symbol.name, spelling, 0
        yield place.rate.name, spelling, 1
        yield place.acceleration.name, spelling, 2
    for speed in model.speeds:
        if speed.symbol == speed.formula:
            continue  # a rate, which is spelled above
        spelling = of_record(speed.name, speed.description.latex)
        yield speed.symbol.name, spelling, 0
        yield speed.rate.name, spelling, 1


def of_record(name: str, override: str | None) -> str:
    """The override where the author gave one, else the name by its spelling."""
    return spelled(name) if override is None else checked(name, override)
