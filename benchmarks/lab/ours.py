"""Our own C, made by our own command line, as contestants; options that are not there are named."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from lab.build import AVX2, COMPILERS, Source
from lab.contestants import Contestant
from lab.limits import output_within
from lab.spec_text import spec
from lab.timing import STATES
from lab.trees import Tree

SECONDS = 120

ADAPTER = """\
#include "scene.h"
#include <stdlib.h>

static scene_params parameters;
{model}

int setup(const char *text)
{{
    (void)text;
    parameters = scene_default_parameters();
    {prepare}
    return 0;
}}

void run(const double *state, const double *inputs, double *result)
{{
    if ({call}) {{
        abort(); /* a mass matrix that is not positive: there is none among the scenes */
    }}
}}
"""
PLAIN = {
    "model": "",
    "prepare": "",
    "call": "scene_accelerations(0, state, inputs, &parameters, result)",
}
PREPARED = {
    "model": "static scene_model model;",
    "prepare": "scene_prepare(&parameters, &model);",
    "call": "scene_prepared_accelerations(0, state, inputs, &model, result)",
}
BATCH = PREPARED | {
    "call": f"scene_batch_accelerations({STATES}, 0, state, inputs, &model, result)"
}


@dataclass(frozen=True)
class Row:
    """A line of the table: the options that make it, and how it is called."""

    name: str
    options: tuple[str, ...]
    call: dict[str, str]
    compilers: dict[str, tuple[str, ...]] = field(default_factory=lambda: COMPILERS)


ROWS = (
    Row("ours, folded", ("--fold",), PREPARED),
    Row("ours, run-time parameters", (), PREPARED),
    Row("ours, folded, fast trig", ("--fold", "--fast-trig"), PREPARED),
    Row("ours, folded, limb after limb", ("--fold", "--batch"), PREPARED),
    Row("ours, batch, folded", ("--fold", "--batch"), BATCH),
    Row("ours, batch, folded, fast trig", ("--fold", "--batch", "--fast-trig"), BATCH),
    Row("ours, batch, folded, AVX2", ("--fold", "--batch"), BATCH, AVX2),
    Row("ours, folded, limb after limb, AVX2", ("--fold", "--batch"), PREPARED, AVX2),
    Row("the same, fast trig, AVX2", ("--fold", "--batch", "--fast-trig"), PREPARED, AVX2),
)


class Missing(Exception):
    """Why a line of ours cannot be there."""


def files(text: str, options: tuple[str, ...]) -> dict[str, str]:
    """The C files of a spec.

    Raises:
        Missing: the command line has no such option, refuses the scene, or takes two minutes.
    """
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "scene.yaml").write_text(text, encoding="utf-8")
        command = [sys.executable, "-m", "eomgen.cli", "generate", "scene.yaml", "-t", "c"]
        try:
            made = output_within(SECONDS, [*command, *options, "-o", "out"], folder)
        except RuntimeError as error:
            raise Missing(str(error).strip().splitlines()[-1]) from error
        if made is None:
            raise Missing(f"not generated within {SECONDS} s")
        return {p.name: p.read_text(encoding="utf-8") for p in Path(folder, "out").iterdir()}


def contestants(tree: Tree, missing: list[str]) -> Iterator[Contestant]:
    """Every row that can be made; what cannot is told to `missing`."""
    text = spec(tree)
    for row in ROWS:
        try:
            made = files(text, (*row.options, "--functions", "accelerations"))
        except Missing as reason:
            missing.append(f"{row.name}, {tree.name}: {reason}")
            continue
        prepared = "scene_prepare(" in made["scene.h"]
        adapter = ADAPTER.format(**(row.call if prepared else PLAIN))
        yield Contestant(
            row.name,
            " ".join(row.options) or "parameters",
            Source({**made, "run.c": adapter}, "run.c", units=("scene.c",)),
            absolute=tree.planar,
            text="parameters",
            batch=row.call is BATCH,
            compilers=row.compilers,
        )
