"""Newton, d'Alembert, Lagrange of both kinds and Kane give one motion, and the reactions hold."""

from dataclasses import replace
from functools import cache

import pytest
import sympy as sp
from scenes import (
    EXTRA,
    LINKED,
    SHIPPED,
    derivation_of,
    machine_of,
    model_of,
    samples_of,
    study_of,
    text_of,
)

from eomgen import compile
from eomgen.algebra import normal
from eomgen.algebra.arithmetic import FLOAT
from eomgen.algebra.closed import ClosedForm, to_sympy
from eomgen.algebra.normal import atoms_of
from eomgen.checks import agreement, samples
from eomgen.checks import principles as comparison
from eomgen.checks.evaluation import singly
from eomgen.errors import CheckError, UsageError
from eomgen.mechanics import (
    free_bodies,
    free_bodies_joints,
    free_bodies_loads,
    free_bodies_rows,
    lagrange,
    newton_euler,
    principles,
)
from eomgen.mechanics.vectors import add, scale
from eomgen.spec import read
from eomgen.wanted import METHODS

TOO_LARGE = {"ball_joints", "bricard", "long_chain"}  # seconds for each of five derivations
NAMES = [n for n in (*SHIPPED, *EXTRA) if n not in TOO_LARGE]
WITH_BODIES = [n for n in NAMES if "newton" in principles.applicable(model_of(n))]


def kinematics_of(name):
    return lagrange.closed_kinematics(model_of(name))


@cache
def free_of(name):
    return free_bodies.derive(kinematics_of(name))


def by_joints(names):
    return [n for n in names if n in WITH_BODIES and free_of(n).by_joints]


JOINTED = [  # what each joint transmits is found there; the list is tested
    "bead_on_fixed_hoop", "bead_on_rough_wire", "bead_on_turning_hoop", "block_on_incline",
    "block_with_friction", "bouncing_ball", "cart_three_pendulums", "compound_pendulum",
    "disc_pendulum", "double_pendulum", "duffing_oscillator", "dumbbell", "elastic_pendulum",
    "four_bar", "half_car", "kapitza_pendulum", "landing_gear", "manipulator",
    "mass_leaving_sphere", "mass_on_sphere", "painleve_rod", "parallelogram",
    "particle_cartesian", "particle_polar", "projectile_drag", "quarter_car", "rolling_cylinder",
    "rope", "rotating_table", "simple_pendulum", "slider_crank", "slider_crank_equal",
    "slider_pendulum", "slider_pendulum_free", "slider_spring_pendulum", "sliding_ladder",
    "snakeboard", "spherical_pendulum", "spring_mass_chain", "sprung_pair", "two_link_arm",
    "two_rotor_drive", "drifting_speeds", "duffing_by_energy", "unitless",
]  # fmt: skip


@pytest.mark.slow
def test_the_list_of_jointed_scenes_is_complete():
    assert by_joints(NAMES) == JOINTED


def whole_machine(name):
    """With multipliers where the scene is linked."""
    return study_of(name).machine if name in LINKED else machine_of(name)


def test_the_command_line_names_the_rows_of_the_table():
    assert METHODS == principles.NAMES


SLOW = {"spatial_tree", "flyball_governor", "andrews_squeezer"}


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.slow) if n in SLOW else n for n in NAMES]
)
def test_every_formalism_that_applies_is_newton_euler_on_the_graph(name):
    for method in principles.applicable(model_of(name)):
        found = principles.worked(model_of(name), method)
        with_it = replace(derivation_of(name), matrix=found.matrix)
        held = agreement.compare(with_it, machine_of(name), samples_of(name))
        assert held.error < 1e-9 or held.digits == agreement.DIGITS


def test_the_skew_spatial_scenes_are_among_them():
    for name in ("skew_arm", "spatial_tree", "spatial_rod"):
        assert principles.applicable(model_of(name)) == principles.NAMES


@pytest.mark.parametrize("method", ["newton", "dalembert", "kane"])
def test_a_formalism_that_forgets_gyroscopic_terms_is_found_out(method, monkeypatch):
    """w x I w is left out of every body's rate of angular momentum."""
    plain = free_bodies_rows.cross
    monkeypatch.setattr(free_bodies_rows, "cross", lambda a, b: scale(a[0] * 0, plain(a, b)))
    found = principles.worked(model_of("skew_arm"), method)
    with_it = replace(derivation_of("skew_arm"), matrix=found.matrix)
    with pytest.raises(CheckError, match="differ"):
        agreement.compare(with_it, machine_of("skew_arm"), samples_of("skew_arm"))


@pytest.mark.parametrize(
    ("name", "method", "why"),
    [
        ("central_force", "newton", "no bodies, its energies are given"),
        ("central_force", "dalembert", "no bodies"),
        ("central_force", "kane", "no bodies"),
        ("central_force", "lagrange1", "no bodies"),
    ],
)
def test_a_formalism_that_does_not_apply_is_refused_with_the_reason(name, method, why):
    with pytest.raises(UsageError, match=why) as caught:
        principles.worked(model_of(name), method)
    assert "those that do: lagrange" in str(caught.value)


def test_a_part_of_the_kinetic_energy_of_no_body_is_a_reason():
    model = model_of("simple_pendulum")
    rate = model.coordinates[0].rate
    given = replace(model, energy=replace(model.energy, kinetic=rate**2))
    with pytest.raises(UsageError, match="given as a formula, of no known body"):
        principles.worked(given, "newton")
    assert principles.applicable(given) == ("lagrange", "lagrange1")


# --- free bodies


@pytest.mark.parametrize("name", JOINTED)
def test_the_sums_hold_no_reaction(name):
    """The sum of dv/dq' times the reactions is J' lambda and nothing else, decided."""
    kinematics = kinematics_of(name)
    free = free_bodies.derive(kinematics)
    left = free_bodies_rows.weighted(kinematics, free.rows, "reaction")
    for work, tied in zip(left, free_bodies_loads.constrained(kinematics), strict=True):
        assert normal.is_zero(work - tied)


def test_most_scenes_of_the_plane_are_resolved_into_joints():
    assert {
        "slider_pendulum", "disc_pendulum", "double_pendulum", "four_bar", "slider_crank",
        "two_link_arm", "spherical_pendulum", "compound_pendulum", "snakeboard",
    } <= set(JOINTED)  # fmt: skip
    # one coordinate moves two weights and a pulley: what the rope does is not in the tree
    assert "atwood_machine" not in JOINTED
    assert "skew_arm" not in JOINTED


@pytest.mark.parametrize("name", WITH_BODIES)
def test_the_equations_of_the_bodies_hold_on_the_motion(name):
    assert comparison.on_bodies(free_of(name), whole_machine(name), samples_of(name)) < 1e-9


@pytest.mark.parametrize("name", ["slider_pendulum", "four_bar", "disc_pendulum"])
def test_a_wrong_reaction_is_found_out(name):
    free = free_of(name)
    last = free.unknowns[-1]
    wrong = replace(free, unknowns=(*free.unknowns[:-1], replace(last, value=last.value * 2)))
    with pytest.raises(CheckError, match="do not hold on the motion"):
        comparison.on_bodies(wrong, whole_machine(name), samples_of(name))


def forces_in_closed_form(name):
    """The force [N] of the parent on each body, as the sum of its unknowns."""
    kinematics = kinematics_of(name)
    values = {u.symbol: u.value for u in free_bodies.derive(kinematics).unknowns}
    found = {}
    for hinge in free_bodies.hinges_of(kinematics):
        total = free_bodies_loads.nothing(kinematics).force
        for share in free_bodies_joints.shares(kinematics, hinge):
            symbol = f"reaction {share.letter} {hinge.joint.body}"
            (value,) = (v for s, v in values.items() if s.name == symbol)
            total = add(total, scale(value, share.force))
        found[hinge.joint.body] = total
    return found


@pytest.mark.parametrize("name", ["slider_pendulum_free", "double_pendulum", "two_link_arm",
                                  "cart_three_pendulums", "spherical_pendulum"])  # fmt: skip
def test_reactions_are_those_of_the_recursion_on_the_graph(name):
    machine = machine_of(name)
    closed = forces_in_closed_form(name)
    graph = {r.on: r.force for r in newton_euler.reactions(machine)}
    assert graph.keys() == closed.keys()
    for at, _ in singly(machine, samples_of(name), FLOAT, 5):
        value = comparison.evaluation(comparison.moving(at), at)
        for body, force in graph.items():
            found = [float(value.of(c)) for c in closed[body]]
            assert found == pytest.approx(at.nodes(force), rel=1e-9, abs=1e-9)


def in_words(name, formula, ring):
    """A formula over the names of the spec, with a'' for accelerations."""
    model = model_of(name)
    names = {"length" if p.name == "l" else p.name: p.symbol for p in model.parameters}
    for q in model.coordinates:
        names |= {q.name: q.symbol, f"{q.name}_1": q.rate, f"{q.name}_2": q.acceleration}
    return ClosedForm(ring).of(formula(sp, **names))


@pytest.mark.parametrize(
    ("name", "letter", "body", "formula"),
    [
        # the lecture's slider with pendulum: rod force and normal force
        (
            "slider_pendulum_free", "S", "bob",
            lambda sp, m_B, length, g, phi, phi_1, s_2, **_: (
                m_B * (length * phi_1**2 + g * sp.cos(phi) - s_2 * sp.sin(phi))
            ),
        ),
        (
            "slider_pendulum_free", "N", "slider",
            lambda sp, m_A, m_B, length, g, phi, phi_1, phi_2, **_: (
                (m_A + m_B) * g + m_B * length * (phi_2 * sp.sin(phi) + phi_1**2 * sp.cos(phi))
            ),
        ),
        # conical motion: S = m l theta'^2 + m l phi'^2 sin^2 + m g cos
        (
            "spherical_pendulum", "S", "bob",
            lambda sp, m, length, g, theta, theta_1, phi_1, **_: (
                m * length * (theta_1**2 + phi_1**2 * sp.sin(theta) ** 2) + m * g * sp.cos(theta)
            ),
        ),
    ],
)  # fmt: skip
def test_reactions_of_the_lecture(name, letter, body, formula):
    kinematics = kinematics_of(name)
    free = free_bodies.derive(kinematics)
    (unknown,) = (u for u in free.unknowns if (u.letter, u.body) == (letter, body))
    stated = in_words(name, formula, kinematics.algebra.ring)
    assert normal.is_zero(unknown.value - stated)


def test_friction_of_the_rolling_disc_acts_at_its_rim():
    """-1/2 m_A r s'' = F r: the moment of what holds it is that of a force at the contact."""
    (moment,) = (r for r in free_of("disc_pendulum").rows if r.body == "disc" and r.is_moment)
    kinematics = kinematics_of("disc_pendulum")
    (turned,) = (r for r in free_bodies.derive(kinematics).rows if r.body == "disc" and r.is_moment)
    model = model_of("disc_pendulum")
    radius = next(p.symbol for p in model.parameters if p.name == "r")
    friction = next(u.symbol for u in free_of("disc_pendulum").unknowns if u.letter == "F")
    algebra = kinematics.algebra
    assert normal.is_zero(turned.reaction - algebra.of(radius) * algebra.of(friction))
    assert not moment.applied.terms


def test_all_that_apply_are_compared_and_the_worst_is_said():
    name = "slider_pendulum"
    found = comparison.compare(derivation_of(name), machine_of(name), samples_of(name), "kane")
    assert found.names == principles.NAMES
    assert found.worked.name == "kane"
    assert found.agreement.proven
    assert found.agreement.states == samples_of(name).count


def test_a_formalism_that_differs_is_an_error(monkeypatch):
    name = "slider_pendulum"
    row = principles.PRINCIPLES["kane"]

    def wrong(kinematics):
        steps = row.derive(kinematics)
        first, *others = steps.equations
        return replace(steps, equations=(replace(first, inertia=first.inertia * 2), *others))

    monkeypatch.setitem(principles.PRINCIPLES, "kane", replace(row, derive=wrong))
    with pytest.raises(CheckError, match="method kane"):
        comparison.compare(derivation_of(name), machine_of(name), samples_of(name), "newton")


def test_a_motor_in_a_joint_acts_on_both_bodies():
    """The drive along phi turns the rod; the slider feels the opposite force."""
    text = text_of("slider_pendulum_free").replace(
        "bodies:", "inputs: {tau: N*m}\nforces: [{along: phi, force: tau}]\nbodies:"
    )
    model = read(text.partition("\nexpect:")[0], "driven.yaml")
    machine, drawn = compile.machine_of(model), samples.draw(model)
    found = comparison.compare(lagrange.derive(model), machine, drawn, "newton")
    assert found.worked.steps.by_joints
    assert found.agreement.proven
    tau = model.inputs[0].symbol
    ring = found.worked.steps.rows[0].applied.ring
    pushed = {r.body for r in found.worked.steps.rows if ring.atom(tau) in atoms_of(r.applied)}
    assert pushed == {"slider", "bob"}


@pytest.mark.parametrize("name", ["sleigh_speeds", "mass_on_sphere", "four_bar"])
def test_what_constraints_add_to_kanes_equations_is_what_they_add_to_lagranges(name):
    """J' lambda over the declared speeds, or over the rates."""
    found = principles.worked(model_of(name), "kane").steps.tied
    for tied, row in zip(found, derivation_of(name).equations, strict=True):
        assert sp.expand(to_sympy(tied) - to_sympy(row.reaction)) == 0
