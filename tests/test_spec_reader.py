import random
import string

import pytest
import yaml
from bad_specs import BASE, LINE, SOLID
from hypothesis import example, given, settings
from hypothesis import strategies as st
from spec_samples import CONSTRAINED, EVERYTHING, SLIDER_PENDULUM, TWO_LINK_ARM

from eomgen import spec
from eomgen.errors import SpecError
from eomgen.spec.ledger import Ledger, Mistake
from eomgen.spec.reader import Mapping, Scalar, Sequence, lines_of, read_tree

SAMPLES = (EVERYTHING, SLIDER_PENDULUM, TWO_LINK_ARM, BASE, LINE, SOLID, *CONSTRAINED.values())
PIECES = (
    *"[]{}:,'\"-+*/^()=>&!|#%@`~ \t\n\r\0", "\n  ", "\n- ", ": ", "<<: ", "---\n", "''", "1e308",
    "1e-300", "\u03b8", "\u2028", "\ufeff", "\U0001f40d", "!!python/object:x ", "**9**9",
    "[]", "{}", "phi'''", "der(", "<=", ">=", " = ", "phi'", "holonomic: ", "unilateral: ",
    "guess: ", "sqrt(", "log(", "/0", "nan", "kg", "m/s", "on", "~", "null", "min(", "atan2(",
)  # fmt: skip


def tree(text):
    ledger = Ledger("x.yaml", lines_of(text))
    return read_tree(text, ledger), ledger.faults


def test_scalars_stay_the_text_that_the_author_wrote():
    text = "a: [on, 010, 1e-3, 12:30, 1_000, .5, ~, true, 0x10, 2020-01-01, 'no', NO]\n"
    root, _ = tree(text)
    words = [item.text for item in root.entries[0].value.items]
    assert words == text[4:-2].replace("'", "").split(", ")


def test_positions_point_at_the_first_character():
    text = "\u03b8\u03b8: {a: 'x y', \"b\": [1, z]}\nlast:\n  - in: word\n"
    root, faults = tree(text)
    lines = lines_of(text)

    def visit(node):
        if isinstance(node, Scalar):
            assert lines[node.line - 1].startswith(node.text, node.column - 1)
        for item in node.items if isinstance(node, Sequence) else ():
            visit(item)
        for entry in node.entries if isinstance(node, Mapping) else ():
            visit(entry.key)
            visit(entry.value)

    visit(root)
    assert not faults


def test_escapes_and_folded_texts_are_not_exact():
    root, _ = tree('a: "x\\ty"\nb: >\n  folded\n  text\nc: plain\n  over lines\n')
    assert [e.value.exact for e in root.entries] == [False, False, False]
    assert [e.value.text for e in root.entries] == ["x\ty", "folded text\n", "plain over lines"]


def test_second_of_two_equal_keys_is_left_out():
    root, faults = tree("a: 1\na: 2\n")
    assert [e.value.text for e in root.entries] == ["1"]
    assert [(f.code, f.location.line) for f in faults] == [("E105", 2)]


@pytest.mark.parametrize("text", SAMPLES)
def test_both_readers_give_the_same_tree(text, monkeypatch):
    fast = tree(text)
    monkeypatch.delattr(yaml, "CSafeLoader", raising=False)
    assert tree(text) == fast


@pytest.mark.parametrize(
    "text", ["a: [1, {b: 2}", "a: 'x", "a: b: c", "\ta: 1", "{a: 1}}", "a: @x"]
)
def test_both_readers_give_the_same_words_for_a_fault(text, monkeypatch):
    with pytest.raises(Mistake) as fast:
        tree(text)
    monkeypatch.delattr(yaml, "CSafeLoader", raising=False)
    with pytest.raises(Mistake) as pure:
        tree(text)
    assert (str(fast.value), fast.value.spot) == (str(pure.value), pure.value.spot)


def only_spec_errors(text):
    for fault in faults_of(text):
        assert fault.code.startswith("E")
        assert fault.location.line >= 1
        assert fault.location.column >= 1


def faults_of(text):
    try:
        spec.read(text, "x.yaml")
    except SpecError as error:
        return error.faults or pytest.fail("refused without a fault")
    return ()


@given(st.binary(max_size=400))
@settings(max_examples=300, deadline=None)
def test_no_bytes_crash_the_reader(data):
    only_spec_errors(data)


@given(st.text(max_size=400))
@example("a:\x85- b\u2028c")
@settings(max_examples=300, deadline=None)
def test_no_text_crashes_the_reader(text):
    only_spec_errors(text)


def mutated(text, seed):
    """The text after a few random insertions, deletions and swaps."""
    chance = random.Random(seed)
    for _ in range(chance.randint(1, 4)):
        start = chance.randrange(len(text) + 1)
        end = min(len(text), start + chance.choice((0, 0, 1, 1, 3, 12)))
        word = chance.choice((*PIECES, chance.choice(string.printable), text[start:end] * 2))
        lines = text.split("\n")
        if chance.random() < 0.2:
            chance.shuffle(lines)
            text = "\n".join(lines)
        else:
            text = text[:start] + word + text[end:]
    return text


@given(st.sampled_from(SAMPLES), st.integers(0, 2**32))
@settings(max_examples=600, deadline=None)
def test_no_mutated_spec_crashes_the_reader(text, seed):
    only_spec_errors(mutated(text, seed))
