"""A chain of masses, springs and dampers, the first held by a wall: numbers, spec and SX."""

from __future__ import annotations

from typing import Any


def mass(i: int) -> str:
    """[kg], a decimal number."""
    return f"1.{i % 7 + 1}"


def stiffness(i: int) -> str:
    """[N/m]."""
    return f"1{i % 5}0"


def damping(i: int) -> str:
    """[N s/m]."""
    return f"0.{i % 3 + 1}"


def spec(count: int) -> str:
    """The chain as a spec."""
    every = range(count)
    longer = [f"x{i} - x{i - 1}" if i else "x0" for i in every]
    lines = [
        "eom: 1",
        f"system: Chain of {count} masses",
        "space: line",
        "gravity: 0",
        "parameters:",
        *(f"  m{i}: {mass(i)} kg" for i in every),
        *(f"  k{i}: {stiffness(i)} N/m" for i in every),
        *(f"  c{i}: {damping(i)} N*s/m" for i in every),
        "coordinates:",
        *(f"  x{i}: m" for i in every),
        "inputs: {F: N}",
        "bodies:",
        *(f"  B{i}: {{mass: m{i}, at: x{i}}}" for i in every),
        "springs:",
        *(f"  - {{along: {longer[i]}, stiffness: k{i}}}" for i in every),
        "dampers:",
        *(f"  - {{along: {longer[i]}, damping: c{i}}}" for i in every),
        "forces:",
        f"  - {{on: B{count - 1}, force: F}}",
    ]
    return "\n".join(lines) + "\n"


def sx_function(count: int) -> Any:
    """(state, force) -> accelerations in CasADi, constants folded."""
    import casadi as ca

    state, force = ca.SX.sym("x", 2 * count), ca.SX.sym("F")
    place, rate = state[:count], state[count:]
    k, c, m = (ca.DM([float(f(i)) for i in range(count)]) for f in (stiffness, damping, mass))
    pull = k * (place - ca.vertcat(0, place[:-1])) + c * (rate - ca.vertcat(0, rate[:-1]))
    total = ca.vertcat(pull[1:], force) - pull
    return ca.Function("fd", [state, force], [total / m])
