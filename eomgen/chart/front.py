"""The Pareto front with margins for noise, and the line that recommends one run."""

from __future__ import annotations

from collections.abc import Sequence

from eomgen.chart.records import OK, PRECISIONS, Chart, Point

CHEAPER, BETTER = 1.1, 1.2  # below these factors two points count as equal
MARGIN = 2.0  # of the error: what is recommended has twice the accuracy asked for


def front(points: Sequence[Point]) -> tuple[Point, ...]:
    """The points that none beats in cost and accuracy at once, cheapest first."""
    good = [p for p in points if p.status == OK]
    kept = [p for p in good if not any(_beats(other, p) for other in good)]
    return tuple(sorted(kept, key=lambda p: p.cost))


def _beats(other: Point, one: Point) -> bool:
    """Both cheaper by more than 10 % and more accurate by more than 20 %."""
    cheaper = other.cost * CHEAPER < one.cost
    return cheaper and other.errors.judged * BETTER < one.errors.judged


def recommended(chart: Chart) -> Point | None:
    """The cheapest run with the margin, whose next larger step did not fail either."""
    fitting = [p for p in chart.good if _fits(chart, p)]
    if not fitting:
        return None
    least = min(p.cost for p in fitting)
    near = [p for p in fitting if p.cost <= CHEAPER * least]
    return min(near, key=lambda p: (p.run.states, p.run.projects, p.run.order, p.cost))


def _fits(chart: Chart, point: Point) -> bool:
    if point.errors.judged * MARGIN > chart.sweep.target:
        return False
    if chart.sweep.budget is not None and _microseconds(point) > chart.sweep.budget:
        return False
    larger = _next_larger(chart, point)
    return larger is not None and larger.status == OK


def _microseconds(point: Point) -> float:
    """Of CPU for one step; infinite where it was not measured."""
    return float("inf") if point.seconds is None else 1e6 * point.seconds * point.run.step


def _next_larger(chart: Chart, point: Point) -> Point | None:
    """The same run with the next larger step."""
    run = point.run
    same = [
        p
        for p in chart.points
        if (p.run.name, p.run.precision) == (run.name, run.precision) and p.run.step > run.step
    ]
    return min(same, key=lambda p: p.run.step, default=None)


def sentence(chart: Chart) -> str:
    """The recommendation in one line."""
    best = recommended(chart)
    head = f"For error <= {chart.sweep.target:g} over {chart.horizon:g} s"
    if best is None:
        return f"{head}: none of these runs; {_closest(chart)}. {_unresolved(chart)}"
    parts = [
        f"{head}: {best.run.name}, h = {milliseconds(best.run.step)}, "
        f"{PRECISIONS[best.run.precision]}: {_cost(best)}, error {best.errors.judged:.1g} "
        f"(margin {chart.sweep.target / best.errors.judged:.2g}x)"
        + (f", constraint {best.errors.constraint:.0e}" if best.errors.constraint > 0 else "")
        + ".",
        _float(chart, best),
        _next(chart, best),
        _unresolved(chart),
    ]
    return " ".join(p for p in parts if p)


def milliseconds(step: float) -> str:
    """A step as a person says it."""
    return f"{1e3 * step:.6g} ms"


def _cost(point: Point) -> str:
    if point.seconds is None:
        return f"{point.operations:.3g} operations per simulated second"
    return f"{1e3 * point.seconds:.2g} ms per simulated second"


def _closest(chart: Chart) -> str:
    best = min(chart.good, key=lambda p: p.errors.judged, default=None)
    if best is None:
        return "all failed"
    step = milliseconds(best.run.step)
    return f"the best is {best.run.name}, h = {step}, with {best.errors.judged:.1g}"


def _float(chart: Chart, best: Point) -> str:
    """The cheapest float that fits, or the best one that misses."""
    if best.run.precision == "f32" or "f32" not in chart.sweep.precisions:
        return ""
    floats = [p for p in chart.good if p.run.precision == "f32"]
    fitting = [p for p in floats if _fits(chart, p)]
    if fitting:
        one = min(fitting, key=lambda p: p.cost)
        return f"Cheapest float: {one.run.name}, h = {milliseconds(one.run.step)}: {_cost(one)}."
    if not floats:
        return "No run in float succeeds."
    one = min(floats, key=lambda p: p.errors.judged)
    return (
        f"Best float: {one.run.name}, h = {milliseconds(one.run.step)} "
        f"misses ({one.errors.judged:.0e})."
    )


def _next(chart: Chart, best: Point) -> str:
    """The cheapest run of another kind."""
    other = [p for p in chart.good if _fits(chart, p) and p.run.name != best.run.name]
    if not other:
        return ""
    one = min(other, key=lambda p: p.cost)
    return f"Next: {one.run.name} {100 * (one.cost / best.cost - 1):+.0f} % {_unit(one)}."


def _unit(point: Point) -> str:
    return "operations" if point.seconds is None else "time"


def _unresolved(chart: Chart) -> str:
    return f"Not resolved below {chart.reference.error:.0e} (reference)."
