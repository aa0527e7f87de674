"""The shipped specs and the extra scenes of the tests, each derived once for all tests."""

from functools import cache
from pathlib import Path

import pytest

from eomgen import compile, formulation, study, study_linked
from eomgen.checks import links, samples
from eomgen.mechanics import lagrange
from eomgen.spec import read
from eomgen.wanted import Wanted

HERE = Path(__file__).parent
SHIPPED = {p.stem: p for p in sorted((HERE.parent / "specs").glob("*.yaml"))}
EXTRA = {p.stem: p for p in sorted((HERE / "fixtures").glob("*.yaml"))}
FILES = SHIPPED | EXTRA


def text_of(name):
    return FILES[name].read_text(encoding="utf-8")


@cache
def model_of(name):
    return read(text_of(name), FILES[name].name)


FREE = tuple(n for n in SHIPPED if not model_of(n).constraints)  # shipped, nothing is linked
LINKED = tuple(n for n in SHIPPED if model_of(n).constraints)


SLOW = {"bricard"}  # seconds for each derivation


def each(names):
    """A test for each of these scenes."""
    marked = [pytest.param(n, marks=pytest.mark.slow) if n in SLOW else n for n in names]
    return pytest.mark.parametrize("name", marked)


@cache
def derivation_of(name):
    return lagrange.derive(model_of(name))


@cache
def machine_of(name):
    """Over all coordinates, as if nothing were linked."""
    return compile.machine_of(model_of(name))


@cache
def program_of(name, wanted="auto"):
    """What `generate` writes; `wanted` is the formulation of a linked scene."""
    if name not in LINKED:
        return compile.program(machine_of(name))
    scene = study_of(name).links.scene
    return study_linked.program(scene, formulation.choose(scene, Wanted(wanted)))


@cache
def samples_of(name):
    """Random states; those of a linked scene are off its constraints."""
    return samples.draw(model_of(name), seed=7)


@cache
def admissible_of(name):
    """Random states of a linked scene that satisfy its constraints."""
    scene = study_of(name).links.scene
    return links.samples_of(scene, scene.report.states, samples_of(name))


@cache
def study_of(name):
    return study.of_model(model_of(name))


def expecting(name, claims):
    """The text of a spec whose claims are replaced by these lines."""
    kept = text_of(name).partition("\nexpect:")[0]
    return f"{kept}\nexpect:\n{claims}"
