"""Where everything is, as a function of the state, and how it is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from eomgen.algebra.assemble import assemble
from eomgen.algebra.graph import Node
from eomgen.compile import Machine
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.vectors import Vector, add, scale
from eomgen.model import Body, Place
from eomgen.program import Function
from eomgen.render.animation import Disc, Pair, Sketch


@dataclass
class _Places:
    """Places with their numbers; equal ones share one."""

    kinematics: Kinematics[Node]
    found: dict[Vector[Node], int] = field(default_factory=dict)

    def number(self, place: Vector[Node]) -> int:
        """The number of a place."""
        return self.found.setdefault(place, len(self.found))

    def named(self, name: str) -> int:
        """The number of a point or mass centre."""
        return self.number(self.kinematics.position(name))


def function(machine: Machine) -> Function:
    """World coordinates [m] of everything that is drawn."""
    places, _ = _drawn(machine)
    rows = list(places.found)
    shape = (len(rows), machine.kinematics.dimensions)
    return assemble("places", "places [m] of what is drawn", shape, [v for r in rows for v in r])


def sketch(machine: Machine) -> Sketch:
    """What is drawn at these places."""
    return _drawn(machine)[1]


def _drawn(machine: Machine) -> tuple[_Places, Sketch]:
    model, places = machine.model, _Places(machine.kinematics)
    points = tuple((places.named(p.name), p.name) for p in model.points)
    bodies = tuple(_disc(places, machine, body) for body in model.bodies)
    arms = [arm for p in model.points for arm in _arms(places, p.place, places.named(p.name))]
    for body in model.bodies:
        arms += _frame_arms(places, body)
    return places, Sketch(
        bodies=bodies,
        points=points,
        rods=tuple(_ends(places, b.frame.along) for b in model.bodies if b.frame.along),
        arms=tuple(dict.fromkeys(a for a in arms if a[0] != a[1])),
        springs=tuple(_ends(places, s.between) for s in model.springs if s.between),
        dampers=tuple(_ends(places, d.between) for d in model.dampers if d.between),
    )


def _ends(places: _Places, pair: tuple[str, str]) -> Pair:
    return places.named(pair[0]), places.named(pair[1])


def _arms(places: _Places, place: Place, end: int) -> Iterator[Pair]:
    """From where a place is counted to it."""
    kinematics = places.kinematics
    for _, point in place.points:
        yield places.named(point), end
    if place.on is not None and not place.points:
        yield places.number(kinematics.origin(place.on)), end
    if place.on is None and not place.points:
        zero = kinematics.algebra.number(0)
        yield places.number((zero,) * kinematics.dimensions), end


def _frame_arms(places: _Places, body: Body) -> Iterator[Pair]:
    """From the parent's origin to the own one, and from there to the mass centre."""
    centre = places.named(body.name)
    if body.frame.along:
        return
    origin = places.number(places.kinematics.origin(body.name))
    yield from _arms(places, body.frame.origin, origin)
    yield origin, centre
    if body.com.on is None or body.com.points:
        yield from _arms(places, body.com, centre)


def _disc(places: _Places, machine: Machine, body: Body) -> Disc:
    """A body with the tips of its axes, a radius of gyration from its mass centre."""
    centre, kinematics = places.named(body.name), places.kinematics
    tips: list[int] = []
    if body.inertia and not body.frame.along and kinematics.dimensions > 1:
        inertia = kinematics.vector(body.inertia)
        # the trace of a tensor in space is twice the sum of m r^2
        total = inertia[0] if len(inertia) == 1 else (inertia[0] + inertia[4] + inertia[8]) / 2
        radius = kinematics.algebra.apply("sqrt", total / kinematics.algebra.of(body.mass))
        axes = zip(*kinematics.axes(body.name), strict=True)
        wanted = 1 if kinematics.dimensions == 2 else 3
        for _, axis in zip(range(wanted), axes, strict=False):
            tip = add(kinematics.position(body.name), scale(radius, tuple(axis)))
            tips.append(places.number(tip))
    return Disc(centre, tuple(tips), _size(machine, body), body.name)


def _size(machine: Machine, body: Body) -> float:
    """Between 0 and 1: the cube root of the mass, of the largest one."""
    values = {p.symbol: p.value for p in machine.model.parameters if p.value is not None}
    formulas = {p.symbol: p.formula for p in machine.model.parameters if p.formula is not None}

    def mass(of: Body) -> float:
        formula = of.mass
        while formula.free_symbols & formulas.keys():
            formula = formula.xreplace(formulas)
        known = formula.xreplace(values)
        return 1.0 if known.free_symbols else abs(float(known))

    masses = [mass(b) for b in machine.model.bodies]
    return float((mass(body) / (max(masses) or 1.0)) ** (1 / 3))
