"""Functions for many states: the order of their statements, their loops, what these read."""

from fractions import Fraction
from math import cos

import numpy as np
import pytest
from programs import div, n, op, program
from scenes import program_of
from tools import tool

from eomgen.numerics.compiled import build
from eomgen.program import Apply, Assign, Function, Read, RequirePositive, Value, Variable, operands
from eomgen.render.code_context import Code, Style, coded
from eomgen.render.lanes import OF_A_CHAIN, Load, Store, in_place, longest_body, waves, without
from eomgen.render.lowered import content, defined, lowered
from eomgen.render.pairs import groups
from eomgen.render.parts import divided, whole
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
