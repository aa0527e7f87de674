"""Where a constraint presses on the bodies: the touching point, its normal and its tangents.

A gap that depends on the place r of one point only has  G = (d gap / d r) (d r / d q').  The force
lambda_N G' is then a force  N = lambda_N |d gap / d r|  on that point along the normal n, and
friction acts there too, against the slip velocity  v - (v . n) n.  The surface itself is taken to
move along its normal only.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from eomgen.algebra import elimination, ldl
from eomgen.algebra.graph import Node
from eomgen.errors import UsageError
from eomgen.mechanics import contacts_states
from eomgen.mechanics.constraints import Row, coasting
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.vectors import Vector, dot, subtract, transform, transpose
from eomgen.model import Body

ZERO = 1e-9  # relative: what a derivative by a coordinate is compared with
Table = list[list[float]]


@dataclass(frozen=True)
class Slip:
    """One component of the slip velocity [m/s]: its derivatives by q' and its rate at q'' = 0."""

    speed: Node
    jacobian: tuple[Node, ...]
    gamma: Node


@dataclass(frozen=True)
class Touch:
    """The point that touches; forces on it are in newtons."""

    point: str
    normal: Vector[Node]  # unit vector, world axes
    steepness: Node  # |d gap / d r|: N = lambda_N * steepness
    slips: tuple[Slip, ...]  # along each tangent: one in a plane, two in solid space
    friction: Node  # Coulomb's coefficient mu
    pivots: ldl.Pivots


def of(kinematics: Kinematics[Node], row: Row[Node]) -> Touch:
    """The touching point of a constraint with friction.

    Raises:
        UsageError: no point, or more than one, can be the touching one.
    """
    point = _touching(kinematics, row)
    velocity = kinematics.velocity(point)
    partials = _partials(kinematics, point)
    # least squares; exact, because G is a combination of the rows of d r / d q'
    square = [[dot(a, b) for b in partials] for a in partials]
    (gradient,), pivots = ldl.solve(square, [dot(p, row.jacobian) for p in partials])
    steepness = kinematics.algebra.apply("sqrt", dot(gradient, gradient))
    normal = tuple(g / steepness for g in gradient)
    slips = tuple(_slip(kinematics, dot(t, velocity)) for t in tangents(kinematics, normal))
    friction = kinematics.algebra.of(row.constraint.friction)
    return Touch(point, normal, steepness, slips, friction, pivots)


def _slip(kinematics: Kinematics[Node], speed: Node) -> Slip:
    algebra, one = kinematics.algebra, kinematics.algebra.number(1)
    jacobian = tuple(algebra.along(speed, {c.rate: one}) for c in kinematics.model.coordinates)
    return Slip(speed, jacobian, algebra.along(speed, coasting(kinematics)))


def tangents(kinematics: Kinematics[Node], normal: Vector[Node]) -> tuple[Vector[Node], ...]:
    """Unit tangents: the normal turned clockwise in a plane; an orthonormal pair in solid space.

    Source: Duff et al., Building an Orthonormal Basis, Revisited (2017); nowhere singular.
    """
    if len(normal) == 2:
        return ((normal[1], -normal[0]),)
    x, y, z = normal
    half = kinematics.algebra.number(1) / 2
    # 1 where z >= 0, else -1
    side = kinematics.algebra.apply("sign", kinematics.algebra.apply("sign", z) + half)
    a = -1 / (side + z)
    b = x * y * a
    return (1 + side * x * x * a, side * b, -side * x), (b, side + y * y * a, -y)


def _partials(kinematics: Kinematics[Node], name: str) -> tuple[Vector[Node], ...]:
    """Rows of d r / d q', one for each component of the place of a point."""
    one = kinematics.algebra.number(1)
    return tuple(
        tuple(kinematics.algebra.along(v, {c.rate: one}) for c in kinematics.model.coordinates)
        for v in kinematics.velocity(name)
    )


def _touching(kinematics: Kinematics[Node], row: Row[Node]) -> str:
    """The one point whose place decides the gap."""
    found = _distinct(
        kinematics, [p for p in _material(kinematics) if _decides(kinematics, p, row)]
    )
    who = f"the friction of {row.constraint.name}"
    if not found:
        raise UsageError(
            f"{who} has no point to act on: '{row.constraint.text}' is no function of the place of "
            "one particle, of a body that does not turn, or of one named point on a body; name the "
            "point that touches and write the constraint with its place"
        )
    if len(found) > 1:
        raise UsageError(
            f"{who} may act on {' or '.join(found)}: '{row.constraint.text}' does not tell, as the "
            "place of each decides it; use more coordinates and constraints, or leave it out"
        )
    if _rank_of(kinematics, _partials(kinematics, found[0])) < max(2, kinematics.dimensions):
        raise UsageError(
            f"{who} has no direction: {found[0]} does not move freely in {kinematics.model.space}, "
            "so the normal is not known; give it a coordinate for each direction of space"
        )
    return found[0]


def _decides(kinematics: Kinematics[Node], name: str, row: Row[Node]) -> bool:
    """Whether G is a combination of the rows of d r / d q' at every state."""
    partials = _partials(kinematics, name)
    nodes = [*row.jacobian, *(entry for p in partials for entry in p)]
    size = len(row.jacobian)
    for found in contacts_states.values(kinematics, nodes):
        rows = [found[i : i + size] for i in range(0, len(found), size)]
        if not any(rows[0]) or rank(rows[1:]) < rank(rows):
            return False
    return True


def rank(rows: Table) -> int:
    """The rank of a numeric matrix whose rows may be of different sizes."""
    largest = [max(map(abs, row), default=0.0) for row in rows]
    units = [[v / most for v in row] for row, most in zip(rows, largest, strict=True) if most]
    return len(elimination.order_of(units, ZERO).rows)


def _rank_of(kinematics: Kinematics[Node], partials: Sequence[Vector[Node]]) -> int:
    """The largest rank over the states."""
    size = len(partials[0])
    found = contacts_states.values(kinematics, [entry for p in partials for entry in p])
    return max(rank([v[i : i + size] for i in range(0, len(v), size)]) for v in found)


def _distinct(kinematics: Kinematics[Node], names: Sequence[str]) -> list[str]:
    """Points that do not move alike, the first of each kind."""
    same: set[str] = set()
    for first, second in combinations(names, 2):
        moved = subtract(kinematics.position(second), kinematics.position(first))
        if first not in same and _is_fixed(kinematics, moved):
            same.add(second)
    return [n for n in names if n not in same]


def _is_fixed(kinematics: Kinematics[Node], components: Vector[Node]) -> bool:
    """Whether components change with no coordinate."""
    algebra, one = kinematics.algebra, kinematics.algebra.number(1)
    slopes = [
        algebra.along(component, {c.symbol: one})
        for component in components
        for c in kinematics.model.coordinates
    ]
    moving = [s for s in slopes if not algebra.is_zero(s)]
    if not moving:
        return True
    return all(abs(v) < ZERO for found in contacts_states.values(kinematics, moving) for v in found)


def _material(kinematics: Kinematics[Node]) -> Iterator[str]:
    """Mass centres of what does not turn, and named points fixed in a body.

    Not the mass centre of a turning body, under any name: a disc touches with its rim.
    """
    bodies = kinematics.model.bodies
    turning = [b for b in bodies if _turns(kinematics, b)]
    yield from (b.name for b in bodies if b not in turning)
    for point in kinematics.model.points:
        if any(_is_at(kinematics, point.name, b) for b in turning):
            continue
        if any(_belongs(kinematics, point.name, b) for b in bodies):
            yield point.name


def _turns(kinematics: Kinematics[Node], body: Body) -> bool:
    """Whether a body has inertia against turning, and turns."""
    if kinematics.spin(body) is None:
        return False
    one = kinematics.algebra.number(1)
    return not all(
        kinematics.algebra.is_zero(kinematics.algebra.along(w, {c.rate: one}))
        for w in kinematics.angular_velocity(body.name)
        for c in kinematics.model.coordinates
    )


def _is_at(kinematics: Kinematics[Node], point: str, body: Body) -> bool:
    """Whether a point is the mass centre wherever the scene is."""
    arm = [c for c in _arm(kinematics, point, body) if not kinematics.algebra.is_zero(c)]
    found = contacts_states.values(kinematics, arm) if arm else [[]]
    return all(abs(v) < ZERO for values in found for v in values)


def _belongs(kinematics: Kinematics[Node], point: str, body: Body) -> bool:
    """Whether a point is fixed in the axes of a body."""
    if body.frame.along and kinematics.dimensions == 3:
        return point in body.frame.along
    arm = _arm(kinematics, point, body)
    return _is_fixed(kinematics, transform(transpose(kinematics.axes(body.name)), arm))


def _arm(kinematics: Kinematics[Node], point: str, body: Body) -> Vector[Node]:
    """From the mass centre to the point, world axes."""
    return subtract(kinematics.position(point), kinematics.position(body.name))
