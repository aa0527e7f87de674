"""The closed form: canonical, exact, and true to SymPy's own evaluation."""

import random
from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from eomgen.algebra.closed import ClosedForm, to_sympy
from eomgen.algebra.normal import ONE, Form, inverse, is_zero, linear_parts, number
from eomgen.mechanics.quasi_velocities import evaluator

x, y, z, t = sp.symbols("x y z t", real=True)
a, m = sp.symbols("a m", positive=True)

leaves = st.sampled_from([x, y, z, a, m, sp.Integer(2), sp.Rational(-3, 5), sp.sin(x), sp.cos(y)])


def _grow(inner: st.SearchStrategy[sp.Expr]) -> st.SearchStrategy[sp.Expr]:
    pair = st.tuples(inner, inner)
    return st.one_of(
        pair.map(lambda p: p[0] + p[1]),
        pair.map(lambda p: p[0] * p[1]),
        pair.map(lambda p: p[0] - p[1]),
        inner.map(sp.sin),
        inner.map(sp.cos),
        inner.map(lambda e: e**2),
    )


expressions = st.recursive(leaves, _grow, max_leaves=6)


def values(seed: int) -> dict[sp.Symbol, sp.Float]:
    chance = random.Random(seed)
    return {s: sp.Float(chance.uniform(0.3, 1.2), 40) for s in (x, y, z, a, m, t)}


def close(left: sp.Expr, right: sp.Expr, seed: int = 1) -> bool:
    at = values(seed)
    one, other = (sp.N(e.xreplace(at), 30) for e in (left, right))
    return abs(one - other) <= sp.Float("1e-20") * (1 + abs(one))


@given(expressions, st.integers(0, 9))
@settings(max_examples=150, deadline=None, derandomize=True)
def test_value_is_that_of_sympy(expression: sp.Expr, seed: int) -> None:
    assert close(expression, to_sympy(ClosedForm().of(expression)), seed)


@given(expressions, expressions)
@settings(max_examples=100, deadline=None, derandomize=True)
def test_equal_polynomials_have_the_same_terms(p: sp.Expr, q: sp.Expr) -> None:
    algebra = ClosedForm()
    left = (algebra.of(p) + algebra.of(q)) ** 2
    right = algebra.of(sp.expand(p**2)) + 2 * algebra.of(p) * algebra.of(q) + algebra.of(q**2)
    assert left == right


@given(expressions)
@settings(max_examples=100, deadline=None, derandomize=True)
def test_derivative_is_that_of_sympy(expression: sp.Expr) -> None:
    algebra = ClosedForm()
    found = algebra.along(algebra.of(expression), {x: algebra.of(y), y: algebra.number(1)})
    wanted = sp.diff(expression, x) * y + sp.diff(expression, y)
    assert close(wanted, to_sympy(found))


FUNCTIONS = [
    sp.tan(x), sp.asin(x / 3), sp.acos(y / 3), sp.atan(x * y), sp.atan2(x, y), sp.sinh(x),
    sp.cosh(y), sp.tanh(x * y), sp.exp(x * y), sp.log(x + 1), sp.sqrt(x**2 + y), sp.Abs(x - y),
    sp.sign(x - y) * x, sp.Min(x, y), sp.Max(x, y, z), x ** sp.Rational(1, 3), x**y, 1 / (x + y),
    sp.sqrt(x + y) ** 3, sp.Abs(x - y) ** 3, sp.cosh(x) ** 3, sp.sin(a * sp.cos(x)), sp.E * x,
    sp.sqrt(8) * x, sp.sin(x + sp.pi / 2), sp.cos(3 * sp.pi / 2 - x), sp.sin(x + sp.pi / 4),
    sp.sin(x / 2) ** 2, sp.sqrt(a**2 * m * (x**2 + 1)), sp.sqrt(a**2 / m**2),
]  # fmt: skip


@pytest.mark.parametrize("function", FUNCTIONS, ids=str)
def test_functions_and_their_derivatives(function: sp.Expr) -> None:
    algebra = ClosedForm()
    form = algebra.of(function)
    assert close(function, to_sympy(form))
    slope = algebra.along(form, {x: algebra.number(1)})
    step = sp.Rational(1, 10**12)
    at = values(3)
    ahead, behind = (sp.N(function.xreplace({**at, x: at[x] + s}), 35) for s in (step, -step))
    found = sp.N(to_sympy(slope).xreplace(at), 30)
    assert abs((ahead - behind) / (2 * step) - found) < 1e-9 * (1 + abs(found))


ZEROS = [
    sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1,
    sp.sin(x + y) - sp.sin(x) * sp.cos(y) - sp.cos(x) * sp.sin(y),
    sp.cos(3 * x) - 4 * sp.cos(x) ** 3 + 3 * sp.cos(x),
    1 - sp.cos(x) - 2 * sp.sin(x / 2) ** 2,
    sp.tan(x) * sp.cos(x) - sp.sin(x),
    1 / (x + y) + 1 / (x - y) - 2 * x / (x**2 - y**2),
    x / sp.sqrt(x**2 + y**2) - x * sp.sqrt(x**2 + y**2) / (x**2 + y**2),
    sp.sqrt(a**2) - a,
    sp.cosh(x) ** 2 - sp.sinh(x) ** 2 - 1,
    sp.sin(a * sp.cos(x)) ** 2 + sp.cos(a * sp.cos(x)) ** 2 - 1,
    sp.sin(x + 7 * sp.pi) + sp.sin(x),
    (sp.sin(x) ** 2 + x * sp.sin(x)) / sp.sin(x) - sp.sin(x) - x,
]


@pytest.mark.parametrize("expression", ZEROS, ids=str)
def test_zero_is_decided(expression: sp.Expr) -> None:
    assert is_zero(ClosedForm().of(expression))


@pytest.mark.parametrize("expression", ZEROS, ids=str)
def test_what_is_nearly_zero_is_not(expression: sp.Expr) -> None:
    assert not is_zero(ClosedForm().of(expression + sp.Rational(1, 10**30)))


def test_division_by_an_identical_zero_is_refused() -> None:
    algebra = ClosedForm()
    with pytest.raises(ZeroDivisionError):
        inverse(algebra.of(sp.sin(x) ** 2 + sp.cos(x) ** 2) - 1)


def test_root_of_an_unknown_sign_is_not_taken() -> None:
    assert to_sympy(ClosedForm().of(sp.sqrt(x**2 * y, evaluate=False))) != x * sp.sqrt(y)


def test_linear_parts_add_up() -> None:
    algebra = ClosedForm()
    form = algebra.of(3 * x * sp.sin(z) + y * a - 4 * m)
    atoms = [algebra.ring.atom(s) for s in (x, y)]
    parts, rest = linear_parts(form, atoms)
    again = parts[atoms[0]] * algebra.of(x) + parts[atoms[1]] * algebra.of(y) + rest
    assert again == form
    assert rest == algebra.of(-4 * m)


def test_numbers_are_exact() -> None:
    algebra = ClosedForm()
    third = number(algebra.ring, Fraction(1, 3))
    assert (third + third + third).terms == {ONE: 1}
    assert type((third * 3).terms[ONE]) is int


def test_no_sum_is_copied_for_each_term_that_is_put_in(monkeypatch: pytest.MonkeyPatch) -> None:
    """Forms in the place of symbols: as many additions as there are terms, not their square."""
    algebra = ClosedForm()
    symbols = sp.symbols("c:300", real=True)
    form = algebra.of(sp.Add(*(k * s * sp.cos(x) for k, s in enumerate(symbols, 1))))
    put = evaluator(algebra, {s: algebra.of(s * y) for s in symbols} | {x: algebra.of(z)})
    touched = 0
    plain = Form.__add__

    def counted(left: Form, right: Form) -> Form:
        nonlocal touched
        touched += len(left.terms)
        return plain(left, right)

    monkeypatch.setattr(Form, "__add__", counted)
    found = put(form)
    assert len(found.terms) == len(symbols)
    assert touched <= 2 * len(symbols)
