"""Imported robots move as Pinocchio's and MuJoCo's do: M, h, accelerations and point Jacobians."""

from pathlib import Path

import pytest
from robots import FOLDER, MuJoCo, Pinocchio, Robot, difference
from tools import library, missing

from eomgen.urdf.wishes import Wishes

pytestmark = pytest.mark.slow  # the quick tests do without programs of a gigabyte
TOLERANCE = 1e-12
STATES = 5
FREE = Wishes(floating_base=True)
ANGLES = Wishes(floating_base=True, euler=True)
OWN = tuple(
    pytest.param(path.stem, Wishes(), id=path.stem) for path in sorted(FOLDER.glob("*.urdf"))
)
FLOATING = tuple(
    pytest.param(name, wishes, id=f"{name}, {said}")
    for name in ("quadruped", "scara", "arm_6r")
    for wishes, said in ((FREE, "quaternion"), (ANGLES, "angles"))
)
BY_ANGLES = (pytest.param("satellite", Wishes(euler=True), id="satellite, angles"),)
SHIPPED = (  # of the wheel example-robot-data, by the end of their paths
    "double_pendulum.urdf", "double_pendulum_continuous.urdf", "TwoDofs.urdf", "iris.urdf",
    "borinot_flying_arm_2.urdf", "hextilt_flying_arm_5.urdf", "so100.urdf", "so101.urdf",
    "ur3_robot.urdf", "ur5_robot.urdf", "ur10_robot.urdf", "z1.urdf", "panda.urdf", "xarm7.urdf",
    "bolt.urdf", "quadruped.urdf", "solo.urdf", "solo12.urdf", "kinova.urdf", "a1.urdf",
    "laikago.urdf", "talos_left_arm.urdf",
)  # fmt: skip


def compare(robot, program):
    """Raise where an answer of the other program is not ours."""
    for state in robot.states(STATES):
        found = difference(robot.ours(*state), robot.projected(program, *state), state[1])
        assert max(found.values()) < TOLERANCE, found


@pytest.mark.parametrize(("name", "wishes"), [*OWN, *FLOATING, *BY_ANGLES])
@pytest.mark.parametrize("kind", [Pinocchio, MuJoCo])
def test_a_robot_of_ours_moves_as_theirs(name, wishes, kind):
    library(kind.__name__.lower())
    robot = Robot((FOLDER / f"{name}.urdf").read_text(encoding="utf-8"), wishes)
    compare(robot, kind(robot))


@pytest.mark.parametrize("name", SHIPPED)
def test_a_robot_of_the_wheel_moves_as_theirs(name):
    robot = Robot(shipped(name).read_text(encoding="utf-8"))
    for kind in (Pinocchio, MuJoCo):
        library(kind.__name__.lower())
        compare(robot, kind(robot))


def shipped(name):
    """A robot of the wheel, whose files lie beside Pinocchio's."""
    root = Path(library("pinocchio").__file__).parents[4] / "share" / "example-robot-data"
    found = list(root.rglob(name))
    if not found:
        missing("example-robot-data")
    assert len(found) == 1
    return found[0]


def test_there_are_more_than_ten():
    assert len(OWN) > 10


@pytest.mark.parametrize("part", ["bias", "mass_matrix", "accelerations", "jacobian"])
def test_the_comparison_can_fail(part):
    library("pinocchio")
    robot = Robot((FOLDER / "double_pendulum.urdf").read_text(encoding="utf-8"))
    (state,) = robot.states(1)
    right = robot.projected(Pinocchio(robot), *state)
    wrong = right._replace(**{part: getattr(right, part) * (1 + 1e-9)})
    assert difference(robot.ours(*state), wrong, state[1])[part] > TOLERANCE
