"""Equilibria against force balances by hand: every number here is found without the tool."""

import json
from functools import cache
from math import acos, atan, atan2, cos, hypot, isclose, pi, sin, sqrt

import pytest
from scenes import model_of
from spec_samples import FOUR_BAR

from eomgen.algebra import normal
from eomgen.analysis import equilibrium_find
from eomgen.analysis.equilibrium import equations, solve
from eomgen.errors import UsageError
from eomgen.spec import read

PLANE = "eom: 1\nsystem: Scene\nspace: plane\ngravity: [0, -g]\n"
SCENES = {
    "pendulum": """
parameters: {m: 2 kg, l: 0.5 m, g: 9.81 m/s^2}
coordinates: {phi: rad}
inputs: {tau: N*m}
bodies: {bob: {mass: m, at: "l*[sin(phi), -cos(phi)]", angle: phi}}
moments: [{on: bob, moment: tau}]
""",
    "double": """
parameters: {m: 2 kg, M: 3 kg, l: 0.5 m, L: 0.7 m, g: 9.81 m/s^2}
coordinates: {a: rad, b: rad}
points: {A: "l*[sin(a), -cos(a)]", B: "A + L*[sin(a + b), -cos(a + b)]"}
bodies: {one: {mass: m, at: A}, two: {mass: M, at: B}}
""",
    "elastic": """
parameters: {m: 1 kg, k: 40 N/m, l: 0.6 m, g: 9.81 m/s^2}
coordinates: {x: m, y: m}
points: {O: [0, 0], P: "[x, y]"}
bodies: {bob: {mass: m, at: P}}
springs: [{between: [O, P], stiffness: k, free_length: l}]
""",
    "hoop": """
parameters: {m: 1 kg, R: 0.3 m, Omega: 20 rad/s, g: 9.81 m/s^2}
coordinates: {theta: rad}
bodies: {bead: {mass: m, at: "R*[sin(theta)*cos(Omega*t), sin(theta)*sin(Omega*t), -cos(theta)]"}}
""",
    "torsion": """
parameters: {m: 2 kg, l: 0.5 m, g: 10 m/s^2, k: {unit: N*m}}
coordinates: {phi: rad}
bodies: {bob: {mass: m, at: "l*[sin(phi), cos(phi)]"}}
springs: [{along: phi, stiffness: k}]
""",
    "linked": """
parameters: {m: 2 kg, l: 0.5 m, g: 9.81 m/s^2}
coordinates: {x: {unit: m, role: free}, y: {unit: m, role: linked}}
bodies: {bob: {mass: m, at: "[x, y]"}}
constraints: {rod: {holonomic: x^2 + y^2 = l^2}}
""",
    "ladder": """
parameters: {m: 12 kg, l: 3 m, g: 9.81 m/s^2}
coordinates: {a: rad, x: {unit: m, role: linked}, y: {unit: m, role: linked}}
inputs: {F: N}
points: {foot: "[x, 0]", head: "[0, y]", tip: "foot + l*[-cos(a), sin(a)]"}
bodies: {ladder: {mass: m, at: "[x - l/2*cos(a), l/2*sin(a)]"}}
forces: [{on: foot, force: "[-F, 0]"}]
constraints: {wall: {holonomic: tip = head, reaction: lean}}
range: {a: [0 deg, 90 deg]}
""",
    "sphere": """
parameters: {m: 2 kg, R: 0.5 m, g: 9.81 m/s^2}
coordinates: {x: m, y: m, z: {unit: m, role: linked}}
bodies: {ball: {mass: m, at: "[x, y, z]"}}
constraints: {ball_on: {holonomic: x^2 + y^2 + z^2 = R^2}}
""",
    "outside": """
parameters: {m: 2 kg, R: 0.5 m, g: 9.81 m/s^2}
coordinates: {x: m, y: m, z: m}
bodies: {ball: {mass: m, at: "[x, y, z]"}}
constraints: {touch: {unilateral: x^2 + y^2 + z^2 >= R^2}}
""",
    "slider": """
parameters: {m: 1 kg, k: 100 N/m, h: 0.3 m, l: 0.5 m, g: 9.81 m/s^2}
coordinates: {x: m}
points: {O: "[0, h]", P: "[x, 0]"}
bodies: {slider: {mass: m, at: P}}
springs: [{between: [O, P], stiffness: k, free_length: l}]
""",
    "truss": """
parameters: {m: 1 kg, k: 1000 N/m, h: 0.4 m, l: 0.5 m, g: 9.81 m/s^2}
coordinates: {x: m, y: m}
inputs: {F: N}
points: {A: "[-h, 0]", B: "[h, 0]", P: "[x, y]"}
bodies: {joint: {mass: m, at: P}}
springs:
  - {between: [A, P], stiffness: k, free_length: l}
  - {between: [B, P], stiffness: k, free_length: l}
forces: [{on: P, force: "[0, m*g - F]"}]
""",
    "follower": """
parameters: {m: 1 kg, k: 5 N*m, l: 1 m, g: 0 m/s^2}
coordinates: {a: rad, b: rad}
inputs: {P: N}
points: {A: "l*[cos(a), sin(a)]", B: "A + l*[cos(b), sin(b)]"}
bodies: {one: {mass: m, at: A}, two: {mass: m, at: B}}
springs: [{along: a, stiffness: k}, {along: b - a, stiffness: k}]
forces: [{on: B, force: "[-P*cos(b), -P*sin(b)]"}]
range: {a: [-90 deg, 90 deg], b: [-90 deg, 90 deg]}
""",
    "drive": """
parameters: {J: 1 kg*m^2, k: 400 N*m, m: 1 kg, g: 9.81 m/s^2}
coordinates: {a: rad, b: rad}
bodies:
  one: {mass: m, inertia: J, at: "[0, 0]", angle: a}
  two: {mass: m, inertia: J, at: "[0, 0]", angle: b}
springs: [{along: a - b, stiffness: k}]
""",
    "shaken": """
parameters: {m: 1 kg, k: 50 N/m, c: 8 N*s/m, l: 0.4 m, A: 0.1 m, Omega: 3 rad/s, g: 9.81 m/s^2}
prescribed: {w: A*sin(Omega*t)}
coordinates: {x: m}
points: {W: "[w, 0]", P: "[x, 0]"}
bodies: {slider: {mass: m, at: P}}
springs: [{along: x - w, stiffness: k, free_length: l}]
dampers: [{along: x - w, damping: c}]
""",
    "coupled": """
parameters: {m: 2 kg, M: 1 kg, l: 0.5 m, d: 0.3 m, k: 30 N/m, g: 9.81 m/s^2}
coordinates: {a: rad, b: rad}
points: {A: "l*[sin(a), -cos(a)]", B: "[d, 0] + l*[sin(b), -cos(b)]"}
bodies: {one: {mass: m, at: A}, two: {mass: M, at: B}}
springs: [{between: [A, B], stiffness: k, free_length: 0}]
""",
    "skate": """
parameters: {m: 1 kg, J: 0.1 kg*m^2, g: 9.81 m/s^2}
coordinates: {x: m, y: m, theta: rad}
inputs: {F: N}
bodies: {skate: {mass: m, inertia: J, at: "[x, y]", angle: theta}}
forces: [{on: skate, force: "[F, m*g]"}]
constraints: {edge: {nonholonomic: "x'*sin(theta) - y'*cos(theta) = 0"}}
""",
    "four_bar": FOUR_BAR.removeprefix(FOUR_BAR.partition("parameters:")[0]),
}
SOLID = ("hoop", "sphere", "outside")


@cache
def scene(name):
    head = PLANE.replace("plane", "solid").replace("[0, -g]", "[0, 0, -g]")
    return read((head if name in SOLID else PLANE) + SCENES[name], f"{name}.yaml")


def found(name, **numbers):
    result = solve(scene(name), **numbers)
    json.dumps(result.to_json())
    return result


def positions(result, *names):
    return [tuple(float(e.coordinates[n]) for n in names) for e in result.found]


def verdicts(result):
    return [e.stability.verdict for e in result.found]


def near(left, right, tolerance=1e-12):
    return all(
        isclose(a, b, rel_tol=tolerance, abs_tol=tolerance)
        for a, b in zip(left, right, strict=True)
    )


def test_pendulum_hangs_or_stands():
    result = found("pendulum")
    assert positions(result, "phi") == [(0.0,), (pi,)]
    assert verdicts(result) == ["stable", "unstable"]
    assert result.complete
    # V'' = m g l cos phi
    assert result.found[0].stability.eigenvalues == pytest.approx((2 * 9.81 * 0.5,))
    assert any("tau" in note for note in result.notes)  # an input that is zero is said to be


def test_pendulum_under_a_torque():
    torque = 6.0
    result = found("pendulum", inputs={"tau": torque})
    angle = atan2(torque / (2 * 9.81 * 0.5), sqrt(1 - (torque / (2 * 9.81 * 0.5)) ** 2))
    assert near([p for (p,) in positions(result, "phi")], [angle, pi - angle])
    assert verdicts(result) == ["stable", "unstable"]
    too_much = found("pendulum", inputs={"tau": 10})  # m g l is 9.81
    assert too_much.found == ()
    assert too_much.complete
    assert "of 2 complex solutions 0 are equilibria" in too_much.method


def test_thirty_digits():
    (stable, _) = found("pendulum", inputs={"tau": 4.905}).found  # sin phi = 1/2
    assert str(stable.coordinates["phi"]) == "0.523598775598298873077107230547"


def test_double_pendulum_has_four_equilibria():
    result = found("double")
    expected = [(0, 0), (0, pi), (pi, 0), (pi, pi)]
    assert near(sum(positions(result, "a", "b"), ()), sum(expected, ()))
    assert verdicts(result) == ["stable", "unstable", "unstable", "unstable"]
    assert morse_sum(result) == 0
    assert result.complete


def test_elastic_pendulum_in_cartesian_coordinates():
    result = found("elastic")
    sag = 9.81 / 40
    # k (r - l) = m g below the pivot, k (l - r) = m g above it
    assert near(sum(positions(result, "x", "y"), ()), (0, -0.6 - sag, 0, 0.6 - sag))
    assert verdicts(result) == ["stable", "unstable"]
    assert result.complete


def test_rotation_of_the_hoop_is_no_applied_force():
    result = found("hoop", time=0.37)
    # the bead that turns with the hoop rests at cos theta = g / (R Omega^2): not an equilibrium
    assert 9.81 / (0.3 * 20**2) < 1
    assert positions(result, "theta") == [(0.0,), (pi,)]
    assert any("inertia" in note for note in result.notes)
    assert not any("inertia" in note for note in found("pendulum").notes)


@pytest.mark.parametrize(("k", "count", "middle"), [(5, 3, "unstable"), (20, 1, "stable")])
def test_inverted_pendulum_with_torsion_spring(k, count, middle):
    result = found("torsion", parameters={"k": k})
    angles = [p for (p,) in positions(result, "phi")]
    assert len(angles) == count
    assert result.complete
    assert angles[count // 2] == 0.0
    assert result.found[count // 2].stability.verdict == middle
    assert all(isclose(k * q, 10 * sin(q), abs_tol=1e-12) for q in angles)  # m g l = 10
    assert verdicts(result) == verdicts(result)[::-1]


def test_bifurcation_is_undecided():
    result = found("torsion", parameters={"k": 10})
    assert positions(result, "phi") == [(0.0,)]
    assert verdicts(result) == ["undecided"]
    assert not result.complete  # roots at no distance cannot be counted by intervals


def test_linked_pendulum_and_the_sign_of_its_multiplier():
    result = found("linked")
    assert positions(result, "x", "y") == [(0.0, -0.5), (0.0, 0.5)]
    assert verdicts(result) == ["stable", "unstable"]
    # m q'' = Q + J' lambda with J = (2x, 2y): hanging, the rod pulls up with m g = 2 y lambda
    tension = 2 * 9.81
    assert [float(e.multipliers["rod"]) for e in result.found] == pytest.approx(
        [-tension / (2 * 0.5), tension / (2 * 0.5)]
    )
    # on the circle V = m g y has V_ss = m g / l at the bottom
    assert result.found[0].stability.eigenvalues == pytest.approx((tension / 0.5,))


def test_ladder_held_by_a_force_at_its_foot():
    load, weight, length = 40.0, 12 * 9.81, 3.0
    result = found("ladder", inputs={"F": load})
    # moments about the foot: wall force N at height l sin a, weight at l/2 cos a;  N = F
    angle = atan(weight / (2 * load))
    expected = (angle, length * cos(angle), length * sin(angle))
    assert near(sum(positions(result, "a", "x", "y"), ()), expected)
    (one,) = result.found
    assert one.stability.verdict == "unstable"
    # the wall pushes the tip to the right with N = F, and it has no other component
    assert near([float(v) for v in one.reactions["lean"]], (load, 0.0))


def test_mass_on_a_sphere():
    result = found("sphere")
    assert positions(result, "x", "y", "z") == [(0.0, 0.0, -0.5), (0.0, 0.0, 0.5)]
    assert verdicts(result) == ["stable", "unstable"]
    assert [float(e.multipliers["ball_on"]) for e in result.found] == pytest.approx([-19.62, 19.62])


def test_a_sphere_pushes_only():
    result = found("outside")
    assert positions(result, "x", "y", "z") == [(0.0, 0.0, 0.5)]
    assert result.found[0].contacts == ("touch",)
    assert verdicts(result) == ["unstable"]


def test_slider_that_snaps_through():
    result = found("slider")
    side = sqrt(0.5**2 - 0.3**2)  # where the spring has its free length
    assert near(sum(positions(result, "x"), ()), (-side, 0.0, side))
    assert verdicts(result) == ["stable", "unstable", "stable"]
    assert result.complete


def test_two_bar_truss_snaps_through():
    load, k, h, free = 10.0, 1000.0, 0.4, 0.5
    result = found("truss", inputs={"F": load})
    assert result.complete
    for x, y in positions(result, "x", "y"):
        bars = [(hypot(x + h, y), x + h), (hypot(x - h, y), x - h)]
        assert sum(k * (r - free) * side / r for r, side in bars) == pytest.approx(0, abs=1e-9)
        assert sum(k * (r - free) * y / r for r, _ in bars) == pytest.approx(-load, rel=1e-9)
    # on the axis: 2 k (l - r) y / r = F has three roots below the limit load
    upright = [y for x, y in positions(result, "x", "y") if x == 0]
    assert len(upright) == 3
    stable = [e for e in result.found if e.stability.verdict == "stable"]
    assert {float(e.coordinates["y"]) for e in stable} == {upright[0], upright[-1]}


def morse_sum(result):
    """Even less odd numbers of falling directions: 0 on a torus of two angles, by Morse."""
    assert len(result.found) >= 4
    return sum((-1) ** sum(v < 0 for v in e.stability.eigenvalues) for e in result.found)


def test_prescribed_motion_stands_still():
    result = found("shaken", time=0.3)
    # the damper between the wall and the slider is at rest
    assert near(sum(positions(result, "x"), ()), (0.4 + 0.1 * sin(0.9),), 1e-15)
    assert any("stand" in note for note in result.notes)


def test_coupled_pendulums_torque_by_torque():
    result = found("coupled")
    assert result.complete
    assert morse_sum(result) == 0
    for a, b in positions(result, "a", "b"):
        pull = (30 * (0.3 + 0.5 * (sin(b) - sin(a))), 30 * 0.5 * (cos(a) - cos(b)))
        for angle, mass, sign in ((a, 2, 1), (b, 1, -1)):
            arm = (0.5 * sin(angle), -0.5 * cos(angle))
            force = (sign * pull[0], sign * pull[1] - mass * 9.81)
            assert arm[0] * force[1] - arm[1] * force[0] == pytest.approx(0, abs=1e-12)


def test_follower_force_has_no_potential():
    still, pushed = found("follower"), found("follower", inputs={"P": 3})
    assert verdicts(still) == ["stable"]
    assert verdicts(pushed) == ["undecided"]
    assert "no potential" in pushed.found[0].stability.reason
    assert not equations(scene("follower")).conservative
    assert equations(scene("double")).conservative


def test_skate_rests_across_the_force():
    result = found("skate", inputs={"F": 7})
    # the edge takes the force across it only: cos theta = 0, and it pushes back with F
    assert near([abs(p) for (p,) in positions(result, "theta")], (pi / 2, pi / 2))
    for e in result.found:
        assert float(e.multipliers["edge"]) * sin(float(e.coordinates["theta"])) == pytest.approx(
            -7
        )
        assert e.stability.verdict == "undecided"
    assert result.arbitrary == ("x", "y")


LINKS = (0.20, 0.50, 0.40, 0.45)


def crank_torque(q1, q2, q3):
    """The crank's torque, and the pin force on the coupler, from free bodies of the three rods."""
    a, b, c, _ = LINKS
    wa, wb, wc = (1.2 * length * 9.81 for length in (a, b, c))
    # moments about B on the coupler and about D on the rocker give the pin force (fx, fy)
    rows = ((-b * sin(q2), b * cos(q2)), (c * sin(q3), -c * cos(q3)))
    right = (wb * b / 2 * cos(q2), wc * c / 2 * cos(q3))
    det = rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]
    fx = (right[0] * rows[1][1] - rows[0][1] * right[1]) / det
    fy = (rows[0][0] * right[1] - right[0] * rows[1][0]) / det
    # the coupler hands fx, fy - wb on to the crank at B
    turning = a * (cos(q1) * (fy - wb) - sin(q1) * fx) - wa * a / 2 * cos(q1)
    return -turning, (fx, fy)


def loop(q1):
    """The rocker's and coupler's angles by the law of cosines, the upper assembly."""
    a, b, c, e = LINKS
    bx, by = a * cos(q1), a * sin(q1)
    d = hypot(e - bx, -by)
    opening = acos((d * d + b * b - c * c) / (2 * d * b))
    q2 = atan2(-by, e - bx) + opening
    return q2, atan2(by + b * sin(q2), bx + b * cos(q2) - e)


def test_four_bar_torque_balance():
    q1 = pi / 3
    q2, q3 = loop(q1)
    torque, pin = crank_torque(q1, q2, q3)
    result = found("four_bar", inputs={"tau": torque})
    assert result.complete
    (match,) = [
        e
        for e in result.found
        if abs(float(e.coordinates["q1"]) - q1) < 1e-9
        and q2 > 0
        and abs(float(e.coordinates["q2"]) - q2) < 1e-9
    ]
    assert near([float(v) for v in match.reactions["pin_C"]], pin, 1e-9)
    for e in result.found:
        angles = [float(e.coordinates[n]) for n in ("q1", "q2", "q3")]
        assert crank_torque(*angles)[0] == pytest.approx(torque, rel=1e-9)


def test_four_bar_stability_is_the_slope_of_its_torque():
    result = found("four_bar")
    upper = [
        e
        for e in result.found
        if abs(loop(float(e.coordinates["q1"]))[0] - float(e.coordinates["q2"])) < 1e-6
    ]
    assert upper
    for e in upper:
        q1, h = float(e.coordinates["q1"]), 1e-5
        # dV/dq1 is the torque that holds the crank
        slope = crank_torque(q1 + h, *loop(q1 + h))[0] - crank_torque(q1 - h, *loop(q1 - h))[0]
        assert (slope > 0) == (e.stability.verdict == "stable")


@pytest.mark.parametrize("name", ["double", "slider", "sphere", "elastic"])
def test_many_starts_find_what_elimination_proves(name, monkeypatch):
    exact = found(name)
    monkeypatch.setattr(equilibrium_find, "LARGEST_SYSTEM", 0)
    searched = found(name)
    assert exact.complete
    assert not searched.complete
    assert "400 starts" in searched.method
    assert searched.found == exact.found


def test_a_family_is_said_to_be_one():
    result = found("drive")
    assert not result.complete
    assert any("family" in note for note in result.notes)
    assert result.found
    for e in result.found:
        assert not e.isolated
        assert e.stability.verdict == "undecided"
        assert e.coordinates["a"] == pytest.approx(e.coordinates["b"])


def test_every_origin_is_kept():
    (balance,) = equations(scene("torsion")).balances
    (m, length, g, k), phi = (p.symbol for p in scene("torsion").parameters), "phi"
    algebra = normal.of_atom(balance.elastic.ring, scene("torsion").coordinates[0].symbol)
    stiffness = normal.of_atom(balance.elastic.ring, k)
    assert balance.name == phi
    assert normal.is_zero(balance.elastic - stiffness * algebra)
    assert balance.gravity.terms
    assert not balance.applied.terms
    assert normal.is_zero(balance.force + balance.gravity + balance.elastic)
    assert not balance.equation.inertia.terms
    assert {str(s) for s in (m, length, g)} == {"m", "l", "g"}


def test_multipliers_are_named_after_their_rows():
    statics = equations(scene("four_bar"))
    assert [str(r.multiplier) for r in statics.links] == ["lambda loop.x", "lambda loop.y"]


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ({"inputs": {"tua": 1}}, "did you mean 'tau'"),
        ({"parameters": {"mass": 1}}, "unknown parameter"),
    ],
)
def test_wrong_names_are_refused(numbers, words):
    with pytest.raises(UsageError, match=words):
        solve(scene("pendulum"), **numbers)


def test_a_parameter_without_value_is_asked_for():
    with pytest.raises(UsageError, match="k has no value"):
        solve(scene("torsion"))


@pytest.mark.parametrize(
    ("name", "weight"), [("mass_on_sphere", 0.5 * 9.81), ("mass_leaving_sphere", 0.5 * 9.81)]
)
def test_a_named_relation_on_one_body_has_its_force_in_world_axes(name, weight):
    """lambda d phi/d r carries the weight, whatever the gradient's length."""
    (one,) = solve(model_of(name)).found
    assert near([float(v) for v in one.reactions["normal_force"]], (0.0, 0.0, weight))


def test_roots_that_a_contact_refuses_are_no_equilibria():
    """At the lowest point of the sphere's outside the contact would have to pull."""
    result = solve(model_of("mass_leaving_sphere"))
    assert len(result.found) == 1
    assert "2 are equilibria, but for 1 that the unilateral constraints refuse" in result.method
    assert "refuse" not in solve(model_of("mass_on_sphere")).method
