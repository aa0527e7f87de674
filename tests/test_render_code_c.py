"""The gate of the generated C: warnings, both precisions, C++, sanitizers, static analysis."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from programs import PROGRAMS, arguments
from tools import tool

from eomgen.render.code_context import Style, coded
from eomgen.render.names import prefix
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment

WARNINGS = """
-std=c99 -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion
-Wfloat-conversion -Wfloat-equal -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wundef
-Wcast-qual -Wvla -Werror
""".split()  # noqa: SIM905
SANITIZERS = "-fsanitize=address,undefined,float-divide-by-zero -fno-sanitize-recover=all"


STYLES = {
    "plain": lambda program: program,
    "prepared": lambda program: coded(program, Style(fast_trig=True, batch=True)),
    "folded": lambda program: coded(program, Style(fold=True, batch=True)),
    "in parts": lambda program: coded(program, Style(fast_trig=True, batch=True, longest=3)),
    "in loops": lambda program: coded(program, Style(longest=3)),
}
SLOW = ("folded", "in parts", "in loops")
styled = pytest.mark.parametrize(
    "style", [pytest.param(s, marks=pytest.mark.slow if s in SLOW else ()) for s in STYLES]
)


def written(name, folder, style="plain"):
    """The C files of a fixture in a folder."""
    files = render(STYLES[style](PROGRAMS[name]), TARGETS["c"], environment())
    for file, text in files.items():
        (folder / file).write_text(text)
    return [folder / file for file in files if file.endswith(".c")]


def command(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@styled
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("name", PROGRAMS)
def test_no_compiler_has_a_word_to_say(name, compiler, style, tmp_path):
    path, (source,) = tool(compiler), written(name, tmp_path, style)
    for option in ((), (f"-D{prefix(name).upper()}_FLOAT",)):
        command(path, *WARNINGS, *option, "-O2", "-c", source, "-o", tmp_path / "a.o")


@pytest.mark.parametrize("compiler", ["g++", "clang++"])
@pytest.mark.parametrize("name", ["slider_pendulum", "int", "lambda", "chain"])
def test_the_header_is_also_c_plus_plus(name, compiler, tmp_path):
    path, (source,) = tool(compiler), written(name, tmp_path, "in parts")
    main = tmp_path / "main.cpp"
    include = f'#include "{name}.h"\n'
    main.write_text(include + include + f"int main() {{ return !{prefix(name)}_speed_names(); }}\n")
    words = ("-std=c++11", "-Wall", "-Wextra", "-Wpedantic", "-Werror")
    command(tool("gcc"), "-std=c99", "-c", source, "-o", tmp_path / "c.o")
    command(path, *words, main, tmp_path / "c.o", "-lm", "-o", tmp_path / "a")
    command(tmp_path / "a")


@styled
def test_static_analysis_finds_nothing(style, tmp_path):
    path = tool("cppcheck")
    sources = [source for name in PROGRAMS for source in written(name, tmp_path, style)]
    # one precision at a time: else the size of an array is taken from one, an index from the other
    floats = [f"{prefix(name).upper()}_FLOAT" for name in PROGRAMS]
    for option in ("-D", "-U"):
        command(path, "-q", "--std=c99", "--enable=all", "--error-exitcode=1",
                "--suppress=missingIncludeSystem", "--suppress=unusedFunction",
                *(option + name for name in floats), *sources)  # fmt: skip


MAIN = """
#include "{name}.h"
int main(void)
{{
    const {prefix}_real state[] = {{{state}}};
    const {prefix}_real inputs[] = {{{inputs}}};
    const {prefix}_params p = {prefix}_default_parameters({arguments});
    {prefix}_real result[200];
    {prefix}_model m;
    int status = 0;
    {prefix}_prepare(&p, &m);
{calls}
    return status;
}}
"""


def main_program(name):
    """A C program that calls every function of a fixture; its exit code adds up the statuses."""
    program, stem = PROGRAMS[name], prefix(name)
    _, state, inputs, _ = arguments(program, seed=0)
    passed = {"time": "0", "accelerations": "state"}
    calls = [
        f"    status += (int){stem}_{form}{f.name}("
        + count
        + ", ".join([*({**passed, "parameters": of}.get(a, a) for a in f.arguments), "result);"])
        for f in program.functions
        for form, count, of in (("", "", "&p"), ("prepared_", "", "&m"), ("batch_", "1, ", "&m"))
    ]
    return MAIN.format(
        name=name,
        prefix=stem,
        state=", ".join(map(repr, state)),
        inputs=", ".join(map(repr, inputs or [0])),
        arguments=", ".join("1" for p in program.parameters if p.value is None),
        calls="\n".join(calls),
    )


@pytest.mark.parametrize("style", ["prepared", "in parts"])
@pytest.mark.parametrize("name", PROGRAMS)
def test_sanitizers_find_nothing(name, style, tmp_path):
    path, (source,) = tool("gcc"), written(name, tmp_path, style)
    main = tmp_path / "main.c"
    main.write_text(main_program(name))
    command(path, "-std=c99", "-g", *SANITIZERS.split(), main, source, "-lm", "-o", tmp_path / "a")
    command(tmp_path / "a")


def test_nothing_is_kept_between_calls(tmp_path):
    """No heap, no globals: the object has no writable data and asks for no allocation."""
    names = ("slider_pendulum", "chain")
    sources = [written(name, tmp_path, style) for name in names for style in STYLES]
    for (each,) in sources:
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
from eomgen.render.code_context import Style, coded
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment
from eomgen.render.code_context import Style, coded
for program in PROGRAMS.values():
    everything = coded(program, Style(fold=True, fast_trig=True, batch=True, longest=3))
    for subject in (program, coded(program), everything):
        for name in ("c", "python"):
            for file, text in render(subject, TARGETS[name], environment()).items():
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
