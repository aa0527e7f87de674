"""The C that the command line writes for every shipped spec: compiled strictly, run, true."""

from functools import cache

import numpy as np
import pytest
from commandline import run, together
from reference import ARGUMENTS, CASES, arguments, stem, worst_error, written
from tools import tool

from eomgen.render.names import prefix

pytestmark = pytest.mark.slow

WARNINGS = """
-std=c99 -O2 -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion
-Wfloat-conversion -Wfloat-equal -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wundef
-Wcast-qual -Wvla -Werror
""".split()  # noqa: SIM905

MAIN = r"""
#include <stdio.h>
#include <string.h>
#include "@name@.h"

typedef @prefix@_real real;

static int filled(real values[], int count)
{
    for (int i = 0; i < count; i++) {
        double value;
        if (scanf("%lf", &value) != 1) {
            return 0;
        }
        values[i] = (real)value;
    }
    return 1;
}

static void show(const char *name, const real values[], int count)
{
    printf("%s", name);
    for (int i = 0; i < count; i++) {
        printf(" %.17g", (double)values[i]);
    }
    printf("\n");
}

static void show_names(const char *kind, const char *const *names, int count)
{
    printf("%s", kind);
    for (int i = 0; i < count; i++) {
        printf(" %s", names[i]);
    }
    printf("\n");
}

int main(void)
{
    real t[1];
    real state[@PREFIX@_NX];
    real inputs[@PREFIX@_NINPUTS + 1];
    real numbers[@PREFIX@_NPARAMETERS + 1];
    real result[400];
    @prefix@_params p = @prefix@_default_parameters();
    memcpy(numbers, &p, (size_t)@PREFIX@_NPARAMETERS * sizeof(real));
    show("defaults", numbers, @PREFIX@_NPARAMETERS);
@once@
    while (filled(t, 1) && filled(state, @PREFIX@_NX) && filled(inputs, @PREFIX@_NINPUTS) &&
           filled(numbers, @PREFIX@_NPARAMETERS)) {
        memcpy(&p, numbers, (size_t)@PREFIX@_NPARAMETERS * sizeof(real));
@calls@
    }
    return 0;
}
"""
INITIAL = '@prefix@_initial_state(state);\n    show("initial_state", state, @PREFIX@_NX);'
NAMES_OF = 'show_names("@kind@", @prefix@_@kind@_names(), @PREFIX@_@size@);'
CALL = """if (@prefix@_@function@(t[0], state, inputs, &p, result) != @PREFIX@_OK) {
            return 1;
        }
        show("@function@", result, @count@);"""
KINDS = {
    "coordinate": ("coordinates", "NQ"),
    "speed": ("speeds", "NU"),
    "input": ("inputs", "NINPUTS"),
    "parameter": ("parameters", "NPARAMETERS"),
    "output": ("outputs", "NOUTPUTS"),
}
BUILDS = [(compiler, real) for compiler in ("gcc", "clang") for real in ("double", "float")]


def filled(template, **words):
    for word, text in words.items():
        template = template.replace(f"@{word}@", str(text))
    return template


def initial_state(program):
    """The numbers of the spec; empty where it leaves one open."""
    values = [v.value for v in program.coordinates + program.speeds]
    return [] if None in values else [float(v) for v in values]


def main_of(case):
    """A program that prints the tables and, for each state that it reads, all results."""
    program, name = written(case), stem(case)
    once = [INITIAL] if initial_state(program) else []
    once += [
        filled(NAMES_OF, kind=kind, size=size)
        for kind, (table, size) in KINDS.items()
        if getattr(program, table)
    ]
    calls = [filled(CALL, function=f.name, count=int(np.prod(f.shape))) for f in program.functions]
    return filled(
        MAIN,
        once="\n".join(f"    {line}" for line in once),
        calls="\n".join(f"        {line}" for line in calls),
        name=name,
        prefix=prefix(name),
        PREFIX=prefix(name).upper(),
    )


def built(case, folder):
    """Build -> executable: each compiler in both precisions, any warning is an error."""
    main, name = folder / "main.c", stem(case)
    main.write_text(main_of(case), encoding="utf-8")
    define = {"double": (), "float": (f"-D{prefix(name).upper()}_FLOAT",)}
    made = {build: folder / "_".join(build) for build in BUILDS}
    sources = (main, folder / f"{name}.c")
    together(
        (tool(compiler), *WARNINGS, *define[real], *sources, "-lm", "-o", made[compiler, real])
        for compiler, real in BUILDS
    )
    return made


@pytest.fixture(scope="session")
def printed(generated):
    """Case and build -> first word of a line -> the rest of these lines."""

    @cache
    def of_all_builds(case):
        given = arguments(case)
        rows = np.concatenate([given[a] for a in ARGUMENTS], axis=1)
        text = "\n".join(" ".join(map(repr, row.tolist())) for row in rows)
        made = built(case, generated(case) / "en")
        return {build: _lines(run(executable, text=text)) for build, executable in made.items()}

    return lambda case, build: of_all_builds(case)[build]


def numbers(rows):
    return [[float(word) for word in row] for row in rows]


def _lines(text):
    found = {}
    for line in text.splitlines():
        first, *rest = line.split()
        found.setdefault(first, []).append(rest)
    return found


@pytest.mark.parametrize("case", CASES)
def test_tables_are_those_of_the_spec(case, printed):
    program = written(case)
    defaults = [float(p.value) for p in program.parameters]
    for build in BUILDS:
        lines = printed(case, build)
        rounding = {"double": 1e-16, "float": 1e-7}[build[1]]
        for kind, (table, _) in KINDS.items():
            assert lines.get(kind, [[]]) == [[v.name for v in getattr(program, table)]]
        assert numbers(lines["defaults"]) == [pytest.approx(defaults, rel=rounding, abs=0)]
        started = numbers(lines.get("initial_state", [[]]))
        assert started == [pytest.approx(initial_state(program), rel=rounding, abs=0)]


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("case", CASES)
def test_double_is_true_to_50_digits(case, compiler, printed):
    lines = printed(case, (compiler, "double"))
    for function in written(case).functions:
        assert worst_error(case, function.name, numbers(lines[function.name])) < 1e-12


@pytest.mark.parametrize("compiler", ["gcc", "clang"])
@pytest.mark.parametrize("case", CASES)
def test_float_is_true_as_far_as_it_goes(case, compiler, printed):
    lines = printed(case, (compiler, "float"))
    for function in written(case).functions:
        assert worst_error(case, function.name, numbers(lines[function.name])) < 3e-4
