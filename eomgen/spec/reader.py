"""YAML text -> a tree of plain text with line and column of every key and value.

Only the event stream is used: it is iterative and stops at the first event past a limit. Nothing
is converted: `on`, `1e-3` and `010` stay the text that the author wrote.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import yaml

from eomgen.spec.ledger import Ledger, Mistake, Spot, shown

MOST_BYTES = 256 * 1024
MOST_DEPTH = 40
MOST_NODES = 20_000

SYNTAX_HINTS = {  # word in the message -> remedy
    "\\t": "indent with spaces",
    "end of stream": "close the quote or bracket",
    "flow": "inside { } and [ ] put a formula that holds , : [ or # in quotes",
    "mapping values": "put a text that holds ': ' in quotes",
}
LINE_BREAK = re.compile("\r\n|[\r\n\x85\u2028\u2029]")
UNPRINTABLE = re.compile(
    "[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]"
)


@dataclass(frozen=True)
class Scalar:
    """A text; `exact`: its characters stand in the file one by one from `column` on."""

    text: str
    line: int
    column: int
    plain: bool = True
    exact: bool = True


@dataclass(frozen=True)
class Sequence:
    """A list of nodes."""

    items: tuple["Node", ...]
    line: int
    column: int


@dataclass(frozen=True)
class Entry:
    """One key with its value."""

    key: Scalar
    value: "Node"


@dataclass(frozen=True)
class Mapping:
    """Entries in the order of the file, every key once; `whole`: none was wrong and left out."""

    entries: tuple[Entry, ...]
    line: int
    column: int
    whole: bool = True

    def get(self, name: str) -> "Node | None":
        """The value of a key, or None."""
        return next((e.value for e in self.entries if e.key.text == name), None)


Node = Scalar | Sequence | Mapping


@dataclass(frozen=True)
class Point:
    """A bare position in the text."""

    line: int
    column: int


def decode(data: str | bytes) -> str:
    """The text of the file; raises `Mistake` where it is too long or no printable UTF-8."""
    if len(data) > MOST_BYTES:
        limit = f"a spec has at most {MOST_BYTES} bytes"
        raise Mistake(Point(1, 1), "E102", f"the file is too large: {limit}")
    try:
        text = data.decode("utf-8-sig") if isinstance(data, bytes) else data.removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        before = error.object[: error.start].decode("utf-8", "replace").removeprefix("\ufeff")
        raise Mistake(_end_of(before), "E101", "the file is not UTF-8 text") from None
    bad = UNPRINTABLE.search(text)
    if bad:
        code = f"U+{ord(bad.group()):04X}"
        spot = _end_of(text[: bad.start()])
        raise Mistake(spot, "E101", f"the character {code} is not allowed in a spec")
    return text


def lines_of(text: str) -> tuple[str, ...]:
    """The lines of the text as YAML counts them."""
    return tuple(LINE_BREAK.split(text))


def read_tree(text: str, ledger: Ledger) -> Node:
    """The one document of the text; raises `Mistake` where it cannot be read on."""
    tree = _Tree(ledger)
    try:
        for event in _events(text):
            tree.take(event)
    except yaml.MarkedYAMLError as error:
        raise _syntax_mistake(text, error) from None
    if tree.root is None:
        raise Mistake(Point(1, 1), "E107", "the file is empty", "start with 'eom: 1'")
    return tree.root


def _events(text: str) -> Iterator[yaml.Event]:
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    yield from yaml.parse(text, Loader=loader)


def _end_of(text: str) -> Point:
    lines = lines_of(text)
    return Point(len(lines), len(lines[-1]) + 1)


def _syntax_mistake(text: str, error: yaml.MarkedYAMLError) -> Mistake:
    """The pure reader's words, which are the same with and without libyaml."""
    try:
        for _ in yaml.parse(text, Loader=yaml.SafeLoader):
            pass
    except yaml.MarkedYAMLError as better:
        error = better
    unended = "end of stream" in str(error.problem)
    mark = (error.context_mark if unended else None) or error.problem_mark
    spot = Point(mark.line + 1, mark.column + 1) if mark else Point(1, 1)
    message = "; ".join(part for part in (error.context, error.problem) if part)
    hint = next((h for word, h in SYNTAX_HINTS.items() if word in message), "")
    return Mistake(spot, "E103", f"not YAML: {message}", hint)


@dataclass
class _Open:
    """A list or map whose end has not come yet."""

    spot: Point
    is_mapping: bool
    items: list[Node] = field(default_factory=list)
    entries: list[Entry] = field(default_factory=list)
    seen: dict[str, Scalar] = field(default_factory=dict)
    key: Scalar | None = None

    def close(self) -> Node:
        """The finished node."""
        line, column = self.spot.line, self.spot.column
        if self.is_mapping:
            return Mapping(tuple(self.entries), line, column)
        return Sequence(tuple(self.items), line, column)


class _Tree:
    """Builds nodes from events; `root` is there once the document has ended."""

    def __init__(self, ledger: Ledger) -> None:
        self.ledger = ledger
        self.root: Node | None = None
        self.stack: list[_Open] = []
        self.documents = self.nodes = 0

    def take(self, event: yaml.Event) -> None:
        """Work one event into the tree."""
        if isinstance(event, yaml.CollectionEndEvent):
            self.put(self.stack.pop().close())
            return
        assert event.start_mark is not None
        spot = Point(event.start_mark.line + 1, event.start_mark.column + 1)
        if isinstance(event, yaml.AliasEvent):
            raise Mistake(spot, "E106", f"alias '*{event.anchor}': a spec has no aliases")
        if isinstance(event, yaml.NodeEvent):
            self.start_node(event, spot)
        elif isinstance(event, yaml.DocumentStartEvent):
            self.start_document(spot)

    def start_document(self, spot: Point) -> None:
        """Count the documents; one is enough."""
        self.documents += 1
        if self.documents > 1:
            raise Mistake(spot, "E107", "a second document begins here", "one file, one system")

    def start_node(self, event: yaml.NodeEvent, spot: Point) -> None:
        """Open a list or map, or put a scalar in its place; refuse what is past a limit."""
        self.nodes += 1
        if self.nodes > MOST_NODES:
            raise Mistake(spot, "E108", f"more than {MOST_NODES} values in one spec")
        self.refuse_marks(event, spot)
        if isinstance(event, yaml.ScalarEvent):
            self.put(self.scalar(event, spot))
            return
        if self.stack and self.stack[-1].is_mapping and self.stack[-1].key is None:
            raise Mistake(spot, "E109", "a key must be a word, not a list or a map")
        if len(self.stack) >= MOST_DEPTH:
            raise Mistake(spot, "E108", f"nested deeper than {MOST_DEPTH} levels")
        self.stack.append(_Open(spot, isinstance(event, yaml.MappingStartEvent)))

    def refuse_marks(self, event: yaml.NodeEvent, spot: Point) -> None:
        """No anchors, no tags."""
        if event.anchor is not None:
            raise Mistake(spot, "E106", f"anchor '&{event.anchor}': a spec has no anchors")
        tag = getattr(event, "tag", None)
        if tag is not None:
            raise Mistake(spot, "E106", f"tag {shown(tag)}: a spec has no tags", "write plain text")

    def scalar(self, event: yaml.ScalarEvent, spot: Spot) -> Scalar:
        """The scalar, at the column of its first character."""
        if not event.value and event.style in (None, "") and self.stack:
            spot = self.stack[-1].key or self.stack[-1].spot  # a missing value stands nowhere
            return Scalar("", spot.line, spot.column)
        line = self.ledger.lines[spot.line - 1] if spot.line <= len(self.ledger.lines) else ""
        plain = event.style in (None, "")
        start = spot.column - 1 if plain else spot.column
        exact = line.startswith(event.value, start)
        return Scalar(event.value, spot.line, start + 1 if exact else spot.column, plain, exact)

    def put(self, node: Node) -> None:
        """Hang a finished node under the open one."""
        if not self.stack:
            self.root = node
        elif not self.stack[-1].is_mapping:
            self.stack[-1].items.append(node)
        elif self.stack[-1].key is not None:
            self.put_value(self.stack[-1], self.stack[-1].key, node)
        else:
            self.put_key(self.stack[-1], node)

    def put_key(self, parent: _Open, node: Node) -> None:
        """Remember the key of the value to come."""
        assert isinstance(node, Scalar)
        if node.text == "<<" and node.plain:
            raise Mistake(node, "E106", "merge key '<<': a spec has no merge keys")
        parent.key = node

    def put_value(self, parent: _Open, key: Scalar, node: Node) -> None:
        """Close an entry; the second of two equal keys is a fault and is left out."""
        parent.key = None
        first = parent.seen.get(key.text)
        if first is None:
            parent.seen[key.text] = key
            parent.entries.append(Entry(key, node))
            return
        message = f"key {shown(key.text)} is given twice (first on line {first.line})"
        self.ledger.note(Mistake(key, "E105", message, "remove one of them"))
