"""Base parameters: known numbers of them, known combinations, and what they must satisfy."""

from functools import cache
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy as sp
from functions_of import PRECISE, difference, states, value
from functions_of import motion as motion_of
from scenes import FREE, model_of

from eomgen import compile
from eomgen.analysis import elimination
from eomgen.errors import UsageError
from eomgen.functions import base, recognise, sheet
from eomgen.functions.motion import Motion
from eomgen.functions.recognise import Coefficient
from eomgen.spec import read

ARMS = Path(__file__).parent / "fixtures" / "arms"


@cache
def found_in(case):
    return base.of(motion_of(case))


@cache
def puma():
    text = (ARMS / "puma.yaml").read_text(encoding="utf-8")
    return base.of(Motion(compile.machine_of(read(text, "puma.yaml"))))


def names(found):
    return [found.name(p) for p in found.base]


def serial(joints, first, *, parallel=()):
    """7 N - 4 b, and 2 less where the first axis is along gravity (Mayeda, Yoshida & Osuka 1990).

    N revolute joints, of which the first b have parallel axes; counted link by link: one in the
    first cluster brings I about its axis and two first moments, one behind it 10 less the 3 that
    its parent takes over.
    """
    return 7 * joints - 4 * (1 + len(parallel)) - (2 if first == "along gravity" else 0)


@pytest.mark.slow
def test_the_puma_has_36_base_parameters():
    """Rank in 50 digits, and the count by Mayeda's formula; the published number is 36."""
    found = puma()
    assert len(found.parameters) == 60
    assert len(found.base) == serial(6, "along gravity") == 36
    assert len(found.without_effect) == 9  # of the first link only the inertia about its axis
    assert found.error < 1e-45


@pytest.mark.slow
def test_the_puma_is_regrouped_as_khalil_does():
    """Revolute: I_yy, m c_z and m of a link go to its parent (Khalil & Dombre, section 9.4)."""
    found = puma()
    left = {found.parameters[p.kept].name for p in found.base}
    for link in range(2, 7):
        taken = {f"{kind}(link_{link})" for kind in ("m", "mc_z", "I_yy")}
        assert not left & taken
    listed = names(found)
    assert "I_xx(link_6) - I_yy(link_6)" in listed
    assert "mc_y(link_5) + mc_z(link_6)" in listed
    heavy = " + ".join(f"a_2 m(link_{i})" for i in (3, 4, 5, 6))
    assert f"mc_x(link_2) + {heavy}" in listed
    reach = "(a_2^2 + a_3^2 + d_2^2 + 2*d_2*d_3 + d_3^2) m(link_6)"
    assert listed[0].endswith(reach)
    assert all(c.general for p in found.base for _, c in p.terms)


def test_two_planar_links_have_the_known_six():
    assert len(found_in("two_link_arm").base) == serial(2, "horizontal", parallel=("second",)) == 6
    assert names(found_in("two_link_arm")) == [
        "mc_x(upper) + l1 m(fore)",
        "mc_y(upper)",
        "I(upper) + l1^2 m(fore)",
        "mc_x(fore)",
        "mc_y(fore)",
        "I(fore)",
    ]
    assert found_in("two_link_arm").without_effect == (0,)


def test_skew_axes_have_as_many_as_the_formula_counts():
    assert len(found_in("skew_arm").base) == serial(2, "skew") == 10


def test_a_free_top_keeps_all_but_its_mass():
    assert names(found_in("heavy_top"))[0] == "mc_x(top)"
    assert len(found_in("heavy_top").base) == 9


def test_a_rolling_disc_moves_its_inertia_to_its_mass():
    assert names(found_in("disc_pendulum"))[0] == "m(disc) + 1/r^2 I(disc)"


@pytest.mark.parametrize("case", [n for n in FREE if n != "flyball_governor"])
def test_the_base_gives_the_whole_regressor(case):
    """Y theta = Y_b theta_b, and the columns of Y_b are independent, at states of their own."""
    found = found_in(case)
    rows, base_rows = [], []
    for given in ({**s, "parameters": states(case)[0]["parameters"]} for s in states(case)):
        theta = value(case, "inertial_parameters", given)
        whole = value(case, "regressor", given)
        chosen = value(case, "base_regressor", given)
        assert chosen.tolist() == whole[:, [p.kept for p in found.base]].tolist()
        rows += whole.tolist()
        base_rows += chosen.tolist()
        values = at(case, found, given)
        totals = [theta[p.kept] + sum(values(c) * theta[j] for j, c in p.terms) for p in found.base]
        assert difference(chosen @ np.array(totals, dtype=object), whole @ theta) < 1e-30
    assert elimination.rank(rows) == elimination.rank(base_rows)
    assert len(found.base) + len(dependent(found)) == len(found.parameters)


def dependent(found):
    return {j for p in found.base for j, _ in p.terms} | set(found.without_effect)


def at(case, found, given):
    """Coefficients at other parameters than those of the spec: the formulas must hold there."""
    parameters = [p for p in model_of(case).parameters if p.formula is None]
    values = {
        p.symbol: sp.Float(str(v), 50) for p, v in zip(parameters, given["parameters"], strict=True)
    }

    def number(coefficient):
        assert coefficient.general
        return PRECISE.number(str(sp.N(coefficient.formula.xreplace(values), 50)))

    return number


@pytest.mark.parametrize("case", ["four_bar-nullspace", "four_bar-minimal"])
def test_a_linked_scene_has_base_parameters_in_independent_speeds(case):
    found = found_in(case)
    assert names(found) == ["m(crank)", "m(coupler)", "m(rocker)"]
    assert found.error < 1e-45


def test_multipliers_have_none():
    with pytest.raises(UsageError, match="use --formulation minimal or nullspace"):
        found_in("four_bar-multiplier")


def test_numbers_in_place_of_parameters_give_fractions():
    text = ARM_OF_NUMBERS
    found = base.of(Motion(compile.machine_of(read(text, "arm.yaml"))))
    assert names(found)[0] == "mc_x(upper) + 3/10 m(fore)"
    assert names(found)[2] == "I(upper) + 9/100 m(fore)"


ARM_OF_NUMBERS = """
eom: 1
system: arm
space: plane
gravity: [0, -9.81]
coordinates: {p: "", q: ""}
bodies:
  upper: {mass: 1, inertia: 0.1, frame: {angle: p}, com: [0.15, 0]}
  fore: {mass: 2, inertia: 0.2, frame: {on: upper, at: [0.3, 0], angle: q}, com: [0.1, 0.02]}
"""


def test_a_scene_with_open_parameters_shows_no_values():
    text = ARM_OF_NUMBERS.replace("mass: 2", "mass: m").replace(
        "gravity", "parameters: {m: }\ngravity"
    )
    found = base.of(Motion(compile.machine_of(read(text, "arm.yaml"))))
    assert found.values is None
    assert "   1  mc_x(upper) + 3/10 m(fore) [kg m]" in sheet.text(found)
    assert sheet.as_json(found)["base_parameters"][0]["value"] is None


# ---- formulas of numbers

X, Y = sp.symbols("x y", positive=True)
AT = {X: PRECISE.number("0.7312984471290384712903847123908471290384712908347"),
      Y: PRECISE.number("1.9284712390847123984712390487120394871290384712039")}  # fmt: skip


@pytest.mark.parametrize(
    "formula", [X, -X / 2, X**2 + Y**2, 3 * X * Y - Y / 7, 1 / X**2, 1 / (2 * X * Y), 5 * X + 2]
)
def test_polynomials_are_found(formula):
    number = formula.xreplace({s: sp.Float(str(v), 60) for s, v in AT.items()})
    found = recognise.polynomial(PRECISE.number(str(sp.N(number, 50))), AT)
    assert sp.expand(found - formula) == 0


def test_what_is_no_polynomial_is_not_called_one():
    assert recognise.polynomial(PRECISE.functions["cos"](AT[X]), AT) is None
    assert recognise.rational(PRECISE.functions["sqrt"](PRECISE.number(2))) is None
    assert recognise.rational(PRECISE.number("-0.4318")) == sp.Rational(-2159, 5000)


@pytest.mark.parametrize(
    ("formula", "text"),
    [(sp.S.One, "+ m"), (-X, "- x m"), (X**2 / 2, "+ x^2/2 m"), (1 / (2 * X**2), "+ 1/(2*x^2) m"),
     (-X - Y, "- (x + y) m"), (sp.Rational(-3, 2), "- 3/2 m")],
)  # fmt: skip
def test_coefficients_in_words(formula, text):
    assert Coefficient(PRECISE.number(1), formula).times("m") == text


def test_a_coefficient_without_formula_is_its_number():
    root = PRECISE.functions["sqrt"](PRECISE.number(2))
    assert Coefficient(-root, None).times("m") == "- 1.4142135623730951 m"
    assert mpmath.mpf(Coefficient(root, None).text) == mpmath.sqrt(2)
