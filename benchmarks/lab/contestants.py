"""Who runs: a source in C or C++, how its coordinates differ from the tree's, what compiles it."""

from __future__ import annotations

import ctypes
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np

from lab.build import COMPILERS, Source, library, present
from lab.timing import STATES, Array, Entry
from lab.trees import Tree

COPIES = count()


@dataclass(frozen=True)
class Contestant:
    """One way to compute accelerations; the least of all with the same `row` goes to the table."""

    row: str
    variant: str
    source: Source
    absolute: bool = False  # takes the angles of a planar chain from the vertical
    driven: bool = True  # takes the inputs of driven joints only, else one a joint
    text: str = ""  # for setup()
    function: str = "run"
    batch: bool = False  # takes all states at once, component by component
    compilers: dict[str, tuple[str, ...]] = field(default_factory=lambda: COMPILERS)


@dataclass(frozen=True)
class Sample:
    """64 random states (64, 2n) and inputs (64, driven) in the tree's own coordinates."""

    tree: Tree
    states: Array
    inputs: Array


def sample(tree: Tree) -> Sample:
    """Angles of a whole turn, rates up to 2, efforts up to 5.

    Angles between joints in one place stay away from where two axes meet: no competitor should
    divide by almost nothing.
    """
    n = len(tree.links)
    random = np.random.default_rng(20)
    angles = random.uniform(-np.pi, np.pi, (STATES, n))
    angles[:, [i for i, k in enumerate(tree.links) if k.joint == "turn" and not k.mass]] *= 0.35
    rates = random.uniform(-2, 2, (STATES, n))
    efforts = random.uniform(-5, 5, (STATES, len(tree.driven)))
    return Sample(tree, np.hstack([angles, rates]), efforts)


def to_absolute(tree: Tree) -> Array:
    """The matrix from the tree's coordinates to those of the spec: angles add up along a chain."""
    n = len(tree.links)
    if not tree.planar:
        return np.eye(n)
    matrix = np.tril(np.ones((n, n)))
    matrix[1:, 0] = 0
    return matrix


def _loaded(contestant: Contestant, made: Path) -> Any:
    """The library; one that is set up is a copy of its own, for its data are its own."""
    if contestant.text:
        own = made.with_name(f"run_{next(COPIES)}.so")
        shutil.copy(made, own)
        made = own
    return ctypes.CDLL(str(made))


def entry(contestant: Contestant, made: Path, given: Sample) -> Entry:
    """The library, loaded and set up, with the sample in its own coordinates."""
    loaded = _loaded(contestant, made)
    if contestant.text:
        status = loaded.setup(contestant.text.encode())
        assert status == 0, f"{contestant.variant}: setup answers {status}"
    n = len(given.tree.links)
    states, inputs = given.states, given.inputs
    if contestant.absolute:
        matrix = to_absolute(given.tree)
        states = np.hstack([states[:, :n] @ matrix.T, states[:, n:] @ matrix.T])
    if not contestant.driven:
        inputs = np.zeros((STATES, n))
        inputs[:, list(given.tree.driven)] = given.inputs
    arrays = (states, inputs, np.zeros((STATES, n)))
    if contestant.batch:
        arrays = tuple(a.T.reshape(1, -1) for a in arrays)
    return Entry(loaded[contestant.function], *(np.ascontiguousarray(a) for a in arrays))


def accelerations(contestant: Contestant, filled: Entry, tree: Tree) -> Array:
    """The results of an entry that has run, in the tree's coordinates."""
    results = filled.results
    if contestant.batch:
        results = results.reshape(-1, STATES).T
    return np.linalg.solve(to_absolute(tree), results.T).T if contestant.absolute else results


Maker = Callable[[Tree], Iterator[Contestant]]


def built(
    contestants: list[Contestant], given: Sample, folder: Path
) -> Iterator[tuple[Contestant, str, Any]]:
    """Every contestant with every compiler that it names and that is installed."""
    for contestant in contestants:
        for name, compiler in present(contestant.compilers).items():
            made = library(contestant.source, compiler, folder)
            yield contestant, name, entry(contestant, made, given)
