from fractions import Fraction

import pytest
import sympy as sp
from graph_cases import coverage, example, state_leaves, uniform

from eomgen.algebra import elementary as g
from eomgen.algebra.arithmetic import FLOAT, evaluate, mpmath_arithmetic
from eomgen.algebra.derive import RULES, along, direction, gradient
from eomgen.algebra.graph import Graph, Node
from eomgen.algebra.lower import GraphAlgebra
from eomgen.program import OPERATORS


def _difference(node, x, y, state):
    """The slope of node along (1, 2) by a central difference in 60 digits."""
    numbers = mpmath_arithmetic(60)
    step = numbers.number("1e-15")

    def line(s):
        values = {x: numbers.number(state[0]) + s, y: numbers.number(state[1]) + 2 * s}
        return evaluate([node], values, numbers)[0]

    return (line(step) - line(-step)) / (2 * step)


def test_every_operator_with_operands_has_a_rule_for_each():
    assert {name: len(rules) for name, rules in RULES.items()} == {
        name: count for name, count in OPERATORS.items() if count
    }


@pytest.mark.parametrize("name", [*OPERATORS, "coverage"])
def test_forward_equals_differences_and_reverse(name):
    graph, x, y = state_leaves()
    node = coverage(x, y) if name == "coverage" else example(name, x, y)
    forward = along(node, {x: graph.one, y: graph.number(2)})
    by_x, by_y = gradient(node, [x, y])
    numbers = mpmath_arithmetic(60)
    for state in uniform(2, 4):
        values = {x: numbers.number(state[0]), y: numbers.number(state[1])}
        a, b = evaluate([forward, by_x + 2 * by_y], values, numbers)
        assert abs(a - b) < 1e-50 * (1 + abs(a))
        assert abs(a - _difference(node, x, y, state)) < 1e-26 * (1 + abs(a))


@pytest.mark.parametrize("name", ["min", "max", "abs"])
@pytest.mark.parametrize("side", [-1, 1])
def test_kinks_are_right_on_both_sides(name, side):
    graph, x, y = state_leaves()
    node = g.absolute(x - y) if name == "abs" else g.BUILD[name](x, y)
    state = {x: 1.0 + side, y: 1.0}
    left = {"min": (side < 0, side > 0), "max": (side > 0, side < 0), "abs": (side, -side)}
    assert evaluate(gradient(node, [x, y]), state, FLOAT) == list(left[name])


def test_second_derivatives_commute():
    graph, x, y = state_leaves()
    node = coverage(x, y)
    one = graph.one
    mixed = [along(along(node, {a: one}), {b: one}) for a, b in ((x, y), (y, x))]
    values = mpmath_arithmetic(40)
    xy = evaluate(mixed, {x: values.number("0.3"), y: values.number("0.7")}, values)
    assert abs(xy[0] - xy[1]) < 1e-35 * abs(xy[0])


def test_what_does_not_move_costs_nothing():
    graph, x, y = state_leaves()
    node = coverage(x, x) + g.exp(x) / x
    before = len(graph.nodes)
    assert along(node, {y: graph.one}) is graph.zero
    assert gradient(node, [y]) == [graph.zero]
    assert along(node, {x: graph.zero}) is graph.zero
    assert len(graph.nodes) == before


def test_the_reverse_sweep_enters_only_what_moves():
    graph, x, y = state_leaves()
    product = g.sin(x) * y
    before = len(graph.nodes)
    assert gradient(product, [y]) == [g.sin(x)]
    assert len(graph.nodes) == before


def test_calls_along_one_direction_share_their_work():
    graph, x, y = state_leaves()
    node = coverage(x, y)
    derivative = direction(graph, {x: y})
    first = derivative(node)
    before = len(graph.nodes)
    assert derivative(node) is first
    assert derivative(2 * node) is 2 * first
    assert len(graph.nodes) <= before + 2


def test_a_formula_moves_with_the_rate_given_for_it():
    graph, t, q = state_leaves()
    w = g.sin(t)
    rate = graph.symbol("w'")
    assert along(w * q, {w: rate, q: graph.one}) is rate * q + w
    assert along(w * t, {t: graph.one, w: rate}) is rate * t + w
    assert gradient(w * q, [w, q]) == [q, w]
    assert gradient(w * t, [w, t]) == [t, w]


def test_a_number_cannot_move():
    graph, x, _ = state_leaves()
    with pytest.raises(ValueError, match="the number 3 cannot move"):
        along(3 * x, {graph.number(3): graph.one})


def test_deep_graphs_need_no_recursion():
    graph, x, y = state_leaves()
    node = x
    for _ in range(100_000):
        node = y * node + x
    assert len(graph.nodes) > 200_000
    # the fixed point of n = n / 2 + 1 / 4
    assert evaluate([node], {x: 0.25, y: 0.5}, FLOAT) == pytest.approx([0.5])


def test_deep_derivatives_need_no_recursion():
    graph, x, y = state_leaves()
    node = x
    for _ in range(20_000):
        node = y * node + x
    slopes = [along(node, {x: graph.one}), *gradient(node, [x])]
    assert evaluate(slopes, {x: 0.25, y: 0.5}, FLOAT) == pytest.approx([2.0, 2.0])


ROUND_TRIP = [
    "x**2*sin(y)/(2*x**(3/2))", "-x/y + pi/3 - E", "sqrt(x + y)*Abs(x - y)", "Min(x, y, 1/2)",
    "Max(x, y, x*y)*sign(y - x)", "atan2(y, x) + asin(x) + acos(y) + atan(x*y)", "x**y + y**(1/3)",
    "exp(-x)*log(y)/(x*y**2*sqrt(y))", "sinh(x)*cosh(y)*tanh(x*y) - tan(x)", "(x + y)**-3",
    "3*x/4 - 5*y/6", "x**-y", "sqrt(2)*x/sqrt(3)", "(x/y)**(5/2)", "x**(-1/3)",
]  # fmt: skip
SYMBOLS = {name: sp.Symbol(name, real=True) for name in ("x", "y")}


@pytest.mark.parametrize("text", ROUND_TRIP)
def test_sympy_to_graph_and_back_to_a_value(text):
    formula = sp.sympify(text, locals=SYMBOLS, rational=True)
    graph, x, y = state_leaves()
    algebra = GraphAlgebra(graph, dict(zip(SYMBOLS.values(), (x, y), strict=True)))
    at = {"x": Fraction(3, 8), "y": Fraction(5, 8)}
    numbers = mpmath_arithmetic(40)
    leaves = {x: numbers.number(at["x"]), y: numbers.number(at["y"])}
    slope = algebra.along(algebra.of(formula), {SYMBOLS["x"]: graph.one})
    value, derivative = evaluate([algebra.of(formula), slope], leaves, numbers)
    exact = {SYMBOLS[name]: sp.Rational(v.numerator, v.denominator) for name, v in at.items()}
    assert abs(sp.N(formula.subs(exact), 40) - value) < 1e-36
    expected = sp.N(sp.diff(formula, SYMBOLS["x"]).subs(exact), 40)
    assert abs(expected - derivative) < 1e-36


def test_the_algebra():
    graph, x, y = state_leaves()
    a, b, c = sp.symbols("a b c")
    algebra = GraphAlgebra(graph, {a: x, b: y})
    assert algebra.of(a * b) is x * y
    assert algebra.of(sp.Rational(2, 3)) is algebra.number(Fraction(2, 3))
    assert algebra.apply("sqrt", x) is g.sqrt(x)
    assert algebra.apply("atan2", x, y) is g.atan2(x, y)
    assert algebra.is_zero(x - x)
    assert not algebra.is_zero(x)
    assert algebra.along(x * y, {a: y, b: x}) is y * y + x * x
    assert algebra.along(x * y, {a: y, c: x}) is y * y
    assert algebra.extended({c: x + y}).of(c / a) is (x + y) / x
    with pytest.raises(KeyError, match="no node is bound to the symbol c"):
        algebra.of(a + c)
    assert isinstance(Graph().symbol("z"), Node)
