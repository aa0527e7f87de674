"""Every shipped spec through the real command line: it checks, and all files are written."""

import json

import pytest
from commandline import eomgen, run
from reference import NAMES
from scenes import SHIPPED, model_of

pytestmark = pytest.mark.slow

SUFFIXES = ("c", "h", "py", "tex", "txt")


def test_all_shipped_specs_check_in_one_call():
    said = run(*eomgen("check", *SHIPPED.values(), "--format", "json"))
    for path, line in zip(SHIPPED.values(), said.splitlines(), strict=True):
        found = json.loads(line)
        assert found["file"] == str(path)
        assert found["degrees_of_freedom"] == len(model_of(path.stem).coordinates)
        assert found["relative_error"] < 1e-9
        assert found["power_balance"] < 1e-9
        assert found["terms"] > 0
        assert found["claims"] > 0


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("name", NAMES)
def test_all_files_are_written(name, language, generated):
    written = {path.name for path in (generated(name) / language).iterdir()}
    assert {f"{name}.{suffix}" for suffix in SUFFIXES} <= written


@pytest.mark.parametrize("name", NAMES)
def test_the_code_does_not_depend_on_the_language(name, generated):
    for suffix in ("c", "h", "py"):
        english, spanish = (
            (generated(name) / language / f"{name}.{suffix}").read_bytes()
            for language in ("en", "es")
        )
        assert english == spanish


@pytest.mark.parametrize("name", NAMES)
def test_every_file_names_the_spec_it_was_made_from(name, generated):
    for suffix in ("c", "h", "py", "tex"):
        text = (generated(name) / "en" / f"{name}.{suffix}").read_text(encoding="utf-8")
        assert model_of(name).digest in text


@pytest.mark.parametrize("name", NAMES)
def test_nothing_of_this_machine_is_in_the_files(name, generated):
    folder = generated(name)
    for path in (folder / "en" / f"{name}.{suffix}" for suffix in SUFFIXES):
        text = path.read_text(encoding="utf-8")
        assert str(folder) not in text
        assert str(SHIPPED[name].parent) not in text


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("name", NAMES)
def test_the_notes_carry_the_check_line(name, language, generated):
    word = {"en": "checked", "es": "comprobado"}[language]
    for suffix in ("tex", "txt"):
        text = (generated(name) / language / f"{name}.{suffix}").read_text(encoding="utf-8")
        assert text.count(f"\n{word}: Lagrange") == 1
