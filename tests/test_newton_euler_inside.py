"""Loads along the coordinate of one joint: it transmits all but what the load itself does."""

import json

import numpy as np
import pytest
from scenes import text_of

from eomgen.answers import Question, answers
from eomgen.study import of_text

ARM = text_of("skew_arm")
AS_MOMENT = ARM.replace(
    "springs:\n  - {along: q_2, stiffness: k}\ndampers:\n  - {along: q_2, damping: b}\n", ""
).replace(
    "moment: [2*tau_2/3, -tau_2/3, 2*tau_2/3]",
    "moment: [2*(tau_2 - k*q_2 - b*q_2')/3, -(tau_2 - k*q_2 - b*q_2')/3, "
    "2*(tau_2 - k*q_2 - b*q_2')/3]",
)
SLIDE = """\
eom: 1
system: A carriage on a skew rail of an arm that turns about a skew axis, sprung, damped, driven
space: solid
gravity: [0.3*g, 0, -g]
parameters: {m: 2 kg, g: 9.81 m/s^2, k: 90 N/m, c: 3 N*s/m, l: 0.4 m, n: 0.2 m,
   I1: 0.5 kg*m^2, I2: 0.7 kg*m^2, I3: 0.6 kg*m^2, I12: 0.05 kg*m^2, I13: -0.04 kg*m^2,
   I23: 0.03 kg*m^2}
coordinates: {q: rad, s: m}
inputs: {F: N}
bodies:
  arm: {mass: m, frame: {turn: [[[1, 2, 3], q]]}, com: [n, 0, l],
        inertia: [[I1, I12, I13], [I12, I2, I23], [I13, I23, I3]]}
  carriage:
    {mass: m, frame: {on: arm, at: [3*s/5, l, 4*s/5], turn: [[y, 0.3 rad]]}, com: [n, l, n],
     inertia: [[I1, I12, I13], [I12, I2, I23], [I13, I23, I3]]}
springs: [{along: s, stiffness: k, free_length: l}]
dampers: [{along: s, damping: c}]
forces: [{along: s, force: 2*F}]
initial: {q: 0.4, s: 0.3 m, q': 1 rad/s, s': -0.7 m/s}
"""
HALF = SLIDE.replace("3*s/5, l, 4*s/5", "s/2, l, s")
TWICE = SLIDE.replace("inputs:", "points: {P: {on: arm, at: [s, 0, 0]}}\ninputs:")


def joints(text, state=None):
    study = of_text(text, "scene.yaml")
    (found,) = answers(study, json.dumps(state or {}), Question(joints=True))
    return found["joints"]


INPUTS = {"inputs": {"tau_1": 0.7, "tau_2": -0.4}}


def unit(vector):
    return np.array(vector) / np.linalg.norm(vector)


def turned(axis, angle, vector):
    """Rodrigues' formula."""
    n, v = unit(axis), np.array(vector, dtype=float)
    c, s = np.cos(angle), np.sin(angle)
    return c * v + s * np.cross(n, v) + (1 - c) * (n @ v) * n


def test_spring_and_damper_of_a_skew_elbow_are_moments_about_its_axis():
    one, other = joints(ARM, INPUTS), joints(AS_MOMENT, INPUTS)
    assert one["unknown"] == other["unknown"] == {}
    for name in ("world/upper", "upper/fore"):
        for part in ("force", "moment"):
            assert one[name][part] == pytest.approx(other[name][part], rel=1e-11, abs=1e-11)


def test_an_ideal_hinge_has_no_moment_about_its_axis():
    """Inertia, weight, spring, damper and motor balance there."""
    found = joints(ARM, INPUTS)["upper/fore"]
    axis = turned([1, 2, 2], np.pi / 6, unit([2, -1, 2]))
    assert abs(axis @ found["moment"]) < 1e-12
    assert np.linalg.norm(found["moment"]) > 0.1


def test_an_ideal_slide_has_no_force_along_itself():
    found = joints(SLIDE, {"inputs": {"F": 1.7}})
    assert found["unknown"] == {}
    rail = turned([1, 2, 3], 0.4, [0.6, 0, 0.8])
    force = np.array(found["arm/carriage"]["force"])
    assert abs(rail @ force) < 1e-11
    assert np.linalg.norm(force) > 1


def test_the_joint_above_feels_no_load_that_acts_below_it():
    """With and without spring, damper and drive the whole has the same balance at rest: weight."""
    state = {"rates": {"q": 0, "s": 0}, "inputs": {"F": 1.7}}
    study = of_text(SLIDE, "scene.yaml")
    (found,) = answers(study, json.dumps(state), Question(joints=True))
    hinge = unit([1, 2, 3])
    # the hinge of the arm is ideal too: nothing of the loads reaches it about its axis
    assert abs(hinge @ found["joints"]["world/arm"]["moment"]) < 1e-11


@pytest.mark.parametrize("text", [HALF, TWICE], ids=["not of unit length", "moves a point too"])
def test_what_is_no_joints_own_travel_stays_unknown(text):
    found = joints(text, {"inputs": {"F": 1.7}})
    because = found["unknown"]["arm/carriage"]
    assert any("acts along s" in reason for reason in because)
