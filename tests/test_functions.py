"""Functions that are asked for: Jacobians, inverse dynamics, regressor, places; in 50 digits."""

import re

import numpy as np
import pytest
from functions_of import (
    JACOBIANS,
    PRECISE,
    STEP,
    compiled,
    difference,
    function,
    motion,
    slope,
    slopes,
    states,
    value,
)
from reference import CASES, stem, written
from scenes import SLOW, model_of, study_of
from trees import arm

from eomgen import compile, formulation, interpreter
from eomgen.algebra import derive, jacobian
from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.algebra.cost import operations
from eomgen.algebra.elementary import absolute, maximum, minimum, sign
from eomgen.algebra.graph import Graph, sqrt
from eomgen.algebra.walk import below
from eomgen.checks import samples
from eomgen.errors import UsageError
from eomgen.functions import places, sensitivity, table
from eomgen.functions.motion import Motion
from eomgen.program import Solve
from eomgen.spec import read
from eomgen.wanted import wanted

LONG = {"andrews_squeezer", "andrews_squeezer-minimal", *(c for c in CASES if stem(c) in SLOW)}
each_case = pytest.mark.parametrize(
    "case", [pytest.param(c, marks=pytest.mark.slow) if c in LONG else c for c in CASES]
)


MOVING = [c for c in CASES if not model_of(stem(c)).guides]  # a rough guide moves in a mode
each_moving = pytest.mark.parametrize(
    "case", [pytest.param(c, marks=pytest.mark.slow) if c in LONG else c for c in MOVING]
)


def test_a_rough_guide_has_no_state_derivative_to_differentiate():
    with pytest.raises(UsageError, match="wire has friction: the state derivative is that of a"):
        function("bead_on_rough_wire", "state_jacobian")


@each_moving
def test_jacobians_are_the_differences_of_the_state_derivative(case):
    given = states(case)[1]
    for name, argument in JACOBIANS.items():
        if given[argument]:
            expected = slopes(case, "state_derivative", given, argument)
            assert difference(value(case, name, given), expected) < 1e-20


@each_case
def test_inverse_dynamics_after_the_motion_is_zero_and_gives_back_added_forces(case):
    """M u' + h - Q: zero on the motion; M du' more where du' is added."""
    if compiled(case).kept:
        return  # constraint forces are among them
    for given in states(case):
        free = value(case, "accelerations", given)
        at_rest = value(case, "inverse_dynamics", {**given, "accelerations": free})
        terms = [*value(case, "bias", given), *value(case, "generalized_forces", given), 1]
        assert max(map(abs, at_rest), default=0) < 1e-40 * max(map(abs, terms))
        chosen = value(case, "inverse_dynamics", given)
        matrix = value(case, "mass_matrix", given)
        more = matrix @ (np.array(given["accelerations"], dtype=object) - free)
        assert difference(chosen, more) < 1e-35


@each_moving
def test_inverse_dynamics_of_multipliers_leaves_the_forces_of_the_constraints(case):
    machine = compiled(case)
    if not machine.kept:
        return
    given = states(case)[0]
    free = value(case, "accelerations", given)
    rows = [r.name in machine.kept for r in machine.rows]
    slopes_of_rows = value(case, "constraint_jacobian", given)[rows]
    held = slopes_of_rows.T @ value(case, "multipliers", given)
    found = value(case, "inverse_dynamics", {**given, "accelerations": free})
    terms = [*value(case, "bias", given), *value(case, "generalized_forces", given), *held]
    assert max(map(abs, found - held)) < 1e-40 * max(map(abs, terms))


@each_case
def test_the_jacobian_of_inverse_dynamics_is_its_differences(case):
    given = states(case)[2]
    expected = np.concatenate(
        [slopes(case, "inverse_dynamics", given, a) for a in ("state", "accelerations")], axis=1
    )
    assert difference(value(case, "inverse_dynamics_jacobian", given), expected) < 1e-20


@each_case
def test_regressor_times_parameters_and_the_rest_is_inverse_dynamics(case):
    for given in states(case)[:2]:
        theta = value(case, "inertial_parameters", given)
        found = value(case, "regressor", given) @ theta + value(case, "regressor_rest", given)
        expected = value(case, "inverse_dynamics", given)
        assert difference(found, expected) < 1e-40


@each_case
def test_the_regressor_knows_no_mass(case):
    """Columns depend on geometry: what is to be identified must not be in them."""
    machine = compiled(case)
    free = {p.symbol for p in machine.model.parameters if p.formula is None}
    symbols = free & {body.mass for body in machine.model.bodies}
    read = {a for p in motion(case).inertial for a in below(p.column)}
    assert not read & {machine.kinematics.algebra.bindings[s] for s in symbols}


@each_moving
def test_velocities_are_rates_of_positions_and_jacobians_carry_the_speeds(case):
    given = states(case)[3]
    rates = value(case, "state_derivative", given)[: len(compiled(case).model.coordinates)]
    speeds = np.array(given["state"][len(rates) :], dtype=object)
    resting = {**given, "state": [*given["state"][: len(rates)], *(0 * speeds)]}
    for name in places.names(compiled(case).model):
        position, velocity, turned = (f"{kind}:{name}" for kind in table.ROWS_AT)
        expected = slopes(case, position, given, "state")[:, : len(rates)] @ rates
        expected = expected + slope(case, position, given, "time", 0)
        found = value(case, velocity, given)
        assert difference(found[: len(expected)], expected) < 1e-20
        drift = value(case, velocity, resting)
        assert difference(value(case, turned, given) @ speeds + drift, found) < 1e-40


SPATIAL = ("skew_arm", "gyroscope", "furuta_pendulum", "flyball_governor", "rolling_disc_tilting")


@pytest.mark.parametrize("case", SPATIAL)
def test_the_angular_velocity_of_a_body_turns_its_axes(case):
    """R' = [w x] R with w in world axes."""
    machine, given = compiled(case), states(case)[0]
    rates = value(case, "state_derivative", given)[: len(machine.model.coordinates)]
    leaves = {n: given[n.datum.argument][n.datum.index] for n in machine.leaves}
    along = dict(zip((c.symbol for c in machine.model.coordinates), machine.rates, strict=True))
    for body in machine.model.bodies:
        if not places.turns(body) or body.frame.along:
            continue
        axes = machine.kinematics.axes(body.name)
        moving = [[machine.kinematics.algebra.along(e, along) for e in row] for row in axes]
        flat = evaluate([*sum(axes, ()), *sum(moving, [])], leaves, PRECISE)
        turn, rate = (np.array(v, dtype=object).reshape(3, 3) for v in (flat[:9], flat[9:]))
        x, y, z = value(case, f"velocity_of:{body.name}", given)[3:]
        tilde = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]], dtype=object)
        assert difference(tilde @ turn, rate) < 1e-40
    assert len(rates) == len(machine.rates)


def test_the_planar_angular_velocity_stands_behind_the_linear_one():
    case, given = "two_link_arm", states("two_link_arm")[0]
    assert value(case, "velocity_of:fore", given)[2] == sum(given["state"][2:])
    assert value(case, "jacobian_of:fore", given).tolist()[2] == [1, 1]


def test_a_particle_has_no_angular_velocity():
    assert function("cart_three_pendulums", "velocity_of:cart").shape == (2,)
    assert function("skew_arm", "jacobian_of:fore").shape == (6, 2)


# ---- on the graph


def leaves(count):
    graph = Graph()
    return graph, [graph.read("state", i) for i in range(count)]


def test_forward_or_reverse_is_chosen_by_what_it_costs():
    graph, x = leaves(12)
    total = graph.zero
    for a in x:
        total = (total + a) * (total - a * a)
    (row,) = jacobian.jacobian([total], x)
    forward = jacobian._forward([total], x, derive.RULES)
    assert operations(row) < operations(forward[0]) / 2
    many = [total * a for a in x]
    column = [entry for (entry,) in jacobian.jacobian(many, x[:1])]
    numbers = dict(zip(x, (0.1 * i + 0.3 for i in range(12)), strict=True))
    assert evaluate(row, numbers, FLOAT) == pytest.approx(evaluate(forward[0], numbers, FLOAT))
    backward = [derive.gradient(y, x[:1])[0] for y in many]
    assert operations(column) < operations(backward)


def test_at_a_kink_the_derivative_is_the_mean_of_both_sides():
    _, (a, b) = leaves(2)
    results = [absolute(a), sign(a), minimum(a, b), maximum(a, b)]
    rows = jacobian.jacobian(results, [a, b])
    found = evaluate([e for row in rows for e in row], {a: 0.0, b: 0.0}, FLOAT)
    assert found == [0, 0, 0, 0, 0.5, 0.5, 0.5, 0.5]
    found = evaluate([e for row in rows for e in row], {a: -2.0, b: 1.0}, FLOAT)
    assert found == [-1, 0, 0, 0, 1, 0, 0, 1]


def test_a_root_that_vanishes_at_rest_has_a_derivative():
    """|v| v, |v|^(3/2) and the like: no 0 / 0; elsewhere the plain derivative."""
    _, (a, b) = leaves(2)
    results = [sqrt(a * a + b * b) * a, absolute(a) * sqrt(absolute(a))]
    entries = [e for row in jacobian.jacobian(results, [a, b]) for e in row]
    assert evaluate(entries, {a: 0.0, b: 0.0}, FLOAT) == [0, 0, 0, 0]
    found = evaluate(entries, {a: 3.0, b: 4.0}, FLOAT)
    assert found == pytest.approx([5 + 9 / 5, 12 / 5, 1.5 * 3**0.5, 0], rel=1e-15)


def test_a_root_that_is_divided_by_anyway_is_not_guarded():
    _, (a, b) = leaves(2)
    length = sqrt(a * a + b * b)
    entries = jacobian.jacobian([a / length], [a])[0]
    assert "max" not in {node.operator for node in below(entries)}


def test_quadratic_drag_at_rest_has_a_finite_jacobian():
    machine = compile.machine_of(read(DRAG, "drag.yaml"))
    (found,) = table.select(compile.program(machine), machine, ["state_jacobian"]).functions
    given = {"time": [0.0], "state": [0.0] * 4, "parameters": [1.0, 2.0]}
    assert interpreter.run(found, given, FLOAT) == [0, 0, 1, 0, 0, 0, 0, 1, *[0] * 8]


DRAG = """
eom: 1
system: drag
space: plane
gravity: 0
parameters: {m: 1, c: 2}
coordinates: {x: "", y: ""}
points: {"\u03b1": [x, y], "\u03b2": [x, 0]}
bodies: {ball: {mass: m, at: [x, y]}}
forces:
  - {on: ball, force: [-c*sqrt(x'^2 + y'^2)*x', -c*sqrt(x'^2 + y'^2)*y']}
"""


def test_greek_places_have_functions_of_their_own():
    machine = compile.machine_of(read(DRAG, "drag.yaml"))
    names = ["position_of:\u03b1", "position_of:\u03b2"]
    found = table.select(compile.program(machine), machine, names).functions
    assert [f.name for f in found] == ["position_of_u03b1", "position_of_u03b2"]


def test_a_scene_that_is_solved_in_a_loop_has_all_columns_from_one_factorisation():
    case, (given, *_) = "long_chain", states("long_chain")
    found = function(case, "state_jacobian")
    (columns,) = [s for s in found.statements if isinstance(s, Solve)]
    assert len(columns.right) == columns.size * 2 * columns.size
    expected = slopes(case, "state_derivative", given, "state")
    assert difference(value(case, "state_jacobian", given), expected) < 1e-20


def test_differentiating_the_inverse_dynamics_costs_less_than_the_solution():
    scene = Motion(compile.machine_of(read(arm(4), "arm.yaml")))
    rows, _ = sensitivity.accelerations(scene, scene.state)
    direct = jacobian.jacobian(scene.machine.solution[0], scene.state)
    assert operations(sum(rows, [])) < 0.9 * operations(sum(direct, []))


# ---- what can be asked for


def select(case, *names):
    return table.select(written(case), compiled(case), names).functions


def test_the_functions_are_those_asked_for_in_that_order_each_once():
    names = ("energy", "position_of:fore", "inverse_dynamics", "energy", "standard")
    found = [f.name for f in select("skew_arm", *names)]
    standard = [f.name for f in written("skew_arm").functions if f.name != "energy"]
    assert found == ["energy", "position_of_fore", "inverse_dynamics", *standard]


def test_the_mass_matrix_of_a_large_scene_is_there_when_asked_for(monkeypatch):
    machine = compile.machine_of(model_of("double_pendulum"))
    expected = compile.program(machine).function("mass_matrix")
    monkeypatch.setattr(compile, "LARGEST_MATRIX", 1)
    small = compile.program(machine)
    assert "mass_matrix" not in [f.name for f in small.functions]
    (found,) = table.select(small, machine, ["mass_matrix"]).functions
    assert found == expected


def test_every_row_says_what_it_is():
    for name in (*table.ROWS, "position_of:fore", "velocity_of:fore", "jacobian_of:fore"):
        (found,) = select("skew_arm", name)
        assert found.name == name.replace(":", "_")
        assert found.about
    assert all(line in table.listing() for line in (*table.ROWS, "jacobian_of:POINT", "standard"))


MISTAKES = (
    ("skew_arm", "state_jacobain", "unknown function 'state_jacobain'; did you mean 'state_jac"),
    ("skew_arm", "", "unknown function ''; there are standard, mass_matrix,"),
    ("skew_arm", "position_of", "unknown function 'position_of'"),
    ("skew_arm", "regressor:fore", "unknown function 'regressor:fore'"),
    ("skew_arm", "position_of:q_1", "no point or body 'q_1'; there are upper, fore"),
    ("skew_arm", "velocity_of:", "no point or body ''"),
    ("double_pendulum", "input_jacobian", "input_jacobian: the spec has no inputs"),
    ("four_bar", "base_regressor", "use --formulation minimal or nullspace"),
    ("skew_arm", "x" * 1000, f"unknown function '{'x' * 60}'; there are"),
)


@pytest.mark.parametrize(("case", "name", "words"), MISTAKES)
def test_a_function_that_is_not_there_is_refused(case, name, words):
    with pytest.raises(UsageError, match=re.escape(words)):
        select(case, name)


@pytest.mark.parametrize("case", ["four_bar", "rolling_disc_tilting"])
def test_stabilised_rows_are_in_the_jacobian(case):
    """Off the constraints, where Baumgarte's terms act."""
    scene = study_of(case).links.scene
    machine = formulation.choose(scene, wanted("auto", "2", "0.01")).machine
    program = compile.program(machine)
    (found,) = table.select(program, machine, ["state_jacobian"]).functions
    drawn = samples.draw(machine.model, 1).arguments()
    given = {name: [PRECISE.number(v) for (v,) in columns] for name, columns in drawn.items()}

    def at(index, move):
        state = [v + move * (i == index) for i, v in enumerate(given["state"])]
        whole = {**given, "state": state}
        results = interpreter.run(program.function("state_derivative"), whole, PRECISE)
        return np.array(results, dtype=object)

    size = range(len(given["state"]))
    expected = [(at(i, STEP) - at(i, -STEP)) / (2 * STEP) for i in size]
    values = np.reshape(interpreter.run(found, given, PRECISE), found.shape)
    assert difference(values, np.array(expected, dtype=object).T) < 1e-20
