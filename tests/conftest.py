"""Fixtures of several test files."""

from functools import cache

import pytest
from commandline import eomgen, together
from scenes import SHIPPED

TARGETS = ("-t", "latex", "-t", "c", "-t", "python", "-t", "text")


@pytest.fixture(scope="session")
def generated(tmp_path_factory):
    """Name of a shipped spec -> folder that the command line wrote: en/ everything, es/ notes."""

    @cache
    def folder_of(name):
        folder, spec = tmp_path_factory.mktemp(name), SHIPPED[name]
        together(
            [
                eomgen("generate", spec, *TARGETS, "-o", folder / "en"),
                eomgen("generate", spec, *TARGETS, "-o", folder / "es", "--lang", "es"),
            ]
        )
        return folder

    return folder_of
