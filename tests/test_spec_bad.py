import pytest
from bad_constraints import BAD_CONSTRAINTS
from bad_specs import BAD, BASE, LINE, SOLID
from spec_samples import FOUR_BAR, LINKED, ROLLING_DISC, ROPE

from eomgen import spec
from eomgen.errors import SpecError
from eomgen.spec.report import render

ALL = (*BAD, *BAD_CONSTRAINTS)


def faults_of(text):
    with pytest.raises(SpecError) as caught:
        spec.read(text, "x.yaml")
    return caught.value.faults


@pytest.mark.parametrize("bad", ALL, ids=lambda bad: bad.name)
def test_bad_file_is_refused_at_its_place(bad):
    found = faults_of(bad.text)
    assert ", ".join(f"{f.location.line}:{f.location.column} {f.code}" for f in found) == bad.faults
    assert all(f.message and f.location.file == "x.yaml" for f in found)


@pytest.mark.parametrize("bad", ALL, ids=lambda bad: bad.name)
def test_caret_stands_below_a_character_of_the_line(bad):
    text = bad.text if isinstance(bad.text, str) else ""
    for fault in faults_of(bad.text):
        if fault.source and len(text) < 10_000:
            assert fault.source == text.split("\n")[fault.location.line - 1]
            assert 1 <= fault.location.column <= len(fault.source) + 1
        render((fault,), "text")


@pytest.mark.parametrize("text", [BASE, LINE, SOLID])
def test_the_files_they_are_made_from_are_right(text):
    assert spec.read(text, "x.yaml").bodies


def test_names_in_the_table_are_different():
    assert len({bad.name for bad in ALL}) == len({bad.text for bad in ALL}) == len(ALL)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        (BASE.replace("gravity", "gravty"), "did you mean 'gravity'?"),
        (BASE.replace("sin(phi)", "sin(phy)"), "did you mean 'phi'?"),
        (BASE.replace("sin(phi)", "sine(phi)"), "did you mean 'sin'?"),
        (BASE.replace("2 kg", "2 kgg"), "did you mean 'kg'?"),
        (BASE.replace("at: P", "rod: [P, bop]"), "did you mean 'bob'?"),
        (BASE.replace("plane", "plan"), "did you mean 'plane'?"),
        (BASE.replace("-cos", "\u2212cos"), "write '-'"),
        (BASE.replace("phi: rad", "phi: deg"), "write 'rad'"),
        (ROPE.replace(">=", ">"), "write '>='"),
        (ROPE.replace(">= 0", "= 0"), "write 'holonomic' for an equation"),
        (ROPE.replace("unilateral", "unilatral"), "did you mean 'unilateral'?"),
        (ROPE.replace("l - sqrt(x^2 + y^2) >= 0", "0 <= x <= l"), "write two relations"),
        (FOUR_BAR.replace("C = Cr", "C = Crr"), "did you mean 'Cr'?"),
        (
            FOUR_BAR.replace("C = Cr", '"C = D + [e, 0]"'),
            "name it under 'points', or write one equation for each component",
        ),
        (
            ROLLING_DISC.replace("x: {nonh", "x: {h"),
            "write 'nonholonomic' for a relation between rates",
        ),
        (
            LINKED.replace("y = x*tan(Omega*t)", "y' = x*Omega"),
            "write 'nonholonomic' for a relation between rates",
        ),
        (
            ROLLING_DISC.replace("x' - R*phi'*cos(theta)", "x - R*phi*cos(theta)"),
            "write 'holonomic' for a relation between coordinates",
        ),
        (LINKED.replace("guess", "gues"), "did you mean 'guess'?"),
    ],
)
def test_hint_says_what_to_write(text, hint):
    assert [f.hint for f in faults_of(text)] == [hint]


def test_disagreeing_terms_are_both_named():
    text = BASE + "outputs: {a: m*g*l*sin(phi) + m*g}\n"
    (fault,) = faults_of(text)
    assert fault.message == "'m*g*l*sin(phi)' is [kg m^2 s^-2] but 'm*g' is [kg m s^-2]"
    assert fault.source[fault.location.column - 1 :] == "m*g}"


def test_every_fault_of_a_file_is_told_in_the_order_of_its_lines():
    wrong = BASE.replace("2 kg", "2 kgg").replace("sin(phi)", "sin(phy)").replace("at: P", "att: P")
    found = faults_of(wrong + "colour: red\nexpect: {dof: x}\n")
    assert [f.code for f in found] == ["E401", "E301", "E104", "E104", "E111"]
    assert list(found) == sorted(found)
