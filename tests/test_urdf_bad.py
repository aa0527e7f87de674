import random

import pytest
from bad_urdfs import BAD, BASE, HAND, extended
from hypothesis import given, settings
from hypothesis import strategies as st
from robots import FOLDER

from eomgen.errors import SpecError
from eomgen.spec.report import render
from eomgen.urdf import imported
from eomgen.urdf.wishes import Wishes

GOOD = tuple(
    path.read_text(encoding="utf-8")
    for path in sorted(FOLDER.glob("*.urdf"))
    if path.stat().st_size < 4000
)
PIECES = (
    *"<>/\"'=&;#- \t\n\r\0", "<!DOCTYPE x>", "<![CDATA[", "]]>", "<!--", "-->", "<?x?>", "&lt;",
    "&#0;", "&#xD800;", "1e308", "1e-300", "nan", "inf", "-", "0", "\u03b8", "\u2028", "\ufeff",
    "\U0001f40d", "<link name='a'/>", "<joint>", "<mimic joint='hinge'/>", " type='fixed'",
    "floating", "planar", "prismatic", "continuous", " name='t'", " name='world'", "base", "arm",
    "0 0 0", "1 2", "xyz", "rpy", "<origin xyz='1 2 3' rpy='1 2 3'/>", "999999999999999999999999",
)  # fmt: skip


def faults_of(text, wishes=None):
    data = text if isinstance(text, bytes) else text.encode()
    with pytest.raises(SpecError) as caught:
        imported(data, "x.urdf", wishes or Wishes())
    return caught.value.faults


@pytest.mark.parametrize("bad", BAD, ids=lambda bad: bad.name)
def test_bad_file_is_refused_at_its_place(bad):
    found = faults_of(bad.text)
    assert ", ".join(f"{f.location.line}:{f.location.column} {f.code}" for f in found) == bad.faults
    assert all(f.message and f.location.file == "x.urdf" for f in found)
    render(found, "text")


def test_the_files_they_are_made_from_are_right():
    assert imported(BASE.encode(), "x.urdf", Wishes()).text
    assert imported(extended(HAND).encode(), "x.urdf", Wishes()).text


def test_names_in_the_table_are_different():
    assert len({bad.name for bad in BAD}) == len({bad.text for bad in BAD}) == len(BAD)


@pytest.mark.parametrize(
    ("old", "new", "hint"),
    [
        ("<axis", "<axes", "did you mean 'axis'?"),
        ("revolute", "revolut", "did you mean 'revolute'?"),
        ('link="base"', 'link="bass"', "did you mean 'base'?"),
        ("revolute", "fixed", "--floating-base lets the whole robot move"),
        ('ixx="0.1"', 'ixx="0.3"', "correct it, or --mend-inertias"),
        ("<robot", "<!DOCTYPE robot><robot", "delete it; a URDF needs none"),
    ],
)
def test_hint_says_what_to_do(old, new, hint):
    assert [f.hint for f in faults_of(BASE.replace(old, new, 1))] == [hint]


def test_a_place_counts_characters_not_bytes():
    (fault,) = faults_of(BASE.replace('"base"/>', '"base"/><!-- \u03b8\U0001f40d --><lnk/>'))
    assert (fault.location.line, fault.location.column) == (3, 33)


def attempt(data):
    """The import ends well or in faults that can be shown, never otherwise."""
    for wishes in (Wishes(), Wishes(floating_base=True, mend=True)):
        try:
            imported(data, "x.urdf", wishes)
        except SpecError as error:
            for style in ("text", "json", "github"):
                render(error.faults, style)


@settings(max_examples=60, deadline=None)
@given(st.binary(max_size=300))
def test_any_bytes_are_refused(data):
    attempt(data)


@settings(max_examples=120, deadline=None)
@given(st.integers(0, 2**32))
def test_mutated_files_never_end_in_a_traceback(seed):
    chance = random.Random(seed)
    text = chance.choice((BASE, extended(HAND), *GOOD))
    for _ in range(chance.randint(1, 4)):
        start = chance.randrange(len(text))
        end = min(len(text), start + chance.choice((0, 1, 2, 5, 40)))
        text = text[:start] + chance.choice(PIECES) + text[end:]
    attempt(text.encode())


@settings(max_examples=120, deadline=None)
@given(st.integers(0, 2**32))
def test_rearranged_elements_never_end_in_a_traceback(seed):
    chance = random.Random(seed)
    lines = chance.choice((BASE, extended(HAND), *GOOD)).splitlines(keepends=True)
    for _ in range(chance.randint(1, 5)):
        here, there = chance.randrange(len(lines)), chance.randrange(len(lines))
        lines[here] = chance.choice((lines[there], "", lines[here] + lines[there]))
    attempt("".join(lines).encode())
