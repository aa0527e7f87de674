"""A scene while it is being made: its names are given here, each once."""

from decimal import Decimal

from eomgen.spec.ledger import shown
from eomgen.spec.quaternions import symbols
from eomgen.urdf.names import Names
from eomgen.urdf.notes import Notes
from eomgen.urdf.numbers import written
from eomgen.urdf.robot import Joint, Link
from eomgen.urdf.scene import AXES, Scene, Vector
from eomgen.urdf.tree import Tree

GRAVITY = "g"


class Draft:
    """The scene so far, with the names of the robot's links and joints in it."""

    def __init__(self, tree: Tree, notes: Notes, euler: bool) -> None:
        self.tree, self.notes, self.scene = tree, notes, Scene()
        self.euler = euler  # attitudes by three angles
        self.scene.parameters |= {j.child: {} for j in tree.joints}
        self.names = Names()
        self.names.new(GRAVITY)
        joints = Names()
        self.links = {j.child: self.names.of(j.child, "link") for j in tree.joints}
        self.joints = {j.name: joints.of(j.name, "joint") for j in tree.joints}

    def link(self, link: Link) -> str:
        """The name of a link that is a body or a point; a note where it is not its own."""
        name = self.links[link.name]
        if name != link.name:
            self.notes.add(f"link {shown(link.name)} is called {name}", link.spot)
        return name

    def of_joint(self, letter: str, joint: Joint) -> str:
        """A new name for something of a joint; a note where it is not the joint's own."""
        name = self.names.new(f"{letter}_{self.joints[joint.name]}")
        if name != f"{letter}_{joint.name}":
            self.notes.add(f"{letter} of joint {shown(joint.name)} is called {name}", joint.spot)
        return name

    def quaternion(self, joint: Joint) -> tuple[str, tuple[str, ...]]:
        """The name of a new quaternion, and of its speeds; the names of its parts are taken."""
        while True:
            own = symbols(self.of_joint("e", joint))
            implied = {symbol.name for symbol in (*own.symbols, *own.speeds)}
            if not implied & self.names.taken:
                self.names.taken |= implied
                return own.name, tuple(speed.name for speed in own.speeds)

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
