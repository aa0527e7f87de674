"""Functions for many states: the order of their statements, their loops, what these read."""

from fractions import Fraction
from math import cos

import numpy as np
import pytest
from programs import div, n, op, program
from scenes import program_of
from tools import tool

from eomgen.numerics.compiled import build
from eomgen.program import (
    Apply,
    Assign,
    Function,
    Read,
    RequirePositive,
    Solve,
    Value,
    Variable,
    operands,
)
from eomgen.render.code_context import Code, Style, coded
from eomgen.render.lanes import OF_A_CHAIN, Load, Store, in_place, longest_body, waves, without
from eomgen.render.lowered import content, defined, lowered
from eomgen.render.pairs import groups
from eomgen.render.parts import LARGEST_SYSTEM, divided, whole
from eomgen.render.sparing import sparing
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment

SCENES = ("skew_arm", "cart_three_pendulums", "four_bar")


def found_of(name):
    return lowered(coded(program_of(name), Style(batch=True)).program.function("accelerations"))


def most_alive(function):
    """The largest number of values that wait for somebody to read them."""
    last = {}
    steps = [(defined(s), operands(s)) for s in function.statements] + [((), function.results)]
    for i, (_, read) in enumerate(steps):
        last |= dict.fromkeys(content(read).values, i)
    alive, most = set(), 0
    for i, (made, _) in enumerate(steps):
        alive = {v for v in alive | {*made} if last.get(v, -1) > i}
        most = max(most, len(alive))
    return most


@pytest.mark.parametrize("name", SCENES)
def test_the_sparing_order_computes_the_same(name):
    found = found_of(name)
    made = sparing(found)
    assert sorted(map(repr, made.function.statements)) == sorted(
        map(repr, found.function.statements)
    )
    assert made.function.results == found.function.results
    known = set()
    for statement, inside in zip(made.function.statements, made.contents, strict=True):
        assert {*inside.values} <= known
        assert content(operands(statement)) == inside
        known |= {*defined(statement)}
    pairs = {g for g in groups(found.function.statements) if len(g) == 2}
    assert pairs == {g for g in groups(made.function.statements) if len(g) == 2}


@pytest.mark.parametrize("name", ["skew_arm", "cart_three_pendulums"])
def test_the_sparing_order_keeps_fewer_values_alive(name):
    found = found_of(name)
    first = waves(found)
    rest = without(found, first)
    assert most_alive(sparing(rest).function) < most_alive(rest.function)


def played(part, held):
    """The names and arguments that a part knows at its end; everything is there when it is read.

    held: what the slots hold, which the part adds to.
    """
    slots = {name: slot for name, slot in part.loads}
    known = set()

    def needs(expressions):
        inside = content(expressions)
        assert {*inside.values, *inside.reads} <= known

    for event in in_place(part):
        match event:
            case Load(place):
                assert place not in known
                assert isinstance(place, Read) or held[slots[place]] == Value(place)
                known.add(place)
            case Store(tree, slot):
                needs((tree,))
                held[slot] = tree
            case group:
                needs([e for s in group for e in operands(s)])
                known |= {name for s in group for name in defined(s)}
    return known


@pytest.mark.parametrize("limit", [10**6, 50, 10, 2])
@pytest.mark.parametrize("name", SCENES)
def test_every_part_reads_and_writes_in_place(name, limit):
    """Played with an array of slots: what is loaded was stored there by name, and nothing else."""
    found = found_of(name)
    rest = sparing(without(found, waves(found)))
    cut = divided(rest, limit, in_place=True)
    held = {}
    for part in (whole(rest),) if cut is None else cut.parts:
        assert {n for s in part.statements for n in defined(s)} <= played(part, held)
    results = rest.function.results
    assert tuple(held[i] for i in range(len(results))) == results


def test_waves_of_arguments_come_first_and_no_other():
    found = found_of("skew_arm")
    first = waves(found)
    assert first
    assert all(w.kind == "pair" for w in first)
    assert [w.slot for w in first] == list(range(0, 2 * len(first), 2))
    rest = without(found, first).function
    for statement in rest.statements:
        match statement:
            case Assign(_, Apply("sin" | "cos", (Read("state"),))):
                pytest.fail("a wave was left behind")


def test_loops_are_short_where_the_lanes_would_wait_for_a_chain():
    chain, broad = (found_of(name) for name in ("cart_three_pendulums", "skew_arm"))
    assert longest_body(broad, 1000) == 1000
    angle = Read("state", 0)
    statements = [Assign("v0", div(n(1), angle))]
    statements += [Assign(f"v{i}", div(n(1), Value(f"v{i - 1}"))) for i in range(1, 100)]
    waiting = Function("outputs", "", (1,), tuple(statements), (Value("v99"),))
    assert longest_body(lowered(waiting), 1000) == OF_A_CHAIN
    assert longest_body(lowered(waiting), 7) == 7
    assert longest_body(chain, 1000) in (OF_A_CHAIN, 1000)


def system(names, scale, right, of="sin"):
    """A matrix with `scale` on its diagonal, at every state another one."""
    size = len(names)
    q = [Read("state", i) for i in range(size)]
    rows = [[op(of, q[j]) for j in range(i)] + [op("add", scale, q[i])] for i in range(size)]
    return Solve(tuple(names), tuple(e for row in rows for e in row), tuple(right))


def two_systems(size, of="sin"):
    """The second has what the first has given, and two right sides; values cross both."""
    q = [Read("state", i) for i in range(size)]
    first, second = [f"x{i}" for i in range(size)], [f"y{i}" for i in range(2 * size)]
    right = [*map(Value, reversed(first)), *(op("multiply", Value("a"), x) for x in q)]
    statements = (
        Assign("a", op("exp", q[0])),
        system(first, n(9), [op("add", Value("a"), x) for x in q], of),
        Assign("b", op("multiply", Value("a"), Value("x1"))),
        Solve(tuple(second), system(second[:size], n(7), (), of).matrix, tuple(right)),
        Assign("c", op("add", Value("b"), Value("y0"))),
    )
    results = (Value("c"), Value("a"), *map(Value, second[2:]), Value("x2"), q[1])
    function = Function("outputs", "", (len(results),), statements, results)
    names = [Variable(f"q{i}") for i in range(size)]
    return program("two", (function,), coordinates=tuple(names), speeds=tuple(names))


@pytest.mark.parametrize("limit", [10**6, 2, 1])
def test_systems_are_solved_between_parts(limit):
    """Every entry stands in its slot when its part ends, and what is solved behind it."""
    size = 4
    rest = sparing(lowered(two_systems(size).functions[0]))
    cut = divided(rest, limit, in_place=True)
    solves = [s for s in rest.function.statements if isinstance(s, Solve)]
    held = {}
    for part in cut.parts:
        assert not any(isinstance(s, Solve) for s in part.statements)
        played(part, held)
        if part.elimination:
            solve, found = solves.pop(0), part.elimination
            entries = [*range(found.matrix, found.right + len(solve.right))]
            assert [held[slot] for slot in entries] == [*solve.matrix, *solve.right]
            held |= {found.right + k: Value(name) for k, name in enumerate(solve.names)}
    assert not solves
    results = rest.function.results
    assert tuple(held[i] for i in range(len(results))) == results


def test_what_is_too_large_for_a_stack_is_solved_lane_by_lane():
    size = LARGEST_SYSTEM + 1
    assert divided(lowered(two_systems(size).functions[0]), 10**6, in_place=True) is None


@pytest.mark.parametrize("of", [np.sin, np.abs])  # without a wave the helpers are fewer
@pytest.mark.parametrize("style", [Style(batch=True), Style(batch=True, longest=2)])
def test_systems_of_many_states_give_what_each_gives_alone(style, of):
    tool("cc")
    made = two_systems(13, "sin" if of is np.sin else "abs")
    files = render(coded(made, style), TARGETS["c"], environment())
    assert "bad |= lanes_solve_13(" in files["two.c"]
    library = build(files, made)
    states = np.random.default_rng(1).uniform(-0.4, 0.4, (26, 41))  # diagonally dominant
    states[5, 7] = -20.0  # not positive there
    found, status = library.batch(
        "outputs", 0.0, states, np.zeros((0, 41)), model=library.model(())
    )
    assert status == 1
    for k, state in enumerate(states.T):
        if k == 7:
            assert np.isnan(found[:, k]).all()
            continue
        np.testing.assert_allclose(found[:, k], _alone(state[:13], of), rtol=1e-12)


def _alone(q, of):
    """The results of `two_systems` by NumPy."""
    size = len(q)
    lower = np.tril(np.tile(of(q), (size, 1)), -1)
    full = lower + lower.T + np.diag(q)
    a = np.exp(q[0])
    x = np.linalg.solve(full + 9 * np.eye(size), a + q)
    y = np.linalg.solve(full + 7 * np.eye(size), np.column_stack([x[::-1], a * q])).T.ravel()
    return np.array([a * x[1] + y[0], a, *y[2:], x[2], q[1]])


def test_a_pivot_may_be_a_wave():
    tool("cc")
    x, pivot = Read("state", 0), Value("c")
    statements = (Assign("c", op("cos", x)), RequirePositive(pivot, n(1)))
    function = Function("outputs", "1 / cos", (1,), statements, (div(n(Fraction(1)), pivot),))
    made = program("pivoted", (function,), coordinates=(Variable("x"),), speeds=(Variable("y"),))
    library = build(render(Code(made, Style(batch=True)), TARGETS["c"], environment()), made)
    angles = np.array([0.3, 2.0, -1.0])
    found, status = library.batch(
        "outputs", 0.0, np.array([angles, angles]), np.zeros((0, 3)), model=library.model(())
    )
    assert status == 1
    np.testing.assert_allclose(found[0], [1 / cos(0.3), np.nan, 1 / cos(-1.0)], rtol=1e-15)
