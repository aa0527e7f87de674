"""Scenes of any size, as spec text, and the same scenes for SymPy's own mechanics."""

from __future__ import annotations

import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, Particle, Point, ReferenceFrame, dynamicsymbols


def cart_with_pendulums(count: int) -> str:
    """A cart with a chain of pendulums, angles from the vertical, as a spec."""
    links = range(1, count + 1)
    lines = [
        "eom: 1",
        f"system: Cart with {count} pendulums",
        "space: plane",
        "gravity: [0, -g]",
        "parameters:",
        "  g: 9.81 m/s^2",
        *(f"  m{i}: 1 kg" for i in range(count + 1)),
        *(f"  l{i}: 0.5 m" for i in links),
        "coordinates:",
        "  s: m",
        *(f"  q{i}: rad" for i in links),
        "inputs: {F: N}",
        "points:",
        "  P0: [s, 0]",
        *(f"  P{i}: P{i - 1} + l{i}*[sin(q{i}), -cos(q{i})]" for i in links),
        "bodies:",
        *(f"  B{i}: {{mass: m{i}, at: P{i}}}" for i in range(count + 1)),
        "forces:",
        "  - {on: P0, force: [F, 0]}",
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
