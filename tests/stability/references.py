"""Formulations that we do not ship, small, over the functions of the C: to show how they fail."""

from math import acos, atan2

import numpy as np

TURNS = 30  # iterations of Newton's method at most


class Lost(Exception):
    """A formulation has no answer where it is."""


class Loop:
    """A loop of three links with q1 independent, over the multiplier form of its scene."""

    def __init__(self, scene):
        self.jacobian = scene.function("constraint_jacobian")
        self.residuals = scene.function("constraint_residuals")
        self.accelerations = scene.function("accelerations")

    def at(self, places, rate):
        """The state over all coordinates."""
        j = self.jacobian(0.0, np.array([*places, 0, 0, 0]))
        return np.array([*places, rate, *np.linalg.solve(j[:, 1:], -j[:, 0] * rate)])

    def newton(self, q1, guess):
        """q2 and q3 by Newton's method from those of the last call: partitioning."""
        places = np.array([q1, *guess])
        for _ in range(TURNS):
            at = np.array([*places, 0, 0, 0])
            error = self.residuals(0.0, at)
            if np.abs(error).max() < 1e-13:
                return places
            places[1:] -= np.linalg.solve(self.jacobian(0.0, at)[:, 1:], error)
        raise Lost


def closed(q1, lengths, sign):
    """q1, q2, q3 by the law of cosines, always on the same side."""
    a, b, c, e = lengths
    x, y = e - a * np.cos(q1), -a * np.sin(q1)
    diagonal = np.hypot(x, y)
    cosine = (diagonal**2 + b**2 - c**2) / (2 * diagonal * b)
    if not abs(cosine) <= 1:
        raise Lost
    q2 = atan2(y, x) + sign * acos(cosine)
    end = a * np.sin(q1) + b * np.sin(q2)
    return np.array([q1, q2, atan2(end, a * np.cos(q1) + b * np.cos(q2) - e)])


def reduced_run(loop, places, state, step, count):
    """q1 and its rate at the end by RK4, and the last full state; `places`: q1 -> q1, q2, q3."""

    def slope(y):
        full = loop.at(places(y[0]), y[1])
        return np.array([y[1], loop.accelerations(0.0, full)[0]])

    y = np.array(state, float)
    for _ in range(count):
        k1 = slope(y)
        k2 = slope(y + step / 2 * k1)
        k3 = slope(y + step / 2 * k2)
        k4 = slope(y + step * k3)
        y = y + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        if not np.all(np.isfinite(y)) or np.abs(y).max() > 1e6:
            raise Lost
    return loop.at(places(y[0]), y[1])


class Penalty:
    """Index-3 augmented Lagrangian with trapezoidal steps and projected rates (ALI3-P).

    Cuadrado, Cardenal, Bayo, Multibody System Dynamics 1 (1997).
    """

    def __init__(self, scene, penalty):
        names = ("mass_matrix", "bias", "generalized_forces", "accelerations")
        self.mass, self.bias, self.forces, self.exact = map(scene.function, names)
        self.residuals = scene.function("constraint_residuals")
        self.jacobian = scene.function("constraint_jacobian")
        self.penalty = penalty

    def run(self, state, step, count):
        """The state at the end.

        Raises:
            Lost: it is no longer finite.
        """
        n = len(state) // 2
        q, v = np.array(state[:n], float), np.array(state[n:], float)
        a = self.exact(0.0, np.array(state))
        multipliers = np.zeros(len(self.residuals(0.0, np.array(state))))
        for _ in range(count):
            q, v, a, multipliers = self._step(q, v, a, multipliers, step)
            if not np.all(np.isfinite(q)) or np.abs(v).max() > 1e6:
                raise Lost
        return np.array([*q, *v])

    def _step(self, q, v, a, multipliers, h):  # noqa: PLR0913
        # rates and accelerations by the trapezoidal rule from the new positions
        speed, thrust = 2 / h * q + v, 4 / h**2 * q + 4 / h * v + a
        q = q + h * v + h**2 / 2 * a
        for _ in range(TURNS):
            v, a = 2 / h * q - speed, 4 / h**2 * q - thrust
            y = np.array([*q, *v])
            j, phi = self.jacobian(0.0, y), self.residuals(0.0, y)
            mass = self.mass(0.0, y)
            load = self.forces(0.0, y) - self.bias(0.0, y)
            left = mass @ a - load + j.T @ (multipliers + self.penalty * phi)
            change = np.linalg.solve(mass + h**2 / 4 * self.penalty * j.T @ j, h**2 / 4 * left)
            q = q - change
            phi = self.residuals(0.0, np.array([*q, *v]))
            multipliers = multipliers + self.penalty * phi
            if not np.all(np.isfinite(q)):
                raise Lost
            if np.abs(change).max() < 1e-12:
                break
        return *self._projected(q, 2 / h * q - speed, 4 / h**2 * q - thrust, h), multipliers

    def _projected(self, q, v, a, h):
        y = np.array([*q, *v])
        j, mass = self.jacobian(0.0, y), self.mass(0.0, y)
        stiff = mass + h**2 / 4 * self.penalty * j.T @ j
        v = np.linalg.solve(stiff, mass @ v)
        y = np.array([*q, *v])
        gamma = -j @ self.exact(0.0, y)
        return q, v, np.linalg.solve(stiff, mass @ a - h**2 / 4 * self.penalty * j.T @ gamma)
