"""`eomgen import` as a user calls it."""

import json

import pytest
from bad_urdfs import BASE, changed
from robots import FOLDER

PENDULUM = FOLDER / "double_pendulum.urdf"


def test_without_an_output_the_spec_is_printed_and_the_notes_apart(call):
    said = call("import", PENDULUM)
    assert said.code == 0
    assert said.output.startswith(
        "# yaml-language-server: $schema=./eomgen.schema.json\n# Imported"
    )
    place, _, text = said.errors.splitlines()[0].partition(": note: ")
    assert place.startswith(f"{PENDULUM}:")
    assert text.endswith("is ignored (2 times)")


def test_an_imported_robot_is_checked_and_generated(call):
    made = call("import", "-", "-o", "arm.yaml", stdin=BASE)
    assert made.output.split() == ["arm.yaml", "eomgen.schema.json"]
    said = call("check", "arm.yaml")
    assert "1 degree of freedom; engine: articulated bodies" in said.output
    assert "; checked: Lagrange = Newton-Euler" in said.output
    assert call("generate", "arm.yaml", "-t", "c", "-o", "out").code == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "freedom"), [("scara", 4), ("arm_7r", 7), ("quadruped", 12), ("satellite", 8)]
)
def test_an_imported_robot_is_derived_twice(call, name, freedom):
    call("import", FOLDER / f"{name}.urdf", "-o", "robot.yaml")
    said = call("check", "robot.yaml").output
    assert f"{freedom} degrees of freedom" in said
    assert "checked: " in said


def test_standard_input_is_read_and_standard_output_is_a_spec(call):
    made = call("import", "-", stdin=BASE)
    assert "# Imported from <stdin>." in made.output
    assert call("check", "-", stdin=made.output).code == 0


def test_nothing_is_overwritten_unless_forced(call, tmp_path):
    place = tmp_path / "arm.yaml"
    place.write_text("mine", encoding="utf-8")
    said = call("import", PENDULUM, "-o", "arm.yaml")
    assert said.code == 2
    assert "arm.yaml exists already and is left as it is" in said.errors
    assert place.read_text(encoding="utf-8") == "mine"
    assert call("import", PENDULUM, "-o", "arm.yaml", "--force").code == 0
    assert place.read_text(encoding="utf-8").startswith("# yaml")


def test_a_schema_that_is_there_stays(call, tmp_path):
    schema = tmp_path / "eomgen.schema.json"
    schema.write_text("{}", encoding="utf-8")
    assert call("import", PENDULUM, "-o", "arm.yaml").output == "arm.yaml\n"
    assert schema.read_text(encoding="utf-8") == "{}"


def test_faults_look_as_asked(call):
    bad = changed("0 1 0", "0 0 0")
    said = call("import", "-", stdin=bad)
    assert said.code == 2
    assert said.errors.splitlines()[0] == ("<stdin>:15:16: error E712: an axis must not be zero")
    (fault,) = json.loads(call("import", "-", "--format", "json", stdin=bad).errors)
    assert (fault["line"], fault["column"], fault["code"]) == (15, 16, "E712")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("nowhere.urdf",), "cannot be read"),
        ((PENDULUM, "--round-angles", "--within", "much"), "'much' is not a decimal number"),
        ((PENDULUM, "--round-angles", "--within", "1"), "give 0 to 0.01 [rad]"),
        ((PENDULUM, "--round-angles", "--within", "-1e-9"), "give 0 to 0.01 [rad]"),
        ((PENDULUM, "--within", "1e-9"), "--within goes with --round-angles"),
        ((PENDULUM, "-o", "file/arm.yaml"), "choose another folder"),
    ],
)
def test_wrong_words_are_refused_in_one_line(call, tmp_path, words, said):
    (tmp_path / "file").touch()
    answer = call("import", *words)
    assert answer.code == 2
    assert said in answer.errors
    assert "Traceback" not in answer.errors


TURNED = changed('<origin xyz="0 0 1"/>', '<origin rpy="1.5708 0 0"/>')


@pytest.mark.parametrize(
    ("options", "made"),
    [
        ((), "[x, 1.5708]"),
        (("--round-angles",), "[x, 1.5708]"),
        (("--round-angles", "--within", "1e-5"), "[x, pi/2]"),
        (("--floating-base",), "{quaternion: e_base}"),
        (("--floating-base", "--euler-angles"), "[[z, yaw_base], [y, pitch_base], [x, roll_base]]"),
    ],
)
def test_options_change_the_robot(call, options, made):
    assert made in call("import", "-", *options, stdin=TURNED).output
