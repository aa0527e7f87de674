"""The options of generated code, through the command line and through a compiler."""

import re
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy as sp
from commandline import run
from scenes import SHIPPED, program_of
from test_parts import drawn, rows
from tools import tool

from eomgen import interpreter
from eomgen.numerics.compiled import build, load_python
from eomgen.render.code_context import Style, coded
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment

STRICT = """
-std=c99 -O2 -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion
-Wfloat-conversion -Wfloat-equal -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wundef
-Wcast-qual -Wvla -Werror -c
""".split()  # noqa: SIM905
STYLES = {
    "prepared": Style(),
    "folded": Style(fold=True),
    "fast": Style(fast_trig=True),
    "everything": Style(fold=True, fast_trig=True, batch=True, longest=30),
}
SCENES = (
    "skew_arm",
    "cart_three_pendulums",
    "satellite",
    "four_bar",
    "two_link_arm",
    "watt_governor",
)
DIGITS = 50


@pytest.fixture
def generate(call):
    """`eomgen generate` of a shipped spec into the folder out."""
    return lambda name, *words: call("generate", SHIPPED[name], "-o", "out", *words)


def test_folded_parameters_are_named_and_gone(generate):
    assert generate("double_pendulum", "-t", "c", "-t", "python", "--fold").code == 0
    header = Path("out/double_pendulum.h").read_text()
    assert re.search(r"folded into the code as numbers:\n \*   m_1 = [\d.]+ \[kg\]\n", header)
    assert "int none;" in header
    assert "DOUBLE_PENDULUM_NPARAMETERS = 0," in header
    assert "m->p." not in Path("out/double_pendulum.c").read_text()
    module = load_python(Path("out/double_pendulum.py").read_text(), "double_pendulum")
    assert module.PARAMETERS == ()
    plain = program_of("double_pendulum").function("accelerations")
    given = {"state": [0.3, -0.2, 1.0, 2.0], "parameters": values_of("double_pendulum")}
    expected = interpreter.run(plain, given, interpreter.FLOAT)
    np.testing.assert_allclose(module.accelerations(0, given["state"]), expected, rtol=1e-12)


def test_without_folding_the_model_is_prepared(generate):
    generate("double_pendulum", "-t", "c")
    header = Path("out/double_pendulum.h").read_text()
    members = re.search(r"typedef struct \{\n(.*?)\} double_pendulum_model;", header, re.DOTALL)
    assert "double_pendulum_params p;" in members[1]
    assert "/**< 0.5 * m_2 */" in members[1]
    assert "folded" not in header


def test_each_option_adds_what_it_says(generate):
    generate("double_pendulum", "-t", "c")
    plain = Path("out/double_pendulum.c").read_text()
    generate("double_pendulum", "-t", "c", "--fast-trig")
    fast = Path("out/double_pendulum.c").read_text()
    generate("double_pendulum", "-t", "c", "--batch")
    batch = Path("out/double_pendulum.c").read_text()
    assert [("sine_and_cosine(" in t, "_batch_" in t) for t in (plain, fast, batch)] == [
        (False, False), (True, False), (False, True)
    ]  # fmt: skip
    assert "1e5 rad" not in Path("out/double_pendulum.h").read_text()


@pytest.mark.parametrize("option", ["--fast-trig", "--batch"])
def test_an_option_of_c_needs_c(generate, option):
    said = generate("double_pendulum", "-t", "python", option)
    assert (said.code, said.output) == (2, "")
    assert said.errors.endswith(f"error: {option} is about C, which is not written; add -t c\n")


def test_stability_names_what_a_start_lacks_and_where_it_can_stand(call):
    spec = SHIPPED["simple_pendulum"].read_text()
    Path("open.yaml").write_text(re.sub(r"^initial:.*\n", "", spec, flags=re.M))
    said = call("generate", "open.yaml", "-t", "c", "--with-stability")
    assert (said.code, said.output) == (2, "")
    assert "--state FILE (of `simulate`, `stability` and `chart`) or `initial`" in said.errors


def values_of(name):
    return [float(p.value) for p in program_of(name).parameters]


def test_python_prepares_once(generate):
    generate("skew_arm", "-t", "python")
    module = load_python(Path("out/skew_arm.py").read_text(), "skew_arm")
    state, inputs = [0.1, 0.2, 0.3, 0.4], [1.0, 2.0]
    for given in (None, {"m_1": 2.5}):
        model = module.prepare(given)
        for name in ("state_derivative", "mass_matrix", "energy"):
            call = getattr(module, name)
            expected = call(0.0, state, inputs, given)
            np.testing.assert_array_equal(call(0.0, state, inputs, model), expected)
    assert model.parameters["m_1"] == 2.5
    many = np.random.default_rng(1).normal(size=(4, 9))
    together = module.state_derivative(0.0, many, inputs, model)
    alone = [module.state_derivative(0.0, column, inputs, model) for column in many.T]
    np.testing.assert_allclose(together.T, alone, rtol=1e-12)
    with pytest.raises(ValueError, match="unknown parameters"):
        module.prepare({"m_9": 1.0})


@pytest.mark.slow
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("name", SHIPPED)
def test_no_compiler_has_a_word_to_say(name, compiler, generate):
    generate(name, "-t", "c", "--fast-trig", "--batch")
    for option in ((), (f"-D{name.upper()}_FLOAT",)):
        run(tool(compiler), *STRICT, *option, f"out/{name}.c", "-o", "a.o")


@pytest.mark.slow
@pytest.mark.parametrize("real", ["double", "float"])
@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("name", SCENES)
def test_every_style_is_true_to_50_digits(name, style, real):
    tool("cc")
    plain = program_of(name)
    code = coded(plain, STYLES[style])
    library = build(render(code, TARGETS["c"], environment()), code.program, real)
    t, states, inputs, _ = drawn(plain)
    kind = np.float32 if real == "float" else np.float64
    states, inputs, t = states.astype(kind), inputs.astype(kind), float(kind(t))
    chosen = [] if code.program.folded else values_of(name)
    with mpmath.workdps(DIGITS):
        numbers = [mpmath.mpmathify(str(sp.N(p.value, DIGITS))) for p in plain.parameters]
    for function in plain.functions:
        columns = [row[:, 0] for row in rows(function, states, inputs)]
        named = dict(
            zip(function.arguments[1:-1], [list(map(float, c)) for c in columns], strict=True)
        )
        given = named | {"time": [t], "parameters": numbers}
        exact = interpreter.run(function, given, interpreter.mpmath_arithmetic(DIGITS))
        found = library.call(function.name, t, *columns, chosen).ravel()
        size = max(map(abs, exact), default=0) or 1
        errors = [abs(a - float(b)) / size for a, b in zip(exact, found, strict=True)]
        assert max(errors, default=0) < (1e-11 if real == "double" else 3e-3)
