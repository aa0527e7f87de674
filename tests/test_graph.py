import os
import subprocess
import sys
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from graph_cases import coverage, example, state_leaves, uniform
from hypothesis import given, settings
from hypothesis import strategies as st

from eomgen.algebra import elementary as g
from eomgen.algebra.arithmetic import (
    EXACT,
    FLOAT,
    NUMPY,
    NotExact,
    evaluate,
    mpmath_arithmetic,
    over,
)
from eomgen.algebra.closed import ClosedForm
from eomgen.algebra.elementary import BUILD
from eomgen.algebra.graph import Graph
from eomgen.algebra.walk import below
from eomgen.program import OPERATORS


@pytest.fixture
def leaves():
    return state_leaves()


def test_equal_values_are_one_node(leaves):
    graph, x, y = leaves
    assert x + y is y + x
    assert x * y is y * x
    assert g.minimum(x, y) is g.minimum(y, x)
    assert graph.read("state", 0) is x
    assert graph.number(Fraction(4, 2)) is graph.number(2)
    assert x - y is not y - x


def test_folding(leaves):
    graph, x, y = leaves
    zero, one, half, negative = graph.zero, graph.one, Fraction(1, 2), -x
    for left, right in [
        (x + 0, x), (0 + x, x), (x * 0, zero), (1 * x, x), (x - x, zero), (-negative, x),
        (x / 1, x),         (x**0, one), (x**1, x), (x**2, x * x), (x**5, x * ((x * x) * (x * x))),
        (x**-2, 1 / (x * x)), (x * (1 / x), one), ((y / x) * x, y),
        (x + (-x), zero), (x + (-1) * y, x - y), (x - (-1) * y, x + y), (-(x - y), y - x),
        (2 * (3 * x), 6 * x), ((2 * x) * (3 * y), 6 * (x * y)), ((-x) * y, -(x * y)),
        ((-x) * (-y), x * y), ((-x) / (-y), x / y), (x / 4, Fraction(1, 4) * x), (0 / x, zero),
        (x / x, one), (1 / (4 * x), Fraction(1, 4) / x), (2 * (half / x), 1 / x),
        (x + x, 2 * x), (x + 2 * x, 3 * x), (3 * x - x, 2 * x), (2 * x - 2 * x, zero),
        ((x + y) - y, x), (x + (y - x), y), ((x - y) - x, -y), (x - (x - y), y), (x - (y + x), -y),
        ((x * g.sin(y)) ** 2 + (x * g.cos(y)) ** 2, x * x),
        (3 * g.cos(x) ** 2 + 3 * g.sin(x) ** 2, graph.number(3)),
        (x + 1 - 1, x), (3 - x + 4, 7 - x), (x - 2 + 5, x + 3), (5 - (2 - x), x + 3),
        (graph.number(7) * half - 3, graph.number(half)),
        (g.sin(zero), zero), (g.cos(zero), one), (g.sin(-x), -g.sin(x)), (g.cos(-x), g.cos(x)),
        (g.sqrt(zero), zero), (g.sqrt(graph.number(Fraction(9, 4))), graph.number(Fraction(3, 2))),
        (g.sqrt(x) * g.sqrt(x), x), (x**half, g.sqrt(x)), (x ** Fraction(-1, 2), 1 / g.sqrt(x)),
        (x ** Fraction(3, 2), x * g.sqrt(x)), (graph.number(2) ** 10, graph.number(1024)),
        (g.absolute(graph.number(-3)), graph.number(3)),
        (g.sign(graph.number(-3)), graph.number(-1)),
        (g.minimum(one, zero), zero), (g.maximum(x, x), x), (g.exp(zero), one), (g.log(one), zero),
        (g.atan2(zero, one), zero), (g.acos(one), zero),
    ]:  # fmt: skip
        assert left is right, (left, right)


def test_products_are_not_taken_apart(leaves):
    _, x, y = leaves
    half_length, square = Fraction(1, 2) * x, y * y
    assert set((half_length * square).operands) == {half_length, square}
    assert set(((x + y) * (x - y)).operands) == {x + y, x - y}


def test_sine_and_cosine_of_parts_of_a_turn(leaves):
    graph, _, _ = leaves
    for k in range(-24, 25):
        angle = Fraction(k, 12) * graph.pi()
        for name in ("sin", "cos"):
            node = BUILD[name](angle)
            (value,) = evaluate([node], {}, FLOAT)
            assert value == pytest.approx(
                float(getattr(mpmath, name)(mpmath.pi * k / 12)), abs=1e-15
            )
            exact = round(2 * value, 12) in (-2, -1, 0, 1, 2)
            assert (node.operator == "number") == exact


def test_what_has_no_exact_number_is_not_folded(leaves):
    graph, x, _ = leaves
    for node in [g.sqrt(graph.number(2)), g.sqrt(graph.number(-4)), g.sin(graph.one), graph.pi()]:
        assert node.operator != "number"
    assert (x ** Fraction(1, 3)).operator == (x**100).operator == (2**x).operator == "power"
    with pytest.raises(TypeError, match=r"0\.5 is not an exact number"):
        x + 0.5
    with pytest.raises(ZeroDivisionError):
        x / 0


NUMBERS = st.fractions(min_value=-3, max_value=3, max_denominator=4)
TREES = st.recursive(
    st.one_of(NUMBERS, st.sampled_from(["x", "y"])),
    lambda inner: st.tuples(
        st.sampled_from(["add", "subtract", "multiply", "divide", "negate", "min", "max", "abs"]),
        inner,
        inner,
    ),
    max_leaves=25,
)


def _node(graph, tree):
    if isinstance(tree, Fraction):
        return graph.number(tree)
    if isinstance(tree, str):
        return graph.read("state", "xy".index(tree))
    name, *operands = tree
    return BUILD[name](*[_node(graph, a) for a in operands[: OPERATORS[name]]])


def _exact(tree, values):
    if isinstance(tree, Fraction):
        return tree
    if isinstance(tree, str):
        return values[tree]
    name, *operands = tree
    return EXACT.functions[name](*[_exact(a, values) for a in operands[: OPERATORS[name]]])


@settings(max_examples=400, deadline=None, derandomize=True)
@given(TREES, NUMBERS, NUMBERS)
def test_folding_never_changes_an_exact_value(tree, x, y):
    graph = Graph()
    leaves = {graph.read("state", 0): x, graph.read("state", 1): y}
    try:
        expected = _exact(tree, {"x": x, "y": y})
        node = _node(graph, tree)
    except ZeroDivisionError:
        return
    assert evaluate([node], leaves, EXACT) == [expected]


def test_a_coverage_expression_uses_every_operator(leaves):
    _, x, y = leaves
    assert {*OPERATORS} <= {a.operator for a in below([coverage(x, y)])}


@pytest.mark.parametrize("name", OPERATORS)
def test_floats_arrays_and_many_digits_agree(name, leaves):
    _, x, y = leaves
    node = example(name, x, y)
    states = uniform(1, 6)
    columns = dict(zip((x, y), np.array(states).T, strict=True))
    (array,) = evaluate([node], columns, NUMPY)
    digits = mpmath_arithmetic(50)
    for state, vectorised in zip(states, np.broadcast_to(array, 6), strict=True):
        (single,) = evaluate([node], dict(zip((x, y), state, strict=True)), FLOAT)
        many = evaluate([node], {x: digits.number(state[0]), y: digits.number(state[1])}, digits)
        assert single == pytest.approx(float(many[0]), rel=1e-14, abs=1e-15)
        assert vectorised == pytest.approx(float(many[0]), rel=1e-14, abs=1e-15)


def test_fifty_digits_are_fifty_digits(leaves):
    _, x, y = leaves
    node = coverage(x, y)
    values = []
    for digits in (50, 80):
        numbers = mpmath_arithmetic(digits)
        half, third = numbers.number(Fraction(1, 2)), numbers.number(Fraction(1, 3))
        values += evaluate([node], {x: half, y: third}, numbers)
    assert 0 < abs(values[1] - values[0]) < abs(values[1]) * values[1].context.mpf(10) ** -47


def test_exact_arithmetic_refuses_what_is_not_rational(leaves):
    _, x, y = leaves
    assert evaluate([x / y + g.sqrt(x)], {x: Fraction(4), y: Fraction(3)}, EXACT) == [
        Fraction(10, 3)
    ]
    for node in (g.sin(x), g.sqrt(y), x ** Fraction(1, 3), x.graph.pi()):
        with pytest.raises(NotExact):
            evaluate([node], {x: Fraction(4), y: Fraction(3)}, EXACT)


def test_values_may_be_given_for_inner_nodes(leaves):
    _, x, _ = leaves
    s, c = g.sin(x), g.cos(x)
    circle = {s: Fraction(3, 5), c: Fraction(4, 5)}
    assert evaluate([s * s + c * c, 2 * s], circle, EXACT) == [1, Fraction(6, 5)]


def test_a_missing_value_is_named(leaves):
    _, x, y = leaves
    with pytest.raises(KeyError, match="index=1"):
        evaluate([x + y], {x: 1.0}, FLOAT)


def test_a_graph_is_evaluated_over_the_closed_form(leaves):
    import sympy as sp

    _, x, y = leaves
    node = (g.sin(x) ** 2 + g.cos(x) ** 2) * y - y
    closed = ClosedForm()
    values = {x: closed.of(sp.Symbol("x")), y: closed.of(sp.Symbol("y"))}
    (zero, other) = evaluate([node, node + g.sin(x)], values, over(closed))
    assert closed.is_zero(zero)
    assert not closed.is_zero(other)


HASHED = """
import sympy as sp
from eomgen.algebra.graph import Graph
from eomgen.algebra.lower import GraphAlgebra
from eomgen.algebra.assemble import assemble
graph = Graph()
symbols = sp.symbols("b a d c f e", real=True)
algebra = GraphAlgebra(graph, {s: graph.read("state", i) for i, s in enumerate(symbols)})
b, a, d, c, f, e = symbols
formula = sp.sin(a + b*c)*sp.Min(d, f, e)/(a*b) + sp.Max(a, b, c)*sp.sqrt(d*e + f**3)*sp.atan2(a, d)
node = algebra.of(formula + sp.diff(sp.exp(a*b*c - d)*sp.log(e + f), a))
rates = {s: algebra.of(symbols[i - 1]) for i, s in enumerate(symbols)}
print(assemble("f", "", (1,), [algebra.along(node, rates)]))
"""


def test_the_program_does_not_depend_on_the_hash_seed():
    printed = {
        subprocess.run(
            [sys.executable, "-c", HASHED],
            env={**os.environ, "PYTHONHASHSEED": str(seed)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in (0, 1, 2)
    }
    assert len(printed) == 1
    assert len(printed.pop()) > 1000
