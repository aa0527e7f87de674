"""Which places a coordinate may move: by a formula of their own or by what they are placed by."""

from collections.abc import Iterator

import sympy as sp

from eomgen.model import Body, Place, Point
from eomgen.spec.cycles import Vertex, needs
from eomgen.spec.scope import Scene


def movers(points: tuple[Point, ...], bodies: tuple[Body, ...], scene: Scene) -> frozenset[str]:
    """The points and bodies that may move; one that could not be read may."""
    graph, users = needs(points, bodies), dict[Vertex, list[Vertex]]()
    for vertex, before in graph.items():
        for needed in before:
            users.setdefault(needed, []).append(vertex)
    coordinates = {k.expressions[0] for k in scene.names.values() if k.kind == "coordinate"}
    places = [n for n, k in scene.names.items() if k.kind in ("point", "body")]
    unread = [n for n in places if ("place", n) not in graph]
    waiting = [(part, name) for name in unread for part in ("place", "frame")]
    for vertex, formulas in _formulas(points, bodies):
        if any(formula.free_symbols & coordinates for formula in formulas):
            waiting.append(vertex)
    moving: set[Vertex] = set()
    while waiting:
        vertex = waiting.pop()
        if vertex not in moving:
            moving.add(vertex)
            waiting += users.get(vertex, ())
    return frozenset(name for part, name in moving if part == "place")


def _formulas(
    points: tuple[Point, ...], bodies: tuple[Body, ...]
) -> Iterator[tuple[Vertex, tuple[sp.Expr, ...]]]:
    """The formulas that each place and each frame is placed by."""
    for point in points:
        yield ("place", point.name), tuple(_of(point.place))
    for body in bodies:
        angles = tuple(f for turn in body.frame.turns for f in turn.formulas)
        yield ("frame", body.name), (*_of(body.frame.origin), *angles)
        yield ("place", body.name), tuple(_of(body.com))


def _of(place: Place) -> Iterator[sp.Expr]:
    yield from place.components
    yield from (coefficient for coefficient, _ in place.points)
