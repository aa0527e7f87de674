from fractions import Fraction

import pytest
import sympy as sp
from programs import AWKWARD_NAMES, PROGRAMS, TIME, add, arguments, div, mul, n, op, sub

from eomgen.errors import UsageError
from eomgen.interpreter import FLOAT, run
from eomgen.program import OPERATORS, Assign, Function, Read, RequirePositive, Value
from eomgen.render.code import expression, literal, number
from eomgen.render.dialects import PYTHON, C
from eomgen.render.lowered import expressions, lower, operations
from eomgen.render.names import escaped, identifier, module

X, Y, Z = (Read("state", i) for i in range(3))
NAMES = {X: "x", Y: "y", Z: "z", TIME: "t"}


@pytest.mark.parametrize(
    ("tree", "text"),
    [
        (sub(X, sub(Y, Z)), "x - (y - z)"),
        (sub(sub(X, Y), Z), "x - y - z"),
        (add(X, add(Y, Z)), "x + (y + z)"),
        (mul(X, mul(Y, Z)), "x * (y * z)"),
        (div(X, mul(Y, Z)), "x / (y * z)"),
        (div(mul(X, Y), Z), "x * y / z"),
        (mul(add(X, Y), Z), "(x + y) * z"),
        (add(mul(X, Y), Z), "x * y + z"),
        (sub(X, op("negate", Y)), "x - (-y)"),
        (op("negate", add(X, Y)), "-(x + y)"),
        (op("negate", mul(X, Y)), "-(x * y)"),
        (op("negate", op("negate", X)), "-(-x)"),
        (mul(op("negate", X), Y), "-x * y"),
        (sub(X, n(-1, 2)), "x - (-0.5)"),
        (op("atan2", add(X, Y), n(3)), "np.arctan2(x + y, 3.0)"),
    ],
)
def test_parentheses_keep_the_order_of_the_tree(tree, text):
    assert expression(tree, PYTHON, NAMES) == text


def test_numbers_of_c_go_through_the_macro():
    assert expression(add(n(1, 3), n(-2)), C, NAMES) == "REAL(0.3333333333333333) + (-REAL(2.0))"


def test_every_operator_has_a_text_in_every_dialect():
    for dialect in (C, PYTHON):
        for name, count in OPERATORS.items():
            assert expression(op(name, *(X, Y)[:count]), dialect, NAMES)


def test_a_rational_is_the_nearest_double():
    assert literal(Fraction(1, 10)) == "0.1"
    assert float(literal(Fraction(2, 3))) == 2 / 3
    assert literal(Fraction(2**53 + 1, 2**53)) == "1.0"  # a tie goes to even
    assert number(sp.pi / 3) == "1.0471975511965979"  # nearer than math.pi / 3


@pytest.mark.parametrize("value", [Fraction(10) ** 400, Fraction(1, 10**400)])
def test_a_number_outside_the_doubles_is_refused(value):
    with pytest.raises(UsageError, match="outside the range"):
        literal(value)


@pytest.mark.parametrize("name", PROGRAMS)
def test_lowering_changes_no_value(name):
    program = PROGRAMS[name]
    for function in program.functions:
        t, *rest = arguments(program, 1, function)
        given = {"time": [t], **dict(zip(function.arguments[1:], rest, strict=True))}
        expected = run(function, given, FLOAT)
        assert run(lower(function), given, FLOAT) == pytest.approx(expected, rel=1e-14, abs=0)


def test_whole_and_half_powers_become_products():
    exponents = (n(0), n(1), n(2), n(3), n(9), n(-5), n(1, 2), n(-3, 2))
    results = tuple(op("power", add(X, Y), e) for e in exponents)
    counts = operations(lower(Function("f", "", (8,), (), results)))
    assert "power" not in counts
    assert counts["sqrt"] == 2
    assert counts["divide"] == 2


def test_a_power_is_computed_once_for_each_factor():
    lowered = lower(Function("f", "", (1,), (), (op("power", op("sin", X), n(8)),)))
    assert operations(lowered) == {"sin": 1, "multiply": 3}


def test_other_powers_stay():
    results = tuple(op("power", X, e) for e in (n(1, 3), n(65), Y))
    assert operations(lower(Function("f", "", (3,), (), results)))["power"] == 3


def test_unused_values_go_and_pivots_stay():
    statements = (
        Assign("unused", op("sin", X)),
        Assign("pivot", op("cos", X)),
        RequirePositive(Value("pivot"), n(1)),
        Assign("used", Y),
    )
    lowered = lower(Function("f", "", (1,), statements, (Value("used"),)))
    assert lowered.statements == statements[1:]
    assert Value("pivot") in expressions(lowered)


def test_new_names_avoid_those_of_the_program():
    statements = (Assign("inner_1", add(X, Y)),)
    results = (op("power", add(Value("inner_1"), n(1)), n(2)),)
    lowered = lower(Function("f", "", (1,), statements, results))
    assert [s.name for s in lowered.statements] == ["inner_1", "inner_2"]


def test_names_are_identifiers_each_once():
    given = ("phi'", "2nd", "_x", "φ")
    assert [identifier(a) for a in given] == ["phi_dot", "n2nd", "n_x", "u03c6"]
    names = escaped((*AWKWARD_NAMES, "x_dot"), C.reserved | PYTHON.reserved)
    assert len(set(names)) == len(names)
    assert all(name.isidentifier() for name in names)
    assert not set(names) & (C.reserved | PYTHON.reserved)


def test_a_python_module_can_be_imported_by_its_name():
    assert [module(a) for a in ("arm-2", "lambda", "2_dof")] == ["arm_2", "lambda_", "n2_dof"]
