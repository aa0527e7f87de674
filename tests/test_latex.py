"""The spelling in LaTeX: names, dots, fractions, brackets, breaks, and nothing of the user's."""

import re
from fractions import Fraction

import pytest

from eomgen.errors import UsageError
from eomgen.latex_name import checked
from eomgen.render import latex_names, layout
from eomgen.render.latex import latex
from eomgen.render.latex_style import display, equation, pairs
from eomgen.render.latex_text import escaped, unit
from eomgen.render.latex_width import width
from eomgen.render.tree import Function, Number, Power, Product, Sum, Symbol

NAMES = {
    "s'": r"\dot{s}",
    "phi": r"\varphi",
    "phi'": r"\dot{\varphi}",
    "d": "c'",
    "delta s": r"\delta s",
}
HALF = Fraction(1, 2)
ONE = Fraction(1)
PHI, M, L, S = Symbol("phi"), Symbol("m_A"), Symbol("l_0"), Symbol("s")


def product(*factors, number=ONE, over=()):
    return Product(Fraction(number), factors, over)


SPELLED = [
    (Number(Fraction(1, 12)), r"\tfrac{1}{12}"),
    (product(M, Power(Symbol("s'"), 2), number=HALF), r"\tfrac12 m_A \dot{s}^2"),
    (product(M, Function("cos", (PHI,))), r"m_A \cos\varphi"),
    (Function("cos", (Symbol("q_1"),)), r"\cos q_1"),
    (Power(Function("sin", (PHI,)), 2), r"\sin^2\varphi"),
    (Power(Function("sin", (Symbol("q_1"),)), 2), r"\sin^2q_1"),
    (Function("cos", (product(PHI, number=2),)), r"\cos 2 \varphi"),
    (Function("cos", (product(PHI, number=HALF),)), r"\cos(\tfrac12 \varphi)"),
    (Function("cos", (Sum((PHI, product(S, number=-1))),)), r"\cos(\varphi - s)"),
    (Power(Symbol("d"), 2), "{c'}^2"),
    (product(Symbol("d"), Symbol("phi'"), over=(M, L), number=-1),
     r"-\frac{c' \dot{\varphi}}{m_A l_0}"),
    (product(M, over=(L,), number=HALF), r"\frac{m_A}{2 l_0}"),
    (product(over=(L,)), r"\frac{1}{l_0}"),
    (product(M, Sum((S, product(L, number=-1)))), "m_A (s - l_0)"),
    (product(M, Sum((Number(ONE), product(L, over=(S,), number=-1)))),
     r"m_A \left(1 - \frac{l_0}{s}\right)"),
    (Power(Sum((S, L)), 2), "(s + l_0)^2"),
    (Power(Function("sqrt", (Sum((S, L)),)), 3), r"(s + l_0)^{3/2}"),
    (Power(Function("exp", (S,)), 2), r"(e^{s})^2"),
    (Function("sqrt", (S,)), r"\sqrt{s}"),
    (Function("abs", (Symbol("s'"),)), r"\left|\dot{s}\right|"),
    (Function("sign", (S,)), r"\operatorname{sgn}(s)"),
    (Function("atan2", (S, L)), r"\operatorname{atan2}(s, l_0)"),
    (Function("power", (S, L)), "{s}^{l_0}"),
    (product(Symbol("F"), Symbol("delta s")), r"F \,\delta s"),
]  # fmt: skip


@pytest.mark.parametrize(("shown", "expected"), SPELLED)
def test_a_tree_is_spelled(shown, expected):
    assert latex(shown, NAMES) == expected


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("l1", "l_1"),
        ("l_0", "l_0"),
        ("m_A", "m_A"),
        ("theta_1", r"\theta_1"),
        ("Omega", r"\Omega"),
        ("omicron", "o"),
        ("m_cart", r"m_{\mathrm{cart}}"),
        ("mass", r"\mathrm{mass}"),
        ("q_12", "q_{12}"),
        ("m_A_1", "m_{A,1}"),
        ("F_theta", r"F_\theta"),
        ("\u03c6_2", r"\phi_2"),
    ],
)
def test_a_name_is_spelled(name, expected):
    assert latex_names.spelled(name) == expected


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("q_1", r"\ddot{q}_1"),
        (r"\varphi", r"\ddot{\varphi}"),
        (r"\bar{x}_1", r"\ddot{\bar{x}}_1"),
        ("c'", r"\ddot{c}'"),
    ],
)
def test_dots_stand_over_the_letter(name, expected):
    assert latex_names.dotted(name, 2) == expected


ACCEPTED = [r"\varphi", "c'", r"\bar{x}_1", r"k_{\mathrm{in}}", "x_1^2", r"\hat{\bar{q}}", "x'_1"]
REFUSED = [
    "", " ", "x_", "x^", "_1", "x_1_2", "x^1^2", "x'^2", "{", "}", "x}{", "{}", r"\bar", r"\bar x",
    r"\input{x}", r"\write18{x}", r"\def\x{}", "$x$", "x%", "x&y", r"x\\y", "x#1", "~", "\u00e9",
    r"\left(", r"\begin{x}", "{" * 50 + "x" + "}" * 50, r"\frac{a}{b}",
]  # fmt: skip


@pytest.mark.parametrize("override", ACCEPTED)
def test_a_name_of_the_author_is_taken(override):
    assert checked("x", f" {override} ") == override


@pytest.mark.parametrize("override", REFUSED)
def test_nothing_but_a_name_is_taken(override):
    with pytest.raises(UsageError, match="is not a name"):
        checked("x", override)


def test_the_users_words_hold_no_macro():
    words = r"50 % of \input{x} & $y_1^2$ ~ #1 {z}" + " \u00e9 \u03c6 \u4e2d\n\x00"
    spelled = escaped(words)
    bare = re.sub(
        r"\\text(backslash|asciicircum|asciitilde)\{\}|\\[%&#_${}]|\\ensuremath\{\\phi\}",
        "",
        spelled,
    )
    assert not set(bare) & set("\\%&#_^$~{}\x00\n")
    assert "[U+4E2D]" in spelled
    assert "\u00e9" in spelled


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("N*s/m", r"\mathrm{N\,s/m}"),
        ("m s^-2", r"\mathrm{m\,s^{-2}}"),
        ("kg*m^2/(s^2*rad)", r"\mathrm{kg\,m^{2}/(s^{2}\,rad)}"),
        ("%", r"\mathrm{\%}"),
        ("", ""),
        ("m^", r"\text{m\textasciicircum{}}"),
        (r"\x", r"\text{\textbackslash{}x}"),
    ],
)
def test_a_unit_is_upright(text, expected):
    assert unit(text) == expected


# --- lines


def test_a_fraction_is_as_wide_as_its_wider_part():
    assert width(r"\frac{abcd}{a}") < width("abcd") + 1 < width(r"\frac{abcd}{a} + a")
    assert width(r"\dot{s}") == width("s")
    assert width(r"x_{12}") < width("x12")


SUM = " + ".join(f"a_{{{i}}} (b + c)" for i in range(30))


def test_a_long_sum_is_broken_before_signs():
    found = layout.lines(SUM, 40, width)
    assert " ".join(found) == SUM
    assert all(width(line) <= 40 for line in found)
    assert all(line.startswith("+ ") for line in found[1:])
    assert all(line.count("(") == line.count(")") for line in found)


def test_a_bracket_is_broken_only_where_it_must_be():
    inside = " + ".join(f"b_{i}" for i in range(30))
    found = layout.lines(f"a + m ({inside}) + c", 40, width)
    assert " ".join(found) == f"a + m ({inside}) + c"
    assert all(width(line) <= 40 for line in found)


def test_a_fraction_and_a_tall_bracket_are_never_broken():
    whole = r"\frac{a + b}{c - d} \left(1 - \frac{a}{b} + c\right)"
    assert layout.lines(whole, 1, width) == [whole]


def test_a_right_side_is_not_torn_where_it_can_stand_alone():
    def fits(formula):
        return layout.lines(formula, 20, width)

    left, right = "a + b + c + d", "e - f + g + h"
    assert layout.equation(left, "0", fits, is_long=True) == [f"{left} = 0"]
    assert layout.equation(left, right, fits, is_long=True) == [left, f"= {right}"]
    assert layout.equation(left, right, fits, is_long=False) == [f"{left} = e - f", "+ g + h"]
    long = " + ".join("abcdefgh")  # its end has room for a short right side
    assert layout.equation(long, "k", fits, is_long=True)[-1].endswith(" = k")


def test_rows_stand_at_their_equals_signs():
    assert display([("x", "s"), ("y", "0")]) == "x &= s \\\\\ny &= 0"
    assert pairs([[("x", "s"), ("u", "t")], [("y", "0")]]) == "x &= s & u &= t \\\\\ny &= 0"


def test_a_long_equation_has_one_number():
    rows = equation(SUM, "0").split("\\\\\n")
    assert len(rows) > 1
    assert all(r"\notag" in row for row in rows[:-1])
    assert r"\notag" not in rows[-1]


def test_no_value_is_lost_in_pairs_that_do_not_fit():
    rows = pairs([[("x", SUM), ("u", SUM)]])
    assert rows.replace("&\\quad ", "").replace("&= ", "").replace("\\\\\n", "").count("a_{0}") == 2
