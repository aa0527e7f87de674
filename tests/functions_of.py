"""Functions that are asked for, of a case of `reference`, and their values in 50 digits."""

from functools import cache

import numpy as np
from reference import STATES, arguments, stem, wanted, written
from scenes import LINKED, machine_of, study_of

from eomgen import formulation, interpreter
from eomgen.checks import samples
from eomgen.functions import table
from eomgen.functions.motion import Motion
from eomgen.interpreter import mpmath_arithmetic
from eomgen.wanted import Wanted

PRECISE = mpmath_arithmetic(60)
STEP = PRECISE.number(10) ** -20
JACOBIANS = {  # of the state derivative, with what each is the derivative by
    "state_jacobian": "state",
    "input_jacobian": "inputs",
    "parameter_jacobian": "parameters",
    "time_jacobian": "time",
}
EVERYTHING = tuple(table.ROWS)


@cache
def compiled(case):
    """The machine of a case."""
    if stem(case) not in LINKED:
        return machine_of(case)
    scene = study_of(stem(case)).links.scene
    return formulation.choose(scene, Wanted(wanted(case))).machine


@cache
def motion(case):
    return Motion(compiled(case))


@cache
def function(case, name):
    (found,) = table.select(written(case), compiled(case), [name]).functions
    return found


@cache
def states(case):
    """Arguments by name, at every state of `reference`, with accelerations.

    Quaternions have length 1 in all digits.
    """
    drawn = samples.draw(compiled(case).model, STATES, seed=5).accelerations
    given = {**arguments(case), "accelerations": np.array(drawn).T.reshape(STATES, -1)}
    found = [
        {name: [PRECISE.number(float(v)) for v in rows[i]] for name, rows in given.items()}
        for i in range(STATES)
    ]
    if compiled(case).model.quaternions:
        for state in found:
            normal = list(value(case, "project_positions", state))
            state["state"][: len(normal)] = normal
    return found


def value(case, name, given):
    """The results as an array of the shape of the function."""
    found = function(case, name)
    results = interpreter.run(found, given, PRECISE)
    return np.array(results, dtype=object).reshape(found.shape)


def slope(case, name, given, argument, index):
    """The central difference of a function's results by one component of an argument."""
    ends = []
    for sign in (1, -1):
        moved = list(given[argument])
        moved[index] += sign * STEP
        ends.append(value(case, name, {**given, argument: moved}).ravel())
    return (ends[0] - ends[1]) / (2 * STEP)


def slopes(case, name, given, argument):
    """A column for each component of an argument."""
    columns = [slope(case, name, given, argument, i) for i in range(len(given[argument]))]
    return np.array(columns, dtype=object).T


def difference(found, expected):
    """The largest difference, relative to the largest expected number where that exceeds 1."""
    found, expected = np.ravel(found), np.ravel(expected)
    size = max([1, *map(abs, expected)])
    return float(max((abs(a - b) for a, b in zip(found, expected, strict=True)), default=0) / size)
