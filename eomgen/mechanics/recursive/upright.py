"""Axes for a body on a skew joint: z along the joint, x across it and the next joint's axis.

So the constant turn from one skew joint to the next is about x (Denavit & Hartenberg, A kinematic
notation for lower-pair mechanisms based on matrices, 1955), and a turn about both has a zero.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.algebra.graph import Node, sqrt
from eomgen.mechanics.vectors import Matrix, Vector, compose, cross, dot, scale

NEARLY_PARALLEL = 1e-6  # the sine of an angle between axes


@dataclass(frozen=True)
class Upright:
    """A constant rotation to axes of which z is along a joint, or against it (sign -1).

    sine, cosine: of a constant angle by which the axes turn further about the joint.
    """

    matrix: Matrix[Node]
    sign: int
    sine: Node
    cosine: Node

    @property
    def tilt(self) -> tuple[Node, Node] | None:
        """Sine and cosine of the angle where the rotation is about x."""
        (_, _, x), (_, _, y), (_, _, z) = self.matrix
        return (-y, z) if x is x.graph.zero else None

    @property
    def axes(self) -> Matrix[Node]:
        """The final axes where the angle of the joint is zero."""
        zero, one = self.sine.graph.zero, self.sine.graph.one
        s, c = self.sine, self.cosine
        return compose(self.matrix, ((c, -s, zero), (s, c, zero), (zero, zero, one)))


def upright(axis: Vector[Node]) -> Upright:
    """By the shortest turn to a unit vector: 1 + [n x] + [n x]^2 / (1 + e_z) with n = z x e."""
    zero, one = axis[0].graph.zero, axis[0].graph.one
    sign = -1 if number(axis[2]) < 0 else 1
    x, y, z = (sign * a for a in axis)
    share = 1 / (1 + z)
    # where x is zero, y^2 = (1 - z) (1 + z)
    middle = z if x is zero else 1 - y * y * share
    matrix = (
        (1 - x * x * share, -(x * y * share), x),
        (-(x * y * share), middle, y),
        (-x, -y, z),
    )
    return Upright(matrix, sign, zero, one)


def towards(
    found: Upright, across: Vector[Node], along: Vector[Node], following: Vector[Node]
) -> tuple[Upright, Vector[Node], Matrix[Node]] | None:
    """The axes turned about z until the next joint's axis has no part along x.

    With it come that axis in the axes found, and these axes as columns. All three vectors are of
    one body, so that no constant is made of those of the bodies before: across, along: x and z of
    the axes before they are turned; following: the next joint's axis. None where it is nearly
    parallel.
    """
    normal = cross(along, following)
    size = sqrt(dot(normal, normal))
    if number(size) < NEARLY_PARALLEL:
        return None
    x = scale(1 / size, normal)
    y, before = cross(along, x), cross(along, across)
    turned = replace(found, sine=dot(x, before), cosine=dot(x, across))
    own = (size.graph.zero, -size, dot(along, following))
    return turned, own, tuple(zip(x, y, along, strict=True))


def number(value: Node) -> float:
    """The value of a node without leaves."""
    (found,) = evaluate([value], {}, FLOAT)
    return float(found)
