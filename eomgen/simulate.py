"""A run: rows as they come, and at the end what it was worth - energy, constraints, events."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from math import ceil

import numpy as np

from eomgen.errors import UsageError
from eomgen.integrators.methods import METHODS
from eomgen.numerics import adaptive, hybrid, integrate, steps_python
from eomgen.numerics.records import Array, Event, Function, Grid, Rows
from eomgen.simulate_method import Choice
from eomgen.simulate_setup import Setup, contact_scene

ROWS = 400  # of the output, where no step of it is given
LEAST_ROWS = 100  # that tell how large the energies become
MOST_ROWS = 10_000_000
NEARLY = 1e-9
BOTH = ("constraint_residuals", "constraint_rates")


@dataclass
class Verdict:
    """What a run was worth so far; energies in joule."""

    steps: int = 0
    time: float = 0.0
    state: Array = field(default_factory=lambda: np.zeros(0))
    stopped: int = 0
    tally: dict[int, tuple[int, int]] = field(default_factory=dict)
    events: list[Event] = field(default_factory=list)
    lost: float = 0.0  # energy that impacts took
    work: float = 0.0
    energy_error: float = 0.0
    kinetic: float = 0.0  # the largest
    potential: tuple[float, float] = (np.inf, -np.inf)
    residuals: dict[str, float] = field(default_factory=dict)
    started: float | None = None  # the energy at the start

    @property
    def energy_scale(self) -> float:
        """The largest kinetic energy and the span of the potential one."""
        low, high = self.potential
        return self.kinetic + (high - low if high > low else 0.0)

    @property
    def relative_energy_error(self) -> float:
        """Of the scale; zero where nothing has energy."""
        return self.energy_error / self.energy_scale if self.energy_scale > 0 else 0.0


def rows(setup: Setup, choice: Choice, outputs: Array) -> Iterator[Rows]:
    """The rows of a run at the output times, the first one the start.

    Raises:
        UsageError: the steps of a fixed-step method do not meet the output times.
        CheckError: the solver gives up, or a contact does what the spec does not describe.
    """
    start = setup.start
    scene = contact_scene(setup, float(outputs[-1] - outputs[0]))
    if scene is not None:
        yield from hybrid.pieces(scene, outputs, start.state, choice.limits)
        return
    yield Rows(outputs[:1], start.state.reshape(1, -1), np.zeros(1))
    yield from (_fixed if choice.is_fixed else _adaptive)(setup, choice, outputs)


def _flow(setup: Setup) -> str | None:
    """The function whose power is integrated; none where it is zero by its form."""
    return None if setup.is_conserved else setup.flow


def _fixed(setup: Setup, choice: Choice, outputs: Array) -> Iterator[Rows]:
    """Whole steps, then a shorter one to the end."""
    method, start = METHODS[choice.method], setup.start
    span = (float(outputs[0]), float(outputs[-1]))
    every = _every(outputs, choice.step)
    grid = integrate.grid_of(span, choice.step, every)
    grid = replace(grid, count=grid.count // every * every)
    last = Rows(outputs[:1], start.state.reshape(1, -1), np.zeros(1))
    for piece in integrate.pieces(setup.engine, method, start.state, grid, _flow(setup)):
        yield piece
        last = piece if len(piece.times) else last
        if piece.stopped:
            return
    reached = span[0] + grid.count * choice.step
    rest = span[1] - reached
    if rest > NEARLY * choice.step:
        count = ceil(rest / choice.step - NEARLY)
        end = Grid(reached, rest / count, count, count)
        found = integrate.run(setup.engine, method, last.states[-1], end, _flow(setup))
        works = found.works[1:] + last.works[-1]
        yield replace(found, times=found.times[1:], states=found.states[1:], works=works)


def _every(outputs: Array, step: float) -> int:
    """Steps between rows."""
    gap = outputs[-1] - outputs[0] if len(outputs) < 3 else outputs[1] - outputs[0]
    return max(1, round(float(gap) / step))


def _adaptive(setup: Setup, choice: Choice, outputs: Array) -> Iterator[Rows]:
    steps, engine = setup.steps, setup.engine
    has_project = steps.projects_positions or steps.has("project_rates")
    known: dict[str, Function] = {}

    def call(name: str) -> Function:
        if name not in known:
            known[name] = engine.function(name)
        return known[name]

    def project(t: float, y: Array) -> tuple[Array, int]:
        return steps_python.admissible(steps, call, t, y)

    given = adaptive.problem(engine, project if has_project else None, _flow(setup))
    yield from adaptive.pieces(choice.method, given, outputs, setup.start.state, choice.limits)


def outputs_of(span: tuple[float, float], choice: Choice, every: float | None) -> Array:
    """The times of the rows: every so often [s] from the start, and the end.

    Without `every`, `ROWS` of them, or as many whole steps of a fixed-step method as come near.

    Raises:
        UsageError: there would be too many of them or of steps, or a row would not fall on a step.
    """
    start, end = span
    gap = (end - start) / ROWS if every is None else every
    if choice.is_fixed:
        integrate.grid_of(span, choice.step, 1)
        gap = _whole_steps(gap, choice.step, is_exact=every is not None)
    if gap > end - start:
        return np.array([start, end])
    if (end - start) / gap > MOST_ROWS:
        raise UsageError(
            f"{(end - start) / gap:.3g} rows are too many: at most {MOST_ROWS:.0e}; "
            "give a larger --output-step"
        )
    count = int((end - start) / gap + NEARLY)
    times = start + gap * np.arange(count + 1)
    if end - times[-1] > NEARLY * gap:
        return np.append(times, end)
    times[-1] = end
    return times


def _whole_steps(gap: float, step: float, *, is_exact: bool) -> float:
    count = round(gap / step)
    if is_exact and (count < 1 or abs(gap / step - count) > NEARLY * max(1, count)):
        raise UsageError(
            f"--output-step {gap:.9g} is no multiple of the step {step:.9g}; "
            f"give {max(1, count) * step:.9g}"
        )
    return max(1, count) * step


def closer(outputs: Array, choice: Choice) -> tuple[Array, int]:
    """Times near enough for the scale of the energy, and how many stand for one of `outputs`.

    Rows a period apart would see a motion that stands still. Steps stay whole.
    """
    gap, count = float(outputs[1] - outputs[0]), len(outputs) - 1
    parts = ceil(LEAST_ROWS / count)
    if choice.is_fixed:
        parts = _whole_parts(gap / choice.step, parts)
    if parts == 1:
        return outputs, 1
    between = outputs[:-2, None] + gap * np.arange(parts) / parts
    left = ceil(float(outputs[-1] - outputs[-2]) / gap * parts - NEARLY)  # the last may be shorter
    last = outputs[-2] + gap * np.arange(left) / parts
    return np.concatenate([between.ravel(), last, outputs[-1:]]), parts


def _whole_parts(steps: float, least: int) -> int:
    """Into how many parts of whole steps so many steps go; 1 where it is far from `least`."""
    count = round(steps)
    if abs(steps - count) > NEARLY * max(1, count):
        return 1
    return next((n for n in range(min(least, count), 10 * least) if count % n == 0), 1)


def judge(setup: Setup, verdict: Verdict, found: Rows) -> None:
    """Take more rows into the verdict."""
    verdict.steps += found.steps
    verdict.stopped |= found.stopped
    verdict.events += found.events
    verdict.lost += found.lost
    for bit, (count, first) in found.tally.items():
        seen, since = verdict.tally.get(bit, (0, first))
        verdict.tally[bit] = (seen + count, since)
    if not len(found.times):
        return
    verdict.time, verdict.state = float(found.times[-1]), found.states[-1]
    _energies(setup, verdict, found)
    for name in BOTH:
        if setup.steps.has(name):
            values = setup.engine.sweep(name, found.times, found.states)
            worst = float(np.max(np.abs(values), initial=verdict.residuals.get(name, 0.0)))
            verdict.residuals[name] = worst


def _energies(setup: Setup, verdict: Verdict, found: Rows) -> None:
    """E - E0 - work, where the work of impacts is in the rows' already."""
    both = setup.engine.sweep("energy", found.times, found.states)
    verdict.kinetic = max(verdict.kinetic, float(np.max(both[:, 0])))
    low, high = verdict.potential
    verdict.potential = (min(low, float(np.min(both[:, 1]))), max(high, float(np.max(both[:, 1]))))
    if setup.flow is None:
        return
    stored = setup.engine.sweep(setup.flow, found.times, found.states)[:, 0]
    if verdict.started is None:
        verdict.started = float(stored[0])
    errors = np.abs(stored - verdict.started - found.works)
    verdict.energy_error = max(verdict.energy_error, float(np.max(errors)))
    verdict.work = float(found.works[-1])
