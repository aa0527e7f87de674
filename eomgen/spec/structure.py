"""Node tree against the language table: every wrong key or shape is entered, the rest is kept."""

import re
from collections.abc import Mapping as Map
from difflib import get_close_matches

from eomgen.spec.language import Either, Form, Items, Key, Leaf, Record, Table
from eomgen.spec.ledger import Ledger, Mistake, shown, suggestion
from eomgen.spec.reader import Entry, Mapping, Node, Scalar, Sequence

SHAPES = {Leaf: Scalar, Items: Sequence, Table: Mapping, Record: Mapping}
WORDS = {Leaf: "a text", Items: "a list", Table: "a map of names", Record: "a map of keys"}
WHOLE = re.compile("[0-9]{1,6}")
MAY_BE_EMPTY = ("quantity", "unit")  # a parameter without value, a coordinate without unit


def conform(node: Node, form: Form, ledger: Ledger, path: tuple[str, ...] = ()) -> Node | None:
    """The part of the node that has the right form; None if nothing is left."""
    match form:
        case Either(forms):
            return _either(node, forms, ledger, path)
        case Leaf() if isinstance(node, Scalar):
            return ledger.attempt(_leaf, node, form, path)
        case Items() if isinstance(node, Sequence):
            return _items(node, form, ledger, path)
        case Table() if isinstance(node, Mapping):
            return _table(node, form, ledger, path)
        case Record(keys) if isinstance(node, Mapping):
            return _record(node, dict(keys), ledger, path)
    _note_shape(node, (form,), ledger, path)
    return None


def _either(
    node: Node, forms: tuple[Form, ...], ledger: Ledger, path: tuple[str, ...]
) -> Node | None:
    fitting = next((f for f in forms if isinstance(node, SHAPES[type(f)])), None)
    if fitting is None:
        _note_shape(node, forms, ledger, path)
        return None
    return conform(node, fitting, ledger, path)


def _note_shape(node: Node, forms: tuple[Form, ...], ledger: Ledger, path: tuple[str, ...]) -> None:
    wanted = " or ".join(dict.fromkeys(WORDS[type(f)] for f in forms))
    found = {Scalar: "a text", Sequence: "a list", Mapping: "a map"}[type(node)]
    if isinstance(node, Scalar) and not node.text:
        found = "nothing"
    ledger.note(Mistake(node, "E109", f"{_named(path)} must be {wanted}, not {found}"))


def _leaf(node: Scalar, form: Leaf, path: tuple[str, ...]) -> Scalar:
    """The scalar; raises `Mistake` for an empty text or a word that is not among the choices."""
    if not node.text.strip() and form.kind not in MAY_BE_EMPTY:
        raise Mistake(node, "E109", f"{_named(path)} has no value")
    if form.choices and node.text not in form.choices:
        hint = suggestion(node.text, form.choices)
        raise Mistake(node, "E111", f"{shown(node.text)} is no value of {_named(path)}", hint)
    if form.kind == "boolean" and node.text not in ("true", "false"):
        raise Mistake(node, "E111", f"{_named(path)} is true or false, not {shown(node.text)}")
    if form.kind == "integer" and not WHOLE.fullmatch(node.text):
        raise Mistake(node, "E111", f"{_named(path)} is a whole number, not {shown(node.text)}")
    return node


def _items(node: Sequence, form: Items, ledger: Ledger, path: tuple[str, ...]) -> Node | None:
    kept = tuple(conform(item, form.of, ledger, path) for item in node.items)
    length = len(node.items)
    if length < form.least or (form.most and length > form.most):
        wanted = str(form.least) if form.least == form.most else f"at least {form.least}"
        message = f"{_named(path)} has {wanted} entries, not {length}"
        ledger.note(Mistake(node, "E109", message))
        return None
    whole = tuple(item for item in kept if item is not None)
    if isinstance(form.of, Record) or len(whole) == length:
        return Sequence(whole, node.line, node.column)
    return None


def _table(node: Mapping, form: Table, ledger: Ledger, path: tuple[str, ...]) -> Mapping:
    entries = []
    for entry in node.entries:
        key = form.keys.get(entry.key.text)
        if key is None and form.keys and isinstance(entry.value, Mapping):
            _note_unknown(entry, form.keys, ledger, path)
            continue
        inner = key.form if key else form.of
        value = conform(entry.value, inner, ledger, (*path, entry.key.text))
        if value is not None:
            entries.append(Entry(entry.key, value))
    return Mapping(tuple(entries), node.line, node.column)


def _record(
    node: Mapping, keys: dict[str, Key], ledger: Ledger, path: tuple[str, ...]
) -> Mapping | None:
    entries = []
    for entry in node.entries:
        key = keys.get(entry.key.text)
        if key is None:
            _note_unknown(entry, keys, ledger, path)
            continue
        value = conform(entry.value, key.form, ledger, (*path, entry.key.text))
        if value is not None:
            entries.append(Entry(entry.key, value))
    _note_missing(node, keys, ledger, path)
    kept = {e.key.text for e in entries}
    whole = all(name in kept for name, key in keys.items() if key.required)
    sound = len(entries) == len(node.entries)
    return Mapping(tuple(entries), node.line, node.column, sound) if whole or not path else None


def _note_unknown(entry: Entry, keys: Map[str, Key], ledger: Ledger, path: tuple[str, ...]) -> None:
    message = f"unknown key {shown(entry.key.text)}" + (f" in {path[-1]}" if path else "")
    ledger.note(Mistake(entry.key, "E104", message, suggestion(entry.key.text, keys)))


def _note_missing(
    node: Mapping, keys: dict[str, Key], ledger: Ledger, path: tuple[str, ...]
) -> None:
    for name, key in keys.items():
        if key.required and is_missing(name, node, keys):
            where = f" in {path[-1]}" if path else ""
            ledger.note(Mistake(node, "E110", f"missing key '{name}'{where}", key.about))


def is_missing(name: str, node: Mapping, keys: Map[str, Key]) -> bool:
    """Whether a key is not there, not even misspelt."""
    return node.get(name) is None and not is_misspelt(name, node, keys)


def is_misspelt(name: str, node: Mapping, keys: Map[str, Key]) -> bool:
    """Whether a key is not there but an unknown one looks like it."""
    astray = [e.key.text[:60] for e in node.entries if e.key.text not in keys]
    return node.get(name) is None and bool(get_close_matches(name, astray, 1, 0.6))


def _named(path: tuple[str, ...]) -> str:
    return f"'{'.'.join(path)}'" if path else "a spec"
