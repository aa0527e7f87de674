"""The gate of the generated C: warnings, both precisions, C++, sanitizers, static analysis."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from programs import PROGRAMS, arguments
from tools import tool

from eomgen.render.names import prefix
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment

WARNINGS = """
-std=c99 -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion
-Wfloat-conversion -Wfloat-equal -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wundef
-Wcast-qual -Wvla -Werror
""".split()  # noqa: SIM905
SANITIZERS = "-fsanitize=address,undefined,float-divide-by-zero -fno-sanitize-recover=all"


def written(name, folder):
    """The C files of a fixture in a folder."""
    files = render(PROGRAMS[name], TARGETS["c"], environment())
    for file, text in files.items():
        (folder / file).write_text(text)
    return [folder / file for file in files if file.endswith(".c")]


def command(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("name", PROGRAMS)
def test_no_compiler_has_a_word_to_say(name, compiler, tmp_path):
    path, (source,) = tool(compiler), written(name, tmp_path)
    for option in ((), (f"-D{prefix(name).upper()}_FLOAT",)):
        command(path, *WARNINGS, *option, "-O2", "-c", source, "-o", tmp_path / "a.o")


@pytest.mark.parametrize("compiler", ["g++", "clang++"])
@pytest.mark.parametrize("name", ["slider_pendulum", "int", "lambda", "chain"])
def test_the_header_is_also_c_plus_plus(name, compiler, tmp_path):
    path, (source,) = tool(compiler), written(name, tmp_path)
    main = tmp_path / "main.cpp"
    include = f'#include "{name}.h"\n'
    main.write_text(include + include + f"int main() {{ return !{prefix(name)}_speed_names(); }}\n")
    words = ("-std=c++11", "-Wall", "-Wextra", "-Wpedantic", "-Werror")
    command(tool("gcc"), "-std=c99", "-c", source, "-o", tmp_path / "c.o")
    command(path, *words, main, tmp_path / "c.o", "-lm", "-o", tmp_path / "a")
    command(tmp_path / "a")


def test_static_analysis_finds_nothing(tmp_path):
    path = tool("cppcheck")
    sources = [source for name in PROGRAMS for source in written(name, tmp_path)]
    command(path, "-q", "--std=c99", "--enable=all", "--error-exitcode=1",
            "--suppress=missingIncludeSystem", "--suppress=unusedFunction", *sources)  # fmt: skip


MAIN = """
#include "{name}.h"
int main(void)
{{
    const {prefix}_real state[] = {{{state}}};
    const {prefix}_real inputs[] = {{{inputs}}};
    const {prefix}_params p = {prefix}_default_parameters({arguments});
    {prefix}_real result[200];
    int status = 0;
{calls}
    return status;
}}
"""


def main_program(name):
    """A C program that calls every function of a fixture; its exit code adds up the statuses."""
    program, stem = PROGRAMS[name], prefix(name)
    _, state, inputs, _ = arguments(program, seed=0)
    passed = {"time": "0", "accelerations": "state", "parameters": "&p"}
    calls = [
        f"    status += (int){stem}_{f.name}("
        + ", ".join([*(passed.get(a, a) for a in f.arguments), "result);"])
        for f in program.functions
    ]
    return MAIN.format(
        name=name,
        prefix=stem,
        state=", ".join(map(repr, state)),
        inputs=", ".join(map(repr, inputs or [0])),
        arguments=", ".join("1" for p in program.parameters if p.value is None),
        calls="\n".join(calls),
    )


@pytest.mark.parametrize("name", PROGRAMS)
def test_sanitizers_find_nothing(name, tmp_path):
    path, (source,) = tool("gcc"), written(name, tmp_path)
    main = tmp_path / "main.c"
    main.write_text(main_program(name))
    command(path, "-std=c99", "-g", *SANITIZERS.split(), main, source, "-lm", "-o", tmp_path / "a")
    command(tmp_path / "a")


def test_nothing_is_kept_between_calls(tmp_path):
    """No heap, no globals: the object has no writable data and asks for no allocation."""
    source = written("slider_pendulum", tmp_path) + written("chain", tmp_path)
    for each in source:
        command(tool("gcc"), "-std=c99", "-fno-pie", "-c", each, "-o", tmp_path / "a.o")
        symbols = command(tool("nm"), tmp_path / "a.o").splitlines()
        kinds = {line.split()[-2] for line in symbols}
        assert not kinds & set("bBCdDgGsS")
        assert not {line.split()[-1] for line in symbols} & {"malloc", "calloc", "free"}


def test_parameters_without_a_value_are_arguments(tmp_path):
    header = render(PROGRAMS["open-parameters"], TARGETS["c"], environment())["open-parameters.h"]
    flat = " ".join(header.split())
    expected = "default_parameters(open_parameters_real b, open_parameters_real lambda);"
    assert expected in flat
    assert "void open_parameters_initial_state(" not in flat


GENERATE = """
import sys
sys.path.insert(0, sys.argv[1])
from programs import PROGRAMS
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment
for program in PROGRAMS.values():
    for name in ("c", "python"):
        for file, text in render(program, TARGETS[name], environment()).items():
            print(file, text)
"""


def test_the_same_bytes_under_any_hash_seed():
    def generated(seed):
        return subprocess.run(
            [sys.executable, "-c", GENERATE, str(Path(__file__).parent)],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            check=True,
        ).stdout

    first = generated("0")
    assert len(first) > 10_000
    assert first == generated("1")
