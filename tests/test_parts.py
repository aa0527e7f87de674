"""Long functions in parts: the same bits, the same statuses, in one state and in batches."""

import ctypes
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from programs import PROGRAMS, arguments
from scenes import program_of
from tools import tool

from eomgen.errors import CheckError
from eomgen.interpreter import FLOAT, call
from eomgen.numerics.compiled import build
from eomgen.program import IN_MOTION, Assign, Value, operands
from eomgen.render import code_context
from eomgen.render.code_context import Code, Style, coded
from eomgen.render.lanes import ROWS
from eomgen.render.lowered import content, lowered
from eomgen.render.parts import divided
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment

SCENES = ("skew_arm", "cart_three_pendulums", "four_bar", "block_with_friction", "sprung_pair")
QUICK = ("cart_three_pendulums", "sprung_pair")


def each(limits):
    """A test for each scene and limit; the spatial arm is quick with one limit only."""
    cases = [(name, limit) for name in SCENES for limit in limits]
    slow = [n not in QUICK and (n, m) != ("skew_arm", limits[0]) for n, m in cases]
    return pytest.mark.parametrize(
        ("name", "limit"),
        [
            pytest.param(*case, marks=pytest.mark.slow if is_slow else ())
            for case, is_slow in zip(cases, slow, strict=True)
        ],
    )


ONE_PIECE = 10**6
COUNTS = (1, 31, 32, 33, 70)


@cache
def built(name, **style):
    """The C of a program as it is shipped, compiled."""
    tool("cc")
    code = coded(source(name), Style(**style))
    return build(render(code, TARGETS["c"], environment()), code.program)


def source(name):
    return PROGRAMS[name] if name in PROGRAMS else program_of(name)


def drawn(program, count=1):
    """Random time, states, inputs (a column each) and parameters; those of the spec if it can."""
    columns = [arguments(program, seed) for seed in range(count)]
    states, inputs = (np.array([c[i] for c in columns]).T.reshape(-1, count) for i in (1, 2))
    values = [
        v if p.value is None else float(p.value)
        for p, v in zip(program.parameters, columns[0][3], strict=True)
    ]
    return 0.3, states, inputs, values


def rows(function, states, inputs):
    """What differs between states; the states serve as accelerations too."""
    moving = (states[: len(states) // 2],) if function.arguments == IN_MOTION else ()
    return (states, *moving, inputs)


def alone(compiled, function, given, k=0):
    """The results at one of the states."""
    t, states, inputs, parameters = given
    columns = [row[:, k] for row in rows(function, states, inputs)]
    return compiled.call(function.name, t, *columns, parameters)


def computed(compiled, function, given):
    """The results, or the words of the error."""
    try:
        return alone(compiled, function, given).tobytes()
    except CheckError as error:
        return str(error)


@each((40, 7, 2))
def test_parts_compute_the_same_bits(name, limit):
    program = program_of(name)
    whole, parts = built(name, longest=ONE_PIECE), built(name, longest=limit)
    given = drawn(program)
    for function in program.functions:
        assert computed(parts, function, given) == computed(whole, function, given)


@pytest.mark.parametrize("name", PROGRAMS)
def test_parts_of_programs_written_by_hand(name):
    program = PROGRAMS[name]
    whole, parts = built(name, longest=ONE_PIECE), built(name, longest=2)
    given = drawn(program)
    for function in program.functions:
        assert computed(parts, function, given) == computed(whole, function, given)


@pytest.mark.parametrize("limit", [2, 10, 50])
def test_slots_carry_what_later_parts_read(limit):
    """Each part reads only what it computes, or what a slot still holds."""
    found = lowered(program_of("skew_arm").function("state_derivative"))
    function, cut = found.function, divided(found, limit)
    assert sum((p.statements for p in cut.parts), ()) == function.statements
    assert max(len(p.statements) for p in cut.parts) <= limit
    held, results = {}, {}
    for part in cut.parts:
        known = {Value(name) for name, slot in part.loads if held[slot] == Value(name)}
        assert len(known) == len(part.loads)
        for statement in part.statements:
            assert {Value(name) for name in content(operands(statement)).values} <= known
            known |= {Value(statement.name)} if isinstance(statement, Assign) else set()
        for expression, slot in part.stores:
            assert {Value(name) for name in content((expression,)).values} <= known
            (results if slot < len(function.results) else held)[slot] = expression
    assert tuple(results[i] for i in range(len(results))) == function.results
    live = {slot for slot in held}
    assert cut.slots == len(results) + len(live)
    assert len(live) < sum(len(p.stores) for p in cut.parts) - len(results)  # slots serve again


def test_a_short_function_is_in_one_piece():
    found = lowered(program_of("simple_pendulum").function("energy"))
    assert divided(found, len(found.function.statements)) is None


def test_a_singular_pivot_in_any_part_writes_nothing():
    compiled = built("slider_pendulum", longest=2)
    call_ = compiled.library.slider_pendulum_accelerations
    call_.argtypes = [ctypes.c_double, *[ctypes.c_void_p] * 4]
    for parameters in ([2.0, 0.0, 0.8, 120.0, 9.81], [-2.0, 0.5, 0.8, 120.0, 9.81]):
        doubles = [(ctypes.c_double * len(v))(*v) for v in ([0.0] * 4, [0], parameters, [7, 7])]
        assert call_(0.0, *doubles) == 1
        assert list(doubles[-1]) == [7, 7]


def test_results_may_overlap_the_state_in_parts_too():
    name = "slider_pendulum"
    program = PROGRAMS[name]
    compiled = built(name, longest=2)
    t, states, inputs, parameters = drawn(program)
    expected = compiled.call("state_derivative", t, states[:, 0], inputs[:, 0], parameters)
    shared, given, p = (
        (ctypes.c_double * len(v))(*v) for v in (states[:, 0], inputs[:, 0], parameters)
    )
    call_ = compiled.library.slider_pendulum_state_derivative
    call_.argtypes = [ctypes.c_double, *[ctypes.c_void_p] * 4]
    assert call_(t, shared, given, p, shared) == 0
    assert list(shared) == expected.tolist()


@pytest.mark.parametrize("limit", [40, ONE_PIECE])
def test_the_state_derivative_calls_the_accelerations(limit, monkeypatch):
    monkeypatch.setattr(code_context, "C", replace(code_context.C, repeated=20))
    made = coded(program_of("skew_arm"), Style(longest=limit))
    source_ = render(made, TARGETS["c"], environment())["skew_arm.c"]
    call_ = "skew_arm_prepared_accelerations(t, state, inputs, m, &result["
    assert source_.count(call_) == 1
    assert source_.count("part_1_of_accelerations(") == (2 if limit == 40 else 0)  # and its caller
    assert "part_1_of_state_derivative(" not in source_


def test_a_short_state_derivative_calls_nothing():
    made = coded(program_of("sprung_pair"))
    source_ = render(made, TARGETS["c"], environment())["sprung_pair.c"]
    assert "&result[" not in source_


def test_prepare_keeps_no_constant_elsewhere():
    """Its parts write the model; their slots hold only what crosses."""
    made = coded(program_of("skew_arm"), Style(longest=40))
    found = lowered(made.program.prepare)
    cut = divided(found, 40, at_once=True)
    given = [pair for part in cut.parts for pair in part.results]
    assert sorted(number for _, number in given) == list(range(len(made.program.prepare.results)))
    assert all(isinstance(value, Value) for part in cut.parts for value, _ in part.stores)
    assert cut.slots < divided(found, 40).slots - len(given) + 1


@each((ONE_PIECE,))
def test_both_forms_are_the_same_bits(name, limit):
    program = program_of(name)
    compiled, given = built(name, longest=limit), drawn(program)
    t, states, inputs, parameters = given
    model = compiled.model(parameters)
    for function in program.functions:
        size = int(np.prod(function.shape))
        state, given_, result = (
            (ctypes.c_double * (len(v) or 1))(*v)
            for v in (states[:, 0], inputs[:, 0], [0.0] * size)
        )
        symbol = compiled.library[f"{name}_prepared_{function.name}"]
        symbol.argtypes = [ctypes.c_double, *[ctypes.c_void_p] * 4]
        status = symbol(t, state, given_, model, result)
        simple = computed(compiled, function, given)
        assert simple == (bytes(result)[: 8 * size] if status == 0 else simple)
        assert (status != 0) == isinstance(simple, str)


@each((ONE_PIECE, 40))
def test_a_batch_is_its_states_one_by_one(name, limit):
    program = program_of(name)
    compiled = built(name, batch=True, longest=limit)
    for count in COUNTS:
        t, states, inputs, parameters = drawn(program, count)
        model = compiled.model(parameters)
        for function in program.functions:
            columns = rows(function, states, inputs)
            found, status = compiled.batch(function.name, t, *columns, model=model)
            failed = 0
            for k in range(count):
                try:
                    one = alone(compiled, function, (t, states, inputs, parameters), k)
                except CheckError:
                    failed = 1
                    assert np.isnan(found[:, k]).all()
                    continue
                size = np.abs(one).max(initial=1.0)
                np.testing.assert_allclose(found[:, k], one.ravel(), rtol=1e-11, atol=1e-12 * size)
            assert status == failed


@pytest.mark.parametrize("name", PROGRAMS)
def test_batches_of_programs_written_by_hand(name):
    program = PROGRAMS[name]
    compiled = built(name, batch=True)
    t, states, inputs, parameters = drawn(program, 40)
    model = compiled.model(parameters)
    named = {"time": [t], "parameters": parameters}
    for function in program.functions:
        columns = rows(function, states, inputs)
        found, status = compiled.batch(function.name, t, *columns, model=model)
        assert status == 0
        for k in range(40):
            taken = [a for a in function.arguments if a in ROWS]
            given = named | {a: c[:, k] for a, c in zip(taken, columns, strict=True)}
            expected = call(program, function.name, given, FLOAT)
            np.testing.assert_allclose(found[:, k], expected, rtol=1e-12, atol=1e-13)


def test_a_batch_names_the_states_that_fail():
    """The slider's pivot vanishes with its mass where the bob hangs straight down."""
    compiled = built("slider_pendulum", batch=True)
    states = np.zeros((4, 40))
    states[1] = 0.5
    states[1, [3, 35]] = 0.0
    model = compiled.model([1e-17, 0.5, 0.8, 120.0, 9.81])
    found, status = compiled.batch("accelerations", 0.0, states, np.zeros((1, 40)), model=model)
    assert status == 1
    assert np.isnan(found).all(axis=0).nonzero()[0].tolist() == [3, 35]
    assert np.isfinite(np.delete(found, [3, 35], axis=1)).all()


@pytest.mark.parametrize("far", [1.0000001e5, 1e9, 1e300])
def test_an_angle_out_of_range_is_right_in_a_batch(far):
    name = "slider_pendulum"
    program = PROGRAMS[name]
    compiled = built(name, batch=True)
    t, states, inputs, parameters = drawn(program, 33)
    states[1, 7] = far
    states[1, 32] = -far
    found, status = compiled.batch("outputs", t, states, inputs, model=compiled.model(parameters))
    assert status == 0
    for k in range(33):
        one = compiled.call("outputs", t, states[:, k], inputs[:, k], parameters)
        np.testing.assert_allclose(found[:, k], one, rtol=1e-15)


def test_an_unprepared_program_renders_too():
    name = "double_pendulum"
    program = program_of(name)
    plain = build(render(Code(program), TARGETS["c"], environment()), program)
    given = drawn(program)
    for function in program.functions:
        np.testing.assert_allclose(
            np.frombuffer(computed(plain, function, given)),
            np.frombuffer(computed(built(name), function, given)),
            rtol=1e-13,
        )
