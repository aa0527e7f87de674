"""Every shipped spec with constraints: all formulations agree, and give the published values."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import sympy as sp
from linked_scenes import from_text, scene, values, windows
from scenes import SHIPPED, machine_of, model_of, text_of
from scipy.integrate import solve_ivp

from eomgen import compile
from eomgen.algebra.arithmetic import mpmath_arithmetic
from eomgen.checks import expectations, links, samples
from eomgen.errors import CheckError
from eomgen.interpreter import FLOAT, run
from eomgen.mechanics import constraints, lagrange, minimal, minimal_graph, nullspace
from eomgen.model import Expectation

MPMATH = mpmath_arithmetic(50)
LINKED = [name for name in SHIPPED if model_of(name).constraints]
BILATERAL = [n for n in LINKED if any(c.kind != "unilateral" for c in model_of(n).constraints)]
# nonholonomic rows eliminate no coordinate, and the ring of hinges has no closed form
HOLONOMIC = [n for n in BILATERAL if all(c.kind == "holonomic" for c in model_of(n).constraints)]
MINIMAL = [n for n in HOLONOMIC if n != "bricard"]
bilateral = pytest.mark.parametrize("name", BILATERAL)


# --- the specs as pages


@pytest.mark.parametrize("name", LINKED)
def test_a_linked_spec_is_complete(name):
    model = model_of(name)
    assert text_of(name).splitlines()[0] == "# yaml-language-server: $schema=./eomgen.schema.json"
    assert list(model.title) == ["en", "es"]
    assert model.with_units
    assert all(p.value is not None or p.formula is not None for p in model.parameters)
    state = [s.name for c in model.coordinates for s in (c.symbol, c.rate)]
    assert sorted([*model.initial, *model.guess]) == sorted(state)
    assert model.expect.dof == scene(name).report.freedom.degrees_of_freedom


@bilateral
def test_the_known_initial_values_stay(name):
    assert scene(name).report.initial.distance < 1e-20


@bilateral
def test_what_the_author_calls_free_is_independent(name):
    free = tuple(c.name for c in model_of(name).coordinates if c.role == "free")
    if len(free) < len(model_of(name).coordinates):
        assert scene(name).basis.independent == free


def claims_that_hold(name, model):
    """How many of these claims hold at the admissible states."""
    found = scene(name)
    at = links.samples_of(found, found.report.states, samples.draw(found.model))
    built = replace(found.machine, kinematics=replace(found.machine.kinematics, model=model))
    return expectations.check(built, at, found.report.freedom.degrees_of_freedom)


@pytest.mark.parametrize("name", LINKED)
def test_the_claims_hold_at_admissible_states(name):
    assert claims_that_hold(name, model_of(name)) == expectations.count(machine_of(name)) > 0


CLAIMS = [(n, i) for n in LINKED for i in range(len(model_of(n).expect.equations))]


@pytest.mark.parametrize(("name", "index"), CLAIMS)
def test_a_false_equation_is_found_out(name, index):
    """With the last of its terms that move doubled it holds no more."""
    model = model_of(name)
    claim = model.expect.equations[index]
    moving = {s for c in model.coordinates for s in (c.symbol, c.rate, c.acceleration)}
    terms = [t for t in expectations.summands(claim.residual) if t.free_symbols & moving]
    wrong = replace(claim, residual=claim.residual + terms[-1])
    with pytest.raises(CheckError, match="does not hold on the motion"):
        claims_that_hold(name, replace(model, expect=Expectation(equations=(wrong,))))


# --- one motion, whatever the formulation


def relative(found, reference):
    return np.max(np.abs(found - reference)) / (np.max(np.abs(reference)) + 1e-300)


@bilateral
def test_multipliers_solve_the_full_system(name):
    """M q'' + h = Q + J' lambda and J q'' + gamma = 0 with every row, dense, by least squares."""
    found = scene(name)
    equations, rows = found.machine.equations, found.machine.rows
    n, m = len(found.names), len(rows)
    for state in found.states:
        inertia = found.numbers([e for row in equations.mass_matrix for e in row], state)
        jacobian = np.reshape(found.numbers([e for r in rows for e in r.jacobian], state), (m, n))
        right = found.numbers(equations.generalized_forces, state)
        right = np.subtract(right, found.numbers(equations.bias, state))
        gamma = np.array(found.numbers([r.gamma for r in rows], state))
        matrix = np.block(
            [[np.reshape(inertia, (n, n)), -jacobian.T], [jacobian, np.zeros((m, m))]]
        )
        # rows of one size, for the tolerance of the least squares
        size = np.abs(matrix).max(axis=1)
        dense = np.linalg.lstsq(
            matrix / size[:, None], np.concatenate([right, -gamma]) / size, rcond=1e-12
        )[0]
        motion = np.array(found.numbers(found.machine.solution[0], state))
        assert relative(motion, dense[:n]) < 1e-9


OVER_RATES = [n for n in BILATERAL if not model_of(n).speeds]


@pytest.mark.parametrize("name", OVER_RATES)
def test_the_null_space_moves_alike(name):
    found = scene(name)
    for state in found.states:
        rates = [
            r for n, r in zip(found.names, state.rates, strict=True) if n in found.basis.independent
        ]
        speeds = [f"{n}'" for n in found.basis.independent]
        at = {
            "time": [float(state.time)],
            "state": [float(v) for v in (*state.coordinates, *rates)],
            "parameters": [float(p) for p in state.parameters],
        }
        reduced = nullspace.derive(found.model, speeds, found.machine.kept, at)
        built = compile.Machine(reduced.kinematics, (), reduced.pivots)
        moved = values(built, built.accelerations, state, (*state.coordinates, *rates))
        assert relative(np.array(moved), found.accelerations(state)) < 1e-10


@cache
def eliminations(name):
    found = scene(name)
    kinematics = lagrange.closed_kinematics(found.model)
    rows = [r for r in constraints.rows(kinematics) if r.name in found.machine.kept]
    residuals = [minimal.Residual((r.name,), r.residual) for r in rows]
    dependent = [c for c in found.model.coordinates if c.name in found.basis.dependent]
    symbols = [c.symbol for c in found.model.coordinates]
    return minimal.eliminations(kinematics.algebra, residuals, dependent, symbols)


@pytest.mark.parametrize("name", HOLONOMIC)
def test_which_specs_have_a_closed_form(name):
    assert (eliminations(name) is not None) == (name in MINIMAL)


@pytest.mark.parametrize("name", MINIMAL)
def test_the_minimal_coordinates_move_alike(name):
    found = scene(name)
    free = [i for i, n in enumerate(found.names) if n in found.basis.independent]
    bindings = found.machine.kinematics.algebra.bindings
    for state in found.states:
        known = dict(zip(bindings, found.numbers(list(bindings.values()), state), strict=True))
        chosen = minimal_graph.choose(eliminations(name), known)
        reduced = minimal_graph.derive(found.model, chosen, found.machine.kept, known)
        built = compile.Machine(reduced.kinematics, (), reduced.pivots)
        columns = [
            (*state.coordinates, *state.rates)[i + k] for k in (0, len(found.names)) for i in free
        ]
        moved = values(built, built.accelerations, state, columns)
        reference = found.accelerations(state)
        size = np.abs(reference).max()
        assert np.max(np.abs(moved - reference[free])) / size < 1e-10


# --- published values

ANDREWS = {  # Hairer and Wanner II, section VII.7; theirs is M q'' + G' lambda = f
    "beta": "14222.4439199541138705911625887",
    "theta": "-10666.8329399655854029433719415",
}
ANDREWS_FORCES = {"triangle_loop.x": "98.566870396241", "triangle_loop.y": "-6.122688344255662"}
ANDREWS_LATER = {  # at t = 0.03 s
    "beta": 15.81077119629904,
    "theta": -15.75637105984298,
    "gamma": 0.04082224013073101,
    "phi": -0.5347301163226948,
    "delta": 0.5244099658805304,
    "omega": 0.5347301163226948,
    "epsilon": 1.048080741042263,
}


def test_the_squeezer_starts_as_published():
    found = scene("andrews_squeezer")
    accelerations = found.by_name(found.accelerations(found.report.initial.state, MPMATH))
    for name, value in accelerations.items():
        assert abs(value - sp.Float(ANDREWS.get(name, "0"), 40)) < 1e-18
    for name, value in found.multipliers(found.report.initial.state, MPMATH).items():
        # every published digit, and our sign
        assert abs(value + sp.Float(ANDREWS_FORCES.get(name, "0"), 40)) < 1e-12


@pytest.mark.slow
def test_the_squeezer_is_later_where_published():
    found = scene("andrews_squeezer")
    function, start = (
        compile.FUNCTIONS["state_derivative"](found.machine),
        found.report.initial.state,
    )
    parameters = [float(p) for p in start.parameters]

    def derivative(t, y):
        given = {"time": [t], "state": y.tolist(), "inputs": [], "parameters": parameters}
        return run(function, given, FLOAT)

    state = np.array([*start.coordinates, *start.rates], float)
    done = solve_ivp(derivative, (0, 0.03), state, method="DOP853", rtol=1e-11, atol=1e-11)
    later = found.by_name(done.y[:7, -1])
    assert later == pytest.approx(ANDREWS_LATER, rel=1e-7)


def test_bricard_moves_although_it_is_counted_rigid():
    """Five rows for five coordinates have rank 4; sin a + sin b + sin a sin b = 0."""
    found = scene("bricard")
    assert (found.report.freedom.rank, len(found.report.freedom.rows)) == (4, 5)
    assert len(found.report.freedom.dependencies) == 1
    for state in found.states:
        a, b, *others = state.coordinates
        sine = MPMATH.functions["sin"]
        assert abs(sine(a) + sine(b) + sine(a) * sine(b)) < 1e-40
        assert max(abs(u - v) for u, v in zip(others, (a, b, a), strict=True)) < 1e-30
        assert abs(a) > 1e-3


def test_the_ring_of_bricard_has_the_published_singular_values():
    found = scene("bricard")
    entries = [e for row in found.machine.rows for e in row.jacobian]
    jacobian = np.reshape(found.numbers(entries, found.report.initial.state), (5, 5))
    sizes = np.linalg.svd(jacobian, compute_uv=False)
    assert sizes == pytest.approx([1.9021, 1.9021, 1.1756, 1.1756, 0], abs=1e-4)


def test_bricard_falls_as_its_energy_says():
    """At the start a' = 1, b' = -1: the middles of bars 3 and 4 fall with l/2, so dV/da = -m g l.

    2 T = (9/2 m l^2 + 6 I_t + 3 I_a) a'^2, with the spins y, y - z, x + y - z, x - z, x.
    """
    found = scene("bricard")
    falling = 9.81 / (9 / 2 + 6 * 101 / 1200 + 3 / 600)  # published: m = l = 1, I_t, I_a
    expected = falling * np.array([1, -1, 1, -1, 1])
    assert found.accelerations(found.report.initial.state) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_parallel_windows_move_as_one_pendulum(count):
    """[(N + 1)/3 + N] phi'' = -g [(N + 1)/2 + N] cos phi."""
    found = from_text(windows(count))
    assert found.report.freedom.degrees_of_freedom == 1
    for state in found.states:
        phi, n = float(state.coordinates[0]), count
        swing = -9.81 * ((n + 1) / 2 + n) * np.cos(phi) / ((n + 1) / 3 + n)
        expected = [swing] * (n + 1) + [0.0] * n
        assert found.accelerations(state) == pytest.approx(expected, rel=1e-10, abs=1e-10)


def test_the_shipped_parallelogram_is_one_window():
    found, one = scene("parallelogram"), from_text(windows(1))
    state = found.at(q1=1.1, q1_t=0.7, q2=0, q3=1.1)
    other = one.at(p0=1.1, p0_t=0.7, c0=0, p1=1.1)
    q1, q2, q3 = found.accelerations(state)
    assert one.accelerations(other) == pytest.approx([q1, q3, q2], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("time", [-2.0, 0.0, 0.4, 3.0])
def test_the_sleigh_runs_down_to_its_straight_course(time):
    """v = V tanh(k t), theta' = W / cosh(k t), k = m a V/J, J = I + m a^2, m V^2 = J W^2."""
    found = scene("chaplygin_sleigh")
    m, i, a = found.parameters("m I a")
    inertia, top = i + m * a**2, 0.8
    k, spin = m * a * top / inertia, top * np.sqrt(m / inertia)
    v, w, theta = top * np.tanh(k * time), spin / np.cosh(k * time), 0.6
    heading, across = (
        np.array([np.cos(theta), np.sin(theta)]),
        np.array([-np.sin(theta), np.cos(theta)]),
    )
    state = found.at(theta=theta, x_t=v * heading[0], y_t=v * heading[1], theta_t=w)
    faster, slower = top * k / np.cosh(k * time) ** 2, -k * w * np.tanh(k * time)
    expected = [*(faster * heading + v * w * across), slower]
    assert found.accelerations(state) == pytest.approx(expected, rel=1e-12, abs=1e-13)


# --- by hand


def test_the_upright_disc_rolls_on_a_circle():
    """x'' = -R phi' theta' sin, y'' = R phi' theta' cos; friction is m times that."""
    found = scene("rolling_disc_upright")
    m, radius = found.parameters("m R")
    for state in found.states:
        theta = float(state.coordinates[2])
        turn, roll = (float(r) for r in state.rates[2:])
        expected = radius * roll * turn * np.array([-np.sin(theta), np.cos(theta), 0, 0])
        assert found.accelerations(state) == pytest.approx(expected, rel=1e-12, abs=1e-13)
        friction = list(found.multipliers(state).values())
        assert friction == pytest.approx(m * expected[:2], rel=1e-11, abs=1e-12)


def tilting(state):
    """(psi'', theta'', phi'') from the balance of moments about the contact, m = R = 1.

    5/4 lean'' = 3/2 c w - 1/4 c^2 tan(lean) + g sin(lean)/R,  c = psi' cos(lean) and
    w = phi' + psi' sin(lean) the spin;  w' = -2/3 lean' c;  c' = lean' (c tan(lean) - 2 w).
    """
    lean = float(state.coordinates[3])
    turn, fall, roll = (float(r) for r in state.rates[2:])
    s, c = np.sin(lean), np.cos(lean)
    across, spin = turn * c, roll + turn * s
    over_r = 9.81 / 0.3
    falling = 4 / 5 * (3 / 2 * across * spin - across**2 * s / c / 4 + over_r * s)
    turning = (fall * (across * s / c - 2 * spin) + turn * s * fall) / c
    rolling = -2 / 3 * fall * across - turning * s - turn * fall * c
    return [turning, falling, rolling]


def test_the_tilting_disc_has_the_moments_of_its_contact():
    found = scene("rolling_disc_tilting")
    for state in found.states:
        expected = tilting(state)
        accelerations = found.accelerations(state)
        assert accelerations[2:] == pytest.approx(expected, rel=1e-11)
        # friction is the only horizontal force
        friction = list(found.multipliers(state).values())
        assert friction == pytest.approx(found.parameter("m") * accelerations[:2], rel=1e-11)


def test_a_tilted_disc_rolls_steadily():
    """4 g sin(lean)/R = c^2 tan(lean) - 6 c w keeps the lean."""
    found = scene("rolling_disc_tilting")
    lean, turn, radius = 0.3, 2.0, found.parameter("R")
    across = turn * np.cos(lean)
    spin = (across**2 * np.tan(lean) - 4 * 9.81 * np.sin(lean) / radius) / (6 * across)
    roll = spin - turn * np.sin(lean)
    state = found.at(theta=lean, psi=0.4, psi_t=turn, theta_t=0, phi_t=roll)
    assert found.accelerations(state)[2:] == pytest.approx([0, 0, 0], abs=1e-12)
    assert np.linalg.norm(found.accelerations(state)[:2]) > 0.1


def test_the_ball_turns_at_two_sevenths_of_its_table():
    found = scene("ball_on_turntable")
    m, omega = found.parameters("m Omega")
    for state in found.states:
        x, y = (float(r) for r in state.rates[:2])
        expected = 2 / 7 * omega * np.array([-y, x])
        assert found.accelerations(state)[:2] == pytest.approx(expected, rel=1e-11)
        assert list(found.multipliers(state).values()) == pytest.approx(m * expected, rel=1e-11)


@pytest.mark.parametrize("steer", [0.2, -0.6])
def test_the_snakeboard_gains_no_momentum_along_its_path(steer):
    """m v' + tan(steer)/l (J theta'' + J_r psi'' + J_w (phi_b'' + phi_f'')) = 0 whatever drives it.

    The wheels stand at -steer and steer, so the board turns about a point beside its middle.
    """
    found = scene("snakeboard")
    m, board, m_r, j_r, m_w, j_w, size = found.parameters("m J m_r J_r m_w J_w l")
    theta, v = 0.7, 1.4
    turn = v * np.tan(steer) / size
    known = {"theta": theta, "phi_b": -steer, "phi_f": steer, "theta_t": turn}
    known |= {"x_t": v * np.cos(theta), "y_t": v * np.sin(theta)}
    known |= {"psi_t": 2.0, "phi_b_t": -0.4, "phi_f_t": 0.9}
    state = found.at(**known)
    assert found.by_name(state.rates)["theta"] == pytest.approx(turn, rel=1e-12)
    q = found.by_name(found.accelerations(state))
    push = (m + m_r + 2 * m_w) * (q["x"] * np.cos(theta) + q["y"] * np.sin(theta))
    about = (board + 2 * m_w * size**2 + j_r + 2 * j_w) * q["theta"]
    about += j_r * q["psi"] + j_w * (q["phi_b"] + q["phi_f"])
    assert push + np.tan(steer) / size * about == pytest.approx(0, abs=1e-11 * abs(push))


def test_the_turning_hoop_is_the_one_with_an_angle():
    """R theta'' = R Omega^2 sin cos - g sin, and z = -R cos(theta)."""
    found = scene("bead_on_turning_hoop")
    radius, omega, g = found.parameters("R Omega g")
    for time, theta, spin in [(0.2, 0.5, 1.0), (1.3, 2.0, -3.0)]:
        s, c = np.sin(theta), np.cos(theta)
        x, y = radius * s * np.cos(omega * time), radius * s * np.sin(omega * time)
        state = found.at(time, x=x, y=y, z=-radius * c, z_t=radius * s * spin)
        swing = omega**2 * s * c - g / radius * s
        expected = radius * (s * swing + c * spin**2)
        assert found.by_name(found.accelerations(state))["z"] == pytest.approx(expected, rel=1e-12)


def test_the_slider_is_where_it_is_in_every_handbook():
    """s = r cos + sqrt(l^2 - r^2 sin^2)."""
    found = scene("slider_crank")
    r, size = found.parameters("r l")
    for state in found.states:
        phi, _, s = (float(q) for q in state.coordinates)
        expected = r * np.cos(phi) + np.sqrt(size**2 - (r * np.sin(phi)) ** 2)
        assert s == pytest.approx(expected, rel=1e-14)
