"""Every shipped spec through the real command line: it checks, and all files are written."""

import json

import pytest
from commandline import eomgen, run
from reference import CASES, stem
from scenes import LINKED, SHIPPED, model_of

pytestmark = pytest.mark.slow

SUFFIXES = ("c", "h", "py", "tex", "txt")


def test_all_shipped_specs_check_in_one_call():
    said = run(*eomgen("check", *SHIPPED.values(), "--format", "json"))
    for path, line in zip(SHIPPED.values(), said.splitlines(), strict=True):
        found = json.loads(line)
        assert found["file"] == str(path)
        assert found["degrees_of_freedom"] == model_of(path.stem).expect.dof
        assert ("formulation" in found) == (path.stem in LINKED)
        assert found["relative_error"] < 1e-9
        assert found["power_balance"] < 1e-9
        assert found["terms"] > 0
        assert found["claims"] > 0


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("case", CASES)
def test_all_files_are_written(case, language, generated):
    written = {path.name for path in (generated(case) / language).iterdir()}
    assert {f"{stem(case)}.{suffix}" for suffix in SUFFIXES} <= written


@pytest.mark.parametrize("case", CASES)
def test_the_code_does_not_depend_on_the_language(case, generated):
    for suffix in ("c", "h", "py"):
        english, spanish = (
            (generated(case) / language / f"{stem(case)}.{suffix}").read_bytes()
            for language in ("en", "es")
        )
        assert english == spanish


@pytest.mark.parametrize("case", CASES)
def test_every_file_names_the_spec_it_was_made_from(case, generated):
    for suffix in ("c", "h", "py", "tex"):
        text = (generated(case) / "en" / f"{stem(case)}.{suffix}").read_text(encoding="utf-8")
        assert model_of(stem(case)).digest in text


@pytest.mark.parametrize("case", CASES)
def test_nothing_of_this_machine_is_in_the_files(case, generated):
    folder = generated(case)
    for path in (folder / "en" / f"{stem(case)}.{suffix}" for suffix in SUFFIXES):
        text = path.read_text(encoding="utf-8")
        assert str(folder) not in text
        assert str(SHIPPED[stem(case)].parent) not in text


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("case", CASES)
def test_the_notes_carry_the_check_line(case, language, generated):
    word = {"en": "checked", "es": "comprobado"}[language]
    for suffix in ("tex", "txt"):
        text = (generated(case) / language / f"{stem(case)}.{suffix}").read_text(encoding="utf-8")
        assert text.count(f"\n{word}: Lagrange") == 1
