"""The notes: every part in its place, nothing of the user's run as a macro, pages that compile."""

import os
import re
import string
import subprocess
import sys
from dataclasses import replace

import pytest
from scenes import FILES, derivation_of, model_of
from tools import tool

from eomgen.errors import UsageError
from eomgen.model import Description
from eomgen.render import notes_data, notes_page, words
from eomgen.render.latex_text import escaped
from eomgen.render.notes import Notes, latex_context, text_context
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment
from eomgen.spec.reader import Scalar
from eomgen.spec.units import parse_unit

CHECK = "checked: Lagrange = Newton-Euler_at 50 % of states"
ORDER = [
    "data", "coordinates", "inputs", "kinematics", "kinetic", "potential", "lagrangian",
    "dissipation", "forces", "steps", "equations", "matrix",
]  # fmt: skip


def page(derivation, target="latex", **known):
    notes = Notes(derivation, check=CHECK, **known)
    (text,) = render(notes, TARGETS[target], environment()).values()
    return text


def test_every_language_has_every_word():
    first, *others = words.WORDS.values()
    for other in others:
        assert other.keys() == first.keys()
        for word, said in first.items():
            fields = {f for _, f, _, _ in string.Formatter().parse(said)}
            assert fields == {f for _, f, _, _ in string.Formatter().parse(other[word])}


@pytest.mark.parametrize("language", words.WORDS)
def test_the_parts_stand_in_the_order_of_a_lecture(language):
    text = page(derivation_of("slider_pendulum"), language=language)
    places = [text.index(rf"section*{{{words.WORDS[language][part]}}}") for part in ORDER]
    assert places == sorted(places)
    assert text.index(escaped(CHECK)) > places[-1]


def test_a_language_without_words_is_an_error():
    with pytest.raises(UsageError, match="en or es"):
        latex_context(Notes(derivation_of("slider_pendulum"), "fr"))


def test_a_title_in_another_language_is_taken_where_there_is_none():
    derivation = derivation_of("slider_pendulum")
    only = replace(derivation, model=replace(derivation.model, title={"en": "Slider & bob"}))
    assert r"\Large Slider \& bob" in page(only, language="es")
    assert page(only, "text", language="es").startswith("Slider & bob\n")


def test_what_a_scene_does_not_have_is_left_out():
    text = page(derivation_of("spherical_pendulum"))
    assert "Dissipation" not in text
    assert "Inputs" not in text
    assert "No other force does virtual work: $Q = 0$ for every coordinate." in text
    assert r"\frac{\partial D}" not in text


def test_without_potential_the_notes_say_so():
    assert "No force has a potential: $V = 0$." in page(derivation_of("particle_polar"))


def test_the_division_is_said():
    assert "Divided by $m_B l$, the equation of motion is" in page(derivation_of("disc_pendulum"))


def test_values_come_with_the_unit_that_they_are_in():
    """5 mm is stored as 1/200 m; a value given in degrees is an exact multiple of pi."""
    rows = latex_context(Notes(derivation_of("two_link_arm")))["parameters"]
    shown = {row["symbol"]: (row["value"], row["unit"]) for row in rows}
    amplitude = next(p for p in model_of("two_link_arm").parameters if p.name == "A0")
    assert float(amplitude.value) == float(shown["A_0"][0])
    assert shown["A_0"][1] == r"\mathrm{m}"
    assert shown["g"] == ("9.81", r"\mathrm{m/s^{2}}")


@pytest.mark.parametrize("name", sorted(notes_data.COHERENT))
def test_a_unit_that_is_left_as_it_is_counts_one_in_si(name):
    assert parse_unit(Scalar(name, 1, 1)).value == 1


@pytest.mark.parametrize(
    ("unit", "shown"),
    [("Ohm", "Ohm"), ("N*m/T", "N*m/T"), ("\u03a9", "\u03a9"), ("mm", "m"), ("min", "s")],
)
def test_the_unit_of_a_value_is_the_authors_where_it_is_coherent(unit, shown):
    dimension = parse_unit(Scalar(unit, 1, 1)).dimension
    assert notes_data.si_unit(Description(unit, dimension)) == shown


def test_the_text_shows_the_derivatives_only_when_asked():
    derivation = derivation_of("slider_pendulum")
    assert "∂L/∂s′ = (m_A + m_B) s′ + m_B l φ′ cos φ" in page(derivation, "text", steps=True)
    assert "∂L" not in page(derivation, "text")
    assert page(derivation, "text").endswith(f"{CHECK}\n")


def test_nothing_of_the_user_is_a_macro():
    evil = r"\input{/etc/passwd} $x$ % & # _ ^ {"
    derivation = derivation_of("slider_pendulum")
    model = derivation.model
    about = replace(model.parameters[0], description=Description(unit=evil, about=evil))
    hostile = replace(model, title={"en": evil}, parameters=(about, *model.parameters[1:]))
    text = page(replace(derivation, model=hostile))
    assert r"\input" not in text.replace(r"\inputenc", "")
    assert text.count(escaped(evil)) == 3


def test_a_formula_that_nobody_would_read_is_named_by_its_size(monkeypatch):
    monkeypatch.setattr(notes_page, "LARGEST", 3)
    text = page(derivation_of("cart_three_pendulums"), "text")
    assert "T = (a sum of" in text
    assert "T_bob_1 = ½ m_1" in text


def test_a_wide_matrix_is_listed_entry_by_entry():
    context = latex_context(Notes(derivation_of("cart_three_pendulums")))
    assert not context["matrix"]["whole"]
    assert re.search(r"M_\{12\} &= \(m_1 \+ m_2 \+ m_3\) l_1 \\cos\\varphi_1", page(
        derivation_of("cart_three_pendulums")
    ))  # fmt: skip
    assert latex_context(Notes(derivation_of("slider_pendulum")))["matrix"]["whole"]


def is_text(value):
    """Whether a value is text or a truth, or tables of these."""
    if isinstance(value, dict):
        return all(is_text(v) for v in value.values())
    if isinstance(value, tuple):
        return all(is_text(v) for v in value)
    return isinstance(value, str | bool)


def test_the_context_holds_nothing_but_text():
    for context in (latex_context, text_context):
        assert is_text({**context(Notes(derivation_of("rigid_body"))), "words": {}})


SCRIPT = """
import sys
from eomgen.mechanics import lagrange
from eomgen.render.notes import Notes
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment
from eomgen.spec import read

for file in sys.argv[1:]:
    derivation = lagrange.derive(read(open(file, encoding="utf-8").read(), file))
    for target in ("latex", "text"):
        for text in render(Notes(derivation), TARGETS[target], environment()).values():
            sys.stdout.buffer.write(text.encode())
"""


def test_the_same_spec_gives_the_same_bytes_under_any_hash_seed():
    files = [str(FILES[n]) for n in ("rigid_body", "half_car", "sprung_pair", "elastic_pendulum")]
    found = {
        subprocess.run(
            [sys.executable, "-c", SCRIPT, *files],
            env=os.environ | {"PYTHONHASHSEED": seed},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "1", "2")
    }
    assert len(found) == 1
    assert len(found.pop()) > 10_000


@pytest.mark.parametrize("target", ["latex", "text"])
@pytest.mark.parametrize("name", FILES)
def test_every_scene_fills_its_templates(name, target):
    text = page(derivation_of(name), target, language="es", steps=True)
    assert "None" not in text
    assert "object at 0x" not in text


def compiled(folder, text):
    """The log of pdflatex, which must end well."""
    (folder / "notes.tex").write_text(text, encoding="utf-8")
    command = [tool("pdflatex"), "-halt-on-error", "-interaction=nonstopmode", "notes.tex"]
    done = subprocess.run(command, cwd=folder, capture_output=True, check=False)
    log = done.stdout.decode(errors="replace")
    assert done.returncode == 0, log[-2000:]
    return log


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_the_notes_compile_and_fit_the_page(name, tmp_path):
    log = compiled(tmp_path, page(derivation_of(name)))
    overfull = [float(w) for w in re.findall(r"Overfull \\hbox \((\d+\.?\d*)pt", log)]
    assert all(points < 6 for points in overfull), overfull


def test_hostile_words_compile(tmp_path):
    evil = "\\input{x} $x_1^2$ % & # {} ~ ^ "
    evil += "\u00e9\u00f1 \u03c6 \u4e2d \u201cq\u201d \u2212 \u00b0 <>|\"'`"
    derivation = derivation_of("particle_cartesian")
    model = derivation.model
    first = replace(
        model.parameters[0], description=Description("kg*m^2/(s\u00b7\u00b5m)", about=evil)
    )
    hostile = replace(model, title={"en": evil}, parameters=(first, *model.parameters[1:]))
    compiled(tmp_path, page(replace(derivation, model=hostile)))
