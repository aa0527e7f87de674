"""Files that the command line writes: whole, where they are wanted, over nothing of the user."""

import json
import os
from pathlib import Path

import pytest
from commandline import eomgen, run, start
from scenes import SHIPPED, text_of
from studies import PENDULUM

from eomgen import files, shelf
from eomgen.errors import UsageError

CODE = ["pendulum.tex", "pendulum.h", "pendulum.c", "pendulum.py"]
TARGETS = {
    "latex": ["pendulum.tex"],
    "c": ["pendulum.h", "pendulum.c"],
    "python": ["pendulum.py"],
    "text": ["pendulum.txt"],
}
LONGER = PENDULUM.replace("0.5 m,", "0.75 m,").replace("Pendulum", "Long pendulum " + "x" * 300)


@pytest.fixture
def generate(call):
    """`generate` on the pendulum's spec in pendulum.yaml."""

    def answer(*words, text=PENDULUM):
        Path("pendulum.yaml").write_text(text)
        return call("generate", "pendulum.yaml", *words)

    return answer


def contents(folder):
    """Name -> bytes of everything in a folder, hidden files too."""
    return {
        p.relative_to(folder).as_posix(): p.read_bytes()
        for p in Path(folder).rglob("*")
        if p.is_file()
    }


# generate


def test_notes_c_and_python_are_written_and_listed(generate):
    said = generate("-o", "a/new/folder")
    assert (said.code, said.errors) == (0, "")
    assert said.output.splitlines() == [str(Path("a/new/folder") / name) for name in CODE]
    assert sorted(contents("a/new/folder")) == sorted(CODE)


def test_the_folder_is_this_one_where_none_is_named(generate):
    assert generate("-t", "python").output == "pendulum.py\n"
    assert sorted(contents(".")) == ["pendulum.py", "pendulum.yaml"]


@pytest.mark.parametrize("target", TARGETS)
def test_one_target_only(generate, target):
    assert generate("-t", target, "-o", "out").code == 0
    assert sorted(contents("out")) == sorted(TARGETS[target])
    with_all = generate("-t", "text", "-t", "latex", "-t", "c", "-t", "python", "-o", "all")
    assert len(with_all.output.splitlines()) == 5
    for name, written in contents("out").items():
        assert written == contents("all")[name]


def test_one_file_on_standard_output_is_the_file(generate):
    said = generate("-t", "python", "-o", "-")
    generate("-t", "python", "-o", "out")
    assert said.output == Path("out/pendulum.py").read_text(encoding="utf-8")
    assert sorted(contents(".")) == ["out/pendulum.py", "pendulum.yaml"]


def test_several_files_on_standard_output_have_headings(generate):
    said = generate("-t", "c", "-o", "-")
    generate("-t", "c", "-o", "out")
    parts = [f"==> {name} <==\n{Path('out', name).read_text()}" for name in TARGETS["c"]]
    assert said.output == "".join(parts)


def test_standard_input_gives_the_same_code(call, generate):
    generate("-t", "c", "-o", "out")
    assert call("generate", "-", "-t", "c", "-o", "in", stdin=PENDULUM).code == 0
    digest = next(line for line in contents("in").popitem()[1].splitlines() if b"sha256" in line)
    assert digest in Path("out/pendulum.c").read_bytes()


def test_steps_can_be_left_out_of_the_text(generate):
    generate("-t", "text", "-o", "with")
    generate("-t", "text", "-o", "without", "--no-steps")
    with_steps, without = (contents(folder)["pendulum.txt"] for folder in ("with", "without"))
    assert "∂L/∂φ′".encode() in with_steps
    assert "∂L/∂φ′".encode() not in without
    assert set(without.splitlines()) < set(with_steps.splitlines())


def test_notes_in_spanish(call):
    spec = str(SHIPPED["simple_pendulum"])
    for language, word in (("en", "Kinetic energy"), ("es", "Energía cinética")):
        call("generate", spec, "-t", "latex", "-o", language, "--lang", language)
        notes = Path(language, "simple_pendulum.tex").read_text(encoding="utf-8")
        assert rf"\section*{{{word}}}" in notes


# nothing of the user's is lost


@pytest.mark.parametrize("name", CODE)
def test_a_file_of_the_user_is_not_overwritten(generate, name):
    Path("out").mkdir()
    Path("out", name).write_text("mine, and about eomgen\n")
    said = generate("-o", "out")
    assert (said.code, said.output) == (2, "")
    place = Path("out", name)
    assert said.errors == (
        f"eomgen: {place}: not made by eomgen and in the way; choose another folder, or --force\n"
    )
    assert contents("out") == {name: b"mine, and about eomgen\n"}
    assert generate("-o", "out", "--force").code == 0
    assert sorted(contents("out")) == sorted(CODE)
    assert b"mine" not in Path("out", name).read_bytes()


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("target", TARGETS)
def test_what_eomgen_made_is_made_again(generate, target, language):
    words = ("-t", target, "-o", "out", "--lang", language)
    assert generate(*words).code == 0
    first = contents("out")
    assert generate(*words, text=LONGER).code == 0
    second = contents("out")
    assert first.keys() == second.keys()
    assert all(first[name] != second[name] for name in first)
    assert generate(*words).code == 0
    assert contents("out") == first


def test_the_same_content_is_in_nobodys_way(generate, monkeypatch):
    monkeypatch.setattr(files, "MARKS", ())
    assert generate("-o", "out").code == 0
    assert generate("-o", "out").code == 0
    assert generate("-o", "out", text=LONGER).code == 2


@pytest.mark.parametrize("force", [(), ("--force",)])
def test_a_folder_in_the_way_stays(generate, force):
    Path("out/pendulum.c").mkdir(parents=True)
    said = generate("-o", "out", *force)
    assert (said.code, said.output) == (2, "")
    assert "is a folder and in the way" in said.errors
    assert not contents("out")


@pytest.mark.parametrize("folder", ["file", "file/below"])
def test_a_folder_that_cannot_be(generate, folder):
    Path("file").write_text("mine")
    said = generate("-o", folder)
    assert (said.code, said.output) == (2, "")
    assert said.errors.startswith(f"eomgen: {folder}: ")
    assert said.errors.endswith("; choose another folder\n")
    assert sorted(contents(".")) == ["file", "pendulum.yaml"]


def test_a_folder_that_cannot_be_written(generate, monkeypatch):
    def denied(**places):
        raise PermissionError(13, "Permission denied", str(places["dir"]))

    monkeypatch.setattr(files.tempfile, "mkstemp", denied)
    said = generate("-o", "out")
    assert (said.code, said.output) == (2, "")
    assert said.errors == "eomgen: out: Permission denied; choose another folder\n"


def test_all_files_are_written_or_none(generate, monkeypatch):
    generate("-o", "out")
    before = contents("out")
    staged = files._staged

    def full(path, text):
        if path.suffix == ".py":
            raise OSError(28, "No space left on device")
        return staged(path, text)

    monkeypatch.setattr(files, "_staged", full)
    said = generate("-o", "out", text=LONGER)
    assert (said.code, said.output) == (2, "")
    assert said.errors == "eomgen: out: No space left on device; choose another folder\n"
    assert contents("out") == before


def test_a_file_is_replaced_in_one_step(tmp_path, monkeypatch):
    """Until the new text is complete in another file the old one is untouched."""
    place = tmp_path / "a.txt"
    place.write_text("old")
    seen = []

    def replace(self, target):
        seen.append((self.read_text(), target.read_text()))
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(Path, "replace", replace)
    with pytest.raises(UsageError, match="Input/output error"):
        files.put({place: "new"})
    assert seen == [("new", "old")]
    assert contents(tmp_path) == {"a.txt": b"old"}


@pytest.mark.parametrize(("mask", "mode"), [(0o022, 0o644), (0o077, 0o600)])
def test_files_have_the_rights_of_the_user(tmp_path, mask, mode):
    before = os.umask(mask)
    try:
        files.put({tmp_path / "a.txt": "text"})
    finally:
        os.umask(before)
    assert (tmp_path / "a.txt").stat().st_mode & 0o777 == mode


# templates


def override(name, text):
    place = Path("mine", name)
    place.parent.mkdir(parents=True, exist_ok=True)
    place.write_text(text)


def test_a_block_of_a_template_can_be_the_users(generate):
    head = '{% extends "builtin/c/model.c.j2" %}{% block head %}/* our house */{% endblock %}'
    override("c/model.c.j2", head)
    generate("-o", "ours")
    assert generate("-o", "theirs", "--templates", "mine").code == 0
    ours, theirs = contents("ours"), contents("theirs")
    assert theirs["pendulum.c"].startswith(b"/* our house */")
    assert theirs["pendulum.c"].endswith(ours["pendulum.c"][-2000:])
    assert {n for n in ours if ours[n] != theirs[n]} == {"pendulum.c"}


def test_a_file_of_templates_can_be_the_users(call):
    override("text/derivation.txt.j2", "{{ title }} by us\n")
    Path("pendulum.yaml").write_text(PENDULUM)
    said = call("derive", "pendulum.yaml", "--templates", "mine")
    assert (said.code, said.output) == (0, "Pendulum by us\n")


def test_a_mistake_in_a_template_has_its_place_and_writes_nothing(generate):
    override("c/model.h.j2", "first line\n{{ nothing }}\n")
    said = generate("-o", "out", "--templates", "mine")
    assert (said.code, said.output) == (2, "")
    assert said.errors.startswith(f"eomgen: {Path('mine/c/model.h.j2')}:2: 'nothing' is undefined")
    assert not Path("out").exists()


def test_a_template_that_is_no_text_is_named(generate):
    override("c/model.h.j2", "")
    Path("mine/c/model.h.j2").write_bytes(b"/* caf\xe9 */")
    said = generate("-o", "out", "--templates", "mine")
    assert (said.code, said.output) == (2, "")
    place = Path("mine/c/model.h.j2")
    assert said.errors == f"eomgen: {place}: byte 7 is not UTF-8; save the file as UTF-8\n"
    assert not Path("out").exists()


def test_a_folder_of_templates_must_be_there(generate):
    said = generate("-o", "out", "--templates", "nowhere")
    assert (said.code, said.output) == (2, "")
    assert said.errors == "eomgen: nowhere: no such folder of templates\n"


def test_templates_are_listed(call):
    listed = call("templates").output.splitlines()
    assert listed == call("templates", "list").output.splitlines()
    assert {"c/model.c.j2", "latex/notes.tex.j2", "python/model.py.j2"} <= set(listed)


def test_ejected_templates_write_the_same_files(call, generate):
    said = call("templates", "eject", "-o", "mine")
    assert said.code == 0
    assert sorted(contents("mine")) == call("templates").output.splitlines()
    assert len(said.output.splitlines()) == len(contents("mine"))
    generate("-o", "ours")
    generate("-o", "theirs", "--templates", "mine")
    assert contents("ours") == contents("theirs")


def test_eject_takes_names_and_overwrites_nothing(call):
    assert call("templates", "eject", "c/model.c.j2").code == 0
    assert sorted(contents(".")) == ["templates/c/model.c.j2"]
    override("c/model.h.j2", "mine")
    said = call("templates", "eject", "-o", "mine")
    assert (said.code, said.output) == (2, "")
    assert "exists already and is left as it is" in said.errors
    assert contents("mine") == {"c/model.h.j2": b"mine"}


UNKNOWN = {
    (
        "templates",
        "eject",
        "c/model.c.j",
    ): "no template 'c/model.c.j'; did you mean 'c/model.c.j2'?",
    ("templates", "eject", "../cli.py"): "no template '../cli.py'; see `eomgen templates list`",
    ("examples", "copy", "furuta"): "no example 'furuta'; did you mean 'furuta_pendulum'?",
    ("examples", "copy", "../x"): "no example '../x'; see `eomgen examples list`",
    ("new", "mine", "--like", "furuta"): "no example 'furuta'; did you mean 'furuta_pendulum'?",
    ("new", "../mine"): "'../mine' is not a name; use letters, digits and _, no suffix",
    ("new", "mine.yaml"): "'mine.yaml' is not a name",
    ("new", ""): "'' is not a name",
    ("new", "é"): "'é' is not a name",
}


@pytest.mark.parametrize("words", UNKNOWN, ids=" ".join)
def test_what_is_not_on_the_shelf(call, words):
    said = call(*words)
    assert (said.code, said.output) == (2, "")
    assert said.errors.startswith("eomgen: ")
    assert UNKNOWN[words] in said.errors
    assert not contents(".")


# examples, new, schema


def test_examples_are_listed_with_their_titles(call):
    listed = call("examples").output
    assert listed == call("examples", "list").output
    rows = [line.split(maxsplit=1) for line in listed.splitlines()]
    assert [name for name, _ in rows] == list(SHIPPED)
    assert dict(rows)["two_rotor_drive"] == "Motor, elastic shaft and load"
    assert dict(rows)["simple_pendulum"] == "Simple pendulum"


def test_titles_in_every_way_that_an_example_may_write_them(tmp_path):
    spec = tmp_path / "a.yaml"
    for line in ("{en: A b's c, es: d}", '{en: "A b\'s c", es: d}', "A b's c", '"A b\'s c"'):
        spec.write_text(f"eom: 1\nsystem: {line}\nspace: line\n")
        assert shelf._title(spec) == "A b's c"


def test_examples_are_copied_with_the_schema(call):
    said = call("examples", "copy", "furuta_pendulum", "heavy_top", "-o", "out")
    assert said.code == 0
    assert sorted(contents("out")) == [shelf.SCHEMA_FILE, "furuta_pendulum.yaml", "heavy_top.yaml"]
    assert Path("out/heavy_top.yaml").read_text(encoding="utf-8") == text_of("heavy_top")
    assert call("examples", "copy", "gyroscope", "-o", "out").output == "out/gyroscope.yaml\n"
    said = call("examples", "copy", "-o", "out")
    assert (said.code, said.output) == (2, "")
    assert len(contents("out")) == 4
    call("examples", "copy", "-o", "all")
    assert len(contents("all")) == len(SHIPPED) + 1


def test_new_starts_a_spec_that_passes(call):
    said = call("new", "mine", "--like", "simple_pendulum")
    assert (said.code, said.output) == (0, f"mine.yaml\n{shelf.SCHEMA_FILE}\n")
    assert call("check", "mine.yaml").code == 0
    first = Path("mine.yaml").read_text(encoding="utf-8").splitlines()[0]
    assert first == f"# yaml-language-server: $schema=./{shelf.SCHEMA_FILE}"
    assert json.loads(Path(shelf.SCHEMA_FILE).read_text())["type"] == "object"


def test_new_overwrites_nothing(call):
    Path("mine.yaml").write_text("mine")
    said = call("new", "mine")
    assert (said.code, said.output) == (2, "")
    assert said.errors == "eomgen: mine.yaml: exists already and is left as it is\n"
    assert contents(".") == {"mine.yaml": b"mine"}
    Path(shelf.SCHEMA_FILE).write_text("{}")
    assert call("new", "other").output == "other.yaml\n"
    assert Path(shelf.SCHEMA_FILE).read_text() == "{}"


def test_the_schema_is_printed_as_it_is_written(call):
    call("new", "mine")
    assert call("schema").output == Path(shelf.SCHEMA_FILE).read_text(encoding="utf-8")


# as processes


def test_bytes_through_a_pipe_are_those_of_the_file(tmp_path):
    spec = SHIPPED["simple_pendulum"]
    run(*eomgen("generate", spec, "-t", "text", "-o", tmp_path))
    piped = run(*eomgen("generate", "-", "-t", "text", "-o", "-"), text=spec.read_text("utf-8"))
    assert piped == (tmp_path / "simple_pendulum.txt").read_text(encoding="utf-8")


def test_a_reader_that_leaves_early_is_no_accident():
    with start(*eomgen("schema")) as writer:
        writer.stdout.close()
        assert writer.stderr.read() == ""
