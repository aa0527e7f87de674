"""Decimals that were meant as fractions of pi."""

from dataclasses import replace
from decimal import Decimal
from fractions import Fraction

from eomgen.urdf.notes import Notes
from eomgen.urdf.numbers import EXACT, written
from eomgen.urdf.robot import Angle, Origin, Robot

PI = Decimal("3.141592653589793238462643383279502884197")
LARGEST = 100  # rad
SUSPICIOUS = Decimal("1e-4")  # so near to a multiple of pi/12 an angle is hardly meant otherwise


def rounded(robot: Robot, within: Decimal, notes: Notes) -> Robot:
    """The robot with every angle of an origin exact that is `within` a multiple of pi/12."""
    text = f"an angle within {within} of a multiple of pi/12 is taken as that"

    def angle(given: Angle) -> Angle:
        if not given.value or not _is_near(given.value, within):
            return given
        notes.add(text, given.spot)
        return replace(given, twelfths=_twelfths(given.value))

    def origin(given: Origin) -> Origin:
        return replace(given, rpy=tuple(angle(a) for a in given.rpy))

    links = tuple(
        replace(link, inertial=replace(link.inertial, origin=origin(link.inertial.origin)))
        if link.inertial
        else link
        for link in robot.links
    )
    joints = tuple(replace(joint, origin=origin(joint.origin)) for joint in robot.joints)
    return replace(robot, links=links, joints=joints)


def point_out(robot: Robot, notes: Notes) -> None:
    """Name angles that look like multiples of pi/12 and are none."""
    for joint in robot.joints:
        for angle in joint.origin.rpy:
            if angle.value and angle.twelfths is None and _is_near(angle.value, SUSPICIOUS):
                text = "an angle near a multiple of pi/12 is kept as it is (see --within)"
                notes.add(text, angle.spot)


def _twelfths(value: Decimal) -> int:
    return int((12 * value / PI).to_integral_value(context=EXACT))


def _is_near(value: Decimal, within: Decimal) -> bool:
    """Whether the angle is one of so many twelfths of pi."""
    return abs(value) < LARGEST and abs(value - _twelfths(value) * PI / 12) <= within


def text(angle: Angle) -> str:
    """The angle as the language writes it."""
    if angle.twelfths is None:
        return written(angle.value)
    share = Fraction(angle.twelfths, 12)
    times = f"{abs(share.numerator)}*" if abs(share.numerator) != 1 else ""
    over = f"/{share.denominator}" if share.denominator != 1 else ""
    return f"{'-' * (share < 0)}{times}pi{over}"
