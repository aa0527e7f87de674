"""The links as a tree: every link but one hangs on a joint, and there is no loop."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from eomgen.spec.ledger import Ledger, Mistake, shown, suggestion
from eomgen.spec.reader import Point
from eomgen.urdf.robot import JOINTS, SINGLE, Joint, Link, Robot

WORLD = ""  # what the root hangs on; no link has an empty name


@dataclass(frozen=True)
class Tree:
    """The joints from the root to the leaves, branch after branch; the first holds the root."""

    joints: tuple[Joint, ...]
    links: Mapping[str, Link]

    def children(self, link: str) -> tuple[Joint, ...]:
        """The joints that hang on a link."""
        return tuple(j for j in self.joints if j.parent == link)


def of(robot: Robot, base: str, ledger: Ledger) -> Tree:
    """The tree of a robot on a `base` joint, fixed or floating; what is wrong is raised."""
    links = {link.name: link for link in robot.links}
    if not links:
        ledger.note(Mistake(Point(1, 1), "E711", "there is no link", "a robot has at least one"))
    for joint in robot.joints:
        for name in (joint.parent, joint.child):
            ledger.attempt(_check_known, name, joint, links)
    holders = _holders(robot, ledger)
    ledger.close()
    roots = [link for link in robot.links if link.name not in holders]
    reached = tuple(_reached(robot, [r.name for r in roots]))
    for mistake in (*_several(roots), *_loops(robot, reached), *_mimics(robot)):
        ledger.note(mistake)
    ledger.close()
    root = roots[0]
    held = Joint(_free_name(robot, root.name), base, root.spot, WORLD, root.name)
    return Tree((held, *reached), links)


def _free_name(robot: Robot, wanted: str) -> str:
    """A name for the joint of the root that no other joint has."""
    taken = {joint.name for joint in robot.joints}
    while wanted in taken:
        wanted += "_"
    return wanted


def _check_known(name: str, joint: Joint, links: Mapping[str, Link]) -> None:
    if name not in links:
        message = f"joint {shown(joint.name)} names the unknown link {shown(name)}"
        raise Mistake(joint.spot, "E710", message, suggestion(name, links))


def _holders(robot: Robot, ledger: Ledger) -> dict[str, Joint]:
    """The joint that each link hangs on."""
    found: dict[str, Joint] = {}
    for joint in robot.joints:
        first = found.setdefault(joint.child, joint)
        if first is not joint:
            message = (
                f"link {shown(joint.child)} hangs on the joints {shown(first.name)} "
                f"and {shown(joint.name)}"
            )
            hint = "a URDF is a tree; cut the loop and close it under 'constraints' of the spec"
            ledger.note(Mistake(joint.spot, "E711", message, hint))
    return found


def _reached(robot: Robot, roots: list[str]) -> Iterator[Joint]:
    """Joints from the roots on, each branch to its leaves before the next."""
    hanging: dict[str, list[Joint]] = {}
    for joint in robot.joints:
        hanging.setdefault(joint.parent, []).append(joint)
    waiting = [j for root in reversed(roots) for j in reversed(hanging.get(root, ()))]
    while waiting:
        joint = waiting.pop()
        yield joint
        waiting += reversed(hanging.get(joint.child, ()))


def _several(roots: list[Link]) -> Iterator[Mistake]:
    if len(roots) > 1:
        names = ", ".join(shown(link.name) for link in roots[:5])
        message = f"{len(roots)} links hang on no joint: {names}{', ...' * (len(roots) > 5)}"
        yield Mistake(roots[1].spot, "E711", message, "join them by fixed joints")


def _loops(robot: Robot, reached: tuple[Joint, ...]) -> Iterator[Mistake]:
    """One fault for the first joint that no root leads to."""
    known = {j.name for j in reached}
    for joint in robot.joints:
        if joint.name not in known:
            message = f"joint {shown(joint.name)} is in a loop that hangs on no root"
            yield Mistake(joint.spot, "E711", message)
            return


def _mimics(robot: Robot) -> Iterator[Mistake]:
    """A joint follows another one with one coordinate, and not itself in the end."""
    joints = {j.name: j for j in robot.joints}
    for joint in robot.joints:
        if joint.mimic is None:
            continue
        leader = joints.get(joint.mimic.joint)
        if leader is None:
            message = f"mimic of the unknown joint {shown(joint.mimic.joint)}"
            yield Mistake(joint.mimic.spot, "E715", message, suggestion(joint.mimic.joint, joints))
        elif leader.kind not in SINGLE:
            count = JOINTS[leader.kind]
            message = f"mimic of joint {shown(leader.name)}, which has {count} coordinates"
            yield Mistake(joint.mimic.spot, "E715", message)
        elif _circles(joint, joints):
            message = f"joint {shown(joint.name)} follows itself in the end"
            yield Mistake(joint.mimic.spot, "E715", message)


def _circles(joint: Joint, joints: Mapping[str, Joint]) -> bool:
    """Whether the chain of leaders comes back to the joint."""
    leader, seen = joint.mimic, {joint.name}
    while leader is not None and leader.joint in joints:
        if leader.joint in seen:
            return leader.joint == joint.name
        seen.add(leader.joint)
        leader = joints[leader.joint].mimic
    return False


def leader(joint: Joint, joints: Mapping[str, Joint]) -> Joint:
    """The joint whose coordinate decides the position of this one."""
    while joint.mimic is not None:
        joint = joints[joint.mimic.joint]
    return joint
