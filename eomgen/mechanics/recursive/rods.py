"""Accelerations of particles on massless links, with the tensions of the links as the unknowns.

A particle i on a link with the direction e_i feels its tension T_i and those of what hangs on it:

m_i a_i = f_i + e_i T_i - sum_k e_k T_k,      e_i . (a_i - a_base) = e_i . drift_i,

two equations that give a system for the tensions alone, with a row for each link:

(e_i.e_i / m_i + e_i.e_i / m_b) T_i - sum_k (e_i.e_k / m_i) T_k - (e_i.e_b / m_b) T_b = right side.

It is as sparse as the tree, nearly constant on its diagonal, and positive definite while masses
are; in a chain it is tridiagonal, where the mass matrix is full. What the ground guides, as it
does a cart, gives way with 1/m along its coordinates only, and has no tension.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial, reduce

from eomgen.algebra import ldl
from eomgen.algebra.elementary import minimum
from eomgen.algebra.graph import Node
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.recursive import particles
from eomgen.mechanics.recursive.formulas import Clock
from eomgen.mechanics.recursive.particles import FIXED, Particle, Way
from eomgen.mechanics.recursive.records import Solution, Tree
from eomgen.mechanics.recursive.recursion import Loads
from eomgen.mechanics.recursive.short import Short
from eomgen.mechanics.vectors import Vector, add, dot, scale

Terms = list[tuple[Node, Node]]  # (coefficient, value) of a sum
Values = Mapping[int, Node]


def solve(kinematics: Kinematics[Node], tree: Tree, applied: Loads) -> Solution | None:
    """M^-1 (Q - h) without M; None where the tree is not one of particles on links.

    Raises:
        SingularMassMatrix: a mass is negative.
    """
    short = Short(kinematics.algebra, Clock(kinematics).constant_bits)
    found = None if applied.wrenches else particles.of(kinematics, tree, short)
    if found is None:
        return None
    scene = Scene(found, tuple(-g for g in tree.gravity), applied.forces, short)
    tensions, pivots = _tensions(scene)
    motion: dict[int, Node] = {}
    for i, particle in enumerate(found):
        move = _guided if particle.is_guided else _led
        motion |= {way.coordinate: move(scene, i, way, (tensions, motion)) for way in particle.ways}
    return tuple(motion[c] for c in range(len(motion))), (*_divisors(scene), *pivots)


@dataclass(frozen=True)
class Scene:
    """Particles and what is applied to them."""

    particles: tuple[Particle, ...]
    falling: Vector[Node]  # the acceleration of the ground
    forces: Sequence[Node]  # of the coordinates
    short: Short

    @cached_property
    def hanging(self) -> tuple[tuple[int, ...], ...]:
        """What hangs on each particle."""
        found: list[list[int]] = [[] for _ in self.particles]
        for i, particle in enumerate(self.particles):
            if particle.base != FIXED:
                found[particle.base].append(i)
        return tuple(map(tuple, found))

    @cached_property
    def pushes(self) -> tuple[Vector[Node], ...]:
        """The force S (S' S)^-1 Q on each particle, whose reaction its base feels."""
        nothing = (self.short.zero,) * len(self.falling)
        each = (
            (scale(self.forces[w.coordinate] * w.inverse, w.direction) for w in p.ways)
            for p in self.particles
        )
        return tuple(reduce(add, parts, nothing) for parts in each)

    @cached_property
    def reactions(self) -> tuple[Vector[Node], ...]:
        """All other forces on each particle but the tensions."""
        minus = -self.short.zero.graph.one
        felt = ((scale(minus, self.pushes[k]) for k in hanging) for hanging in self.hanging)
        return tuple(
            reduce(add, parts, p.force) for p, parts in zip(self.particles, felt, strict=True)
        )

    @cached_property
    def lightness(self) -> tuple[Node, ...]:
        """1 / m."""
        return tuple(1 / p.mass for p in self.particles)

    def along_link(self, direction: Vector[Node], i: int) -> Node:
        """direction . e_i; in the plane the same value, but for the sign, for (a, b) and (b, a)."""
        if len(direction) != 2:
            return self.short.of(dot(direction, self.particles[i].link))
        across = self.particles[i].ways[0].direction
        first, second = sorted((direction, across), key=lambda v: [entry.id for entry in v])
        turned = first[0] * second[1] - first[1] * second[0]
        return turned if first is across else -turned

    def links(self, i: int, k: int) -> Node:
        """e_i . e_k."""
        return self.short.of(dot(self.particles[i].link, self.particles[k].link))


def _guided(scene: Scene, i: int, way: Way, known: tuple[Values, Values]) -> Node:
    """Against the ground: S' S q'' = S' (f / m - a of the ground - drift)."""
    particle, (tensions, _) = scene.particles[i], known
    terms = _pulled(scene, i, way.direction, tensions)
    terms.append((scene.lightness[i], dot(way.direction, scene.reactions[i])))
    terms.append(_minus(scene, dot(way.direction, scene.falling)))
    return _share(scene, particle, way, terms) + _own_force(scene, i, way)


def _led(scene: Scene, i: int, way: Way, known: tuple[Values, Values]) -> Node:
    """Against another particle: S' S q'' = S' (a - a of the base - drift)."""
    particle, (tensions, _) = scene.particles[i], known
    # the own link is at right angles to S
    terms = _pulled(scene, i, way.direction, tensions, but=i)
    terms.append((scene.lightness[i], dot(way.direction, scene.reactions[i])))
    base = _acceleration(scene, particle.base, way.direction, known, but=i)
    terms += [(coefficient, -value) for coefficient, value in base]
    return _share(scene, particle, way, terms) + _own_force(scene, i, way)


def _own_force(scene: Scene, i: int, way: Way) -> Node:
    return scene.forces[way.coordinate] * (scene.lightness[i] / way.gram)


def _minus(scene: Scene, value: Node) -> tuple[Node, Node]:
    return scene.short.zero.graph.one, -value


def _share(scene: Scene, particle: Particle, way: Way, terms: Terms) -> Node:
    """size / (S' S) * (the sum of the terms - what the base's place and the drift add)."""
    terms = [*terms, _minus(scene, dot(way.direction, particle.carried))]
    terms.append(_minus(scene, particle.drift.along(way.direction, scene.short)))
    if not scene.short.is_constant(way.inverse):
        return way.inverse * _sum(scene, terms)
    return _sum(scene, [(way.inverse * factor, value) for factor, value in terms])


def _sum(scene: Scene, terms: Terms) -> Node:
    """The sum, each coefficient once."""
    values: dict[Node, Node] = {}
    for factor, value in terms:
        values[factor] = values[factor] + value if factor in values else value
    return sum((factor * value for factor, value in values.items()), scene.short.zero)


def _pulled(
    scene: Scene, i: int, direction: Vector[Node], tensions: Values, but: int | None = None
) -> Terms:
    """What tensions, but one, add to the acceleration of i along a direction."""
    terms = []
    for k in (i, *scene.hanging[i]):
        if k in tensions and k != but:
            pull = scene.along_link(direction, k) * tensions[k]
            terms.append((scene.lightness[i], pull if k == i else -pull))
    return terms


def _acceleration(
    scene: Scene,
    i: int,
    direction: Vector[Node],
    known: tuple[Values, Values],
    but: int | None = None,
) -> Terms:
    """The acceleration along a direction, with these tensions and q''."""
    one = scene.short.zero.graph.one
    if i == FIXED:
        return [(one, dot(direction, scene.falling))]
    particle, (tensions, motion) = scene.particles[i], known
    if not particle.is_guided:
        force = dot(direction, add(scene.reactions[i], scene.pushes[i]))
        return [(scene.lightness[i], force), *_pulled(scene, i, direction, tensions, but)]
    total = dot(direction, add(scene.falling, particle.carried))
    total = total + particle.drift.along(direction, scene.short)
    for way in particle.ways:
        moved = scene.short.of(dot(direction, way.direction))
        total = total + way.size * motion[way.coordinate] * moved
    return [(one, total)]


def _tensions(scene: Scene) -> tuple[dict[int, Node], ldl.Pivots]:
    """The tension of each link, from the leaves to the root and back."""
    slack: dict[int, Node] = {}
    for i, particle in enumerate(scene.particles):
        if particle.is_guided:
            slack |= {w.coordinate: _guided(scene, i, w, ({}, {})) for w in particle.ways}
    rods = [i for i, particle in enumerate(scene.particles) if particle.is_hung]
    rows = _rows(scene, {i: number for number, i in enumerate(rods)})
    right = [_right_side(scene, i, slack) for i in rods]
    pivots: list[tuple[Node, Node]] = []
    factors = ldl.factor(rows, partial(_check, rows, pivots))
    return dict(zip(rods, ldl.substitute(factors, right), strict=True)), tuple(pivots)


def _check(
    rows: list[list[Node]], pivots: list[tuple[Node, Node]], row: int, pivot: Node, scale: Node
) -> None:
    """Remember the last pivot of each chain, which holds all others: these are above 1/m_b."""
    if all(entry is entry.graph.zero for entry in rows[row][:row]):
        ldl.check_pivot(pivots, row, pivot, scale)


def _rows(scene: Scene, number: Mapping[int, int]) -> list[list[Node]]:
    """How far a tension parts the ends of a link: its own, of its base, of what hangs beside it."""
    rows = []
    for i, own in number.items():
        row = [scene.short.zero] * (own + 1)
        base = scene.particles[i].base
        if base in number:
            row[number[base]] = -(scene.links(i, base) * scene.lightness[base])
        for k in scene.hanging[base]:
            if k in number and k <= i:
                row[number[k]] = _give(scene, base, i, k)
        row[own] = scene.links(i, i) * scene.lightness[i] + row[own]
        rows.append(row)
    return rows


def _give(scene: Scene, base: int, i: int, k: int) -> Node:
    """How far a base gives way along the link i when pulled along the link k."""
    if not scene.particles[base].is_guided:
        return scene.links(i, k) * scene.lightness[base]
    total = scene.short.zero
    for way in scene.particles[base].ways:
        product = scene.along_link(way.direction, i) * scene.along_link(way.direction, k)
        total = total + scene.lightness[base] / way.square * product
    return total


def _right_side(scene: Scene, i: int, slack: Values) -> Node:
    """How fast the ends of a link would part if it had no tension."""
    particle, link = scene.particles[i], scene.particles[i].link
    one = scene.short.zero.graph.one
    terms = [(one, particle.drift.along(link, scene.short)), (one, dot(link, particle.carried))]
    terms += _acceleration(scene, particle.base, link, ({}, slack))
    terms.append((scene.lightness[i], -dot(link, scene.reactions[i])))
    return _sum(scene, terms)


def _divisors(scene: Scene) -> ldl.Pivots:
    """Masses and S' S, of which the least must be positive; apart those that move."""
    pivots: list[tuple[Node, Node]] = []
    least: Node | None = None
    for particle in scene.particles:
        for value in (particle.mass, *(way.gram for way in particle.ways)):
            if value.operator == "number" or not scene.short.is_constant(value):
                ldl.check_pivot(pivots, len(pivots), value, value)
            else:
                least = value if least is None else minimum(least, value)
    return (*pivots, *([] if least is None else [(least, least)]))
