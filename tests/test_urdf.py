"""What `eomgen import` makes of a robot, and what it says of what it leaves out."""

from decimal import Decimal
from fractions import Fraction

import pytest
from bad_urdfs import BASE, HAND, changed, extended, grown
from robots import FOLDER

from eomgen import spec
from eomgen.spec.reader import Point
from eomgen.urdf import imported
from eomgen.urdf.names import Names, identifier
from eomgen.urdf.numbers import direction, number, written
from eomgen.urdf.wishes import Wishes

GOLDEN = FOLDER / "gripper.yaml"
ALL = tuple(sorted(FOLDER.glob("*.urdf")))


def made_of(text, **wishes):
    return imported(text.encode(), "test.urdf", Wishes(**wishes))


def model_of(text, **wishes):
    return spec.read(made_of(text, **wishes).text, "test.yaml")


def said(text, **wishes):
    return [note.text for note in made_of(text, **wishes).notes]


def test_the_spec_of_a_gripper_is_the_one_shown():
    made = imported(GOLDEN.with_suffix(".urdf").read_bytes(), "gripper.urdf", Wishes())
    assert made.text == GOLDEN.read_text(encoding="utf-8")


@pytest.mark.parametrize("path", ALL, ids=lambda path: path.stem)
def test_every_line_fits_and_every_parameter_is_used(path):
    made = imported(path.read_bytes(), path.name, Wishes())
    assert all(len(line) <= 100 for line in made.text.splitlines())
    model = spec.read(made.text, "x.yaml")
    places = [*(b.frame.origin for b in model.bodies), *(b.com for b in model.bodies)]
    formulas = [*model.gravity, *(c for p in places for c in p.components)]
    formulas += [c for p in model.points for c in p.place.components]
    formulas += [f for b in model.bodies for f in (b.mass, *b.inertia)]
    formulas += [f for b in model.bodies for t in b.frame.turns for f in t.formulas]
    formulas += [f for d in model.dampers for f in (d.along, d.damping)]
    used = set().union(*(f.free_symbols for f in formulas))
    assert {p.symbol for p in model.parameters} <= used
    assert {i.symbol for i in model.inputs} == {d.force for d in model.drives}


def test_a_joint_is_a_coordinate_with_motor_damper_range_and_start():
    model = model_of(BASE)
    assert [c.name for c in model.coordinates] == ["q_hinge"]
    assert [(d.name, str(d.along), str(d.force)) for d in model.drives] == [
        ("hinge", "q_hinge", "tau_hinge")
    ]
    assert [(str(d.along), str(d.damping)) for d in model.dampers] == [("q_hinge", "d_hinge")]
    assert model.range == {"q_hinge": (-1, 1)}
    assert model.initial == {"q_hinge": 0, "q_hinge'": 0}


def test_what_starts_outside_its_range_starts_in_the_middle():
    model = model_of(changed('lower="-1"', 'lower="0.5"'))
    assert model.initial["q_hinge"] == Fraction(3, 4)


def test_a_number_stays_the_decimal_that_it_is():
    model = model_of(changed("0 0 0.1", "1e-3 1.57079632679 -.5"))
    values = {p.name: str(p.value) for p in model.parameters}
    assert values["c_arm_x"] == "1/1000"
    assert values["c_arm_y"] == "157079632679/100000000000"
    assert values["c_arm_z"] == "-1/2"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("0", "0"), ("-0.0", "0"), ("0e9", "0"), ("1.50", "1.5"), ("+2", "2"), (".5", "0.5"),
        ("-3.", "-3"), ("1e-3", "0.001"), ("1e-9", "1e-9"), ("-12e-9", "-1.2e-8"),
        ("123456.5", "123456.5"), ("12345678", "1.2345678e7"), ("1E+2", "100"),
    ],
)  # fmt: skip
def test_numbers_are_written_as_the_language_reads_them(text, shown):
    assert written(number(text, Point(1, 1))) == shown


@pytest.mark.parametrize(
    ("axis", "shown"),
    [
        ("0 0 -2", ("0", "0", "-1")),
        ("3 0 4", ("0.6", "0", "0.8")),
        ("1 2 2", ("1/3", "2/3", "2/3")),
        ("0 1 -1", ("0", "1/sqrt(1^2 + 1^2)", "-1/sqrt(1^2 + 1^2)")),
    ],
)
def test_a_direction_has_length_one(axis, shown):
    assert direction(tuple(Decimal(c) for c in axis.split())) == shown


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ("arm", "arm"), ("left-arm", "left_arm"), ("link 1.0", "link_1_0"), ("1", "link_1"),
        ("t", "t_"), ("sin", "sin_"), ("world", "world_"), ("\u00e9paule", "epaule"),
        ("\u624b", "link"), ("__", "link"), ("_a", "_a"), ("a" * 90, "a" * 40),
    ],
)  # fmt: skip
def test_a_name_becomes_an_identifier(given, name):
    assert identifier(given, "link") == name


def test_equal_names_are_numbered_and_told():
    names = Names()
    assert [names.of(n, "link") for n in ("a-b", "a_b", "a.b")] == ["a_b", "a_b_2", "a_b_3"]
    text = extended(HAND).replace('"arm"', '"h-a"').replace('"hand"', '"h.a"')
    assert said(text)[:1] == ["link 'h-a' is called h_a"]
    assert "link 'h.a' is called h_a_2" in said(text)


def test_what_has_no_meaning_is_named_once_with_its_place():
    shape = "<visual/><visual/><collision/></link>"
    text = changed("</link>", shape).replace("</robot>", "<gazebo/><transmission/></robot>")
    text = text.replace("damping", 'friction="0.2" damping').replace("<axis", "<calibration/><axis")
    made = made_of(text)
    assert [(n.line, n.text) for n in made.notes] == [
        (10, "'visual' in link is ignored (2 times)"),
        (10, "'collision' in link is ignored"),
        (15, "'calibration' in joint is ignored"),
        (16, "'effort' of 'limit' is ignored"),
        (16, "'velocity' of 'limit' is ignored"),
        (17, "'friction' of 'dynamics' is ignored"),
        (19, "'gazebo' in robot is ignored"),
        (19, "'transmission' in robot is ignored"),
    ]
    assert all(f"# Line {n.line}: {n.text}." in made.text for n in made.notes)


def test_no_friction_is_nothing_to_tell():
    assert not any("friction" in s for s in said(changed("damping", 'friction="0.0" damping')))


@pytest.mark.parametrize("kind", ["fixed", "floating"])
def test_elements_without_meaning_in_a_joint_are_named(kind):
    text = grown("</joint>", '<axis xyz="x"/><mimic joint="nobody"/></joint>').replace(
        "continuous", kind
    )
    assert f"'axis' of a {kind} joint is ignored" in said(text)
    assert f"'mimic' of a {kind} joint is ignored" in said(text)


def test_a_follower_has_the_formula_of_its_leader_and_no_motor():
    follower = '<mimic joint="hinge" multiplier="-2" offset="0.1"/></joint>'
    model = model_of(grown("</joint>", follower))
    assert [c.name for c in model.coordinates] == ["q_hinge"]
    assert [i.name for i in model.inputs] == ["tau_hinge"]
    (turn,) = model.bodies[-1].frame.turns
    assert str(turn.angle) == "1/10 - 2*q_hinge"


def test_a_leaf_without_mass_and_turn_is_a_point():
    tip = '<link name="tip"/><joint name="j" type="fixed"><parent link="arm"/><child link="tip"/>'
    straight = extended(tip + '<origin xyz="0 0 1"/></joint>')
    assert [p.name for p in model_of(straight).points] == ["tip"]
    turned = extended(tip + '<origin rpy="0 0 1"/></joint>')
    assert [b.name for b in model_of(turned).bodies] == ["arm", "tip"]


def test_turned_axes_of_inertia_are_a_body_of_their_own():
    model = model_of(changed('rpy="0 0 0"', 'rpy="0.1 0.2 0.3"'))
    frame, inertial = model.bodies
    assert (frame.name, frame.mass, inertial.name) == ("arm", 0, "arm_inertial")
    assert [str(t.angle) for t in inertial.frame.turns] == ["3/10", "1/5", "1/10"]  # z, y, x


def test_angles_near_multiples_of_a_twelfth_turn_are_rounded_when_asked():
    text = changed('<origin xyz="0 0 1"/>', '<origin rpy="1.57079632679 -2.61799 1e-12"/>')
    (note,) = [n for n in said(text) if "multiple" in n]
    assert note == "an angle near a multiple of pi/12 is kept as it is (see --within) (3 times)"
    exact = [str(t.angle) for t in model_of(text, within=Decimal("1e-9")).bodies[0].frame.turns]
    assert exact == ["-261799/100000", "pi/2", "q_hinge"]
    rough = [str(t.angle) for t in model_of(text, within=Decimal("1e-5")).bodies[0].frame.turns]
    assert rough == ["-5*pi/6", "pi/2", "q_hinge"]


def test_a_floating_base_has_three_lengths_and_a_quaternion():
    model = model_of(grown(), floating_base=True)
    parts = [f"e_base_{i}" for i in range(4)]
    names = ["x_base", "y_base", "z_base", *parts, "q_hinge", "q_wrist"]
    assert [c.name for c in model.coordinates] == names
    assert [i.name for i in model.inputs] == ["tau_hinge", "tau_wrist"]
    assert model.initial["e_base_0"] == 1


def test_a_floating_base_turns_by_angles_when_asked():
    model = model_of(grown(), floating_base=True, euler=True)
    names = ["x_base", "y_base", "z_base", "yaw_base", "pitch_base", "roll_base"]
    assert [c.name for c in model.coordinates] == [*names, "q_hinge", "q_wrist"]
    assert [str(t.axis) for t in model.bodies[0].frame.turns] == [
        "(0, 0, 1)", "(0, 1, 0)", "(1, 0, 0)"
    ]  # fmt: skip


def test_the_implied_names_of_a_quaternion_are_kept_free():
    text = grown().replace('"hand"', '"e_base_0"')
    names = [c.name for c in model_of(text, floating_base=True).coordinates]
    assert names[3:7] == [f"e_base_2_{i}" for i in range(4)]


def test_the_world_is_called_the_world():
    assert not any("called" in s for s in said(BASE.replace('"base"', '"world"')))


def test_an_impossible_inertia_is_mended_when_asked():
    text = changed('ixx="0.1"', 'ixx="0.3"')
    values = {p.name: p.value for p in model_of(text, mend=True).parameters}
    assert float(values["I_arm_xx"]) == pytest.approx(0.4, rel=1e-3)
    assert float(values["I_arm_yy"]) == pytest.approx(0.2, rel=1e-3)
    (note,) = [n for n in said(text, mend=True) if "raised" in n]
    assert note == "the moments of inertia of 'arm' are raised by 0.1001 kg m^2"


def test_a_possible_inertia_is_left_alone():
    assert made_of(BASE, mend=True).text == made_of(BASE).text
