"""Optional programs on the path: a test that needs one says so, and CI forbids to skip it."""

import importlib
import os
import shutil

import pytest

STRICT = "EOMGEN_REQUIRE_TOOLS"  # set: a tool that is missing is a failure


def missing(name):
    """Skip the test, or fail where `STRICT` is set."""
    (pytest.fail if os.environ.get(STRICT) else pytest.skip)(f"{name} is not installed")


def tool(name):
    """The path of a program; without it the test is skipped, or fails where `STRICT` is set."""
    found = shutil.which(name)
    if not found:
        missing(name)
    return found


def library(name):
    """A module that only tests need; without it as above."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError:
        return missing(name)
