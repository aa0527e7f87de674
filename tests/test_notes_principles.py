"""The pages of the formalisms, of the forces between components and of contacts."""

import re
import string
from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp
from scenes import SHIPPED, model_of
from test_generated_latex import WIDEST_EXCESS, typeset

from eomgen import study
from eomgen.mechanics import principles
from eomgen.outputs import Wish, rendered
from eomgen.render import words_contacts, words_principles
from eomgen.wanted import METHODS, Wanted

CONTACTS = ("mass_leaving_sphere", "block_with_friction", "bouncing_ball", "rope")


def page(name, method=None, target="text", language="en", steps=True):
    found = study.of_model(model_of(name), Wanted(method=method))
    (text,) = rendered(found, Wish((target,), language, steps=steps)).values()
    return text


def lines(text):
    return {" ".join(line.split()) for line in text.splitlines()}


@pytest.mark.parametrize("words", [words_principles.WORDS, words_contacts.WORDS])
def test_every_language_has_every_word(words):
    assert set(words) == {"en", "es"}
    for word, said in words["en"].items():
        fields = {f for _, f, _, _ in string.Formatter().parse(said)}
        assert fields == {f for _, f, _, _ in string.Formatter().parse(words["es"][word])}
    assert words["es"].keys() == words["en"].keys()


def test_newton_shows_each_body_the_sums_and_the_reactions():
    """As the lecture writes the vector formalism, component by component."""
    assert {
        "(1) m_A s″ = S_bob sin φ",
        "(2) 0 = N_slider − S_bob cos φ − m_A g",
        "(3) m_B (s″ + l φ″ cos φ − l φ′² sin φ) = −S_bob sin φ",
        "(4) m_B l (φ″ sin φ + φ′² cos φ) = S_bob cos φ − m_B g",
        "Coordinate s: (1) + (3)",
        "Coordinate φ: (3) l cos φ + (4) l sin φ",
        "(m_A + m_B) s″ + m_B l φ″ cos φ − m_B l φ′² sin φ = 0",
        "l φ″ + s″ cos φ + g sin φ = 0",
        "S_bob = m_B (l φ′² − s″ sin φ + g cos φ)",
        "N_slider = m_B l (φ″ sin φ + φ′² cos φ) + (m_A + m_B) g",
    } <= lines(page("slider_pendulum_free", "newton", steps=False))


def test_dalembert_shows_inertial_forces_and_coefficients():
    assert {
        "−m_B a_bob_x = −m_B (s″ + l φ″ cos φ − l φ′² sin φ)",
        "δx_bob = δs + l cos φ δφ",
        "δW_bob = −m_B g l sin φ δφ",
        "−m_B g l sin φ − m_B l s″ cos φ − m_B l² φ″ = 0",
        "l φ″ + s″ cos φ + g sin φ = 0",
    } <= lines(page("slider_pendulum_free", "dalembert", steps=False))


def test_kane_shows_partial_velocities_and_both_forces():
    assert {
        "∂v_bob/∂s′ = (1, 0)",
        "∂v_bob/∂φ′ = (l cos φ, l sin φ)",
        "F_φ′ = −m_B g l sin φ",
        "F^*_φ′ = −m_B l s″ cos φ − m_B l² φ″",
    } <= lines(page("slider_pendulum_free", "kane", steps=False))


def test_kane_speaks_of_the_declared_speeds():
    assert {"∂ω_satellite/∂p = (1, 0, 0)", "F_p = M_x"} <= lines(page("satellite", "kane"))


def test_the_first_kind_of_a_free_scene_has_cartesian_coordinates():
    assert {
        "x_bob − s − l sin φ = 0",
        "m_B y_bob″ = λ_bob_y − m_B g",
        "0 = −λ_bob_x l cos φ − λ_bob_y l sin φ",
    } <= lines(page("slider_pendulum_free", "lagrange1", steps=False))


@pytest.mark.parametrize("name", ["mass_on_sphere", "four_bar"])
def test_the_first_kind_of_a_linked_scene_is_as_ever(name):
    with_it, plain = (page(name, m).split("\nchecked:")[0] for m in ("lagrange1", None))
    assert with_it == plain


def test_the_second_kind_is_as_ever():
    with_it, plain = (page("disc_pendulum", m).split("\nchecked:")[0] for m in ("lagrange", None))
    assert with_it == plain


@pytest.mark.parametrize("method", METHODS)
def test_the_check_line_names_all_that_were_compared(method):
    text = page("disc_pendulum", method)
    said = "Newton = d'Alembert = Lagrange = Lagrange of the first kind = Kane, identical in exact"
    assert f"checked: {said}" in text
    assert "Newton = d'Alembert" not in page("disc_pendulum")


@pytest.mark.parametrize("method", METHODS)
def test_the_equations_of_motion_are_the_same_in_every_formalism(method):
    def equations(text):
        return text.split("\nEquations of motion\n")[1].split("\n\n")[0]

    assert equations(page("disc_pendulum", method)) == equations(page("disc_pendulum"))


def test_linked_displacements_bring_multipliers():
    for method in ("dalembert", "kane"):
        assert "2 λ x − m x″ = 0" in lines(page("mass_on_sphere", method))
    assert "(1) m x″ = 2 λ x" in lines(page("mass_on_sphere", "newton"))


def test_resultants_say_what_their_virtual_work_is():
    text = " ".join(page("rolling_disc_upright", "newton").split())
    assert "that of springs, dampers and multipliers along coordinates is left" in text
    assert "Ideal forces of constraint do no virtual work: " in " ".join(
        page("satellite", "newton").split()
    )


def test_names_that_the_spec_has_stay_its_own():
    """A parameter S_bob is not the rod's force."""
    model = model_of("slider_pendulum_free")
    bob = replace(model.bodies[1], name="B")
    shadowed = replace(model, bodies=(model.bodies[0], bob))
    taken = replace(shadowed.parameters[0], name="S_B")
    other = replace(taken, symbol=sp.Symbol("S_B", positive=True))
    clashing = replace(shadowed, parameters=(*shadowed.parameters, other))
    found = study.of_model(clashing, Wanted(method="newton"))
    (text,) = rendered(found, Wish(("text",))).values()
    assert "S_B_0 sin φ" in text
    assert not re.search(r"S_B [sc]", text)


@pytest.mark.parametrize("method", [m for m in METHODS if m != "lagrange"])
def test_spanish_pages_have_no_english(method):
    text = page("slider_pendulum_free", method, language="es").partition("Coordenadas")[2]
    text = text.partition("\n\n")[2]  # what the author says of the coordinates is the author's
    assert not re.search(r"\b(the|force|each|body|velocit\w+|multiplier\w*)\b", text)
    assert "de el " not in text


# --- forces between components, and named ones


def test_the_usual_notes_show_forces_between_components():
    for target, shown in (("text", "S_bob = m_B (l"), ("latex", r"S_{\mathrm{bob}} &= m_B (l")):
        assert shown in page("slider_pendulum_free", target=target)
    assert "S_bob" not in page("slider_pendulum_free", steps=False)


def test_large_and_spatial_scenes_show_none():
    for name in ("skew_arm", "furuta_pendulum", "atwood_machine"):
        assert "Forces between components" not in page(name)


def test_named_reactions_are_shown_by_component():
    assert {
        "normal_force, the force on mass:",
        "R_normal_force,z = 2 λ z",
    } <= lines(page("mass_on_sphere"))
    assert {"pin_C, the force on C:", "R_pin_C,x = λ_loop_x"} <= lines(page("four_bar"))
    assert "Q_φ = −λ_1 R cos θ" in lines(page("rolling_disc_upright"))


# --- contacts


def test_flight_and_contact_are_written_out():
    """The mass leaves the sphere where lambda falls to zero: g z = v^2, cos = 2/3 from rest."""
    assert {
        "h = x² + y² + z² − R²",
        "h′ = 2 x x′ + 2 y y′ + 2 z z′",
        "m (z″ + g) = 2 λ z",
        "2 x x″ + 2 y y″ + 2 z z″ + 2 x′² + 2 y′² + 2 z′² = 0",
        "λ = ½ m (g z − x′² − y′² − z′²)/(x² + y² + z²)",
        "N = 2 λ √(x² + y² + z²)",
        "m Δz′ = 2 P z",
        "h′ (after) = −e h′ (before)",
    } <= lines(page("mass_leaving_sphere"))


def test_stick_and_slip_are_written_out():
    assert {
        "m x″ = −λ sin θ + F_t cos θ",
        "m (y″ + g) = λ cos θ + F_t sin θ",
        "v_t = x′ cos θ + y′ sin θ",
        "λ = m g cos θ",
        "N = λ",
        "v_t = 0",
        "μ N ≥ |F_t|",
        "F_t = −μ N sign(v_t)",
    } <= lines(page("block_with_friction"))


@pytest.mark.parametrize("name", CONTACTS)
def test_contacts_are_shown_in_spanish_too(name):
    text = page(name, language="es")
    part = text.split("\nContactos\n")[1].split("\ncomprobado")[0]
    assert not re.search(r"\b(the|gap|force|rate|contact)\b", part)


def test_the_incline_is_printed_as_in_the_lecture():
    assert "y − x tan θ = 0" in lines(page("block_on_incline"))
    assert r"y - x \tan\theta" in page("block_on_incline", target="latex")


# --- typeset

PRINTED = ("slider_pendulum", "disc_pendulum", "skew_arm", "four_bar", "satellite",
           "mass_on_sphere", "tumbling_body", "particle_polar")  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("method", [m for m in METHODS if m != "lagrange"])
@pytest.mark.parametrize("name", PRINTED)
def test_pages_of_formalisms_are_typeset(name, method, tmp_path):
    for language in ("en", "es"):
        file = Path(tmp_path) / f"{language}.tex"
        file.write_text(page(name, method, "latex", language), encoding="utf-8")
        log = typeset(file)
        found = re.findall(r"^Overfull \\[hv]box \(([\d.]+)pt", log, re.MULTILINE)
        assert max(map(float, found), default=0.0) <= WIDEST_EXCESS
        assert "LaTeX Warning" not in log


@pytest.mark.slow
@pytest.mark.parametrize("name", SHIPPED)
def test_every_scene_has_every_page_that_applies(name):
    if name in ("bricard", "ball_joints"):
        pytest.skip("its closed forms take seconds each")
    for method in principles.applicable(model_of(name)):
        assert "checked: " in page(name, method)
