import re
from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from spec_samples import outcome, source

from eomgen.spec import lower, names
from eomgen.spec.formula import FUNCTIONS, parse, parse_relation
from eomgen.spec.ledger import Ledger, Mistake
from eomgen.spec.scope import Known, Scene
from eomgen.spec.syntax import Name, children

SYMBOLS = {
    n: sp.Symbol(n, real=True) for n in ("x", "y", "z", "I", "N", "S", "beta", "lambda", "\u03b8")
}


def scene():
    found = Scene(Ledger("x", ("",)), "plane", dict(names.BUILT_IN))
    for name, symbol in SYMBOLS.items():
        rates = (sp.Symbol(f"{name}'", real=True), sp.Symbol(f"{name}''", real=True))
        found.names[name] = Known("coordinate", (symbol, *rates))
    return found


def lowered(text):
    return lower.scalar(parse(source(text)), lower.Lowering(scene(), "output"))


numbers = st.integers(0, 9).map(str) | st.sampled_from(["0.5", "1.25", "2e-1", ".5", "3."])


def combined(inner):
    binary = st.tuples(inner, st.sampled_from(["+", "-", "*", "/", " - ", "/ -"]), inner)
    return (
        binary.map("".join)
        | inner.map("({})".format)
        | inner.map("-{}".format)
        | st.tuples(inner.map("({})".format), st.sampled_from(["^2", "**3", "^-1", "^2^2"])).map(
            "".join
        )
    )


@given(st.recursive(numbers, combined, max_leaves=12))
@settings(max_examples=500, deadline=None)
def test_numbers_are_those_of_python(text):
    exact = re.sub(r"\d+\.?\d*(?:e-\d)?|\.\d+", r"Fraction('\g<0>')", text).replace("^", "**")
    exact = re.sub(r"\*\*(-?)Fraction\('(\d)'\)", r"**\1\2", exact)
    try:
        expected = eval(exact, {"Fraction": Fraction})
    except ZeroDivisionError:
        with pytest.raises(Mistake):
            lowered(text)
        return
    found, mistake = outcome(lowered, text)
    if mistake is not None:
        assert mistake.code == "E202"
    else:
        assert found == sp.Rational(expected.numerator, expected.denominator)


@given(st.text(alphabet="xyzt0129.e+-*/^()[],=' \u03b8", max_size=60))
@settings(max_examples=500, deadline=None)
def test_nothing_but_a_mistake_comes_out(text):
    _, mistake = outcome(lowered, text)
    assert mistake is None or 1 <= mistake.spot.column <= len(text) + 1


words = st.sampled_from(
    [*FUNCTIONS, "x", "y'", "pi", "t", "2", "1/3", "0", "64", "-", "+", "*", "/", "^", ","]
)


@given(st.lists(words | st.sampled_from(["(", ")"]), max_size=30).map("".join))
@settings(max_examples=500, deadline=None)
def test_nothing_but_a_mistake_comes_out_of_words(text):
    found, _ = outcome(lowered, text)
    assert found is None or not found.has(sp.nan, sp.zoo, sp.oo, sp.I)


def test_operators_bind_as_on_paper():
    x, y, z = (SYMBOLS[n] for n in "xyz")
    assert lowered("-x^2") == -(x**2)
    assert lowered("2^-x") == sp.Integer(2) ** (-x)
    assert lowered("x^y^z") == x ** (y**z)
    assert lowered("x - y - z") == x - y - z
    assert lowered("x/y/z") == x / y / z
    assert lowered("x/y*z") == x * z / y
    assert lowered("x*-y") == -x * y
    assert lowered("x**2") == lowered("x^2") == x**2


def test_numbers_are_exact():
    assert lowered("0.1 + 0.2") == sp.Rational(3, 10)
    assert lowered("1e-3") == sp.Rational(1, 1000)
    assert lowered("1.5E2*x") == 150 * SYMBOLS["x"]


def test_ordinary_names_are_not_sympy_objects():
    expected = sp.Mul(*(SYMBOLS[n] for n in ("I", "N", "S", "beta", "lambda", "\u03b8")))
    assert lowered("I*N*S*beta*lambda*\u03b8") == expected


def test_rates_have_two_spellings():
    assert lowered("der(x)") == lowered("x'") == sp.Symbol("x'", real=True)
    assert lowered("der(der(x))") == lowered("der(x')") == lowered("x''")


@pytest.mark.parametrize("function", FUNCTIONS)
def test_every_function_has_its_value(function):
    arguments = "x, y" if FUNCTIONS[function][0] == 2 else "x"
    found = lowered(f"{function}({arguments})")
    assert found == lower.FUNCTIONS[function].symbolic(*(SYMBOLS[a] for a in arguments.split(", ")))
    assert found.free_symbols == {SYMBOLS[a] for a in arguments.split(", ")}


def test_every_term_knows_its_text():
    text = "x*(y - 2)  + sin( x ) ^ 2"

    def visit(tree):
        start = tree.span.column - 1
        assert text[start : start + len(tree.span.text)] == tree.span.text
        for child in children(tree):
            visit(child)

    visit(parse(source(text)))


def test_printed_terms_read_back_equal():
    text = "-x*(y - 2)^-z + max(x, 1/3)*[1, 2]"
    first = parse(source(text))
    assert parse(source(first.span.text)) == first


def test_deepest_formula_that_is_allowed_is_read():
    assert lowered("sin(" * 40 + "x" + ")" * 40).count(sp.sin) == 40
    assert lowered("+".join(["x"] * 250)) == 250 * SYMBOLS["x"]


def test_relation_has_two_sides():
    relation = parse_relation(source("x + 1 = y"))
    assert (relation.sign, relation.left.span.text, relation.right) == (
        "=", "x + 1", Name("y", 0, relation.right.span),
    )  # fmt: skip
    assert parse_relation(source("x >= 0")).sign == ">="


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("exp(1000)", "E202"),
        ("exp(-1000)", "E202"),
        ("asin(sin(1e300))", "E202"),
        ("asin(cos(exp(-700)^64))", "E202"),
        ("cosh((-700)^tan(1))", "E203"),
        ("x*exp(1e18)", "E202"),
        ("cos(exp(exp(10)))", "E202"),
        ("exp(exp(6))^64", "E202"),
        ("2^(1e18*sin(1))", "E202"),
        ("1e300*1e300", "E202"),
        ("1e300*1e300*pi", "E202"),
        ("1/(1e-300*pi*1e-300)", "E202"),
        ("(2^64)^64", "E202"),
        ("x^65", "E202"),
        ("x^(1/65)", "E202"),
        ("sqrt(-2)", "E203"),
        ("(-2)^(1/2)", "E203"),
        ("log(-1)", "E203"),
        ("log(0)", "E203"),
        ("asin(2)", "E203"),
        ("1/0", "E203"),
        ("0^-1", "E203"),
        ("1/(x - x)", "E203"),
        ("tan(pi/2)", "E203"),
    ],
)
def test_constant_without_a_double_is_refused(text, code):
    _, mistake = outcome(lowered, text)
    assert mistake is not None
    assert mistake.code == code


@pytest.mark.parametrize("text", ["sqrt(0.3 - 0.1 - 0.2)", "asin((sqrt(2)/2)^2*2)*0", "0*1e300"])
def test_rounding_refuses_no_constant(text):
    assert lowered(text) == 0


def test_smallest_and_greatest_are_kept_as_they_stand():
    x, y = SYMBOLS["x"], SYMBOLS["y"]
    assert lowered("max(x, y)").subs({x: 2, y: 3}) == 3
    assert lowered("min(2, 1/3, pi)") == sp.Rational(1, 3)
