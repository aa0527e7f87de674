"""`--functions` of generate and evaluate, and the command `regressor`, as a user calls them."""

import json

import pytest
from scenes import SHIPPED, model_of

from eomgen.functions import table
from eomgen.outputs import Wish, rendered
from eomgen.study import of_text
from eomgen.wanted import Wanted

ARM, LINKS, BAR = (SHIPPED[n] for n in ("skew_arm", "two_link_arm", "four_bar"))
MOVING = {"accelerations": {"q_1": 0.5, "q_2": "-1"}, "inputs": {"tau_1": 0, "tau_2": 0}}


def test_generate_writes_what_is_asked_for_and_nothing_else(call, tmp_path):
    asked = ("--functions", "state_jacobian, energy", "--functions", "velocity_of:fore")
    said = call("generate", ARM, "-t", "c", "-t", "python", "-o", "out", *asked)
    assert said.code == 0, said.errors
    header = (tmp_path / "out" / "skew_arm.h").read_text()
    module = (tmp_path / "out" / "skew_arm.py").read_text()
    for name in ("state_jacobian", "energy", "velocity_of_fore"):
        assert f"skew_arm_{name}(" in header
        assert f"def {name}(" in module
    assert "skew_arm_mass_matrix(" not in header
    assert "def mass_matrix(" not in module


@pytest.mark.parametrize("name", ["skew_arm", "satellite", "quarter_car"])
def test_only_what_is_asked_for_is_assembled_and_it_is_the_same(name):
    text = SHIPPED[name].read_text()
    asked = ("accelerations", "energy")
    whole, alone = of_text(text, name), of_text(text, name, Wanted(functions=asked))
    assert [f.name for f in alone.program.functions] == list(asked)
    made = rendered(whole, Wish(("c",), functions=asked))
    assert rendered(alone, Wish(("c",), functions=asked)) == made
    beside = of_text(text, name, Wanted(functions=("energy", "inverse_dynamics")))
    assert beside.program == whole.program


def test_generate_lists_what_can_be_asked_for_without_a_spec(call):
    said = call("generate", "--list-functions")
    assert said.code == 0
    assert said.output == f"{table.listing()}\n"


@pytest.mark.parametrize("using", ["interpreter", "c", "python"])
def test_evaluate_shows_matrices_row_by_row(call, using):
    asked = ("--functions", "inverse_dynamics,state_jacobian,position_of:upper")
    words = ("evaluate", ARM, "--state", "-", "--using", using, *asked)
    said = call(*words, stdin=json.dumps(MOVING))
    assert said.code == 0, said.errors
    (result,) = json.loads(said.output)
    assert list(result) == ["inverse_dynamics", "state_jacobian", "position_of_upper"]
    assert [len(row) for row in result["state_jacobian"]] == [4, 4, 4, 4]
    assert result["state_jacobian"][0] == [0, 0, 1, 0]
    assert result["inverse_dynamics"] == pytest.approx([0.0, 0.0], abs=100)


def test_evaluate_gives_as_many_digits_as_are_asked_for(call):
    words = ("evaluate", ARM, "--state", "-", "--functions", "inverse_dynamics", "--digits", "40")
    (result,) = json.loads(call(*words, stdin=json.dumps(MOVING)).output)
    assert all(isinstance(v, str) and len(v.strip("-0.")) >= 38 for v in result["inverse_dynamics"])


def test_evaluate_moves_a_state_of_a_linked_scene_where_asked(call):
    words = ("evaluate", BAR, "--state", "-", "--functions", "jacobian_of:C")
    still = {"inputs": {"tau": 0}}
    assert call(*words, stdin=json.dumps(still)).code == 0
    (first, *_) = model_of("four_bar").coordinates
    off = json.dumps({**still, "coordinates": {first.name: 1.1}})
    assert "off the constraints" in call(*words, stdin=off).errors
    assert call(*words, "--project", stdin=off).code == 0


MISTAKES = (
    (("generate", ARM, "--functions", "bla"), {}, "unknown function 'bla'; there are standard"),
    (("generate", ARM, "--functions", ""), {}, "unknown function ''"),
    (("generate", ARM, "--functions", "energy,"), {}, "unknown function ''"),
    (("generate", ARM, "-t", "latex", "--functions", "energy"), {}, "only C and Python have"),
    (("evaluate", ARM, "--functions", "position_of:t"), MOVING, "no point or body 't'"),
    (("evaluate", ARM, "--functions", "regressor"), {"inputs": MOVING["inputs"]},
     'regressor needs "accelerations" in the state'),
    (("evaluate", ARM, "--functions", "energy"), MOVING, "no function here takes them"),
    (("evaluate", ARM), MOVING, "no function here takes them"),
    (("evaluate", ARM, "--joints", "--functions", "energy"), {}, "--functions replaces them"),
    (("evaluate", ARM, "--functions", "regressor"),
     {**MOVING, "accelerations": {"q_1": 1}}, "accelerations: q_2 is missing"),
    (("evaluate", ARM, "--functions", "regressor"),
     {**MOVING, "accelerations": {"q_1": 1, "q_2": "x", "q_3": 0}}, "unknown name 'q_3'"),
    (("evaluate", ARM, "--functions", "regressor"),
     {**MOVING, "accelerations": [1, 2]}, "accelerations is not an object"),
    (("regressor", BAR), {}, "use --formulation minimal or nullspace"),
    (("evaluate", BAR, "--functions", "base_regressor"), {"inputs": {"tau": 0}},
     "with `generate` or `regressor`"),
    (("regressor", "no_such.yaml"), {}, "no_such.yaml"),
)  # fmt: skip


@pytest.mark.parametrize(("words", "state", "complaint"), MISTAKES)
def test_a_mistake_is_one_line_and_exit_code_2(call, words, state, complaint):
    given = ("--state", "-") if words[0] == "evaluate" else ()
    said = call(*words, *given, stdin=json.dumps(state))
    assert said.code == 2
    assert complaint in said.errors
    assert "Traceback" not in said.errors
    assert not said.output


def test_the_regressor_of_an_arm_in_words(call):
    said = call("regressor", LINKS)
    assert said.code == 0, said.errors
    assert said.output.splitlines()[:3] == [
        "Inertial parameters: 8",
        "Base parameters: 6 (rank in 50 digits at 11 random states)",
        "   1  mc_x(upper) + l1 m(fore) = 1.34 kg m",
    ]
    assert "Without effect: m(upper)" in said.output
    assert "checked: Y theta + rest = M u' + h - Q there, relative error below 1e-" in said.output


def test_the_regressor_of_an_arm_as_json(call):
    found = json.loads(call("regressor", LINKS, "--format", "json").output)
    assert [p["name"] for p in found["inertial_parameters"]][:2] == ["m(upper)", "mc_x(upper)"]
    assert found["base_parameters"][0] == {
        "name": "mc_x(upper) + l1 m(fore)",
        "column": "mc_x(upper)",
        "value": pytest.approx(1.34, rel=1e-15),
        "terms": [{"parameter": "m(fore)", "coefficient": "l1", "value": 0.4, "general": True}],
    }
    assert found["without_effect"] == ["m(upper)"]


def test_the_regressor_of_a_linked_scene(call):
    said = call("regressor", BAR, "--formulation", "nullspace")
    assert said.code == 0, said.errors
    assert "Base parameters: 3" in said.output
