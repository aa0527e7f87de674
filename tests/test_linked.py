"""Linked scenes: every formulation gives the same motion, reactions are forces in newton."""

import json
from dataclasses import replace

import mpmath
import pytest
from scenes import HERE
from spec_samples import FOUR_BAR

from eomgen import study_linked
from eomgen.algebra.arithmetic import FLOAT
from eomgen.answers import Question, answers
from eomgen.checks import links, samples
from eomgen.errors import CheckError, UsageError
from eomgen.interpreter import run
from eomgen.mechanics import multipliers
from eomgen.spec import read
from eomgen.study import of_text
from eomgen.wanted import NAMES, Wanted
from eomgen.wanted import wanted as wish

PENDULUM = """\
eom: 1
system: Pendulum in Cartesian coordinates
space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 0.5 m, g: 9.81 m/s^2}
coordinates: {x: m, y: {unit: m, role: linked}}
bodies: {bob: {mass: m, at: [x, y]}}
constraints:
  rod: {holonomic: x^2 + y^2 = l^2, reaction: rod_force}
initial: {x: 0.3 m, x': 0.8 m/s, guess: {y: -0.4 m}}
"""

DISC = """\
eom: 1
system: Upright rolling disc
space: solid
gravity: [0, 0, -g]
parameters: {m: 2 kg, R: 0.3 m, g: 9.81 m/s^2, I_d: m*R^2/4, I_a: m*R^2/2}
coordinates: {x: m, y: m, theta: rad, phi: rad}
bodies:
  disc: {mass: m, at: [x, y, R], turn: [[z, theta], [y, phi]], inertia: [I_d, I_a, I_d]}
constraints:
  no_slip_x: {nonholonomic: x' - R*phi'*cos(theta) = 0}
  no_slip_y: {nonholonomic: y' - R*phi'*sin(theta) = 0}
initial: {x: 0 m, y: 0 m, theta: 20 deg, phi: 0, theta': 0.7 rad/s, phi': 3 rad/s}
"""

SCENES = {"four_bar": FOUR_BAR, "pendulum": PENDULUM, "disc": DISC}
STUDIES = {name: study_linked.of_model(read(t, f"{name}.yaml")) for name, t in SCENES.items()}
LINKED = pytest.mark.parametrize("name", SCENES)


@LINKED
def test_all_formulations_are_there_and_agree(name):
    found = STUDIES[name].formulations
    assert found == (("nullspace", "multiplier") if name == "disc" else NAMES[1:])


@LINKED
def test_a_wrong_formulation_is_seen(name, monkeypatch):
    """A sign in the solution with multipliers is noticed by the others."""
    original = multipliers._corrected
    monkeypatch.setattr(
        multipliers, "_corrected", lambda v, c, s: original(v, c, [-1 * x for x in s])
    )
    with pytest.raises(CheckError, match="differ"):
        study_linked.of_model(read(SCENES[name], f"{name}.yaml"))


@LINKED
def test_wrong_rows_are_seen(name):
    study = STUDIES[name]
    first = study.derivation.constraints[0]
    wrong = replace(first, gamma=first.gamma + first.jacobian[0] * 3 + 1)
    tampered = replace(study.derivation, constraints=(wrong, *study.derivation.constraints[1:]))
    with pytest.raises(CheckError, match="constraint rows"):
        links.rows(tampered, study.machine, samples.draw(study.scene.model))


def ask(name, state="{}", **question):
    study = of_text(SCENES[name], f"{name}.yaml")
    return answers(study, state, Question(**question))


FREE = '{"inputs": {"tau": 0.1}}'


@pytest.mark.parametrize("using", ["interpreter", "c", "python"])
@LINKED
def test_engines_agree_with_50_digits(name, using):
    state = FREE if name == "four_bar" else "{}"
    (exact,), (found,) = ask(name, state, digits=50), ask(name, state, using=using)
    for group in ("accelerations", "multipliers", "energy"):
        wanted = {k: float(mpmath.mpf(v)) for k, v in exact[group].items()}
        size = max(map(abs, wanted.values())) or 1.0
        assert all(abs(found[group][k] - v) < 1e-12 * size for k, v in wanted.items())


def test_rod_force_is_the_tension_of_the_pendulum():
    (found,) = ask("pendulum")
    x, y, speed = 0.3, -0.4, 0.8
    velocity = speed**2 * (1 + (x / y) ** 2)
    # towards the pivot: m v^2/l + m g cos(angle), cos(angle) = -y/l
    tension = 2 * velocity / 0.5 + 2 * 9.81 * 0.8
    force = found["reactions"]["rod_force"]
    assert force["on"] == "bob"
    assert force["x"] == pytest.approx(-tension * x / 0.5, rel=1e-12)
    assert force["y"] == pytest.approx(-tension * y / 0.5, rel=1e-12)


def test_joint_of_the_free_pendulum_is_the_rod_force():
    free = of_text((HERE.parent / "specs" / "simple_pendulum.yaml").read_bytes(), "a.yaml")
    (found,) = answers(free, "{}", Question(joints=True))
    x, y = found["joints"]["world/bob"]["force"]
    assert (x**2 + y**2) ** 0.5 == pytest.approx(0.5 * 9.81 * 0.5, rel=1e-12)
    assert x / y == pytest.approx(-(3**0.5), rel=1e-12)


def test_joints_need_admissible_states():
    with pytest.raises(UsageError, match="without --project"):
        ask("pendulum", joints=True, project=True)


def test_pin_force_moves_the_rocker():
    """The opposite of the pin force on C turns the rocker about D as Euler says."""
    (found,) = ask("four_bar", FREE)
    study = STUDIES["four_bar"]
    angle = float(study.scene.report.initial.state.coordinates[2])
    force, length = found["reactions"]["pin_C"], 0.4
    mass = 1.2 * length
    on_rocker = [-force["x"], -force["y"]]
    arm = [length * float(mpmath.cos(angle)), length * float(mpmath.sin(angle))]
    moment = arm[0] * on_rocker[1] - arm[1] * on_rocker[0] - mass * 9.81 * arm[0] / 2
    assert moment == pytest.approx(mass * length**2 / 3 * found["accelerations"]["q3"], rel=1e-9)


def test_disc_rolls_at_constant_speed():
    (found,) = ask("disc")
    c, s = mpmath.cos(mpmath.pi / 9), mpmath.sin(mpmath.pi / 9)
    # the centre turns with theta' at the constant speed R phi'
    assert found["accelerations"]["phi"] == pytest.approx(0, abs=1e-12)
    assert found["accelerations"]["x"] == pytest.approx(-0.9 * 0.7 * float(s), rel=1e-12)
    assert found["accelerations"]["y"] == pytest.approx(0.9 * 0.7 * float(c), rel=1e-12)


def test_a_state_off_the_constraints_is_refused_or_projected():
    state = json.dumps({"coordinates": {"x": "0.31"}})
    with pytest.raises(CheckError, match=r"state 1: the state is off the constraints: rod has"):
        ask("pendulum", state)
    (found,) = ask("pendulum", state, project=True)
    assert abs(found["residuals"]["position"]["rod"]) < 1e-12
    assert abs(found["residuals"]["rate"]["rod"]) < 1e-12


def test_projection_needs_constraints():
    free = of_text((HERE.parent / "specs" / "simple_pendulum.yaml").read_bytes(), "a.yaml")
    with pytest.raises(UsageError, match="no constraints"):
        answers(free, "{}", Question(project=True))


def test_missing_values_are_not_made_up():
    text = DISC.replace("theta': 0.7 rad/s, ", "")
    with pytest.raises(UsageError, match="theta is missing"):
        answers(of_text(text, "disc.yaml"), "{}", Question())


def test_no_formula_is_chosen_that_the_motion_may_leave():
    """Without a range x may come to l, where y = -sqrt(l^2 - x^2) ends; with one it does not."""
    text = PENDULUM.replace(", reaction: rod_force", "")
    assert of_text(text, "a.yaml").links.chosen.name == "nullspace"
    asked = of_text(text, "a.yaml", Wanted(formulation="minimal"))
    assert asked.links.chosen.name == "minimal"
    narrow = text + "range: {x: [-0.35 m, 0.35 m]}\n"
    assert of_text(narrow, "a.yaml").links.chosen.name == "minimal"


REFUSED = [
    (DISC, "minimal", "a nonholonomic constraint eliminates no coordinate"),
    (PENDULUM.replace("guess: {y: -0.4 m}", "guess: {y: -0.4 m}}\nrange: {x: [-0.5 m, 0.5 m]"),
     "minimal", "W-DEAD"),
    (FOUR_BAR.replace("constraints:\n  loop: {holonomic: C = Cr, reaction: pin_C}",
                      "constraints:\n  gap: {unilateral: q2 >= -10}").replace(", role: linked", "")
     .replace(", role: free", "").replace("dof: 1", "dof: 3")
     .replace("guess: {q2: 20 deg, q3: 80 deg}", "q2: 20 deg, q3: 80 deg"),
     "nullspace", "a one-sided constraint needs all coordinates"),
]  # fmt: skip


FIXED = PENDULUM.replace("  rod:", "  flat: {holonomic: y = 2*x - 1*l}\n  rod:").replace(
    "x': 0.8 m/s, guess: {y: -0.4 m}", "guess: {y: -0.1 m}"
)


@pytest.mark.parametrize("wanted", ["nullspace", "minimal"])
def test_what_cannot_move_has_no_speeds(wanted):
    with pytest.raises(UsageError, match="hold everything fast"):
        study_linked.of_model(read(FIXED, "a.yaml"), Wanted(wanted))


@pytest.mark.parametrize(("text", "wanted", "words"), REFUSED)
def test_a_formulation_that_does_not_exist_says_why(text, wanted, words):
    with pytest.raises(UsageError, match=words):
        study_linked.of_model(read(text, "a.yaml"), Wanted(wanted))


def test_auto_says_why():
    assert STUDIES["four_bar"].chosen.why == "reactions are asked for"
    plain = study_linked.of_model(read(FOUR_BAR.replace(", reaction: pin_C", ""), "a.yaml"))
    assert (plain.chosen.name, plain.chosen.why) == (
        "minimal",
        "q3, q2 eliminated in closed form, branch q3: +1",
    )


def test_a_false_number_of_degrees_of_freedom_is_named():
    with pytest.raises(CheckError, match="dof is 1, by the rank of the constraints, not 2"):
        of_text(FOUR_BAR.replace("dof: 1", "dof: 2"), "a.yaml")


@pytest.mark.parametrize("wanted", NAMES[1:])
def test_programs_start_on_the_constraints(wanted):
    program = of_text(FOUR_BAR, "a.yaml", Wanted(wanted)).program
    assert all(v.value is not None for v in (*program.coordinates, *program.speeds))


def test_baumgarte_is_exact_on_the_constraints_and_pulls_back_off_them():
    plain = of_text(PENDULUM, "a.yaml", Wanted("multiplier")).program
    asked = of_text(PENDULUM, "a.yaml", wish("auto", "10", "0.02")).program
    on = {"state": [0.3, -0.4, 0.8, 0.6], "parameters": [2.0, 0.5, 9.81]}
    off = {**on, "state": [0.31, -0.4, 0.8, 0.6]}
    free, pulled = (run(p.function("accelerations"), on, FLOAT) for p in (plain, asked))
    assert pulled == pytest.approx(free, rel=1e-12)
    x, y = run(asked.function("accelerations"), off, FLOAT)
    # phi'' + 2 alpha phi' + alpha^2 phi = 0
    second = 2 * (0.31 * x - 0.4 * y + 0.8**2 + 0.6**2)
    first, zeroth = 2 * (0.31 * 0.8 - 0.4 * 0.6), 0.31**2 + 0.4**2 - 0.25
    assert second + 20 * first + 100 * zeroth == pytest.approx(0, abs=1e-12)


BAD_WISHES = [
    (("auto", "10", None), "needs --step"),
    (("auto", None, "0.1"), "needs --step"),
    (("auto", "10", "0.1"), "at most 2 for the step 0.1"),
    (("minimal", "1", "0.1"), "not the formulation minimal"),
    (("auto", "-1", "0.1"), "not a positive decimal"),
    (("auto", "1/3", "0.1"), "not a positive decimal"),
    (("auto", "nan", "0.1"), "not a positive decimal"),
]


@pytest.mark.parametrize(("given", "words"), BAD_WISHES)
def test_baumgarte_is_capped(given, words):
    with pytest.raises(UsageError, match=words):
        wish(*given)


def test_a_motion_without_inertia_is_named():
    text = PENDULUM.replace("y: {unit: m, role: linked}", "y: m, z: m").partition("constraints")[0]
    with pytest.raises(UsageError, match=r"E-MASS: .*the motion z [+-]1 has no inertia"):
        of_text(text, "a.yaml")


def test_a_block_that_turns_singular_is_refused():
    """A crank of any angle cannot have its slider's rate as the only speed."""
    text = PENDULUM.replace("y: {unit: m, role: linked}", "y: {unit: m, role: free}")
    text = text.replace("{x: m,", "{x: {unit: m, role: linked},")
    text = text.replace("guess: {y: -0.4 m}}", "guess: {y: -0.4 m}}\nrange: {x: [-0.5 m, 0.5 m]}")
    with pytest.raises(UsageError, match="W-PIVOT: x cannot stay dependent"):
        study_linked.of_model(read(text, "a.yaml"), Wanted("nullspace"))


def test_an_output_with_the_acceleration_of_an_eliminated_coordinate():
    text = PENDULUM + "outputs: {fall: y'', sum: x'' + y''}\n"
    program = of_text(text, "pendulum.yaml", Wanted("minimal")).program
    x, v, known = 0.3, 0.8, [float(p.value) for p in program.parameters]
    given = {"time": [0.0], "state": [x, v], "inputs": [], "parameters": known}
    (slope,) = run(program.function("accelerations"), given, FLOAT)
    fall, total = run(program.function("outputs"), given, FLOAT)
    # x^2 + y^2 = l^2, differentiated twice
    y = -((0.5**2 - x**2) ** 0.5)
    expected = -(v**2 + x * slope + (x * v / y) ** 2) / y
    assert fall == pytest.approx(expected, rel=1e-13)
    assert total == pytest.approx(expected + slope, rel=1e-13)
