import json

import pytest
from bad_specs import BASE

from eomgen import spec
from eomgen.errors import Fault, Location, SpecError
from eomgen.spec.report import render

FAULT = Fault(Location("a.yaml", 12, 5), "E104", "unknown key 'x'", "did you mean 'y'?", "    x: 1")


def test_text_has_place_message_line_and_caret():
    assert render((FAULT,), "text") == (
        "a.yaml:12:5: error E104: unknown key 'x'; did you mean 'y'?\n        x: 1\n        ^"
    )


def test_caret_stands_below_the_term_after_wide_and_combining_letters():
    source = "s: \u6f22e\u0301 + y"
    fault = Fault(Location("a", 1, 10), "E301", "unknown name 'y'", source=source)
    _, line, caret = render((fault,), "text").split("\n")
    assert line == "    " + source
    # two columns for the first letter, none for the accent
    assert caret == " " * (4 + 3 + 2 + 1 + 0 + 3) + "^"


def test_tabs_and_long_lines_keep_the_caret_in_place():
    tabbed = Fault(Location("a", 1, 4), "E1", "x", source="a\tb?")
    assert render((tabbed,), "text").split("\n")[2] == "     \t ^"
    long = Fault(Location("a", 1, 501), "E1", "x", source="." * 500 + "?" + "." * 500)
    _, line, caret = render((long,), "text").split("\n")
    assert len(line) < 200
    assert line[len(caret) - 1] == "?"


def test_control_characters_do_not_reach_the_terminal():
    fault = Fault(Location("a\x1b[2J", 1, 1), "E1", "x\x07", source="\x1b]0;evil\u202e")
    assert not {"\x1b", "\x07", "\u202e"} & set(render((fault,), "text"))


def test_json_reads_back():
    (row,) = json.loads(render((FAULT,), "json"))
    assert row == {
        "file": "a.yaml",
        "line": 12,
        "column": 5,
        "code": "E104",
        "message": "unknown key 'x'",
        "hint": "did you mean 'y'?",
        "source": "    x: 1",
    }
    assert json.loads(render((), "json")) == []


def test_github_escapes_what_would_end_a_command():
    fault = Fault(Location("a,b:c.yaml", 1, 2), "E1", "50 % of\n::error::x", "a, b: c")
    assert render((fault,), "github") == (
        "::error file=a%2Cb%3Ac.yaml,line=1,col=2,title=E1::50 %25 of%0A::error::x; a, b: c"
    )
    title = "::error file=a.yaml,line=12,col=5,title=E104::unknown key 'x'; did you mean 'y'?"
    assert render((FAULT,), "github") == title


@pytest.mark.parametrize("format", ["text", "json", "github"])
def test_no_fault_of_a_file_is_lost(format):
    with pytest.raises(SpecError) as caught:
        spec.read(BASE.replace("2 kg", "2 kgg").replace("gravity", "gravty"), "x.yaml")
    text = render(caught.value.faults, format)
    assert text.index("E104") < text.index("E401")
