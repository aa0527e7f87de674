"""The measurement of a checked scene, from its states to the warning."""

from __future__ import annotations

import numpy as np

from eomgen.errors import CheckError
from eomgen.evaluate import depends_on_time
from eomgen.precision import statements, states
from eomgen.precision.engines import engines
from eomgen.precision.errors import ON_CONSTRAINTS, ZERO, of_function, scales_of
from eomgen.precision.exact import Bench, plain
from eomgen.precision.records import Array, FunctionErrors, Report
from eomgen.precision.statements import Traced
from eomgen.program import Program
from eomgen.render.code_context import coded
from eomgen.render.lowered import operations
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment
from eomgen.study import Study

STATES = 1000
FEWEST = 50
AFFORDED = 16_000_000  # operations in fifty digits, all states together: under a minute
WAVE = 50  # operations that a function such as the sine counts
PLAIN = frozenset(("add", "subtract", "multiply", "divide", "negate", "sqrt", "abs", "sign"))
TOO_MUCH = 1e-3  # of error in float


def of(study: Study) -> Report:
    """The errors of the shipped code of a scene.

    Raises:
        CheckError: there is no state to measure at, or the shipped code is not what was derived.
    """
    code = coded(study.program)
    shipped = code.program
    files = render(code, TARGETS["c"], environment())
    (file,) = (name for name in files if name.endswith(".c"))
    sampled = states.draw(study, _affordable(shipped), STATES)
    bench = Bench(shipped, sampled)
    bench.prove(study.program)
    said, measured = engines(shipped, files, sampled)
    traced: dict[str, Traced] = {}
    if (prepared := bench.prepare()) is not None:
        traced["prepare"] = Traced(prepared, scales_of("prepare", prepared.results, ZERO))
    is_free = study.links is None and not study.model.quaternions
    for function in (f for f in shipped.functions if f.results):
        exact = bench.traced(function)
        scales = scales_of(function.name, exact.results, ZERO if is_free else ON_CONSTRAINTS)
        traced[function.name] = Traced(exact, scales)
    rows = [
        of_function(name, traced[name].exact, measured, bench.arithmetic, traced[name].scales)
        for name in traced
        if name != "prepare"
    ]
    if not any(r.states for r in rows):
        raise CheckError("the code has no value at any state; give `range` for the coordinates")
    condition = _condition(shipped, traced)
    return Report(
        sampled=sampled,
        names=tuple(v.name for v in (*shipped.coordinates, *shipped.speeds)),
        inputs=tuple(v.name for v in shipped.inputs),
        timed=depends_on_time(shipped),
        engine=said,
        file=file,
        functions=tuple(rows),
        statements=statements.worst_of(shipped, traced, sampled, files[file]),
        condition=condition,
        warnings=_warnings(rows, condition),
    )


def _affordable(shipped: Program) -> int:
    """How many states there is time for."""
    applied = [operations(plain(f)) for f in shipped.functions]
    cost = sum(n * (1 if o in PLAIN else WAVE) for counts in applied for o, n in counts.items())
    return min(STATES, max(FEWEST, AFFORDED // max(cost, 1)))


def _condition(shipped: Program, traced: dict[str, Traced]) -> float | None:
    """The worst condition number of M with its rows and columns scaled to ones on the diagonal.

    Source: van der Sluis, Condition numbers and equilibration of matrices (1969): no other
    diagonal scaling does much better, so units do not matter.
    """
    if "mass_matrix" not in traced:
        return None
    size = shipped.function("mass_matrix").shape[0]
    matrices = traced["mass_matrix"].exact.results.astype(float).T.reshape(-1, size, size)
    roots: Array = np.sqrt(np.diagonal(matrices, axis1=1, axis2=2))
    usable = np.isfinite(matrices).all(axis=(1, 2)) & (roots > 0).all(axis=1)
    if not usable.any():
        return None
    scaled = matrices[usable] / (roots[usable][:, :, None] * roots[usable][:, None, :])
    return float(np.linalg.cond(scaled).max())


def _warnings(rows: list[FunctionErrors], condition: float | None) -> tuple[str, ...]:
    """One line where float is not enough."""
    bad = [r for r in rows if not r.absolute and r.spreads["float"].worst > TOO_MUCH]
    if not bad:
        return ()
    worst = max(bad, key=lambda r: r.spreads["float"].worst)
    spread = worst.spreads["float"]
    cond = "" if condition is None else f"cond {condition:.0e} -> "
    return (
        f"W-F32: {cond}{worst.name} has a float error of {spread.worst:.0e} (median "
        f"{spread.median:.0e}); use double, or absolute angles and coordinates that count from "
        "the natural length of springs",
    )
