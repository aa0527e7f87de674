"""The spelling in Unicode text."""

from fractions import Fraction

import pytest

from eomgen.render.text import name, text
from eomgen.render.text_style import display, printable, width
from eomgen.render.tree import Function, Number, Power, Product, Sum, Symbol

S, PHI, M, L = Symbol("s"), Symbol("phi"), Symbol("m_A"), Symbol("l_0")
ONE = Fraction(1)

SPELLED = [
    (Number(Fraction(-1, 2)), "−½"),
    (Number(Fraction(5, 3)), "5/3"),
    (Product(Fraction(1, 2), (M, Power(Symbol("s'"), 2))), "½ m_A s′²"),
    (Product(Fraction(3, 2), (M, Symbol("phi''"))), "3/2 m_A φ″"),
    (Product(ONE, (M, Function("cos", (PHI,)))), "m_A cos φ"),
    (Power(Function("sin", (PHI,)), 2), "sin² φ"),
    (Function("cos", (Sum((PHI, Product(-ONE, (S,)))),)), "cos(φ − s)"),
    (Power(Sum((S, Product(-ONE, (L,)))), 2), "(s − l_0)²"),
    (Power(Function("exp", (S,)), 2), "(exp(s))²"),
    (Product(-ONE, (S,), (M, L)), "−s/(m_A l_0)"),
    (Product(ONE, (S,), (L,)), "s/l_0"),
    (Product(ONE, (), (Function("cos", (PHI,)),)), "1/(cos φ)"),
    (Product(ONE, (S,), (Function("sqrt", (Sum((S, L)),)),)), "s/√(s + l_0)"),
    (Product(ONE, (S,), (Sum((S, L)),)), "s/(s + l_0)"),
    (Function("abs", (Symbol("s'"),)), "|s′|"),
    (Function("log", (S,)), "ln(s)"),
    (Function("power", (Sum((S, L)), PHI)), "(s + l_0)^(φ)"),
    (Product(ONE, (Symbol("F"), Symbol("delta phi"))), "F δφ"),
]


@pytest.mark.parametrize(("shown", "expected"), SPELLED)
def test_a_tree_is_spelled(shown, expected):
    assert text(shown) == expected


@pytest.mark.parametrize(
    ("spelling", "expected"),
    [("theta_1'", "θ_1′"), ("F_theta", "F_θ"), ("l1", "l1"), ("tau1", "τ1"), ("delta q1", "δq1"),
     ("lambda", "λ"), ("mass", "mass")],
)  # fmt: skip
def test_a_name_is_spelled(spelling, expected):
    assert name(spelling) == expected


def test_no_sign_combines_with_another():
    """Combining dots are misplaced by many terminals."""
    assert width(text(Power(Symbol("phi''"), 2))) == len("φ″²")


def test_a_long_formula_goes_on_below_its_equals_sign():
    formula = " + ".join(f"a_{i} b_{i}" for i in range(40))
    first, *rest = display([("T", formula)]).split("\n")
    assert rest
    assert all(width(line) <= 100 for line in (first, *rest))
    assert first.index("a_0") == rest[0].index("+")
    assert " ".join(line.strip() for line in (first, *rest)) == f"T = {formula}"


def test_the_users_words_hold_no_control_characters():
    assert printable("a\x1b[31m b\n\tc") == "a[31m b c"
