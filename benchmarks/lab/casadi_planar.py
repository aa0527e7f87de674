"""The cart with pendulums in SX by 2-vectors and angles from the vertical: nothing is 3-D."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import casadi as ca

from lab.casadi_composite import solved
from lab.casadi_spatial import SX, scaled
from lab.trees import Tree


@dataclass(frozen=True)
class Pendulum:
    """cos q, sin q, q', mass and length."""

    cosine: SX
    sine: SX
    rate: SX
    mass: float
    length: float


@dataclass(frozen=True)
class Cart:
    """The whole scene; the force acts on the cart."""

    mass: float
    gravity: float
    force: SX
    pendulums: list[Pendulum]


Solver = Callable[[Cart], list[SX]]


def function(tree: Tree, solver: Solver, name: str = "fd") -> ca.Function:
    """(state, force) -> accelerations of the cart and of the angles from the vertical."""
    n = len(tree.links)
    state, force = ca.SX.sym("x", 2 * n), ca.SX.sym("u")
    pendulums = [
        Pendulum(ca.cos(state[i]), ca.sin(state[i]), state[n + i], float(k.mass), -float(k.com[1]))
        for i, k in enumerate(tree.links)
        if i
    ]
    cart = Cart(float(tree.links[0].mass), -float(tree.gravity[1]), force, pendulums)
    return ca.Function(name, [state, force], [ca.vertcat(*solver(cart))])


def composite(cart: Cart) -> list[SX]:
    """M_ij = l_i l_j cos(q_i - q_j) sum(masses beyond both), by sums of products; L' D L."""
    rows: list[dict[int, SX]] = [{0: ca.SX(cart.mass + sum(p.mass for p in cart.pendulums))}]
    right = [cart.force]
    for i, p in enumerate(cart.pendulums):
        pull = sum(r.mass for r in cart.pendulums[i:]) * p.length
        right[0] = right[0] + pull * p.sine * p.rate**2
        right.append(-pull * cart.gravity * p.sine)
        rows.append({0: pull * p.cosine})
        for j, r in enumerate(cart.pendulums[:i]):
            weight = pull * r.length
            rows[-1][j + 1] = weight * (p.cosine * r.cosine + p.sine * r.sine)
            crossed = weight * (p.sine * r.cosine - p.cosine * r.sine)
            right[i + 1] = right[i + 1] - crossed * r.rate**2
            right[j + 1] = right[j + 1] + crossed * p.rate**2
        rows[-1][i + 1] = ca.SX(pull * p.length)
    return solved(rows, right)


def articulated(cart: Cart) -> list[SX]:
    """The articulated-body method on points: force = A a + p with A (2, 2)."""
    freed, load = ca.SX(2, 2), ca.SX(2, 1)
    kept = []
    for p in reversed(cart.pendulums):
        inertia = p.mass * ca.SX.eye(2) + freed
        across, along = ca.vertcat(p.cosine, p.sine), ca.vertcat(p.sine, -p.cosine)
        push = inertia @ across
        reciprocal = 1 / (across.T @ push)
        inward = -p.length * p.rate**2 * along
        load = load + inertia @ inward
        unit, rest = scaled(push, reciprocal), scaled(across.T @ load, reciprocal)
        kept.append((p.length, across, inward, unit, rest))
        freed = ca.tril2symm(ca.tril(inertia - unit @ push.T))
        load = load - push * rest
    return _outward(cart, freed, load, kept[::-1])


def _outward(cart: Cart, freed: SX, load: SX, kept: list[tuple[Any, ...]]) -> list[SX]:
    known = cart.force - load[0] - freed[0, 1] * cart.gravity
    solution = [known / (cart.mass + freed[0, 0])]
    moving = ca.vertcat(solution[0], cart.gravity)
    for length, across, inward, unit, rest in kept:
        step = -(unit.T @ moving + rest)  # l q''
        solution.append(step * (1 / length))
        moving = moving + inward + across * step
    return solution
