"""What joints do in terms of coordinates: displacements, turns, motors, dampers, followers."""

from dataclasses import dataclass
from decimal import Decimal

from eomgen.urdf.draft import Draft
from eomgen.urdf.numbers import direction, written
from eomgen.urdf.robot import SINGLE, SLIDES, Joint, Triple
from eomgen.urdf.scene import AXES, NOWHERE, Along, Coordinate, Turn, Vector, plus, times, turn

PITCH = ("-80 deg", "80 deg")  # Euler's angles are singular at 90 deg
ANGLES = (("z", "yaw", None), ("y", "pitch", PITCH), ("x", "roll", None))


@dataclass(frozen=True)
class Motion:
    """A displacement in the axes of the joint, then turns; `position` where it is one scalar."""

    shift: Vector = NOWHERE
    turns: tuple[Turn, ...] = ()
    position: str = "0"


def motions(draft: Draft) -> dict[str, Motion]:
    """The motion of every joint; coordinates, motors and dampers go into the draft."""
    free = {j.name: OWN[j.kind](draft, j) for j in draft.tree.joints if j.mimic is None}
    places = {name: motion.position for name, motion in free.items()}
    found = {}
    for joint in draft.tree.joints:
        _follow(draft, joint, places)
        found[joint.name] = free.get(joint.name) or _single(joint, places[joint.name])
    return found


def _single(joint: Joint, position: str) -> Motion:
    if joint.kind in SLIDES:
        shift = tuple(times(factor, position) for factor in direction(joint.axis))
        return Motion(shift, position=position)
    return Motion(turns=(turn(_axis(joint.axis), position),), position=position)


def _axis(axis: Triple) -> str:
    """`x`, `-z` or `[1, 2, 2]`."""
    if sum(c != 0 for c in axis) > 1:
        return f"[{', '.join(written(c) for c in axis)}]"
    place = next(i for i, c in enumerate(axis) if c)
    return f"{'-' * (axis[place] < 0)}{AXES[place]}"


def _fixed(draft: Draft, joint: Joint) -> Motion:
    return Motion()


def _floating(draft: Draft, joint: Joint) -> Motion:
    """Three displacements in the axes below, then an attitude."""
    shift = tuple(draft.of_joint(axis, joint) for axis in AXES)
    draft.scene.coordinates += [Coordinate(name, "m") for name in shift]
    return Motion(shift, _angles(draft, joint) if draft.euler else _quaternion(draft, joint))


def _angles(draft: Draft, joint: Joint) -> tuple[Turn, ...]:
    """Yaw, pitch and roll."""
    turns = []
    for axis, word, limits in ANGLES:
        name = draft.of_joint(word, joint)
        draft.scene.coordinates.append(Coordinate(name, "rad", limits))
        turns.append(turn(axis, name))
    return tuple(turns)


def _quaternion(draft: Draft, joint: Joint) -> tuple[Turn, ...]:
    """A unit quaternion, whose speeds are the angular velocity."""
    name, speeds = draft.quaternion(joint)
    start = "[1, 0, 0, 0]"
    draft.scene.coordinates.append(Coordinate(name, "quaternion", start=start, speeds=speeds))
    return (f"{{quaternion: {name}}}",)


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
    return Motion(tuple(shift), (turn(_axis(joint.axis), angle),))


def _follow(draft: Draft, joint: Joint, places: dict[str, str]) -> None:
    """The position of a joint and, before it, of the joints that it follows."""
    joints = {j.name: j for j in draft.tree.joints}
    chain = [joint]
    while (mimic := chain[-1].mimic) and chain[-1].name not in places:
        chain.append(joints[mimic.joint])
    for follower in reversed(chain[:-1]):
        places[follower.name] = _followed(draft, follower, joints, places)


def _driven(draft: Draft, joint: Joint) -> Motion:
    """A new coordinate, with its motor."""
    slides = joint.kind in SLIDES
    name, motor = draft.of_joint("q", joint), draft.of_joint("tau", joint)
    unit = "m" if slides else "rad"
    draft.scene.coordinates.append(Coordinate(name, unit, *_limits(joint, unit)))
    draft.scene.inputs[motor] = "N" if slides else "N*m"
    draft.scene.forces.append(Along(draft.joints[joint.name], name, motor))
    return _single(joint, name)


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


OWN = {  # kind of joint -> its motion where it follows no other
    "fixed": _fixed, "floating": _floating, "planar": _planar, **dict.fromkeys(SINGLE, _driven),
}  # fmt: skip
