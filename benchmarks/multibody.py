"""Problems of the IFToMM library of computational benchmark problems, and Andrews' mechanism.

Gonzalez, Dopico, Lugris, Cuadrado, A benchmarking system for MBS simulation software, Multibody
System Dynamics 16 (2006). One command: python benchmarks/multibody.py [-o FILE].
"""

from __future__ import annotations

import argparse
import os
import platform
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk

from eomgen import stepping, study
from eomgen.integrators.methods import METHODS
from eomgen.numerics import integrate
from eomgen.numerics.engine_c import EngineC
from eomgen.numerics.records import Arguments, Grid, Rows
from eomgen.wanted import Wanted

SPECS = Path(__file__).parents[1] / "specs"
HIGH = 1e-3  # the error that the library calls high accuracy, relative
THRESHOLD = 1e-3  # below this size an error counts in full
REPEATS = 3
NAN = float("nan")
PENDULUM = """\
eom: 1
system: Simple pendulum in Cartesian coordinates
space: plane
gravity: [0, -g]
parameters: {m: 1 kg, l: 1 m, g: 9.81 m/s^2}
coordinates: {x: m, y: m}
bodies: {bob: {mass: m, at: "[x, y]"}}
constraints: {bar: {holonomic: "x^2 + y^2 = l^2"}}
initial: {x: -1 m, y: 0 m, x': 0 m/s, y': 0 m/s}
"""
SQUEEZER = {  # published at t = 0.03 s
    "beta": "0.1581077119629904e2", "theta": "-0.1575637105984298e2",
    "gamma": "0.4082224013073101e-1", "phi": "-0.5347301163226948",
    "delta": "0.5244099658805304", "omega": "0.5347301163226948",
    "epsilon": "1.048080741042263",
}  # fmt: skip


def windows(count: int) -> str:
    """The chain of `count` four-bar windows: uprights a, couplers b, all angles from x."""
    uprights, couplers = range(count + 1), range(count)
    coordinates = [f"  a{i}: {{unit: rad, role: {'linked' if i else 'free'}}}" for i in uprights]
    lines = [
        "eom: 1",
        f"system: {count} four-bar windows",
        "space: plane",
        "gravity: [0, -g]",
        "parameters: {m: 1 kg, l: 1 m, g: 9.81 m/s^2}",
        "coordinates:",
        *coordinates,
        *(f"  b{i}: {{unit: rad, role: linked}}" for i in couplers),
        "points:",
        *(f"  P{i}: [{i}*l, 0]" for i in uprights),
        *(f"  B{i}: P{i} + l*[cos(a{i}), sin(a{i})]" for i in uprights),
        *(f"  C{i}: B{i} + l*[cos(b{i}), sin(b{i})]" for i in couplers),
        "bodies:",
        *(f"  upright{i}: {{rod: [P{i}, B{i}], mass: m}}" for i in uprights),
        *(f"  coupler{i}: {{rod: [B{i}, C{i}], mass: m}}" for i in couplers),
        "constraints:",
        *(f"  loop{i}: {{holonomic: C{i} = B{i + 1}}}" for i in couplers),
        "initial:",
        "  a0: 90 deg",
        "  a0': -1 rad/s",
        "  guess: {"
        + ", ".join(
            [f"a{i}: 90 deg, a{i}': -1 rad/s" for i in uprights if i]
            + [f"b{i}: 0 deg, b{i}': 0 rad/s" for i in couplers]
        )
        + "}",
        "expect: {dof: 1}",
    ]
    return "\n".join(lines) + "\n"


@dataclass(frozen=True)
class Scene:
    """A problem, compiled: the engine, the state at the start, and what preparing it took [s]."""

    engine: EngineC
    start: np.ndarray
    prepared: float

    def run(self, method: str, span: float, step: float, rows: int) -> tuple[Rows, float]:
        """The rows of a run, and the least time of `REPEATS` [s]."""
        count = round(span / step)
        grid = Grid(0.0, span / count, count, max(1, count // rows))
        best, found = float("inf"), None
        for _ in range(REPEATS):
            since = time.perf_counter()
            found = integrate.run(self.engine, METHODS[method], self.start, grid)
            best = min(best, time.perf_counter() - since)
        assert found is not None
        assert not found.stopped
        return found, best

    def energies(self, rows: Rows) -> np.ndarray:
        """Kinetic plus potential [J]."""
        return self.engine.sweep("energy", rows.times, rows.states).sum(axis=1)


def scene(text: str, formulation: str, method: str, name: str = "scene.yaml") -> Scene:
    """Derive, generate, compile."""
    since = time.perf_counter()
    found = study.of_text(text, name, Wanted(formulation))
    steps = stepping.of(found, (method,))
    values = tuple(float(p.value) for p in steps.program.parameters)
    engine = EngineC(steps, Arguments((), values))
    variables = (*steps.program.coordinates, *steps.program.speeds)
    start = np.array([float(v.value) for v in variables])
    return Scene(engine, start, time.perf_counter() - since)


@dataclass(frozen=True)
class Line:
    """A line of the table."""

    problem: str
    how: str
    step: float
    seconds: float
    error: float  # as the problem measures it
    energy: float  # the largest change [J], NaN where it is not conserved
    prepared: float


def relative(found: np.ndarray, wanted: np.ndarray) -> float:
    """The largest error of a table, relative where the value is above `THRESHOLD`."""
    return float((np.abs(found - wanted) / np.maximum(np.abs(wanted), THRESHOLD)).max())


def pendulum() -> Iterator[Line]:
    """A01, 2000 s and 10 s: the exact motion is an elliptic function."""
    made = scene(PENDULUM, "multiplier", "rk4")
    for span, steps in ((2000.0, (5e-3, 2e-3)), (10.0, (1e-2, 1e-3))):
        for step in steps:
            rows, seconds = made.run("rk4", span, step, 4000)
            sine = ellipj(np.sqrt(9.81) * rows.times + ellipk(0.5), 0.5)[0]
            angle = -2 * np.arcsin(np.sqrt(0.5) * sine)
            wanted = np.stack([np.sin(angle), -np.cos(angle)], axis=1)
            error = float(np.abs(rows.states[:, :2] - wanted).max())
            yield _line(f"A01 pendulum, {span:g} s", made, (rows, seconds), (step, error))


def _line(
    problem: str, made: Scene, ran: tuple[Rows, float], measured: tuple[float, float]
) -> Line:
    """A line of a conservative problem; measured: step, error."""
    energies = made.energies(ran[0])
    change = float(np.abs(energies - energies[0]).max())
    return Line(problem, "multiplier, rk4", measured[0], ran[1], measured[1], change, made.prepared)


def four_bars() -> Iterator[Line]:
    """A02: the uprights turn together, [(N+1)/3 + N] q'' = -g [(N+1)/2 + N] cos q."""
    for count in (1, 2, 5):
        made = scene(windows(count), "multiplier", "rk4")
        ratio = 9.81 * ((count + 1) / 2 + count) / ((count + 1) / 3 + count)
        for step in (5e-3, 1e-3):
            rows, seconds = made.run("rk4", 10.0, step, 200)
            exact = solve_ivp(
                lambda t, y, a=ratio: [y[1], -a * np.cos(y[0])],
                (0, 10), [np.pi / 2, -1], "DOP853", rtol=1e-13, atol=1e-13, t_eval=rows.times,
            ).y[0]  # fmt: skip
            ours = np.stack([np.cos(rows.states[:, 0]), np.sin(rows.states[:, 0])])
            error = float(np.abs(ours - np.stack([np.cos(exact), np.sin(exact)])).max())
            yield _line(f"A02 four-bars, N = {count}", made, (rows, seconds), (step, error))


def governor() -> Iterator[Line]:
    """A05: the height of the slider against Radau IIA at rtol 1e-11."""
    made = scene((SPECS / "flyball_governor.yaml").read_text(), "auto", "rosenbrock2")
    slope, jacobian = (made.engine.function(f) for f in ("state_derivative", "state_jacobian"))
    for step in (1e-2, 2e-3):
        rows, seconds = made.run("rosenbrock2", 10.0, step, 200)
        exact = solve_ivp(
            slope, (0, 10), made.start, "Radau", jac=jacobian, rtol=1e-11, atol=1e-13,
            t_eval=rows.times,
        )  # fmt: skip
        error = relative(rows.states[:, 1], exact.y[1])
        yield Line("A05 governor", "free, rosenbrock2", step, seconds, error, NAN, made.prepared)


@dataclass(frozen=True)
class Squeezer:
    """Andrews' mechanism at t = 0.03 s by two steps and by another formulation and method."""

    names: tuple[str, ...]
    coarse: np.ndarray
    fine: np.ndarray
    other: np.ndarray
    seconds: float  # of the fine one


def squeezer() -> Squeezer:
    """Positions by dopri5 in the null space at two steps, and by rk4 with multipliers."""
    file = SPECS / "andrews_squeezer.yaml"
    made = scene(file.read_text(), "nullspace", "dopri5", file.name)
    names = tuple(v.name for v in made.engine.steps.program.coordinates)
    coarse, _ = made.run("dopri5", 0.03, 0.03 / 20_000, 1)
    fine, seconds = made.run("dopri5", 0.03, 0.03 / 40_000, 1)
    other, _ = scene(file.read_text(), "multiplier", "rk4", file.name).run("rk4", 0.03, 1e-6, 1)
    ends = [rows.states[-1, : len(names)] for rows in (coarse, fine, other)]
    return Squeezer(names, *ends, seconds)


def table(lines: list[Line]) -> list[str]:
    """The problems."""
    found = [
        "| problem | formulation, method | step [s] | run [s] | error | energy [J] "
        "| derive, compile [s] |",
        "|---|---|---|---|---|---|---|",
    ]
    for line in lines:
        energy = "-" if np.isnan(line.energy) else f"{line.energy:.1e}"
        found.append(
            f"| {line.problem} | {line.how} | {line.step:g} | {line.seconds:.3f} "
            f"| {line.error:.1e} | {energy} | {line.prepared:.1f} |"
        )
    return found


def digits(found: Squeezer) -> list[str]:
    """Published positions beside ours, and how well ours confirm each other."""
    lines = [
        "| angle | published | ours | two steps differ by | two formulations by "
        "| from the published |",
        "|---|---|---|---|---|---|",
    ]
    rows = zip(found.names, found.coarse, found.fine, found.other, strict=True)
    for name, coarse, fine, other in rows:
        given = float(SQUEEZER[name])
        lines.append(
            f"| {name} | {given:.16g} | {fine:.16g} | {abs(fine - coarse):.1e} "
            f"| {abs(fine - other):.1e} | {abs(fine - given):.1e} |"
        )
    return lines


PUBLISHED = """\
Published times, each on its own machine and none of them ours, so read them as sizes: A01, 10 s:
OpenSim 3.2 0.637 s (accuracy 1e-12, Core i5-4570), EXUDYN 0.037 s (step 0.8 ms); A02, N = 2, 10 s:
OpenSim 3.2 0.455 s, EXUDYN 0.078 s (step 10 ms); A05: OpenSim 3.2 0.233 s. Errors here are of the
whole run: A01 position of the mass [m], A02 position of B0 [m], A05 height of the slider, relative.
The corner B0 that was published for A02, N = 2, is the exact one to 2e-8: ours is nearer."""


def report(lines: list[Line], found: Squeezer) -> str:
    """The page."""
    return "\n".join([
        "# Multibody benchmark collection",
        "",
        f"`python benchmarks/multibody.py` on {platform.machine()}, {os.cpu_count()} cores;",
        f"run: the least of {REPEATS}, the generated C alone. The library asks for an error",
        "of 1e-1 (low) and 1e-3 (high).",
        "",
        *table(lines),
        "",
        PUBLISHED,
        "",
        f"## Andrews' squeezing mechanism at t = 0.03 s, {found.seconds:.2f} s for 40 000 steps",
        "",
        *digits(found),
        "",
    ])  # fmt: skip


PROBLEMS: tuple[Callable[[], Iterator[Line]], ...] = (pendulum, four_bars, governor)


def main() -> None:
    """Run everything and print the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=Path)
    output = parser.parse_args().output
    text = report([line for problem in PROBLEMS for line in problem()], squeezer())
    print(text)
    if output:
        output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
