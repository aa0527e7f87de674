"""Friction on two-sided constraints: a bead on a wire, Painleve's rod, a body on a rough plane."""

import json
from functools import cache

import numpy as np
import pytest
from scenes import study_of

from eomgen.answers import Question, answers
from eomgen.errors import CheckError, SpecError, UsageError
from eomgen.outputs import Wish, rendered
from eomgen.spec import read
from eomgen.study import of_model, of_text
from eomgen.wanted import Wanted

ENGINES = ("interpreter", "c", "python")
BLOCK = """\
eom: 1
system: A block of full inertia in a rough slot between two skew planes
space: solid
gravity: [0, 0, -g]
parameters:
  {m: 2 kg, g: 9.81 m/s^2, mu: 0.3, a: 0.3 m, b: -0.2 m, c: 0.4 m, k: 0.5, n: -0.3,
   I1: 0.5 kg*m^2, I2: 0.7 kg*m^2, I3: 0.6 kg*m^2, I12: 0.05 kg*m^2, I13: -0.04 kg*m^2,
   I23: 0.03 kg*m^2}
coordinates: {x: m, y: m, z: m, alpha: rad, beta: rad, gamma: rad}
inputs: {F: N}
points: {P: {on: block, at: "[a, b, c]"}}
bodies:
  block:
    mass: m
    at: "[x, y, z]"
    turn: [[z, alpha], [y, beta], [x, gamma]]
    inertia: [[I1, I12, I13], [I12, I2, I23], [I13, I23, I3]]
forces: [{on: block, force: "[0, 0, F]"}]
constraints:
  slot:
    holonomic: "PZ - k*PX - n*PY = 0"
    friction: mu
    reaction: press
initial: {x: 0.1 m, y: 0.2 m, alpha: 0.3, beta: -0.4, gamma: 0.5, x': 0.7 m/s, y': -0.2 m/s,
          alpha': 0.5 rad/s, beta': 0.2 rad/s, gamma': -0.6 rad/s, guess: {z: -0.3 m}}
outputs: {u: x''}
"""
PX = (
    "(x + a*cos(alpha)*cos(beta) + b*(cos(alpha)*sin(beta)*sin(gamma) - sin(alpha)*cos(gamma))"
    " + c*(cos(alpha)*sin(beta)*cos(gamma) + sin(alpha)*sin(gamma)))"
)
PY = (
    "(y + a*sin(alpha)*cos(beta) + b*(sin(alpha)*sin(beta)*sin(gamma) + cos(alpha)*cos(gamma))"
    " + c*(sin(alpha)*sin(beta)*cos(gamma) - cos(alpha)*sin(gamma)))"
)
PZ = "(z - a*sin(beta) + b*cos(beta)*sin(gamma) + c*cos(beta)*cos(gamma))"
for short, long in (("PX", PX), ("PY", PY), ("PZ", PZ)):
    BLOCK = BLOCK.replace(short, long)


def ask(name, state, **question):
    (found,) = answers(study_of(name), json.dumps(state), Question(**question))
    return found


def on_wire(x, speed, **parameters):
    """A state of the bead, `speed` along the wire."""
    slope = 2 * x / 0.8
    rate = speed / np.hypot(1, slope)
    return {
        "coordinates": {"x": repr(float(x)), "y": repr(float(x * x / 0.8))},
        "rates": {"x": repr(float(rate)), "y": repr(float(slope * rate))},
        "parameters": parameters,
    }


@pytest.mark.parametrize("using", ENGINES)
@pytest.mark.parametrize(("x", "speed"), [(0.5, -1.6), (-0.3, -0.7), (0.1, 2.0), (0.4, 1.1)])
def test_the_bead_is_braked_by_mu_n(x, speed, using) -> None:
    """v' = -g sin a - sign(v) mu (g cos a + v^2/R), R = p/(2 cos^3 a)."""
    found = ask("bead_on_rough_wire", on_wire(x, speed), using=using)
    angle = np.arctan(2 * x / 0.8)
    press = 9.81 * np.cos(angle) + speed**2 * 2 * np.cos(angle) ** 3 / 0.8
    along = -9.81 * np.sin(angle) - np.sign(speed) * 0.3 * press
    mode = "slip_plus" if speed > 0 else "slip_minus"
    assert found["contacts"]["holds"] == [mode]
    # x'' = v' cos a - v a' sin a, a' = v/R
    turn = speed * 2 * np.cos(angle) ** 3 / 0.8
    expected = along * np.cos(angle) - speed * turn * np.sin(angle)
    assert found["accelerations"]["x"] == pytest.approx(expected, rel=1e-12)
    forces = found["contacts"]["modes"][mode]["surface_forces"]["wire"]
    assert forces["normal"] == pytest.approx(0.2 * press, rel=1e-12)
    assert forces["friction"] == [pytest.approx(-np.sign(speed) * 0.06 * press, rel=1e-12)]
    # the named reaction is the normal force on the bead
    x_part, y_part = (found["reactions"]["wire_force"][axis] for axis in "xy")
    assert np.hypot(x_part, y_part) == pytest.approx(0.2 * press, rel=1e-12)


@pytest.mark.parametrize(
    ("x", "mode"), [(0.1, "stick"), (-0.11, "stick"), (0.13, "slip_minus"), (-0.13, "slip_plus")]
)
def test_at_rest_the_slope_decides(x, mode) -> None:
    """tan(a) = 2 x/p against mu = 0.3: at rest it sticks up to x = 0.12 m, else it slides down."""
    found = ask("bead_on_rough_wire", on_wire(x, 0.0))
    assert found["contacts"]["holds"] == [mode]
    assert (abs(found["accelerations"]["x"]) < 1e-12) == (mode == "stick")


def test_without_a_mode_nothing_is_shown_as_the_motion() -> None:
    study = study_of("bead_on_rough_wire")
    names = {f.name for f in study.program.functions}
    assert names.isdisjoint({"accelerations", "state_derivative", "multipliers"})
    assert {"accelerations_stick", "multipliers_slip_plus", "project_rates"} <= names
    (text,) = rendered(study, Wish(("text",))).values()
    assert "Coulomb friction, with the coefficient μ" in text
    assert "These are the equations without friction." in text
    (notes,) = rendered(study, Wish(("latex",), language="es")).values()
    assert "Estas son las ecuaciones sin rozamiento." in notes


@pytest.mark.parametrize("wanted", ["minimal", "nullspace"])
def test_only_multipliers_know_the_normal_force(wanted) -> None:
    model = study_of("bead_on_rough_wire").model
    with pytest.raises(UsageError, match=f"{wanted}: a constraint with friction needs all"):
        of_model(model, Wanted(wanted))


def rod(phi, mu, slip, state=None):
    given = {
        "coordinates": {"phi": repr(float(phi)), "y": repr(float(0.7 * np.sin(phi)))},
        "rates": {"x": slip, "phi": 0, "y": 0},
        "parameters": {"mu": mu},
    }
    return ask("painleve_rod", {**given, **(state or {})})


def fitting_forces(phi, mu, slip):
    """N of m y'' = N - m g, m x'' = F, J phi'' = moment, y = l sin phi, F = -mu |N| sign(slip)."""
    m, half, g = 2.0, 0.7, 9.81
    found = []
    for side in (1, -1):
        # phi'' = (half/J) (-cos N + sin F), y'' = half cos phi''  at phi' = 0
        drag = -mu * side * np.sign(slip)
        per_force = half / (m * half**2 / 3) * (-np.cos(phi) + np.sin(phi) * drag)
        # N/m - g = half cos phi per_force N
        force = g / (1 / m - half * np.cos(phi) * per_force)
        found += [force] if force * side > 0 else []
    return found


def test_painleves_rod_has_one_motion_below_four_thirds() -> None:
    phi = np.arctan(2)
    found = rod(phi, 1.3, 1)
    assert found["contacts"]["holds"] == ["slip_plus"]
    (force,) = fitting_forces(phi, 1.3, 1)
    mode = found["contacts"]["modes"]["slip_plus"]
    assert mode["surface_forces"]["rail"]["normal"] == pytest.approx(force, rel=1e-12)


@pytest.mark.parametrize(("slip", "count"), [(-1, 2), (1, 2)])
def test_painleves_rod_jams_above_four_thirds_and_it_is_said(slip, count) -> None:
    phi = np.arctan(2)
    assert len(fitting_forces(phi, 1.5, slip)) in (0, 2)
    found = rod(phi, 1.5, slip)
    name = "slip_plus" if slip > 0 else "slip_minus"
    mode, forces = found["contacts"]["modes"][name], fitting_forces(phi, 1.5, slip)
    assert "accelerations" not in {*mode, *found}
    assert mode["margins"][0] < 0
    words = f"{len(forces)} normal forces satisfy" if forces else "no normal force satisfies"
    assert mode["undetermined"].startswith("friction jams (Painleve's paradox): " + words)
    assert found["contacts"]["holds"] == []
    assert "no mode holds" in found["contacts"]["because"]
    assert found.keys().isdisjoint({"multipliers", "reactions"})


def test_a_pull_turns_two_forces_into_none() -> None:
    """With the weight reversed the same paradox has the other face."""
    counts = set()
    for g in ("9.81", "-9.81"):
        found = rod(np.arctan(2), 1.5, 1, {"parameters": {"mu": 1.5, "g": g}})
        counts.add(found["contacts"]["modes"]["slip_plus"]["undetermined"].split(": ")[1][:2])
    assert counts == {"no", "2 "}


@cache
def block():
    return of_text(BLOCK, "block.yaml")


@pytest.mark.parametrize("push", ["-40", "60"])
@pytest.mark.parametrize("using", ENGINES)
def test_a_body_of_full_inertia_rubs_in_a_skew_slot(push, using) -> None:
    """The forces at P are the ones in Newton's law; friction is against the slip, mu |N|."""
    (found,) = answers(block(), json.dumps({"inputs": {"F": push}}), Question(using=using))
    assert found["contacts"]["holds"] == ["slip"]
    mode = found["contacts"]["modes"]["slip"]
    force = 2 * np.array([found["accelerations"][q] for q in "xyz"])
    force += [0, 0, 2 * 9.81 - float(push)]
    normal = np.array([-0.5, 0.3, 1]) / np.sqrt(0.25 + 0.09 + 1)
    shown = mode["surface_forces"]["slot"]
    assert shown["on"] == "P"
    assert force @ normal == pytest.approx(shown["normal"], rel=1e-10)
    rub = force - (force @ normal) * normal
    assert np.linalg.norm(rub) == pytest.approx(0.3 * abs(shown["normal"]), rel=1e-10)
    assert np.hypot(*shown["friction"]) == pytest.approx(0.3 * abs(shown["normal"]), rel=1e-10)
    assert mode["outputs"]["u"] == pytest.approx(found["accelerations"]["x"], rel=1e-12)
    assert found["outputs"] == mode["outputs"]


def test_the_slot_presses_on_both_sides() -> None:
    sides = set()
    for push in ("-40", "60"):
        (found,) = answers(block(), json.dumps({"inputs": {"F": push}}), Question())
        mode = found["contacts"]["modes"]["slip"]
        sides.add(np.sign(mode["surface_forces"]["slot"]["normal"]))
    assert sides == {1, -1}


def test_claims_on_the_motion_are_refused_and_those_on_positions_are_not() -> None:
    text = BLOCK + "expect: {dof: 5, equations: [\"x'' = y''\"], conserved: [\"m*x'\"]}\n"
    with pytest.raises(CheckError) as caught:
        of_text(text, "block.yaml")
    assert str(caught.value).count("but slot has friction") == 2


def test_joints_beside_a_rough_guide_are_not_told() -> None:
    found = ask("painleve_rod", {}, joints=True)
    (because,) = found["joints"]["unknown"].values()
    assert because == ("every acceleration depends on whether rail sticks or slides",)


def test_a_pin_has_no_surface() -> None:
    text = BLOCK.partition("constraints:")[0]
    text += "constraints: {pin: {holonomic: P = block, friction: mu}}\n"
    with pytest.raises(SpecError, match="'friction' needs a surface"):
        read(text, "pin.yaml")


def test_a_coefficient_of_zero_changes_nothing() -> None:
    text = BLOCK.replace("friction: mu", "friction: 0")
    found = of_text(text, "block.yaml")
    assert "accelerations" in {f.name for f in found.program.functions}
    assert found.links.formulations == ("minimal", "nullspace", "multiplier")
