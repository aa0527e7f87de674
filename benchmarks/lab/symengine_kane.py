"""Kane's equations of a tree on SymEngine expressions: M and f, common subexpressions, C text."""

from __future__ import annotations

from dataclasses import dataclass
from math import isqrt
from typing import Any

import symengine as se

from lab.trees import Link, Tree

Vector = list[Any]


def _cross(a: Vector, b: Vector) -> Vector:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def _dot(a: Vector, b: Vector) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _add(*vectors: Vector) -> Vector:
    return [sum(parts, se.Integer(0)) for parts in zip(*vectors, strict=True)]


def _turned(matrix: list[Vector], v: Vector) -> Vector:
    return [_dot(row, v) for row in matrix]


@dataclass
class Place:
    """A link in world axes, with the accelerations that rates and gravity alone cause."""

    rotation: list[Vector]
    joint: Vector
    axis: Vector
    spin: Vector
    turning: Vector
    moving: Vector


def _symbols(name: str, values: tuple[Any, ...]) -> Vector:
    return [se.Symbol(f"{name}_{i}") if v else se.Integer(0) for i, v in enumerate(values)]


def _rodrigues(axis: Vector, q: Any) -> list[Vector]:
    c, s, (x, y, z) = se.cos(q), se.sin(q), axis
    return [
        [c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
        [x * y * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
        [x * z * (1 - c) - y * s, y * z * (1 - c) + x * s, c + z * z * (1 - c)],
    ]


def _ground(tree: Tree) -> Place:
    zero = [se.Integer(0)] * 3
    identity = [[se.Integer(int(i == j)) for j in range(3)] for i in range(3)]
    gravity = [se.Symbol("g") * (1 if g < 0 else 0) for g in tree.gravity]
    return Place(identity, zero, zero, zero, zero, gravity)


def _place(i: int, link: Link, before: Place) -> Place:
    """The next link of a chain, by the rules of relative motion."""
    q, u = se.Symbol(f"q_{i}"), se.Symbol(f"u_{i}")
    length = isqrt(sum(a * a for a in link.axis))
    own = [se.Rational(a, length) for a in link.axis]
    axis = _turned(before.rotation, own)
    arm = _turned(before.rotation, _symbols(f"r{i}", link.place))
    swing = _cross(before.spin, [a * u for a in axis])
    if link.joint == "slide":
        arm = _add(arm, [a * q for a in axis])
        spin, turning, rotation = before.spin, before.turning, before.rotation
        extra = [2 * s for s in swing]
    else:
        spin = _add(before.spin, [a * u for a in axis])
        turning = _add(before.turning, swing)
        columns = list(zip(*_rodrigues(own, q), strict=True))
        rotation = [[_dot(row, list(c)) for c in columns] for row in before.rotation]
        extra = [se.Integer(0)] * 3
    whirl = _cross(before.spin, _cross(before.spin, arm))
    moving = _add(before.moving, _cross(before.turning, arm), whirl, extra)
    return Place(rotation, _add(before.joint, arm), axis, spin, turning, moving)


def equations(tree: Tree) -> list[Any]:
    """M, row by row, then f."""
    n, places = len(tree.links), []
    mass = [[se.Integer(0)] * n for _ in range(n)]
    forcing = [se.Symbol(f"tau_{i}") if i in tree.driven else se.Integer(0) for i in range(n)]
    for i, link in enumerate(tree.links):
        before = _ground(tree) if link.parent < 0 else places[link.parent]
        places.append(_place(i, link, before))
        if link.mass:
            _add_body(tree, i, places, mass, forcing)
    return [entry for row in mass for entry in row] + forcing


def _ancestors(tree: Tree, i: int) -> list[int]:
    found = []
    while i >= 0:
        found.append(i)
        i = tree.links[i].parent
    return found


def _add_body(
    tree: Tree, i: int, places: list[Place], mass: list[Vector], forcing: list[Any]
) -> None:
    """M += m Jv' Jv + Jw' I Jw,  f -= Jv' m a + Jw' (I alpha + w x I w)."""
    link, place, m = tree.links[i], places[i], se.Symbol(f"m_{i}")
    com = _turned(place.rotation, _symbols(f"c{i}", link.com))
    whirl = _cross(place.spin, _cross(place.spin, com))
    acceleration = _add(place.moving, _cross(place.turning, com), whirl)
    inertia = _world_inertia(i, link, place.rotation)
    momentum = _turned(inertia, place.spin)
    torque = _add(_turned(inertia, place.turning), _cross(place.spin, momentum))
    chain, columns = _ancestors(tree, i), {}
    for j in chain:
        arm = _add(place.joint, com, [-p for p in places[j].joint])
        slides = tree.links[j].joint == "slide"
        linear = places[j].axis if slides else _cross(places[j].axis, arm)
        columns[j] = linear, [se.Integer(0)] * 3 if slides else places[j].axis
    for j in chain:
        linear, angular = columns[j]
        forcing[j] = forcing[j] - m * _dot(linear, acceleration) - _dot(angular, torque)
        moved = _turned(inertia, angular)
        for k in chain:
            mass[j][k] = mass[j][k] + m * _dot(linear, columns[k][0]) + _dot(moved, columns[k][1])


def _world_inertia(i: int, link: Link, rotation: list[Vector]) -> list[Vector]:
    xx, yy, zz, xy, xz, yz = _symbols(f"I{i}", link.inertia)
    own = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    half = [[_dot(row, list(column)) for column in zip(*own, strict=True)] for row in rotation]
    return [[_dot(row, other) for other in rotation] for row in half]


def masses(count: int) -> list[Any]:
    """M and f of the chain of masses, springs and dampers, in the same form."""
    x, v = [[se.Symbol(f"{n}_{i}") for i in range(count)] for n in "xv"]
    k, c, m = [[se.Symbol(f"{n}_{i}") for i in range(count)] for n in "kcm"]
    forcing = [se.Integer(0)] * (count - 1) + [se.Symbol("F")]
    for i in range(count):
        pull = k[i] * (x[i] - (x[i - 1] if i else 0)) + c[i] * (v[i] - (v[i - 1] if i else 0))
        forcing[i] = forcing[i] - pull
        if i:
            forcing[i - 1] = forcing[i - 1] + pull
    zero = se.Integer(0)
    return [m[i] if i == j else zero for i in range(count) for j in range(count)] + forcing


def text(expressions: list[Any]) -> str:
    """C statements."""
    shared, results = se.cse(expressions)
    lines = [f"const double {s} = {se.ccode(e)};" for s, e in shared]
    return "\n".join(lines + [f"r[{i}] = {se.ccode(e)};" for i, e in enumerate(results)])
