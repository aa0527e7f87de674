"""Parameters folded or prepared: the same values, and nothing left to compute of them."""

import random
from fractions import Fraction

import mpmath
import pytest
import sympy as sp
from programs import PROGRAMS, add, arguments, div, mul, n, op, program, sub
from scenes import program_of

from eomgen import interpreter
from eomgen.algebra.elementary import BUILD
from eomgen.algebra.fixed import builders
from eomgen.algebra.graph import Graph
from eomgen.algebra.ldl import SingularMassMatrix
from eomgen.algebra.lift import Target, lift
from eomgen.algebra.specialise import literals, specialised, with_values
from eomgen.errors import UsageError
from eomgen.interpreter import EXACT, mpmath_arithmetic
from eomgen.program import (
    Apply,
    Assign,
    Function,
    Number,
    Read,
    RequirePositive,
    Solve,
    Value,
    Variable,
    operands,
)
from eomgen.render.lowered import operations

SCENES = ("cart_three_pendulums", "skew_arm", "watt_governor", "four_bar", "block_with_friction")
CASES = (*PROGRAMS, *SCENES)
DIGITS = 50
X, Y, A, B, C = (*(Read("state", i) for i in range(2)), *(Read("parameters", i) for i in range(3)))


def source(name):
    return PROGRAMS[name] if name in PROGRAMS else program_of(name)


def given(of, free):
    """Random arguments; parameters with a value have it, in `DIGITS`."""
    t, state, inputs, drawn = arguments(of, seed=4)
    with mpmath.workdps(DIGITS + 10):
        values = [
            mpmath.mpf(d) if p.value is None else mpmath.mpmathify(str(sp.N(p.value, DIGITS + 10)))
            for p, d in zip(of.parameters, drawn, strict=True)
        ]
    names = [p.name for p in free]
    chosen = [v for p, v in zip(of.parameters, values, strict=True) if p.name in names]
    rows = {"state": state, "accelerations": state, "inputs": inputs}
    return rows | {"time": [t], "parameters": chosen}


def values(of, function, free):
    """The results of a function, or why there are none."""
    try:
        return interpreter.call(of, function, given(free, of.parameters), mpmath_arithmetic(DIGITS))
    except interpreter.NotDefined:
        return None


@pytest.mark.parametrize("fold", [False, True])
@pytest.mark.parametrize("name", CASES)
def test_the_values_are_those_of_the_program(name, fold):
    plain = source(name)
    made = specialised(plain, with_values(plain) if fold else ())
    for function in plain.functions:
        expected = values(plain, function.name, plain)
        found = values(made, function.name, plain)
        assert (found is None) == (expected is None)
        size = max(map(abs, expected or []), default=0)
        for a, b in zip(expected or [], found or [], strict=True):
            assert abs(a - b) <= 1e-40 * max(size, 1)


def moving(of):
    """For every operator of the functions, whether what it is applied to moves."""
    for function in of.functions:
        known = {}
        for statement in function.statements:
            for expression in operands(statement):
                yield from walk(expression, known)
            match statement:
                case Assign(name, expression):
                    known[name] = depends(expression, known)
                case Solve(names, _, _):
                    known |= dict.fromkeys(names, True)
        for expression in function.results:
            yield from walk(expression, known)


def depends(expression, known):
    match expression:
        case Apply(_, parts):
            return any(depends(p, known) for p in parts)
        case Value(name):
            return known[name]
        case Read(argument, _):
            return argument in ("time", "state", "accelerations", "inputs")
    return False


def walk(expression, known):
    if isinstance(expression, Apply):
        trivial = expression.operator == "negate" and not isinstance(expression.operands[0], Apply)
        yield trivial or depends(expression, known)
        for part in expression.operands:
            yield from walk(part, known)


@pytest.mark.parametrize("name", CASES)
def test_nothing_that_depends_on_parameters_alone_is_left(name):
    plain = source(name)
    assert all(moving(specialised(plain)))
    if name == "skew_arm":
        assert not all(moving(plain))  # the test can fail


@pytest.mark.parametrize("name", CASES)
def test_folded_parameters_are_gone(name):
    plain = source(name)
    made = specialised(plain, with_values(plain))
    assert {p.name for p in made.folded} == with_values(plain)
    assert made.folded + made.parameters == tuple(
        sorted(plain.parameters, key=lambda p: p.value is None)
    )
    assert (made.prepare is None) or made.parameters
    count = len(made.parameters)
    for function in made.functions:
        for expression in [e for s in function.statements for e in operands(s)]:
            for part in every(expression):
                assert (
                    not isinstance(part, Read)
                    or part.argument != "parameters"
                    or (part.index < count)
                )


def every(expression):
    inner = expression.operands if isinstance(expression, Apply) else ()
    return [expression, *(p for e in inner for p in every(e))]


def small(*results, parameters=3, values=(Fraction(1, 10), Fraction(1, 5), None), statements=()):
    """A program of two coordinates and parameters a, b with values, and c without."""
    named = zip("abc", values, strict=True)
    return program(
        "small",
        (Function("f", "", (len(results),), statements, results),),
        coordinates=(Variable("x"),),
        speeds=(Variable("x'"),),
        parameters=tuple(
            Variable(k, value=None if v is None else sp.Rational(v.numerator, v.denominator))
            for k, v in list(named)[:parameters]
        ),
    )


def folded(*results, **more):
    of = small(*results, **more)
    return specialised(of, with_values(of)).function("f")


def test_products_of_constants_fold_exactly():
    assert folded(mul(mul(A, X), B)).results == (mul(n(1, 50), X),)
    assert folded(add(A, B)).results == (n(3, 10),)
    assert folded(sub(mul(A, X), mul(n(1, 10), X))).results == (n(0),)


def test_a_parameter_without_a_value_stays():
    of = small(mul(mul(A, X), C))
    made = specialised(of, with_values(of))
    assert [p.name for p in made.parameters] == ["c"]
    assert made.prepare.results == (mul(n(1, 10), Read("parameters", 0)),)
    assert made.function("f").results == (mul(X, Read("constants", 0)),)


def test_a_value_that_is_not_rational_becomes_a_number():
    of = small(mul(op("sqrt", A), X), values=(Fraction(2), None, None))
    (product,) = specialised(of, {"a"}).function("f").results
    (number,) = [e for e in product.operands if isinstance(e, Number)]
    assert abs(number.value**2 - 2) < Fraction(1, 10**50)


def test_one_reciprocal_serves_all_quotients_of_one_denominator():
    d = Value("d")
    statements = (Assign("d", add(mul(X, X), n(1))),)
    made = specialised(small(div(X, d), div(Y, d), div(A, d), statements=statements))
    assert operations(made.function("f"))["divide"] == 1


PREPARED = {  # an expression, and how often each operator remains
    "constant factors meet": (mul(mul(A, X), B), {"multiply": 1}),
    "constant terms meet": (sub(add(A, X), B), {"add": 1}),
    "a minus in between": (sub(A, sub(X, B)), {"subtract": 1}),
    "like terms": (add(mul(A, X), mul(X, B)), {"multiply": 1}),
    "a term and a multiple": (sub(X, mul(X, B)), {"multiply": 1}),
    "a constant divisor": (div(div(X, A), B), {"multiply": 1}),
    "a constant in the divisor": (div(A, mul(B, X)), {"divide": 1}),
    "a product of a quotient": (mul(C, div(A, X)), {"divide": 1}),
    "signs": (mul(op("negate", A), op("negate", mul(B, X))), {"multiply": 1}),
}


@pytest.mark.parametrize("case", PREPARED)
def test_what_is_left_of(case):
    expression, left = PREPARED[case]
    assert operations(specialised(small(expression)).function("f")) == left


def random_tree(rng, depth):
    if depth == 0 or rng.random() < 0.1:
        return rng.choice((X, Y, A, B, C, n(rng.randint(-3, 3), rng.randint(1, 4))))
    operator = rng.choice(("add", "subtract", "multiply", "divide", "negate"))
    parts = [random_tree(rng, depth - 1) for _ in range(1 if operator == "negate" else 2)]
    return op(operator, *parts)


def test_the_rules_of_constants_are_exact():
    """Over fractions the rebuilt expression has the same value, whatever it looks like."""
    rng = random.Random(2)
    numbers = {"state": [Fraction(3, 7), Fraction(-5, 3)], "time": [0]}
    numbers["parameters"] = [Fraction(2, 11), Fraction(7, 5), Fraction(-9, 4)]
    compared = 0
    for _ in range(600):
        function = Function("f", "", (1,), (), (random_tree(rng, 5),))
        graph = Graph()
        for i in range(3):
            graph.read("parameters", i)
        target = Target(graph, builders(lambda node: not node.leaves >> 3), {})
        try:
            expected = interpreter.run(function, numbers, EXACT)
            (node,) = lift(function, target).results
        except (interpreter.NotDefined, ZeroDivisionError):
            continue
        of = program("p", (function,), parameters=tuple(map(Variable, "abc")))
        assert interpreter.call(specialised(of), "f", numbers, EXACT) == expected
        compared += 1
    assert compared > 300


def pivoted(value):
    """x / (a - 1/10) with its pivot checked; zero where a is a tenth."""
    pivot = Value("pivot")
    statements = (Assign("pivot", sub(A, n(1, 10))), RequirePositive(pivot, A))
    return small(div(X, pivot), statements=statements, values=(value, None, None))


def test_a_pivot_that_folds_is_decided():
    assert specialised(pivoted(Fraction(3, 5)), {"a"}).function("f").statements == ()
    with pytest.raises(SingularMassMatrix, match="with the folded parameters is -0.1"):
        specialised(pivoted(Fraction(0)), {"a"})
    with pytest.raises(UsageError, match="f divides by zero with the folded parameters"):
        specialised(pivoted(Fraction(1, 10)), {"a"})


def test_a_pivot_of_parameters_is_checked_where_it_divides():
    made = specialised(pivoted(None))
    kinds = [type(s) for s in made.function("f").statements]
    assert kinds == [Assign, RequirePositive]
    assert all(isinstance(s, Assign) for s in made.prepare.statements)


def test_a_formula_that_is_never_real_is_refused():
    of = small(mul(X, op("log", A)), values=(Fraction(-2), None, None))
    with pytest.raises(UsageError, match="not real and finite"):
        specialised(of, {"a"})


def test_lifting_with_the_plain_operators_changes_nothing():
    plain = program_of("double_pendulum").function("state_derivative")
    lifted = lift(plain, Target(Graph(), BUILD, {}))
    assert len(lifted.results) == 4
    assert len(lifted.pivots) == 2


def test_what_is_left_of_a_sum_that_is_zero_is_zero():
    """sin^2(1) + cos^2(1) - 1 in sixty digits is some 1e-63; a number as small as that stays."""
    graph = Graph()
    one = graph.number(Fraction(1))
    sine, cosine = graph.make("sin", (one,)), graph.make("cos", (one,))
    square = graph.make(
        "add", (graph.make("multiply", (sine, sine)), graph.make("multiply", (cosine, cosine)))
    )
    none = graph.make("subtract", (square, one))
    small = graph.make("multiply", (sine, graph.number(Fraction(1, 10**70))))
    found = literals([none, small])
    assert found[none] == 0
    assert float(found[small]) == pytest.approx(0.8414709848078965e-70, rel=1e-15)
