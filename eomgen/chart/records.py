"""What is swept, what a run was worth, and the whole chart."""

from __future__ import annotations

from dataclasses import dataclass

OK = "ok"
FAILURES = {  # status -> what the reader is told
    "nan": "not finite",
    "diverged": "far from the reference",
    "energy": "the energy is off",
    "constraint": "the constraints are off",
    "newton": "the iterations left a residual",
    "singular": "singular",
    "timeout": "not run: it would take too long",
}
PRECISIONS = {"f64": "double", "f32": "float"}
SCHEMA = 1  # version of chart.json


@dataclass(frozen=True)
class Sweep:
    """What the user wants; None: not said."""

    target: float = 1e-4  # of positions and rates, relative
    budget: float | None = None  # us a step
    horizon: float = 10.0  # s
    formulations: tuple[str, ...] = ()  # all that the scene has
    integrators: tuple[str, ...] = ()  # all that it can have
    precisions: tuple[str, ...] = ("f64", "f32")
    steps: tuple[float, float, int] | None = None  # largest, smallest [s], how many
    seconds: float = 40.0  # for the runs and their timing
    seed: int = 1  # of the order in which points are timed


@dataclass(frozen=True)
class Combination:
    """One run; `states`: numbers that are integrated; `projects`: back to the constraints."""

    formulation: str
    integrator: str
    order: int
    precision: str
    step: float  # s
    states: int
    projects: bool

    @property
    def name(self) -> str:
        """For tables and legends."""
        return f"{self.formulation} + {self.integrator}"


@dataclass(frozen=True)
class Errors:
    """Maxima over the output grid, relative; NaN where there is nothing to compare."""

    positions: float
    rates: float
    outputs: float  # of the spec
    energy: float
    constraint: float  # of the residuals, over the size of the coordinates

    @property
    def judged(self) -> float:
        """What the target is compared with."""
        return max(self.positions, self.rates)


@dataclass(frozen=True)
class Point:
    """A run and its cost per simulated second; operations are exact, seconds were measured."""

    run: Combination
    status: str
    errors: Errors
    operations: float
    seconds: float | None = None
    median: float | None = None  # of the repeats
    resolved: bool = True  # well above the error of the reference

    @property
    def cost(self) -> float:
        """Seconds where they were measured."""
        return self.operations if self.seconds is None else self.seconds


@dataclass(frozen=True)
class Reference:
    """What the runs are compared with, and how well it is known."""

    about: tuple[str, str]  # two independent ways
    error: float  # their difference


@dataclass(frozen=True)
class Chart:
    """Everything that is drawn and written."""

    title: str
    name: str
    digest: str
    sweep: Sweep
    horizon: float  # s, after a cut for chaos
    reference: Reference
    points: tuple[Point, ...]
    remarks: tuple[str, ...]  # what was left out, and why
    machine: dict[str, str]

    @property
    def good(self) -> tuple[Point, ...]:
        """The runs that did not fail."""
        return tuple(p for p in self.points if p.status == OK)
