"""Trees of rigid bodies as plain numbers, from which every competitor builds its own model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

Numbers = tuple[Fraction, ...]
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
GRAVITY = Fraction("9.81")


@dataclass(frozen=True)
class Link:
    """A joint and the body behind it; where all coordinates are zero all axes are parallel.

    axis: of integers with an integer length; place: of the joint in the parent's axes [m];
    com in own axes from the joint [m]; inertia about it: xx, yy, zz, xy, xz, yz [kg m^2].
    """

    parent: int  # -1: the world
    joint: str  # "turn" or "slide"
    axis: tuple[int, int, int]
    place: Numbers
    mass: Fraction
    com: Numbers
    inertia: Numbers


@dataclass(frozen=True)
class Tree:
    """Links, parents first; one coordinate each. `driven` joints have a force or torque."""

    name: str
    gravity: Numbers
    links: tuple[Link, ...]
    driven: tuple[int, ...]
    planar: bool = False  # a cart with pendulums, whose spec counts angles from the vertical


def decimals(*values: str | int) -> Numbers:
    """Exact numbers."""
    return tuple(Fraction(v) for v in values)


def massless(parent: int, joint: str, axis: tuple[int, int, int]) -> Link:
    """A joint that shares its place with the next one."""
    nothing = decimals(0, 0, 0)
    return Link(parent, joint, axis, nothing, Fraction(0), nothing, nothing * 2)


def limb(index: int, parent: int, axis: tuple[int, int, int]) -> Link:
    """A link on which nothing is zero: full inertia, mass centre off every axis."""
    k = Fraction(index % 7, 100)
    return Link(
        parent,
        "turn",
        axis,
        (Fraction(3, 10) + k, Fraction(1, 10) - k, Fraction(-1, 20) + k / 2),
        Fraction(2) - 10 * k,
        (Fraction(3, 20) - k, Fraction(1, 25) + k, Fraction(-3, 100) - k / 2),
        (
            Fraction(1, 20) + k / 4,
            Fraction(3, 50) - k / 5,
            Fraction(1, 25) + k / 2,
            Fraction(1, 100) - k / 10,
            Fraction(-1, 200) + k / 10,
            Fraction(1, 125) - k / 20,
        ),
    )


def cart(count: int) -> Tree:
    """A cart with a chain of pendulums of point masses, in the x-y plane, y upwards."""
    masses = [f"1.{i % 7 + 1}" for i in range(count + 1)]  # no two neighbours alike
    lengths = [f"0.{i % 5 + 3}5" for i in range(count)]
    place = nothing = decimals(0, 0, 0)
    links = [Link(-1, "slide", X, nothing, Fraction(masses[0]), nothing, nothing * 2)]
    for i, length in enumerate(lengths):
        below = decimals(0, "-" + length, 0)
        links.append(Link(i, "turn", Z, place, Fraction(masses[i + 1]), below, nothing * 2))
        place = below
    return Tree(f"cart_{count}", (Fraction(0), -GRAVITY, Fraction(0)), tuple(links), (0,), True)


def _chain(name: str, axes: list[tuple[int, int, int]]) -> Tree:
    links = tuple(limb(i, i - 1, axis) for i, axis in enumerate(axes))
    return Tree(name, (Fraction(0), Fraction(0), -GRAVITY), links, tuple(range(len(axes))))


def arm(count: int) -> Tree:
    """A spatial arm: axes z, y, x in turn, no two of them meeting; full inertias."""
    return _chain(f"arm_{count}", [(Z, Y, X)[i % 3] for i in range(count)])


def skew_arm(count: int) -> Tree:
    """A spatial arm whose joint axes are parallel to nothing; full inertias."""
    axes = [(1, 2, 2), (2, -1, 2), (2, 3, 6), (2, -2, 1)]
    return _chain(f"skew_arm_{count}", [axes[i % 4] for i in range(count)])


def walker() -> Tree:
    """30 degrees of freedom: a body that slides and turns freely, four legs of six turns each."""
    links = [massless(i - 1, "slide", axis) for i, axis in enumerate((X, Y, Z))]
    links += [massless(2 + i, "turn", axis) for i, axis in enumerate((Z, Y))]
    trunk = limb(0, 4, X)
    links.append(Link(4, "turn", X, decimals(0, 0, 0), 5 * trunk.mass, trunk.com, trunk.inertia))
    for leg in range(4):
        first = len(links)
        for i in range(6):
            links.append(limb(leg + i, first + i - 1 if i else 5, (Z, X, Y, Y, Y, X)[i]))
    return Tree("walker", (Fraction(0), Fraction(0), -GRAVITY), tuple(links), tuple(range(6, 30)))


COLUMNS: dict[str, Callable[[], Tree]] = {
    "cart+2": lambda: cart(2),
    "cart+4": lambda: cart(4),
    "cart+8": lambda: cart(8),
    "cart+16": lambda: cart(16),
    "7-joint arm": lambda: arm(7),
    "7-joint skew arm": lambda: skew_arm(7),
    "30-dof tree": walker,
}
