"""The generated Python module as its user meets it."""

import ast
import subprocess
import sys

import numpy as np
import pytest
from programs import PROGRAMS, arguments
from scipy.integrate import solve_ivp

from eomgen.numerics.compiled import load_python
from eomgen.render.names import module
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment


def text_of(name):
    return render(PROGRAMS[name], TARGETS["python"], environment())[f"{module(name)}.py"]


@pytest.fixture(scope="module")
def slider():
    return load_python(text_of("slider_pendulum"), "slider_pendulum")


STATE = [0.1, 0.7, -0.3, 0.5]


def test_the_interface_is_by_declaration(slider):
    assert slider.COORDINATES == ("s", "phi")
    assert slider.SPEEDS == ("s'", "phi'")
    assert slider.INPUTS == ("F",)
    assert slider.PARAMETERS == ("m_A", "m_B", "l", "k", "g")
    assert slider.DEFAULTS == {"m_A": 2.0, "m_B": 0.5, "l": 0.8, "k": 120.0, "g": 9.81}
    assert slider.UNITS["F"] == "kg m s^-2"
    assert slider.INITIAL_STATE.tolist() == [0.1, float(slider.INITIAL_STATE[1]), 0, 0]


def test_many_states_at_once_are_the_states_one_by_one(slider):
    states = np.random.default_rng(7).normal(size=(4, 5))
    for name, shape in [("mass_matrix", (2, 2)), ("state_derivative", (4,)), ("energy", (2,))]:
        function = getattr(slider, name)
        together = function(0.0, states, [2.0])
        assert together.shape == (*shape, 5)
        for i in range(5):
            alone = function(0, states[:, i], [2.0])
            np.testing.assert_allclose(together[..., i], alone, rtol=1e-15)


@pytest.mark.parametrize("vectorized", [False, True])
def test_solve_ivp_takes_it_as_it_is(slider, vectorized):
    found = solve_ivp(slider.state_derivative, (0, 1), STATE, args=([0.0],), method="Radau",
                      rtol=1e-8, atol=1e-10, vectorized=vectorized)  # fmt: skip
    energies = slider.energy(found.t, found.y, [0.0]).sum(axis=0)
    assert found.success
    assert np.ptp(energies) < 1e-5 * abs(energies[0])


def test_without_inputs_nothing_is_asked_for():
    chain = load_python(text_of("chain"), "chain")
    assert chain.accelerations(0.0, np.zeros(28)).shape == (13,)
    assert chain.nothing(0.0, np.zeros((28, 3))).shape == (0, 3)


def test_inputs_are_a_sequence_or_a_mapping(slider):
    given = slider.accelerations(0, STATE, [3.0])
    np.testing.assert_array_equal(slider.accelerations(0, STATE, {"F": 3.0}), given)
    assert not np.array_equal(slider.accelerations(0, STATE, {"F": 4.0}), given)
    states = np.array([STATE, STATE]).T
    each = slider.accelerations(0, states, [np.array([3.0, 4.0])])
    np.testing.assert_allclose(each[:, 0], given, rtol=1e-15)


@pytest.mark.parametrize("inputs", [None, (), [1.0, 2.0], 3.0, "F", {"G": 1.0}, {"F": 1, "G": 2}])
def test_wrong_inputs_are_a_type_error_that_names_them(slider, inputs):
    with pytest.raises(TypeError, match="F"):
        slider.accelerations(0, STATE, inputs)


def test_parameters_override_the_defaults(slider):
    heavier = slider.mass_matrix(0, STATE, [0], {"m_A": 5.0})
    assert heavier[0, 0] == 5.5
    assert slider.mass_matrix(0, STATE, [0])[0, 0] == 2.5
    with pytest.raises(ValueError, match=r"unknown parameters \['m_C'\]"):
        slider.mass_matrix(0, STATE, [0], {"m_C": 5.0})


def test_a_parameter_without_a_value_must_be_given():
    opened = load_python(text_of("open-parameters"), "open_parameters")
    assert not hasattr(opened, "INITIAL_STATE")
    with pytest.raises(ValueError, match=r"\['b', 'lambda'\]"):
        opened.bias(0, [0, 0])
    assert opened.bias(0, [0, 1], parameters={"b": 2, "lambda": 0}).tolist() == [-np.pi, 1]


def test_a_state_of_the_wrong_length_is_refused(slider):
    with pytest.raises(ValueError, match="it needs 4 rows: s, phi, s', phi'"):
        slider.energy(0, [1, 2, 3], [0])


def test_a_singular_mass_matrix_is_a_linear_algebra_error(slider):
    states = np.array([STATE, STATE]).T
    states[1] = 0  # where the bob's inertia adds nothing to the slider's
    for parameters in ({"m_B": 0.0}, {"m_B": -1.0}, {"m_A": 1e-15}, {"l": float("nan")}):
        with pytest.raises(np.linalg.LinAlgError, match="singular"):
            slider.accelerations(0, states, [0], parameters)


@pytest.mark.parametrize("name", PROGRAMS)
def test_linters_find_nothing(name, tmp_path):
    file = tmp_path / f"{module(name)}.py"
    file.write_text(text_of(name))
    for rules in ((), ("--select", "E4,E7,E9,F,B,RUF100")):
        done = subprocess.run(
            [sys.executable, "-m", "ruff", "check", "--isolated", *rules, str(file)],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("name", PROGRAMS)
def test_only_numpy_is_imported_and_lines_are_short(name):
    text = text_of(name)
    imports = [i for i in ast.walk(ast.parse(text)) if isinstance(i, ast.Import | ast.ImportFrom)]
    assert [a.name for i in imports for a in i.names] == ["numpy"]
    assert max(map(len, text.splitlines())) <= 100


def test_random_arguments_are_defined_for_every_fixture():
    for name, program in PROGRAMS.items():
        loaded = load_python(text_of(name), module(name))
        for function in program.functions:
            _, *positional, parameters = arguments(program, 3, function)
            given = dict(zip(loaded.PARAMETERS, parameters, strict=True))
            result = getattr(loaded, function.name)(0.1, *positional, given)
            assert np.isfinite(result).all()
