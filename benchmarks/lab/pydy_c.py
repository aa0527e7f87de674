"""PyDy's generated C for M and f, with a Cholesky solution behind it."""

from __future__ import annotations

import sys

from lab.build import Source
from lab.contestants import Contestant
from lab.limits import output_within
from lab.trees import COLUMNS, Tree

SECONDS = 120

ADAPTER = """\
#include "equations.c"

enum {{ N = {n}, INPUTS = {inputs} }};
static double constants[] = {{{values}}};

void run(const double *state, const double *inputs, double *result)
{{
    double q[N], u[N], given[INPUTS], mass[N * N];
    for (int i = 0; i < N; i++) {{
        q[i] = state[i] + (i ? {offset} : 0);
        u[i] = state[N + i];
    }}
    for (int i = 0; i < INPUTS; i++) {{
        given[i] = inputs[i];
    }}
    evaluate(q, u, given, constants, mass, result);
    for (int j = 0; j < N; j++) {{
        for (int k = 0; k < j; k++) {{
            mass[j * N + j] -= mass[j * N + k] * mass[j * N + k];
        }}
        mass[j * N + j] = 1 / sqrt(mass[j * N + j]);
        for (int i = j + 1; i < N; i++) {{
            for (int k = 0; k < j; k++) {{
                mass[i * N + j] -= mass[i * N + k] * mass[j * N + k];
            }}
            mass[i * N + j] *= mass[j * N + j];
        }}
    }}
    for (int i = 0; i < N; i++) {{
        for (int k = 0; k < i; k++) {{
            result[i] -= mass[i * N + k] * result[k];
        }}
        result[i] *= mass[i * N + i];
    }}
    for (int i = N - 1; i >= 0; i--) {{
        for (int k = i + 1; k < N; k++) {{
            result[i] -= mass[k * N + i] * result[k];
        }}
        result[i] *= mass[i * N + i];
    }}
}}
"""


def text(tree: Tree) -> str:
    """The C of a tree: derived by KanesMethod, written by PyDy's CMatrixGenerator."""
    from pydy.codegen.c_code import CMatrixGenerator

    from lab.sympy_kane import derive

    kane = derive(tree)
    arguments = [kane.coordinates, kane.speeds, kane.inputs, kane.constants]
    _, source = CMatrixGenerator(arguments, [kane.mass_matrix, kane.forcing]).doprint()
    adapter = ADAPTER.format(
        n=len(kane.coordinates),
        inputs=len(kane.inputs),
        values=", ".join(map(repr, kane.values)),
        offset="3.14159265358979323846" if kane.upside_down else "0",
    )
    return source.replace("void evaluate", "static void evaluate") + "\n/* adapter */\n" + adapter


def contestants(column: str, missing: list[str]) -> list[Contestant]:
    """PyDy's C of a column, where it is derived within two minutes."""
    script = "from lab import pydy_c, trees; print(pydy_c.text(trees.COLUMNS[%r]()))"
    try:
        made = output_within(SECONDS, [sys.executable, "-c", script % column])
    except RuntimeError as error:
        missing.append(f"PyDy, {column}: {str(error).strip().splitlines()[-1]}")
        return []
    if made is None:
        missing.append(f"PyDy, {column}: not derived within {SECONDS} s")
        return []
    equations, adapter = made.split("\n/* adapter */\n")
    source = Source({"run.c": adapter, "equations.c": equations}, "run.c")
    return [Contestant("PyDy + Cholesky", "Kane", source, absolute=COLUMNS[column]().planar)]
