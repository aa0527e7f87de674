"""Declared speeds beside constraints: the same motion as over the rates, and the textbook's."""

import json
from functools import cache

import mpmath
import numpy as np
import pytest
from scenes import text_of

from eomgen.answers import Question, answers
from eomgen.checks import samples
from eomgen.errors import UsageError
from eomgen.study import of_text
from eomgen.wanted import Wanted

# body-fixed rates of the disc about tangent, axle and the third axis, and the slip velocities
TILTING = """\
speeds:
  w1: theta'
  w2: phi' + psi'*sin(theta)
  w3: psi'*cos(theta)
  s1: x' - R*(phi' + psi'*sin(theta))*cos(psi) - R*theta'*sin(psi)*cos(theta)
  s2: y' - R*(phi' + psi'*sin(theta))*sin(psi) + R*theta'*cos(psi)*cos(theta)
"""
PENDULUM = """\
eom: 1
system: Pendulum in Cartesian coordinates, the pivot shaken
space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 0.5 m, g: 9.81 m/s^2, A: 0.05 m, W: 3 rad/s}
prescribed: {s: A*sin(W*t)}
coordinates: {x: m, y: {unit: m, role: linked}}
bodies: {bob: {mass: m, at: [x, y]}}
constraints:
  rod: {holonomic: (x - s)^2 + y^2 = l^2, reaction: rod_force}
initial: {x: 0.3 m, x': 0.8 m/s, guess: {y: -0.4 m}}
"""
POLAR = "speeds: {out: x*x' + y*y' - l*s', turn: x*y' - y*x' + x*l*W}\n"
LOOP = """\
eom: 1
system: Skew arm of two links whose hand stays on a plane
space: solid
gravity: [0, 0, -g]
parameters:
  {m: 2 kg, g: 9.81 m/s^2, l: 0.6 m, d: 0.1 m, I1: 0.5 kg*m^2, I2: 0.7 kg*m^2, I3: 0.6 kg*m^2,
   I12: 0.05 kg*m^2, I13: -0.04 kg*m^2, I23: 0.03 kg*m^2}
coordinates: {p: rad, q: rad, r: rad}
inputs: {tau: N*m}
bodies:
  upper:
    {mass: m, frame: {turn: [[[1, 2, 3], p]]}, com: [0, d, l/2],
     inertia: [[I1, I12, I13], [I12, I2, I23], [I13, I23, I3]]}
  lower:
    {mass: m, frame: {on: upper, at: [0, 0, l], turn: [[[2, -1, 1], q], [x, r]]}, com: [d, 0, l/2],
     inertia: [[I1, I12, I13], [I12, I2, I23], [I13, I23, I3]]}
points: {hand: {on: lower, at: [0, 0, l]}}
moments: [{on: lower, from: upper, moment: [tau, 0, 0], in: upper}]
constraints:
  level: {nonholonomic: "p' + 0.4*cos(q)*q' - 0.3*sin(p)*r' = 0"}
initial: {p: 0.4, q: 0.3, r: 0.5, p': 0.2 rad/s, q': 0.5 rad/s, guess: {r': 1 rad/s}}
"""
MIXED = "speeds: {a: p' + q', b: q' - r'*cos(p), c: r' + 0.2*p'}\n"
OWN = text_of("sleigh_speeds").partition("\nspeeds:")[2].partition("points:")[0]
OWN = f"speeds:{OWN}"
ALONG, ACROSS = "x'*cos(theta) + y'*sin(theta)", "y'*cos(theta) - x'*sin(theta)"
PAIRS = {
    "sleigh": (
        text_of("sleigh_speeds")
        .replace(OWN, "")
        .replace("w = 0", f"{ACROSS} = 0")
        .replace("*v\n", f"*({ALONG})\n")
        .replace("*v^2", f"*({ALONG})^2")
        .replace("r^2", "theta'^2"),
        text_of("sleigh_speeds"),
    ),
    "disc": (text_of("rolling_disc_tilting"), text_of("rolling_disc_tilting") + TILTING),
    "pendulum": (PENDULUM, PENDULUM + POLAR),
    "arm": (LOOP, LOOP + MIXED),
}
EACH = pytest.mark.parametrize("name", PAIRS)


@cache
def studies(name):
    return tuple(of_text(text, f"{name}.yaml") for text in PAIRS[name])


def admissible(study):
    """State files of the sampled states, by rates."""
    names = [c.name for c in study.model.coordinates]
    drawn = samples.draw(study.model, seed=3)

    def text(values):
        return {n: mpmath.nstr(v, 40) for n, v in zip(names, values, strict=True)}

    found = [
        {
            "t": mpmath.nstr(at.state.time, 40),
            "coordinates": text(at.state.coordinates),
            "rates": text(at.state.rates),
            "inputs": {k.name: v[i] for k, v in zip(study.model.inputs, drawn.inputs, strict=True)},
        }
        for i, at in enumerate(study.links.scene.report.states)
    ]
    return json.dumps(found)


@EACH
def test_every_formulation_is_there_and_agrees(name):
    # the sleigh over its rates has no null space: neither x' nor y' can stay dependent as it turns
    assert studies(name)[1].links.formulations == ("nullspace", "multiplier")
    with pytest.raises(UsageError, match="minimal: "):
        of_text(PAIRS[name][1], "a.yaml", Wanted("minimal"))


@pytest.mark.parametrize("using", ["interpreter", "c", "python"])
@EACH
def test_the_motion_is_the_one_over_the_rates(name, using):
    over_rates, over_speeds = studies(name)
    text = admissible(over_rates)
    one = answers(over_rates, text, Question(using=using))
    other = answers(over_speeds, text, Question(using=using))
    for a, b in zip(one, other, strict=True):
        for group in ("accelerations", "multipliers", "energy"):
            size = max(map(abs, a[group].values())) or 1
            assert b[group].keys() == a[group].keys()
            assert all(abs(b[group][k] - v) < 1e-10 * size for k, v in a[group].items())
        for reaction, parts in a["reactions"].items():
            for axis in set(parts) - {"on"}:
                assert b["reactions"][reaction][axis] == pytest.approx(parts[axis], rel=1e-9)


@EACH
def test_the_jacobian_is_j_n(name):
    """Rows over the speeds times dq'/du: finite differences of the rate residual, exact in u."""
    study = studies(name)[1]
    program = study.links.full_program()
    from eomgen.interpreter import FLOAT, run

    state = study.links.scene.report.states[0].state
    size = len(state.coordinates)
    given = {
        "time": [float(state.time)],
        "state": [*map(float, state.coordinates), *[0.0] * size],
        "inputs": [0.0] * len(study.model.inputs),
        "parameters": [float(v) for v in state.parameters],
    }

    def rates(u):
        moved = given | {"state": [*given["state"][:size], *u]}
        return np.array(run(program.function("constraint_rates"), moved, FLOAT))

    jacobian = np.array(run(program.function("constraint_jacobian"), given, FLOAT))
    columns = [rates(np.eye(size)[k]) - rates(np.zeros(size)) for k in range(size)]
    np.testing.assert_allclose(
        jacobian.reshape(-1, size), np.array(columns).T, rtol=1e-12, atol=1e-12
    )


@EACH
def test_projection_reaches_the_constraints(name):
    study = studies(name)[1]
    (first, *_) = json.loads(admissible(study))
    moved = next(iter(first["rates"]))
    first["rates"][moved] = str(float(first["rates"][moved]) + 0.01)
    place = next(iter(first["coordinates"]))
    first["coordinates"][place] = str(float(first["coordinates"][place]) + 0.001)
    (found,) = answers(study, json.dumps(first), Question(project=True))
    residuals = [v for group in found["residuals"].values() for v in group.values()]
    assert max(map(abs, residuals)) < 1e-12


def test_the_sleigh_has_the_equations_of_the_textbook():
    """v' = a r^2, r' = -m a v r/(I + m a^2)."""
    state = {"coordinates": {"theta": 0.7, "x": 1, "y": -2}, "speeds": {"v": 1.3, "w": 0, "r": 0.8}}
    (found,) = answers(studies("sleigh")[1], json.dumps(state), Question())
    turn = -3 * 0.25 * 1.3 * 0.8 / (0.2 + 3 * 0.25**2)
    expected = {"v": 0.25 * 0.8**2, "w": 0, "r": turn}
    assert found["speed_derivatives"] == pytest.approx(expected, rel=1e-12, abs=1e-13)


def test_the_independent_speeds_are_the_authors():
    """w = 0 leaves v and r; the slip velocities vanish and leave the turning of the disc."""
    for name, kept in (("sleigh", ["v", "r"]), ("disc", ["w1", "w2", "w3"])):
        made = of_text(PAIRS[name][1], f"{name}.yaml", Wanted("nullspace"))
        assert [s.name for s in made.program.speeds] == kept
        assert all(s.value is not None for s in made.program.speeds)


def test_a_state_by_speeds_off_the_constraint_is_refused():
    from eomgen.errors import CheckError

    state = {"speeds": {"v": 1.3, "w": 0.1, "r": 0.8}}
    with pytest.raises(CheckError, match=r"blade has the residual 0\.1"):
        answers(studies("sleigh")[1], json.dumps(state), Question())


def test_the_null_space_has_the_jacobian_of_all_rates():
    """It is d rate / d q', also where the dependent rates are formulas of the others."""
    for name in ("chaplygin_sleigh", "four_bar", "bead_on_fixed_hoop"):
        from eomgen.interpreter import FLOAT, run

        full, reduced = (
            of_text(text_of(name), f"{name}.yaml", Wanted(w)) for w in ("multiplier", "nullspace")
        )
        state = full.links.scene.report.states[0].state
        given = {
            "time": [0.0],
            "state": [*map(float, state.coordinates), *[0.0] * len(state.coordinates)],
            "inputs": [0.0] * len(full.model.inputs),
            "parameters": [float(v) for v in state.parameters],
        }
        values = [
            run(s.program.function("constraint_jacobian"), given, FLOAT) for s in (full, reduced)
        ]
        assert values[0] == pytest.approx(values[1], rel=1e-14)
        assert np.abs(values[0]).max() > 0.01
