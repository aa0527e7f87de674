"""Numbers of the stability suite: what tests assert and `benchmarks/stability.py` prints."""

from functools import cache
from math import exp, pi

import numpy as np
from laboratory import CRANK_ROCKER, OSCILLATOR, amplitude, engine, run, start, stepped
from scipy.integrate import solve_ivp

ZETAS = (0.0, 0.01, 0.1, 1.0)
# h omega of the linear oscillator at these damping ratios
LIMITS = {
    "euler": (0.0, 0.02, 0.2, 2.0),
    "heun": (0.0, 0.44, 1.05, 2.0),
    "rk3": (1.732, 1.80, 2.15, 2.51),
    "rk4": (2.828, 2.85, 2.95, 2.785),
    "dopri5": (1.0, 1.87, 2.68, 3.31),
    "semi-euler": (2.0, 1.98, 1.81, 0.828),
    "semi-euler-damped": (2.0, 2.02, 2.21, 4.828),  # 2 (sqrt(1 + zeta^2) + zeta)
    "verlet": (2.0, 1.98, 1.81, 0.828),  # position form, as generated; refused where forces damp
    "velocity-verlet": (2.0, 1.99, 1.91, 2.0),  # two evaluations of a damped force
}


def one_step(method, scene, size, step):
    """The matrix of one step of a linear scene, made by the C."""
    make = REFERENCES.get(method)
    ends = [
        make(scene, unit, step) if make else run(scene, method, unit, step, 1).states[-1]
        for unit in np.eye(size)
    ]
    return np.array(ends).T


def velocity_verlet(scene, state, step):
    """One step: half a kick, a drift, half a kick with the force of the half rate."""
    slope, n = scene.function("state_derivative"), len(state) // 2
    y = np.array(state, float)
    y[n:] += step / 2 * slope(0.0, y)[n:]
    y[:n] += step * y[n:]
    y[n:] += step / 2 * slope(0.0, y)[n:]
    return y


REFERENCES = {"velocity-verlet": velocity_verlet}


@cache
def measured_limit(method, zeta):
    """The first h omega, upwards, at which the C of a step has an eigenvalue beyond 1."""
    scene = engine(stepped(OSCILLATOR), c=2 * zeta)

    def grows(h):
        return np.abs(np.linalg.eigvals(one_step(method, scene, 2, h))).max() > 1 + 1e-9

    tried = np.linspace(0.01, 5, 500)
    above = next(i for i, h in enumerate(tried) if grows(h))
    if above == 0:
        return 0.0
    good, bad = tried[above - 1], tried[above]
    while bad - good > 1e-7:
        middle = (good + bad) / 2
        good, bad = (good, middle) if grows(middle) else (middle, bad)
    return good


@cache
def energy_change(method, count):
    """Relative change of the energy in one period of `count` steps, averaged over 10."""
    scene = engine(stepped(OSCILLATOR))
    rows = run(scene, method, start(stepped(OSCILLATOR)), 2 * pi / count, 10 * count)
    return float(np.expm1(np.log(amplitude(rows)[-1] ** 2) / 10))


# method -> (at N = 100, formula, how well it was published)
ENERGY = {
    "euler": (0.48, lambda n: exp(39.478 / n) - 1, 0.02),
    "heun": (3.9e-4, lambda n: 390 / n**3, 0.01),
    "rk3": (-1.3e-4, lambda n: -130 / n**3, 0.02),
    "rk4": (-8.5e-8, lambda n: -855 / n**5, 0.01),
    "dopri5": (-3.4e-9, lambda n: -34.2 / n**5, 0.02),
}


@cache
def exact_parallelogram():
    """Angle and rate of the parallelogram after 10 s: (2/3 + 1) l q'' = -2 g cos q, by DOP853."""
    found = solve_ivp(
        lambda t, y: [y[1], -1.2 * 9.81 * np.cos(y[0])],
        (0, 10), [pi / 2, -1], "DOP853", rtol=1e-13, atol=1e-13,
    )  # fmt: skip
    return found.y[:, -1]


@cache
def crank(formulation, count):
    """Crank angle and speed (101, 2) of the crank-rocker over 10 s by RK4."""
    steps = stepped(CRANK_ROCKER, formulation)
    rows = run(engine(steps), "rk4", start(steps), 10 / count, count, count // 100)
    speed = len(steps.program.coordinates)
    return rows.states[:, [0, speed]]


@cache
def best_in_float(formulation, *, compensated):
    """Step -> error of the crank angle after 10 s by RK4 in float."""
    steps = stepped(CRANK_ROCKER, formulation, compensated=compensated)
    exact = crank("minimal", 10_000)[-1, 0]
    scene = engine(steps, "float")
    counts = {1e-2: 1000, 5e-3: 2000, 1e-3: 10_000, 1e-4: 100_000, 1e-5: 1_000_000}
    return {
        step: abs(run(scene, "rk4", start(steps), step, count).states[-1, 0] - exact)
        for step, count in counts.items()
    }
