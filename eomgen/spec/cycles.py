"""Does every place lead back to the world? Points and frames may be declared in any order."""

from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter

from eomgen.model import Body, Place, Point
from eomgen.spec.ledger import Mistake
from eomgen.spec.scope import Scene

Vertex = tuple[str, str]  # "place" or "frame", name


def check(points: tuple[Point, ...], bodies: tuple[Body, ...], scene: Scene) -> None:
    """Raise `Mistake` at a point or body that is placed by way of itself."""
    try:
        TopologicalSorter(needs(points, bodies)).prepare()
    except CycleError as error:
        # the sorter lists each vertex before the one that needs it
        names = [name for _, name in reversed(error.args[1])]
        chain = [
            name for name, before in zip(names, [None, *names], strict=False) if name != before
        ]
        spot = scene.names[chain[0]].spot
        assert spot is not None
        message = f"places go round in a circle: {' -> '.join(chain)}"
        raise Mistake(spot, "E503", message, "place one of them in the world") from None


def needs(points: tuple[Point, ...], bodies: tuple[Body, ...]) -> dict[Vertex, tuple[Vertex, ...]]:
    """What each place and each frame is placed by."""
    graph = {("place", p.name): tuple(_needs(p.place)) for p in points}
    for body in bodies:
        along = tuple(("place", name) for name in body.frame.along or ())
        graph["frame", body.name] = (*_needs(body.frame.origin), *along)
        graph["place", body.name] = tuple(_needs(body.com))
    return graph


def _needs(place: Place) -> Iterator[Vertex]:
    yield from (("place", name) for _, name in place.points)
    if place.on is not None:
        yield ("frame", place.on)
