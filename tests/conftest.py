"""Fixtures of several test files."""

import os
import sys
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from io import BytesIO, TextIOWrapper
from pathlib import Path
from shutil import copytree

import pytest
from commandline import eomgen, together
from reference import stem, wanted
from scenes import SHIPPED

from eomgen.cache_folder import VARIABLE
from eomgen.cli import main
from eomgen.numerics.compiled import load_python

HEAVY = frozenset((Path(__file__).parent / "heavy.txt").read_text(encoding="utf-8").split("\n"))
TARGETS = ("-t", "latex", "-t", "c", "-t", "python", "-t", "text")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Tests that take seconds, one on each line of `heavy.txt`, are among the slow ones."""
    for item in items:
        if item.nodeid.removeprefix("tests/") in HEAVY:
            item.add_marker(pytest.mark.slow)


@pytest.fixture(scope="session")
def generated(tmp_path_factory):
    """A case of `reference` -> folder that the command line wrote: en/ and es/, everything."""

    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base  # by all processes

    @cache
    def folder_of(case):
        own, known = tmp_path_factory.mktemp(case), shared / f"generated-{case}"
        if known.exists():  # tests compile in their own copy
            return copytree(known, own, dirs_exist_ok=True)
        wish = ("--formulation", wanted(case))
        generate = ("generate", SHIPPED[stem(case)], *TARGETS, *(wish if "-" in case else ()))
        together(
            [
                eomgen(*generate, "-o", own / "en"),
                eomgen(*generate, "-o", own / "es", "--lang", "es"),
            ]
        )
        with suppress(OSError):  # another process was first, with the same bytes
            copytree(own, tmp_path_factory.mktemp("copy") / case).rename(known)
        return own

    return folder_of


@pytest.fixture(scope="session")
def module(generated):
    """A case of `reference` -> the module that was written for it, imported."""

    @cache
    def imported(case):
        text = (generated(case) / "en" / f"{stem(case)}.py").read_text(encoding="utf-8")
        return load_python(text, stem(case))

    return imported


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory):
    """Compiled libraries of this session, shared by its processes, not the user's."""
    base = tmp_path_factory.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = before or str(shared / "libraries")
    yield
    if before is None:
        del os.environ[VARIABLE]


@dataclass(frozen=True)
class Said:
    """What a command answered."""

    code: int
    output: str
    errors: str


@pytest.fixture
def call(monkeypatch, capsys, tmp_path):
    """The command line in this process, in an empty folder: words and standard input -> Said."""
    monkeypatch.chdir(tmp_path)

    def answer(*words, stdin=""):
        monkeypatch.setattr(sys, "argv", ["eomgen", *map(str, words)])
        monkeypatch.setattr(sys, "stdin", TextIOWrapper(BytesIO(stdin.encode())))
        with pytest.raises(SystemExit) as end:
            main()
        return Said(end.value.code, *capsys.readouterr())

    return answer
