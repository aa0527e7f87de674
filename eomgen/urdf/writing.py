"""A scene as the text of a spec, to be read by people."""

import json
import re
from collections.abc import Iterable, Iterator, Mapping

from eomgen.urdf.scene import NOWHERE, Along, Body, Frame, Scene

WIDEST = 96
PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_ ]*")
LONGEST_TITLE = 200


def spec(scene: Scene, title: str, remarks: Iterable[str]) -> str:
    """The text of the spec; remarks stand as comments at its head."""
    lines = [
        "# yaml-language-server: $schema=./eomgen.schema.json",
        *(f"# {printable(remark)}" for remark in remarks),
        "eom: 1",
        f"system: {_title(title)}",
        "space: solid",
        "gravity: [0, 0, -g]",
        *_parameters(scene.parameters),
        *_table("coordinates", {c.name: c.unit for c in scene.coordinates}),
        *_table("inputs", scene.inputs),
        *_section("points", (_point(*entry) for entry in scene.points.items())),
        *_section("bodies", (line for body in scene.bodies for line in _body(body))),
        *_section("dampers", (_along(damper, "damping") for damper in scene.dampers)),
        *_section("forces", (_along(force, "force") for force in scene.forces)),
        *_initial(scene),
        *_table("range", {c.name: f"[{', '.join(c.range)}]" for c in scene.coordinates if c.range}),
    ]
    return "\n".join(_wrapped(line) for line in lines) + "\n"


def printable(text: str) -> str:
    """One line without control characters."""
    return "".join(c if c.isprintable() else "?" for c in text)


def _title(title: str) -> str:
    shown = printable(title)[:LONGEST_TITLE].strip() or "robot"
    return shown if PLAIN.fullmatch(shown) else json.dumps(shown, ensure_ascii=False)


def _section(name: str, lines: Iterable[str]) -> Iterator[str]:
    """A key with its lines; nothing where there is none."""
    inside = [f"  {line}" for line in lines]
    if inside:
        yield f"{name}:"
        yield from inside


def _table(name: str, entries: Mapping[str, str]) -> Iterator[str]:
    return _section(name, (f"{key}: {value}" for key, value in entries.items()))


def _parameters(groups: Mapping[str, Mapping[str, str]]) -> Iterator[str]:
    """The parameters, each link's under its name."""
    yield "parameters:"
    yield "  g: 9.81 m/s^2"
    for link, entries in groups.items():
        if entries:
            yield f"  # {printable(link)}"
        yield from (f"  {name}: {value}" for name, value in entries.items())


def _list(items: Iterable[str]) -> str:
    return f"[{', '.join(items)}]"


def _point(name: str, frame: Frame) -> str:
    at = _list(frame.at)
    return f"{name}: {at}" if frame.on is None else f"{name}: {{on: {frame.on}, at: {at}}}"


def _body(body: Body) -> Iterator[str]:
    """A mere frame in one line where it fits, a body in one line for each key."""
    line = f"{body.name}: {{mass: 0, frame: {_frame(body.frame)}}}"
    if body.mass == "0" and not body.inertia and len(line) + 2 <= WIDEST:
        yield line
        return
    yield f"{body.name}:"
    yield f"  mass: {body.mass}"
    if body.com != NOWHERE:
        yield f"  com: {_list(body.com)}"
    if body.inertia:
        yield f"  inertia: {_list(body.inertia[: 6 if any(_mixed(body)) else 3])}"
    yield from _long_frame(body.frame)


def _mixed(body: Body) -> Iterator[bool]:
    """Which products of inertia there are."""
    return (entry != "0" for entry in body.inertia[3:])


def _frame(frame: Frame) -> str:
    return f"{{{', '.join(_frame_parts(frame))}}}"


def _long_frame(frame: Frame) -> Iterator[str]:
    """The frame in one line, or in one line for each key where that is too long."""
    line = f"  frame: {_frame(frame)}"
    if len(line) + 2 <= WIDEST:
        yield line
        return
    yield "  frame:"
    yield from (f"    {part}" for part in _frame_parts(frame))


def _frame_parts(frame: Frame) -> Iterator[str]:
    if frame.on:
        yield f"on: {frame.on}"
    if frame.at != NOWHERE or not frame.turns:
        yield f"at: {_list(frame.at)}"
    if frame.turns:
        yield f"turn: {_list(frame.turns)}"


def _along(load: Along, strength: str) -> str:
    return f"{load.name}: {{along: {load.along}, {strength}: {load.strength}}}"


def _initial(scene: Scene) -> Iterator[str]:
    """At rest where the coordinates are zero, or in the middle of a range without zero."""
    starts = [f"{c.name}: {c.start}" for c in scene.coordinates]
    speeds = (s for c in scene.coordinates for s in c.speeds or (f"{c.name}'",))
    rates = [f"{speed}: 0" for speed in speeds]
    yield f"initial: {{{', '.join(starts + rates)}}}"


def _wrapped(line: str) -> str:
    """The line, broken after commas where it is long."""
    if len(line) <= WIDEST or line.lstrip().startswith("#"):
        return line
    indent = " " * (len(line) - len(line.lstrip()) + 4)
    rows, row = [], ""
    for piece in line.split(", "):
        longer = f"{row}, {piece}" if row else piece
        if row and len(longer) >= WIDEST:
            rows.append(f"{row},")
            longer = indent + piece
        row = longer
    return "\n".join([*rows, row])
