"""Random scenes that are trees: skew axes, full inertias, joints of every kind, as spec text."""

import random

JOINTS = {  # coordinates of a joint, and the frame that they make: offset and turns
    "revolute": (1, "[{0}, {1}, {2}]", "[[{axis}, {q}]]"),
    "aligned": (1, "[{0}, {1}, {2}]", "[[y, {q}]]"),
    "prismatic": (1, "[{0} + 0.6*{q}, {1} - 0.3*{q}, {2} + 0.7*{q}]", "[[{axis}, 0.4]]"),
    "screw": (1, "[{0}, {1}, {2} + 0.2*{q}]", "[[z, {q}]]"),
    "universal": (2, "[{0}, {1}, {2}]", "[[[3, 1, 0], {q}], [{axis}, {p}]]"),
    "cylindrical": (2, "[{0}, {1} + {p}, {2}]", "[[y, {q} - 0.1]]"),
    "curved": (1, "[{0} + {q}^2, {1} + sin({q}), {2}]", "[[{axis}, {q} - {q}^2/3]]"),
    "driven": (1, "[{0}, {1} + w/2, {2}]", "[[{axis}, w], [x, {q} + w]]"),
}


def spatial(seed, count=6):
    """A tree of bodies in space, each on a random earlier one, with loads of every kind."""
    chance = random.Random(seed)
    coordinates, bodies, moments, forces = [], [], [], []
    for i in range(count):
        name = f"B{i}"
        number, at, turn = JOINTS[chance.choice(list(JOINTS)) if i else "revolute"]
        own = [f"q{len(coordinates) + k}" for k in range(number)]
        coordinates += own
        numbers = [f"{chance.uniform(-0.5, 0.5):.2f}" for _ in range(3)]
        words = {"q": own[0], "p": own[-1], "axis": axis(chance)}
        base = f"on: B{chance.randrange(i)}, " if i else ""
        frame = f"{{{base}at: {at.format(*numbers, **words)}, turn: {turn.format(**words)}}}"
        com = ", ".join(f"{chance.uniform(-0.4, 0.4):.2f}" for _ in range(3))
        bodies.append(
            f"  {name}: {{mass: {chance.uniform(1, 3):.2f}, inertia: [{inertia(chance)}], "
            f"com: [{com}], frame: {frame}}}"
        )
        other = chance.choice(["", *(f", from: B{j}" for j in range(i))])
        inside = chance.choice(["", f", in: {name}"])
        moments.append(f"  - {{on: {name}{other}{inside}, moment: [tau, 0.3, -q0]}}")
        forces.append(f"  - {{on: {name}, in: {name}, force: [1, -F, 0.2]}}")
    springs = [
        f"  - {{between: [B0, B{count - 1}], stiffness: 3, free_length: 0.1}}",
        f"  - {{along: {coordinates[-1]} - {coordinates[0]}, stiffness: 2}}",
    ]
    lines = [
        "eom: 1", f"system: Random tree {seed}", "space: solid", "gravity: [0.3, -1, -9.7]",
        "coordinates:", *(f"  {q}: 1" for q in (*coordinates, "swing")),
        "prescribed: {w: 0.3*sin(2*t)}", "inputs: {tau: 1, F: 1}",
        f"points: {{T: {{on: B{count // 2}, at: [0.2, -0.1, 0.3 + 0.1*q0]}}}}",
        "bodies:", *bodies, "  nut: {mass: 0.4, at: T}",
        '  bob: {mass: 0.7, at: "T + 0.4*[sin(swing), 0.2, -cos(swing)]"}', "springs:", *springs,
        "moments:", *moments, "forces:", *forces,
        "dampers:", f"  - {{between: [B0, B{count - 1}], damping: 0.4}}",
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def axis(chance):
    """A skew axis; a length that is no rational number now and then."""
    return chance.choice(["[1, 2, 2]", "[2, -1, 2]", "[1, 1, 0]", "[1, -2, -3]", "x", "[0, 0, -1]"])


def inertia(chance):
    """Positive definite and full."""
    main = [f"{chance.uniform(0.3, 0.5):.2f}" for _ in range(3)]
    return ", ".join([*main, *(f"{chance.uniform(-0.1, 0.1):.2f}" for _ in range(3))])


BALL = """\
eom: 1
system: A ball joint between two skew axes
space: solid
gravity: [0.3, -1, -9.7]
coordinates: {a: 1, b: 1, e: quaternion}
inputs: {tau: 1}
bodies:
  arm: {mass: 2, inertia: [0.3, 0.4, 0.5, 0.01, 0.02, 0],
        com: [0.1, 0, 0.2], frame: {at: [0, 0, 0], turn: [[[2, 1, -2], a]]}}
  ball: {mass: 1, inertia: [0.3, 0.4, 0.5, 0, 0.05, 0.01],
         com: [0, 0.1, 0.2],
         frame: {on: arm, at: [0.3, 0.1, 0], turn: [{quaternion: e}]}}
  tip: {mass: 1, inertia: [0.2, 0.3, 0.4, 0.02, 0, 0.01],
        com: [0.1, 0.1, 0], frame: {on: ball, at: [0, 0.3, 0.1], turn: [[[1, 2, 2], b]]}}
moments:
  - {on: ball, from: arm, in: arm, moment: [tau, 2*tau, 0.3]}
  - {on: tip, from: ball, in: tip, moment: [tau, 0, tau]}
"""
PLANAR = """\
eom: 1
system: Planar tree of every kind
space: plane
gravity: [0, -9.81]
parameters: {l: 0.5, m: 2, J: 0.1, k: 3}
coordinates: {s: 1, a: 1, b: 1, c: 1, d: 1, e: 1, f: 1}
prescribed: {w: 0.2*sin(3*t)}
inputs: {tau: 1}
points:
  P: [s, w]
  Q: P + l*[sin(a), -cos(a)]
  R: Q + 2*l*[sin(b), -cos(b)]
  tip: {on: arm, at: [l, 0.1]}
  bob: tip + l*[cos(e), sin(e)]
bodies:
  cart: {mass: m, at: P}
  first: {mass: m, inertia: J, at: Q, angle: a}
  second: {rod: [Q, R], mass: m}
  arm: {mass: m, inertia: J, frame: {on: first, at: [l, 0.2], angle: c}, com: [0.1, 0.2]}
  slide: {mass: m, inertia: J, frame: {on: arm, at: [d, 0.1*d^2], angle: 0.3 + w}, com: [0.1, 0]}
  end: {mass: m, at: bob}
  wheel: {mass: m, inertia: J, frame: {on: slide, at: [0.2, 0], angle: f}}
springs:
  - {between: [cart, end], stiffness: k, free_length: 0.3}
  - {along: d, stiffness: k}
dampers:
  - {between: [first, wheel], damping: 0.7}
moments:
  - {on: wheel, from: slide, moment: tau}
  - {on: arm, from: wheel, moment: 2*tau}
  - {on: first, moment: 0.3}
forces:
  - {on: end, from: cart, force: [1, 0.2]}
"""


PARALLEL = ("[1, 2, 2]", "[1, 2, 2]", "[-1, -2, -2]", "[1, 1, 3]", "[1, 1, 3]", "[3, 0, -1]")


def arm(count, axes=("[1, 2, 2]", "y", "[2, -1, 2]", "z")):
    """A chain in space: skew axes, full inertias."""
    lines = [
        "eom: 1", f"system: Chain of {count}", "space: solid", "gravity: [0, 0, -9.81]",
        "coordinates:", *(f"  q{i}: 1" for i in range(count)),
        "bodies:",
    ]  # fmt: skip
    for i in range(count):
        on = f"on: B{i - 1}, at: [0.1, 0.02, 0.3], " if i else ""
        lines.append(
            f"  B{i}: {{mass: {1 + i / 100}, inertia: [0.05, 0.06, 0.04, 0.01, -0.005, 0.008], "
            f"com: [0.02, -0.03, 0.15], frame: {{{on}turn: [[{axes[i % len(axes)]}, q{i}]]}}}}"
        )
    return "\n".join(lines) + "\n"
