"""The command line on scenes with constraints: cards, formulations, states on and off them."""

import json
from pathlib import Path

import pytest
from scenes import LINKED, SHIPPED, study_of, text_of
from test_cli import finished

FREE_OF = {"four_bar": {"inputs": {"tau": "0.1"}}}


def answer(call, *words, stdin=""):
    """The JSON that a command prints."""
    said = call(*words, stdin=stdin)
    assert (said.code, said.errors) == (0, "")
    return json.loads(said.output)


def evaluated(call, name, *words, **state):
    """The results at one state of a shipped spec."""
    text = json.dumps(FREE_OF.get(name, {}) | state)
    (found,) = answer(call, "evaluate", SHIPPED[name], "--state", "-", *words, stdin=text)
    return found


def edited(name, old, new):
    """A shipped spec with one piece replaced."""
    text = text_of(name)
    assert text.count(old) == 1
    return text.replace(old, new)


# check


def test_check_says_the_formulation_why_and_where_it_starts(call):
    said = call("check", SHIPPED["four_bar"])
    assert said.code == 0
    first, *more = said.output.splitlines()
    assert "four_bar.yaml: 1 degree of freedom; multiplier (reactions are asked for); " in first
    assert "formulations minimal = nullspace = multiplier at admissible states" in first
    assert more[0].startswith("    dependent values found: q2 0.349066 -> 0.441269, q3 1.39626 -> ")
    assert more[1].startswith("    another assembly mode: q1 = 1.0472, q2 = -1.36034, q3 = -2.23")


CARDS = {
    # name -> bilateral, scleronomic, holonomic of each constraint
    "bead_on_turning_hoop": {"sphere": (True, True, True), "turning": (True, False, True)},
    "bouncing_ball": {"floor": (False, True, False)},
    "rolling_disc_upright": {"no_slip_x": (True, True, False), "no_slip_y": (True, True, False)},
    "four_bar": {"loop": (True, True, True)},
}
COUNTS = {  # coordinates, degrees of freedom, minimal number of coordinates
    "bead_on_turning_hoop": (3, 1, 1),
    "bouncing_ball": (2, 2, 2),
    "rolling_disc_upright": (4, 2, 4),
    "four_bar": (3, 1, 1),
}


@pytest.mark.parametrize("name", CARDS)
def test_check_for_machines_has_a_card_for_each_constraint(call, name):
    found = answer(call, "check", SHIPPED[name], "--format", "json")
    cards = {
        c["name"]: (c["bilateral"], c["scleronomic"], c["holonomic"]) for c in found["constraints"]
    }
    assert cards == CARDS[name]
    counts = ("coordinates", "degrees_of_freedom", "minimal_coordinates")
    assert tuple(found[k] for k in counts) == COUNTS[name]
    assert found["formulation"] == study_of(name).links.chosen.name
    assert found["formulations"] == list(study_of(name).links.formulations)


def test_rolling_is_shown_not_to_be_integrable(call):
    found = answer(call, "check", SHIPPED["rolling_disc_upright"], "--format", "json")
    assert all(card["growth"] == [[3, 4]] and not card["hidden"] for card in found["constraints"])
    assert found["independent"] == ["theta", "phi"]
    assert found["constraints"][0]["virtual"] == ["-R*delta phi*cos(theta) + delta x"]


def test_a_free_scene_has_no_cards(call):
    found = answer(call, "check", SHIPPED["simple_pendulum"], "--format", "json")
    assert not {"constraints", "formulation", "warnings"} & found.keys()


REDUNDANT = (
    "plane: {holonomic: y = 0,",
    "again: {holonomic: 2*y = 0}\n  plane: {holonomic: y = 0,",
)


def test_dependent_rows_are_dropped_and_named(call):
    said = call("check", "-", stdin=edited("bead_on_fixed_hoop", *REDUNDANT))
    assert said.code == 0
    assert "1 degree of freedom" in said.output
    assert "W-RANK: constraint plane depends on again" in said.output
    assert "Reaction forces of again, plane are not unique" in said.output


def test_rank_that_is_lost_inside_the_range_is_reported_with_its_place(call):
    said = call("check", SHIPPED["slider_crank_equal"])
    assert said.code == 0
    assert "W-SING: constraint wrist.y loses rank near phi = 1.5708, psi = 1.5708" in said.output
    found = answer(call, "check", SHIPPED["slider_crank_equal"], "--format", "json")
    assert [w[:7] for w in found["warnings"]] == ["W-SING:"]
    assert "W-" not in call("check", SHIPPED["slider_crank"]).output


def test_a_false_number_of_degrees_of_freedom_ends_with_1(call):
    said = call("check", "-", stdin=edited("four_bar", "dof: 1", "dof: 2"))
    assert (said.code, said.output) == (1, "")
    assert (
        said.errors == "<stdin>: error: expect: dof is 1, by the rank of the constraints, not 2\n"
    )


CONTRADICTORY = (
    "plane: {holonomic: y = 0,",
    "other: {holonomic: y = R}\n  plane: {holonomic: y = 0,",
)
TOO_MANY = (
    "plane: {holonomic: y = 0,",
    "low: {holonomic: x = R*sin(1)}\n  side: {holonomic: z^2 = R^2*cos(1)^2}\n"
    "  plane: {holonomic: y = 0,",
)
WRONG = {
    "contradictory": (
        edited("bead_on_fixed_hoop", *CONTRADICTORY),
        ("no admissible state was found: ", "other (residual", "plane (residual", "mend the con"),
    ),
    "out of reach": (
        edited("four_bar", "C = Cr", "C = Far").replace("\nbodies:", "\n  Far: [9*e, 0]\nbodies:"),
        ("no admissible state was found: ", "loop.x (residual", "mend the constraints"),
    ),
    "too many": (
        edited("bead_on_fixed_hoop", *TOO_MANY),
        ("4 constraints (hoop, low, side, plane) hold 3 coordinates fast", "remove constraints"),
    ),
    "penetrating": (
        edited("bouncing_ball", "y: 1 m,", "y: -1 m,"),
        ("violates the unilateral constraint floor: its gap is", "below zero"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("command", ["check", "derive", "generate", "evaluate"])
@pytest.mark.parametrize("fault", WRONG)
def test_constraints_that_cannot_hold_are_refused_with_their_rows(call, command, fault, tmp_path):
    text, words = WRONG[fault]
    said = call(command, "-", stdin=text)
    assert (said.code, said.output) == (2, "")
    assert said.errors.startswith("<stdin>: error: ")
    assert all(word in said.errors for word in words)
    assert not list(tmp_path.iterdir())


# derive and generate


@pytest.mark.parametrize("wanted", ["minimal", "nullspace", "multiplier"])
def test_the_formulation_can_be_chosen(call, wanted):
    said = call("derive", SHIPPED["block_on_incline"], "--formulation", wanted)
    assert (said.code, said.errors) == (0, "")
    assert f"Formulation of the generated code: {wanted} (" in said.output
    said = call("generate", SHIPPED["block_on_incline"], "-t", "python", "-o", wanted,
                "--formulation", wanted)  # fmt: skip
    assert said.code == 0
    text = Path(wanted, "block_on_incline.py").read_text(encoding="utf-8")
    tables = {
        "minimal": ('COORDINATES = ("x",)', """SPEEDS = ("x'",)""", "def all_coordinates("),
        "nullspace": (
            'COORDINATES = ("x", "y")',
            """SPEEDS = ("x'",)""",
            "def constraint_jacobian(",
        ),
        "multiplier": ('COORDINATES = ("x", "y")', """SPEEDS = ("x'", "y'")""", "def multipliers("),
    }
    assert all(line in text for line in tables[wanted])


def test_auto_is_the_formulation_where_none_is_chosen(call):
    plain = call("generate", SHIPPED["block_on_incline"], "-t", "c", "-o", "-")
    auto = call("generate", SHIPPED["block_on_incline"], "-t", "c", "-o", "-", "--formulation",
                "auto")  # fmt: skip
    assert plain.code == 0
    assert plain.output == auto.output


IMPOSSIBLE = {
    ("rolling_disc_upright", "minimal"): "a nonholonomic constraint eliminates no coordinate",
    ("bouncing_ball", "minimal"): "a one-sided constraint needs all coordinates",
    ("bouncing_ball", "nullspace"): "a one-sided constraint needs all coordinates",
    ("parallelogram", "nullspace"): "the constraints lose rank inside `range`",
}


@pytest.mark.parametrize("command", ["derive", "generate"])
@pytest.mark.parametrize(("name", "wanted"), IMPOSSIBLE)
def test_a_formulation_that_does_not_exist_says_why(call, name, wanted, command, tmp_path):
    said = call(command, SHIPPED[name], "--formulation", wanted)
    assert (said.code, said.output) == (2, "")
    assert f"{name}.yaml: error: {wanted}: {IMPOSSIBLE[name, wanted]}" in said.errors
    assert not list(tmp_path.iterdir())


def test_a_wrong_formulation_is_no_formulation(call):
    said = call("derive", SHIPPED["four_bar"], "--formulation", "kkt")
    assert (said.code, said.output) == (2, "")
    assert "'kkt' is not one of 'auto', 'minimal', 'nullspace', 'multiplier'" in said.errors


# evaluate


def test_evaluate_names_multipliers_reactions_and_residuals(call):
    found = evaluated(call, "block_on_incline")
    assert list(found) == [
        "accelerations", "energy", "generalized_forces", "outputs",
        "status", "multipliers", "reactions", "residuals",
    ]  # fmt: skip
    force = found["reactions"]["normal_force"]
    assert list(force) == ["on", "x", "y"]
    # m g cos(theta) across the incline: the force is lambda (-tan(theta), 1)
    assert found["multipliers"]["incline"] == pytest.approx(force["y"], rel=1e-12)
    assert set(found["residuals"]) == {"position", "rate"}
    assert abs(found["residuals"]["position"]["incline"]) < 1e-12


def test_evaluate_names_gaps_and_modes(call):
    found = evaluated(call, "bouncing_ball")
    assert found["contacts"]["gaps"]["floor"] > 0
    assert found["contacts"]["gap_rates"]["floor"] == 0
    modes = found["contacts"]["modes"]
    assert "accelerations" not in modes["flight"]
    (touching,) = (m for n, m in modes.items() if n != "flight")
    assert touching["accelerations"]["y"] == 0
    # the floor carries the ball
    assert touching["contact_forces"]["floor"] == -found["generalized_forces"]["y"]
    assert found["accelerations"]["y"] < -9


OFF = {"coordinates": {"x": "1", "y": "0.7"}}


def test_a_state_off_the_constraints_is_refused_with_its_residual(call):
    words = ("evaluate", SHIPPED["block_on_incline"], "--state", "-")
    said = call(*words, stdin=json.dumps(OFF))
    assert (said.code, said.output) == (1, "")
    assert "<stdin>: error: state 1: the state is off the constraints: incline has" in said.errors
    assert "the residual 0.123" in said.errors
    assert "--project" in said.errors
    said = call(*words, "--format", "json", stdin=json.dumps([{}, OFF]))
    (mistake,) = json.loads(said.errors)
    assert (said.code, mistake["message"][:8]) == (1, "state 2:")
    slow = {"rates": {"x": "1", "y": "0"}}
    assert "off the constraints" in call(*words, stdin=json.dumps(slow)).errors


@pytest.mark.parametrize("using", ["interpreter", "python"])
def test_project_moves_a_state_to_the_constraints(call, using):
    state = OFF | {"rates": {"x": "1", "y": "0"}}
    found = evaluated(call, "block_on_incline", "--project", "--using", using, **state)
    residuals = found["residuals"]
    assert abs(residuals["position"]["incline"]) < 1e-12
    assert abs(residuals["rate"]["incline"]) < 1e-12
    # the nearest rates in the metric of the masses: the part along the incline, cos(theta) long
    plain = evaluated(call, "block_on_incline")
    cosine = -plain["accelerations"]["x"] / 9.81 / (plain["accelerations"]["y"] / -9.81) ** 0.5
    assert found["energy"]["kinetic"] == pytest.approx(2 / 2 * cosine**2, rel=1e-9)
    assert found["accelerations"] == pytest.approx(plain["accelerations"], rel=1e-12)


def test_project_leaves_an_admissible_state_as_it_is(call):
    assert evaluated(call, "four_bar") == evaluated(call, "four_bar", "--project")


def test_a_state_that_cannot_be_projected_says_so(call):
    state = {"inputs": {"tau": 0}, "parameters": {"e": 9}}  # too far apart for its links
    words = ("evaluate", SHIPPED["four_bar"], "--state", "-", "--project")
    said = call(*words, stdin=json.dumps(state))
    assert (said.code, said.output) == (1, "")
    assert "state 1: the state cannot be projected: Newton's method does not" in said.errors


def test_project_needs_constraints(call):
    said = call("evaluate", SHIPPED["simple_pendulum"], "--project")
    assert (said.code, said.output) == (2, "")
    assert "--project: the spec has no constraints to project a state on" in said.errors


@pytest.mark.parametrize("using", ["interpreter", "c", "python"])
def test_a_singular_position_ends_with_1(call, using):
    """The parallelogram folded flat: its rows depend there."""
    flat = {"coordinates": dict.fromkeys(("q1", "q2", "q3"), 0)}
    state = flat | {"rates": dict.fromkeys(("q1", "q2", "q3"), 0)}
    words = ("evaluate", SHIPPED["parallelogram"], "--state", "-", "--using", using)
    said = call(*words, stdin=json.dumps(state))
    assert (said.code, said.output) == (1, "")
    assert said.errors.startswith("<stdin>: error: state 1: ")
    assert "singular" in said.errors


def test_the_time_is_needed_where_a_constraint_moves(call):
    words = ("evaluate", SHIPPED["bead_on_turning_hoop"], "--state", "-")
    said = call(*words, stdin="{}")
    assert (said.code, said.output) == (2, "")
    assert "t is missing, and the equations depend on the time" in said.errors
    assert call(*words, stdin='{"t": 0}').code == 0


def test_a_refused_scene_ends_the_real_program_with_2():
    code, said, complained = finished("check", "-", text=WRONG["contradictory"][0])
    assert (code, said) == (2, "")
    assert complained.startswith("<stdin>: error: no admissible state was found: ")


def test_every_linked_spec_is_listed(call):
    listed = call("examples").output
    assert all(f"\n{name} " in f"\n{listed}" for name in LINKED)


@pytest.mark.slow
def test_states_in_another_assembly_mode_are_no_difference(call):
    """The states that are compared depend on the file's name; some of them have another mode."""
    for name in ("scene", "linkage", "a"):
        Path(f"{name}.yaml").write_text(text_of("andrews_squeezer"), encoding="utf-8")
        said = call("check", f"{name}.yaml")
        assert (said.code, said.errors) == (0, "")
