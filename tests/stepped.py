"""Scenes with every step they can have, compiled once for all tests."""

from dataclasses import replace
from functools import cache

import numpy as np
from scenes import model_of, study_of
from tools import tool

from eomgen import compile_flow, compile_steps, stepping, study
from eomgen.integrators.methods import METHODS
from eomgen.numerics import integrate
from eomgen.numerics.engine_c import EngineC
from eomgen.numerics.engine_python import EnginePython
from eomgen.numerics.records import Arguments, Grid
from eomgen.wanted import Wanted

# skew axes and full inertia; M(q); linked; quasi-velocities; constant M; quaternions
SCENES = (
    "skew_arm", "double_pendulum", "four_bar", "satellite", "sprung_pair", "ball_joints",
)  # fmt: skip


@cache
def steps_of(name, formulation="auto", compensated=False):
    found = (
        study_of(name)
        if formulation == "auto"
        else study.of_model(model_of(name), Wanted(formulation))
    )
    steps = stepping.of(found, ("all",), compensated=compensated)
    machine = found.compiled
    more = (compile_steps.state_jacobian(machine), *compile_flow.functions(machine))
    return replace(steps, program=stepping.extended(steps.program, more))


def given(steps):
    """Inputs 0.1, 0.2, ... and the parameters of the spec."""
    inputs = tuple(0.1 * (i + 1) for i in range(len(steps.program.inputs)))
    return Arguments(inputs, tuple(float(p.value) for p in steps.program.parameters))


def start(steps):
    variables = (*steps.program.coordinates, *steps.program.speeds)
    return np.array([float(v.value) for v in variables])


@cache
def engine_c(name, formulation="auto", real="double", compensated=False):
    tool("cc")
    steps = steps_of(name, formulation, compensated)
    return EngineC(steps, given(steps), real)


@cache
def engine_python(name, formulation="auto"):
    steps = steps_of(name, formulation)
    return EnginePython(steps, given(steps))


def run(engine, method, span, count, flow=None, *, every=None):  # noqa: PLR0913
    grid = Grid(0.0, span / count, count, every or count)
    return integrate.run(engine, METHODS[method], start(engine.steps), grid, flow)


def methods_of(name, formulation="auto"):
    return [m.name for m in steps_of(name, formulation).methods]
