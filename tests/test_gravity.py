"""Weights and energies summed over a tree of frames, against sums over the bodies."""

from functools import cache

import mpmath
import pytest
from scenes import EXTRA, SHIPPED, model_of
from trees import PARALLEL, arm, spatial

from eomgen.algebra import cost
from eomgen.algebra.arithmetic import evaluate, mpmath_arithmetic
from eomgen.checks import power, samples
from eomgen.compile import machine_of
from eomgen.errors import CheckError
from eomgen.mechanics import efforts
from eomgen.mechanics.recursive import gravity, loads
from eomgen.mechanics.recursive.records import NoTree
from eomgen.spec import read

# a drum that turns as prescribed on a pedestal, an arm that slides on it, a skew limb on that
DRIVEN = """
eom: 1
system: driven
space: solid
gravity: [g_x, 0, -g]
parameters: {g: 9.81, g_x: 1.5, w: 2, l: 0.3, m: 2, J_x: 0.05, J_y: 0.06, J_z: 0.04, J_xy: 0.01}
coordinates: {s: 1, q: 1}
prescribed: {drive: w*t + l*t^2}
bodies:
  pedestal: {mass: m, inertia: [0.1, 0.1, 0.1], com: [l, l/2, l],
    frame: {at: [l, 2*l, l], turn: [[[2, 3, 6], 0.3]]}}
  drum: {mass: 3*m, inertia: [J_x, J_y, J_z, J_xy, 0, 0], com: [l/5, l, 0],
    frame: {on: pedestal, at: [0, l, l/2], turn: [[z, drive]]}}
  slide: {mass: m/2, inertia: [J_y, J_z, J_x, 0, J_xy, 0], com: [0, l/4, l],
    frame: {on: drum, at: [l, s, l + t*w]}}
  limb: {mass: m, inertia: [J_x, J_y, J_z, J_xy, J_xy/2, -J_xy], com: [l, l/2, -l],
    frame: {on: slide, at: [l, l/3, 0], turn: [[[1, 2, 2], q]]}}
springs: [{along: s, stiffness: 30}]
"""


def of_frames(text):
    """The scene without what stands at a formula in world axes."""
    left = [s for s in text.splitlines() if not s.startswith(("  bob:", "  swing:"))]
    return "\n".join(left)


RANDOM = {f"random_{seed}": of_frames(spatial(seed)) for seed in range(8)}
RANDOM |= {"parallel": arm(6, PARALLEL), "driven": DRIVEN, "long": arm(20)}


@cache
def machine(name):
    model = read(RANDOM[name], f"{name}.yaml") if name in RANDOM else model_of(name)
    return machine_of(model)


def is_of_frames(name):
    tree = machine(name).tree
    return not isinstance(tree, NoTree) and gravity.is_of_frames(tree)


FRAMES = [n for n in (*SHIPPED, *EXTRA, *RANDOM) if is_of_frames(n)]
each_tree = pytest.mark.parametrize("name", FRAMES)


def values(found, nodes):
    """Numbers of 50 digits at a random state."""
    drawn = samples.draw(found.model, 1, seed=5).arguments()
    leaves = {n: mpmath.mpf(drawn[n.datum.argument][n.datum.index][0]) for n in found.leaves}
    with mpmath.workdps(50):
        return evaluate(nodes, leaves, mpmath_arithmetic(50))


def test_skew_and_driven_trees_are_among_them():
    assert {"skew_arm", "heavy_top", "driven", "parallel", "random_1"} <= {*FRAMES}
    assert "ball_joints" not in FRAMES  # turned by a quaternion


@each_tree
def test_energies_are_those_of_the_bodies(name):
    found = machine(name)
    kinetic, potential = found.energy
    others = gravity.kinetic(found._lumped), gravity.potential(found.kinematics, found.tree)
    t, v, short_t, short_v, summed = values(
        found, [kinetic, potential, *found.short_energy, others[0]]
    )
    assert abs(short_t - t) <= 1e-40 * (abs(t) + 1)
    assert abs(summed - t) <= 1e-40 * (abs(t) + 1)
    assert abs(short_v - v) <= 1e-40 * (abs(v) + 1)


@each_tree
def test_weights_are_those_of_the_bodies(name):
    found = machine(name)
    swept = loads.generalized(found.kinematics, list(efforts.weights(found.kinematics)))
    for tree in (found.tree, found._lumped):
        rows = values(found, [*swept, *gravity.weights(tree)])
        for one, other in zip(rows[: len(swept)], rows[len(swept) :], strict=True):
            assert abs(one - other) <= 1e-40 * (abs(one) + 1)


def test_on_a_long_skew_arm_half_of_the_operations_go():
    found = machine("long")
    assert 2 * cost.operations(found.short_energy) <= cost.operations(found.energy)
    swept = loads.generalized(found.kinematics, list(efforts.weights(found.kinematics)))
    assert cost.operations(gravity.weights(found._lumped)) < cost.operations(swept)


def test_a_written_energy_that_is_wrong_is_found(monkeypatch):
    right = gravity.kinetic
    monkeypatch.setattr(gravity, "kinetic", lambda tree: right(tree) * 2)
    machine = machine_of(model_of("skew_arm"))
    drawn = samples.draw(machine.model, 3, seed=1)
    assert machine.short_energy[0] is not machine.energy[0]
    with pytest.raises(CheckError, match="power in is not the rate of the energy"):
        power.balance(machine, drawn)
