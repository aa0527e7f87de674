"""Base parameters: the combinations of inertial parameters that motions and forces can tell apart.

The columns of Y over random states have a rank; in the order of declaration each column that
depends on those before it gives its parameter to them (Gautier & Khalil, Direct calculation of
minimum set of inertial parameters of serial robots, 1990; the rank is numeric, Gautier 1991):

Y theta = Y_b theta_b,   theta_b = theta_kept + K theta_other.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from eomgen.algebra.arithmetic import evaluate
from eomgen.algebra.graph import Node
from eomgen.algebra.walk import below
from eomgen.analysis import admissible, elimination, linkage
from eomgen.analysis.linkage import PRECISE
from eomgen.checks import samples
from eomgen.errors import UsageError
from eomgen.functions import recognise
from eomgen.functions.motion import Motion
from eomgen.functions.recognise import Coefficient
from eomgen.mechanics import machine as machines
from eomgen.mechanics import motions, speeds
from eomgen.mechanics.regressor import Inertial

SPARE = 3  # states more than the columns need
Values = dict[Node, Any]


@dataclass(frozen=True)
class BaseParameter:
    """A parameter that stays, and those that it takes over, with their coefficients."""

    kept: int  # number of its column in Y
    terms: tuple[tuple[int, Coefficient], ...]


@dataclass(frozen=True)
class Base:
    """The base parameters of a scene."""

    parameters: tuple[Inertial[Node], ...]  # all
    base: tuple[BaseParameter, ...]
    without_effect: tuple[int, ...]  # their columns are zero
    states: int  # random ones, at which the rank was found in 50 digits
    error: float  # of Y theta + rest = M u' + h - Q there, relative to the largest term
    values: tuple[Any, ...] | None  # by the spec, in 50 digits; None where it leaves some open

    def name(self, parameter: BaseParameter) -> str:
        """The combination in words, as `mc_x(upper) + l_1 m(fore)`."""
        shares = (c.times(self.parameters[j].name) for j, c in parameter.terms)
        return " ".join([self.parameters[parameter.kept].name, *shares])


def of(motion: Motion) -> Base:
    """The base parameters of a scene, for the values of its parameters in the spec.

    A parameter without a value stands in with a random number.

    Raises:
        UsageError: the scene has multipliers, or too few admissible states are found.
    """
    if motion.machine.kept:
        raise UsageError(
            "base parameters need independent speeds, and this formulation has multipliers; "
            "use --formulation minimal or nullspace, with `generate` or `regressor`"
        )
    found = motion.inertial
    count = 2 * len(found) // max(motion.size, 1) + SPARE
    regression = _Regression(motion, tuple(_states(motion, count)))
    trial = regression.trial()
    relations = recognise.recognised(trial)
    kept = [i for i in range(len(found)) if i not in relations]
    base = tuple(
        BaseParameter(i, tuple((j, c[i]) for j, c in relations.items() if i in c)) for i in kept
    )
    return Base(
        parameters=found,
        base=base,
        without_effect=tuple(j for j, c in relations.items() if not c),
        states=count,
        error=regression.error(trial.values),
        values=tuple(regression.total(p, trial.values) for p in base) if trial.known else None,
    )


@dataclass(frozen=True)
class _Regression:
    """The columns of Y at random states."""

    motion: Motion
    states: tuple[Values, ...]  # of every argument but the parameters

    def trial(self) -> recognise.Trial:
        """The relations at the spec's parameters, and at others where states are free of them."""
        scene = linkage.Linkage(self.motion.machine.kinematics, ())
        values, unknown = linkage.free_parameters(scene)
        read = set(below(entry for p in self.motion.inertial for entry in p.column))
        names = {
            i: p.symbol
            for i, p in enumerate(machines.free_parameters(self.motion.machine.model))
            if self.motion.parameters[i] in read and not self.motion.machine.rows
        }
        return recognise.Trial(names, values, not unknown, self.relations)

    def error(self, parameters: Sequence[Any]) -> float:
        """The worst difference of Y theta + rest from M u' + h - Q, over the largest term."""
        given = dict(zip(self.motion.parameters, parameters, strict=True))
        inputs = dict.fromkeys(self.motion.inputs, PRECISE.number(1))
        terms = [_terms(self.motion, i) for i in range(self.motion.size)]
        worst = 0.0
        for state in self.states:
            for row in terms:
                values = evaluate(row, {**given, **inputs, **state}, PRECISE)
                size = max(map(abs, values))
                worst = max(worst, float(abs(sum(values)) / size) if size else 0.0)
        return worst

    def total(self, parameter: BaseParameter, parameters: Sequence[Any]) -> Any:
        """The value of a base parameter."""
        given = dict(zip(self.motion.parameters, parameters, strict=True))
        values = evaluate([p.value for p in self.motion.inertial], given, PRECISE)
        return values[parameter.kept] + sum(c.value * values[j] for j, c in parameter.terms)

    def relations(self, parameters: Sequence[Any]) -> recognise.Relations:
        """Each dependent column -> its multiples of those that stay."""
        given = dict(zip(self.motion.parameters, parameters, strict=True))
        nodes = [entry for p in self.motion.inertial for entry in p.column]
        rows: list[list[Any]] = [[] for _ in self.motion.inertial]
        for state in self.states:
            values = iter(evaluate(nodes, {**given, **state}, PRECISE))
            for row in rows:
                row += [next(values) for _ in range(self.motion.size)]
        return elimination.combinations(rows)


def _terms(motion: Motion, row: int) -> list[Node]:
    """Terms that add up to zero: Y theta + rest, less M u' + h - Q as the equations have it."""
    equations = motion.machine.equations
    pairs = zip(equations.mass_matrix[row], motion.accelerations, strict=True)
    return [
        *(p.column[row] * p.value for p in motion.inertial),
        motion.rest[row],
        *(-(entry * a) for entry, a in pairs),
        equations.generalized_forces[row] - equations.bias[row],
    ]


def _states(motion: Motion, count: int) -> Iterator[Values]:
    """Random states with random accelerations; on the constraints, where there are some."""
    chance = random.Random(f"base {motion.machine.model.name}")
    draw = _admissible if motion.machine.rows else _free
    for time, state in draw(motion, count):
        values = {
            motion.argument("time", 1)[0]: time,
            **dict(zip(motion.state, state, strict=True)),
        }
        values |= {a: PRECISE.number(chance.uniform(-2.0, 2.0)) for a in motion.accelerations}
        yield values


def _free(motion: Motion, count: int) -> Iterator[tuple[Any, list[Any]]]:
    drawn = samples.draw(motion.machine.model, count)
    kinematics = motion.machine.kinematics
    # quaternions are of length 1 in doubles only
    places = motions.normalised(kinematics.model, kinematics.algebra)
    for i in range(count):
        state = [PRECISE.number(column[i]) for column in drawn.state]
        normal = evaluate(places, dict(zip(motion.state, state, strict=True)), PRECISE)
        yield PRECISE.number(drawn.time[i]), [*normal, *state[len(normal) :]]


def _admissible(motion: Motion, count: int) -> Iterator[tuple[Any, list[Any]]]:
    model = motion.machine.model
    rates = [c.rate for c in model.coordinates]
    independent = [rates.index(s) for s in speeds.symbols(model)]
    for found in admissible.draw(motion.machine, count):
        state = found.state
        yield state.time, [*state.coordinates, *(state.rates[i] for i in independent)]
