"""The chart of a scene: variants, reference, runs, times."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

from eomgen.chart import reference, runs, timing, variants
from eomgen.chart.records import Chart, Point, Sweep
from eomgen.chart.reference import Motion
from eomgen.chart.runs import Plan
from eomgen.chart.variants import Variant
from eomgen.errors import UsageError
from eomgen.integrators.methods import METHODS
from eomgen.study import Study

UNOFFERED = "M is not constant, or forces depend on rates: not symplectic"
UNTIMED = "not every run could be timed; the cost is in operations: give more --seconds"
FOR_RUNS, FOR_TIMES = 0.5, 0.5  # of the seconds that the chart may take


def chart(study: Study, sweep: Sweep, state: str, inputs: dict[str, str]) -> Chart:
    """Everything that the chart shows.

    Raises:
        UsageError: the scene has no chart, a name is unknown, a start is missing.
        CheckError: there is no reference.
    """
    for name in sweep.integrators:
        if name not in METHODS:
            raise UsageError(f"there is no integrator {name!r}; there are {', '.join(METHODS)}")
    found = variants.of(study, state, inputs, sweep.formulations)
    for precision in sweep.precisions:
        found = tuple(variants.in_precision(v, precision) for v in found)
    horizon, said = reference.trusted_horizon(found[0], sweep.horizon, sweep.target)
    motion, known = reference.of(found, horizon)
    began = time.monotonic()
    pairs = _run(
        _plans(found, sweep, motion), motion, known.error, began + FOR_RUNS * sweep.seconds
    )
    left = began + (FOR_RUNS + FOR_TIMES) * sweep.seconds - time.monotonic()
    points, is_whole = timing.timed(pairs, left, sweep.seed)
    if not is_whole:
        # one cost for all: times of some would hide the others
        points = tuple(replace(p, seconds=None, median=None) for p in points)
    remarks = (said, "" if is_whole else UNTIMED, *_left_out(found, sweep))
    steps = found[0].setup.steps
    return Chart(
        title=steps.program.title,
        name=steps.name,
        digest=steps.program.digest,
        sweep=sweep,
        horizon=horizon,
        reference=known,
        points=points,
        remarks=tuple(r for r in remarks if r),
        machine=timing.machine(),
    )


def _plans(found: tuple[Variant, ...], sweep: Sweep, motion: Motion) -> list[Plan]:
    """All runs, the cheapest first, so that what must be left out is what costs most."""
    made = [
        plan for v in found for p in sweep.precisions for plan in runs.plans(v, p, sweep, motion)
    ]
    return sorted(made, key=runs.foreseen)


def _run(plans: list[Plan], motion: Motion, known: float, end: float) -> list[tuple[Plan, Point]]:
    """Every plan with its point; those that would end too late are not run."""
    pairs = []
    for plan in plans:
        late = time.monotonic() + runs.foreseen(plan) > end
        pairs.append((plan, runs.missing(plan) if late else runs.made(plan, motion, known)))
    return pairs


def _left_out(found: tuple[Variant, ...], sweep: Sweep) -> Iterator[str]:
    """Integrators that a formulation cannot have."""
    for variant in found:
        missing = [
            name
            for name in sweep.integrators or METHODS
            if name not in {m.name for m in variant.methods}
        ]
        if missing:
            yield f"{variant.name}: not offered {', '.join(missing)} ({UNOFFERED})"
