"""The integrators that the command line writes: strictly compiled, and their header is true."""

import re
import subprocess

import pytest
from commandline import eomgen, run, together
from scenes import SHIPPED, model_of
from stepped import steps_of
from test_render_code_c import WARNINGS
from tools import tool

from eomgen.render.names import prefix

BUILDS = [(compiler, real) for compiler in ("gcc", "clang") for real in ("double", "float")]
FRAMES = 400  # bytes of saved registers, spilled values and return addresses, in three calls


def written(name, folder, *more):
    run(*eomgen("generate", SHIPPED[name], "-t", "c", "--integrator", "all", *more, "-o", folder))
    return folder / f"{name}_steps.c"


@pytest.mark.slow
@pytest.mark.parametrize("more", [(), ("--compensated",)], ids=["plain", "compensated"])
@pytest.mark.parametrize("name", [n for n in SHIPPED if not model_of(n).guides])
def test_no_warning_in_any_build(name, more, tmp_path):
    source = written(name, tmp_path, *more)
    define = {"double": (), "float": (f"-D{prefix(name).upper()}_FLOAT",)}
    together(
        (tool(compiler), *WARNINGS, "-O2", *define[real], "-c", source, "-o", tmp_path / f"{i}.o")
        for i, (compiler, real) in enumerate(BUILDS)
    )


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_compensated_steps_refuse_arithmetic_that_undoes_them(compiler, tmp_path):
    source = written("simple_pendulum", tmp_path, "--compensated")
    command = [tool(compiler), "-std=c99", "-O2", "-ffast-math", "-c", source]
    said = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert said.returncode != 0
    assert "compile without -ffast-math" in said.stderr


@pytest.mark.slow
@pytest.mark.parametrize("name", ["skew_arm", "four_bar"])
def test_the_stack_is_at_most_what_the_header_says(name, tmp_path):
    written(name, tmp_path)
    sources = [f"{name}.c", f"{name}_steps.c"]
    run(tool("gcc"), "-std=c99", "-O2", "-fstack-usage", "-c", *sources, folder=tmp_path)
    used = {}
    for line in "".join(f.read_text() for f in tmp_path.glob("*.su")).splitlines():
        place, size, _ = line.split("\t")
        used[place.rpartition(":")[2].removeprefix(f"{name}_").partition(".")[0]] = int(size)
    header = _joined((tmp_path / f"{name}_steps.h").read_text())
    said = dict(re.findall(r"^ \*   ([\w-]+): [^;]*?; stack (\d+) bytes$", header, re.M))
    steps = steps_of(name)
    assert said.keys() == {m.name for m in steps.methods}
    for method in steps.methods:
        below = max(used[f"prepared_{function}"] for function in steps.calls(method))
        found = used[f"prepared_step_{method.spelled}"] + used.get("finish", 0) + below
        assert found <= int(said[method.name]) + FRAMES


def _joined(text):
    """A header with its wrapped lines in one."""
    return re.sub(r"\n \*       (?=\S)", " ", text)


@pytest.mark.slow
def test_the_header_is_cpp_too_and_the_source_needs_no_library(tmp_path):
    written("four_bar", tmp_path)
    main = tmp_path / "main.cpp"
    main.write_text(
        '#include "four_bar_steps.h"\nint main() { return FOUR_BAR_STEP_NEWTON == 0; }\n'
    )
    run(tool("g++"), "-Wall", "-Wextra", "-Werror", "-c", main, "-o", tmp_path / "main.o")
    text = (tmp_path / "four_bar_steps.c").read_text()
    assert set(re.findall(r"#include (\S+)", text)) == {'"four_bar_steps.h"', "<float.h>"}
    assert not re.search(r"\b(malloc|calloc|while|goto|static \w+ \w+ =)", text)


@pytest.mark.slow
def test_every_loop_has_a_fixed_count(tmp_path):
    text = written("four_bar", tmp_path).read_text()
    loops = re.findall(r"for \(int \w+ = ([^;]+); \w+ (<|>=) ([^;]+); \w+(?:\+\+|--)\)", text)
    assert len(loops) == text.count("for (") > 20
    bound = re.compile(r"[k\d]+|\w+_N[QUX](?: (?:[-+*] )(?:1|\w+_NX))?|k \+ 1|FOUR_BAR_NX - 1")
    assert all(bound.fullmatch(first) and bound.fullmatch(last) for first, _, last in loops)


@pytest.mark.slow
def test_only_what_was_asked_for_is_written(tmp_path):
    words = ("generate", SHIPPED["skew_arm"], "-t", "c", "-o", tmp_path)
    run(*eomgen(*words, "--integrator", "rk4", "--integrator", "semi-euler"))
    text = (tmp_path / "skew_arm_steps.h").read_text()
    assert re.findall(r"unsigned skew_arm_step_(\w+)\(", text) == ["semi_euler", "rk4"]
    assert "state_jacobian" not in (tmp_path / "skew_arm.h").read_text()
    source = (tmp_path / "skew_arm_steps.c").read_text()
    assert "factor(" not in source


@pytest.mark.slow
def test_without_integrators_there_are_no_steps(tmp_path):
    run(*eomgen("generate", SHIPPED["four_bar"], "-t", "c", "-o", tmp_path))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["four_bar.c", "four_bar.h"]


@pytest.mark.parametrize(
    ("spec", "words", "reason"),
    [
        ("double_pendulum", ["--integrator", "verlet"],
         "E-SYM: verlet is not symplectic for this model (M depends on phi_1); expect energy drift "
         "of order h; use rk4"),
        ("duffing_oscillator", ["--integrator", "verlet"], "(the forces depend on x')"),
        ("four_bar", ["--integrator", "verlet"], "(the constraint forces depend on the rates)"),
        ("satellite", ["--integrator", "verlet"], "(the speeds are not the rates"),
        ("double_pendulum", ["--integrator", "semi-euler-damped"],
         "E-DAMP: semi-euler-damped needs applied forces that damp and are linear in the speeds "
         "(no force depends on the speeds); use semi-euler or rosenbrock2"),
        ("projectile_drag", ["--integrator", "semi-euler-damped"], "(the forces are not linear in"),
        ("simple_pendulum", ["--integrator", "euler"], "there is no integrator 'euler'; there are"),
        ("painleve_rod", ["--integrator", "all"], "rail has friction on both sides: the motion is"),
        ("simple_pendulum", ["--compensated"], "say --integrator too"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused(spec, words, reason, call, tmp_path):
    said = call("generate", SHIPPED[spec], "-t", "c", "-o", tmp_path / "out", *words)
    assert (said.code, said.output) == (2, "")
    assert reason in said.errors
    assert not (tmp_path / "out").exists()
