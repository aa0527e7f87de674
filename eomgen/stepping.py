"""A study and the integrators that are wanted -> its program with step functions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from eomgen import compile_steps
from eomgen.compile_steps import Scene
from eomgen.integrators import methods
from eomgen.integrators.steps import Steps
from eomgen.program import Function, Program
from eomgen.study import Study


def of(study: Study, names: tuple[str, ...], *, compensated: bool = False) -> Steps:
    """The steps of these names, in the formulation of the study; `all` are those that it can have.

    Raises:
        UsageError: there is no such method, or it is not what it should be for this scene.
    """
    scene = scene_of(study)
    found = methods.chosen(names)
    if methods.ALL in names:
        found = tuple(m for m in found if m.name in names or compile_steps.offers(scene, m))
    extra = compile_steps.functions(scene, found)
    return Steps(extended(study.program, extra), found, compensated)


def scene_of(study: Study) -> Scene:
    """The machines that are integrated."""
    return Scene(study.compiled, study.machine)


def extended(program: Program, extra: Sequence[Function]) -> Program:
    """The program with these functions, each once."""
    known = {f.name for f in program.functions}
    new = tuple(f for f in extra if f.name not in known)
    return replace(program, functions=program.functions + new)
