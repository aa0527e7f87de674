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
    Vector,
    dynamicsymbols,
    inertia,
)
from sympy.physics.mechanics.models import n_link_pendulum_on_cart

from lab.trees import Link, Numbers, Tree


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

    @property
    def arguments(self) -> list[sp.Expr]:
        """What is a function of time."""
        return [*self.coordinates, *self.speeds, *self.inputs]


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
    axis = parent.x * link.axis[0] + parent.y * link.axis[1] + parent.z * link.axis[2]
    axis = axis / sp.sqrt(sum(a * a for a in link.axis))
    frame = ReferenceFrame(f"B{i}")
    frame.orient_axis(parent, axis, 0 if link.joint == "slide" else scene.q[i])
    scene.joints.append(_joint(scene, i, link, axis))
    scene.frames.append(frame)
    if link.joint == "turn":
        frame.set_ang_vel(parent, scene.u[i] * axis)
    if link.mass:
        scene.bodies.append(_body(scene, i, link))
    if driven:
        torque = scene.tau[i] * axis
        scene.loads += [(frame, torque), (parent, -torque)]


def _joint(scene: _Scene, i: int, link: Link, axis: Vector) -> Point:
    """The point of a joint, with its velocity."""
    parent = scene.world if link.parent < 0 else scene.frames[link.parent]
    before = scene.origin if link.parent < 0 else scene.joints[link.parent]
    place = _components(scene, f"r{i}", link.place, parent)
    if link.joint == "turn":
        joint = before.locatenew(f"P{i}", place)
        joint.v2pt_theory(before, scene.world, parent)
        return joint
    joint = before.locatenew(f"P{i}", place + scene.q[i] * axis)
    joint.set_vel(parent, scene.u[i] * axis)
    joint.v1pt_theory(before, scene.world, parent)
    return joint


def _components(scene: _Scene, name: str, values: Numbers, frame: ReferenceFrame) -> Vector:
    named = [scene.constant(f"{name}_{i}", float(v)) if v else 0 for i, v in enumerate(values)]
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


def masses(count: int) -> Kane:
    """The chain of masses, springs and dampers."""
    q, u = list(dynamicsymbols(f"x:{count}")), list(dynamicsymbols(f"v:{count}"))
    world, origin, force = ReferenceFrame("N"), Point("O"), dynamicsymbols("F")
    origin.set_vel(world, 0)
    names = [sp.symbols(f"{n}:{count}") for n in "mkc"]
    pulls = [
        k * (q[i] - (q[i - 1] if i else 0)) + c * (u[i] - (u[i - 1] if i else 0))
        for i, (_, k, c) in enumerate(zip(*names, strict=True))
    ]
    bodies, loads = [], []
    for i, mass in enumerate(names[0]):
        point = origin.locatenew(f"P{i}", q[i] * world.x)
        point.set_vel(world, u[i] * world.x)
        bodies.append(Particle(f"B{i}", point, mass))
        beyond = pulls[i + 1] if i + 1 < count else force
        loads.append((point, (beyond - pulls[i]) * world.x))
    equations = [a.diff() - b for a, b in zip(q, u, strict=True)]
    kane = KanesMethod(world, q_ind=q, u_ind=u, kd_eqs=equations)
    kane.kanes_equations(bodies, loads)
    constants = [s for group in names for s in group]
    return Kane(kane.mass_matrix, kane.forcing, q, u, [force], constants, [])
