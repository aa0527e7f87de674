from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from spec_samples import outcome, source

from eomgen.dimension import CURRENT, ENERGY, FORCE, LENGTH, MASS, NONE, TEMPERATURE, TIME
from eomgen.spec.ledger import Mistake
from eomgen.spec.units import POWER, UNITS, parse_unit, quantity, si_unit


@pytest.mark.parametrize(
    ("text", "value", "dimension"),
    [
        ("2 kg", 2, MASS),
        ("2kg", 2, MASS),
        ("-3", -3, NONE),
        ("1e-3 km", 1, LENGTH),
        ("9.81 m/s^2", sp.Rational(981, 100), LENGTH / TIME**2),
        ("9.81 m*s^-2", sp.Rational(981, 100), LENGTH / TIME**2),
        ("9.81 m s**(-2)", sp.Rational(981, 100), LENGTH / TIME**2),
        ("1.5 N*s/m", sp.Rational(3, 2), FORCE * TIME / LENGTH),
        ("5 Nm", 5, ENERGY),
        ("5 kNm", 5000, ENERGY),
        ("5 N m", 5, ENERGY),
        ("1/3 m", sp.Rational(1, 3), LENGTH),
        ("20 deg", sp.pi / 9, NONE),
        ("20\u00b0", sp.pi / 9, NONE),
        ("30 rpm", sp.pi, NONE / TIME),
        ("1 rev/min", sp.pi / 30, NONE / TIME),
        ("3 rad/s", 3, NONE / TIME),
        ("50 %", sp.Rational(1, 2), NONE),
        ("2 kg*m/(s^2*rad)", 2, FORCE),
        ("1 lbf/in", sp.Rational(8896443230521, 50800000000), FORCE / LENGTH),
        ("36 km/h", 10, LENGTH / TIME),
        ("1 min", 60, TIME),
        ("1 1/s", 1, NONE / TIME),
        ("2 W/A", 2, POWER / CURRENT),
        ("7 mK", sp.Rational(7, 1000), TEMPERATURE),
        ("4 \u00b5m", sp.Rational(4, 10**6), LENGTH),
        ("2 t", 2000, MASS),
        ("2 g", sp.Rational(1, 500), MASS),
        ("1 ft", sp.Rational(3048, 10000), LENGTH),
    ],
)
def test_quantity_is_exact(text, value, dimension):
    found = quantity(source(text))
    if text == "1 1/s":
        assert found is None  # a unit begins with a letter
        return
    assert (found.value, found.dimension) == (value, dimension)


@pytest.mark.parametrize("text", ["x", "2*x", "2 + 3", "m*R^2/4", "pi/2", "", "[1, 2]", "-x"])
def test_formulas_are_no_quantities(text):
    assert quantity(source(text)) is None


@pytest.mark.parametrize(
    ("text", "column", "code"),
    [
        ("2 kgg", 3, "E401"),
        ("2 m/sec", 5, "E401"),
        ("2 m/", 5, "E402"),
        ("2 m^x", 4, "E402"),
        ("2 m^2.5", 6, "E402"),
        ("2 (m", 1, None),
        ("2 m)", 4, "E402"),
        ("2 J/kg K", 8, "E402"),
        ("2 degC", 3, "E402"),
        ("2 m**9**9**9", 7, "E402"),
        ("2 m " + "m" * 90, 2, "E402"),
        ("1" * 31 + " m", 1, "E202"),
        ("1e9999999 m", 1, "E202"),
    ],
)
def test_wrong_unit_is_refused_at_its_column(text, column, code):
    if code is None:
        assert quantity(source(text)) is None
        return
    with pytest.raises(Mistake) as caught:
        quantity(source(text))
    assert (caught.value.spot.column, caught.value.code) == (column, code)


@given(st.text(alphabet="kgmsNrad/*^()12- %", max_size=30))
@settings(max_examples=500, deadline=None)
def test_nothing_but_a_mistake_comes_out(text):
    found, mistake = outcome(quantity, source("2 " + text))
    if mistake is not None:
        assert 1 <= mistake.spot.column <= len(text) + 3
    assert found is None or found.value.is_finite


@given(
    st.lists(st.tuples(st.sampled_from(sorted(UNITS)), st.integers(-4, 4)), min_size=1, max_size=4)
)
@settings(max_examples=200, deadline=None)
def test_unit_of_a_product_is_the_product_of_the_units(factors):
    text = "*".join(f"{name}^{power}" for name, power in factors)
    found = parse_unit(source(text))
    value, dimension = sp.S.One, NONE
    for name, power in factors:
        value, dimension = (
            value * UNITS[name].value ** power,
            dimension * UNITS[name].dimension ** power,
        )
    assert (found.value, found.dimension) == (value, dimension)


@given(st.tuples(*[st.integers(-4, 4)] * 5))
@settings(max_examples=200, deadline=None)
def test_si_text_reads_back(exponents):
    dimension = NONE
    for base, exponent in zip((MASS, LENGTH, TIME, CURRENT, TEMPERATURE), exponents, strict=True):
        dimension *= base**exponent
    text = si_unit(dimension)
    found = parse_unit(source(text))
    assert (found.dimension, found.value) == (dimension, 1)


@pytest.mark.parametrize(
    ("dimension", "text"),
    [
        (NONE, "1"),
        (FORCE, "N"),
        (ENERGY, "N*m"),
        (POWER, "W"),
        (FORCE / LENGTH, "N/m"),
        (MASS * LENGTH**2, "kg*m^2"),
        (MASS * LENGTH**2 / TIME, "N*m*s"),
        (LENGTH / TIME**2, "m/s^2"),
        (NONE / TIME, "1/s"),
        (NONE / (LENGTH * TIME), "1/(m*s)"),
        (LENGTH ** Fraction(1, 2), "m^(1/2)"),
    ],
)
def test_si_text_is_what_engineers_write(dimension, text):
    assert si_unit(dimension) == text
