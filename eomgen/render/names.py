"""Names that a target accepts: escaped where it reserves them, each once, by declaration."""

import keyword
import sys
from collections.abc import Iterable


def identifier(name: str) -> str:
    """A plain ASCII identifier: phi' becomes phi_dot, a letter outside ASCII its code point."""
    if name.isascii() and name.isidentifier() and name[0] != "_":
        return name
    plain = "".join(_character(c) for c in name.replace("'", "_dot"))
    return plain if plain[:1].isalpha() else f"n{plain}"


def _character(character: str) -> str:
    if character.isascii():
        return character if character.isalnum() else "_"
    return f"u{ord(character):04x}"


def escaped(names: Iterable[str], reserved: Iterable[str]) -> tuple[str, ...]:
    """The identifiers of `names`, with `_` behind one that is reserved or already taken."""
    taken = set(reserved)
    found = []
    for name in names:
        spelling = identifier(name)
        while spelling in taken:
            spelling += "_"
        taken.add(spelling)
        found.append(spelling)
    return tuple(found)


def prefix(name: str) -> str:
    """What the names of a program's C code begin with."""
    return identifier(name)


def module(name: str) -> str:
    """The name of a program's Python module: none that Python or NumPy would take for their own."""
    return escaped([name], [*keyword.kwlist, "numpy", *sys.stdlib_module_names])[0]
