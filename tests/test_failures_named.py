"""How formulations fail, one named message for each way; and what looks like it, but is none."""

import json
from fractions import Fraction

import numpy as np
import pytest
from scenes import admissible_of, study_of, text_of

from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.answers import Question, answers
from eomgen.errors import UsageError
from eomgen.mechanics import multipliers
from eomgen.study import of_text
from eomgen.wanted import Wanted

HEAD = "eom: 1\nsystem: A\nspace: plane\ngravity: [0, -g]\n"
PENDULUM = f"""{HEAD}parameters: {{m: 2 kg, l: 0.5 m, g: 9.81 m/s^2}}
coordinates: {{x: m, y: {{unit: m, role: linked}}}}
bodies: {{bob: {{mass: m, at: [x, y]}}}}
constraints: {{rod: {{holonomic: x^2 + y^2 = l^2}}}}
initial: {{x: 0.3 m, x': 0.8 m/s, guess: {{y: -0.4 m}}}}
"""
DEAD_START = PENDULUM.replace("x: 0.3 m, x': 0.8 m/s", "x: 0.5 m, x': 0 m/s")
TURNING = PENDULUM.replace("x: m, y: {unit: m, role: linked}", "x: {unit: m, role: linked}, y: m")
TURNING += "range: {x: [-0.5 m, 0.5 m]}\n"
TWICE = PENDULUM.replace("l^2}", "l^2}, again: {holonomic: 2*x^2 + 2*y^2 = 2*l^2}")
AGAINST = PENDULUM.replace("l^2}", "l^2}, far: {holonomic: x = 3*l}")
FAST = PENDULUM.replace(
    "l^2}", "l^2}, up: {holonomic: y = -0.4*l/0.5}, left: {holonomic: x = 0.3*l/0.5}"
)
FLAT = PENDULUM.replace("x^2 + y^2 = l^2", "(x - y - l)^2 = 0")
NOWHERE = PENDULUM.replace("x^2 + y^2 = l^2", "y = sqrt(-l^2 - x^2)")
EMPTY_RANGE = PENDULUM + "range: {x: [0.6 m, 0.7 m]}\n"
LOOSE = PENDULUM.replace("x: m,", "x: m, z: m,").replace("x': 0.8 m/s", "x': 0.8 m/s, z: 0, z': 0")
BELOW = PENDULUM.replace("l^2}", "l^2}, floor: {unilateral: y >= 0}")
ROUGH_PAIR = PENDULUM.replace(
    "{rod: {holonomic: x^2 + y^2 = l^2}}",
    "{one: {holonomic: y = -0.4*l/0.5, friction: 0.1}, two: {holonomic: x = 0.3*l/0.5, "
    "friction: 0.1}}",
)

NAMED = [  # what fails, the formulation, the words
    ("a dead point in closed form", DEAD_START, "minimal", "minimal: W-DEAD: y has a dead point"),
    ("dependents that become dependent", TURNING, "nullspace", "W-PIVOT: x cannot stay dependent"),
    ("a start where they are", DEAD_START, "nullspace", "W-PIVOT: y cannot stay dependent"),
    ("rank that falls", text_of("parallelogram"), "nullspace", "the constraints lose rank inside"),
    ("a singular mass matrix", LOOSE, "auto", r"E-MASS: .*the motion z [+-]1 has no inertia"),
    ("constraints that contradict", AGAINST, "auto", r"far \(residual .* together with rod"),
    ("more constraints than coordinates", FAST, "auto", r"3 constraints \(rod, up, left\) hold 2"),
    ("a row without gradient", FLAT, "auto", "constraint rod has no gradient where it holds"),
    (
        "a row that is not defined",
        NOWHERE,
        "auto",
        "constraints rod are not defined at the initial",
    ),
    ("a range that nothing enters", EMPTY_RANGE, "auto", "0 of 5 random admissible states"),
    ("a gap below zero", BELOW, "auto", "violates the unilateral constraint floor"),
    ("two rough guides", ROUGH_PAIR, "auto", "one and two both have friction"),
]


@pytest.mark.parametrize(
    ("text", "wanted", "words"), [n[1:] for n in NAMED], ids=[n[0] for n in NAMED]
)
def test_each_failure_has_its_words(text, wanted, words) -> None:
    with pytest.raises(UsageError, match=words):
        of_text(text, "failing.yaml", Wanted(wanted)).links.program()


def test_redundancy_is_a_warning() -> None:
    freedom = of_text(TWICE, "twice.yaml").links.scene.report.freedom
    assert freedom.warnings == (
        "W-RANK: constraint again depends on rod (rank 1 of 2); dropped. "
        "Reaction forces of rod, again are not unique.",
    )


def test_auto_goes_on_where_the_smaller_ones_fail_and_says_why() -> None:
    chosen = of_text(TURNING, "turning.yaml").links.chosen
    assert chosen.name == "multiplier"
    assert chosen.why.startswith("W-PIVOT: x cannot stay dependent over the range")
    plain = text_of("parallelogram")
    plain = "\n".join(line.partition(", reaction")[0] + "}" * (", reaction" in line)
                      for line in plain.splitlines())  # fmt: skip
    chosen = of_text(plain, "parallelogram.yaml").links.chosen
    assert (chosen.name, chosen.why) == ("multiplier", "the constraints lose rank inside `range`")


# --- a motion without inertia that the constraints decide


def test_a_massless_coupler_is_a_two_force_member() -> None:
    (found,) = answers(study_of("massless_coupler"), "{}", Question())
    force = found["reactions"]["pin_C"]
    state = study_of("massless_coupler").links.scene.report.initial.state
    angle = float(state.coordinates[1])
    assert force["y"] * np.cos(angle) == pytest.approx(force["x"] * np.sin(angle), rel=1e-12)
    assert np.hypot(force["x"], force["y"]) > 0.1


def test_it_is_said_and_only_where_it_is_needed() -> None:
    study = study_of("massless_coupler")
    assert "M is singular where the constraints decide: M + 0.1 J'J" in study.links.chosen.why
    assert study.links.formulations == ("minimal", "nullspace", "multiplier")
    assert study_of("four_bar").machine.weight == 0


@pytest.mark.parametrize("weight", [Fraction(1, 10), Fraction(3), Fraction(1000)])
def test_any_weight_gives_the_solution_of_the_whole_system(weight) -> None:
    """[M -J'; J 0] (u', lambda) = (Q - h, -gamma), dense, where M alone cannot be inverted."""
    machine, at = study_of("massless_coupler").machine, admissible_of("massless_coupler")
    system = multipliers.schur(machine.equations, machine.rows, weight)
    found = multipliers.solve(system)
    equations = machine.equations
    for i in range(at.count):
        given = {name: [c[i] for c in columns] for name, columns in at.arguments().items()}
        leaves = {n: given[n.datum.argument][n.datum.index] for n in machine.leaves}

        def values(nodes, leaves=leaves):
            return np.array(evaluate(nodes, leaves, FLOAT))

        mass = values([e for row in equations.mass_matrix for e in row]).reshape(3, 3)
        slopes = values([e for row in machine.rows for e in row.jacobian]).reshape(2, 3)
        assert np.linalg.matrix_rank(mass) == 2
        load = values(equations.generalized_forces) - values(equations.bias)
        whole = np.block([[mass, -slopes.T], [slopes, np.zeros((2, 2))]])
        right = [*load, *-values([row.gamma for row in machine.rows])]
        expected = np.linalg.solve(whole, right)
        got = values([*found.accelerations, *found.multipliers])
        assert np.abs(got - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("using", ["interpreter", "c", "python"])
def test_projection_works_without_inertia_too(using) -> None:
    state = json.dumps({"coordinates": {"q1": "1.05", "q2": "0.45"}, "rates": {"q2": "-0.2"}})
    (found,) = answers(study_of("massless_coupler"), state, Question(using=using, project=True))
    residuals = [v for group in found["residuals"].values() for v in group.values()]
    assert max(map(abs, residuals)) < 1e-12


def test_a_massless_crank_on_two_loose_links_is_still_refused() -> None:
    """The constraint binds y and z together, and neither has inertia: their difference has none."""
    text = LOOSE.replace("coordinates: {x: m, z: m,", "coordinates: {x: m, z: m, w: m,")
    text = text.replace("z: 0, z': 0", "z: 0, z': 0, w: 0, w': 0")
    text = text.replace("rod: {", "tie: {holonomic: z = w}, rod: {")
    with pytest.raises(UsageError, match="E-MASS: .*no constraint decides it"):
        of_text(text, "a.yaml")
