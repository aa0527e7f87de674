"""`check --precision`: what is measured, at which states, and how it is said."""

import json
import random
from decimal import Decimal

import mpmath
import numpy as np
import pytest
from click.testing import CliRunner
from graph_cases import coverage, state_leaves, uniform
from scenes import SHIPPED, study_of

from eomgen import interpreter, study
from eomgen.algebra import decimals, elementary, ldl
from eomgen.algebra.assemble import assemble
from eomgen.algebra.cancellation import Rule
from eomgen.algebra.derive import gradient
from eomgen.algebra.graph import Graph
from eomgen.cli import commands
from eomgen.errors import CheckError
from eomgen.interpreter import NUMPY, mpmath_arithmetic
from eomgen.numerics import compiled
from eomgen.precision import measure, show, statements, states
from eomgen.precision.errors import scales_of
from eomgen.precision.exact import Bench
from eomgen.precision.reach import Sweep, reach, seeds
from eomgen.precision.records import Sampled
from eomgen.program import Program, Value, Variable
from eomgen.render.code_context import coded

FIFTY = mpmath_arithmetic(50)
SPRING = """\
eom: 1
system: Mass on a spring in the plane
space: plane
parameters: {m: 2 kg, k: 1000 N/m, l_0: 0.5 m}
coordinates: {x: m, y: m}
points: {O: [0, 0], P: [x, y]}
bodies: {ball: {mass: m, at: P}}
springs: [{between: [O, P], stiffness: k, free_length: l_0}]
gravity: [0, 0]
range: {x: [0.30000 m, 0.30001 m], y: [0.40000 m, 0.40001 m]}
"""
HANGING = SPRING.replace("P: [x, y]", "P: [x, l_0 + y]").replace(
    "range: {x: [0.30000 m, 0.30001 m], y: [0.40000 m, 0.40001 m]}",
    "range: {x: [-0.00001 m, 0.00001 m], y: [-0.00001 m, 0.00001 m]}",
)


def studied(text, name="scene.yaml"):
    return study.of_text(text, name)


@pytest.fixture(scope="module")
def spring():
    """The measurement of the spring near its natural length."""
    return measure.of(studied(SPRING))


@pytest.fixture
def few(monkeypatch):
    monkeypatch.setattr(measure, "STATES", 30)


# fifty digits over arrays


def test_decimals_are_the_fifty_digits_of_mpmath():
    _, x, y = state_leaves()
    function = assemble("f", "", (2,), [coverage(x, y), x / y])
    points = uniform(5, 6)
    number = decimals.arithmetic(50)
    with number.quiet():
        columns = [decimals.exactly(np.array(c)) for c in zip(*points, strict=True)]
        found = interpreter.run(function, {"state": columns}, number)
    for index, point in enumerate(points):
        for one, other in zip(
            found, interpreter.run(function, {"state": point}, FIFTY), strict=True
        ):
            assert abs(FIFTY.number(str(one[index])) - other) < abs(other) * FIFTY.number("1e-45")


@pytest.mark.parametrize("operator", ["sqrt", "asin", "acos", "log"])
def test_what_is_not_real_is_no_number(operator):
    number = decimals.arithmetic(50)
    with number.quiet():
        found = number.functions[operator](np.array([Decimal(-2), Decimal("nan")], object))
    assert not any(v.is_finite() for v in found)


# states


def test_states_are_in_range_exact_in_float_and_the_same_each_time():
    scene = studied(SPRING)
    first, again = states.draw(scene, 50), states.draw(scene, 50)
    assert first.count == 50
    assert np.array_equal(first.state, again.state)
    assert np.array_equal(first.state, first.state.astype(np.float32))
    x, y = first.state[:2]
    assert np.ptp(x) > 0
    assert (abs(x - 0.300005) < 6e-6).all()
    assert (abs(y - 0.400005) < 6e-6).all()
    assert list(first.parameters) == [2, 1000, 0.5]


@pytest.mark.parametrize("name", ["slider_crank", "snakeboard", "bouncing_ball", "sleigh_speeds"])
def test_states_are_on_the_constraints(name):
    scene = study_of(name)
    drawn = states.draw(scene, 60)
    assert drawn.count == 60
    assert len(np.unique(drawn.state, axis=1)[0]) == 60
    for function in scene.program.functions:
        if function.name in ("constraint_residuals", "constraint_rates"):
            values = interpreter.run(function, drawn.columns(), NUMPY)
            assert max((abs(v).max() for v in values), default=0) < 1e-6
        if function.name == "gaps":
            assert min(np.min(v) for v in interpreter.run(function, drawn.columns(), NUMPY)) > -1e-7


def test_the_minimal_formulation_is_measured_over_its_own_coordinates():
    scene = study_of("block_on_incline")
    drawn = states.draw(scene, 20)
    assert len(drawn.state) == len(scene.program.coordinates) + len(scene.program.speeds)


# errors


def test_the_errors_are_those_of_the_c(spring):
    report = spring
    assert report.engine.startswith("C by ")
    assert report.sampled.count == 1000
    (row,) = (f for f in report.functions if f.name == "generalized_forces")
    assert row.spreads["float"].worst > 1e-3
    assert row.spreads["float"].worst > 1e6 * row.spreads["double"].worst
    assert row.condition > 1e4
    # the worst, by hand: Q = -k (r - l_0) (x, y)/r in fifty digits and in float
    at = row.spreads["float"].at
    x, y = (mpmath.mpf(float(v)) for v in report.sampled.state[:2, at])
    with mpmath.workdps(50):
        r = mpmath.sqrt(x * x + y * y)
        force = -1000 * (r - mpmath.mpf("0.5")) * x / r
    X, Y = (np.float32(v) for v in report.sampled.state[:2, at])
    R = np.sqrt(X * X + Y * Y)
    wrong = np.float32(-1000) * (R - np.float32(0.5)) * X / R
    scale = max(abs(float(force)), 1e-9)
    assert abs(float(wrong) - float(force)) / scale > row.spreads["float"].worst / 30


def test_the_statement_that_cancels_is_shown_as_it_stands(spring):
    worst = spring.statements[0]
    assert worst.amplification > 1e3
    assert "generalized_forces" in {n for s in spring.statements[:3] for n in s.functions}
    assert "l_0" in worst.source
    assert 0 <= worst.at < 1000
    text = measure.render(
        coded(studied(SPRING).program), measure.TARGETS["c"], measure.environment()
    )["scene.c"]
    line = text.splitlines()[worst.line - 1]
    assert line.split()[0] == worst.source.split()[0]


def test_a_spring_measured_from_its_natural_length_loses_nothing(few):
    report = measure.of(studied(HANGING))
    assert not report.warnings
    assert max(f.spreads["float"].worst for f in report.functions) < 2e-6


def test_float_that_is_not_enough_is_a_warning(spring):
    (warning,) = spring.warnings
    assert warning.startswith("W-F32: cond 1e+00 -> ")
    assert "float error of" in warning


def test_skew_axes_and_full_inertia(monkeypatch):
    monkeypatch.setattr(measure, "STATES", 100)
    report = measure.of(study_of("skew_arm"))
    assert {f.name for f in report.functions} >= {"mass_matrix", "bias", "accelerations", "energy"}
    for row in report.functions:
        assert row.states == 100
        assert 1e-9 < row.spreads["float"].worst < 1e-5
        assert 1e-18 < row.spreads["double"].worst < 1e-14
        assert row.spreads["float"].median <= row.spreads["float"].worst
    assert 1 < report.condition < 100
    assert not report.warnings


def test_a_linked_scene_with_reactions(monkeypatch):
    monkeypatch.setattr(measure, "STATES", 60)
    report = measure.of(study_of("four_bar"))
    rows = {f.name: f for f in report.functions}
    assert rows["constraint_residuals"].absolute
    assert rows["constraint_residuals"].spreads["double"].worst < 1e-15
    assert rows["accelerations"].spreads["float"].worst < 1e-4
    # what vanishes on the constraints is not among the worst
    assert not any("constraint" in n for n in report.statements[0].functions)


def test_without_a_compiler_the_interpreter_measures(monkeypatch):
    monkeypatch.setattr(measure, "STATES", 40)
    with_c = measure.of(study_of("skew_arm"))
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setattr(compiled, "COMPILERS", ())
    without = measure.of(study_of("skew_arm"))
    assert without.engine == "the interpreter in NumPy, as there is no C compiler"
    for one, other in zip(with_c.functions, without.functions, strict=True):
        for kind, spread in one.spreads.items():
            assert other.spreads[kind].worst == pytest.approx(spread.worst, rel=0.9)


def test_code_that_is_not_what_was_derived_is_a_defect(monkeypatch):
    from eomgen.algebra import cancellation

    wrong = Rule("", "", "", lambda scene, pair, at: pair.number * at)
    monkeypatch.setattr(cancellation, "RULES", (wrong,))
    with pytest.raises(CheckError, match="as it is written and as it was derived differ"):
        measure.of(study_of("elastic_pendulum"))


def test_a_large_scene_is_measured_at_fewer_states(monkeypatch):
    monkeypatch.setattr(measure, "AFFORDED", 30_000)
    report = measure.of(study_of("double_pendulum"))
    assert 50 <= report.sampled.count < 100
    assert f"at {report.sampled.count} states (of 1000 wanted)" in show.text(report)


# the pieces


def test_results_that_pass_zero_are_compared_with_their_usual_size():
    results = np.array([[1.0, -2.0, 1e-9], [0.0, 0.0, 1e-40]])
    scales = scales_of("f", results, 1e-30)
    assert scales[0].tolist() == [1.0, 2.0, 1.0]
    assert scales[1].tolist() == [1.0, 2.0, 1.0]
    assert (scales_of("constraint_rates", results, 1e-30) == 1).all()


def hand_made():
    """v = x y + y, w = v - y x; f = (w, v / x): w loses what v has more digits of."""
    graph = Graph()
    x, y = graph.read("state", 0), graph.read("state", 1)
    v = x * y + elementary.sin(y)
    results = [elementary.sqrt(v) - x, v / x, v * v]
    parts = (Variable("x"), Variable("y"))
    function = assemble("f", "", (3,), results)
    return Program("hand", "", "", "", parts, (), (), (), (), (function,)), results, (x, y), v


def sampled(*rows):
    state = np.array(rows, float)
    return Sampled(state.shape[1], np.zeros(state.shape[1]), state, np.zeros((0, 2)), np.zeros(0))


def test_adjoints_are_the_derivatives():
    program, results, leaves, v = hand_made()
    drawn = sampled([0.5, 1.5], [0.25, 2.0])
    traced = Bench(program, drawn).traced(program.functions[0])
    memory = interpreter.Memory(drawn.columns(), NUMPY)
    memory.values = dict(traced.values)
    scales = np.array([[2.0, 4.0], [1.0, 1.0], [3.0, 3.0]])
    adjoints = Sweep(memory).back(traced.function, seeds(scales))
    (name,) = (
        n for n in traced.values if np.allclose(traced.values[n], value_of(v, leaves, drawn))
    )
    slopes = [gradient(r, [v])[0] for r in results]
    given = np.array([value_of(s, leaves, drawn) for s in slopes])
    # three results: a sweep each
    assert np.allclose(adjoints[Value(name)], given / scales)
    assert np.allclose(reach(adjoints[Value(name)], 3), np.abs(given / scales).max(axis=0))


def value_of(node, leaves, drawn):
    from eomgen.algebra.arithmetic import evaluate

    return evaluate([node], dict(zip(leaves, drawn.state, strict=True)), NUMPY)[0]


def test_adjoints_go_through_a_system_solved_in_a_loop():
    graph = Graph()
    a, b = graph.read("state", 0), graph.read("state", 1)
    first, second = elementary.exp(a), elementary.exp(b)
    matrix = [[4 + first, second], [second, 3 + first * second]]
    (solution,) = ldl.solve_in_loop(matrix, [first * 2, second + 1])
    function = assemble("f", "", (2,), solution)
    state = [0.3, 0.7]
    memory = interpreter.Memory({"state": [np.array([v]) for v in state]}, NUMPY)
    for statement in function.statements:
        memory.execute(statement)
    memory.values = {n: np.atleast_1d(v) for n, v in memory.values.items()}
    adjoints = Sweep(memory).back(function, seeds(np.ones((2, 1))))
    for k, name in enumerate(n for n in memory.values if Value(n) in adjoints):
        step = 1e-6
        if not np.isclose(memory.values[name], np.exp(state[0])) and not np.isclose(
            memory.values[name], np.exp(state[1])
        ):
            continue
        index = int(np.isclose(memory.values[name], np.exp(state[1]))[0])
        sides = []
        for sign in (1, -1):
            moved = list(state)
            moved[index] = np.log(np.exp(state[index]) + sign * step)
            sides.append(np.array(interpreter.run(function, {"state": moved}, interpreter.FLOAT)))
        slope = (sides[0] - sides[1]) / (2 * step)
        assert np.allclose(adjoints[Value(name)][:, 0], slope, rtol=1e-6), k


def test_many_results_share_sweeps_of_random_signs():
    started = seeds(np.ones((50, 3)))
    assert {s.shape for s in started} == {(4, 1)} or {s.shape for s in started} == {(4, 3)}
    assert {abs(v) for s in started for v in s.ravel()} == {1.0}
    adjoint = np.array([[3.0], [-3.0], [3.0], [3.0]])
    assert reach(adjoint, 50) == pytest.approx([3.0])


def test_local_errors_are_not_inherited():
    program, *_ = hand_made()
    chance = random.Random(3)
    drawn = sampled(*[[float(np.float32(chance.uniform(1, 2))) for _ in range(2)] for _ in "xy"])
    report = statements._of_function
    traced = Bench(program, drawn).traced(program.functions[0])
    each = statements.Traced(traced, scales_of("f", traced.results, 1e-30))
    found = list(report(program, "f", each, (drawn, {})))
    assert [e.target for e in found][-3:] == ["result[0]", "result[1]", "result[2]"]
    assert all(e.worst < 2.0**-21 for e in found)


# the command line


def check(*words):
    return CliRunner().invoke(commands, ["check", *map(str, words)])


def test_the_table_follows_the_summary(few):
    said = check(SHIPPED["skew_arm"], "--precision")
    assert said.exit_code == 0
    lines = said.output.splitlines()
    plain = check(SHIPPED["skew_arm"]).output.splitlines()
    assert lines[: len(plain)] == plain
    assert lines[len(plain)].startswith("    precision: ")
    assert lines[len(plain)].endswith("against 50 digits at 30 states")
    (header,) = (line for line in lines if "double worst" in line)
    assert header.split() == [
        "function",
        "float",
        "worst",
        "median",
        "double",
        "worst",
        "median",
        "condition",
    ]
    assert "    largest local errors in float, lines of skew_arm.c" in lines
    assert sum(line.strip().startswith("at q_1 = ") for line in lines) >= 5


def test_as_json(few):
    found = json.loads(check(SHIPPED["skew_arm"], "--precision", "--format", "json").output)
    assert found["degrees_of_freedom"] == 2
    measured = found["precision"]
    assert measured["states"] == 30
    assert len(measured["statements"]) == 10
    worst = measured["statements"][0]
    assert worst["source"].endswith(";")
    assert set(worst["at"]) == {"q_1", "q_2", "q_1'", "q_2'", "tau_1", "tau_2"}
    by_name = {f["name"]: f for f in measured["functions"]}
    assert by_name["energy"]["float"]["worst"] > by_name["energy"]["double"]["worst"]


def test_a_warning_is_no_failure(few, tmp_path):
    path = tmp_path / "scene.yaml"
    path.write_text(SPRING, encoding="utf-8")
    said = check(path, "--precision")
    assert said.exit_code == 0
    assert said.output.splitlines()[-1].startswith("    W-F32: cond 1e+00 -> ")
    noted = check(path, "--precision", "--format", "github").output.splitlines()
    assert noted[0].startswith("::notice file=")
    assert noted[1].startswith(f"::warning file={path}::W-F32: ".replace(":", "%3A", 0))


def test_several_specs_and_a_wrong_one(few, tmp_path):
    path = tmp_path / "bad.yaml"
    path.write_text(SPRING.replace("mass: m", "mas: m"), encoding="utf-8")
    said = check(SHIPPED["simple_pendulum"], path, "--precision")
    assert said.exit_code == 2
    assert "precision: " in said.output


@pytest.mark.parametrize("flags", [["--precision=yes"], ["--precison"], ["--precision", "--fast"]])
def test_bad_flags(flags):
    assert check(SHIPPED["simple_pendulum"], *flags).exit_code == 2


@pytest.mark.slow
@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_scene_is_measured(name, monkeypatch):
    monkeypatch.setattr(measure, "STATES", 100)
    report = measure.of(study_of(name))
    assert report.sampled.count >= 50
    for row in report.functions:
        assert row.spreads["double"].worst < 1e-6  # near a dead point all is lost
        assert row.spreads["double"].median < 1e-9
    assert report.statements or not report.functions
    assert show.json_of(report)["states"] == report.sampled.count
