"""The lecture notes of every shipped spec are typeset, in both languages."""

import re

import pytest
from commandline import run
from scenes import SHIPPED
from tools import tool

pytestmark = pytest.mark.slow

PACKAGES = {"inputenc", "fontenc", "lmodern", "amsmath", "babel"}
WIDEST_EXCESS = 20.0  # points beyond the margin that nobody sees
CASES = [(name, language) for name in SHIPPED for language in ("en", "es")]


def typeset(file):
    """The log of one run of pdflatex, which must succeed."""
    words = ("-halt-on-error", "-interaction=nonstopmode", file.name)
    run(tool("pdflatex"), *words, folder=file.parent, max_print_line="1000")
    return file.with_suffix(".log").read_text(encoding="latin-1")


@pytest.mark.parametrize(("name", "language"), CASES)
def test_notes_are_typeset(name, language, generated):
    file = generated(name) / language / f"{name}.tex"
    log = typeset(file)
    assert file.with_suffix(".pdf").read_bytes().startswith(b"%PDF-")
    excesses = [
        float(e) for e in re.findall(r"^Overfull \\[hv]box \(([\d.]+)pt", log, re.MULTILINE)
    ]
    assert max(excesses, default=0.0) <= WIDEST_EXCESS
    assert "Missing character" not in log
    assert "LaTeX Warning" not in log


@pytest.mark.parametrize(("name", "language"), CASES)
def test_notes_need_standard_packages_only(name, language, generated):
    text = (generated(name) / language / f"{name}.tex").read_text(encoding="utf-8")
    used = re.findall(r"\\(?:usepackage|RequirePackage)(?:\[[^]]*\])?\{([^}]*)\}", text)
    assert "amsmath" in used
    assert {package for words in used for package in words.split(",")} <= PACKAGES
