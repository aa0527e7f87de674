"""Scenes of any size, as spec text, and the same scenes for SymPy's own mechanics."""

from __future__ import annotations

import sympy as sp
from lab.spec_text import cart
from sympy.physics.mechanics import LagrangesMethod, Particle, Point, ReferenceFrame, dynamicsymbols


def cart_with_pendulums(count: int) -> str:
    """A cart with a chain of pendulums, angles from the vertical, as a spec."""
    return cart(f"Cart with {count} pendulums", ["1"] * (count + 1), ["0.5"] * count)


AXES = ("z", "y")  # of the joints of an arm, in turn


def _head(
    title: str, space: str = "solid", gravity: str = "[0, 0, -g]", unit: str = ""
) -> list[str]:
    return [
        "eom: 1",
        f"system: {title}",
        f"space: {space}",
        f"gravity: {gravity}",
        "parameters:",
        f"  g: 9.81{unit}",
    ]


def arm(count: int) -> str:
    """Revolute joints about z and y in turn, skew inertias, a torque on each joint, as a spec."""
    joints = range(1, count + 1)
    lines = [
        *_head(f"Arm with {count} joints"),
        *(f"  {n}{i}: {v}" for i in joints for n, v in _link_values(i)),
        "coordinates:",
        *(f"  q{i}: 1" for i in joints),
        f"inputs: {{{', '.join(f'tau{i}: 1' for i in joints)}}}",
        "bodies:",
    ]
    for i in joints:
        on = f"on: L{i - 1}, at: [0, 0, l{i - 1}], " if i > 1 else ""
        lines.append(_link(f"L{i}", i, f"{{{on}turn: [[{AXES[i % 2]}, q{i}]]}}"))
    lines.append("moments:")
    for i in joints:
        source = f", from: L{i - 1}" if i > 1 else ""
        moment = "[0, 0, tau{}]" if AXES[i % 2] == "z" else "[0, tau{}, 0]"
        lines.append(f"  - {{on: L{i}{source}, in: L{i}, moment: {moment.format(i)}}}")
    return "\n".join(lines) + "\n"


def _link_values(i: int) -> list[tuple[str, str]]:
    """Parameters of a link; no two links are alike."""
    size = 1 + i / 50
    values = {
        "m": 2 * size, "l": 0.4 * size, "cx": 0.02 * size, "cy": -0.03 * size, "cz": 0.2 * size,
        "Jxx": 0.06 * size, "Jyy": 0.05 * size, "Jzz": 0.02 * size,
        "Jxy": 0.004 * size, "Jxz": -0.003 * size, "Jyz": 0.002 * size,
    }  # fmt: skip
    return [(name, f"{value:.6g}") for name, value in values.items()]


def _link(name: str, i: int, frame: str) -> str:
    tensor = ", ".join(f"J{axes}{i}" for axes in ("xx", "yy", "zz", "xy", "xz", "yz"))
    com = f"[cx{i}, cy{i}, cz{i}]"
    return f"  {name}: {{mass: m{i}, inertia: [{tensor}], com: {com}, frame: {frame}}}"


def walker(legs: int = 4, joints: int = 6) -> str:
    """A free body (three sliding, three turning joints) with legs of revolute joints."""
    axes = ("x", "y", "y", "x", "y", "z")
    count = legs * joints
    names = [f"q{k}_{j}" for k in range(legs) for j in range(joints)]
    lines = [
        *_head(f"Walker with {6 + count} degrees of freedom"),
        *(f"  {n}{i}: {v}" for i in range(count + 1) for n, v in _link_values(i)),
        "coordinates:",
        *(f"  {n}: 1" for n in ("x", "y", "z", "yaw", "pitch", "roll", *names)),
        f"inputs: {{{', '.join(f'tau_{n}: 1' for n in names)}}}",
        "bodies:",
        _link("trunk", 0, "{at: [x, y, z], turn: [[z, yaw], [y, pitch], [x, roll]]}"),
    ]
    moments = ["moments:"]
    for k in range(legs):
        for j in range(joints):
            i = 1 + k * joints + j
            before = f"L{k}_{j - 1}" if j else "trunk"
            hip = f"[{(-1) ** k * 0.3}, {(-1) ** (k // 2) * 0.2}, -0.1]"
            at = f"[0, 0, -l{i - 1}]" if j else hip
            turn = f"turn: [[{axes[j]}, q{k}_{j}]]"
            lines.append(_link(f"L{k}_{j}", i, f"{{on: {before}, at: {at}, {turn}}}"))
            parts = [f"tau_q{k}_{j}" if a == axes[j] else "0" for a in "xyz"]
            moments.append(
                f"  - {{on: L{k}_{j}, from: {before}, in: L{k}_{j}, moment: [{', '.join(parts)}]}}"
            )
    return "\n".join([*lines, *moments]) + "\n"


def mass_chain(count: int) -> str:
    """Masses on a line between neighbours' springs and dampers, the first at a wall."""
    masses = range(1, count + 1)
    lines = [
        *_head(f"Chain of {count} masses", "line", "0", " m/s^2"),
        *(
            f"  {n}{i}: {v + i / 1000} {unit}"
            for i in masses
            for n, v, unit in (("m", 1, "kg"), ("k", 100, "N/m"), ("c", 2, "N*s/m"))
        ),
        "coordinates:",
        *(f"  x{i}: m" for i in masses),
        "inputs: {F: N}",
        "bodies:",
        *(f"  B{i}: {{mass: m{i}, at: x{i}}}" for i in masses),
        "springs:",
        "  - {along: x1, stiffness: k1}",
        *(f"  - {{along: x{i} - x{i - 1}, stiffness: k{i}}}" for i in masses[1:]),
        "dampers:",
        "  - {along: x1, damping: c1}",
        *(f"  - {{along: x{i} - x{i - 1}, damping: c{i}}}" for i in masses[1:]),
        "forces:",
        f"  - {{on: B{count}, force: F}}",
    ]
    return "\n".join(lines) + "\n"


def lagranges_method(count: int) -> sp.Matrix:
    """The same scene by `LagrangesMethod`: equations formed, not simplified."""
    q = dynamicsymbols(f"q0:{count + 1}")
    frame, origin = ReferenceFrame("N"), Point("O")
    origin.set_vel(frame, 0)
    masses = sp.symbols(f"m0:{count + 1}")
    lengths = sp.symbols(f"l1:{count + 1}")
    gravity, force, t = sp.Symbol("g"), dynamicsymbols("F"), dynamicsymbols._t
    place = q[0] * frame.x
    particles, potential, cart = [], 0, None
    for i, mass in enumerate(masses):
        if i:
            place += lengths[i - 1] * (sp.sin(q[i]) * frame.x - sp.cos(q[i]) * frame.y)
        point = Point(f"P{i}")
        point.set_vel(frame, place.dt(frame))
        cart = cart or point
        particles.append(Particle(f"B{i}", point, mass))
        potential += mass * gravity * place.dot(frame.y)
    kinetic = sum(p.kinetic_energy(frame) for p in particles)
    method = LagrangesMethod(
        kinetic - potential, q, forcelist=[(cart, force * frame.x)], frame=frame
    )
    assert t is not None
    return method.form_lagranges_equations()
