"""The Python that the command line writes for every shipped spec: imported, run, true."""

import sys

import numpy as np
import pytest
from commandline import run
from reference import CASES, STATES, arguments, stem, worst_error, written
from scenes import FREE, model_of
from scipy.integrate import solve_ivp

from eomgen import interpreter
from eomgen.evaluate import depends_on_time

pytestmark = pytest.mark.slow

SHORT = 0.5  # seconds of motion
FAST = {"andrews_squeezer": 0.002}  # seconds, of a mechanism that turns in milliseconds
CONSERVATIVE = """
atwood_machine ball_joints central_force double_pendulum elastic_pendulum heavy_top rigid_body
rolling_cylinder simple_pendulum slider_pendulum_free slider_spring_pendulum sliding_ladder
spherical_pendulum sprung_pair
""".split()  # noqa: SIM905


def called(module, case, function, number):
    """The results of a function at one of the random states, row by row."""
    given = {argument: rows[number] for argument, rows in arguments(case).items()}
    parameters = dict(zip(module.PARAMETERS, given["parameters"], strict=True))
    of = getattr(module, function)
    return np.ravel(of(given["time"][0], given["state"], given["inputs"], parameters))


@pytest.mark.parametrize("case", CASES)
def test_results_are_true_to_50_digits(case, module):
    for function in written(case).functions:
        rows = [called(module(case), case, function.name, n) for n in range(STATES)]
        assert worst_error(case, function.name, rows) < 1e-12


@pytest.mark.parametrize("case", CASES)
def test_tables_are_those_of_the_spec(case, module):
    program, found = written(case), module(case)
    for table in ("coordinates", "speeds", "inputs", "parameters", "outputs"):
        variables = getattr(program, table)
        assert getattr(found, table.upper()) == tuple(v.name for v in variables)
        assert {v.name: found.UNITS[v.name] for v in variables} == {
            v.name: v.unit for v in variables
        }
    assert {p.name: float(p.value) for p in program.parameters} == found.DEFAULTS


@pytest.mark.parametrize("case", CASES)
def test_many_states_at_once_are_the_states_one_by_one(case, module):
    found, states = module(case), arguments(case)["state"].T
    for function in written(case).functions:
        call, inputs = getattr(found, function.name), np.ones(len(found.INPUTS))
        together = call(0.3, states, inputs)
        assert together.shape == (*function.shape, STATES)
        alone = np.stack([call(0.3, state, inputs) for state in states.T], axis=-1)
        size = np.abs(alone).max(initial=0.0)
        np.testing.assert_allclose(together, alone, rtol=1e-12, atol=1e-12 * size)


def moved(module, case):
    """A short motion from the initial state of the spec, or from a random one."""
    start = getattr(module, "INITIAL_STATE", arguments(case)["state"][0])
    inputs = np.zeros(len(module.INPUTS))
    found = solve_ivp(
        module.state_derivative,
        (0.0, FAST.get(stem(case), SHORT)),
        start,
        args=(inputs,),
        rtol=1e-10,
        atol=1e-12,
    )
    assert found.success
    return found, module.energy(found.t, found.y, inputs)


MOVING = [c for c in CASES if not model_of(stem(c)).guides]  # a rough guide moves in a mode


@pytest.mark.parametrize("case", MOVING)
def test_solve_ivp_takes_it_as_it_is(case, module):
    found, _ = moved(module(case), case)
    assert np.isfinite(found.y).all()
    assert np.ptp(found.y, axis=1).max() > 0  # something moves


def is_conservative(name):
    """Whether energy cannot come or go: nothing is applied, damped or driven."""
    model = model_of(name)
    applied = (*model.inputs, *model.forces, *model.moments, *model.dampers, *model.prescribed)
    driven = depends_on_time(written(name)) or not is_quadratic(name)
    return not applied and not model.energy.dissipation and not driven


def is_quadratic(name):
    """Whether T(q, 2 u) = 4 T(q, u): no frame or point moves by itself."""
    given = {argument: rows[0].tolist() for argument, rows in arguments(name).items()}
    count = len(model_of(name).coordinates)
    faster = [*given["state"][:count], *(2 * u for u in given["state"][count:])]
    energy = written(name).function("energy")
    slow, fast = (
        interpreter.run(energy, given | {"state": state}, interpreter.FLOAT)[0]
        for state in (given["state"], faster)
    )
    return fast == pytest.approx(4 * slow, rel=1e-12)


def test_the_list_of_conservative_scenes_is_complete():
    assert [name for name in FREE if is_conservative(name)] == CONSERVATIVE


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_energy_is_kept_where_nothing_gives_or_takes_it(name, module):
    found, energies = moved(module(name), name)
    total = energies.sum(axis=0)
    assert np.ptp(total) < 1e-6 * np.abs(energies).max()


@pytest.mark.parametrize("case", CASES)
def test_linters_find_nothing(case, generated):
    words = (sys.executable, "-m", "ruff", "check", "--isolated", "--no-cache")
    folder = generated(case) / "en"
    run(*words, folder)
    run(*words, "--select", "E4,E7,E9,F,B,RUF100", folder)
