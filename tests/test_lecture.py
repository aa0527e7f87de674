"""The lecture's own statements, row by row of its table of systems."""

import re

import pytest
from scenes import derivation_of, expecting, study_of

from eomgen.algebra import normal
from eomgen.algebra.closed import ClosedForm
from eomgen.checks import expectations, samples
from eomgen.compile import machine_of
from eomgen.errors import CheckError, SpecError
from eomgen.mechanics.quasi_velocities import PARTS
from eomgen.outputs import Wish, rendered
from eomgen.spec import read

# the same equation may be written with a common factor: ours is the lecture's times this
EQUATIONS = {
    "particle_cartesian": (("m*x'' = F_x", "1"), ("m*y'' = F_y", "1")),
    "particle_polar": (
        ("m*(R'' - R*theta'^2) = F_R", "1"),
        ("m*(2*R'*theta' + R*theta'') = F_theta", "R"),
    ),
    "slider_pendulum_free": (
        ("(m_A + m_B)*s'' + m_B*l*phi''*cos(phi) - m_B*l*phi'^2*sin(phi) = 0", "1"),
        ("l*phi'' + s''*cos(phi) + g*sin(phi) = 0", "m_B*l"),
    ),
    "slider_spring_pendulum": (
        ("(m_A + m_B)*s'' + m_B*l*phi''*cos(phi) - m_B*l*phi'^2*sin(phi) + k*s = 0", "1"),
        ("l*phi'' + s''*cos(phi) + g*sin(phi) = 0", "m_B*l"),
    ),
    "disc_pendulum": (
        (
            "(3/2*m_A + m_B)*s'' + m_B*l*phi''*cos(phi) - m_B*l*phi'^2*sin(phi) + k*(s - l_0)"
            " = -c*s'",
            "1",
        ),
        ("l*phi'' + s''*cos(phi) + g*sin(phi) = -d*phi'/(m_B*l)", "m_B*l"),
    ),
}
KINETIC = {
    "slider_spring_pendulum": (
        "1/2*(m_A + m_B)*s'^2 + 1/2*m_B*l^2*phi'^2 + m_B*l*s'*phi'*cos(phi)"
    ),
    "disc_pendulum": (
        "1/2*m_A*s'^2 + 1/2*(1/2*m_A*r^2)*s'^2/r^2"
        " + 1/2*m_B*(s'^2 + l^2*phi'^2 + 2*l*s'*phi'*cos(phi))"
    ),
}
POTENTIAL = {
    "slider_spring_pendulum": "1/2*k*s^2 - m_B*g*l*cos(phi)",
    "disc_pendulum": "1/2*k*(s - l_0)^2 - m_B*g*l*cos(phi)",
}
LAGRANGIAN = {
    "slider_spring_pendulum": (
        "1/2*(m_A + m_B)*s'^2 + 1/2*m_B*l^2*phi'^2 + m_B*l*s'*phi'*cos(phi)"
        " - 1/2*k*s^2 + m_B*g*l*cos(phi)"
    ),
    "disc_pendulum": (
        "1/2*(3/2*m_A + m_B)*s'^2 + 1/2*m_B*l^2*phi'^2 + m_B*l*s'*phi'*cos(phi)"
        " - 1/2*k*(s - l_0)^2 + m_B*g*l*cos(phi)"
    ),
}


def forms(name, *formulas):
    """Formulas of the lecture as closed forms beside our derivation of that spec."""
    lines = "".join(f"  - {formula}\n" for formula in formulas)
    model = read(expecting(name, f"  conserved:\n{lines}"), f"{name}.yaml")
    algebra = ClosedForm(derivation_of(name).kinetic_energy.ring)
    return [algebra.of(claim.residual) for claim in model.expect.conserved]


def residuals(name, *equations):
    """Equations of the lecture as left side minus right side."""
    return forms(
        name, *(f"{left} - ({right})" for left, right in (e.split(" = ") for e in equations))
    )


def ours(name):
    """Our equations, everything on the left."""
    return [
        normal.total(e.inertia.ring, (getattr(e, part) for part in PARTS[:-1])) - e.applied
        for e in derivation_of(name).equations
    ]


@pytest.mark.parametrize("name", EQUATIONS)
def test_equations_of_motion_are_the_lectures(name):
    stated = residuals(name, *(equation for equation, _ in EQUATIONS[name]))
    factors = forms(name, *(factor for _, factor in EQUATIONS[name]))
    found = ours(name)
    assert len(found) == len(stated)
    for left, factor, right in zip(found, factors, stated, strict=True):
        assert normal.is_zero(left - factor * right)


@pytest.mark.parametrize("name", KINETIC)
def test_energies_are_the_lectures(name):
    kinetic, potential, lagrangian = forms(name, KINETIC[name], POTENTIAL[name], LAGRANGIAN[name])
    found = derivation_of(name)
    assert normal.is_zero(found.kinetic_energy - kinetic)
    assert normal.is_zero(found.potential_energy - potential)
    assert normal.is_zero(found.kinetic_energy - found.potential_energy - lagrangian)


@pytest.mark.parametrize(
    ("name", "place", "position"),
    [
        ("particle_cartesian", "particle", ("x", "y")),
        ("particle_polar", "particle", ("R*cos(theta)", "R*sin(theta)")),
        ("slider_pendulum_free", "A", ("s", "0")),
        ("slider_pendulum_free", "B", ("s + l*sin(phi)", "-l*cos(phi)")),
        ("slider_spring_pendulum", "B", ("s + l*sin(phi)", "-l*cos(phi)")),
        ("disc_pendulum", "B", ("s + l*sin(phi)", "-l*cos(phi)")),
    ],
)
def test_positions_are_the_lectures(name, place, position):
    (found,) = (p for p in derivation_of(name).places if p.name == place)
    assert list(found.position) == forms(name, *position)


def test_velocities_are_the_lectures():
    (bob,) = (p for p in derivation_of("slider_spring_pendulum").places if p.name == "B")
    stated = forms("slider_spring_pendulum", "s' + l*phi'*cos(phi)", "l*phi'*sin(phi)")
    assert list(bob.velocity) == stated
    (square,) = forms("slider_spring_pendulum", "s'^2 + l^2*phi'^2 + 2*l*s'*phi'*cos(phi)")
    assert bob.velocity[0] ** 2 + bob.velocity[1] ** 2 == square


def test_generalized_force_of_the_angle_is_the_moment_of_the_transverse_force():
    radial, transverse = (row.force for row in derivation_of("particle_polar").rows)
    assert [radial, transverse] == forms("particle_polar", "F_R", "R*F_theta")


def test_virtual_work_of_the_damped_disc():
    """delta W = F delta s + M delta phi, F = -c s', M = -c' phi': both on the right side."""
    derivation = derivation_of("disc_pendulum")
    assert [row.force for row in derivation.rows] == forms("disc_pendulum", "-c*s'", "-d*phi'")
    assert not derivation.dissipation_function.terms
    assert [e.applied for e in derivation.equations] == [row.force for row in derivation.rows]
    assert all(not e.damping.terms for e in derivation.equations)
    assert len(derivation.virtual_work) == 2


UNCORRECTED = "l*phi'' + s''*cos(phi) + g*sin(phi) = -d*phi'"


def test_the_uncorrected_equation_of_the_last_slide_is_refused():
    """It was divided by m_B l on the left only: N m on the right, m/s^2 on the left."""
    text = expecting("disc_pendulum", f"  equations:\n    phi: {UNCORRECTED}\n")
    with pytest.raises(SpecError) as caught:
        read(text, "disc_pendulum.yaml")
    (fault,) = caught.value.faults
    lines = text.splitlines()
    assert fault.code == "E403"
    stated = "'l*phi''' is [m s^-2] but 'd*phi'' is [kg m^2 s^-2]"
    assert fault.message == stated
    assert lines[fault.location.line - 1].strip() == f"phi: {UNCORRECTED}"
    assert lines[fault.location.line - 1][fault.location.column - 1 :] == "d*phi'"


def test_without_units_the_corrected_equation_holds():
    assert claims_that_hold_without_units(f"{UNCORRECTED}/(m_B*l)") == 1


def test_without_units_the_uncorrected_equation_does_not_hold():
    with pytest.raises(CheckError, match="does not hold on the motion"):
        claims_that_hold_without_units(UNCORRECTED)


def claims_that_hold_without_units(equation):
    text = expecting("disc_pendulum", f"  equations:\n    phi: {equation}\n")
    machine = machine_of(read(without_units(text), "disc_pendulum.yaml"))
    return expectations.check(machine, samples.draw(machine.model))


def without_units(text):
    """The same spec with plain numbers."""
    return re.sub(r"(?<=\d) [a-z][\w*/^]*", "", re.sub(r"unit: \w+, ", "", text), flags=re.I)


def test_each_equation_is_derived_in_the_four_steps():
    """The row keeps dL/ds', its rate and dL/ds of row 11 as the slide prints them."""
    row, _ = derivation_of("slider_spring_pendulum").rows
    momentum, rate, slope = forms(
        "slider_spring_pendulum",
        "(m_A + m_B)*s' + m_B*l*phi'*cos(phi)",
        "(m_A + m_B)*s'' + m_B*l*phi''*cos(phi) - m_B*l*phi'^2*sin(phi)",
        "-k*s",
    )
    assert (row.momentum, row.momentum_rate, row.slope) == (momentum, rate, slope)


@pytest.mark.parametrize("name", EQUATIONS)
def test_the_coordinates_are_a_free_set(name):
    """n = g: as many coordinates as degrees of freedom, each with its own equation."""
    derivation = derivation_of(name)
    assert [c.role for c in derivation.model.coordinates] == ["free", "free"]
    assert len(derivation.equations) == derivation.model.expect.dof == 2


# --- what is printed, term for term: accelerations first, then velocity terms, springs, weights

TEXT = {
    "particle_cartesian": ("m x″ = F_x", "m y″ = F_y"),
    "particle_polar": ("m (R″ − R θ′²) = F_R", "m (R θ″ + 2 R′ θ′) = F_θ"),
    "slider_pendulum_free": (
        "(m_A + m_B) s″ + m_B l φ″ cos φ − m_B l φ′² sin φ = 0",
        "l φ″ + s″ cos φ + g sin φ = 0",
    ),
    "slider_spring_pendulum": (
        "T = ½ (m_A + m_B) s′² + ½ m_B l² φ′² + m_B l s′ φ′ cos φ",
        "V = ½ k s² − m_B g l cos φ",
        "(m_A + m_B) s″ + m_B l φ″ cos φ − m_B l φ′² sin φ + k s = 0",
        "l φ″ + s″ cos φ + g sin φ = 0",
    ),
    "disc_pendulum": (
        "T = ½ (3/2 m_A + m_B) s′² + ½ m_B l² φ′² + m_B l s′ φ′ cos φ",
        "V = ½ k (s − l_0)² − m_B g l cos φ",
        "Q_s = −c s′",
        "Q_φ = −d φ′",
        "(3/2 m_A + m_B) s″ + m_B l φ″ cos φ − m_B l φ′² sin φ + k (s − l_0) = −c s′",
        "l φ″ + s″ cos φ + g sin φ = −d φ′/(m_B l)",
    ),
}
LATEX = {
    "particle_cartesian": (r"m \ddot{x} = F_x", r"m \ddot{y} = F_y"),
    "particle_polar": (
        r"m (\ddot{R} - R \dot{\theta}^2) = F_R",
        r"m (R \ddot{\theta} + 2 \dot{R} \dot{\theta}) = F_\theta",
    ),
    "slider_pendulum_free": (
        r"x_{A} = s",
        r"y_{A} = 0",
        r"x_{B} = s + l \sin\varphi",
        r"y_{B} = -l \cos\varphi",
        r"(m_A + m_B) \ddot{s} + m_B l \ddot{\varphi} \cos\varphi"
        r" - m_B l \dot{\varphi}^2 \sin\varphi = 0",
        r"l \ddot{\varphi} + \ddot{s} \cos\varphi + g \sin\varphi = 0",
    ),
    "slider_spring_pendulum": (
        r"L = T - V = \tfrac12 (m_A + m_B) \dot{s}^2 + \tfrac12 m_B l^2 \dot{\varphi}^2"
        r" + m_B l \dot{s} \dot{\varphi} \cos\varphi - \tfrac12 k s^2 + m_B g l \cos\varphi",
        r"(m_A + m_B) \ddot{s} + m_B l \ddot{\varphi} \cos\varphi"
        r" - m_B l \dot{\varphi}^2 \sin\varphi + k s = 0",
        r"l \ddot{\varphi} + \ddot{s} \cos\varphi + g \sin\varphi = 0",
    ),
    "disc_pendulum": (
        r"L = T - V = \tfrac12 (\tfrac32 m_A + m_B) \dot{s}^2 + \tfrac12 m_B l^2 \dot{\varphi}^2"
        r" + m_B l \dot{s} \dot{\varphi} \cos\varphi - \tfrac12 k (s - l_0)^2"
        r" + m_B g l \cos\varphi",
        r"Q_{s} = -c \dot{s}",
        r"Q_{\varphi} = -c' \dot{\varphi}",
        r"(\tfrac32 m_A + m_B) \ddot{s} + m_B l \ddot{\varphi} \cos\varphi"
        r" - m_B l \dot{\varphi}^2 \sin\varphi + k (s - l_0) = -c \dot{s}",
        r"l \ddot{\varphi} + \ddot{s} \cos\varphi + g \sin\varphi"
        r" = -\frac{c' \dot{\varphi}}{m_B l}",
    ),
}


def printed(name, target):
    """The lines of a target, the columns of a line apart."""
    wish = Wish((target,), steps=True)
    (text,) = rendered(study_of(name), wish).values()
    cells = text.replace("&=", "=").replace(r"\\", "").replace("\n", "&").split("&")
    return {" ".join(cell.split()) for cell in cells}


@pytest.mark.parametrize("name", TEXT)
def test_the_terminal_shows_the_lectures_equations(name):
    assert set(TEXT[name]) <= printed(name, "text")


@pytest.mark.parametrize("name", LATEX)
def test_the_notes_show_the_lectures_equations(name):
    assert set(LATEX[name]) <= printed(name, "latex")
