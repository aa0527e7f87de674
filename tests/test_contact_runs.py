"""Runs with contacts against closed forms: when they hit, where they leave, where they stick."""

import json
from math import cos, radians, sin, sqrt, tan

import numpy as np
import pytest
from scenes import study_of, text_of
from test_friction_guides import BLOCK
from tools import tool

from eomgen import simulate_run, study
from eomgen.errors import CheckError, UsageError
from eomgen.simulate_run import Request
from eomgen.spec import read

G = 9.81


def finished(found, t_end, state=None, **more):
    """A job that has run, and its table by column."""
    tool("cc")
    job = simulate_run.job(found, Request(json.dumps(state or {}), t_end, **more))
    rows = [text for _, text in job.parts()]
    names = [h.partition(" [")[0] for h in job.head().strip().split(",")]
    table = np.array([line.split(",") for line in "".join(rows).splitlines()], float)
    return job, dict(zip(names, table.T, strict=True))


def impacts(job):
    return [e.time for e in job.verdict.events if e.what.startswith("impact at")]


def modes(job):
    return [(e.time, e.what.removeprefix("mode ")) for e in job.verdict.events if "mode" in e.what]


def test_a_bouncing_ball_bounces_when_it_should_and_comes_to_rest():
    height, radius, e = 1.0, 0.03, 0.8
    job, rows = finished(study_of("bouncing_ball"), 5.0)
    first = sqrt(2 * (height - radius) / G)
    speed = G * first
    wanted = [first + sum(2 * speed * e**k / G for k in range(1, n + 1)) for n in range(55)]
    found = impacts(job)
    assert len(found) > 55
    np.testing.assert_allclose(found[:40], wanted[:40], rtol=0, atol=1e-9)
    np.testing.assert_allclose(found[:55], wanted, rtol=0, atol=1e-7)  # hops of 1e-10 m
    end = first + 2 * speed / G * e / (1 - e)
    (told,) = [e.what for e in job.verdict.events if "accumulate" in e.what]
    assert float(told.split()[5]) == pytest.approx(end, abs=1e-7)
    assert modes(job)[-1] == (pytest.approx(end, abs=1e-5), "contact")
    assert rows["y"][-1] == pytest.approx(radius, abs=1e-15)
    assert rows["x"][-1] == pytest.approx(2.5, abs=1e-12)
    assert job.faults() == []
    lost = 0.06 * G * (height - radius)
    assert job.verdict.lost == pytest.approx(lost, rel=1e-9)


def test_each_bounce_is_lower_by_the_square_of_the_restitution():
    _, rows = finished(study_of("bouncing_ball"), 1.1, {"parameters": {"e": "0.5"}})
    after = rows["y"][rows["t"] > 0.4447]
    assert after.max() == pytest.approx(0.03 + 0.97 * 0.25, abs=1e-4)


def test_a_mass_leaves_the_sphere_at_two_thirds():
    """Lecture, system 7; with a push v the cosine is 2/3 + v^2 / (3 g R)."""
    job, _ = finished(study_of("mass_leaving_sphere"), 3.0)
    ((left, mode),) = modes(job)
    assert mode == "flight"
    _, rows = finished(study_of("mass_leaving_sphere"), left, output_step=left)
    assert rows["z"][-1] == pytest.approx(2 / 3 + 0.01**2 / (3 * G), abs=1e-9)
    # and as the push goes to zero, the lecture's own number
    state = {"rates": {"x": "1e-6"}}
    job, _ = finished(study_of("mass_leaving_sphere"), 6.0, state)
    ((left, _),) = modes(job)
    _, rows = finished(study_of("mass_leaving_sphere"), left, state, output_step=left)
    assert rows["z"][-1] == pytest.approx(2 / 3, abs=1e-9)


def test_a_rope_goes_slack_where_its_tension_ends_and_is_taut_again():
    state = {"coordinates": {"x": 0, "y": -1}, "rates": {"x": repr(sqrt(4 * G)), "y": 0}}
    job, rows = finished(study_of("rope"), 2.0, state)
    slack, taut = modes(job)
    assert (slack[1], taut[1]) == ("flight", "contact")
    _, up = finished(study_of("rope"), slack[0], state, output_step=slack[0])
    assert up["y"][-1] == pytest.approx(2 / 3, abs=1e-9)
    lengths = np.hypot(rows["x"], rows["y"])
    assert lengths.max() <= 1 + 1e-12
    assert lengths.min() < 0.95
    assert job.faults() == []


def test_a_block_sticks_on_a_gentle_slope_and_slides_on_a_steep_one():
    theta, mu = radians(30), 0.7
    assert mu > tan(theta)
    along = cos(theta) + 0.6 * sin(theta)
    job, rows = finished(study_of("block_with_friction"), 1.0, {"parameters": {"mu": "0.7"}})
    assert [m for _, m in modes(job)] == ["slip_plus", "stick"]
    (begin, _), (stop, _) = modes(job)
    uphill = along - G * sin(theta) * begin
    duration = uphill / (G * (sin(theta) + mu * cos(theta)))
    assert stop == pytest.approx(begin + duration, abs=1e-9)
    assert abs(rows["x'"][-1]) < 1e-14
    resting = rows["x"][rows["t"] > stop]
    assert np.ptp(resting) < 1e-14
    job, rows = finished(study_of("block_with_friction"), 2.0)
    assert [m for _, m in modes(job)] == ["slip_plus", "slip_minus"]
    turn = modes(job)[1][0]
    slope = G * (sin(theta) - 0.3 * cos(theta))
    speed = np.hypot(rows["x'"], rows["y'"])[-1]
    assert speed == pytest.approx(slope * (2.0 - turn), rel=1e-9)
    assert job.verdict.work < 0  # friction takes
    assert job.faults() == []


SPATIAL = """\
eom: 1
system: Puck
space: solid
gravity: [0, 0, -g]
parameters: {m: 2 kg, mu: 0.25, g: 9.81 m/s^2}
coordinates: {x: m, y: m, z: m}
inputs: {F: N, W: N}
bodies: {puck: {mass: m, at: "[x, y, z]"}}
forces: [{on: puck, force: [F, W, 0]}]
constraints: {ice: {unilateral: z >= 0, friction: mu}}
initial: {x: 0 m, y: 0 m, z: 0 m, x': 3 m/s, y': -4 m/s, z': 0 m/s}
"""


def puck(inputs, t_end, state=None):
    found = study.of_model(read(SPATIAL, "puck.yaml"))
    return finished(found, t_end, state, inputs=inputs)


def test_a_puck_slides_against_its_velocity_and_stops():
    job, rows = puck(("F=0", "W=0"), 4.0)
    stop = 5 / (0.25 * G)
    assert [m for _, m in modes(job)] == ["stick"]
    assert modes(job)[0][0] == pytest.approx(stop, abs=1e-6)
    way = 5**2 / (2 * 0.25 * G)
    assert [rows["x"][-1], rows["y"][-1]] == pytest.approx([0.6 * way, -0.8 * way], abs=1e-6)
    assert job.faults() == []


def test_a_puck_at_rest_starts_to_slide_along_the_force():
    state = {"rates": {"x": 0, "y": 0, "z": 0}}
    job, rows = puck(("F=3", "W=-4"), 1.0, state)
    a = 5 / 2 - 0.25 * G
    assert [rows["x"][-1], rows["y"][-1]] == pytest.approx([0.6 * a / 2, -0.8 * a / 2], rel=1e-4)
    job, rows = puck(("F=2", "W=-3"), 1.0, state)  # below mu m g
    assert abs(rows["x"]).max() == 0
    assert job.verdict.events == []


def test_an_impact_that_the_spec_does_not_describe_ends_the_run():
    text = text_of("bouncing_ball").replace(", restitution: e", "")
    found = study.of_model(read(text, "ball.yaml"))
    job = simulate_run.job(found, Request("{}", 5.0))
    with pytest.raises(CheckError, match=r"floor is hit at t = 0\.444699.*`restitution`"):
        list(job.parts())
    assert job.rows > 30


@pytest.mark.parametrize("words", [{"method": "rk4"}, {"step": 0.01}, {"method": "radau"}])
def test_a_method_that_does_not_locate_events_is_refused(words):
    with pytest.raises(UsageError, match="run by dop853"):
        simulate_run.job(study_of("bouncing_ball"), Request("{}", 1.0, **words))


def test_a_bead_swings_on_a_rough_wire_until_it_sticks():
    """v' = -g sin a - sign(v) mu (g cos a + v^2/R), R = p/(2 cos^3 a), along the wire."""
    solve_ivp = pytest.importorskip("scipy.integrate").solve_ivp
    job, rows = finished(study_of("bead_on_rough_wire"), 2.0)
    (first, one), (second, two) = modes(job)
    assert (one, two) == ("slip_plus", "stick")

    def along(side):
        def slope(t, y):
            a = np.arctan(2 * y[0] / 0.8)
            press = G * cos(a) + y[1] ** 2 * 2 * cos(a) ** 3 / 0.8
            return [y[1] * cos(a), -G * sin(a) - side * 0.3 * press]

        return slope

    def stops(t, y):
        return y[1]

    stops.terminal = True
    start = [0.5, -sqrt(1 + 1.25**2)]
    back = solve_ivp(along(-1), (0, 2), start, events=stops, rtol=1e-12, atol=1e-12)
    assert first == pytest.approx(back.t[-1], abs=1e-8)
    begin = (back.t[-1], 2)
    # it starts again at rest, on the steep side
    forth = solve_ivp(along(1), begin, [back.y[0, -1], 1e-9], events=stops, rtol=1e-12, atol=1e-12)
    assert second == pytest.approx(forth.t[-1], abs=1e-7)
    assert rows["x"][-1] == pytest.approx(forth.y[0, -1], abs=1e-8)
    assert abs(2 * rows["x"][-1] / 0.8) < 0.3
    assert job.faults() == []


def test_a_body_of_full_inertia_runs_in_a_rough_skew_slot():
    job, rows = finished(study.of_text(BLOCK, "slot.yaml"), 0.4, inputs=("F=3",), output_step=1e-3)
    assert job.faults() == []
    assert job.verdict.relative_energy_error < 1e-9
    assert all(worst < 1e-12 for worst in job.verdict.residuals.values())
    # the output x'' is that of the mode, with its friction
    slope = (rows["x'"][2:] - rows["x'"][:-2]) / 2e-3
    np.testing.assert_allclose(rows["u"][1:-1], slope, atol=1e-3)


def test_outputs_with_accelerations_are_those_of_the_mode():
    text = SPATIAL + "outputs: {a: x''}\n"
    job, rows = finished(study.of_text(text, "puck.yaml"), 4.0, inputs=("F=0", "W=0"))
    stop = modes(job)[0][0]
    sliding, resting = rows["t"] < stop, rows["t"] > stop
    np.testing.assert_allclose(rows["a"][sliding], -0.6 * 0.25 * G, rtol=1e-6)
    np.testing.assert_allclose(rows["a"][resting], 0, atol=1e-12)
