"""Names that C, Python or our own templates have for something else: renaming changes no number."""

import sys
from pathlib import Path

import numpy as np
import pytest
from commandline import run
from tools import tool

from eomgen.numerics.compiled import load_python

SPEC = """
eom: 1
system: Slider with pendulum
space: plane
gravity: [0, -{g}]
parameters:
  {{ {m_A}: 2 kg, {m_B}: 0.5 kg, {g}: 9.81 m/s^2, {l}: 0.8 m, {k}: 120 N/m, {d}: 3 N*s/m }}
coordinates: {{ {s}: m, {phi}: rad }}
inputs: {{ {F}: N }}
points:
  A: [{s}, 0]
bodies:
  slider: {{mass: {m_A}, at: A}}
  bob: {{mass: {m_B}, at: "A + {l}*[sin({phi}), -cos({phi})]"}}
springs: [{{along: {s}, stiffness: {k}}}]
dampers: [{{along: {s}, damping: {d}}}]
forces: [{{along: {s}, force: {F}}}]
"""
PLAIN = ("m_A", "m_B", "g", "l", "k", "d", "s", "phi", "F")
NAMES = {
    "our macros": "EPSILON LANES PIECE WAVE_RANGE SIGN_BIT ALIGNED APART INLINED SIDE_BY_SIDE",
    "our variables": "work waves bad lane m p state inputs accelerations",
    "macros of headers": "M_PI M_E M_LN2 FLT_MAX DBL_EPSILON INT32_MAX FP_NAN HUGE_VALF SIZE_MAX",
    "functions of headers": "y0 j1 gamma signgam index REAL SIN isnan div",
    "our Python": "Model float prepare constants model np parameters DEFAULTS accelerations",
}
FUNCTIONS = "standard,inverse_dynamics,parameter_jacobian"


def renamed(names):
    return SPEC.format(**dict(zip(PLAIN, names, strict=True)))


@pytest.fixture
def generate(call):
    """The C and the Python of the scene over some names, in the folder out."""

    def written(names, *words):
        Path("scene.yaml").write_text(renamed(names))
        said = call("generate", "scene.yaml", "-o", "out", *words, "--functions", FUNCTIONS)
        assert said.code == 0, said.errors

    return written


@pytest.mark.parametrize("kind", NAMES)
@pytest.mark.parametrize("standard", ["c99", "gnu17"])
def test_c_compiles(kind, standard, generate):
    generate(NAMES[kind].split(), "-t", "c", "--batch", "--fast-trig")
    strict = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror")
    run(tool("gcc"), f"-std={standard}", *strict, "-c", "out/scene.c", "-o", "a.o")


@pytest.mark.parametrize("kind", NAMES)
def test_python_computes_the_same(kind, generate):
    results = []
    for names in (PLAIN, NAMES[kind].split()):
        generate(names, "-t", "python")
        module = load_python(Path("out/scene.py").read_text(), "scene")
        state = (0.1, 0.2, 0.3, 0.4)
        results.append([
            module.inverse_dynamics(0.0, state, (5.0, 6.0), (7.0,)),
            module.parameter_jacobian(0.0, state, (7.0,)).ravel(),
        ])  # fmt: skip
    for plain, awkward in zip(*results, strict=True):
        np.testing.assert_array_equal(plain, awkward)


@pytest.mark.parametrize("name", ["math", "struct", "numbers", "time", "numpy"])
def test_a_module_is_not_mistaken_for_a_library(name, call):
    Path(f"{name}.yaml").write_text(renamed(PLAIN))
    assert call("generate", f"{name}.yaml", "-t", "python").output == f"{name}_.py\n"
    run(sys.executable, "-c", f"import {name}_; {name}_.energy(0, [0, 0, 0, 0], [0])")
