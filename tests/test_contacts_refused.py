"""Friction whose point, normal or force is not determined is refused with the reason."""

from dataclasses import replace

import pytest
from test_contacts import HEAD, Scene, machine_of
from test_contacts_friction import GRAVITY, INCLINE, TWO_GUIDES, rubbing, scene

from eomgen import compile_contacts
from eomgen.errors import UsageError
from eomgen.mechanics import contacts, contacts_modes
from eomgen.spec import read


def refuse(text, match, *names):
    model = rubbing(*names)(read(HEAD + text, "friction.yaml"))
    with pytest.raises(UsageError, match=match):
        compile_contacts.functions(machine_of(model))


DISC = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, r: 0.7 m, g: 9.81 m/s^2, mu: 0.5}
coordinates: {x: m, y: m, phi: rad}
points: {A: "[x, y]"}
bodies: {disc: {mass: m, at: A, angle: phi, inertia: m*r^2/2}}
constraints: {floor: {unilateral: y >= r, friction: mu}}
"""
PENDULUM = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 0.7 m, g: 9.81 m/s^2, mu: 0.5}
coordinates: {s: m, phi: rad}
bodies:
  slider: {mass: m, at: "[s, 0]"}
  bob: {mass: m, at: "[s, 0] + l*[sin(phi), -cos(phi)]"}
constraints: {stop: {unilateral: s >= 0, friction: mu}}
"""
ALONE = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, g: 9.81 m/s^2, mu: 0.5}
coordinates: {s: m}
bodies: {slider: {mass: m, at: "[s, 0]"}}
constraints: {stop: {unilateral: s >= 0, friction: mu}}
"""
TWO = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, g: 9.81 m/s^2, mu: 0.5}
coordinates: {x: m, y: m, u: m, v: m}
bodies: {first: {mass: m, at: "[x, y]"}, second: {mass: m, at: "[u, v]"}}
constraints: {apart: {unilateral: (x - u)^2 + (y - v)^2 >= (m*g/(m*g))^2, friction: mu}}
"""
TWO = TWO.replace("g: 9.81 m/s^2", "g: 9.81 m/s^2, d: 1 m").replace("(m*g/(m*g))^2", "d^2")
ROOT = """space: plane
gravity: [0, -g]
parameters: {m: 2 kg, g: 9.81 m/s^2, d: 5 m, mu: 0.5}
coordinates: {x: m, y: m}
range: {x: [2*d, 3*d]}
bodies: {block: {mass: m, at: "[x, y]"}}
constraints: {hill: {unilateral: y >= sqrt(d*(x - d)), friction: mu}}
"""
REFUSED = [
    (DISC, "has no point to act on: 'y >= r' is no function of the place of one particle"),
    (PENDULUM, "may act on slider or bob"),
    (ALONE, "has no direction: slider does not move freely in plane"),
    (TWO, "has no point to act on"),
    # a place that runs below the disc is not on the disc
    (DISC.replace("A: ", 'B: "[x, y - r]", A: '), "has no point to act on"),
    (ROOT.replace("range: {x: [2*d, 3*d]}", ""), "no state was found at which the contacts"),
]


@pytest.mark.parametrize(("text", "match"), REFUSED)
def test_friction_without_a_touching_point_is_refused(text, match) -> None:
    refuse(text, match)


def test_a_gap_is_looked_at_where_it_is_defined() -> None:
    """In the declared range; without one, at those of the states that are drawn."""
    for text in (ROOT, ROOT.replace("range: {x: [2*d, 3*d]}", "").replace("x - d", "x + d/5")):
        (contact,) = contacts.of(Scene(text).machine)
        assert contact.touch.point == "block"


def test_points_that_move_alike_are_one() -> None:
    text = ROOT.replace("range:", 'points: {corner: "[x + d/9, y]"}\nrange:')
    (contact,) = contacts.of(Scene(text).machine)
    assert contact.touch.point == "block"


def test_friction_on_one_of_two_particles_finds_it() -> None:
    text = TWO.replace("(x - u)^2 + (y - v)^2 >= d^2", "v >= 0")
    found = Scene(text)
    state = [0, 0, 1, 0, 1, 1, -2, 0]
    expected = [0, -GRAVITY, 0.5 * GRAVITY, 0]
    assert found.call("accelerations_slip_minus", state) == pytest.approx(expected)
    (contact,) = contacts.of(found.machine)
    assert contact.touch.point == "second"


def test_a_named_point_of_a_turning_body_is_found_and_its_mass_centre_is_not() -> None:
    (contact,) = contacts.of(scene("rod").machine)
    assert contact.touch.point == "P"
    text = DISC.replace("y >= r", "y - r*sin(phi) >= 0")
    text = text.replace('A: "[x, y]"', 'A: "[x, y]", B: {on: disc, at: "[0, 0]"}')
    refuse(text, "has no point to act on")
    refuse(text.replace("y - r*sin(phi) >= 0", "y >= r"), "has no point to act on")


def test_friction_of_a_pin_or_a_rate_is_refused() -> None:
    pin = INCLINE.replace("constraints:", "points: {A: 'block', B: [0, 0]}\nconstraints:")
    pin = pin.replace("y - x*tan(theta) = 0", "A = B")
    refuse(pin, "friction of incline is not supported: it needs a surface", "incline")
    rate = INCLINE.replace("holonomic: y - x*tan(theta) = 0", "nonholonomic: y' = x'*tan(theta)")
    refuse(rate, "friction of incline is not supported: it needs a surface", "incline")


def test_friction_of_a_dropped_row_is_refused() -> None:
    model = rubbing("incline")(read(HEAD + INCLINE, "friction.yaml"))
    found = replace(machine_of(model), kept=())
    with pytest.raises(UsageError, match="friction of incline is not determined"):
        compile_contacts.functions(found)


def test_two_sliding_guides_are_refused() -> None:
    refuse(TWO_GUIDES, "floor and wall both have friction", "floor", "wall")


def test_more_than_three_contacts_are_refused_by_the_modes() -> None:
    found = scene("on top")
    (contact,) = contacts.of(found.machine)
    with pytest.raises(UsageError, match="two modes would be called"):
        contacts_modes.modes(found.machine, [contact, contact])
    with pytest.raises(UsageError, match="at most 3"):
        contacts_modes.modes(found.machine, [contact] * 4)
