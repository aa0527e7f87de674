"""Linked scenes in the notes: cards, both numbers, a basis that is admissible, multipliers."""

import random
import re
from dataclasses import replace
from fractions import Fraction
from functools import cache

import pytest
import sympy as sp
from scenes import FILES, derivation_of, machine_of, model_of, study_of, text_of
from scenes import LINKED as LINKED_SHIPPED
from test_notes import compiled, is_text

from eomgen import compile, formulation, output_links
from eomgen.algebra.closed import Evaluation
from eomgen.analysis import cards
from eomgen.analysis.rank import Dependency
from eomgen.analysis.singular import Singularity
from eomgen.formulation import Formulation
from eomgen.mechanics import lagrange
from eomgen.mechanics.equations import multiplier_name, virtual_name
from eomgen.output_links import links
from eomgen.render import arrange, notes_links_names, notes_links_page, tree, words
from eomgen.render.latex_text import escaped
from eomgen.render.notes import Notes, latex_context, text_context
from eomgen.render.notes_links import Combination
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment
from eomgen.spec import read

LINKED = [
    pytest.param(name, marks=pytest.mark.slow) if name == "bricard" else name
    for name in FILES
    if model_of(name).constraints
]
MIXED = """
eom: 1
system: Cylinder on ground that moves
space: plane
gravity: [0, -g]
parameters: {m: 1 kg, R: 0.2 m, g: 9.81 m/s^2, e: 0.5, mu: 0.3, a: 0.01 m, w: 3 rad/s}
coordinates: {x: m, y: m, phi: rad}
prescribed: {h: {formula: a*sin(w*t), unit: m}}
bodies:
  wheel: {mass: m, at: [x, y], angle: phi, inertia: m*R^2/2}
constraints:
  rolls: {nonholonomic: x' + R*phi' = 0}
  ground: {holonomic: y - R - h = 0}
  again: {holonomic: 2*y - 2*R - 2*h = 0}
  wall: {unilateral: x >= 0, restitution: e, friction: mu}
initial: {x: 1 m}
"""


def filled(machine, language):
    chosen = Formulation("multiplier", "it was asked for", machine)
    return links(cards.report(machine), chosen, language)


@cache
def notes_of(name, language="en"):
    known = filled(machine_of(name), language)
    return Notes(derivation_of(name), language, "checked", links=known)


@cache
def mixed():
    model = read(MIXED, "mixed.yaml")
    known = filled(compile.machine_of(model), "en")
    return Notes(lagrange.derive(model), check="checked", links=known)


def page(notes, target="latex"):
    (text,) = render(notes, TARGETS[target], environment()).values()
    return text


# --- the page


@pytest.mark.parametrize("language", words.WORDS)
def test_constraints_stand_between_coordinates_and_kinematics(language):
    text = page(notes_of("four_bar", language))
    parts = ("coordinates", "constraints", "freedom", "kinematics", "first_kind", "equations")
    places = [text.index(f"section*{{{words.WORDS[language][part]}}}") for part in parts]
    assert places == sorted(places)


ANSWERS = {
    "four_bar": "bilateral, scleronomic, holonomic",
    "bead_on_turning_hoop": "bilateral, rheonomic, holonomic",
    "rolling_disc_upright": "bilateral, scleronomic, "
    "nonholonomic: it cannot be integrated (2, 3, 4)",
    "rope": "unilateral, scleronomic, not holonomic, for an inequality eliminates no coordinate",
}


@pytest.mark.parametrize("name", ANSWERS)
def test_a_card_answers_the_three_questions(name):
    assert latex_context(notes_of(name))["constraints"][-1]["answers"] == ANSWERS[name]


COUNTS = {
    "mass_on_sphere": ["3", "1", "$3 - 1 = 2$"],
    "dumbbell": ["6", "1", "$6 - 1 = 5$"],
    "four_bar": ["3", "2", "$3 - 2 = 1$"],
    "rolling_disc_upright": ["4", "2", "$4 - 2 = 2$", "4"],
    "rope": ["2", "0", "$2$"],
}


@pytest.mark.parametrize("name", COUNTS)
def test_both_numbers_stand_on_the_page_where_they_differ(name):
    found = latex_context(notes_of(name))["freedom"]["counts"]
    assert [row["body"] for row in found] == COUNTS[name]


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("rope", "The coordinates are free"),
        ("four_bar", "The set of coordinates is linked"),
        ("rolling_disc_upright", "The coordinates are independent of each other, and yet"),
    ],
)
def test_the_set_is_called_free_or_linked(name, said):
    assert latex_context(notes_of(name))["set_said"].startswith(said)
    assert said in page(notes_of(name), "text")


def test_a_nonholonomic_scene_says_why_the_numbers_differ():
    text = page(notes_of("rolling_disc_upright", "es"), "text")
    assert "el número mínimo de coordenadas, 4, es mayor que el de grados de libertad, 2" in text
    assert "no holónoma: no se puede integrar (2, 3, 4)" in text
    assert "δx = R cos θ δφ" in text


def test_each_form_of_a_constraint_is_shown():
    (card,) = latex_context(notes_of("mass_on_sphere"))["constraints"]
    bodies = [row["body"] for row in card["equations"] + card["rates"] + card["virtual"]]
    assert bodies == [
        "& x^2 + y^2 + z^2 - R^2 = 0",
        r"& 2 x \dot{x} + 2 y \dot{y} + 2 z \dot{z} = 0",
        r"& 2 x \,\delta x + 2 y \,\delta y + 2 z \,\delta z = 0",
    ]


def test_a_rate_constraint_is_not_repeated_as_its_own_rate():
    for card in latex_context(notes_of("rolling_disc_upright"))["constraints"]:
        assert not card["rates"]
        assert len(card["equations"]) == len(card["virtual"]) == 1


def test_gaps_are_inequalities_with_contact_and_flight():
    text = page(mixed())
    assert r"& x \ge 0" in text
    assert "In contact the gap is zero" in text
    assert "multiplies it by $e$." in text
    assert r"with the coefficient $\mu$" in text
    assert "These are the equations of flight." in text
    assert "In flight" not in page(notes_of("four_bar"))


def test_redundant_rows_and_hidden_relations_are_named():
    text = page(mixed(), "text")
    assert "Redundant, as it follows from other constraints: again." in text
    assert "W-RANK: constraint again depends on ground" in text
    assert "holonomic: stated between rates, it can be integrated" in text
    assert "x + R φ = (constant)  (integrated)" in text


def test_a_relation_that_was_not_found_is_owned_up_to():
    known = mixed().links
    unknown = tuple(replace(c, hidden=tuple(None for _ in c.hidden)) for c in known.cards)
    text = page(replace(mixed(), links=replace(known, cards=unknown)), "text")
    assert text.count("was not found in closed form") == 1


def test_rows_that_are_integrated_together_are_shown():
    known = mixed().links
    relation = next(f for c in known.cards for f in c.hidden if f is not None)
    together = (Combination(("rolls", "ground"), relation),)
    text = page(replace(mixed(), links=replace(known, combined=together)), "text")
    assert "Together they can be integrated:\n  x + R φ = (constant)  (rolls, ground)" in text


def test_without_a_record_nothing_is_claimed_of_the_constraints():
    text = page(Notes(derivation_of("four_bar")))
    assert "The coordinates are free" not in text
    assert r"section*{Constraints}" not in text
    assert "together with the constraints" in text


def test_a_long_virtual_form_is_named_by_its_size(monkeypatch):
    monkeypatch.setattr(notes_links_page, "REPEATED", 2)
    text = page(notes_of("mass_on_sphere"), "text")
    assert "(a sum of 3 terms) = 0  (virtual form)" in text
    assert "x² + y² + z² − R² = 0" in text


def test_nothing_of_the_user_is_a_macro():
    evil = r"\input{/etc/passwd} $x$ % & # _ ^ {"
    known = mixed().links
    hostile = tuple(replace(c, text=evil) for c in known.cards)
    said = replace(known, cards=hostile, warnings=(evil,), sentences=(evil,))
    text = page(replace(mixed(), links=said))
    assert r"\input" not in text.replace(r"\inputenc", "")
    assert text.count(escaped(evil)) == len(hostile) + 2


def test_the_context_holds_nothing_but_text():
    for context in (latex_context, text_context):
        assert is_text({**context(mixed()), "words": {}})


def links_page(name, language="en"):
    known = study_of(name).links
    shown = links(known.scene.report, known.chosen, language)
    return page(Notes(derivation_of(name), language, links=shown))


def test_numbers_are_explained_where_there_are_any():
    said = words.of("en")["growth"]
    assert said in links_page("rolling_disc_upright")
    assert said not in links_page("block_with_friction")  # of an inequality none are shown


def test_no_word_is_divided_by_the_rules_of_another_language():
    none = r"\lefthyphenmin=62"
    assert none in links_page("four_bar", "es")
    assert none not in links_page("four_bar")


LEFT = re.compile(r"\b(the|are|asked|for|and|over|of|in|rank|singular where)\b")


@pytest.mark.parametrize("name", [n for n in LINKED_SHIPPED if n != "bricard"])
def test_the_reason_of_a_formulation_is_said_in_the_language_of_the_page(name):
    known = study_of(name).links
    reasons = {known.chosen.why, *(f.why for f in formulation.available(known.scene))}
    for why in reasons:
        assert output_links.reason(why, "en") == why
        assert not LEFT.search(output_links.reason(why, "es").replace("`simulate`", ""))


def test_a_reason_without_a_translation_stays():
    assert output_links.reason("W-NEW: told; constant rank", "es") == "W-NEW: told; rango constante"


def test_warnings_are_said_in_the_language_of_the_page():
    known = study_of("four_bar").links
    at = (("q1", 0.0), ("q2", 1.5))
    freedom = replace(
        known.scene.report.freedom,
        dependencies=(Dependency("b.y", ("a.x", "a.y")),),
        singularities=(Singularity(("a.x",), at), Singularity(("a.x", "b.y"), at)),
    )
    report = replace(known.scene.report, freedom=freedom)
    assert links(report, known.chosen, "en").warnings == freedom.warnings
    said = links(report, known.chosen, "es").warnings
    assert len(said) == 3
    for before, after in zip(freedom.warnings, said, strict=True):
        assert not LEFT.search(after)
        assert after[:7] == before[:7]
        found = [re.findall(r"a\.[xy]|b\.y|q1 = 0|q2 = 1.5|\b[23]\b", w) for w in (before, after)]
        assert found[0] == found[1]


# --- multipliers


def shown_as(name):
    return list(notes_links_names.aliases(derivation_of(name)).values())


def test_one_multiplier_needs_no_index_and_long_names_give_way_to_numbers():
    assert shown_as("mass_on_sphere") == ["lambda"]
    assert shown_as("four_bar") == ["lambda_loop_x", "lambda_loop_y"]
    assert shown_as("rolling_disc_upright") == ["lambda_1", "lambda_2"]
    assert r"\lambda_{\mathrm{loop},x} a \sin q_1" in page(notes_of("four_bar"))


def test_multipliers_stand_in_the_order_of_the_constraints():
    """The first equation of this scene has the second multiplier alone."""
    turned = text_of("rolling_disc_upright").replace("  x: m\n  y: m\n", "  y: m\n  x: m\n")
    model = read(turned, "turned.yaml")
    assert [c.name for c in model.coordinates[:2]] == ["y", "x"]
    assert "= −λ_1 R cos θ − λ_2 R sin θ" in page(Notes(lagrange.derive(model)), "text")


def test_a_multiplier_takes_no_name_of_the_scene():
    derivation = derivation_of("mass_on_sphere")
    named = [replace(p, name="lambda", symbol=sp.Symbol("lambda", real=True))
             for p in derivation.model.parameters]  # fmt: skip
    model = replace(derivation.model, parameters=tuple(named[:1]))
    (alias,) = notes_links_names.aliases(replace(derivation, model=model)).values()
    assert alias == "lambda_sphere"


def test_the_card_says_which_multiplier_is_its_own():
    found = latex_context(notes_of("rolling_disc_upright"))["constraints"]
    assert [c["remarks"][0] for c in found] == [
        r"Multiplier: $\lambda_1$.", r"Multiplier: $\lambda_2$."
    ]  # fmt: skip


def test_the_matrix_form_has_the_jacobian():
    text = page(notes_of("four_bar"))
    assert r"\mathbf{Q} + \mathbf{J}^{\mathsf{T}} \boldsymbol{\lambda}" in text
    assert r"-a \sin q_1 & -b \sin q_2 & c \sin q_3" in text
    assert r"\boldsymbol{\lambda}" not in page(Notes(derivation_of("slider_pendulum")))


def test_a_wide_jacobian_is_listed_entry_by_entry():
    found = latex_context(Notes(derivation_of("andrews_squeezer")))["matrix"]
    assert not found["jacobian_whole"]
    assert "J_{13} &= -ss" not in found["jacobian"]
    entries = sum(len(f.terms) > 0 for r in derivation_of("andrews_squeezer").constraints
                  for f in r.jacobian)  # fmt: skip
    assert len(re.findall(r"J_\{\d+\} &=", found["jacobian"])) == entries


# --- identities


def number(form, values):
    known = {a: values[a.name] for a in form.ring.atoms if isinstance(a, sp.Symbol)}
    functions = tree.NUMERIC | {"pi": lambda: 3.141592653589793}
    return Evaluation(known, float, lambda name, *a: functions[name](*a)).of(form)


def drawn(model, seed):
    """Random values of every name of a model, its virtual displacements and multipliers."""
    draw = random.Random(seed)
    names = ["t"]
    for kind in ("parameters", "coordinates", "prescribed", "inputs"):
        for record in getattr(model, kind):
            names.append(record.symbol.name)
            if kind in ("coordinates", "prescribed"):
                names += [record.rate.name, record.acceleration.name, virtual_name(record.name)]
    return {n: draw.uniform(0.5, 1.5) for n in names} | {"pi": 3.141592653589793}


@pytest.mark.parametrize("name", LINKED)
def test_the_displacements_that_are_shown_keep_every_constraint(name):
    known, model = notes_of(name).links, model_of(name)
    if not known.displacements:
        pytest.skip("a long basis is not written out")
    arranger, values = arrange.of_model(model), drawn(model, 5)
    for coordinate, form in known.displacements:
        shown = notes_links_page.displaced(arranger, form)
        values[virtual_name(coordinate)] = tree.value(shown, values)
    for card in known.cards:
        if card.is_bilateral:
            for form in card.virtual:
                assert number(form, values) == pytest.approx(0, abs=1e-9)


def test_quotients_of_equal_sums_are_cancelled():
    (_, form), = notes_of("dumbbell").links.displacements  # fmt: skip
    shown = notes_links_page.displaced(arrange.of_model(model_of("dumbbell")), form)
    for term in tree.terms_of(shown):
        if isinstance(term, tree.Product):
            assert not set(term.factors) & set(term.divisors)


def test_what_differs_in_sign_is_cancelled_with_its_sign():
    a, b, c = (tree.Symbol(n) for n in "abc")
    ahead = tree.Sum((a, tree.negated(b)))
    back = tree.Sum((b, tree.negated(a)))
    values = {"a": 2.0, "b": 5.0, "c": 7.0}
    for above, below in ((ahead, back), (back, ahead), (ahead, ahead)):
        term = tree.product(Fraction(3), (above, c), (below,))
        shown = notes_links_page.cancelled(term)
        assert tree.value(shown, values) == tree.value(term, values)
        assert tree.length(shown) == 1


@pytest.mark.parametrize("name", [n for n in LINKED if n != "sleigh_speeds"])
def test_the_right_side_holds_the_virtual_work_of_the_multipliers(name):
    """Sum of lambda_k * (virtual form of row k) = sum of Q_reaction_j * delta q_j."""
    derivation = derivation_of(name)
    values = drawn(derivation.model, 6)
    for i, row in enumerate(derivation.constraints, 1):
        values[multiplier_name(row.name)] = 1 / i
    work = sum(number(r.virtual, values) / i for i, r in enumerate(derivation.constraints, 1))
    pairs = zip(derivation.equations, derivation.model.coordinates, strict=True)
    found = sum(
        number(e.reaction, values) * values[virtual_name(c.name)] for e, c in pairs if e.reaction
    )
    assert found == pytest.approx(work, rel=1e-9, abs=1e-9)


# --- TeX


def overfull(log):
    return [float(w) for w in re.findall(r"Overfull \\hbox \((\d+\.?\d*)pt", log)]


def test_a_page_with_every_kind_of_constraint_compiles(tmp_path):
    assert all(points < 6 for points in overfull(compiled(tmp_path, page(mixed()))))


@pytest.mark.slow
@pytest.mark.parametrize("language", words.WORDS)
@pytest.mark.parametrize("name", LINKED)
def test_the_pages_compile_and_fit(name, language, tmp_path):
    log = compiled(tmp_path, page(notes_of(name, language)))
    assert all(points < 6 for points in overfull(log)), overfull(log)


@pytest.mark.parametrize("target", ["latex", "text"])
@pytest.mark.parametrize("name", LINKED)
def test_every_linked_scene_fills_its_templates(name, target):
    text = page(notes_of(name, "es"), target)
    assert "None" not in text
    assert "object at 0x" not in text
    assert not re.search(r"(?<!\\)lambda", text)  # the symbol's own name, which no page shows
