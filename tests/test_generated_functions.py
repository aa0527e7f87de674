"""Functions that are asked for, in C and Python: both are the interpreter's, and true."""

import numpy as np
import pytest
from commandline import eomgen, finish, start, together
from functions_of import compiled, difference, states, value
from reference import CASES, stem, wanted, written
from scenes import SHIPPED, SLOW
from test_generated_c import WARNINGS
from tools import tool

from eomgen.functions import places, table
from eomgen.interpreter import FLOAT, run
from eomgen.numerics.compiled import build, load_python
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment

QUICK = (
    "skew_arm",  # spatial, skew axes, full inertia
    "four_bar",  # multipliers
    "slider_crank-minimal",
)
LONG = {"andrews_squeezer", "andrews_squeezer-minimal", *(c for c in CASES if stem(c) in SLOW)}
TRUE = 1e-11  # of the largest result


OF_A_MODE = {"state_jacobian", "input_jacobian", "parameter_jacobian", "time_jacobian"}


def names(case):
    """Every function that a case has."""
    model = compiled(case).model
    missing = set() if model.inputs else {"input_jacobian"}
    missing |= set() if model.parameters else {"parameter_jacobian"}
    missing |= {"base_regressor"} if compiled(case).kept else set()
    missing |= OF_A_MODE if model.guides else set()
    if case in LONG:
        return ["inverse_dynamics", "state_jacobian"]
    everywhere = [f"{kind}:{name}" for kind in table.ROWS_AT for name in places.names(model)]
    return [*(n for n in table.ROWS if n not in missing), *everywhere]


def as_floats(given):
    return {name: [float(v) for v in values] for name, values in given.items()}


@pytest.mark.parametrize(
    "case", [c if c in QUICK else pytest.param(c, marks=pytest.mark.slow) for c in CASES]
)
def test_c_and_python_are_the_interpreter_and_true(case):
    tool("cc")
    program = table.select(written(case), compiled(case), names(case))
    library = build(render(program, TARGETS["c"], environment()), program)
    (text,) = render(program, TARGETS["python"], environment()).values()
    module = load_python(text, stem(case))
    for exact in states(case)[:2]:
        given = as_floats(exact)
        for asked, function in zip(names(case), program.functions, strict=True):
            passed = [given[a] for a in function.arguments[1:]]
            parameters = dict(zip(module.PARAMETERS, given["parameters"], strict=True))
            from_c = library.call(function.name, given["time"][0], *passed)
            from_python = getattr(module, function.name)(given["time"][0], *passed[:-1], parameters)
            here = np.reshape(run(function, given, FLOAT), function.shape)
            assert from_c.shape == from_python.shape == function.shape
            assert difference(from_c, here) < 1e-12
            assert difference(from_python, here) < 1e-12
            assert difference(here, value(case, asked, exact)) < TRUE


@pytest.mark.parametrize(
    "case", [pytest.param(c, marks=pytest.mark.slow) for c in ("skew_arm", "four_bar-nullspace")]
)
def test_the_c_of_the_command_line_compiles_without_a_warning(case, tmp_path):
    words = ("--formulation", wanted(case)) if "-" in case else ()
    asked = ("--functions", ",".join(names(case)), *words, "-t", "c", "-o", tmp_path)
    finish(start(*eomgen("generate", SHIPPED[stem(case)], *asked)))
    source = tmp_path / f"{stem(case)}.c"
    define = f"-D{stem(case).upper()}_FLOAT"
    together(
        (tool(compiler), *WARNINGS, *options, "-c", source, "-o", tmp_path / f"{compiler}.o")
        for compiler in ("gcc", "clang")
        for options in ((), (define,))
    )


@pytest.mark.slow
def test_the_same_bytes_under_any_hash_seed(tmp_path):
    asked = ("--functions", ",".join(names("skew_arm")), "-t", "c", "-t", "python")
    for seed in ("0", "1"):
        words = eomgen("generate", SHIPPED["skew_arm"], *asked, "-o", tmp_path / seed)
        finish(start(*words, PYTHONHASHSEED=seed))
    for path in (tmp_path / "0").iterdir():
        assert path.read_bytes() == (tmp_path / "1" / path.name).read_bytes()


def test_python_takes_many_states_at_once():
    case = "skew_arm"
    program = table.select(written(case), compiled(case), ["inverse_dynamics", "state_jacobian"])
    (text,) = render(program, TARGETS["python"], environment()).values()
    module, given = load_python(text, case), as_floats(states(case)[0])
    state = np.outer(given["state"], [1.0, 0.5, -2.0])
    moving = np.outer(given["accelerations"], [1.0, 0.0, 1.0])
    parameters = dict(zip(module.PARAMETERS, given["parameters"], strict=True))
    many = module.state_jacobian(0.0, state, given["inputs"], parameters)
    forces = module.inverse_dynamics(0.0, state, moving, given["inputs"], parameters)
    assert many.shape == (4, 4, 3)
    assert forces.shape == (2, 3)
    for i in range(3):
        one = module.state_jacobian(0.0, state[:, i], given["inputs"], parameters)
        np.testing.assert_allclose(many[..., i], one, rtol=1e-13, atol=1e-13)
