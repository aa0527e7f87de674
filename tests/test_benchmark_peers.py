"""The peers of benchmarks/engine.py are oracles: their accelerations are ours."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tools import library

from eomgen import compile
from eomgen.interpreter import FLOAT, run
from eomgen.spec import read

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

from lab import derivation
from lab.contestants import sample, to_absolute
from lab.engines import mjcf
from lab.frames import aligned, plain
from lab.spec_text import spec
from lab.trees import cart, limb, massless, skew_arm, walker

pytestmark = pytest.mark.slow  # the peers are large, and not among what developers install


def short_walker():
    """The free body and the first joints of one leg: slides, joints without mass, skew offsets."""
    whole = walker()
    return replace(whole, links=whole.links[:8], driven=(6, 7))


def sled():
    """A slide without mass under two joints, one of them skew: small enough for KanesMethod."""
    links = (massless(-1, "slide", (0, 1, 0)), limb(0, 0, (0, 0, 1)), limb(1, 1, (1, 2, 2)))
    return replace(skew_arm(3), links=links, driven=(1, 2))


TREES = {"skew arm": skew_arm(3), "walker": short_walker(), "cart": cart(3)}


@pytest.fixture(params=TREES)
def tree(request):
    return TREES[request.param]


def ours(tree, state, inputs):
    """Accelerations in the coordinates of the tree, through the spec that the benchmark writes."""
    model = read(spec(tree), "scene.yaml")
    function = compile.FUNCTIONS["accelerations"](compile.machine_of(model))
    n, to_spec = len(tree.links), to_absolute(tree)
    arguments = {
        "time": [0.0],
        "state": [*(to_spec @ state[:n]), *(to_spec @ state[n:])],
        "inputs": inputs,
        "parameters": [float(p.value) for p in model.parameters],
    }
    return np.linalg.solve(to_spec, np.array(run(function, arguments, FLOAT), float))


def at_first_states(tree):
    """Three states and inputs with our accelerations."""
    given = sample(tree)
    for state, inputs in zip(given.states[:3], given.inputs[:3], strict=True):
        yield state, inputs, ours(tree, state, inputs)


def assert_equal(found, expected):
    assert np.abs(np.ravel(found) - expected).max() < 1e-11 * np.abs(expected).max()


@pytest.mark.parametrize("axes", [plain, aligned])
@pytest.mark.parametrize("method", ["casadi_articulated", "casadi_composite"])
def test_casadi_finds_our_accelerations(tree, method, axes):
    library("casadi")
    solve = library(f"lab.{method}").solve
    function = library("lab.casadi_spatial").function(tree, axes(tree), solve)
    for state, inputs, expected in at_first_states(tree):
        assert_equal(function(state, inputs).full(), expected)


@pytest.mark.parametrize("method", ["articulated", "composite"])
def test_casadi_in_the_plane_finds_our_accelerations(method):
    library("casadi")
    planar, tree = library("lab.casadi_planar"), TREES["cart"]
    function = planar.function(tree, getattr(planar, method))
    to_spec = np.kron(np.eye(2), to_absolute(tree))
    for state, inputs, expected in at_first_states(tree):
        assert_equal(function(to_spec @ state, inputs).full(), to_absolute(tree) @ expected)


def test_mujoco_finds_our_accelerations(tree):
    mujoco = library("mujoco")
    model = mujoco.MjModel.from_xml_string(mjcf(tree))
    data, n = mujoco.MjData(model), len(tree.links)
    for state, inputs, expected in at_first_states(tree):
        data.qpos[:], data.qvel[:] = state[:n], state[n:]
        data.qfrc_applied[list(tree.driven)] = inputs
        mujoco.mj_forward(model, data)
        assert_equal(data.qacc, expected)


def values(tree, state, inputs, name):
    """The numbers of all symbols of a peer; `name` makes one of its symbols."""
    n = len(tree.links)
    found = {name("g"): 9.81}
    for i, link in enumerate(tree.links):
        found |= {name(f"q_{i}"): state[i], name(f"u_{i}"): state[n + i]}
        found[name(f"m_{i}")] = float(link.mass)
        for letter, numbers in (("r", link.place), ("c", link.com), ("I", link.inertia)):
            found |= {name(f"{letter}{i}_{k}"): float(v) for k, v in enumerate(numbers)}
    return found | {name(f"tau_{i}"): v for i, v in zip(tree.driven, inputs, strict=True)}


def test_symengine_finds_our_accelerations(tree):
    symengine = library("symengine")
    equations = library("lab.symengine_kane").equations(tree)
    n = len(tree.links)
    for state, inputs, expected in at_first_states(tree):
        known = values(tree, state, inputs, symengine.Symbol)
        entries = np.array([float(symengine.sympify(e).subs(known)) for e in equations])
        mass, forcing = entries[: n * n].reshape(n, n), entries[n * n :]
        assert_equal(np.linalg.solve(mass, forcing), expected)


@pytest.mark.slow
def test_kanes_method_finds_our_accelerations():
    import sympy as sp
    from lab.sympy_kane import derive

    tree = sled()
    kane = derive(tree)
    arguments = [kane.constants, kane.coordinates, kane.speeds, kane.inputs]
    function = sp.lambdify(arguments, [kane.mass_matrix, kane.forcing], cse=True)
    n = len(tree.links)
    for state, inputs, expected in at_first_states(tree):
        mass, forcing = function(kane.values, state[:n], state[n:], inputs)
        assert_equal(np.linalg.solve(mass, forcing), expected)


def test_an_exponent_is_the_slope_of_the_logarithms():
    assert derivation.exponent([(n, 3 * n**1.5) for n in (25.0, 50.0, 100.0)]) == pytest.approx(1.5)
    assert derivation.exponent([(25.0, 1.0)]) is None
