"""`eomgen statics` as its user meets it: targets, files, languages, what it refuses."""

import json

import pytest
from scenes import SHIPPED

PENDULUM = SHIPPED["simple_pendulum"]


def test_text_is_printed(call):
    said = call("statics", PENDULUM)
    assert (said.code, said.errors) == (0, "")
    assert said.output.startswith("Simple pendulum: Statics\n")
    assert said.output.count("\n  −m g l sin φ = 0\n") == 1


def test_spanish_and_latex_on_standard_output(call):
    said = call("statics", PENDULUM, "-t", "latex", "--lang", "es", "-o", "-")
    assert said.code == 0
    assert r"\section*{Ecuaciones de equilibrio}" in said.output
    assert r"\Large Péndulo simple: Estática" in said.output


@pytest.mark.parametrize(("target", "suffix"), [("text", "txt"), ("latex", "tex")])
def test_a_file_is_written_and_written_again(call, tmp_path, target, suffix):
    for language, words in (("en", "Virtual work"), ("es", "Trabajo virtual")):
        said = call("statics", PENDULUM, "-t", target, "-o", "out", "--lang", language)
        assert said.code == 0
        assert said.output.split() == [f"out/simple_pendulum_statics.{suffix}"]
        file = tmp_path / "out" / f"simple_pendulum_statics.{suffix}"
        assert words in file.read_text(encoding="utf-8")


def test_a_foreign_file_is_kept_unless_forced(call, tmp_path):
    file = tmp_path / "simple_pendulum_statics.txt"
    file.write_text("mine", encoding="utf-8")
    said = call("statics", PENDULUM, "-o", ".")
    assert said.code == 2
    assert "not made by eomgen" in said.errors
    assert file.read_text(encoding="utf-8") == "mine"
    assert call("statics", PENDULUM, "-o", ".", "--force").code == 0
    assert file.read_text(encoding="utf-8").startswith("Simple pendulum")


def test_json_is_printed(call):
    said = call("statics", PENDULUM, "--format", "json")
    found = json.loads(said.output)
    assert [e["stability"] for e in found["equilibria"]["equilibria"]] == ["stable", "unstable"]
    assert list(found["statics"]["equations"]) == ["phi"]


def test_a_target_goes_before_json(call):
    said = call("statics", PENDULUM, "--format", "json", "-t", "latex")
    assert said.output.startswith("% eomgen, spec ")


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--format", "json", "-o", "out"), "--target text or latex"),
        (("--input", "tau=1"), "the names are: none"),
        (("--parameter", "l"), "write NAME=VALUE"),
        (("--parameter", "l=long"), "not a finite decimal number"),
        (("--time", "soon"), "not a finite decimal number"),
        (("-t", "c"), "Invalid value for '-t'"),
        (("--lang", "fr"), "Invalid value for '--lang'"),
        (("--templates", "nowhere"), "no such folder of templates"),
    ],
)
def test_wrong_words_are_refused(call, tmp_path, words, complaint):
    said = call("statics", PENDULUM, *words)
    assert said.code == 2
    assert complaint in said.errors
    assert said.output == ""
    assert not [*tmp_path.iterdir()]


def test_a_wrong_spec_is_refused(call):
    said = call("statics", "-", stdin=PENDULUM.read_text().replace("gravity:", "gravty:"))
    assert said.code == 2
    assert "did you mean 'gravity'" in said.errors


def test_a_template_of_the_user_wins(call, tmp_path):
    file = tmp_path / "mine" / "text" / "statics.txt.j2"
    file.parent.mkdir(parents=True)
    file.write_text("{{ title }}: {{ tables | length }}\n", encoding="utf-8")
    assert call("statics", PENDULUM, "--templates", "mine").output == "Simple pendulum: 1\n"
    file.write_text("{{ nothing }}\n", encoding="utf-8")
    said = call("statics", PENDULUM, "--templates", "mine")
    assert said.code == 2
    assert "statics.txt.j2:1: 'nothing' is undefined" in said.errors
