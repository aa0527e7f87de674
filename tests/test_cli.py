"""The command line as its user meets it: what it prints, refuses and answers."""

import json
import re
import subprocess
import sys
from pathlib import Path

import click
import mpmath
import pytest
from commandline import eomgen, run, start
from scenes import SHIPPED
from studies import PENDULUM

from eomgen import __version__, study
from eomgen.cli import commands

COMMANDS = [
    "chart", "check", "derive", "evaluate", "examples", "generate", "import", "new", "regressor",
    "schema", "simulate", "stability", "statics", "templates",
]  # fmt: skip
EQUATION = "m l² φ″ + d φ′ + m l g sin φ = τ"
STATE = {"coordinates": {"phi": "0.1"}, "rates": {"phi": 2}, "inputs": {"tau": 0.5}}
FALSE = PENDULUM + "expect: {equations: m*l*phi'' + m*g*sin(phi) = 0}\n"
WRONG = PENDULUM.replace("gravity:", "gravty:").replace("2 kg", "2 kq")


# what every command shares


def test_the_commands_are_these():
    assert sorted(commands.commands) == COMMANDS


@pytest.mark.parametrize("flag", ["-h", "--help"])
@pytest.mark.parametrize("command", [None, *COMMANDS])
def test_help_explains_every_option_and_gives_examples(call, command, flag):
    words = (flag,) if command is None else (command, flag)
    said = call(*words)
    assert (said.code, said.errors) == (0, "")
    assert "  Examples:\n    eomgen " in said.output
    options = (commands if command is None else commands.commands[command]).params
    for option in (o for o in options if isinstance(o, click.Option)):
        assert all(name in said.output for name in option.opts)
    if command is None:
        assert all(f"\n  {name} " in said.output for name in COMMANDS)
        assert "Exit codes: 0 done, 1 a check failed, 2 wrong input." in said.output


@pytest.mark.parametrize("command", [None, *COMMANDS])
def test_the_examples_of_the_help_are_command_lines(command):
    epilog = (commands if command is None else commands.commands[command]).epilog
    examples = re.findall(r"^  eomgen (\w+) ?([^<>|\n]*)", epilog, re.MULTILINE)
    assert examples
    for name, words in examples:
        commands.commands[name].make_context(name, words.split())


def test_version(call):
    assert call("--version").output == f"eomgen, version {__version__}\n"


HELP = """
import sys
from eomgen.cli import commands, main
for words in [["--version"], ["-h"], *([name, "-h"] for name in commands.commands)]:
    sys.argv = ["eomgen", *words]
    try:
        main()
    except SystemExit as end:
        assert end.code == 0
heavy = {"sympy", "mpmath", "numpy", "scipy", "jinja2", "yaml"}
print("imported:", sorted(heavy & sys.modules.keys()))
"""


def test_help_imports_nothing_heavy():
    assert run(sys.executable, "-c", HELP).splitlines()[-1] == "imported: []"


SMALL = """
import sys
from eomgen.cli import main
sys.argv = ["eomgen", "generate", sys.argv[1], "-t", "c", "-t", "latex", "-o", sys.argv[2]]
try:
    main()
except SystemExit as end:
    assert end.code == 0
print("imported:", sorted({"numpy", "scipy"} & sys.modules.keys()))
"""


def test_a_small_scene_is_derived_and_checked_without_numpy(tmp_path):
    scene = SHIPPED["double_pendulum"]
    said = run(sys.executable, "-c", SMALL, str(scene), str(tmp_path))
    assert said.splitlines()[-1] == "imported: []"


USAGE = {
    (): "Usage: eomgen",
    ("derife", "a.yaml"): "No such command 'derife'",
    ("derive",): "Missing argument 'SPEC'",
    ("check",): "Missing argument 'SPECS...'",
    ("generate", "a.yaml", "--ouput", "x"): "Did you mean one of: '--input', '--output'?",
    ("generate", "a.yaml", "-t", "fortran"): "not one of 'latex', 'c', 'python', 'text'",
    ("derive", "a.yaml", "--lang", "fr"): "not one of 'en', 'es'",
    ("check", "a.yaml", "--format", "xml"): "not one of 'text', 'json', 'github'",
    ("evaluate", "a.yaml", "--using", "fortran"): "not one of 'interpreter', 'c', 'python'",
    ("evaluate", "a.yaml", "--digits", "0"): "0 is not in the range 1<=x<=10000",
    ("evaluate", "a.yaml", "--digits", "many"): "'many' is not a valid integer",
    ("examples", "steal"): "not one of 'list', 'copy'",
    ("examples", "list", "gyroscope"): "list takes no names: gyroscope",
    ("templates", "list", "c/model.c.j2"): "list takes no names: c/model.c.j2",
    ("new",): "Missing argument 'NAME'",
}


@pytest.mark.parametrize("words", USAGE, ids=" ".join)
def test_a_wrong_call_is_explained(call, words):
    said = call(*words)
    assert (said.code, said.output) == (2, "")
    assert USAGE[words] in said.errors


COMMANDS_ON_A_SPEC = ["derive", "generate", "check", "evaluate"]


@pytest.mark.parametrize("command", COMMANDS_ON_A_SPEC)
def test_what_is_no_spec_is_refused(call, command, tmp_path):
    Path("binary.yaml").write_bytes(b"\x7fELF\x00\xff\xfe")
    Path("empty.yaml").write_text("")
    for spec, reason in (
        ("missing.yaml", "missing.yaml: error: cannot be read: No such file or directory; give"),
        (str(tmp_path), "error: cannot be read: Is a directory; give a file, or -"),
        ("binary.yaml", "binary.yaml:1:6: error E101: the file is not UTF-8 text"),
        ("empty.yaml", "empty.yaml:1:1: error E"),
    ):
        said = call(command, spec)
        assert (said.code, said.output) == (2, "")
        assert reason in said.errors
    assert sorted(p.name for p in tmp_path.iterdir()) == ["binary.yaml", "empty.yaml"]


@pytest.mark.parametrize("command", COMMANDS_ON_A_SPEC)
def test_all_mistakes_of_a_spec_have_their_places(call, command):
    Path("a.yaml").write_text(WRONG)
    said = call(command, "a.yaml")
    assert (said.code, said.output) == (2, "")
    assert "a.yaml:4:1: error E104: unknown key 'gravty'; did you mean 'gravity'?\n" in said.errors
    assert "    gravty: [0, -g]\n    ^\n" in said.errors
    assert "a.yaml:5:19: error E4" in said.errors


@pytest.mark.parametrize("command", COMMANDS_ON_A_SPEC)
def test_mistakes_as_json(call, command):
    Path("a.yaml").write_text(WRONG)
    said = call(command, "a.yaml", "--format", "json")
    # the answer of `check` is the list of faults, so it is on standard output
    answer, other = (said.output, said.errors) if command == "check" else (said.errors, said.output)
    faults = json.loads(answer)
    assert (said.code, other) == (2, "")
    assert [(f["file"], f["line"], f["column"]) for f in faults] == [
        ("a.yaml", 4, 1),
        ("a.yaml", 5, 19),
    ]
    assert faults[0]["code"] == "E104"
    assert faults[0]["hint"] == "did you mean 'gravity'?"


@pytest.mark.parametrize("command", COMMANDS_ON_A_SPEC)
def test_mistakes_as_annotations(call, command):
    Path("a.yaml").write_text(WRONG)
    first, second = call(command, "a.yaml", "--format", "github").errors.splitlines()
    assert first.startswith("::error file=a.yaml,line=4,col=1,title=E104::unknown key 'gravty'")
    assert second.startswith("::error file=a.yaml,line=5,col=19,title=E4")


@pytest.mark.parametrize("command", COMMANDS_ON_A_SPEC)
def test_a_spec_from_standard_input_is_named_so(call, command):
    said = call(command, "-", stdin=WRONG)
    assert said.code == 2
    assert "<stdin>:4:1: error E104" in said.errors


@pytest.mark.parametrize("command", COMMANDS_ON_A_SPEC)
def test_a_false_claim_ends_with_1_and_writes_nothing(call, command, tmp_path):
    said = call(command, "-", stdin=FALSE)
    assert (said.code, said.output) == (1, "")
    assert said.errors.startswith("<stdin>: error: expect: the equation `m*l*phi''")
    assert not list(tmp_path.iterdir())
    said = call(command, "-", "--format", "json", stdin=FALSE)
    (mistake,) = json.loads(said.output if command == "check" else said.errors)
    assert mistake["file"] == "<stdin>"
    assert mistake["message"].startswith("expect: the equation")
    said = call(command, "-", "--format", "github", stdin=FALSE)
    assert said.errors.startswith("::error file=<stdin>::expect: the equation")


def test_a_defect_of_ours_shows_its_traceback(call, monkeypatch):
    def broken(text, file, wanted):
        raise RuntimeError("our own mistake")

    monkeypatch.setattr(study, "of_text", broken)
    with pytest.raises(RuntimeError, match="our own mistake"):
        call("derive", "-", stdin=PENDULUM)


# derive


def test_derive_prints_the_equations_and_how_it_knows(call):
    Path("a.yaml").write_text(PENDULUM)
    said = call("derive", "a.yaml")
    assert (said.code, said.errors) == (0, "")
    assert said.output.startswith("Pendulum\n")
    assert EQUATION in said.output
    assert said.output.splitlines()[-1].startswith("checked: Lagrange = Newton-Euler")
    assert call("derive", "-", stdin=PENDULUM).output == said.output


def test_steps_are_shown_where_asked(call):
    plain = call("derive", "-", stdin=PENDULUM).output
    steps = call("derive", "-", "--steps", stdin=PENDULUM).output
    assert "∂L/∂φ′" in steps
    assert "∂L/∂φ′" not in plain
    assert set(plain.splitlines()) <= set(steps.splitlines())


def test_derive_in_spanish(call):
    said = call("derive", str(SHIPPED["slider_pendulum"]), "--lang", "es")
    assert said.output.startswith("Masa deslizante con péndulo\n")
    assert "Energía cinética" in said.output
    assert said.output.splitlines()[-1].startswith("comprobado: Lagrange = Newton-Euler")


# check


def test_check_goes_on_after_a_bad_spec_and_answers_the_worst(call):
    for name, text in (("good", PENDULUM), ("wrong", WRONG), ("false", FALSE)):
        Path(f"{name}.yaml").write_text(text)
    said = call("check", "wrong.yaml", "false.yaml", "missing.yaml", "good.yaml")
    assert said.code == 2
    (line,) = said.output.splitlines()
    assert line.startswith("good.yaml: 1 degree of freedom; engine: tensions of rods, ")
    assert "; checked: Lagrange = Newton-Euler" in line
    assert "dimensions of" in line
    for name in ("wrong.yaml:4:1:", "false.yaml: error: expect", "missing.yaml: error: cannot"):
        assert name in said.errors
    assert call("check", "wrong.yaml", "false.yaml").code == 2
    assert call("check", "false.yaml", "good.yaml").code == 1
    assert call("check", "good.yaml", "good.yaml").code == 0
    assert call("check", "-", stdin=PENDULUM).output.startswith("<stdin>: 1 degree")


def test_check_for_machines(call):
    Path("a.yaml").write_text(PENDULUM)
    found = json.loads(call("check", "a.yaml", "--format", "json").output)
    assert found["file"] == "a.yaml"
    assert found["degrees_of_freedom"] == 1
    assert found["proven"] is True
    assert 0 <= found["relative_error"] < 1e-12
    said = call("check", "a.yaml", "--format", "github")
    assert said.output.startswith("::notice file=a.yaml::checked: ")


# evaluate


def values(call, *words, state=STATE, spec="a.yaml"):
    """The results at one state of the pendulum."""
    Path("a.yaml").write_text(PENDULUM)
    said = call("evaluate", spec, "--state", "-", *words, stdin=json.dumps(state))
    assert (said.code, said.errors) == (0, "")
    (found,) = json.loads(said.output)
    return found


def test_evaluate_by_every_engine(call):
    expected = (0.5 - 0.1 * 2 - 2 * 9.81 * 0.5 * 0.09983341664682815) / (2 * 0.5**2)
    for using in ("interpreter", "c", "python"):
        found = values(call, "--using", using)
        assert found["accelerations"] == {"phi": pytest.approx(expected, rel=1e-14)}
        assert found["energy"]["kinetic"] == pytest.approx(1.0, rel=1e-14)
        assert list(found) == ["accelerations", "energy", "generalized_forces", "outputs"]


def test_evaluate_in_50_digits(call):
    found = values(call, "--digits", "50")
    with mpmath.workdps(60):
        expected = (mpmath.mpf("0.3") - mpmath.mpf("9.81") * mpmath.sin(mpmath.mpf("0.1"))) * 2
        assert found["accelerations"]["phi"] == mpmath.nstr(expected, 50)


def test_fewer_digits_are_rounded(call):
    assert values(call, "--digits", "3")["accelerations"] == {"phi": -1.36}


def test_a_list_of_states_has_a_list_of_results(call):
    Path("a.yaml").write_text(PENDULUM)
    Path("states.json").write_text(json.dumps([STATE, STATE | {"inputs": {"tau": 1}}]))
    first, second = json.loads(call("evaluate", "a.yaml", "--state", "states.json").output)
    assert second["accelerations"]["phi"] == pytest.approx(first["accelerations"]["phi"] + 1)
    said = call("evaluate", "-", "--state", "states.json", stdin=PENDULUM)
    assert json.loads(said.output) == [first, second]


def test_the_initial_state_is_the_state_where_none_is_given(call):
    (found,) = json.loads(call("evaluate", str(SHIPPED["simple_pendulum"])).output)
    assert found["accelerations"]["phi"] == pytest.approx(-9.81 * 0.75**0.5)


STATES = {
    "{": "states.json: error: the state file is not JSON: Expecting",
    "\xff": "states.json: error: not UTF-8 text (byte 0)",
    "7": 'states.json: error: state 1: is not an object such as {"coordinates"',
    '{"speed": 1}': "state 1: key: unknown name 'speed'; did you mean 'speeds'?",
    "{}": "state 1: inputs: tau is missing, and the spec has no value for it",
    '{"t": NaN}': "state 1: t: 'NaN' is not a finite decimal number",
    '{"coordinates": {"phi": "2**9**9"}}': "'2**9**9' is not a finite decimal number",
}


@pytest.mark.parametrize("text", STATES)
def test_a_wrong_state_file_is_refused(call, text):
    Path("a.yaml").write_text(PENDULUM)
    Path("states.json").write_bytes(text.encode("latin-1"))
    said = call("evaluate", "a.yaml", "--state", "states.json")
    assert (said.code, said.output) == (2, "")
    assert STATES[text] in said.errors
    assert all(line.startswith("states.json: error: ") for line in said.errors.splitlines())
    said = call("evaluate", "a.yaml", "--state", "states.json", "--format", "json")
    assert {mistake["file"] for mistake in json.loads(said.errors)} == {"states.json"}


def test_a_state_file_that_is_not_there(call):
    Path("a.yaml").write_text(PENDULUM)
    said = call("evaluate", "a.yaml", "--state", "nowhere.json")
    assert (said.code, said.output) == (2, "")
    assert said.errors.startswith("nowhere.json: error: cannot be read: No such file or directory")


def test_spec_and_state_cannot_share_standard_input(call):
    said = call("evaluate", "-", "--state", "-", stdin=PENDULUM)
    assert (said.code, said.output) == (2, "")
    assert "the spec and the state cannot both come from standard input" in said.errors


@pytest.mark.parametrize("using", ["interpreter", "c", "python"])
def test_a_singular_mass_matrix_ends_with_1(call, using):
    Path("a.yaml").write_text(PENDULUM)
    state = json.dumps(STATE | {"parameters": {"m": 0}})
    said = call("evaluate", "a.yaml", "--state", "-", "--using", using, stdin=state)
    assert (said.code, said.output) == (1, "")
    assert said.errors.startswith("<stdin>: error: state 1: ")
    assert "the mass matrix is singular" in said.errors


def test_an_engine_in_double_has_no_50_digits(call):
    Path("a.yaml").write_text(PENDULUM)
    words = ("evaluate", "a.yaml", "--state", "-", "--digits", "50", "--using", "c")
    said = call(*words, stdin=json.dumps(STATE))
    assert (said.code, said.output) == (2, "")
    assert "use the interpreter" in said.errors


def test_a_compiler_that_is_missing_is_named(call, monkeypatch):
    monkeypatch.setenv("CC", "no_such_compiler")
    Path("a.yaml").write_text(PENDULUM)
    words = ("evaluate", "a.yaml", "--state", "-", "--using", "c")
    said = call(*words, stdin=json.dumps(STATE))
    assert (said.code, said.output) == (2, "")
    assert "the C compiler 'no_such_compiler' does not start" in said.errors


# as processes


def finished(*words, text="", **environment):
    """Exit code, output and errors of the real program."""
    running = start(*eomgen(*words), standard_input=subprocess.PIPE, **environment)
    said, complained = running.communicate(text, timeout=60)
    return running.returncode, said, complained


def test_exit_codes_reach_the_shell():
    for text, code in ((PENDULUM, 0), (FALSE, 1), (WRONG, 2)):
        assert finished("check", "-", text=text)[0] == code
    code, said, complained = finished("new", "a.b")
    assert (code, said) == (2, "")
    assert complained == "eomgen: 'a.b' is not a name; use letters, digits and _, no suffix\n"


def through_a_shell(line, text=""):
    """Exit code and errors of a line for the shell in which `$@` is our program."""
    words = ("sh", "-c", line, "sh", *eomgen())
    running = start(*words, standard_input=subprocess.PIPE)
    complained = running.communicate(text, timeout=60)[1]
    return running.returncode, complained


def test_closed_standard_input_is_named():
    said = through_a_shell('"$@" check - <&-')
    assert said == (2, "<stdin>: error: standard input is closed; give a file\n")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device that is full is of Linux")
@pytest.mark.parametrize("words", ["derive -", "schema", "generate - -t c -o -"])
def test_a_full_disk_is_named(words):
    said = through_a_shell(f'"$@" {words} >/dev/full', PENDULUM)
    assert said == (2, "eomgen: cannot be written: No space left on device; make room\n")


def test_a_terminal_without_unicode_is_no_accident():
    code, said, complained = finished("derive", "-", text=PENDULUM, PYTHONIOENCODING="ascii")
    assert (code, complained) == (0, "")
    assert said


def test_a_formalism_is_chosen_and_all_are_compared(call):
    said = call("derive", SHIPPED["slider_pendulum_free"], "--method", "newton")
    assert said.code == 0
    assert "(2)  0 = N_slider − S_bob cos φ − m_A g" in said.output
    assert "checked: Newton = d'Alembert = Lagrange = Lagrange of the first kind" in said.output


def test_a_formalism_that_a_scene_has_not_is_wrong_input(call):
    said = call("generate", SHIPPED["central_force"], "--method", "newton")
    assert said.code == 2
    assert "--method newton does not apply: the scene has no bodies" in said.errors
    assert not list(Path().iterdir())


def test_the_formalism_changes_the_notes_and_not_the_code(call):
    spec = SHIPPED["slider_pendulum_free"]
    for folder, more in (("plain", ()), ("kane", ("--method", "kane"))):
        assert call("generate", spec, "-o", folder, *more).code == 0
    plain, kane = ({f.name: f.read_bytes() for f in Path(n).iterdir()} for n in ("plain", "kane"))
    assert [n for n in plain if plain[n] != kane[n]] == ["slider_pendulum_free.tex"]


def test_a_formalism_without_notes_is_wrong_input(call):
    said = call("generate", SHIPPED["simple_pendulum"], "-t", "c", "--method", "kane")
    assert said.code == 2
    assert "--method is how the notes derive" in said.errors
