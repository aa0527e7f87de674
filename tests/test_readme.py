"""What the README shows is what the tool prints."""

import re
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner
from scenes import SHIPPED
from tools import tool

from eomgen.cli import commands
from eomgen.functions.table import ROWS, ROWS_AT, STANDARD

README = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
SPEC = re.search(r"```yaml\n(eom: 1.*?)```", README, re.DOTALL)[1]


def run(command, text, name, folder, monkeypatch):
    monkeypatch.chdir(folder)
    Path(name).write_text(text, encoding="utf-8")
    return CliRunner().invoke(commands, [command, name])


def test_derivation_is_the_one_shown(tmp_path, monkeypatch):
    result = run("derive", SPEC, "my_pendulum.yaml", tmp_path, monkeypatch)
    assert result.exit_code == 0
    assert f"```\n{result.stdout.rstrip()}\n```" in README


def test_errors_are_those_shown(tmp_path, monkeypatch):
    text = SPEC.replace("stiffness: k", "stifness: k").replace("sin(phi)", "sin(ph)")
    result = run("check", text, "bad.yaml", tmp_path, monkeypatch)
    assert result.exit_code == 2
    assert f"```\n{result.stderr.rstrip()}\n```" in README


def test_the_state_shown_is_one_of_the_file_that_is_started(tmp_path, monkeypatch):
    state = re.search(r"```json\n(.*?)```", README, re.DOTALL)[1]
    monkeypatch.chdir(tmp_path)
    Path("state.json").write_text(state, encoding="utf-8")
    for words in ("new my_pendulum", "evaluate my_pendulum.yaml --state state.json --digits 50"):
        result = CliRunner().invoke(commands, words.split())
        assert result.exit_code == 0, result.stderr


def test_base_parameters_are_those_shown():
    result = CliRunner().invoke(commands, ["regressor", str(SHIPPED["two_link_arm"])])
    assert f"```\n{result.stdout.rstrip()}\n```" in README


def test_every_function_is_in_the_table():
    names = [STANDARD, *ROWS, *(f"{name}:POINT" for name in ROWS_AT)]
    (section,) = re.findall(r"^## Functions$.*?^## ", README, re.MULTILINE | re.DOTALL)
    listed = [
        n
        for row in re.findall(r"^\| (`.*?) \|", section, re.MULTILINE)
        for n in re.findall("`([^`]+)`", row)
    ]
    assert listed == names


EXAMPLES = [
    line.split()[1:]
    for command in commands.commands.values()
    for line in (command.epilog or "").splitlines()
    if any(f"{name}.yaml" in line for name in SHIPPED)
]


@pytest.mark.slow
@pytest.mark.parametrize("words", EXAMPLES, ids=" ".join)
def test_examples_in_the_help_run_with_what_ships(words, call, tmp_path):
    tool("cc")
    pytest.importorskip("scipy")
    for word in words:
        if word.removesuffix(".yaml") in SHIPPED:
            shutil.copy(SHIPPED[word.removesuffix(".yaml")], tmp_path)
    said = call(*words)
    assert said.code == 0, said.errors


def test_there_are_two_commands_that_set_up():
    commands = re.findall(r"^python3 -m venv .*$", README, re.MULTILINE)
    assert len(commands) == 2
    assert commands[0].endswith("eomgen generate specs/slider_pendulum.yaml -o out")
    assert commands[1].endswith("pytest -n auto")
