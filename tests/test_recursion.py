"""Recursion over the tree of joints against d'Alembert's projection, and its own identities."""

from functools import cache

import numpy as np
import pytest
from scenes import EXTRA, SHIPPED, model_of
from trees import BALL, PARALLEL, PLANAR, arm, spatial

from eomgen import compile, study
from eomgen.algebra import cost, normal
from eomgen.algebra.arithmetic import NUMPY, evaluate
from eomgen.algebra.ldl import SingularMassMatrix
from eomgen.algebra.walk import below
from eomgen.checks import samples
from eomgen.interpreter import mpmath_arithmetic, run
from eomgen.mechanics import virtual_work
from eomgen.mechanics.recursive import articulated, engine, loads, recursion
from eomgen.mechanics.recursive.lumping import lumped
from eomgen.mechanics.recursive.records import NoTree, PlanarFrame, Point
from eomgen.spec import read

SEEDS = range(8)
RANDOM = {f"random_{seed}": spatial(seed) for seed in SEEDS}
RANDOM |= {"planar": PLANAR, "ball": BALL, "parallel": arm(6, PARALLEL)}


@cache
def machine_of(name):
    model = read(RANDOM[name], f"{name}.yaml") if name in RANDOM else model_of(name)
    return compile.machine_of(model)


TREES = [
    *(n for n in SHIPPED | EXTRA if not isinstance(machine_of(n).tree, NoTree)),
    *RANDOM,
]
each_tree = pytest.mark.parametrize("name", TREES)


def values(machine, nodes):
    """An array (nodes, states)."""
    drawn = samples.draw(machine.model, 20, seed=3).arguments()
    leaves = {n: np.array(drawn[n.datum.argument][n.datum.index]) for n in machine.leaves}
    found = evaluate(nodes, leaves, NUMPY)
    return np.array([np.broadcast_to(v, (20,)) for v in found], dtype=float)


def matrix_values(machine, matrix):
    size = len(matrix)
    return values(machine, [e for row in matrix for e in row]).reshape(size, size, -1)


def close(found, wanted, scale=0.0):
    """Equal to 1e-12 of the largest value at each state."""
    axes = tuple(range(found.ndim - 1))
    size = np.maximum(np.max(np.abs(wanted), axis=axes), scale) + 1e-300
    return np.max(np.max(np.abs(found - wanted), axis=axes) / size) < 1e-12


@each_tree
def test_mass_matrix_bias_and_forces_are_those_of_virtual_work(name):
    machine = machine_of(name)
    wanted = virtual_work.derive(machine.kinematics)
    matrix = matrix_values(machine, wanted.mass_matrix)
    size = np.max(np.abs(matrix), axis=(0, 1))  # of M q'q', which h is made of
    for tree in (machine.tree, lumped(machine.tree)):
        assert close(matrix_values(machine, recursion.mass_matrix(tree)), matrix)
        bias = recursion.inverse_dynamics(tree, falling=False)
        assert close(values(machine, bias), values(machine, wanted.bias), size)
        forces = loads.generalized_forces(machine.kinematics, tree)
        whole = values(machine, wanted.generalized_forces)
        assert close(values(machine, forces), whole, np.maximum(size, 100 * np.abs(whole).max()))


@each_tree
@pytest.mark.parametrize("method", engine.METHODS)
def test_every_method_gives_the_accelerations_of_virtual_work(name, method):
    machine = machine_of(name)
    wanted = virtual_work.derive(machine.kinematics)
    right = [q - h for q, h in zip(wanted.generalized_forces, wanted.bias, strict=True)]
    matrix, force = matrix_values(machine, wanted.mass_matrix), values(machine, right)
    solved = np.linalg.solve(np.moveaxis(matrix, 2, 0), force.T[..., None])[..., 0].T
    for tree in (machine.tree, lumped(machine.tree)):
        applied = loads.of(machine.kinematics, tree)
        solution = engine.METHODS[method].solve(engine.Task(machine.kinematics, tree, applied))
        if solution is None:
            continue
        found, _ = solution
        conditioned = 1e-12 * np.linalg.cond(np.moveaxis(matrix, 2, 0))
        worst = np.max(np.abs(values(machine, found) - solved), axis=0)
        # a rounded force of size one is an acceleration of at most 1 / least eigenvalue
        floor = np.max(np.abs(force), axis=0) + np.max(np.abs(matrix), axis=(0, 1))
        size = np.max(np.abs(solved), axis=0) + floor / np.max(np.abs(matrix), axis=(0, 1))
        assert np.all(worst / size < np.maximum(1e-12, conditioned / 100))


@each_tree
def test_the_engine_takes_the_cheapest_and_says_which(name):
    machine = machine_of(name)
    chosen = machine.engine
    assert chosen.said in compile.program(machine).engine
    prepared = 0
    for p in machine.model.parameters:
        prepared |= machine.kinematics.algebra.of(p.symbol).leaves
    assert cost.of(chosen.accelerations, prepared) == chosen.cost
    for tree in (machine.tree, lumped(machine.tree)):
        applied = loads.of(machine.kinematics, tree)
        for method in engine.METHODS.values():
            solution = method.solve(engine.Task(machine.kinematics, tree, applied))
            if solution is not None:
                # lumping is decided by the moments that it leaves
                assert cost.of(solution[0], prepared).total >= 0.99 * chosen.cost.total


def test_lumping_pays_and_changes_nothing():
    machine = machine_of("furuta_pendulum")
    whole, less = machine.tree, lumped(machine.tree)
    assert machine.engine.lumped

    def count(tree):
        return cost.operations(recursion.inverse_dynamics(tree, falling=True))

    assert count(less) < count(whole)


def test_no_inertia_of_the_first_link_is_left_but_about_its_axis():
    """Everything else of a link that stands on the ground cannot matter."""
    tree = lumped(machine_of("furuta_pendulum").tree)
    body, zero = tree.places[1].body, tree.gravity[0].graph.zero
    assert body.mass is zero
    assert body.first[2] is zero  # the axis is z
    assert body.second[1][1] is zero


def test_a_chain_of_points_is_a_chain_of_translating_places():
    tree = machine_of("cart_three_pendulums").tree
    assert [place.base for place in tree.places[1:]] == [0, 1, 2, 3]
    assert all(isinstance(p.kind, Point) and p.kind.size == 2 for p in tree.places)
    assert tree.order == (0, 1, 2, 3)


@pytest.mark.parametrize("name", [n for n in TREES if machine_of(n).model.space == "plane"])
def test_planar_scenes_hold_no_value_of_space(name):
    """Twists have at most three parts, world axes need one sine a body and one a formula."""
    machine = machine_of(name)
    for place in machine.tree.places:
        assert place.kind.size <= 3
        for step in place.steps:
            assert len(step.matrix) <= 3
            assert all(len(row) <= 3 for row in step.matrix)


def test_an_arm_in_the_plane_takes_one_sine_and_cosine_a_link():
    machine = machine_of("manipulator")
    sines = [n for n in below(machine.engine.accelerations) if n.operator in ("sin", "cos")]
    assert len(sines) == 4
    assert all(isinstance(p.kind, PlanarFrame) for p in machine.tree.places[1:])


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("satellite", "its speeds are declared"),
        ("foucault_pendulum", "a kinetic energy is given as a formula"),
    ],
)
def test_what_is_no_tree_keeps_the_other_route_and_says_why(name, reason):
    machine = machine_of(name)
    assert str(machine.tree) == reason
    assert machine.engine is None
    assert compile.program(machine).engine == ""


def test_a_coordinate_that_moves_nothing_has_no_tree():
    text = PLANAR.replace("f: 1}", "f: 1, idle: 1}")
    machine = compile.machine_of(read(text, "idle.yaml"))
    assert str(machine.tree) == "no body moves with idle"


def test_skew_axes_cost_less_than_half_as_much_again():
    """The body axes are free: z along the joint, x across it and the next one."""
    skew, straight = (
        compile.machine_of(read(arm(6, axes), "arm.yaml")).engine.cost.operations
        for axes in (("[1, 2, 2]", "[2, -1, 2]", "[2, 3, 6]"), ("z", "y", "x"))
    )
    assert skew < 1.5 * straight


@cache
def chain(count):
    return compile.machine_of(read(arm(count), f"chain_{count}.yaml"))


def test_inverse_after_forward_dynamics_is_the_identity_of_fifty_joints():
    machine = chain(50)
    found = machine.engine
    assert found.method == "articulated bodies"
    right = recursion.inverse_dynamics(found.tree, True)
    left = recursion.inverse_dynamics(found.tree, True, found.accelerations)
    sizes = np.max(np.abs(values(machine, right)), axis=0)
    assert np.max(np.max(np.abs(values(machine, left)), axis=0) / sizes) < 1e-11


def test_programs_grow_linearly_with_a_chain():
    lengths = [len(compile.FUNCTIONS["accelerations"](chain(n)).statements) for n in (25, 50)]
    assert lengths[1] / lengths[0] < 2**1.15


def test_a_motion_without_inertia_is_refused_where_it_is_made():
    text = PLANAR.replace("wheel: {mass: m, inertia: J", "wheel: {mass: 0, inertia: 0")
    machine = compile.machine_of(read(text, "weightless.yaml"))
    with pytest.raises(SingularMassMatrix):
        articulated.factor(machine.tree)


def test_a_singular_state_is_seen_by_the_pivots_of_the_recursion():
    """A top standing upright: its first and last turn are the same."""
    machine = machine_of("heavy_top")
    function = compile.FUNCTIONS["accelerations"](machine)
    assert machine.engine.method == "articulated bodies"
    parameters = [1.0] * len(compile.program(machine).parameters)
    state = {
        "time": [0],
        "state": [0.3, 1e-9, 0.4, 1, 1, 1],
        "inputs": [],
        "parameters": parameters,
    }
    arithmetic = mpmath_arithmetic(16)
    numbers = {k: [arithmetic.number(v) for v in column] for k, column in state.items()}
    with pytest.raises(SingularMassMatrix):
        run(function, numbers, arithmetic)


def test_a_large_scene_is_proven_on_the_graph():
    report = study.of_text(arm(8), "chain.yaml").report
    assert report.routes == "recursion"
    assert report.agreement.error < 1e-12
    assert report.identity < 1e-12
    assert report.power < 1e-12


def test_the_proof_of_a_large_scene_sees_a_forgotten_term(monkeypatch):
    from eomgen.errors import CheckError
    from eomgen.mechanics.recursive import rigid

    whole = rigid.wrench

    def forgetful(body, spin, acceleration):
        return whole(body, tuple(0 * w for w in spin), acceleration)

    monkeypatch.setattr(rigid, "wrench", forgetful)
    with pytest.raises(CheckError, match="differ"):
        study.of_text(arm(8), "chain.yaml")


@pytest.mark.parametrize(
    ("name", "command", "remedy"),
    [
        ("skew_arm", "derive", "only notes need it, and `generate -t c -t python` writes none"),
        ("satellite", "check", "no recursion takes its place: its speeds are declared"),
    ],
)
def test_a_closed_form_too_large_is_refused_with_its_reason(
    monkeypatch, call, name, command, remedy
):
    monkeypatch.setattr(normal, "MOST_PRODUCTS", 10)
    said = call(command, SHIPPED[name])
    assert said.code == 2
    assert remedy in said.errors


@pytest.mark.slow
def test_the_command_line_of_a_scene_without_a_closed_form(call, tmp_path):
    """Code and numbers without it; notes are refused, with the reason."""
    (tmp_path / "arm.yaml").write_text(arm(8), encoding="utf-8")
    checked = call("check", "arm.yaml")
    assert checked.code == 0
    said = "8 degrees of freedom; engine: composite inertias and L'DL, inertias lumped, "
    assert f"arm.yaml: {said}" in checked.output
    assert "checked: Lagrange by differentiation = recursive Newton-Euler, at 50" in checked.output
    assert "inverse after forward dynamics = identity below 1e-1" in checked.output
    assert call("generate", "arm.yaml", "-t", "c").code == 0
    head = (tmp_path / "arm.c").read_text(encoding="utf-8")[:600]
    assert " * Engine: composite inertias and L'DL, inertias lumped, " in head
    refused = call("derive", "arm.yaml")
    assert refused.code == 2
    assert "the closed form of this scene takes more than" in refused.errors
