"""Trees as specs in our language, every mass and length a parameter."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from lab.trees import Link, Tree

INERTIA = ("xx", "yy", "zz", "xy", "xz", "yz")


def spec(tree: Tree) -> str:
    """The spec of a tree; its coordinates are q0, q1, ... in the tree's order."""
    if tree.planar:
        return _cart(tree)
    frames = list(_frames(tree))
    heavy = [link for link in tree.links if link.mass]
    lines = [
        "eom: 1",
        f"system: {tree.name}",
        "space: solid",
        "gravity: [0, 0, -g]",
        "parameters:",
        "  g: 9.81 m/s^2",
        *(line for i, link in enumerate(heavy) for line in _parameters(i, link)),
        "coordinates:",
        *(f"  q{i}: {'rad' if k.joint == 'turn' else 'm'}" for i, k in enumerate(tree.links)),
        "inputs:",
        *(f"  tau{i}: N*m" for i in tree.driven),
        "bodies:",
        *(line for i, frame in enumerate(frames) for line in _body(i, frame)),
        "moments:",
        *(_moment(i, tree, frames) for i in tree.driven),
    ]
    return "\n".join(lines) + "\n"


def _cart(tree: Tree) -> str:
    masses = [_decimal(link.mass) for link in tree.links]
    return cart(tree.name, masses, [_decimal(-link.com[1]) for link in tree.links[1:]])


def cart(title: str, masses: Sequence[str], lengths: Sequence[str]) -> str:
    """A cart with a chain of pendulums: points by their positions, angles from the vertical."""
    pendulums = range(1, len(masses))
    lines = [
        "eom: 1",
        f"system: {title}",
        "space: plane",
        "gravity: [0, -g]",
        "parameters:",
        "  g: 9.81 m/s^2",
        *(f"  m{i}: {mass} kg" for i, mass in enumerate(masses)),
        *(f"  l{i}: {length} m" for i, length in enumerate(lengths, start=1)),
        "coordinates:",
        "  s: m",
        *(f"  q{i}: rad" for i in pendulums),
        "inputs: {F: N}",
        "points:",
        "  P0: [s, 0]",
        *(f"  P{i}: P{i - 1} + l{i}*[sin(q{i}), -cos(q{i})]" for i in pendulums),
        "bodies:",
        *(f"  B{i}: {{mass: m{i}, at: P{i}}}" for i in range(len(masses))),
        "forces:",
        "  - {on: P0, force: [F, 0]}",
    ]
    return "\n".join(lines) + "\n"


@dataclass(frozen=True)
class Frame:
    """A body with its joints: `links` are their numbers in the tree, the last has the mass."""

    on: int | None
    links: tuple[int, ...]
    at: str
    turns: str


def _frames(tree: Tree) -> Iterator[Frame]:
    """One frame for each body: massless links belong to the next one with a mass."""
    bodies: dict[int, int] = {}
    joints: list[int] = []
    for i, link in enumerate(tree.links):
        joints.append(i)
        if not link.mass:
            continue
        body = len(bodies)
        bodies[i] = body
        parent = tree.links[joints[0]].parent
        yield Frame(
            bodies.get(parent), tuple(joints), _at(tree, joints, body), _turns(tree, joints)
        )
        joints = []


def _at(tree: Tree, joints: list[int], body: int) -> str:
    slides = {tree.links[i].axis.index(1): i for i in joints if tree.links[i].joint == "slide"}
    if slides:
        return ", ".join(f"q{slides[k]}" if k in slides else "0" for k in range(3))
    return ", ".join(f"r{body}_{axis}" for axis in "xyz")


def _turns(tree: Tree, joints: list[int]) -> str:
    turns = [i for i in joints if tree.links[i].joint == "turn"]
    return ", ".join(f"[{list(tree.links[i].axis)}, q{i}]" for i in turns)


def _parameters(body: int, link: Link) -> Iterator[str]:
    yield f"  m{body}: {_decimal(link.mass)} kg"
    for axis, place, com in zip("xyz", link.place, link.com, strict=True):
        yield f"  r{body}_{axis}: {_decimal(place)} m"
        yield f"  c{body}_{axis}: {_decimal(com)} m"
    for axes, value in zip(INERTIA, link.inertia, strict=True):
        yield f"  I{body}_{axes}: {_decimal(value)} kg*m^2"


def _decimal(value: Fraction) -> str:
    text = repr(float(value))
    assert Fraction(text) == value, f"{value} has no short decimal"
    return text


def _body(body: int, frame: Frame) -> Iterator[str]:
    on = "" if frame.on is None else f"on: B{frame.on}, "
    yield f"  B{body}:"
    yield f"    mass: m{body}"
    yield f"    inertia: [{', '.join(f'I{body}_{axes}' for axes in INERTIA)}]"
    yield f"    frame: {{{on}at: [{frame.at}], turn: [{frame.turns}]}}"
    yield f"    com: [{', '.join(f'c{body}_{axis}' for axis in 'xyz')}]"


def _moment(joint: int, tree: Tree, frames: list[Frame]) -> str:
    """A torque about the axis of a joint, which both bodies see with the same components."""
    body = next(i for i, frame in enumerate(frames) if joint in frame.links)
    axis = tree.links[joint].axis
    length = isqrt(sum(a * a for a in axis))
    parts = [_share(a, length, f"tau{joint}") for a in axis]
    source = "" if frames[body].on is None else f", from: B{frames[body].on}"
    return f"  T{joint}: {{on: B{body}{source}, in: B{body}, moment: [{', '.join(parts)}]}}"


def _share(component: int, length: int, torque: str) -> str:
    if component == length:
        return torque
    return f"{component}*{torque}/{length}" if component else "0"
