from fractions import Fraction

import numpy as np
import pytest
from graph_cases import coverage, state_leaves, uniform

from eomgen import interpreter
from eomgen.algebra import elementary as g
from eomgen.algebra import ldl
from eomgen.algebra.assemble import assemble
from eomgen.algebra.graph import Graph
from eomgen.errors import CheckError
from eomgen.interpreter import EXACT, FLOAT, NUMPY, NotDefined, SingularMassMatrix, run
from eomgen.program import Function, Number, RequirePositive, Value

DIGITS = interpreter.mpmath_arithmetic(50)
KINDS = {"float": FLOAT, "numpy": NUMPY, "digits": DIGITS, "exact": EXACT}


def covering():
    _, x, y = state_leaves()
    return assemble("f", "", (2,), [coverage(x, y), x / y])


def test_floats_arrays_and_fifty_digits_agree():
    function = covering()
    states = uniform(3, 8)
    columns = run(function, {"state": np.array(states).T}, NUMPY)
    for index, state in enumerate(states):
        many = run(function, {"state": state}, DIGITS)
        for column, single, long in zip(
            columns, run(function, {"state": state}, FLOAT), many, strict=True
        ):
            assert single == pytest.approx(float(long), rel=1e-14)
            assert column[index] == pytest.approx(float(long), rel=1e-14)


def test_arguments_may_be_text_fractions_or_numbers():
    _, x, y = state_leaves()
    function = assemble("f", "", (1,), [x / y])
    for state in (["0.1", 3], [Fraction(1, 10), "3"]):
        assert run(function, {"state": state}, EXACT) == [Fraction(1, 30)]
        assert run(function, {"state": state}, FLOAT) == [0.1 / 3]
        (long,) = run(function, {"state": state}, DIGITS)
        assert abs(long * 30 - 1) < DIGITS.number("1e-48")


def singular(kind, unrolled):
    """A x = b with A = [[1, s], [s, 1]], solved by the kind of statement asked for."""
    graph = Graph()
    s, one = graph.read("state", 0), graph.read("parameters", 0)
    matrix, right = [[one, s], [s, one]], [s, one]
    if unrolled:
        (x,), pivots = ldl.solve(matrix, right)
    else:
        (x,), pivots = ldl.solve_in_loop(matrix, right), ()
    function = assemble("accelerations", "", (2,), x, pivots)
    return lambda value: run(function, {"state": [value], "parameters": [1]}, KINDS[kind])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("unrolled", [True, False])
def test_a_singular_mass_matrix_is_refused(kind, unrolled):
    solve = singular(kind, unrolled)
    assert [float(a) for a in solve(0)] == [0, 1]
    for value in (1, -1, 2):
        with pytest.raises(SingularMassMatrix, match="the mass matrix is singular: its pivot"):
            solve(value)
    assert issubclass(SingularMassMatrix, CheckError)


def test_one_singular_state_of_many_is_enough():
    solve = singular("numpy", True)
    assert solve(np.array([0.5, 0.25]))[1].shape == (2,)
    with pytest.raises(SingularMassMatrix):
        solve(np.array([0.5, 1.0]))


@pytest.mark.parametrize(
    ("kind", "below", "above"),
    [
        ("float", 1e-14, 1e-13),
        ("numpy", 1e-14, 1e-13),
        ("digits", "1e-49", "1e-47"),
        ("exact", 0, "1e-99"),
    ],
)
def test_the_tolerance_is_a_hundred_epsilons_of_the_scale(kind, below, above):
    pivot = Value("v0")
    check = RequirePositive(pivot, Number(Fraction(7)))
    arithmetic = KINDS[kind]

    def attempt(text):
        from eomgen.program import Assign, Read

        function = Function("f", "", (0,), (Assign("v0", Read("state", 0)), check), ())
        return run(function, {"state": [7 * arithmetic.number(text)]}, arithmetic)

    assert attempt(above) == []
    with pytest.raises(SingularMassMatrix, match="v0"):
        attempt(below)
    with pytest.raises(SingularMassMatrix):
        attempt(-1)


@pytest.mark.parametrize("kind", ["float", "digits"])
@pytest.mark.parametrize(
    "formula",
    [lambda x: 1 / x, lambda x: g.sqrt(x - 1), lambda x: g.log(x), lambda x: g.asin(x + 2),
     lambda x: (x - 1) ** Fraction(1, 3)],
)  # fmt: skip
def test_what_has_no_real_value_is_refused(kind, formula):
    _, x, _ = state_leaves()
    function = assemble("outputs", "", (1,), [formula(x)])
    with pytest.raises(NotDefined, match="outputs is not defined at this state"):
        run(function, {"state": [0]}, KINDS[kind])
