"""Which contacts are closed together: the modes, what they say, and what is left out."""

from dataclasses import replace

import pytest
from test_contacts import BALL, HEAD, Scene, machine_of, scene

from eomgen import compile_contacts
from eomgen.algebra.ldl import SingularMassMatrix
from eomgen.errors import UsageError
from eomgen.mechanics import contacts, contacts_modes
from eomgen.spec import read

CORNER = """space: plane
gravity: [0, -g]
parameters: {m: 0.3 kg, g: 9.81 m/s^2, L: 2 m, e: 0.8}
coordinates: {x: m, y: m}
bodies: {ball: {mass: m, at: "[x, y]"}}
constraints:
  floor: {unilateral: y >= 0, restitution: e}
  left: {unilateral: x >= 0}
  right: {unilateral: x <= L}
"""


def test_every_subset_of_contacts_is_a_mode_unless_its_forces_are_not_determined() -> None:
    found = Scene(CORNER)
    touching = compile_contacts.Touching(found.machine)
    assert [m.active for m in touching.modes] == [
        (), ("right",), ("left",), ("floor",), ("floor", "right"), ("floor", "left"),
    ]  # fmt: skip
    out = contacts_modes.left_out(found.machine, touching.contacts)
    assert [m.active for m in out] == [("left", "right"), ("floor", "left", "right")]
    assert "contact_forces" not in found.functions  # of all three together
    corner = [0, 0, -0.5, 0]
    assert list(found.call("accelerations_floor_contact_left_contact", corner)) == [0, 0]
    forces = found.call("contact_forces_floor_contact", corner)
    assert list(forces) == pytest.approx([0.3 * 9.81, 0, 0])
    mode = touching.modes[4]
    assert mode.events == ("normal force of floor", "gap of left", "normal force of right")
    about = found.functions[f"events_{mode.name}"].about
    assert all(event in about for event in mode.events)
    assert list(found.call(f"events_{mode.name}", [0.5, 0, 1, 0])) == pytest.approx([2.943, 0.5, 0])


def test_forces_of_contacts_that_are_closed_together() -> None:
    """A push of 0.3 g into the corner: the floor bears the weight, the wall the push."""
    text = CORNER.replace("  right: {unilateral: x <= L}\n", "")
    found = Scene(text.replace("gravity: [0, -g]", "gravity: [-g/3, -g]"))
    forces = found.call("contact_forces", [0, 0, 0, 0])
    assert list(forces) == pytest.approx([0.3 * 9.81, 0.1 * 9.81])


def test_a_sticking_contact_does_not_share_a_wall() -> None:
    """The wall may bear what friction bears, so neither force is determined."""
    text = CORNER.replace("e: 0.8", "e: 0.8, mu: 0.3").replace("restitution: e", "friction: mu")
    found = Scene(text.replace("  right: {unilateral: x <= L}\n", ""))
    touching = compile_contacts.Touching(found.machine)
    out = contacts_modes.left_out(found.machine, touching.contacts)
    assert [m.name for m in out] == ["floor_stick_left_contact"]
    assert len(touching.modes) == 7


def test_an_impact_is_only_known_where_restitution_is_given() -> None:
    names = Scene(CORNER).functions
    assert [n for n in names if n.startswith("impact")] == ["impact_floor"]


def test_contacts_that_never_close_together_stop_the_program_only_where_they_meet() -> None:
    """Dependent at some states only: the mode is there, and refuses such a state."""
    text = CORNER.replace("x >= 0}", "x + y*y/L >= 0}").replace("  right: {unilateral: x <= L}", "")
    found = Scene(text.replace("y >= 0,", "y + x*x/L >= 0,"))
    name = "accelerations_floor_contact_left_contact"
    assert list(found.call(name, [0, 0, 0, 0])) == [0, 0]
    with pytest.raises(SingularMassMatrix):
        found.call(name, [1, 1, 0, 0])


def test_too_many_contacts_are_refused() -> None:
    more = "".join(f"  more{i}: {{unilateral: y + x/{i + 2} >= 0}}\n" for i in range(2))
    with pytest.raises(UsageError, match="modes of 5 contacts .floor, left, right, more0, more1"):
        Scene(CORNER + more)


def test_a_scene_without_contacts_has_no_functions_of_contacts() -> None:
    plain = replace(scene("ball").model, constraints=())
    assert compile_contacts.functions(machine_of(plain)) == ()


def test_speeds_beside_contacts_are_refused() -> None:
    spun = read(HEAD + BALL.partition("constraints")[0] + "speeds: {u1: x', u2: y'}\n", "s.yaml")
    model = replace(spun, constraints=scene("ball").model.constraints)
    with pytest.raises(UsageError, match="speeds beside contacts"):
        contacts.of(machine_of(model))


def test_modes_say_what_holds() -> None:
    flight, contact = compile_contacts.Touching(scene("ball").machine).modes
    assert (flight.name, flight.meaning) == ("flight", "floor: no force")
    assert (contact.name, contact.active, contact.sticking) == ("contact", ("floor",), ())
    assert contact.meaning == "floor: gap'' = 0, normal force without friction"
    assert flight.events == ("gap of floor",)
