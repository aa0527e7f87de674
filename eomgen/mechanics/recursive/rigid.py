"""The inertia of a rigid body: mass, first and second moments about an origin, in one set of axes.

Spatial vectors have the rotational part first: a twist (w, v), a wrench (n, f), with v of the
origin and n about it; the inertia maps twists to wrenches (Featherstone, Rigid Body Dynamics
Algorithms, 2008, ch. 2, with body axes).
"""

from __future__ import annotations

from dataclasses import dataclass

from eomgen.algebra.graph import Node
from eomgen.mechanics.vectors import Matrix, Vector, add, compose, cross, scale, transform
from eomgen.mechanics.vectors import transpose as transposed

PAIRS = ((1, 2), (2, 0), (0, 1))  # the axes that a turn about x, y or z mixes


@dataclass(frozen=True)
class Rigid:
    """Mass [kg], first moment [kg m] (2 or 3 components), second moment [kg m^2] (1x1 or 3x3)."""

    mass: Node
    first: Vector[Node]
    second: Matrix[Node]

    @property
    def moments(self) -> tuple[Node, ...]:
        """Mass, first moments, and second moments, each once."""
        second = (row[j] for i, row in enumerate(self.second) for j in range(i + 1))
        return (self.mass, *self.first, *second)

    def __add__(self, other: Rigid) -> Rigid:
        """Both, in the same axes about the same origin."""
        rows = zip(self.second, other.second, strict=True)
        return Rigid(
            self.mass + other.mass,
            add(self.first, other.first),
            tuple(add(a, b) for a, b in rows),
        )


def about_origin(mass: Node, com: Vector[Node], inertia: Matrix[Node]) -> Rigid:
    """A body from its inertia about the mass centre (Steiner)."""
    zero = mass.graph.zero
    none = tuple(zero for _ in com)
    central = Rigid(zero, none, inertia)
    return central + shifted(Rigid(mass, none, _zeros(zero, len(inertia))), com)


def _zeros(zero: Node, size: int) -> Matrix[Node]:
    return tuple((zero,) * size for _ in range(size))


def shifted(body: Rigid, arm: Vector[Node]) -> Rigid:
    """About another origin, from which the old one is at `arm`, in the same axes."""
    # h' = h + m r,  J' = J + r.(h + h') 1 - (h r' + r h'')
    first = add(body.first, scale(body.mass, arm))
    along = tuple(r * w for r, w in zip(arm, add(body.first, first), strict=True))
    if len(arm) == 2:
        return Rigid(body.mass, first, ((body.second[0][0] + (along[0] + along[1]),),))
    rows = [list(row) for row in body.second]
    for i, j in PAIRS:
        k = 3 - i - j
        rows[k][k] = rows[k][k] + (along[i] + along[j])
        rows[i][j] = rows[j][i] = rows[i][j] - (body.first[i] * arm[j] + arm[i] * first[j])
    return Rigid(body.mass, first, tuple(tuple(row) for row in rows))


def rotated(body: Rigid, matrix: Matrix[Node]) -> Rigid:
    """In other axes, of which the columns of `matrix` are the old ones: R h, R J R'."""
    second = turned_tensor(body.second, matrix)
    return Rigid(body.mass, transform(matrix, body.first), second)


def turned_tensor(tensor: Matrix[Node], matrix: Matrix[Node]) -> Matrix[Node]:
    """R J R', each entry of the symmetric result once."""
    second = compose(compose(matrix, tensor), transposed(matrix))
    return tuple(tuple(second[max(i, j)][min(i, j)] for j in range(3)) for i in range(3))


def wrench(body: Rigid, spin: Vector[Node], acceleration: Vector[Node]) -> Vector[Node]:
    """n = J alpha + w x J w + h x a,  f = m a + U h,  with U = [alpha x] + [w x]^2."""
    alpha, linear = acceleration[:3], acceleration[3:]
    u = swirl(spin, alpha)
    j = body.second
    moment = []
    for axis, (p, q) in enumerate(PAIRS):
        # (J alpha + w x J w)_x = J_xx alpha_x + (J_zz - J_yy) w_y w_z + ...
        turned = j[axis][axis] * alpha[axis] + (j[q][q] - j[p][p]) * (spin[p] * spin[q])
        turned = turned - j[axis][p] * u[q][axis] + j[axis][q] * u[p][axis]
        moment.append(turned + j[p][q] * (spin[p] * spin[p] - spin[q] * spin[q]))
    force = add(scale(body.mass, linear), transform(u, body.first))
    return (*add(tuple(moment), cross(body.first, linear)), *force)


def swirl(spin: Vector[Node], alpha: Vector[Node]) -> Matrix[Node]:
    """U = [alpha x] + [w x]^2: the acceleration of a fixed point at r is a + U r."""
    (x, y, z), (e, f, g) = spin, alpha
    xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
    return (
        (-(yy + zz), xy - g, xz + f),
        (xy + g, -(xx + zz), yz - e),
        (xz - f, yz + e, -(xx + yy)),
    )


def tilde(a: Vector[Node]) -> Matrix[Node]:
    """[a x]."""
    zero = a[0].graph.zero
    return ((zero, -a[2], a[1]), (a[2], zero, -a[0]), (-a[1], a[0], zero))


def matrix(body: Rigid) -> Matrix[Node]:
    """[[J, h x], [-h x, m 1]] (6, 6); in the plane (3, 3)."""
    zero, m, h = body.mass.graph.zero, body.mass, body.first
    if len(h) == 2:
        return ((body.second[0][0], -h[1], h[0]), (-h[1], m, zero), (h[0], zero, m))
    coupling = tilde(h)
    upper = [(*row, *beside) for row, beside in zip(body.second, coupling, strict=True)]
    lower = [
        (*(coupling[j][i] for j in range(3)), *(m if i == j else zero for j in range(3)))
        for i in range(3)
    ]
    return (*upper, *lower)


def product(body: Rigid, twist: Vector[Node]) -> Vector[Node]:
    """The momentum of a twist: n = J w + h x v, f = m v - h x w."""
    if len(body.first) == 2:
        return transform(matrix(body), twist)
    spin, linear = twist[:3], twist[3:]
    moment = add(transform(body.second, spin), cross(body.first, linear))
    return (*moment, *add(scale(body.mass, linear), cross(spin, body.first)))


def squares(body: Rigid) -> Node:
    """A bound of the second moments: their sum over the axes."""
    total = body.mass.graph.zero
    for i, row in enumerate(body.second):
        total = total + row[i]
    return total


def particle(mass: Node, dimensions: int) -> Rigid:
    """A mass at the origin."""
    zero = mass.graph.zero
    return Rigid(mass, (zero,) * dimensions, _zeros(zero, 1 if dimensions == 2 else 3))


def nothing(zero: Node, dimensions: int) -> Rigid:
    """No inertia."""
    return particle(zero, dimensions)
