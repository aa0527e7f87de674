"""What a URDF says of a robot, as frozen records: exact decimals in SI units, names as they stand.

URDF: wiki.ros.org/urdf/XML; a link's frame is its joint's, a joint's origin is in the parent link.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal

from eomgen.spec.ledger import Spot

ZERO = Decimal(0)
Triple = tuple[Decimal, Decimal, Decimal]


@dataclass(frozen=True)
class Angle:
    """An angle [rad]: the decimal of the file, or `twelfths` of pi where it was rounded."""

    value: Decimal
    spot: Spot
    twelfths: int | None = None

    @property
    def is_zero(self) -> bool:
        """Whether nothing turns."""
        return self.value == 0 if self.twelfths is None else self.twelfths == 0


@dataclass(frozen=True)
class Origin:
    """A displacement xyz [m], then Rz(yaw) Ry(pitch) Rx(roll); rpy = (roll, pitch, yaw)."""

    xyz: Triple = (ZERO, ZERO, ZERO)
    rpy: tuple[Angle, ...] = ()  # empty: none

    @property
    def turns(self) -> bool:
        """Whether the axes after it are others."""
        return any(not angle.is_zero for angle in self.rpy)

    @property
    def moves(self) -> bool:
        """Whether it is displaced."""
        return any(self.xyz)


@dataclass(frozen=True)
class Inertial:
    """Mass [kg], mass centre and axes, (ixx, iyy, izz, ixy, ixz, iyz) [kg m^2] in these axes."""

    origin: Origin
    mass: Decimal
    inertia: tuple[Decimal, ...]
    spot: Spot  # of the inertia

    @property
    def is_zero(self) -> bool:
        """Whether it says that there is no mass."""
        return not self.mass and not any(self.inertia)


@dataclass(frozen=True)
class Link:
    """A rigid body, or a mere frame."""

    name: str
    spot: Spot
    inertial: Inertial | None = None

    @property
    def is_massless(self) -> bool:
        """Whether it is a mere frame."""
        return self.inertial is None or self.inertial.is_zero


@dataclass(frozen=True)
class Mimic:
    """The joint's position is multiplier * position of `joint` + offset."""

    joint: str
    spot: Spot
    multiplier: Decimal = Decimal(1)
    offset: Decimal = ZERO


@dataclass(frozen=True)
class Joint:
    """How the child link moves on the parent link."""

    name: str
    kind: str  # a key of `JOINTS`
    spot: Spot
    parent: str
    child: str
    origin: Origin = Origin()
    axis: Triple = (Decimal(1), ZERO, ZERO)  # in the joint's frame, any length but zero
    limit: tuple[Decimal, Decimal] | None = None
    damping: Decimal = ZERO
    mimic: Mimic | None = None


JOINTS = {  # kind -> number of coordinates
    "fixed": 0, "revolute": 1, "continuous": 1, "prismatic": 1, "planar": 3, "floating": 6,
}  # fmt: skip
SLIDES = ("prismatic",)  # the one coordinate is a length
SINGLE = tuple(kind for kind, count in JOINTS.items() if count == 1)


@dataclass(frozen=True)
class Robot:
    """Links and joints in the order of the file."""

    name: str
    links: tuple[Link, ...]
    joints: tuple[Joint, ...]
