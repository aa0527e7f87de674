"""Rows 1 to 5 of the stability matrix, the table of limits and the table of energy growth.

One mass on a spring, m = k = 1: omega = 1, so the step is h omega; c = 2 zeta.
"""

import numpy as np
import pytest
from laboratory import EVERY, OSCILLATOR, amplitude, engine, failed, run, start, stepped
from measures import ENERGY, LIMITS, ZETAS, energy_change, measured_limit

from eomgen.stability.theory import Linear, growth, largest_step


def oscillator(**parameters):
    return engine(stepped(OSCILLATOR), **parameters)


def began():
    return start(stepped(OSCILLATOR))


@pytest.mark.parametrize("method", ["verlet", "semi-euler"])
def test_row_1_limit_of_the_symplectic_pair(method):
    assert amplitude(run(oscillator(), method, began(), 2.01, 500)).max() > 1e3
    assert amplitude(run(oscillator(), method, began(), 1.99, 500, 1)).max() < 25


@pytest.mark.parametrize(("method", "good", "bad"), [("rk4", 2.82, 2.84), ("rk3", 1.7, 1.8)])
def test_row_2_limit_of_runge_kutta_on_the_imaginary_axis(method, good, bad):
    assert amplitude(run(oscillator(), method, began(), bad, 500)).max() > 1e3
    assert amplitude(run(oscillator(), method, began(), good, 500, 1)).max() <= 1


def test_row_3_limit_on_the_real_axis():
    """x'' = -x': the rate decays with 1/s, or with 1e6/s."""
    decay = oscillator(k=0.0, c=1.0)
    moving = np.array([0.0, 1.0])
    assert abs(run(decay, "rk4", moving, 2.9, 500).states[-1, 1]) > 1e3
    assert abs(run(decay, "rk4", moving, 2.7, 500).states[-1, 1]) < 1e-3
    stiff = run(oscillator(k=0.0, c=1e6), "rosenbrock2", moving, 1.0, 20, 1)
    assert np.abs(stiff.states[1:, 1]).max() < 1e-5
    assert abs(stiff.states[-1, 1]) < 1e-60


def test_row_4_fixed_dopri5_grows_slowly_where_rk4_decays():
    count = round(1e4 * 2 * np.pi / 1.2)
    grown = amplitude(run(oscillator(), "dopri5", began(), 1.2, count))[-1]
    assert grown ** (1 / count) - 1 == pytest.approx(3.1e-4, rel=0.02)
    assert 5e6 < grown < 5e7
    assert amplitude(run(oscillator(), "rk4", began(), 1.2, count))[-1] < 1e-100


def test_row_5_damping_must_be_implicit_in_semi_euler():
    critical = oscillator(c=2.0)
    assert failed(run(critical, "semi-euler", began(), 0.85, 500))
    assert not failed(run(critical, "semi-euler", began(), 0.82, 500))
    assert not failed(run(critical, "semi-euler-damped", began(), 0.85, 500))
    assert np.abs(run(critical, "semi-euler-damped", began(), 0.85, 500).states[-1]).max() < 1e-20
    # its own limit is 2 (sqrt(1 + zeta^2) + zeta)
    assert failed(run(critical, "semi-euler-damped", began(), 4.84, 5000))
    assert not failed(run(critical, "semi-euler-damped", began(), 4.82, 5000))


@pytest.mark.parametrize("zeta", ZETAS)
@pytest.mark.parametrize("method", LIMITS)
def test_limits_are_those_of_theory(method, zeta):
    """The one-step map of the C, the stability function of the tableau, and the published table."""
    matrix = np.array([[0.0, 1.0], [-1.0, -2 * zeta]])
    measured = measured_limit(method, zeta)
    if method in EVERY:
        theory = largest_step(EVERY[method], Linear(matrix, 1))
        assert measured == pytest.approx(theory, rel=1e-5, abs=0.01)
    assert measured == pytest.approx(LIMITS[method][ZETAS.index(zeta)], rel=0.006, abs=0.01)


def test_the_closed_formula_of_semi_euler():
    for zeta in (0.0, 0.05, 0.3, 1.0):
        wanted = 2 * (np.sqrt(1 + zeta**2) - zeta)
        assert measured_limit("semi-euler", zeta) == pytest.approx(wanted, rel=1e-5)


def test_the_closed_formula_of_damped_semi_euler():
    for zeta in (0.0, 0.05, 0.3, 1.0):
        wanted = 2 * (np.sqrt(1 + zeta**2) + zeta)
        assert measured_limit("semi-euler-damped", zeta) == pytest.approx(wanted, rel=1e-5)


@pytest.mark.parametrize("method", ["rosenbrock2", "midpoint"])
@pytest.mark.parametrize("zeta", ZETAS)
def test_implicit_methods_have_no_limit(method, zeta):
    matrix = np.array([[0.0, 1.0], [-1.0, -2 * zeta]])
    assert largest_step(EVERY[method], Linear(matrix, 1)) == np.inf
    assert not failed(run(oscillator(c=2 * zeta), method, began(), 100.0, 1000))


def test_a_motion_that_grows_by_itself_is_no_fault_of_the_step():
    """A pendulum upside down beside a spring: the spring alone limits the step."""
    matrix = np.zeros((4, 4))
    matrix[:2, 2:], matrix[2, 0], matrix[3, 1] = np.eye(2), 9.0, -16.0
    for method, limit in (("rk4", 2.828427), ("verlet", 2.0), ("semi-euler", 2.0)):
        assert largest_step(EVERY[method], Linear(matrix, 2)) == pytest.approx(limit / 4, rel=1e-4)
        assert growth(EVERY[method], Linear(matrix, 2), 0.1) <= 1 + 1e-9


@pytest.mark.parametrize("method", ENERGY)
def test_energy_of_a_period_is_that_of_theory(method):
    """N steps a period: the published coefficients, the formulas, and the C."""
    published, formula, relative = ENERGY[method]
    measured = energy_change(method, 100)
    assert measured == pytest.approx(formula(100), rel=0.02, abs=1e-12)
    assert measured == pytest.approx(published, rel=relative, abs=1e-12)


def test_energy_band_and_phase_of_the_symplectic_pair():
    """At N = 100: +-3.2 % and 9.9e-4 of the energy, and the same phase error of 10.3/N^2."""
    h = 2 * np.pi / 100
    bands = {}
    for method in ("semi-euler", "verlet"):
        rows = run(oscillator(), method, began(), h, 100_000, 1)
        bands[method] = np.abs(amplitude(rows) ** 2 - 1)
        phase = np.arctan2(-rows.states[100, 1], rows.states[100, 0])
        assert abs(phase) == pytest.approx(10.3e-4, rel=0.05)
        # nothing is gained in a thousand periods
        assert bands[method][-1000:].max() == pytest.approx(bands[method][:1000].max(), rel=1e-3)
    assert bands["verlet"].max() == pytest.approx(9.9e-4, rel=0.01)
    # about the mean of the band
    spread = np.ptp(amplitude(run(oscillator(), "semi-euler", began(), h, 1000, 1)) ** 2) / 2
    assert spread == pytest.approx(h / 2, rel=0.02)
    rk4 = run(oscillator(), "rk4", began(), h, 100)
    phase = np.arctan2(-rk4.states[-1, 1], rk4.states[-1, 0])
    assert abs(phase) == pytest.approx(81.5e-8, rel=0.02)
