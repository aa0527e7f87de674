"""The lecture's statements on linked sets, rows 4 to 10 of its table of systems."""

import numpy as np
import pytest
import sympy as sp
from linked_scenes import from_text, scene, touching
from scenes import model_of, text_of
from scipy.integrate import solve_ivp

from eomgen.algebra.closed import to_sympy
from eomgen.analysis import cards
from eomgen.mechanics.vectors import dot
from eomgen.model import TIME

# row -> (spec, coordinates, constraints, degrees of freedom, least number of coordinates)
ROWS = {
    4: ("block_on_incline", 2, 1, 1, 1),
    5: ("mass_on_sphere", 3, 1, 2, 2),
    6: ("dumbbell", 6, 1, 5, 5),
    7: ("mass_leaving_sphere", 3, 0, 3, 3),
    8: ("bead_on_fixed_hoop", 3, 2, 1, 1),
    9: ("bead_on_turning_hoop", 3, 2, 1, 1),
    10: ("rolling_disc_upright", 4, 2, 2, 4),
}
# row -> constraint -> (bilateral, scleronomic, holonomic)
ANSWERS = {
    4: {"incline": (True, True, True)},
    5: {"sphere": (True, True, True)},
    6: {"rod": (True, True, True)},
    7: {"outside": (False, True, False)},  # "holonomic: cannot be unilateral"
    8: {"hoop": (True, True, True), "plane": (True, True, True)},
    9: {"sphere": (True, True, True), "turning": (True, False, True)},
    10: {"no_slip_x": (True, True, False), "no_slip_y": (True, True, False)},
}
# what the slide has left of its = or >=; in row 9 ours is this times -cos(Omega t)
WRITTEN = {
    4: {"incline": "y - x*tan(theta)"},
    5: {"sphere": "x**2 + y**2 + z**2 - R**2"},
    6: {"rod": "(x_2 - x_1)**2 + (y_2 - y_1)**2 + (z_2 - z_1)**2 - l**2"},
    7: {"outside": "x**2 + y**2 + z**2 - R**2"},
    8: {"hoop": "x**2 + z**2 - R**2", "plane": "y"},
    9: {"sphere": "x**2 + y**2 + z**2 - R**2", "turning": "-cos(Omega*t)*(y - x*tan(Omega*t))"},
    10: {"no_slip_x": "x_t - R*phi_t*cos(theta)", "no_slip_y": "y_t - R*phi_t*sin(theta)"},
}
each = pytest.mark.parametrize("row", ROWS)


def report_of(row):
    return scene(ROWS[row][0]).report


def card_of(row, name):
    (found,) = (c for c in report_of(row).cards if c.name == name)
    return found


def lecture_formula(row, text):
    """A formula of the lecture over the symbols of the spec; x_t is the rate of x."""
    model = model_of(ROWS[row][0])
    known = {"t": TIME, **{p.name: p.symbol for p in model.parameters}}
    for c in model.coordinates:
        known |= {c.name: c.symbol, f"{c.name}_t": c.rate}
    return sp.sympify(text, locals=known)


def differ(left, right):
    """The largest difference of two formulas at random numbers."""
    chance = np.random.default_rng(5)
    symbols = sorted(left.free_symbols | right.free_symbols, key=str)
    return max(
        abs(float((left - right).evalf(30, subs={s: chance.uniform(0.3, 1.2) for s in symbols})))
        for _ in range(5)
    )


@each
def test_degrees_of_freedom_are_the_lectures(row):
    _, coordinates, constraints, freedom, least = ROWS[row]
    found = report_of(row).freedom
    assert found.coordinates == coordinates
    assert found.rank == len(found.rows) == constraints
    assert found.degrees_of_freedom == freedom
    assert found.minimal_coordinates == least
    assert len(found.basis.independent) == len(found.basis.vectors) == freedom
    assert found.states >= 5
    assert not found.warnings


@each
def test_each_constraint_is_of_the_lectures_kind(row):
    cards = report_of(row).cards
    answers = {c.name: (c.is_bilateral, c.is_scleronomic, c.is_holonomic) for c in cards}
    assert answers == ANSWERS[row]


@each
def test_each_constraint_is_the_lectures(row):
    assert {c.name for c in report_of(row).cards} == WRITTEN[row].keys()
    for name, text in WRITTEN[row].items():
        (residual,) = card_of(row, name).residuals
        assert differ(to_sympy(residual), lecture_formula(row, text)) < 1e-14


@each
def test_virtual_displacements_keep_the_constraints(row):
    """Delta phi = sum (d phi/d q_j) delta q_j = 0 for every vector of the basis."""
    found = scene(ROWS[row][0])
    state = found.report.states[0].state
    for vector in found.basis.vectors:
        assert max(abs(v) for v in vector) >= 1
        for line in found.machine.rows:
            jacobian = found.numbers(line.jacobian, state)
            assert abs(float(dot(jacobian, [float(v) for v in vector]))) < 1e-13


def test_on_the_incline_dy_follows_dx():
    (pair,) = report_of(4).freedom.basis.formulas
    theta = lecture_formula(4, "theta")
    assert pair[0] == "y"
    assert differ(to_sympy(pair[1]), sp.tan(theta) * sp.Symbol("delta x", real=True)) < 1e-14


def test_on_the_sphere_two_displacements_are_free():
    (pair,) = report_of(5).freedom.basis.formulas
    x, y, z = (lecture_formula(5, n) for n in "xyz")
    expected = -(x * sp.Symbol("delta x", real=True) + y * sp.Symbol("delta y", real=True)) / z
    assert pair[0] == "z"
    assert differ(to_sympy(pair[1]), expected) < 1e-13


# --- rows 4 to 6: what the constraint carries


def test_the_sphere_pushes_with_what_the_path_needs():
    """2 lambda R^2 = m (g z - v^2)."""
    found = scene("mass_on_sphere")
    m, radius, g = found.parameters("m R g")
    for state in found.states:
        square = sum(float(r) ** 2 for r in state.rates)
        expected = m * (g * float(state.coordinates[2]) - square) / (2 * radius**2)
        assert found.multipliers(state)["sphere"] == pytest.approx(expected, rel=1e-12)


def test_the_rod_of_the_dumbbell_holds_the_relative_motion():
    """2 lambda l^2 = -m_1 m_2/(m_1 + m_2) |v_2 - v_1|^2: gravity does not stretch it."""
    found = scene("dumbbell")
    m_1, m_2, size = found.parameters("m_1 m_2 l")
    for state in found.states:
        rates = np.array(state.rates, float)
        square = np.sum((rates[3:] - rates[:3]) ** 2)
        expected = -m_1 * m_2 / (m_1 + m_2) * square / (2 * size**2)
        assert found.multipliers(state)["rod"] == pytest.approx(expected, rel=1e-11)


def test_the_incline_carries_the_weight_across_it():
    found = scene("block_on_incline")
    m, theta, g = found.parameters("m theta g")
    state = found.report.initial.state
    # lambda (-tan, 1) is the force, so lambda = N cos
    assert found.multipliers(state)["incline"] == pytest.approx(m * g * np.cos(theta) ** 2)


# --- row 7: it leaves the sphere


def test_the_mass_leaves_the_sphere_at_two_thirds():
    """Released at rest from the top; the angle it starts with changes cos by its square."""
    found, small = touching("mass_leaving_sphere"), 1e-5

    def derivative(t, y):
        return [*y[3:], *found.call("accelerations_contact", y)]

    def force(t, y):
        return found.call("events_contact", y)[0]

    force.terminal, force.direction = True, -1
    start = [np.sin(small), 0, np.cos(small), 0, 0, 0]
    assert found.call("contact_forces", start)[0] > 0
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "events": force}
    done = solve_ivp(derivative, (0, 20), start, **options)
    (left,) = done.y_events[0]
    assert left[2] / np.linalg.norm(left[:3]) == pytest.approx(2 / 3, abs=1e-9)
    # v^2 = g R cos: the weight alone bends its path as the sphere does
    assert left[3:] @ left[3:] == pytest.approx(9.81 * 2 / 3, rel=1e-8)
    assert done.y[2, 0] > 0.999 > left[2]


def test_a_one_sided_constraint_takes_no_freedom():
    assert report_of(7).freedom.rows == ()
    two_sided = text_of("mass_leaving_sphere").replace("unilateral:", "holonomic:")
    two_sided = two_sided.replace(">= 0, restitution: e,", "= 0,").replace("dof: 3", "dof: 2")
    assert from_text(two_sided).report.freedom.degrees_of_freedom == 2


# --- row 9: rheonomic


def balance(name, state):
    """(d(T + V)/dt, power of the constraints, size of the energies and powers) on the motion."""
    found = scene(name)
    machine = found.machine
    algebra, accelerations = machine.kinematics.algebra, machine.accelerations
    motion = {TIME: algebra.number(1)}
    for c, rate, acceleration in zip(
        machine.model.coordinates, machine.rates, accelerations, strict=True
    ):
        motion |= {c.symbol: rate, c.rate: acceleration}
    changes = [algebra.along(e, motion) for e in machine.energy]
    powers = [
        multiplier * dot(row.jacobian, machine.rates)
        for multiplier, row in zip(machine.linked.multipliers, machine.schur.rows, strict=True)
    ]
    values = found.numbers([*machine.energy, *changes, *powers], state)
    return sum(values[2:4]), sum(values[4:]), max(abs(v) for v in values)


def test_the_turning_hoop_gives_exactly_its_constraints_power():
    for state in scene("bead_on_turning_hoop").states:
        gained, power, size = balance("bead_on_turning_hoop", state)
        assert abs(gained - power) < 1e-12 * size
        assert abs(gained) > 1e-4 * size


@pytest.mark.parametrize("row", [4, 5, 6, 8, 10])
def test_a_constraint_at_rest_gives_no_power(row):
    for state in scene(ROWS[row][0]).states:
        gained, power, size = balance(ROWS[row][0], state)
        assert abs(power) < 1e-12 * size
        assert abs(gained) < 1e-12 * size


def test_a_virtual_displacement_is_at_frozen_time():
    """On the turning hoop dr = r' dt is no virtual displacement; on the fixed one it is."""
    for row, moves in [(8, False), (9, True)]:
        found = scene(ROWS[row][0])
        state = found.states[0]
        jacobian = [e for line in found.machine.rows for e in line.jacobian]
        jacobian = np.reshape(found.numbers(jacobian, state), (2, 3))
        drift = np.abs(jacobian @ np.array(state.rates, float)).max()
        assert (drift > 1e-3) if moves else (drift < 1e-14)


def test_the_lectures_own_plane_is_the_same_hoop():
    """Y - x tan(omega t) = 0, away from omega t = 90 deg: same freedom, kind and motion."""
    text = text_of("bead_on_turning_hoop")
    text = text.replace("x*sin(Omega*t) - y*cos(Omega*t) = 0", "y - x*tan(Omega*t) = 0")
    lecture, ours = from_text(text), scene("bead_on_turning_hoop")
    assert lecture.report.freedom.degrees_of_freedom == 1
    assert [c.is_scleronomic for c in lecture.report.cards] == [True, False]
    for state in ours.states:
        found, expected = lecture.accelerations(state), ours.accelerations(state)
        assert found == pytest.approx(expected, rel=1e-9)


# --- row 10: it cannot be integrated


def test_the_rolling_disc_cannot_be_integrated():
    """Two directions, their bracket, and one more: every position can be reached."""
    found = report_of(10)
    assert found.integrability.growth == (2, 3, 4)
    assert found.integrability.hidden == 0
    assert not any(v.is_integrable or v.is_integrable_alone for v in found.integrability.verdicts)
    assert not found.integrability.combinations
    assert found.freedom.degrees_of_freedom == 2
    assert found.freedom.minimal_coordinates == found.freedom.coordinates == 4
    assert [cards.to_json(c)["holonomic"] for c in found.cards] == [False, False]


def test_rolling_straight_can_be_integrated():
    """With its heading held the same disc has x - R phi: what is decided is not what is written."""
    text = text_of("rolling_disc_upright").replace("*cos(theta) = 0", " = 0")
    text = text.replace("R*phi'*sin(theta) = 0, reaction", "0 = 0, reaction")
    found = from_text(text.partition("\nexpect:")[0] + "\n").report
    assert found.integrability.growth == (2,)
    assert [c.kind for c in found.cards] == ["nonholonomic"] * 2
    assert all(c.is_holonomic for c in found.cards)
    relations = [str(to_sympy(h.relation)) for c in found.cards for h in c.hidden]
    assert relations == ["-R*phi + x", "y"]
    assert found.freedom.minimal_coordinates == 2


@pytest.mark.parametrize("name", ["chaplygin_sleigh", "rolling_disc_tilting", "snakeboard"])
def test_the_other_rolling_scenes_reach_every_position(name):
    found = scene(name).report
    assert found.integrability.growth[0] == found.freedom.degrees_of_freedom
    assert found.integrability.growth[-1] == found.freedom.coordinates
    assert found.freedom.minimal_coordinates == found.freedom.coordinates


# --- beside row 7: other one-sided scenes


def test_the_rubbing_block_slides():
    """g (sin - mu cos) down the incline; sticking would need more friction than there is."""
    found, slope, mu = touching("block_with_friction"), np.radians(30), 0.3
    down = np.array([-np.cos(slope), -np.sin(slope)])
    sliding = found.call("accelerations_slip_minus", [0, 0, *(0.5 * down)])
    assert sliding == pytest.approx(9.81 * (np.sin(slope) - mu * np.cos(slope)) * down, rel=1e-12)
    climbing = found.call("accelerations_slip_plus", [0, 0, *(-0.5 * down)])
    assert climbing == pytest.approx(9.81 * (np.sin(slope) + mu * np.cos(slope)) * down, rel=1e-12)
    force, reserve = found.call("events_stick", [0, 0, 0, 0])
    assert force == pytest.approx(2 * 9.81 * np.cos(slope), rel=1e-12)
    assert reserve < 0


def test_the_ball_comes_back_with_its_restitution():
    found = touching("bouncing_ball")
    assert found.call("gaps", [0.2, 0.03, 0, 0])[0] == pytest.approx(0, abs=1e-15)
    assert found.call("impact_floor", [0.2, 0.03, 0.5, -3]) == pytest.approx([0.5, 2.4], rel=1e-14)
    assert found.call("accelerations", [0.2, 1, 0.5, -3]) == pytest.approx([0, -9.81])


def test_the_rope_pulls_until_it_is_slack():
    """N = m (v^2/l + g cos(angle)) with the angle from the downward vertical."""
    found = touching("rope")
    for angle, speed in [(0.0, 1.0), (1.0, 2.0), (2.8, 2.0)]:
        s, c = np.sin(angle), np.cos(angle)
        state = [s, -c, speed * c, speed * s]
        tension = speed**2 + 9.81 * c
        assert found.call("contact_forces", state)[0] == pytest.approx(tension, rel=1e-12)
        assert (tension < 0) == (angle == 2.8)
    assert found.call("impact_taut", [0, -1, 0.3, -2]) == pytest.approx([0.3, 0], abs=1e-15)
