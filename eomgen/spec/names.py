"""The names of a file, all in one space: each is declared once, before any formula is read."""

from collections.abc import Iterable

import sympy as sp

from eomgen.dimension import LENGTH, NONE, TIME
from eomgen.model import TIME as T
from eomgen.spec import quaternions
from eomgen.spec.formula import NAME, RESERVED
from eomgen.spec.formulas import field, text_of
from eomgen.spec.language import LANGUAGE
from eomgen.spec.ledger import Ledger, Mistake, shown
from eomgen.spec.reader import Entry, Mapping, Node, Scalar
from eomgen.spec.scope import PRIMES, Known
from eomgen.spec.structure import is_misspelt

MOST_CHARACTERS = 60
WORLD = "world"  # the axes that are no body's
WORDS = frozenset((*RESERVED, WORLD))  # of the language
KINDS = {  # key of the file -> kind of name, number of derivatives it has
    "parameters": ("parameter", 0),
    "coordinates": ("coordinate", 2),
    "speeds": ("speed", 1),
    "prescribed": ("prescribed", 2),
    "inputs": ("input", 0),
    "points": ("point", 0),
    "bodies": ("body", 0),
}
BUILT_IN = {
    "t": Known("time", (T,), TIME),
    "pi": Known("constant", (sp.pi,), NONE),
}


def declare(root: Mapping, ledger: Ledger) -> dict[str, Known]:
    """Every name of the file with its symbols; those that are wrong or taken are entered."""
    names = dict(BUILT_IN)
    for section, (kind, orders) in KINDS.items():
        table = root.get(section)
        for entry in table.entries if isinstance(table, Mapping) else ():
            for key, known in _declared(entry, kind, orders):
                if ledger.attempt(check, key, names) is not None:
                    names[key.text] = known
    return names


def _declared(entry: Entry, kind: str, orders: int) -> Iterable[tuple[Scalar, Known]]:
    if kind == "coordinate" and quaternions.is_quaternion(entry.value):
        return quaternions.declared(entry.key)
    return [(entry.key, _known(entry.key, entry.value, kind, orders))]


def are_complete(root: Mapping) -> bool:
    """Whether every name that the author meant could be declared."""
    if any(is_misspelt(section, root, LANGUAGE.keys) for section in KINDS):
        return False
    tables = [root.get(section) for section in KINDS]
    shaped = all(table is None or isinstance(table, Mapping) for table in tables)
    return shaped and root.get("coordinates") is not None


def check(key: Scalar, names: dict[str, Known]) -> Scalar:
    """The key, if it is free and a proper name; else raises `Mistake`."""
    name = key.text
    check_spelling(key)
    if name in names:
        first = names[name]
        line = f" on line {first.spot.line}" if first.spot else ""
        message = f"name '{name}' is already taken by the {first.kind}{line}"
        raise Mistake(key, "E303", message, "choose another name")
    return key


def check_spelling(key: Scalar) -> None:
    """Raise `Mistake` where the key is no proper name."""
    name = key.text
    if name in WORDS:
        raise Mistake(key, "E304", f"'{name}' is a word of the language", "choose another name")
    if not NAME.fullmatch(name) or len(name) > MOST_CHARACTERS:
        hint = "letters, digits and '_', a letter first"
        if name[:1].isdigit():  # {m: 0,1 kg} reads as {m: 0, 1 kg: }
            hint += "; decimals take a point"
        raise Mistake(key, "E304", f"{shown(name)} is not a name", hint)


def _known(key: Scalar, value: Node, kind: str, orders: int) -> Known:
    positive = text_of(field(value, "positive")) == "true"
    first = sp.Symbol(key.text, positive=True) if positive else sp.Symbol(key.text, real=True)
    rates = [sp.Symbol(key.text + prime, real=True) for prime in PRIMES[1 : orders + 1]]
    dimension = LENGTH if kind in ("point", "body") else None
    return Known(kind, (first, *rates), dimension, key)
