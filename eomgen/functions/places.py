"""Where a named point or body is, how fast it moves, and its Jacobian; in world axes.

A body is its mass centre; one that can be seen to turn has its angular velocity behind.
"""

from __future__ import annotations

from eomgen.algebra.graph import Node
from eomgen.algebra.jacobian import Rows, jacobian
from eomgen.errors import UsageError
from eomgen.functions.motion import Motion
from eomgen.mechanics import efforts
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.vectors import Vector
from eomgen.model import Body, Model


def names(model: Model) -> tuple[str, ...]:
    """Everything that has a place."""
    return (*(p.name for p in model.points), *(b.name for b in model.bodies))


def position(motion: Motion, name: str) -> Vector[Node]:
    """The position [m].

    Raises:
        UsageError: there is no such point or body.
    """
    known = names(motion.machine.model)
    if name not in known:
        raise UsageError(f"no point or body {name!r}; there are {', '.join(known) or 'none'}")
    return motion.machine.kinematics.position(name)


def velocity(motion: Motion, name: str) -> Vector[Node]:
    """The velocity [m/s], and the angular velocity [rad/s] of a body that turns."""
    position(motion, name)
    kinematics = motion.machine.kinematics
    found = kinematics.velocity(name)
    body = kinematics.bodies.get(name)
    return (*found, *angular(kinematics, body)) if body is not None and turns(body) else found


def about_velocity(motion: Motion, name: str) -> str:
    """What the components of `velocity` are."""
    body = motion.machine.kinematics.bodies.get(name)
    angular_too = body is not None and turns(body) and motion.machine.kinematics.dimensions > 1
    behind = ", then its angular velocity [rad/s]" if angular_too else ""
    return f"velocity of {name} [m/s]{behind}, world axes"


def turns(body: Body) -> bool:
    """Whether a body has axes of its own: it is a rod, it has inertia, or its frame turns."""
    frame = body.frame
    return bool(frame.along or body.inertia or frame.turns or frame.origin.on)


def angular(kinematics: Kinematics[Node], body: Body) -> Vector[Node]:
    """The angular velocity: one component in a plane, three in world axes in solid space."""
    if kinematics.dimensions == 1:
        return ()
    if kinematics.dimensions == 2:
        return kinematics.angular_velocity(body.name)
    return efforts.world_spin(kinematics, body.name)


def point_jacobian(motion: Motion, name: str) -> Rows:
    """d velocity / d u, a row for each component of `velocity`."""
    speeds = motion.state[len(motion.state) - motion.size :]
    return jacobian(velocity(motion, name), speeds)
