"""Robots of URDF files: ours, Pinocchio's and MuJoCo's, at the same states and in the same order.

An answer is (M, h, q'', J): mass matrix, bias with gravity and dampers (what inputs must hold
against), accelerations under random inputs, Jacobian of a point on the last link. The speeds of the
others are w = B(y) y' with the positions y = G q + o of all joints: G couples joints that follow
others, B makes theirs of the rates of Euler's angles and of displacements in the axes below.
"""

import random
from collections import namedtuple
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import sympy as sp

from eomgen import spec, urdf
from eomgen.compile import machine_of, program
from eomgen.functions import table
from eomgen.interpreter import FLOAT, run
from eomgen.mechanics import speeds
from eomgen.model import Place, Point
from eomgen.urdf.names import identifier

FOLDER = Path(__file__).parent / "urdf"
OFFSET = (0.11, -0.23, 0.31)  # of the point, in the axes of the last link
LONE = ("revolute", "continuous", "prismatic")
MOVING = (*LONE, "planar", "floating")
ANGLES = ("x_{}", "y_{}", "z_{}", "yaw_{}", "pitch_{}", "roll_{}")
QUATERNION = ("x_{}", "y_{}", "z_{}", *(f"e_{{}}_{i}" for i in range(4)))
SPINNING = ("x_{}'", "y_{}'", "z_{}'", *(f"omega_e_{{}}_{i}" for i in "xyz"))
Answer = namedtuple("Answer", "mass_matrix bias accelerations jacobian")
Speeds = namedtuple("Speeds", "position partials drift")  # of one joint: theirs, B, B' y'


def turned(angle):
    """R' of a turn in the plane."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, s], [-s, c]])


def axes_of(yaw, pitch, roll):
    """Rz(yaw) Ry(pitch) Rx(roll)."""
    z, y, x = (np.eye(3) for _ in range(3))
    z[:2, :2], x[1:, 1:] = turned(yaw).T, turned(roll).T
    y[::2, ::2] = turned(pitch)
    return z @ y @ x


def spin_of(pitch, roll):
    """Columns: the angular velocity in body axes for each of yaw', pitch', roll'."""
    (cp, sp_), (cr, sr) = ((np.cos(a), np.sin(a)) for a in (pitch, roll))
    return np.array([[-sp_, 0, 1], [cp * sr, cr, 0], [cp * cr, -sr, 0]])


def spin_rate(angles, rates):
    """The time derivative of `spin_of`."""
    (_, p, r), (_, dp, dr) = angles, rates
    by_pitch = [[-np.cos(p), 0, 0], [-np.sin(p) * np.sin(r), 0, 0], [-np.sin(p) * np.cos(r), 0, 0]]
    by_roll = [[0, 0, 0], [np.cos(p) * np.cos(r), -np.sin(r), 0],
               [-np.cos(p) * np.sin(r), -np.cos(r), 0]]  # fmt: skip
    return np.array(by_pitch) * dp + np.array(by_roll) * dr


def turned_by(quaternion):
    """The axes turned by a unit quaternion, its scalar part first (Rodrigues)."""
    scalar, (x, y, z) = quaternion[0], quaternion[1:]
    tilde = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * scalar * tilde + 2 * tilde @ tilde


def floating(y, dy, in_body):
    """Displacements below and an attitude -> velocity (in the body's axes or not) and spin."""
    if len(y) == 7:
        axes, spin, spin_change = turned_by(y[3:]), np.eye(3), np.zeros((3, 3))
    else:
        axes, spin, spin_change = axes_of(*y[3:]), spin_of(*y[4:]), spin_rate(y[3:], dy[3:])
    velocity = axes.T if in_body else np.eye(3)
    partials = np.block([[velocity, np.zeros((3, 3))], [np.zeros((3, 3)), spin]])
    drift = np.concatenate([
        -np.cross(spin @ dy[3:], axes.T @ dy[:3]) if in_body else np.zeros(3),
        spin_change @ dy[3:],
    ])  # fmt: skip
    return axes, partials, drift


def origin_of(joint):
    """Displacement and axes of a joint's origin."""
    found = joint.find("origin")
    xyz, rpy = ("0 0 0" if found is None else found.get(n, "0 0 0") for n in ("xyz", "rpy"))
    roll, pitch, yaw = map(float, rpy.split())
    return np.array([float(c) for c in xyz.split()]), axes_of(yaw, pitch, roll)


def without_shapes(text):
    """The text without what only shows: meshes are not installed."""
    root = ElementTree.fromstring(text)
    for link in root.iter("link"):
        for name in ("visual", "collision"):
            for shape in link.findall(name):
                link.remove(shape)
    return root


def on_a_floating_base(text):
    """The robot on a floating joint in the world, called as ours is with --floating-base."""
    root = ElementTree.fromstring(text)
    held = {child.get("link") for child in root.iterfind("joint/child")}
    (base,) = (n for link in root.findall("link") if (n := link.get("name")) not in held)
    ElementTree.SubElement(root, "link", name="world")
    joint = ElementTree.SubElement(root, "joint", name=base, type="floating")
    ElementTree.SubElement(joint, "parent", link="world")
    ElementTree.SubElement(joint, "child", link=base)
    return ElementTree.tostring(root, "unicode")


@dataclass(frozen=True)
class Robot:
    """A URDF as ours and as the others read it."""

    text: str
    wishes: urdf.Wishes = field(default_factory=urdf.Wishes)

    @cached_property
    def theirs(self):
        """The text for the others."""
        text = self.text[self.text.index("<robot") :]  # no encoding beside text
        return on_a_floating_base(text) if self.wishes.floating_base else text

    @cached_property
    def root(self):
        """What the others read, as elements."""
        return ElementTree.fromstring(self.theirs)

    @cached_property
    def joints(self):
        """Moving joints by name."""
        return {j.get("name"): j for j in self.root.findall("joint") if j.get("type") in MOVING}

    @cached_property
    def model(self):
        """Our model, with a point `probe` on the last body that has mass."""
        made = urdf.imported(self.text.encode(), "robot.urdf", self.wishes)
        model = spec.read(made.text, "robot.yaml")
        last = [b for b in model.bodies if b.mass != 0][-1].name.removesuffix("_inertial")
        probe = Point("probe", Place(tuple(sp.Rational(str(c)) for c in OFFSET), on=last))
        return replace(model, points=(*model.points, probe))

    @property
    def speeds(self):
        """The names of the speeds."""
        return [symbol.name for symbol in speeds.symbols(self.model)]

    @cached_property
    def last(self):
        """The name of the link that the probe is on, as the file spells it."""
        names = (link.get("name") for link in self.root.findall("link"))
        return next(n for n in names if identifier(n, "link") == self.model.points[-1].place.on)

    def _words(self, joint):
        """The names of the coordinates of a joint, and of its speeds."""
        kind = joint.get("type")
        if kind == "floating" and not self.wishes.euler:
            return QUATERNION, SPINNING
        found = ANGLES if kind == "floating" else ("q_{}",)
        if kind == "planar":
            axis = joint.find("axis").get("xyz").split()
            normal = next(i for i, c in enumerate(axis) if float(c))
            found = (*("xyz"[(normal + k) % 3] + "_{}" for k in (1, 2)), "theta_{}")
        return found, tuple(f"{word}'" for word in found)

    @cached_property
    def coupling(self):
        """Positions of all joints y = G q + o, their speeds = H u; where each joint's stand."""
        ours = [c.name for c in self.model.coordinates], self.speeds
        matrices, offsets, places = ([], []), [], {}
        for name, joint in self.joints.items():
            factor, offset, leader = self._leader(name)
            starts = [len(rows) for rows in matrices]
            for names, rows, words in zip(ours, matrices, self._words(joint), strict=True):
                for word in words:
                    row = np.zeros(len(names))
                    row[names.index(word.format(identifier(leader, "joint")))] = factor
                    rows.append(row)
            offsets += [offset] * len(self._words(joint)[0])
            places[name] = [slice(a, len(rows)) for a, rows in zip(starts, matrices, strict=True)]
        G, H = map(np.array, matrices)
        return G, np.array(offsets), H, places

    def _leader(self, name):
        """Factor and offset of a joint's position, and the joint that leads it."""
        mimic = self.joints[name].find("mimic")
        if mimic is None:
            return 1.0, 0.0, name
        factor, offset, leader = self._leader(mimic.get("joint"))
        multiplier = float(mimic.get("multiplier", 1))
        return multiplier * factor, multiplier * offset + float(mimic.get("offset", 0)), leader

    @cached_property
    def damping(self):
        """The coefficient of the damper along each position."""
        found = []
        for joint in self.joints.values():
            dynamics = joint.find("dynamics")
            value = 0.0 if dynamics is None else float(dynamics.get("damping", 0))
            found += [value] * len(self._words(joint)[1])
        return np.diag(found)

    def states(self, count, seed=1):
        """Random coordinates, speeds and generalized forces."""
        chance = random.Random(seed)
        model, names = self.model, self.speeds
        near = [0.9 if c.name.startswith("pitch_") else 2.0 for c in model.coordinates]
        found = []
        for _ in range(count):
            q = np.array([chance.uniform(-1, 1) * a for a in near])
            for quaternion in model.quaternions:
                first = [c.symbol for c in model.coordinates].index(quaternion.symbols[0])
                q[first : first + 4] /= np.linalg.norm(q[first : first + 4])
            u = np.array([chance.uniform(-2, 2) for _ in names])
            found.append((q, u, self.driven @ [chance.uniform(-2, 2) for _ in model.inputs]))
        return found

    @cached_property
    def driven(self):
        """Which speed each input drives."""
        names = self.speeds
        matrix = np.zeros((len(names), len(self.model.inputs)))
        for column, given in enumerate(self.model.inputs):
            matrix[names.index("q" + given.name.removeprefix("tau") + "'"), column] = 1
        return matrix

    @cached_property
    def functions(self):
        """Our functions, and the Jacobian of the probe."""
        machine = machine_of(self.model)
        names = ("mass_matrix", "bias", "generalized_forces", "accelerations", "jacobian_of:probe")
        return table.select(program(machine), machine, names).functions

    def ours(self, q, v, forces):
        """Our answer."""
        n, inputs = len(v), self.driven.T @ forces
        given = {
            "time": [0.0],
            "state": [*q, *v],
            "parameters": [float(p.value) for p in self.model.parameters],
        }

        mass, bias, driven, accelerations, jacobian = (
            np.array(run(function, given | {"inputs": inputs}, FLOAT))
            for function in self.functions
        )
        bias = bias - (driven - forces)
        return Answer(mass.reshape(n, n), bias, accelerations, jacobian.reshape(3, n))

    def projected(self, they, q, v, forces):
        """Another program's answer in our coordinates.

        they: its size and, for each joint, where its positions and speeds stand and `Speeds`; its
        answer for positions and speeds.
        """
        G, offsets, H, places = self.coupling
        y, dy = G @ q + offsets, H @ v
        position, drift = they.rest(), np.zeros(they.speeds)
        partials = np.zeros((they.speeds, len(dy)))
        for name, joint in self.joints.items():
            here, moving = places[name]
            found = they.of_joint(joint, y[here], dy[moving])
            at, rows = they.places(joint)
            position[at], drift[rows] = found.position, found.drift
            partials[rows, moving] = found.partials
        their_speeds, resistance = partials @ dy, H.T @ self.damping @ dy
        mass, bias, jacobian = they.answer(position, their_speeds)
        P = partials @ H
        found = P.T @ mass @ P, P.T @ (bias + mass @ drift) + resistance
        if P.shape[0] == P.shape[1]:
            # w' = B q'' + B' q' by their own forward dynamics
            pushed = they.forward(position, their_speeds, np.linalg.solve(P.T, forces - resistance))
            accelerations = np.linalg.solve(P, pushed - drift)
        else:
            accelerations = np.linalg.solve(found[0], forces - found[1])
        return Answer(*found, accelerations, jacobian @ P)


class Pinocchio:
    """Pinocchio's model of a robot."""

    def __init__(self, robot):
        import pinocchio

        self.robot, self.library = robot, pinocchio
        self.model = pinocchio.buildModelFromXML(robot.theirs)
        self.speeds = self.model.nv

    def rest(self):
        """Its neutral position."""
        return self.library.neutral(self.model)

    def places(self, joint):
        """Where the joint stands in its positions and speeds."""
        found = self.model.joints[self.model.getJointId(joint.get("name"))]
        return slice(found.idx_q, found.idx_q + found.nq), slice(
            found.idx_v, found.idx_v + found.nv
        )

    def of_joint(self, joint, y, dy):
        """Its position and speeds of a joint."""
        match joint.get("type"):
            case "continuous":
                return Speeds([np.cos(y[0]), np.sin(y[0])], np.eye(1), np.zeros(1))
            case "planar":
                partials, back = np.eye(3), turned(y[2])
                partials[:2, :2] = back
                vx, vy = back @ dy[:2]
                drift = dy[2] * np.array([vy, -vx, 0])
                return Speeds([*y[:2], np.cos(y[2]), np.sin(y[2])], partials, drift)
            case "floating":
                axes, partials, drift = floating(y, dy, in_body=True)
                quaternion = self.library.Quaternion(axes).coeffs()
                return Speeds([*y[:3], *quaternion], partials, drift)
        return Speeds(y, np.eye(1), np.zeros(1))

    def answer(self, position, rates):
        """M, bias without dampers, Jacobian of the probe."""
        pinocchio, model = self.library, self.model
        data = model.createData()
        mass = pinocchio.crba(model, data, position)
        mass = np.triu(mass) + np.triu(mass, 1).T
        bias = pinocchio.nonLinearEffects(model, data, position, rates)
        frame = model.getFrameId(self.robot.last, pinocchio.FrameType.BODY)
        data = model.createData()
        pinocchio.computeJointJacobians(model, data, position)
        pinocchio.updateFramePlacements(model, data)
        aligned = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
        whole = pinocchio.getFrameJacobian(model, data, frame, aligned)
        arm = data.oMf[frame].rotation @ np.array(OFFSET)
        return mass, bias, whole[:3] - pinocchio.skew(arm) @ whole[3:]

    def forward(self, position, rates, forces):
        """Its accelerations, by the articulated-body algorithm."""
        return self.library.aba(self.model, self.model.createData(), position, rates, forces)


class MuJoCo:
    """MuJoCo's model of a robot, which must neither join bodies nor change their inertia."""

    SETTINGS = {
        "fusestatic": "false", "balanceinertia": "false", "boundmass": "0",
        "boundinertia": "0", "inertiafromgeom": "false", "discardvisual": "true",
    }  # fmt: skip
    UNWANTED = ("CONSTRAINT", "CONTACT", "LIMIT", "FRICTIONLOSS", "EQUALITY", "DAMPER")

    def __init__(self, robot):
        import mujoco

        self.robot, self.library = robot, mujoco
        root = without_shapes(robot.theirs)
        compiler = ElementTree.SubElement(root, "mujoco")
        ElementTree.SubElement(compiler, "compiler", self.SETTINGS)
        self.model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, "unicode"))
        for name in self.UNWANTED:
            self.model.opt.disableflags |= getattr(mujoco.mjtDisableBit, f"mjDSBL_{name}")
        self.speeds = self.model.nv

    def rest(self):
        """Its position of reference."""
        return self.model.qpos0.copy()

    def places(self, joint):
        """Where the joint stands in its positions and speeds."""
        name, kind = joint.get("name"), joint.get("type")
        if kind == "planar":
            found = [self.model.joint(f"{name}_{end}") for end in ("TX", "TY", "RZ")]
            return [int(j.qposadr[0]) for j in found], [int(j.dofadr[0]) for j in found]
        found, size = self.model.joint(name), 6 if kind == "floating" else 1
        at, row = int(found.qposadr[0]), int(found.dofadr[0])
        return slice(at, at + (7 if size == 6 else 1)), slice(row, row + size)

    def of_joint(self, joint, y, dy):
        """Its position and speeds of a joint."""
        if joint.get("type") == "floating":
            # its free joint counts from the world, not from the joint's origin
            axes, partials, drift = floating(y, dy, in_body=False)
            at, below = origin_of(joint)
            quaternion, partials[:3, :3] = np.zeros(4), below
            self.library.mju_mat2Quat(quaternion, (below @ axes).flatten())
            return Speeds([*(at + below @ y[:3]), *quaternion], partials, drift)
        return Speeds(y, np.eye(len(y)), np.zeros(len(y)))

    def answer(self, position, rates):
        """M, bias without dampers, Jacobian of the probe."""
        mujoco, model = self.library, self.model
        data = mujoco.MjData(model)
        data.qpos[:], data.qvel[:] = position, rates
        mujoco.mj_forward(model, data)
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, mass)
        jacobian, turning = np.zeros((3, model.nv)), np.zeros((3, model.nv))
        body = model.body(self.robot.last).id
        point = data.xpos[body] + data.xmat[body].reshape(3, 3) @ np.array(OFFSET)
        mujoco.mj_jac(model, data, jacobian, turning, point, body)
        return mass, data.qfrc_bias.copy(), jacobian

    def forward(self, position, rates, forces):
        """Its accelerations."""
        data = self.library.MjData(self.model)
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = position, rates, forces
        self.library.mj_forward(self.model, data)
        return data.qacc.copy()


def difference(left, right, rates):
    """The largest difference in each part of two answers, relative to the size of its terms."""
    scale = np.max(np.abs(right.mass_matrix)) * np.max(np.abs(rates)) ** 2
    least = {"bias": scale, "accelerations": 1e-3}
    found = {}
    for name in Answer._fields:
        a, b = getattr(left, name), getattr(right, name)
        found[name] = float(np.max(np.abs(a - b)) / max(np.max(np.abs(b)), least.get(name, 1e-9)))
    return found
