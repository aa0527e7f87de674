"""What joints do in terms of coordinates: displacements, turns, motors, dampers, followers."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal

from eomgen.urdf.draft import Draft
from eomgen.urdf.numbers import direction, written
from eomgen.urdf.robot import SINGLE, SLIDES, Joint, Triple
from eomgen.urdf.scene import AXES, NOWHERE, Along, Coordinate, Turn, Vector, plus, times

PITCH = ("-80 deg", "80 deg")  # Euler's angles are singular at 90 deg
FLOATING = (("x", "m"), ("y", "m"), ("z", "m"), ("yaw", "rad"), ("pitch", "rad"), ("roll", "rad"))


@dataclass(frozen=True)
class Motion:
    """A displacement in the axes of the joint, then turns."""

    shift: Vector = NOWHERE
    turns: tuple[Turn, ...] = ()


def motions(draft: Draft, positions: Mapping[str, str]) -> dict[str, Motion]:
    """The motion of every joint; coordinates of floating and planar ones go into the draft."""
    found = {}
    for joint in draft.tree.joints:
        if joint.kind in SINGLE:
            found[joint.name] = _single(joint, positions[joint.name])
        else:
            found[joint.name] = OTHERS[joint.kind](draft, joint)
    return found


def _single(joint: Joint, position: str) -> Motion:
    if joint.kind in SLIDES:
        return Motion(tuple(times(factor, position) for factor in direction(joint.axis)))
    return Motion(turns=((_axis(joint.axis), position),))


def _axis(axis: Triple) -> str:
    """`x`, `-z` or `[1, 2, 2]`."""
    if sum(c != 0 for c in axis) > 1:
        return f"[{', '.join(written(c) for c in axis)}]"
    place = next(i for i, c in enumerate(axis) if c)
    return f"{'-' * (axis[place] < 0)}{AXES[place]}"


def _fixed(draft: Draft, joint: Joint) -> Motion:
    return Motion()


def _floating(draft: Draft, joint: Joint) -> Motion:
    """Three displacements in the axes below, then yaw, pitch and roll."""
    names = [draft.of_joint(word, joint) for word, _ in FLOATING]
    for name, (word, unit) in zip(names, FLOATING, strict=True):
        limits = PITCH if word == "pitch" else None
        draft.scene.coordinates.append(Coordinate(name, unit, limits))
    x, y, z, yaw, pitch, roll = names
    return Motion((x, y, z), (("z", yaw), ("y", pitch), ("x", roll)))


def _planar(draft: Draft, joint: Joint) -> Motion:
    """Two displacements across the axis, in cyclic order, and a turn about it."""
    normal = next(i for i, c in enumerate(joint.axis) if c)
    first, second = (normal + 1) % 3, (normal + 2) % 3
    shift = list(NOWHERE)
    for place in (first, second):
        shift[place] = draft.of_joint(AXES[place], joint)
        draft.scene.coordinates.append(Coordinate(shift[place], "m"))
    angle = draft.of_joint("theta", joint)
    draft.scene.coordinates.append(Coordinate(angle, "rad"))
    return Motion(tuple(shift), ((_axis(joint.axis), angle),))


OTHERS = {"fixed": _fixed, "floating": _floating, "planar": _planar}


def positions(draft: Draft) -> dict[str, str]:
    """The position of every joint of one coordinate; these and their motors go into the draft."""
    joints = {j.name: j for j in draft.tree.joints if j.kind in SINGLE}
    found: dict[str, str] = {}
    for joint in joints.values():
        if joint.mimic is None:
            found[joint.name] = _coordinate(draft, joint)
    for joint in joints.values():
        chain = list(_unknown_leaders(joint, joints, found))
        for follower in reversed(chain):
            found[follower.name] = _followed(draft, follower, joints, found)
    return found


def _unknown_leaders(
    joint: Joint, joints: dict[str, Joint], found: dict[str, str]
) -> Iterator[Joint]:
    """The joint and its leaders up to one whose position is known."""
    while joint.name not in found:
        assert joint.mimic is not None
        yield joint
        joint = joints[joint.mimic.joint]


def _coordinate(draft: Draft, joint: Joint) -> str:
    """A new coordinate, with its motor."""
    slides = joint.kind in SLIDES
    name, motor = draft.of_joint("q", joint), draft.of_joint("tau", joint)
    unit = "m" if slides else "rad"
    draft.scene.coordinates.append(Coordinate(name, unit, *_limits(joint, unit)))
    draft.scene.inputs[motor] = "N" if slides else "N*m"
    draft.scene.forces.append(Along(draft.joints[joint.name], name, motor))
    return name


def _limits(joint: Joint, unit: str) -> tuple[tuple[str, str] | None, str]:
    """The range, and zero as the start or else the middle of the range."""
    if joint.limit is None:
        return None, "0"
    lower, upper = joint.limit
    start = Decimal(0) if lower <= 0 <= upper else (lower + upper) / 2
    least, most, begin = (
        f"{written(v)} {unit}" if unit == "m" and v else written(v) for v in (lower, upper, start)
    )
    return (least, most), begin


def _followed(draft: Draft, joint: Joint, joints: dict[str, Joint], found: dict[str, str]) -> str:
    """Multiplier * position of the leader + offset."""
    mimic = joint.mimic
    assert mimic is not None
    slides, leads = joint.kind in SLIDES, joints[mimic.joint].kind in SLIDES
    name, link = draft.joints[joint.name], joint.child
    factor, offset = written(mimic.multiplier), written(mimic.offset)
    if slides != leads:
        unit = "m" if slides else "m^-1"
        factor = draft.parameter(link, f"k_{name}", mimic.multiplier, unit)
    if slides:
        offset = draft.parameter(link, f"o_{name}", mimic.offset, "m")
    return plus(times(factor, found[mimic.joint]), offset)


def damp(draft: Draft, joint: Joint, position: str) -> None:
    """Put a damper along the position of a joint into the draft."""
    unit = "N*s/m" if joint.kind in SLIDES else "N*m*s"
    name = draft.joints[joint.name]
    damping = draft.parameter(joint.child, f"d_{name}", joint.damping, unit)
    draft.scene.dampers.append(Along(name, position, damping))
