"""What we ship, run: C in both precisions and Python mean what the interpreter means."""

import ctypes

import numpy as np
import pytest
from programs import PROGRAMS, add, arguments, mul, n, op, program
from tools import tool

from eomgen.errors import CheckError, UsageError
from eomgen.interpreter import FLOAT, run
from eomgen.numerics.compiled import build, load_python
from eomgen.program import Function, Read, Solve, Value, Variable
from eomgen.render.names import module
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment

SEEDS = range(5)


def c_of(name, real="double", folder=None):
    tool("cc")
    program = PROGRAMS[name]
    return build(render(program, TARGETS["c"], environment()), program, real, folder)


def python_of(name):
    files = render(PROGRAMS[name], TARGETS["python"], environment())
    return load_python(files[f"{module(name)}.py"], module(name))


def reference(program, function, given):
    t, *rest = given
    named = dict(zip(function.arguments[1:], rest, strict=True))
    return np.reshape(run(function, {"time": [t], **named}, FLOAT), function.shape)


def states(name):
    program = PROGRAMS[name]
    for seed in SEEDS:
        for function in program.functions:
            given = arguments(program, seed, function)
            yield function, given, reference(program, function, given)


@pytest.mark.parametrize("name", PROGRAMS)
def test_c_in_double_is_the_interpreter(name):
    compiled = c_of(name)
    for function, given, expected in states(name):
        found = compiled.call(function.name, *given)
        assert found.shape == function.shape
        np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-14)


@pytest.mark.parametrize("name", PROGRAMS)
def test_c_in_float_is_close(name):
    compiled = c_of(name, "float")
    for function, given, expected in states(name):
        found = compiled.call(function.name, *given)
        assert found.dtype == np.float32
        with np.errstate(over="ignore"):  # 3.x^200 is infinite in single precision
            expected = expected.astype(np.float32)
        np.testing.assert_allclose(found, expected, rtol=2e-4, atol=1e-5)


@pytest.mark.parametrize("name", PROGRAMS)
def test_python_is_the_interpreter(name):
    loaded = python_of(name)
    for function, (*positional, parameters), expected in states(name):
        given = dict(zip(loaded.PARAMETERS, parameters, strict=True))
        found = getattr(loaded, function.name)(*positional, given)
        np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-14)


def test_operators_agree_at_negative_arguments():
    compiled, loaded = c_of("operators"), python_of("operators")
    for state in ([-0.3, 0.4], [0.0, -0.5], [-0.7, -0.2]):
        with np.errstate(invalid="ignore", divide="ignore"):  # sqrt and log out of range
            expected = loaded.outputs(0.5, state)
        found = compiled.call("outputs", 0.5, state, [], [])
        np.testing.assert_allclose(found, expected, rtol=1e-14, atol=1e-15)


def test_the_default_values_are_those_of_the_spec():
    compiled, program = c_of("slider_pendulum"), PROGRAMS["slider_pendulum"]

    class Parameters(ctypes.Structure):
        _fields_ = [(p.name, ctypes.c_double) for p in program.parameters]

    defaults = compiled.library.slider_pendulum_default_parameters
    defaults.restype = Parameters
    assert [getattr(defaults(), p.name) for p in program.parameters] == [2, 0.5, 0.8, 120, 9.81]
    state = (ctypes.c_double * 4)()
    compiled.library.slider_pendulum_initial_state(state)
    assert list(state) == [0.1, 1.0471975511965979, 0, 0]
    names = compiled.library.slider_pendulum_speed_names
    names.restype = ctypes.POINTER(ctypes.c_char_p)
    assert names()[:2] == [b"s'", b"phi'"]


SINGULAR = {
    "zero mass": [2.0, 0.0, 0.8, 120.0, 9.81],
    "negative mass": [2.0, -1.0, 0.8, 120.0, 9.81],
    "negative sum": [-2.0, 0.5, 0.8, 120.0, 9.81],
    "lost in rounding": [1e-15, 0.5, 0.8, 120.0, 9.81],
    "not a number": [2.0, 0.5, float("nan"), 120.0, 9.81],
}


@pytest.mark.parametrize("case", SINGULAR)
def test_a_singular_pivot_is_an_error_and_writes_nothing(case):
    compiled, state = c_of("slider_pendulum"), [0.0, 0.0, 0.0, 0.0]
    with pytest.raises(CheckError, match="singular"):
        compiled.call("accelerations", 0, state, [0], SINGULAR[case])
    doubles = [(ctypes.c_double * len(v))(*v) for v in (state, [0], SINGULAR[case], [7, 7])]
    call = compiled.library.slider_pendulum_accelerations
    call.argtypes = [ctypes.c_double, *[ctypes.c_void_p] * 4]
    assert call(0.0, *doubles) == 1
    assert list(doubles[-1]) == [7, 7]
    assert np.isfinite(compiled.call("mass_matrix", 0, state, [0], [2, 0, 0.8, 120, 9.81])).all()


def test_the_loop_finds_a_singular_pivot_too():
    compiled, loaded = c_of("chain"), python_of("chain")
    with pytest.raises(CheckError, match="singular"):
        compiled.call("accelerations", 0, [0.0] * 28, [], [-1.0])
    with pytest.raises(np.linalg.LinAlgError, match="singular"):
        loaded.accelerations(0, [0.0] * 28, parameters={"m": -1.0})


def test_results_may_overlap_the_state():
    compiled = c_of("slider_pendulum")
    state, parameters = [0.1, 0.7, -0.3, 0.5], SINGULAR["zero mass"][:1] + [0.5, 0.8, 120.0, 9.81]
    expected = compiled.call("state_derivative", 0, state, [1], parameters)
    shared, inputs, p = ((ctypes.c_double * len(v))(*v) for v in (state, [1], parameters))
    call = compiled.library.slider_pendulum_state_derivative
    call.argtypes = [ctypes.c_double, *[ctypes.c_void_p] * 4]
    assert call(0.0, shared, inputs, p, shared) == 0
    assert list(shared) == expected.tolist()


def test_python_takes_accelerations_for_many_states():
    loaded, (t, state, moving, inputs, _) = python_of("in_motion"), (0, [1, 2], [3], [4], [5])
    many = loaded.inverse_dynamics(t, np.ones((2, 7)) * [[1], [2]], np.full((1, 7), 3.0), inputs)
    assert many.shape == (1, 7)
    assert many[:, 3].tolist() == loaded.inverse_dynamics(t, state, moving, inputs).tolist()
    with pytest.raises(ValueError, match="they need 1 rows: q'"):
        loaded.inverse_dynamics(t, state, [1, 2], inputs)


def test_a_wrong_number_of_arguments_is_refused():
    compiled = c_of("slider_pendulum")
    with pytest.raises(ValueError, match="4 numbers are needed"):
        compiled.call("bias", 0, [1, 2], [0], [1] * 5)


def test_the_files_stay_in_a_folder_that_is_given(tmp_path):
    c_of("open-parameters", folder=tmp_path)
    assert (tmp_path / "open-parameters.c").is_file()


def test_without_a_compiler_the_error_says_what_to_do(monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)
    with pytest.raises(UsageError, match="environment variable CC"):
        build({"a.c": ""}, PROGRAMS["chain"])
    monkeypatch.setenv("CC", "no-such-compiler -m64")
    with pytest.raises(UsageError, match="'no-such-compiler' does not start"):
        build({"a.c": ""}, PROGRAMS["chain"])


def test_the_words_of_the_compiler_are_the_error():
    tool("cc")
    with pytest.raises(UsageError, match=r"a\.c:1"):
        build({"a.c": "not C\n"}, PROGRAMS["chain"])


def rational_system(size=13):
    """Two right sides over a matrix of quotients: every operation rounds alike everywhere."""
    q = [Read("state", i) for i in range(size)]
    entries = [
        add(n(j + 9), mul(q[i], q[i])) if i == j else op("divide", q[i], n(3 + i + 2 * j))
        for i in range(size)
        for j in range(i + 1)
    ]
    names = tuple(f"x{i}" for i in range(2 * size))
    solve = Solve(names, tuple(entries), (*q, *(mul(x, x) for x in q)))
    results = tuple(Value(name) for name in names)
    functions = (Function("columns", "two right sides", (2, size), (solve,), results),)
    coordinates = tuple(Variable(f"q{i}") for i in range(size))
    return program("rational", functions, coordinates=coordinates, speeds=())


def test_a_system_in_a_loop_has_the_same_bits_everywhere():
    """One order of operations, one reciprocal per pivot: in C, in Python, in the interpreter."""
    tool("cc")
    made, files = rational_system(), environment()
    compiled = build(render(made, TARGETS["c"], files), made, "double")
    python = load_python(render(made, TARGETS["python"], files)["rational.py"], "rational")
    state = list(np.random.default_rng(3).uniform(0.1, 0.9, 13))
    expected = reference(made, made.functions[0], (0.0, state, [], []))
    assert (compiled.call("columns", 0.0, state, [], []) == expected).all()
    assert (python.columns(0.0, state) == expected).all()
