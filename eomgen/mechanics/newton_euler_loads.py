"""Applied forces and moments as the vector formalism wants them: each on the body that takes it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, Protocol

import sympy as sp

from eomgen.algebra import ldl
from eomgen.algebra.graph import Node
from eomgen.algebra.scalar import S
from eomgen.mechanics import efforts, multipliers, newton_euler_inside, newton_euler_tree
from eomgen.mechanics.constraints import Row
from eomgen.mechanics.efforts import Effort
from eomgen.mechanics.elongation import Element, length, span
from eomgen.mechanics.energies import has_potential
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.newton_euler_inside import Inside
from eomgen.mechanics.vectors import Vector, scale
from eomgen.model import Drive, Model


class Scene(Protocol):
    """A scene on the graph with its accelerations: a `compile.Machine`."""

    @property
    def kinematics(self) -> Kinematics[Node]:
        """Where things are and how they move."""

    @property
    def solution(self) -> tuple[tuple[Node, ...], ldl.Pivots]:
        """u', the derivatives of the speeds."""

    @property
    def rows(self) -> tuple[Row[Node], ...]:
        """Every row of the two-sided constraints."""

    @property
    def kept(self) -> tuple[str, ...]:
        """Names of the independent rows among them."""

    @property
    def linked(self) -> multipliers.Solution:
        """Accelerations and multipliers of a linked scene."""


@dataclass(frozen=True)
class Push(Generic[S]):
    """A force on a point, in world axes [N]."""

    name: str
    point: str
    force: Vector[S]


@dataclass(frozen=True)
class Twist(Generic[S]):
    """A moment on a body, in world axes [N m]."""

    name: str
    body: str
    moment: Vector[S]


@dataclass(frozen=True)
class Unplaced:
    """A load that no body can be named for: the coordinates and bodies that it may act through."""

    name: str
    why: str
    coordinates: frozenset[sp.Symbol]
    bodies: tuple[str, ...] = ()
    along: bool = False  # it acts along coordinates, not on a point


def pushes(scene: Scene) -> list[Push[Node]]:
    """Applied forces, and the multipliers of every constraint that joins two points."""
    return [*applied(scene.kinematics), *_joins(scene)]


def _joins(scene: Scene) -> list[Push[Node]]:
    """Lambda on the first point, minus lambda on the second."""
    zero = scene.kinematics.algebra.number(0)
    names = [row.name for row in scene.rows if row.name in scene.kept]
    values = dict(zip(names, scene.linked.multipliers, strict=True)) if names else {}
    found: list[Push[Node]] = []
    for constraint in scene.kinematics.model.constraints:
        if constraint.points is not None:
            rows = [row.name for row in scene.rows if row.constraint is constraint]
            force = tuple(values.get(name, zero) for name in rows)
            found += both(constraint.name, *constraint.points, force)
    return found


def applied(kinematics: Kinematics[S]) -> Iterator[Push[S]]:
    """Springs, dampers and forces on points; weights are `weight`."""
    for element, effort in _elements(kinematics):
        if element.between is not None:
            first, second = element.between
            pull = _pull(kinematics, element, effort)
            yield from both(element.name, second, first, pull)
    for force in kinematics.model.forces:
        vector = kinematics.to_world(kinematics.vector(force.components), force.axes)
        yield from both(force.name, force.on, force.source, vector)


def both(name: str, on: str, source: str | None, force: Vector[S]) -> Iterator[Push[S]]:
    """A force and, where something takes it, its reaction."""
    yield Push(name, on, force)
    if source is not None:
        yield Push(name, source, tuple(-f for f in force))


def _elements(kinematics: Kinematics[S]) -> Iterator[tuple[Element, Effort[S]]]:
    """Every spring and damper with its effort."""
    model = kinematics.model
    conservative = list(efforts.conservative(kinematics))
    dissipative = list(efforts.dissipative(kinematics))
    others = list(efforts.nonconservative(kinematics))
    groups: tuple[tuple[Sequence[Element], list[Effort[S]], str], ...] = (
        ([s for s in model.springs if has_potential(s)], conservative, "spring"),
        ([s for s in model.springs if not has_potential(s)], others, "spring"),
        ([d for d in model.dampers if d.damping is not None], dissipative, "damper"),
        ([d for d in model.dampers if d.law is not None], others, "damper"),
    )
    for elements, found, kind in groups:
        yield from zip(elements, (e for e in found if e.kind == kind), strict=True)


def _pull(kinematics: Kinematics[S], element: Element, effort: Effort[S]) -> Vector[S]:
    """The force on the second end; a scalar effort works along the element."""
    if len(effort.force) == kinematics.dimensions:
        return effort.force
    tension = effort.force[0] / length(kinematics, element)
    return scale(tension, span(kinematics, element))


def twists(kinematics: Kinematics[S]) -> Iterator[Twist[S]]:
    """Moments, with their reactions."""
    for moment in kinematics.model.moments:
        vector = kinematics.to_world(
            kinematics.vector(moment.components), _axes(moment.axes, kinematics)
        )
        yield Twist(moment.name, moment.on, vector)
        if moment.source is not None:
            yield Twist(moment.name, moment.source, tuple(-m for m in vector))


def _axes(name: str | None, kinematics: Kinematics[S]) -> str | None:
    """In a plane a moment is one number, whatever the axes."""
    return name if kinematics.dimensions == 3 else None


def inside(kinematics: Kinematics[Node]) -> Iterator[tuple[Inside, Node]]:
    """Loads that act in one joint, each with its force along the coordinate."""
    model = kinematics.model
    drives = ((d.along, kinematics.algebra.of(d.force)) for d in model.drives)
    elements = (
        (element.along, effort.force[0])
        for element, effort in _elements(kinematics)
        if element.along is not None
    )
    for along, force in (*elements, *drives):
        found = newton_euler_inside.of(model, along)
        if found is not None:
            yield found, force


def weight(kinematics: Kinematics[S], mass: sp.Expr) -> Vector[S]:
    """M g."""
    gravity = kinematics.vector(kinematics.model.gravity)
    return scale(kinematics.algebra.of(mass), gravity)


def unplaced(scene: Scene) -> Iterator[Unplaced]:
    """Loads along coordinates, energies as formulas, and forces on points that nobody carries."""
    model = scene.kinematics.model
    loads: tuple[Element | Drive, ...] = (*model.springs, *model.dampers, *model.drives)
    for element in loads:
        if element.along is not None and newton_euler_inside.of(model, element.along) is None:
            used = _coordinates(model, element.along)
            names = ", ".join(c.name for c in model.coordinates if c.symbol in used)
            yield Unplaced(element.name, f"{element.name} acts along {names}", used, along=True)
    for letter, term in zip("TVD", _energies(model), strict=True):
        if term != 0:
            yield Unplaced(letter, f"{letter} is given as a formula", _coordinates(model, term))
    for push in pushes(scene):
        if newton_euler_tree.carrier(model, push.point).massless:
            why = f"{push.name} acts on {push.point}, which no body carries"
            coordinates, bodies = newton_euler_tree.reached(model, push.point)
            yield Unplaced(push.name, why, coordinates, bodies)


def _energies(model: Model) -> tuple[sp.Expr, ...]:
    return model.energy.kinetic, model.energy.potential, model.energy.dissipation


def _coordinates(model: Model, formula: sp.Expr) -> frozenset[sp.Symbol]:
    """Coordinates of a formula, by themselves or by their rates."""
    used = formula.free_symbols
    return frozenset(c.symbol for c in model.coordinates if {c.symbol, c.rate} & used)
