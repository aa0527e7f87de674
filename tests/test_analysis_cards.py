"""The card of a constraint: three decided answers and all its forms."""

import json

import pytest
import sympy as sp
from linkages import (
    HOLONOMIC,
    LECTURE,
    RATES,
    TIME,
    R,
    dphi,
    dtheta,
    dx,
    dy,
    lecture,
    machine,
    radius,
    symbol,
    theta,
    x,
    y,
)

from eomgen.algebra.closed import to_sympy
from eomgen.analysis import cards
from eomgen.model import Prescribed, Speed

# row -> name -> (bilateral, scleronomic, holonomic)
ANSWERS = {
    4: {"incline": (True, True, True)},
    5: {"sphere": (True, True, True)},
    6: {"rod": (True, True, True)},
    7: {"outside": (False, True, False)},
    8: {"hoop": (True, True, True), "plane": (True, True, True)},
    9: {"sphere": (True, True, True), "turning": (True, False, True)},
    10: {"rolling": (True, True, False)},
}


def only(coordinates, kind, *residuals, **known):
    """The card of a scene with one constraint `c`."""
    (card,) = cards.report(machine(coordinates, {"c": (kind, *residuals)}, {"R": 1}, **known)).cards
    return card


@pytest.mark.parametrize("row", LECTURE)
def test_the_lecture_answers(row) -> None:
    found = cards.report(lecture(row)).cards
    answers = {c.name: (c.is_bilateral, c.is_scleronomic, c.is_holonomic) for c in found}
    assert answers == ANSWERS[row]
    assert not any(c.hidden or c.redundant for c in found)


def test_the_sphere_in_all_its_forms() -> None:
    (card,) = cards.report(lecture(5)).cards
    z, dz = symbol("z"), symbol("z'")
    delta = [symbol(f"delta {n}") for n in "xyz"]
    assert sp.expand(to_sympy(card.residuals[0]) - (x**2 + y**2 + z**2 - radius**2)) == 0
    assert sp.expand(to_sympy(card.rates[0]) - 2 * (x * dx + y * dy + z * dz)) == 0
    wanted = 2 * (x * delta[0] + y * delta[1] + z * delta[2])
    assert sp.expand(to_sympy(card.virtual[0]) - wanted) == 0


def test_the_virtual_form_is_at_frozen_time() -> None:
    """The hoop turns, and its virtual displacements do not: real and virtual differ."""
    _, card = cards.report(lecture(9)).cards
    assert symbol("w", positive=True) in to_sympy(card.rates[0]).subs({dx: 0, dy: 0}).free_symbols
    slope = sp.tan(symbol("w", positive=True) * TIME)
    wanted = symbol("delta y") - slope * symbol("delta x")
    difference = (to_sympy(card.virtual[0]) - wanted).rewrite(sp.cos)
    at = {TIME: R(1, 7), symbol("w", positive=True): R(3, 2)}
    at |= {symbol("delta x"): R(2, 3), symbol("delta y"): R(5, 3)}
    assert abs(difference.subs(at).evalf(30)) < 1e-25


def test_the_disc_in_json() -> None:
    (card,) = cards.report(lecture(10)).cards
    found = json.loads(json.dumps(cards.to_json(card)))
    assert found["rows"] == ["rolling.x", "rolling.y"]
    assert found["growth"] == [[3, 4], [3, 4]]
    assert (found["bilateral"], found["scleronomic"], found["holonomic"]) == (True, True, False)
    assert found["virtual"][0] == "-R*delta phi*cos(theta) + delta x"


def test_what_is_called_nonholonomic_is_decided() -> None:
    card = only("x phi", RATES, dx - radius * dphi)
    assert card.kind == "nonholonomic"
    assert card.is_holonomic
    assert card.is_hidden_form_known
    found = cards.to_json(card)["hidden"]
    assert found == [{"of": {"c": "1"}, "relation": "-R*phi + x", "factor": "1", "constants": []}]


def test_the_sleigh_stays_nonholonomic() -> None:
    card = only("x y theta", RATES, dx * sp.sin(theta) - dy * sp.cos(theta))
    assert not card.is_holonomic
    assert card.growth == ((2, 3),)


def test_time_that_cancels_is_no_time() -> None:
    hidden_time = sp.Add(TIME * x, -TIME * x, x - y, evaluate=False)
    assert only("x y", HOLONOMIC, hidden_time).is_scleronomic
    assert not only("x y", HOLONOMIC, x - y * sp.exp(sp.sin(TIME))).is_scleronomic


def test_prescribed_motions_make_it_rheonomic() -> None:
    w, dw, ddw = (symbol(n) for n in ("w", "w'", "w''"))
    shaken = (Prescribed("w", w, dw, ddw, sp.sin(TIME)),)
    assert not only("x y", HOLONOMIC, x - w, prescribed=shaken).is_scleronomic
    assert not only("x y", RATES, dx - dw, prescribed=shaken).is_scleronomic
    assert not only("x y", RATES, dx - 3).is_scleronomic  # x - 3 t


def test_redundant_rows_are_on_the_card() -> None:
    rows = {"first": (HOLONOMIC, x - y), "again": (HOLONOMIC, 2 * x - 2 * y)}
    first, again = cards.report(machine("x y", rows)).cards
    assert (first.redundant, again.redundant) == ((), ("again",))


def test_the_report_counts_hidden_relations() -> None:
    found = cards.report(machine("x phi", {"c": (RATES, dx - radius * dphi)}, {"R": 1}))
    assert (found.freedom.degrees_of_freedom, found.freedom.minimal_coordinates) == (1, 1)
    disc = cards.report(lecture(10)).freedom
    assert (disc.degrees_of_freedom, disc.minimal_coordinates) == (2, 4)


def test_quasi_velocities_do_not_change_the_card() -> None:
    u = Speed("u", symbol("u"), symbol("u'"), dx + dtheta)
    v = Speed("v", symbol("v"), symbol("v'"), dtheta)
    card = only("x theta", RATES, dx - radius * dtheta, speeds=(u, v))
    assert card.is_holonomic
    assert to_sympy(card.rates[0]) == dx - radius * dtheta
