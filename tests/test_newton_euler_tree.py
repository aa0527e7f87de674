"""The tree of joints, who carries a point, what is left out, and the program's functions."""

import pytest
from scenes import machine_of, model_of, samples_of
from test_newton_euler import of_text, scene_of

from eomgen import compile_reactions
from eomgen.algebra.arithmetic import FLOAT
from eomgen.checks.evaluation import singly
from eomgen.interpreter import run
from eomgen.mechanics import newton_euler, newton_euler_tree, newton_euler_unknown

HEAD = """\
eom: 1
system: Own
space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 0.5 m, k: 3 N/m, g: 10 m/s^2}
"""


def names(scene):
    return [r.name for r in newton_euler.reactions(scene)]


def reasons(scene):
    return {left.name: left.because for left in newton_euler_unknown.left_out(scene)}


@pytest.mark.parametrize(
    ("name", "joints"),
    [
        ("cart_three_pendulums", ["world/cart", "cart/bob_1", "bob_1/bob_2", "bob_2/bob_3"]),
        ("gyroscope", ["world/outer", "outer/inner", "inner/rotor", "inner/weight"]),
        ("four_bar", ["world/crank", "world/rocker", "crank/coupler"]),
        ("slider_crank", ["world/crank", "world/slider", "crank/connecting_rod"]),
        ("snakeboard", ["world/board", "board/rotor", "board/back", "board/front"]),
        ("spatial_rod", ["world/slider", "slider/rod"]),
    ],
)
def test_parents(name, joints):
    tree = newton_euler_tree.joints(model_of(name))
    assert [newton_euler_unknown.name_of(j) for j in tree] == joints


def test_a_bob_at_the_end_of_a_rod_hangs_on_it_and_bears_the_next():
    scene = of_text(
        HEAD
        + """\
coordinates: {a: rad, b: rad}
points:
  O: [0, 0]
  P: "O + l*[sin(a), -cos(a)]"
  Q: "P + l*[sin(b), -cos(b)]"
bodies:
  last: {rod: [P, Q], mass: m}
  bob: {mass: m, at: P}
  first: {rod: [O, P], mass: m}
"""
    )
    assert names(scene) == ["world/first", "first/bob", "bob/last"]


def test_rods_that_place_each_other_in_a_circle_are_still_a_tree():
    scene = of_text(
        HEAD
        + """\
coordinates: {x: m, y: m, z: m}
points: {A: "[x, 0]", B: "[0, y]", C: "[z, z]"}
bodies: {a: {rod: [A, B], mass: m}, b: {rod: [B, C], mass: m}, c: {rod: [C, A], mass: m}}
"""
    )
    assert names(scene) == ["world/a", "a/b", "b/c"]


@pytest.mark.parametrize(
    ("point", "carrier"),
    [
        ("tip", newton_euler_tree.Carrier("left")),
        ("hook", newton_euler_tree.Carrier(None)),
        ("base", newton_euler_tree.Carrier("base")),
    ],
)
def test_carriers_in_a_tree(point, carrier):
    assert newton_euler_tree.carrier(model_of("spatial_tree"), point) == carrier


def test_carriers_of_a_linkage():
    model = model_of("four_bar")
    found = {p: newton_euler_tree.carrier(model, p).body for p in ("A", "B", "C", "Cr", "D")}
    assert found == {"A": None, "B": "crank", "C": "coupler", "Cr": "rocker", "D": None}


def test_along_a_coordinate_the_joint_is_left_out():
    found = reasons(machine_of("slider_spring_pendulum"))
    assert found == {"world/slider": ("spring 1 acts along s",)}
    assert names(machine_of("slider_spring_pendulum")) == ["slider/bob"]


def test_a_load_along_the_angle_of_one_joint_acts_in_it():
    """Spring and damper of the elbow are moments about its skew axis; nothing is left to guess."""
    scene = machine_of("skew_arm")
    assert names(scene) == ["world/upper", "upper/fore"]
    assert reasons(scene) == {}


def test_a_load_along_an_absolute_angle_is_felt_above():
    assert names(machine_of("slider_pendulum")) == []
    because = reasons(machine_of("slider_pendulum"))["world/slider"]
    assert "damper 2 acts along phi" in because


MASSLESS = (
    HEAD
    + """\
coordinates: {s: m, phi: rad, q: rad}
points:
  A: "[s, 0]"
  B: A + l*[sin(phi), -cos(phi)]
  C: PLACE + l*[sin(q), -cos(q)]
bodies:
  slider: {mass: m, at: A}
  bob: {mass: m, at: B}
  other: {mass: m, at: "[2*l, l*q]"}
forces: [{on: C, force: [0, k*l]}]
"""
)


def test_a_force_on_a_massless_point_reaches_what_carries_it():
    found = reasons(of_text(MASSLESS.replace("PLACE", "B")))
    assert found.keys() == {"world/slider", "world/other", "slider/bob"}
    assert found["slider/bob"] == ("force 1 acts on C, which no body carries",)


def test_a_force_on_a_massless_point_leaves_the_rest():
    scene = of_text(MASSLESS.replace("PLACE", "A"))
    assert names(scene) == ["slider/bob"]


def test_a_body_placed_by_two_is_left_out_with_both():
    found = reasons(machine_of("watt_governor"))
    assert found.keys() == {"world/right_ball", "world/left_ball", "right_ball/sleeve"}


def test_what_is_above_a_loop_is_known():
    scene = of_text(
        HEAD
        + """\
coordinates: {s: m, a: rad, b: rad}
points:
  A: "[s, 0]"
  P: A + l*[sin(a), -cos(a)]
  Q: A + l*[sin(b), -cos(b)]
bodies:
  slider: {mass: m, at: A}
  left: {mass: m, at: P}
  right: {mass: m, at: Q}
  middle: {mass: m, at: P/2 + Q/2}
"""
    )
    assert names(scene) == ["world/slider"]


@pytest.mark.slow
def test_dependent_constraints_leave_their_joints_out():
    found = reasons(scene_of("bricard"))
    assert set(found) == {f"{a}/{b}" for a, b in zip(
        ("world", "bar_1", "bar_2", "bar_3", "bar_4"),
        ("bar_1", "bar_2", "bar_3", "bar_4", "bar_5"), strict=True)}  # fmt: skip
    assert all("depends on others" in b for because in found.values() for b in because)


@pytest.mark.parametrize("name", ["block_with_friction", "bouncing_ball", "rope"])
def test_a_contact_leaves_its_joint_out(name):
    assert names(scene_of(name)) == []
    assert len(reasons(scene_of(name))) == 1


def test_what_hangs_on_a_point_of_a_body_is_about_that_point():
    found = {r.on: r.about for r in newton_euler.reactions(machine_of("flyball_governor"))}
    assert found["right_ball"] == "right_end"
    assert found["right_rod"] == "origin of right_rod"
    assert found["slider"] == "mass centre of slider"


DRIVEN = """\
coordinates: {s: m, phi: rad}
points:
  A: "[s, 0]"
  B: A + l*[sin(phi), -cos(phi)]
bodies: {slider: {mass: m, at: A}, bob: {mass: m, at: B}}
constraints: {drive: {holonomic: phi = k/m*l*t}}
initial: {s: 0, s': 0}
"""


def test_a_relation_below_is_named_above():
    text = HEAD.replace("k: 3 N/m", "k: 3 kg/(m*s)") + DRIVEN
    found = {r.on: r.together_with for r in newton_euler.reactions(of_text(text))}
    assert found == {"slider": ("bob",), "bob": ()}


def test_bodies_that_a_relation_ties_are_named():
    found = {r.on: r.together_with for r in newton_euler.reactions(scene_of("dumbbell"))}
    assert found == {"first": ("second",), "second": ("first",)}


@pytest.mark.parametrize("name", ["skew_arm", "double_pendulum", "four_bar", "duffing_by_energy"])
def test_functions_are_the_reactions(name):
    scene = scene_of(name)
    functions = {f.name: f for f in compile_reactions.functions(scene)}
    found = newton_euler.reactions(scene)
    wanted = {"joint_forces": [r.force for r in found], "joint_moments": [r.moment for r in found]}
    if scene.kinematics.dimensions == 1:
        del wanted["joint_moments"]
    assert functions.keys() == wanted.keys()
    samples = samples_of(name)
    for at, _ in singly(scene, samples, FLOAT, 2):
        arguments = {"time": [0], "state": [0] * 2 * len(scene.model.coordinates)}
        arguments |= {"inputs": [0] * 9, "parameters": [0] * 99}
        for leaf in scene.leaves:
            arguments[leaf.datum.argument][leaf.datum.index] = at.leaves[leaf]
        for key, rows in wanted.items():
            assert functions[key].shape == (len(rows), len(rows[0]))
            values = run(functions[key], arguments, FLOAT)
            assert values == pytest.approx(at.nodes([v for row in rows for v in row]), rel=1e-13)
            assert all(r.name in functions[key].about for r in found)


def test_the_functions_say_what_is_not_determined():
    forces, moments = compile_reactions.functions(machine_of("slider_spring_pendulum"))
    assert forces.about.endswith(": slider/bob; not determined: world/slider")
    assert moments.about.endswith(": slider/bob about A; not determined: world/slider")


def test_no_functions_where_nothing_is_known():
    assert compile_reactions.functions(machine_of("central_force")) == ()
    assert compile_reactions.functions(machine_of("half_car")) == ()


def test_the_first_end_of_a_rod_belongs_to_it_where_it_moves():
    scene = of_text(
        HEAD
        + """\
coordinates: {s: m, phi: rad}
points: {A: "[s, 0]", B: "A + l*[sin(phi), -cos(phi)]"}
bodies: {rod: {rod: [A, B], mass: m}}
forces: [{on: A, force: [k*l, 0]}]
"""
    )
    assert newton_euler_tree.carrier(scene.model, "A") == newton_euler_tree.Carrier("rod")
    assert names(scene) == ["world/rod"]


def test_a_coordinate_belongs_to_the_first_joint_that_it_moves():
    own = {
        j.body: {s.name for s in j.own} for j in newton_euler_tree.joints(model_of("snakeboard"))
    }
    assert own == {
        "board": {"x", "y", "theta"}, "rotor": {"psi"}, "back": {"phi_b"}, "front": {"phi_f"},
    }  # fmt: skip


def test_a_moment_in_the_plane_has_no_axes():
    scene = of_text(
        HEAD
        + """\
coordinates: {phi: rad}
bodies: {bar: {mass: m, inertia: m*l^2, frame: {angle: phi}, com: [l, 0]}}
moments: [{on: bar, in: bar, moment: k*l^2}]
"""
    )
    assert names(scene) == ["world/bar"]
