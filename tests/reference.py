"""What the functions of a shipped spec are worth at random arguments, in 50 digits.

A case is a spec, or a linked spec and its formulation: `four_bar`, `four_bar-minimal`.
"""

from functools import cache

import mpmath
import numpy as np
from scenes import FREE, LINKED, model_of, program_of, study_of

from eomgen import interpreter
from eomgen.checks import links, samples

STATES = 5
DIGITS = 50
ARGUMENTS = ("time", "state", "inputs", "parameters")
BALANCE = ("bias", "generalized_forces")  # terms of one equation: an h of 0 has no size of its own
VANISHING = {"constraint_residuals": "coordinates", "constraint_rates": "rates"}
# what `auto` does not choose, of scenes that differ in kind
BESIDE_AUTO = (
    "andrews_squeezer-minimal",
    "andrews_squeezer-nullspace",
    "ball_on_turntable-nullspace",
    "block_on_incline-minimal",
    "bricard-multiplier",
    "chaplygin_sleigh-nullspace",
    "four_bar-minimal",
    "four_bar-nullspace",
    "rolling_disc_tilting-nullspace",
    "slider_crank-minimal",
)
LINKED_CASES = (*LINKED, *BESIDE_AUTO)
CASES = (*FREE, *LINKED_CASES)


def stem(case):
    """The spec of a case."""
    return case.partition("-")[0]


def wanted(case):
    """The formulation of a case."""
    return case.partition("-")[2] or "auto"


def written(case):
    """The program that `generate` renders."""
    return program_of(stem(case), wanted(case))


def single(columns):
    """A (STATES, n) array of numbers that single precision holds too."""
    return np.array(columns, dtype=np.float32).reshape(-1, STATES).T.astype(np.float64)


@cache
def arguments(case):
    """(STATES, n) arrays by the names of ARGUMENTS; a linked scene is on its constraints."""
    drawn = samples.draw(model_of(stem(case)), STATES, seed=11).arguments()
    if case in LINKED_CASES:
        drawn |= admissible(case)
    return {argument: single(drawn[argument]) for argument in ARGUMENTS}


def admissible(case):
    """Time, state and parameters of the admissible states: a list for each component."""
    states = [found.state for found in study_of(stem(case)).links.scene.report.states]
    assert len(states) == STATES
    program, model = written(case), model_of(stem(case))
    places = {c.name: [s.coordinates[i] for s in states] for i, c in enumerate(model.coordinates)}
    rates = {c.rate.name: [s.rates[i] for s in states] for i, c in enumerate(model.coordinates)}
    scene = study_of(stem(case)).links.scene
    moving = places | rates
    own = [links.speeds_of(scene, s) for s in states]
    moving |= {s.name: [row[i] for row in own] for i, s in enumerate(model.speeds)}
    return {
        "time": [[float(s.time) for s in states]],
        "state": [
            [float(v) for v in moving[variable.name]]
            for variable in (*program.coordinates, *program.speeds)
        ],
        "parameters": np.array([s.parameters for s in states], dtype=np.float64).T.tolist(),
    }


@cache
def exact(case):
    """Function -> for each state its results, row by row."""
    arithmetic = interpreter.mpmath_arithmetic(DIGITS)
    given = arguments(case)

    def results(function, number):
        numbers = {a: [mpmath.mpf(float(v)) for v in given[a][number]] for a in ARGUMENTS}
        return interpreter.run(function, numbers, arithmetic)

    return {f.name: [results(f, n) for n in range(STATES)] for f in written(case).functions}


def terms(case, function, number):
    """Numbers of the size that the results of a function have where nothing cancels."""
    found = exact(case)
    if function in VANISHING:  # the terms of J q and J q'
        state = study_of(stem(case)).links.scene.report.states[number].state
        values = [float(v) for v in getattr(state, VANISHING[function])]
        slopes = found["constraint_jacobian"][number]
        return [slope * values[i % len(values)] for i, slope in enumerate(slopes)]
    return [term for name in beside(case, function) for term in found[name][number]]


def beside(case, function):
    """The functions whose results are of one size with those of this one."""
    if function in BALANCE:
        # rolling at a constant speed: h cancels, and no force is applied
        return (*BALANCE, "mass_matrix") if case in LINKED_CASES else BALANCE
    if function.startswith("accelerations_"):  # none while a contact sticks
        return tuple(n for n in exact(case) if n.startswith("accelerations"))
    return (function,)


# what `watch` returns is a tolerance less a square of round-off: its sign counts, not its digits
MARGINS = {"watch": 1000}


def worst_error(case, function, found):
    """The worst error at any state, relative to the largest of the terms that it stands beside."""
    worst = 0.0
    for number, (wanted, got) in enumerate(zip(exact(case)[function], found, strict=True)):
        size = max(map(abs, terms(case, function, number)), default=0) or 1
        size *= MARGINS.get(function, 1)
        worst = max([worst, *(float(abs(w - g) / size) for w, g in zip(wanted, got, strict=True))])
    return worst
