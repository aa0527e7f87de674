"""A request of the command line -> a job whose parts are written as they come."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from eomgen import compile_places, simulate, simulate_report, simulate_table
from eomgen.errors import UsageError
from eomgen.numerics.records import Array, Rows
from eomgen.render import animation, plot
from eomgen.simulate import Verdict
from eomgen.simulate_method import AUTO, Choice, Wish, checked, choose, wanted
from eomgen.simulate_report import ENERGY_TOLERANCE
from eomgen.simulate_setup import Setup, inputs_of, setup, start_of
from eomgen.study import Study

FRAMES = 300  # of an animation


@dataclass(frozen=True)
class Request:
    """What the command line was given; None: not said."""

    state: str
    t_end: float
    method: str = "auto"
    step: float | None = None
    rtol: float | None = None
    atol: float | None = None
    output_step: float | None = None
    inputs: tuple[str, ...] = ()
    show: tuple[str, ...] = ()
    plot: Path | None = None
    animate: Path | None = None
    energy_tolerance: float | None = None


@dataclass
class Job:
    """A run that was set up; `parts` runs it."""

    request: Request
    setup: Setup
    choice: Choice
    outputs: Array
    every: int  # of the rows at `outputs` one is shown; the others are for the verdict
    verdict: Verdict = field(default_factory=Verdict)
    kept: list[Rows] = field(default_factory=list)  # for drawings
    seconds: float = 0.0
    computed: int = 0
    rows: int = 0  # that were shown so far

    def head(self) -> str:
        """The first line of the CSV."""
        return simulate_table.csv_head(self.setup)

    def parts(self) -> Iterator[tuple[float, str]]:
        """(share of the run that is done, lines of the CSV), piece by piece."""
        start, end = self.outputs[0], self.outputs[-1]
        since = time.monotonic()
        for found in simulate.rows(self.setup, self.choice, self.outputs):
            simulate.judge(self.setup, self.verdict, found)
            self.seconds = time.monotonic() - since
            found = self._wanted(found)
            if self.request.plot or self.request.animate:
                self.kept.append(found)
            text = ""
            if len(found.times):
                text = simulate_table.csv_rows(simulate_table.values(self.setup, found))
            yield (self.verdict.time - start) / (end - start), text

    def _wanted(self, found: Rows) -> Rows:
        """Without the rows that were computed for the verdict alone."""
        places = self.computed + np.arange(len(found.times))
        self.computed += len(found.times)
        chosen = (places % self.every == 0) | (places == len(self.outputs) - 1)
        self.rows += int(np.sum(chosen))
        works = found.works[chosen] if len(found.works) else found.works
        return replace(found, times=found.times[chosen], states=found.states[chosen], works=works)

    def beginning(self) -> list[str]:
        """What is going to be done."""
        return list(simulate_report.beginning(self.setup, self.choice))

    def ending(self) -> list[str]:
        """What was done."""
        return list(simulate_report.ending(self.setup, self.verdict, self.seconds))

    def faults(self) -> list[str]:
        """Why the run is not to be trusted."""
        tolerance = self.request.energy_tolerance or ENERGY_TOLERANCE
        return list(simulate_report.faults(self.setup, self.verdict, tolerance))

    @cached_property
    def table(self) -> Array:
        """All rows."""
        parts = [simulate_table.values(self.setup, r) for r in self.kept if len(r.times)]
        return np.concatenate(parts)

    def drawings(self) -> dict[Path, str]:
        """The files of the drawings."""
        made: dict[Path, str] = {}
        if self.request.plot:
            made[self.request.plot] = plot.lines(*self._lines())
        if self.request.animate:
            made[self.request.animate] = self._animation()
        return made

    def _lines(self) -> tuple[str, list[plot.Panel]]:
        """The title and a panel for each unit."""
        columns = simulate_table.columns(self.setup)
        names = self.request.show or [c.name for c in columns if c.kind in ("coordinate", "output")]
        panels: dict[str, list[plot.Line]] = {}
        for column, values in zip(columns, self.table.T, strict=True):
            if column.name in names:
                panels.setdefault(column.unit, []).append(plot.Line(column.name, values.tolist()))
        times = self.table[:, 0].tolist()
        found = [plot.Panel(unit, times, tuple(lines)) for unit, lines in panels.items()]
        return self.setup.steps.program.title, found

    def _animation(self) -> str:
        found = [r for r in self.kept if len(r.times)]
        times = np.concatenate([r.times for r in found])
        states = np.concatenate([r.states for r in found])
        # equal times between frames, so that it moves as fast as in life
        wanted_times = np.linspace(times[0], times[-1], min(FRAMES, len(times)))
        chosen = np.unique(np.searchsorted(times, wanted_times - 1e-12).clip(0, len(times) - 1))
        places = self.setup.engine.sweep("places", times[chosen], states[chosen])
        sketch = compile_places.sketch(self.setup.study.compiled)
        return animation.page(self.setup.steps.program.title, sketch, times[chosen], places)


def job(study: Study, request: Request) -> Job:
    """The job of a request.

    Raises:
        UsageError: the request contradicts itself or the scene.
        CheckError: the start cannot be moved to the constraints.
    """
    wish = checked(_wish(study, request), study)
    if request.animate and not (study.model.bodies or study.model.points):
        raise UsageError("--animate: the scene has neither bodies nor points that could be drawn")
    start = start_of(study, request.state, inputs_of(request.inputs))
    extra = (compile_places.function(study.compiled),) if request.animate else ()
    made = setup(study, (wanted(wish, study),), start, extra)
    choice = choose(wish, made, request.t_end)
    if choice.is_fixed and choice.method not in {m.name for m in made.steps.methods}:
        made = setup(study, (choice.method,), start, extra)
    _known(made, request.show)
    outputs = simulate.outputs_of(
        (start.time, start.time + request.t_end), choice, request.output_step
    )
    return Job(request, made, choice, *simulate.closer(outputs, choice))


def _wish(study: Study, request: Request) -> Wish:
    """What was said on the command line; what it leaves open, the spec may say."""
    said = study.model.simulation
    if request.method != AUTO or request.step or request.rtol or request.atol or not said.method:
        return Wish(request.method, request.step, request.rtol, request.atol)
    return Wish(said.method, None if said.step is None else float(said.step))


def _known(made: Setup, names: tuple[str, ...]) -> None:
    known = [c.name for c in simulate_table.columns(made)]
    for name in names:
        if name not in known:
            raise UsageError(
                f"--show {name}: there is no such column; there are {', '.join(known)}"
            )
