"""A scene while it is being made: its names are given here, each once."""

from decimal import Decimal

from eomgen.spec.ledger import shown
from eomgen.urdf.names import Names
from eomgen.urdf.notes import Notes
from eomgen.urdf.numbers import written
from eomgen.urdf.robot import Joint, Link
from eomgen.urdf.scene import AXES, Scene, Vector
from eomgen.urdf.tree import Tree

GRAVITY = "g"


class Draft:
    """The scene so far, with the names of the robot's links and joints in it."""

    def __init__(self, tree: Tree, notes: Notes) -> None:
        self.tree, self.notes, self.scene = tree, notes, Scene()
        self.scene.parameters |= {j.child: {} for j in tree.joints}
        self.names = Names()
        self.names.new(GRAVITY)
        joints = Names()
        self.links = {j.child: self._link(tree.links[j.child]) for j in tree.joints}
        self.joints = {j.name: joints.of(j.name, "joint") for j in tree.joints}

    def _link(self, link: Link) -> str:
        name = self.names.of(link.name, "link")
        if name != link.name:
            self.notes.add(f"link {shown(link.name)} is called {name}", link.spot)
        return name

    def of_joint(self, letter: str, joint: Joint) -> str:
        """A new name for something of a joint; a note where it is not the joint's own."""
        name = self.names.new(f"{letter}_{self.joints[joint.name]}")
        if name != f"{letter}_{joint.name}":
            self.notes.add(f"{letter} of joint {shown(joint.name)} is called {name}", joint.spot)
        return name

    def parameter(self, link: str, wanted: str, value: Decimal, unit: str) -> str:
        """The name of a new parameter of a link; zero is none."""
        if not value:
            return "0"
        name = self.names.new(wanted)
        self.scene.parameters[link][name] = f"{written(value)} {unit}"
        return name

    def vector(self, link: str, letter: str, values: tuple[Decimal, ...]) -> Vector:
        """Three lengths as parameters of a link."""
        stem = f"{letter}_{self.links[link]}"
        return tuple(
            self.parameter(link, f"{stem}_{axis}", value, "m")
            for axis, value in zip(AXES, values, strict=True)
        )
