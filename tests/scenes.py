"""The shipped specs and the extra scenes of the tests, each derived once for all tests."""

from functools import cache
from pathlib import Path

from eomgen import compile, study
from eomgen.checks import samples
from eomgen.mechanics import lagrange
from eomgen.spec import read

HERE = Path(__file__).parent
SHIPPED = {p.stem: p for p in sorted((HERE.parent / "specs").glob("*.yaml"))}
EXTRA = {p.stem: p for p in sorted((HERE / "fixtures").glob("*.yaml"))}
FILES = SHIPPED | EXTRA


def text_of(name):
    return FILES[name].read_text(encoding="utf-8")


@cache
def model_of(name):
    return read(text_of(name), FILES[name].name)


@cache
def derivation_of(name):
    return lagrange.derive(model_of(name))


@cache
def machine_of(name):
    return compile.machine_of(model_of(name))


@cache
def program_of(name):
    return compile.program(machine_of(name))


@cache
def samples_of(name):
    return samples.draw(model_of(name), seed=7)


@cache
def study_of(name):
    return study.of_model(model_of(name))


def expecting(name, claims):
    """The text of a spec whose claims are replaced by these lines."""
    kept = text_of(name).partition("\nexpect:")[0]
    return f"{kept}\nexpect:\n{claims}"
