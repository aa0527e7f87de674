"""XML text -> elements with the line and column of every tag and attribute.

The events of expat are used: it is iterative and stops at the first event past a limit. A document
type is refused, and with it every entity that a file could define.
"""

import re
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass, field
from xml.parsers import expat

from eomgen.spec.ledger import Mistake, shown
from eomgen.spec.reader import Point

MOST_BYTES = 8_000_000
MOST_DEPTH = 60
MOST_ELEMENTS = 100_000

LINE_BREAK = re.compile("\r\n|\r|\n")
ATTRIBUTE = re.compile(rb"\s+([^\s=]+)\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")


class Source:
    """The bytes of a file, which know the line and column of each of them."""

    def __init__(self, text: str) -> None:
        self.data = text.encode()
        self.starts = [0, *(m.end() for m in re.finditer(rb"\r\n|\r|\n", self.data))]

    def point(self, offset: int) -> Point:
        """Line and column of a byte, both counted from 1, columns in characters."""
        line = bisect_right(self.starts, offset)
        before = self.data[self.starts[line - 1] : offset]
        return Point(line, len(before.decode("utf-8", "replace")) + 1)


@dataclass(frozen=True)
class Place:
    """A place in a source, whose line and column are found when they are asked for."""

    source: Source
    offset: int

    @property
    def line(self) -> int:
        """The line."""
        return self.source.point(self.offset).line

    @property
    def column(self) -> int:
        """The column."""
        return self.source.point(self.offset).column


@dataclass(frozen=True)
class Attribute:
    """The value of an attribute, where it begins, and where the attribute's name does."""

    text: str
    place: Place
    name_place: Place


@dataclass(frozen=True)
class Element:
    """A tag with its attributes, and its children in the order of the file."""

    name: str
    attributes: Mapping[str, Attribute]
    children: tuple["Element", ...]
    place: Place

    def __str__(self) -> str:
        name = self.attributes.get("name")
        return f"{self.name} {shown(name.text)}" if name else f"'{self.name}'"


def decode(data: bytes) -> str:
    """The text of the file; raises `Mistake` where it is too long or not UTF-8."""
    if len(data) > MOST_BYTES:
        raise Mistake(Point(1, 1), "E702", f"the file has more than {MOST_BYTES} bytes")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = lines_of(data[: error.start].decode("utf-8", "replace").removeprefix("\ufeff"))
        spot = Point(len(before), len(before[-1]) + 1)
        raise Mistake(spot, "E701", "the file is not UTF-8 text") from None


def lines_of(text: str) -> tuple[str, ...]:
    """The lines of the text as XML counts them."""
    return tuple(LINE_BREAK.split(text))


def read_tree(text: str) -> Element:
    """The root element; raises `Mistake` where the text cannot be read on."""
    tree = _Tree(Source(text))
    try:
        tree.parser.Parse(tree.source.data, True)
    except expat.ExpatError as error:
        spot = tree.source.point(max(0, tree.parser.ErrorByteIndex))
        raise Mistake(spot, "E701", f"not XML: {expat.errors.messages[error.code]}") from None
    assert tree.root is not None
    return tree.root


@dataclass
class _Open:
    """An element whose end has not come yet."""

    name: str
    attributes: Mapping[str, Attribute]
    place: Place
    children: list[Element] = field(default_factory=list)


class _Tree:
    """Builds elements from events; `root` is there once the document has ended."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.root: Element | None = None
        self.stack: list[_Open] = []
        self.count = 0
        self.parser = expat.ParserCreate("utf-8")
        self.parser.ordered_attributes = True
        self.parser.StartDoctypeDeclHandler = self.refuse
        self.parser.StartElementHandler = self.start
        self.parser.EndElementHandler = self.end

    def here(self) -> Place:
        """Where the current event begins."""
        return Place(self.source, self.parser.CurrentByteIndex)

    def refuse(self, *_: object) -> None:
        """No document type: its entities could grow without bound or name other files."""
        message = "a document type (DOCTYPE) is not read"
        start = self.source.data.rfind(b"<!DOCTYPE", 0, self.parser.CurrentByteIndex)
        raise Mistake(Place(self.source, start), "E702", message, "delete it; a URDF needs none")

    def start(self, name: str, listed: list[str]) -> None:
        """Open an element; refuse what is past a limit."""
        self.count += 1
        if self.count > MOST_ELEMENTS:
            raise Mistake(self.here(), "E702", f"more than {MOST_ELEMENTS} elements")
        if len(self.stack) >= MOST_DEPTH:
            raise Mistake(self.here(), "E702", f"nested deeper than {MOST_DEPTH} elements")
        self.stack.append(_Open(name, self.attributes(name, listed), self.here()))

    def attributes(self, name: str, listed: list[str]) -> dict[str, Attribute]:
        """The attributes: expat has decoded their values, the data say where these stand."""
        found = {}
        index = self.parser.CurrentByteIndex + 1 + len(name.encode())
        for key, text in zip(listed[::2], listed[1::2], strict=True):
            match = ATTRIBUTE.match(self.source.data, index)
            assert match is not None
            value = Place(self.source, max(match.start(2), match.start(3)))
            found[key] = Attribute(text, value, Place(self.source, match.start(1)))
            index = match.end()
        return found

    def end(self, _: str) -> None:
        """Hang the finished element under the open one."""
        top = self.stack.pop()
        done = Element(top.name, top.attributes, tuple(top.children), top.place)
        if self.stack:
            self.stack[-1].children.append(done)
        else:
            self.root = done
