"""The shipped specs and the extra scenes of the tests, each derived once for all tests."""

from functools import cache
from pathlib import Path

from eomgen import compile, formulation, study, study_linked
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


FREE = tuple(n for n in SHIPPED if not model_of(n).constraints)  # shipped, nothing is linked
LINKED = tuple(n for n in SHIPPED if model_of(n).constraints)


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
    links = study_of(name).links if model_of(name).constraints else None
    if links is None:
        return compile.program(machine_of(name))
    return study_linked.program(links.scene, formulation.choose(links.scene, wanted))


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
