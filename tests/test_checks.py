"""The checks see what is wrong: each is shown a scene that was tampered with."""

import random
from dataclasses import replace
from functools import cached_property

import numpy as np
import pytest
from scenes import LINKED, SHIPPED, SLOW, each, expecting
from studies import PENDULUM, model, study

from eomgen import compile
from eomgen.algebra.graph import Node
from eomgen.checks import agreement, dimensions, evaluation, power, samples
from eomgen.errors import CheckError
from eomgen.mechanics import efforts, lagrange
from eomgen.mechanics.recursive import rigid
from eomgen.mechanics.vectors import Vector
from eomgen.spec import read
from eomgen.study import of_model, of_text

STIFF = {"flyball_governor": 4e-12}  # its springs cancel: 8e5 N/m


@each(SHIPPED)
def test_every_shipped_spec_passes_every_check(name: str) -> None:
    report = study(name).report
    assert report.agreement.error < STIFF.get(name, 1e-12)
    assert report.agreement.states == samples.COUNT
    assert report.power < 1e-12
    assert report.terms > 0
    assert report.claims > 0


@pytest.mark.parametrize("name", STIFF)
def test_what_a_stiff_scene_loses_in_double_is_there_in_50_digits(name: str) -> None:
    found = study(name)
    drawn = samples.draw(found.model)
    assert found.report.agreement.proven
    assert max(agreement.decided(found.derivation, found.machine, drawn)) < 1e-40


@each(LINKED)
def test_a_linked_spec_is_derived_in_every_formulation_that_it_has(name: str) -> None:
    found = study(name)
    assert found.links is not None
    assert found.links.formulations == found.report.formulations
    assert found.links.chosen.name in found.links.formulations
    assert "multiplier" in found.links.formulations


def test_most_small_scenes_are_proven_not_sampled() -> None:
    names = [name for name in SHIPPED if name not in SLOW]
    proven = [name for name in names if study(name).report.agreement.proven]
    assert len(proven) >= len(names) - 2
    assert "slider_pendulum" in proven


@pytest.mark.parametrize("part", ["mass_matrix", "bias", "generalized_forces"])
@pytest.mark.parametrize("name", ["slider_pendulum", "skew_arm"])
def test_a_wrong_term_is_seen(name: str, part: str) -> None:
    found = study(name)
    small = found.derivation.matrix.bias[1] * 0 + 1
    values = getattr(found.derivation.matrix, part)
    first = values[0]
    wrong = (first[0] + small, *first[1:]) if isinstance(first, tuple) else first + small
    matrix = replace(found.derivation.matrix, **{part: (wrong, *values[1:])})
    tampered = replace(found.derivation, matrix=matrix)
    assert not agreement.proven(tampered, found.machine)
    with pytest.raises(CheckError, match="differ"):
        agreement.compare(tampered, found.machine, samples.draw(found.model))


def test_a_forgotten_gyroscopic_term_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The planar scenes would not notice; the spatial one must."""
    whole = rigid.wrench

    def forgetful(
        body: rigid.Rigid, spin: Vector[Node], acceleration: Vector[Node]
    ) -> Vector[Node]:
        return whole(body, tuple(0 * w for w in spin), acceleration)

    monkeypatch.setattr(rigid, "wrench", forgetful)
    scene = model("skew_arm")
    with pytest.raises(CheckError, match="differ"):
        agreement.compare(lagrange.derive(scene), compile.machine_of(scene), samples.draw(scene))


class WithoutPotential(compile.Machine):
    """A machine that forgets the potential energy."""

    @cached_property
    def energy(self) -> tuple[Node, Node]:
        kinetic, potential = super().energy
        return kinetic, potential * 0


@pytest.mark.parametrize("name", ["slider_pendulum", "heavy_top", "elastic_pendulum"])
def test_a_wrong_energy_is_seen(name: str) -> None:
    scene = model(name)
    tampered = WithoutPotential(compile.machine_of(scene).kinematics)
    with pytest.raises(CheckError, match="power"):
        power.balance(tampered, samples.draw(scene))


def test_a_lost_force_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(efforts, "dissipative", lambda kinematics: iter(()))
    scene = model("slider_pendulum")
    derivation, machine = lagrange.derive(scene), compile.machine_of(scene)
    drawn = samples.draw(scene)
    with pytest.raises(CheckError, match="differ"):
        agreement.compare(derivation, machine, drawn)


def test_a_term_of_another_dimension_is_named() -> None:
    found = study("slider_pendulum").derivation
    second = found.equations[1]
    # the uncorrected damping of the lecture's last slide: divided on one side only
    wrong = replace(second, damping=found.equations[0].damping)
    with pytest.raises(CheckError, match="equation of phi adds unlike terms: .* is .*, but .* is"):
        dimensions.check(replace(found, equations=(found.equations[0], wrong)))


CLAIMS = [
    ("dof: 2", "dof is 1"),
    ("equations: [\"m*l^2*phi'' + d*phi' + 2*m*g*l*sin(phi) = tau\"]", "does not hold"),
    ("equations: [\"m*l^2*phi'' + d*phi' + m*g*l*sin(phi) = -tau\"]", "does not hold"),
    ('conserved: "m*l^2*phi\'"', "is not conserved"),
    ("conserved: m*l^2", "constant by itself"),
    ('kinetic: "m*l^2*phi\'^2"', "is not the energy"),
    ("potential: m*g*l*cos(phi)", "is not the energy"),
    ("equilibrium: {phi: 90 deg}", "is not an equilibrium"),
]


@pytest.mark.parametrize(("claim", "words"), CLAIMS)
def test_a_wrong_claim_is_named(claim: str, words: str) -> None:
    with pytest.raises(CheckError, match=words):
        of_text(f"{PENDULUM}expect:\n  {claim}\n", "pendulum.yaml")


TRUE = """\
expect:
  dof: 1
  equations: ["m*l^2*phi'' + d*phi' + m*g*l*sin(phi) = tau"]
  kinetic: "m*l^2*phi'^2/2"
  potential: 7*m*g*l - m*g*l*cos(phi)
  equilibrium: [{phi: 0}, {phi: 180 deg}]
"""


def test_true_claims_are_counted() -> None:
    assert of_text(PENDULUM + TRUE, "pendulum.yaml").report.claims == 6


def test_samples_are_seeded_and_in_range() -> None:
    scene = read(PENDULUM + "range: {phi: [10 deg, 20 deg]}\n", "pendulum.yaml")
    first, second = samples.draw(scene), samples.draw(scene)
    assert first == second
    assert all(0.17 < v < 0.35 for v in first.state[0])
    assert samples.draw(scene, seed=2) != first


def test_what_one_check_computes_the_next_one_reads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evaluation, "LARGEST_SINGLY", 0)
    machine, drawn = compile.machine_of(model("skew_arm")), samples.draw(model("skew_arm"))
    wanted = power.balance_terms(machine)
    power.balance(machine, drawn)
    ((again, _),) = evaluation.benches(machine, drawn)
    ((fresh, _),) = evaluation.benches(machine, samples.draw(model("skew_arm")))
    for node, kept, value in zip(wanted, again.nodes(wanted), fresh.nodes(wanted), strict=True):
        assert kept is drawn.known[node]
        assert np.array_equal(kept, value)
    assert not replace(drawn, count=drawn.count).known


def test_free_accelerations_are_those_of_the_samples(monkeypatch: pytest.MonkeyPatch) -> None:
    machine, drawn = compile.machine_of(model("skew_arm")), samples.draw(model("skew_arm"))
    for largest in (0, 10**6):
        monkeypatch.setattr(evaluation, "LARGEST_SINGLY", largest)
        states = list(evaluation.benches(machine, drawn))
        found = [np.vstack(at.nodes(evaluation.free_accelerations(machine))) for at, _ in states]
        assert len(states) == (drawn.count if largest else 1)
        assert np.array_equal(np.hstack(found), drawn.accelerations)


def test_a_scene_without_a_regular_state_is_refused() -> None:
    text = PENDULUM.replace("inputs:", "prescribed: {w: l*sqrt(-1 - t^2*g/l)}\ninputs:")
    text = text.replace('"l*[sin(phi), -cos(phi)]"', '"l*[sin(phi), -cos(phi)] + [w, 0]"')
    with pytest.raises(CheckError, match="no regular state"):
        of_text(text, "pendulum.yaml")


def test_doubtful_doubles_are_decided_in_50_digits() -> None:
    """A closed form that cancels badly in double is right all the same."""
    found = study("double_pendulum")
    big = found.derivation.matrix.bias[0] * 10**14
    bias = (found.derivation.matrix.bias[0] + big + -1 * big, *found.derivation.matrix.bias[1:])
    tampered = replace(found.derivation, matrix=replace(found.derivation.matrix, bias=bias))
    drawn = samples.draw(found.model)
    errors = agreement.decided(tampered, found.machine, drawn)
    assert len(errors) == agreement.DECIDING_STATES
    assert max(errors) < 1e-40


def test_random_is_not_shared_with_the_caller() -> None:
    random.seed(5)
    before = random.getstate()
    samples.draw(model("slider_pendulum"))
    assert random.getstate() == before


@pytest.mark.parametrize(
    ("name", "claim"),
    [
        ("rolling_disc_upright", "theta'' = 0"),
        ("rolling_disc_upright", "phi'' = 0"),
        ("mass_on_sphere", "sin((x*y'' - y*x'')/g/R) = 0"),
    ],
)
def test_a_single_term_that_vanishes_is_no_round_off(name: str, claim: str) -> None:
    """In doubles it is all of its own size; in 50 digits it is nothing."""
    claiming = read(expecting(name, f"  equations:\n    - {claim}\n"), f"{name}.yaml")
    assert of_model(claiming).report.claims == 1


@pytest.mark.parametrize(
    ("name", "claim"),
    [
        ("rolling_disc_upright", "theta'' = 1e-13*phi'^2"),
        ("mass_leaving_sphere", "x'' = 1e-14*g"),
    ],
)
def test_a_term_that_is_small_and_not_zero_is_refused(name: str, claim: str) -> None:
    claiming = read(expecting(name, f"  equations:\n    - {claim}\n"), f"{name}.yaml")
    with pytest.raises(CheckError, match="does not hold on the motion"):
        of_model(claiming)
