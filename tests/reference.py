"""What the functions of a shipped spec are worth at random arguments, in 50 digits."""

from functools import cache

import mpmath
import numpy as np
from scenes import SHIPPED, model_of, program_of

from eomgen import interpreter
from eomgen.checks import samples

NAMES = tuple(SHIPPED)
STATES = 5
DIGITS = 50
BALANCE = ("bias", "generalized_forces")  # terms of one equation: an h of 0 has no size of its own
ARGUMENTS = ("time", "state", "inputs", "parameters")


@cache
def arguments(name):
    """(STATES, n) arrays by the names of ARGUMENTS, of numbers that single precision holds too."""
    drawn = samples.draw(model_of(name), STATES, seed=11).arguments()
    return {
        argument: np.array(drawn[argument], dtype=np.float32)
        .reshape(-1, STATES)
        .T.astype(np.float64)
        for argument in ARGUMENTS
    }


@cache
def exact(name):
    """Function -> for each state its results, row by row."""
    arithmetic = interpreter.mpmath_arithmetic(DIGITS)
    given = arguments(name)

    def results(function, number):
        numbers = {a: [mpmath.mpf(float(v)) for v in given[a][number]] for a in ARGUMENTS}
        return interpreter.run(function, numbers, arithmetic)

    return {f.name: [results(f, n) for n in range(STATES)] for f in program_of(name).functions}


def worst_error(name, function, found):
    """The worst error at any state, relative to the largest of the terms that it stands beside."""
    beside = [exact(name)[f] for f in BALANCE] if function in BALANCE else []
    worst = 0.0
    for number, (wanted, got) in enumerate(zip(exact(name)[function], found, strict=True)):
        terms = [*wanted, *(term for results in beside for term in results[number])]
        size = max(map(abs, terms), default=0) or 1
        worst = max([worst, *(float(abs(w - g) / size) for w, g in zip(wanted, got, strict=True))])
    return worst
