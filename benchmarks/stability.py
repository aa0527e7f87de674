"""The numbers of the stability suite as a page: what each method can bear, measured and in theory.

One command: python benchmarks/stability.py [-o FILE]. It runs the scenes of `tests/stability`.
"""

from __future__ import annotations

import argparse
import sys
from math import inf
from pathlib import Path

import numpy as np

TESTS = Path(__file__).parents[1] / "tests"
sys.path[:0] = [str(TESTS), str(TESTS / "stability")]

import laboratory as lab  # noqa: E402
import measures  # noqa: E402

from eomgen.integrators.methods import METHODS  # noqa: E402
from eomgen.numerics.records import UNPROJECTED  # noqa: E402
from eomgen.stability.theory import Linear, largest_step  # noqa: E402


def limits() -> list[str]:
    """Largest h omega of the oscillator: by the C / by theory."""
    lines = [
        "| method | " + " | ".join(f"zeta = {z:g}" for z in measures.ZETAS) + " |",
        "|---|" + "---|" * len(measures.ZETAS),
    ]
    for method in (*measures.LIMITS, "rosenbrock2", "midpoint"):
        cells = " | ".join(_limit(method, zeta) for zeta in measures.ZETAS)
        lines.append(f"| {method} | {cells} |")
    return lines


def _limit(method: str, zeta: float) -> str:
    if method not in lab.EVERY:
        return f"{measures.measured_limit(method, zeta):.3f}"
    matrix = np.array([[0.0, 1.0], [-1.0, -2 * zeta]])
    theory = largest_step(lab.EVERY[method], Linear(matrix, 1))
    if theory == inf:
        return "none"
    return f"{measures.measured_limit(method, zeta):.3f} / {theory:.3f}"


def energy() -> list[str]:
    """Relative change of the energy in a period of 100 steps."""
    lines = ["| method | by the C | by theory |", "|---|---|---|"]
    for method, (_, formula, _) in measures.ENERGY.items():
        lines.append(
            f"| {method} | {measures.energy_change(method, 100):+.2e} | {formula(100):+.2e} |"
        )
    return lines


def drifts() -> list[str]:
    """Energy of the double pendulum (rows 6, 7)."""
    steps = lab.stepped(lab.DOUBLE_PENDULUM)
    scene, start = lab.engine(steps), lab.start(steps)
    lines = ["| method | h = 0.01 | h = 0.001 |", "|---|---|---|"]
    for method in ("semi-euler", "verlet", "rk4", "midpoint"):
        found = [
            lab.drift(scene, lab.run(scene, method, start, h, round(1000 / h), 100))
            for h in (1e-2, 1e-3)
        ]
        lines.append(f"| {method} | {found[0]:.1e} | {found[1]:.1e} |")
    return lines


def residuals() -> list[str]:
    """Residual of the crank-rocker after 10, 100, 1000 s (row 8)."""
    lines = ["| formulation | 10 s | 100 s | 1000 s |", "|---|---|---|---|"]
    for formulation in ("multiplier", "nullspace"):
        for bare in (True, False):
            steps = lab.stepped(lab.CRANK_ROCKER, formulation, bare=bare)
            scene = lab.engine(steps)
            rows = lab.run(scene, "rk4", lab.start(steps), 1e-3, 1_000_000, 1000)
            found = lab.residual(scene, rows)
            cells = " | ".join(f"{found[: t + 1].max():.1e}" for t in (10, 100, 1000))
            lines.append(f"| {formulation}{'' if bare else ', projected'} | {cells} |")
    return lines


def spatial() -> list[str]:
    """Energy of the arm with skew axes and full inertia, without its damper."""
    steps = lab.stepped("skew_arm")
    scene, start = lab.engine(steps, b=0.0), lab.start(steps)
    lines = ["| method | h = 0.01 | h = 0.005 | h = 0.001 |", "|---|---|---|---|"]
    for method in METHODS:
        found = [
            lab.drift(scene, lab.run(scene, method, start, h, round(100 / h), 10))
            for h in (1e-2, 5e-3, 1e-3)
        ]
        lines.append(f"| {method} | " + " | ".join(f"{d:.1e}" for d in found) + " |")
    return lines


def insisted() -> list[str]:
    """The null space where it is refused (rows 12, 15): as if no position were singular."""
    lines = ["| scene | h [s] | angle off [rad] | energy | unprojected steps |", "|---" * 5 + "|"]
    for name, span, counts in (
        ("parallelogram", 10, (2e-2, 1e-2, 5e-3, 1e-3, 1e-4)),
        ("slider_crank_equal", 2, (2e-3, 1e-3, 5e-4, 1e-4)),
    ):
        exact, steps = lab.stepped(name, "multiplier"), lab.insisting(name, "nullspace")
        fine = lab.run(lab.engine(exact), "rk4", lab.start(exact), 2e-4, round(span * 5e3))
        scene = lab.engine(steps)
        for h in counts:
            rows = lab.run(scene, "rk4", lab.start(steps), h, round(span / h), 10)
            skipped = rows.tally.get(UNPROJECTED, (0, 0))[0]
            off = abs(rows.states[-1, 0] - fine.states[-1, 0])
            said = "lost | -" if lab.failed(rows) else f"{off:.1e} | {lab.drift(scene, rows):.1e}"
            lines.append(f"| {name} | {h:g} | {said} | {skipped} |")
    return lines


def singular() -> list[str]:
    """The parallelogram through its singular position (row 12), and its unequal variants."""
    head = "| links | h [s] | ends | angle off [rad] | energy | unprojected steps |"
    lines = [head, "|---" * 6 + "|"]
    lengths = {
        "rocker 1 + 1e-6": ("1", "1", "1.000001", "1"),
        "rocker 1 - 1e-6": ("1", "1", "0.999999", "1"),
        "coupler 1 + 1e-6": ("1", "1.000001", "1", "1"),
        "ground 1 + 1e-6": ("1", "1", "1", "1.000001"),
    }
    unequal = {name: lab.FOUR_BAR.format(*bars, lab.TURNING) for name, bars in lengths.items()}
    scenes = {"equal": "parallelogram", **unequal}
    for name, text in scenes.items():
        steps = lab.stepped(text, "multiplier")
        scene = lab.engine(steps)
        for h in (1e-2, 1e-3, 2e-4, 1e-4):
            rows = lab.run(scene, "rk4", lab.start(steps), h, round(10 / h), 10)
            lines.append(f"| {name} | {h:g} | {_singular(scene, rows)} |")
    return lines


def _singular(scene: object, rows: object) -> str:
    skipped = rows.tally.get(UNPROJECTED, (0, 0))[0]  # type: ignore[attr-defined]
    if lab.failed(rows):
        return f"lost | - | - | {skipped}"
    off = abs(rows.states[-1, 0] - measures.exact_parallelogram()[0])  # type: ignore[attr-defined]
    return f"10 s | {off:.1e} | {lab.drift(scene, rows):.1e} | {skipped}"


def floats() -> list[str]:
    """Error of the crank after 10 s in float (row 19)."""
    names = [(f, c) for f in ("minimal", "nullspace", "multiplier") for c in (False, True)]
    found = [measures.best_in_float(f, compensated=c) for f, c in names]
    lines = ["| formulation | " + " | ".join(f"h = {h:g}" for h in found[0]) + " |",
             "|---|" + "---|" * len(found[0])]  # fmt: skip
    for (formulation, compensated), errors in zip(names, found, strict=True):
        cells = " | ".join(f"{e:.1e}" for e in errors.values())
        lines.append(f"| {formulation}{', compensated' if compensated else ''} | {cells} |")
    return lines


FINDINGS = """\
## What these numbers say

* A step is told to be too large by its limit alone: RK4 bears h omega = 2.83, fixed-step dopri5
  only 1.0 where nothing damps. Verlet's position form has the limit of semi-implicit Euler under
  damping (0.83 at zeta = 1), the velocity form 2.0; the generated one is therefore refused where
  forces depend on rates.
* With M(q), semi-implicit Euler and Verlet drift with order 1. RK4 and the midpoint rule of (q,
  p) do not.
* Projection keeps the constraints, not the energy: under semi-implicit Euler at h = 0.001 the
  projected multiplier form of the four-bar linkage gains energy and runs away after 150 s; the
  null space loses energy instead.
* The parallelogram passes its singular position at h = 0.01, 0.001 and 0.0002. With h = 0.0001 a
  stage is at q1 = 6e-8, where the multipliers have no digits: the run takes another branch, and
  that step says that its constraints are off. With one bar off by 1e-6 there is no smooth passage:
  every fixed step is lost or ends with a wrong energy, and every such run says that steps were not
  projected.
* The null space would pass the parallelogram too, but not at the smallest step: where a step lands
  that near, the dependent rates are a quotient of roundings. At the dead point of equal arms the
  rank itself falls, so that no other choice of dependent rates helps. It is refused there, and
  multipliers are taken; at a dead point of full rank `W-PIVOT` names the coordinates to change.
* Implicit damping in semi-implicit Euler turns the limit 2 (sqrt(1 + zeta^2) - zeta) into
  2 (sqrt(1 + zeta^2) + zeta): damping helps instead of hurting. It costs a factorisation.
* Yaw, pitch and roll that miss the pole by 1e-3 rad overflow at h = 0.01 and are off by 6e-2 rad at
  h = 0.001 (turning with 1 rad/s); the quaternion is off by 2e-11 and 2e-16.
* In float, smaller steps make the error larger again. The compensated sum removes that where
  nothing is projected (2e-7 instead of 1e-5 at h = 1e-5), and does not where a projection rounds
  its own result.
"""

PARTS = {
    "Largest h omega of a damped oscillator, by the C / by theory": limits,
    "Energy of an oscillator, change in a period of 100 steps": energy,
    "Energy of a double pendulum, 1000 s, worst error against the kinetic energy": drifts,
    "Energy of a spatial arm with skew axes and full inertia, 100 s": spatial,
    "Residual of a four-bar linkage [m], RK4, h = 0.001": residuals,
    "A parallelogram that passes its singular position, multipliers, RK4, 10 s": singular,
    "The null space where it is refused: against multipliers with h = 0.0002, RK4": insisted,
    "Crank angle of a four-bar linkage after 10 s in float, error [rad], RK4": floats,
}


def main() -> None:
    """Measure everything and print the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=Path)
    output = parser.parse_args().output
    parts = [line for title, part in PARTS.items() for line in (f"## {title}", "", *part(), "")]
    text = "\n".join(["# Stability, measured", "", *parts, FINDINGS])
    print(text)
    if output:
        output.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
