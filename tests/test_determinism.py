"""The same spec gives the same bytes, under any hash seed and from any folder."""

import os
from pathlib import Path

import pytest
from commandline import eomgen, finish, start
from scenes import SHIPPED

pytestmark = pytest.mark.slow

NAMES = (
    "cart_three_pendulums",  # large closed forms, inputs
    "central_force",  # energy only
    "gyroscope",  # spatial, outputs
    "satellite",  # quasi-velocities, moments in body axes
    "sprung_pair",  # six coordinates, roots
    "two_link_arm",  # prescribed motion
)
TARGETS = ("-t", "latex", "-t", "c", "-t", "python", "-t", "text")
SEEDS = ("0", "1", "12345")


def contents(folder):
    return {path.name: path.read_bytes() for path in Path(folder).iterdir()}


@pytest.mark.parametrize("name", NAMES)
def test_the_same_bytes_under_any_hash_seed_and_from_any_folder(name, tmp_path):
    """Each seed runs in a folder of another depth, with another path to the spec."""
    folders = [tmp_path / "x", tmp_path / "y" / "z", SHIPPED[name].parent]
    running = []
    for seed, folder in zip(SEEDS, folders, strict=True):
        folder.mkdir(parents=True, exist_ok=True)
        spec = os.path.relpath(SHIPPED[name], folder)
        words = eomgen("generate", spec, *TARGETS, "-o", tmp_path / seed)
        running.append(start(*words, folder=folder, PYTHONHASHSEED=seed))
    for process in running:
        finish(process)
    first, *others = (contents(tmp_path / seed) for seed in SEEDS)
    assert sorted(first) == sorted(f"{name}.{suffix}" for suffix in ("c", "h", "py", "tex", "txt"))
    for other in others:
        assert other == first
