"""Robot -> scene: what has mass or carries axes becomes a body.

A body's frame is that of its link: displaced and turned by the joint's origin, then moved by its
coordinates. Axes that are displaced and turned and then slide are a frame of their own. A link that
cannot move has no mass here; a link without mass, turn and successors is a point.
"""

from dataclasses import replace

from eomgen.spec.ledger import Ledger, Mistake, shown
from eomgen.spec.reader import Point
from eomgen.urdf import angles, inertias
from eomgen.urdf.draft import Draft
from eomgen.urdf.motion import Motion, damp, motions
from eomgen.urdf.parts import Book
from eomgen.urdf.robot import Inertial, Joint, Link, Origin
from eomgen.urdf.scene import NOWHERE, Body, Frame, Scene, Turn, plus, turn
from eomgen.urdf.tree import WORLD, Tree, leader
from eomgen.urdf.wishes import Wishes

TENSOR = ("xx", "yy", "zz", "xy", "xz", "yz")


def scene(tree: Tree, book: Book, wishes: Wishes) -> Scene:
    """The scene of a robot; raises `SpecError` where something cannot move as it should."""
    _check_motion(tree, book.ledger)
    _check_masses(tree, book.ledger)
    still = _still(tree)
    links = {n: _weighed(link, n in still, book, wishes.mend) for n, link in tree.links.items()}
    book.ledger.close()
    draft = Draft(replace(tree, links=links), book.notes, wishes.euler)
    moving = motions(draft)
    frames: dict[str, str | None] = {WORLD: None}
    for joint in tree.joints:
        frames[joint.child] = _placed(draft, joint, moving[joint.name], frames)
        if joint.damping and moving[joint.name].position != "0":
            damp(draft, joint, moving[joint.name].position)
    return draft.scene


def _still(tree: Tree) -> set[str]:
    """The links that cannot move."""
    still = {WORLD}
    for joint in tree.joints:
        if joint.kind == "fixed" and joint.parent in still:
            still.add(joint.child)
    return still


def _weighed(link: Link, is_still: bool, book: Book, mend: bool) -> Link:
    """The link with an inertia that a body can have; without mass where it cannot move."""
    if link.is_massless or link.inertial is None:
        return replace(link, inertial=None)
    if is_still:
        book.notes.add("the mass of a link that cannot move has no effect", link.spot)
        return replace(link, inertial=None)
    if mend:
        return inertias.mended(link, book.notes)
    book.ledger.attempt(inertias.check, link.name, link.inertial)
    return link


def _check_motion(tree: Tree, ledger: Ledger) -> None:
    if all(joint.kind == "fixed" or joint.mimic for joint in tree.joints):
        hint = "--floating-base lets the whole robot move"
        ledger.note(Mistake(Point(1, 1), "E716", "nothing of this robot can move", hint))


def _check_masses(tree: Tree, ledger: Ledger) -> None:
    """Every coordinate moves some mass."""
    heavy = {name for name, link in tree.links.items() if not link.is_massless}
    for joint in reversed(tree.joints):
        if joint.child in heavy:
            heavy.add(joint.parent)
    joints = {j.name: j for j in tree.joints}
    moved = {leader(j, joints).name for j in tree.joints if j.child in heavy}
    for joint in tree.joints:
        if joint.kind != "fixed" and joint.mimic is None and joint.name not in moved:
            message = f"nothing that joint {shown(joint.name)} moves has mass"
            hint = "give a link an 'inertial', or make the joint fixed"
            ledger.note(Mistake(joint.spot, "E717", message, hint))


def _placed(
    draft: Draft, joint: Joint, motion: Motion, frames: dict[str, str | None]
) -> str | None:
    """The name of the frame of the joint's child; it may be that of the parent."""
    link = draft.tree.links[joint.child]
    on = frames[joint.parent]
    if link.inertial is None and joint.kind == "fixed" and not joint.origin.turns:
        if not draft.tree.children(link.name):
            _point(draft, link, joint.origin, on)
            return on
        if not joint.origin.moves:
            return on
    frame = _frame(draft, joint, motion, on)
    name = draft.link(link)
    if link.inertial is None:
        draft.scene.bodies.append(Body(name, frame))
    else:
        _weigh(draft, joint.child, frame, link.inertial)
    return name


def _point(draft: Draft, link: Link, origin: Origin, on: str | None) -> None:
    """A point for a link of which nothing but the place matters; none for the world's origin."""
    if on is not None or origin.moves:
        at = draft.vector(link.name, "p", origin.xyz)
        draft.scene.points[draft.link(link)] = Frame(on, at)


def _frame(draft: Draft, joint: Joint, motion: Motion, on: str | None) -> Frame:
    """The frame after the joint's origin and motion."""
    origin = Frame(on, draft.vector(joint.child, "p", joint.origin.xyz), _turns(joint.origin))
    if origin.turns and motion.shift != NOWHERE:
        name = draft.names.new(f"{draft.links[joint.child]}_frame")
        draft.scene.bodies.append(Body(name, origin))
        origin = Frame(name)
    at = tuple(plus(a, b) for a, b in zip(origin.at, motion.shift, strict=True))
    return Frame(origin.on, at, origin.turns + motion.turns)


def _turns(origin: Origin) -> tuple[Turn, ...]:
    """Rz(yaw) Ry(pitch) Rx(roll), body-fixed from left to right, without zeros."""
    pairs = zip("zyx", reversed(origin.rpy), strict=False)
    return tuple(turn(axis, angles.text(angle)) for axis, angle in pairs if not angle.is_zero)


def _weigh(draft: Draft, link: str, frame: Frame, inertial: Inertial) -> None:
    """The body of a link with mass; turned axes of its inertia are a body of their own."""
    name = draft.links[link]
    mass = draft.parameter(link, f"m_{name}", inertial.mass, "kg")
    com = draft.vector(link, "c", inertial.origin.xyz)
    inertia = tuple(
        draft.parameter(link, f"I_{name}_{at}", value, "kg*m^2")
        for at, value in zip(TENSOR, inertial.inertia, strict=True)
    )
    inertia = inertia if any(entry != "0" for entry in inertia) else ()
    if inertia and inertial.origin.turns:
        draft.scene.bodies.append(Body(name, frame))
        name = draft.names.new(f"{name}_inertial")
        frame, com = Frame(draft.links[link], com, _turns(inertial.origin)), NOWHERE
    draft.scene.bodies.append(Body(name, frame, mass, com, inertia))
