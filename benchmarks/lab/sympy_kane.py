"""Trees by SymPy's KanesMethod: M q'' = f, unsimplified."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp
from sympy.physics.mechanics import (
    KanesMethod,
    Particle,
    Point,
    ReferenceFrame,
    RigidBody,
    dynamicsymbols,
    inertia,
)
from sympy.physics.mechanics.models import n_link_pendulum_on_cart

from lab.trees import Link, Tree


@dataclass(frozen=True)
class Kane:
    """M, f and what they are functions of; `values` are those of the constants."""

    mass_matrix: sp.Matrix
    forcing: sp.Matrix
    coordinates: list[sp.Expr]
    speeds: list[sp.Expr]
    inputs: list[sp.Expr]
    constants: list[sp.Symbol]
    values: list[float]
    upside_down: bool = False  # angles count from the upward vertical


def derive(tree: Tree) -> Kane:
    """The equations of a tree."""
    return _cart(tree) if tree.planar else _spatial(tree)


def _cart(tree: Tree) -> Kane:
    """SymPy's own ready-made scene, whose angles count from the upward vertical."""
    n = len(tree.links) - 1
    kane = n_link_pendulum_on_cart(n, cart_force=True)
    masses, lengths = sp.symbols(f"m:{n + 1}"), sp.symbols(f"l:{n}")
    values = [float(k.mass) for k in tree.links] + [-float(k.com[1]) for k in tree.links[1:]]
    return Kane(
        kane.mass_matrix,
        kane.forcing,
        list(kane.q),
        list(kane.u),
        [dynamicsymbols("F")],
        [*masses, *lengths, sp.Symbol("g")],
        [*values, -float(tree.gravity[1])],
        upside_down=True,
    )


class _Scene:
    """What the bodies have in common while they are put together."""

    def __init__(self, tree: Tree) -> None:
        n = len(tree.links)
        self.q, self.u = list(dynamicsymbols(f"q:{n}")), list(dynamicsymbols(f"u:{n}"))
        self.tau = list(dynamicsymbols(f"tau:{n}"))
        self.world, self.origin = ReferenceFrame("N"), Point("O")
        self.origin.set_vel(self.world, 0)
        self.gravity = sp.Symbol("g")
        self.constants: dict[sp.Symbol, float] = {self.gravity: -float(tree.gravity[2])}
        self.frames: list[ReferenceFrame] = []
        self.joints: list[Point] = []
        self.bodies: list[RigidBody | Particle] = []
        self.loads: list[tuple[object, object]] = []

    def constant(self, name: str, value: float) -> sp.Symbol:
        symbol = sp.Symbol(name)
        self.constants[symbol] = value
        return symbol


def _spatial(tree: Tree) -> Kane:
    scene = _Scene(tree)
    for i, link in enumerate(tree.links):
        _add(scene, i, link, i in tree.driven)
    equations = [q.diff() - u for q, u in zip(scene.q, scene.u, strict=True)]
    kane = KanesMethod(scene.world, q_ind=scene.q, u_ind=scene.u, kd_eqs=equations)
    kane.kanes_equations(scene.bodies, scene.loads)
    return Kane(
        kane.mass_matrix,
        kane.forcing,
        scene.q,
        scene.u,
        [scene.tau[i] for i in tree.driven],
        list(scene.constants),
        list(scene.constants.values()),
    )


def _add(scene: _Scene, i: int, link: Link, driven: bool) -> None:
    """A joint with its frame and points, and the body behind it."""
    parent = scene.world if link.parent < 0 else scene.frames[link.parent]
    before = scene.origin if link.parent < 0 else scene.joints[link.parent]
    axis = parent.x * link.axis[0] + parent.y * link.axis[1] + parent.z * link.axis[2]
    axis = axis / sp.sqrt(sum(a * a for a in link.axis))
    frame = ReferenceFrame(f"B{i}")
    place = _components(scene, f"r{i}", link.place, parent)
    if link.joint == "slide":
        frame.orient_axis(parent, axis, 0)
        place += scene.q[i] * axis
    else:
        frame.orient_axis(parent, axis, scene.q[i])
        frame.set_ang_vel(parent, scene.u[i] * axis)
    joint = before.locatenew(f"P{i}", place)
    _set_velocity(scene, joint, before, parent, link, i)
    scene.frames.append(frame)
    scene.joints.append(joint)
    if link.mass:
        scene.bodies.append(_body(scene, i, link))
    if driven:
        torque = scene.tau[i] * axis
        scene.loads += [(frame, torque), (parent, -torque)]


def _set_velocity(
    scene: _Scene, joint: Point, before: Point, parent: ReferenceFrame, link: Link, i: int
) -> None:
    if link.joint == "slide":
        moved = joint.pos_from(before).dt(parent).subs(scene.q[i].diff(), scene.u[i])
        joint.set_vel(parent, moved)
        joint.set_vel(scene.world, joint.pos_from(scene.origin).dt(scene.world).subs(
            {q.diff(): u for q, u in zip(scene.q, scene.u, strict=True)}
        ))
    else:
        joint.v2pt_theory(before, scene.world, parent)


def _components(scene: _Scene, name: str, values: tuple[object, ...], frame: ReferenceFrame):
    named = [scene.constant(f"{name}{a}", float(v)) if v else 0 for a, v in zip("xyz", values)]
    return named[0] * frame.x + named[1] * frame.y + named[2] * frame.z


def _body(scene: _Scene, i: int, link: Link) -> RigidBody:
    frame, joint = scene.frames[i], scene.joints[i]
    centre = joint.locatenew(f"C{i}", _components(scene, f"c{i}", link.com, frame))
    centre.v2pt_theory(joint, scene.world, frame)
    mass = scene.constant(f"m{i}", float(link.mass))
    names = ("xx", "yy", "zz", "xy", "xz", "yz")
    xx, yy, zz, xy, xz, yz = (
        scene.constant(f"I{i}{name}", float(v)) for name, v in zip(names, link.inertia, strict=True)
    )
    scene.loads.append((centre, -mass * scene.gravity * scene.world.z))
    tensor = inertia(frame, xx, yy, zz, xy, yz, xz)
    return RigidBody(f"body{i}", centre, frame, mass, (tensor, centre))
