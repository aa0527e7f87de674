import shutil

import jinja2
import pytest
import sympy as sp
from programs import PROGRAMS

from eomgen.cache_folder import VARIABLE, root
from eomgen.errors import UsageError
from eomgen.render.lines import named, rows, short_statements, statements, wrap
from eomgen.render.records import Argument, Step
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import (
    c_comment,
    c_string,
    docstring,
    environment,
    fill,
    shipped,
)

PROGRAM = PROGRAMS["slider_pendulum"]


def overriding(folder, name, text):
    """An environment whose user folder holds one template."""
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return environment(folder)


def test_what_ships_is_there():
    assert (shipped("templates") / "c" / "model.c.j2").is_file()


def test_a_file_of_the_user_wins_and_the_others_stay_ours(tmp_path):
    templates = overriding(tmp_path, "c/model.h.j2", "/* {{ name }} of {{ version }} */\n")
    files = render(PROGRAM, TARGETS["c"], templates)
    assert files["slider_pendulum.h"] == "/* slider_pendulum of 0.1.0 */\n"
    ours = render(PROGRAM, TARGETS["c"], environment())
    assert files["slider_pendulum.c"] == ours["slider_pendulum.c"]


@pytest.mark.parametrize(
    ("target", "template"),
    [("c", "c/model.c.j2"), ("c", "c/model.h.j2"), ("python", "python/model.py.j2")],
)
def test_a_block_of_the_user_replaces_ours(tmp_path, target, template):
    text = f'{{% extends "builtin/{template}" %}}{{% block head %}}# our house\n{{% endblock %}}'
    templates = overriding(tmp_path, template, text)
    changed = render(PROGRAM, TARGETS[target], templates)
    ours = render(PROGRAM, TARGETS[target], environment())
    (different,) = [file for file in ours if ours[file] != changed[file]]
    assert changed[different].lstrip().startswith("# our house\n")
    assert "do not edit" not in changed[different]
    assert ours[different].endswith(changed[different][-1000:])


@pytest.mark.parametrize("template", ["c/model.c.j2", "c/model.h.j2", "python/model.py.j2"])
def test_every_template_is_cut_in_named_blocks(template):
    blocks = environment().get_template(template).blocks
    assert {"head", "declarations", "functions"} <= set(blocks)


WRONG = {
    "{{ nothing }}": "'nothing' is undefined",
    "{{ ''.__class__ }}": "unsafe",
    "{{ ''.__class__.__mro__ }}": "unsafe",
    "{{ parameters.append(1) }}": "no attribute 'append'",
    "{% for %}": "Expected an expression",
    "{{ name | no_such_filter }}": "no_such_filter",
    "{{ 1 / 0 }}": "division by zero",
    "{% extends 'missing.j2' %}": "missing.j2",
    "{% include '../../etc/passwd' %}": "passwd",
}


@pytest.mark.parametrize("text", WRONG)
def test_a_mistake_in_a_template_has_file_and_line(tmp_path, text):
    templates = overriding(tmp_path, "c/model.h.j2", f"first\n{text}\n")
    with pytest.raises(UsageError, match=WRONG[text]) as raised:
        render(PROGRAM, TARGETS["c"], templates)
    assert str(raised.value).startswith(f"{tmp_path / 'c' / 'model.h.j2'}:2: ")


def test_a_mistake_of_ours_shows_its_traceback():
    with pytest.raises(jinja2.UndefinedError):
        fill(environment(), "c/model.h.j2", {})


def test_a_template_cannot_reach_into_sympy(tmp_path):
    templates = overriding(tmp_path, "c/model.h.j2", "{{ x.subs('x', 'exit()') }}")
    with pytest.raises(UsageError, match="unsafe"):
        fill(templates, "c/model.h.j2", {"x": sp.Symbol("x")})


def test_a_folder_that_is_missing_is_an_error(tmp_path):
    with pytest.raises(UsageError, match="no such folder"):
        environment(tmp_path / "nowhere")


def test_comments_and_strings_cannot_be_left():
    assert c_comment("a */ b\n/* ??/") == "a * / b / * ? ?/"
    assert c_comment("*/*/ ????") == "* / * / ? ? ? ?"
    assert c_string('a"\\ ???') == '"a\\"\\\\ ?""?""?"'
    assert docstring('"""') == '\\"\\"\\"'


def test_long_lines_break_at_spaces():
    assert wrap("a + b + c", indent=2, hanging=2, width=7) == "  a + b\n    + c"


HEADER = "c/model.h.j2"


def header(templates):
    return fill(templates, HEADER, {})


def test_compiled_templates_stay_in_the_cache_until_their_text_changes(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path / "cache"))
    assert header(overriding(tmp_path / "mine", HEADER, "first")) == "first"
    (kept,) = root().rglob("*.cache")
    written = kept.read_bytes()
    compiled = jinja2.Environment.compile
    monkeypatch.setattr(jinja2.Environment, "compile", None)
    assert header(environment(tmp_path / "mine")) == "first"
    monkeypatch.setattr(jinja2.Environment, "compile", compiled)
    assert header(overriding(tmp_path / "mine", HEADER, "second")) == "second"
    assert kept.read_bytes() != written
    kept.write_bytes(written[:-5])
    assert header(environment(tmp_path / "mine")) == "second"


def test_templates_need_no_cache(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path / "cache"))
    templates = overriding(tmp_path / "mine", HEADER, "first")
    shutil.rmtree(root())
    assert header(templates) == "first"
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv(VARIABLE, str(tmp_path / "file"))
    assert header(environment(tmp_path / "mine")) == "first"


PATTERNS = {"assign": ["%(name)s = %(expression)s;"], "sine": ["%(name)s;", "f(&%(name)s);"]}
LONG = " + ".join(["abcdefgh"] * 12)


def otherwise(step):
    return f"<{step.kind}>\n"


def test_a_record_is_laid_out_by_the_lines_of_its_kind():
    steps = (Step("assign", "a", "b"), Step("solve"), Step("sine", "s"), Step("assign", "x", LONG))
    text = statements(steps, PATTERNS, otherwise, 2)
    assert text.splitlines()[:4] == ["  a = b;", "<solve>", "  s;", "  f(&s);"]
    assert text == "  a = b;\n<solve>\n  s;\n  f(&s);\n" + wrap(f"x = {LONG};", 2) + "\n"
    assert max(map(len, text.splitlines())) <= 100


def test_a_line_that_is_too_long_is_left_to_a_macro():
    steps = (Step("assign", "a", "b"), Step("assign", "x", "abc"), Step("solve"))
    patterns = {"assign": "%(name)s = %(expression)s"}
    assert short_statements(steps, patterns, otherwise, 2, 7) == "  a = b\n<assign>\n<solve>\n"


def test_rows_and_records_have_a_line_each():
    assert rows([(0, "a"), (1, "b + c")], "r[%s] = %s;", 1) == " r[0] = a;\n r[1] = b + c;\n"
    assert rows(["a"], "%s,", 0) == "a,\n"
    items = (Argument("x", "state", 3, "x"), Argument("m", "parameters", 0, "m", "m_"))
    patterns = {"state": "%(code)s = s[%(index)s]", "parameters": "%(code)s = p.%(member)s"}
    assert named(items, patterns, "source", 2) == "  x = s[3]\n  m = p.m_\n"
