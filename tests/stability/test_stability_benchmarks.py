"""The multibody benchmark collection at its high accuracy, and Andrews' mechanism."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest
from tools import tool

PAGE = Path(__file__).parents[2] / "benchmarks" / "multibody.py"


@pytest.fixture(scope="module")
def multibody():
    tool("cc")
    description = importlib.util.spec_from_file_location("multibody", PAGE)
    module = importlib.util.module_from_spec(description)
    sys.modules["multibody"] = module  # dataclasses look their module up
    description.loader.exec_module(module)
    module.REPEATS = 1
    yield module
    del sys.modules["multibody"]


def test_a01_is_the_elliptic_function_for_2000_seconds(multibody):
    for line in multibody.pendulum():
        assert line.error < (1.1e-3 if line.step == 5e-3 else multibody.HIGH / 10)
        assert line.energy < 2e-5


@pytest.mark.slow
def test_a02_passes_its_singular_positions(multibody):
    for line in multibody.four_bars():
        assert line.error < 1e-6
        assert line.energy < 1e-6


@pytest.mark.slow
def test_a05_follows_radau(multibody):
    coarse, fine = multibody.governor()
    assert fine.error < multibody.HIGH / 10
    assert coarse.error / fine.error == pytest.approx(25, rel=0.3)  # order 2


@pytest.mark.slow
def test_the_squeezer_is_where_it_was_published_and_confirmed_twice(multibody):
    found = multibody.squeezer()
    published = np.array([float(multibody.SQUEEZER[name]) for name in found.names])
    np.testing.assert_allclose(found.fine, published, rtol=1e-9)
    np.testing.assert_allclose(found.coarse, found.fine, rtol=3e-13)  # rounding of both runs
    np.testing.assert_allclose(found.other, found.fine, rtol=3e-13)
