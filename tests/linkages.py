"""Scenes with constraints, built by hand: the lecture's rows 4 to 10 and mechanisms with loops."""

from functools import cache

import sympy as sp

from eomgen import compile
from eomgen.model import TIME, Constraint, Coordinate, Model, Parameter

R = sp.Rational


def symbol(name, **known):
    return sp.Symbol(name, real=True, **known)


def coordinate(name, role="linked"):
    return Coordinate(name, *(symbol(name + dots) for dots in ("", "'", "''")), role=role)


def constraint(name, kind, *residuals):
    return Constraint(name, kind, residuals, name)


def scene(coordinates, constraints, parameters=None, free="", **known):
    """A model of constraints alone: `{name: (kind, residual, ...)}`."""
    return Model(
        "scene",
        {"en": "Scene"},
        "solid",
        (),
        parameters=tuple(
            Parameter(n, symbol(n, positive=True), value=sp.sympify(v), positive=True)
            for n, v in (parameters or {}).items()
        ),
        coordinates=tuple(
            coordinate(c, "free" if c in free.split() else "linked") for c in coordinates.split()
        ),
        constraints=tuple(constraint(n, *c) for n, c in constraints.items()),
        **known,
    )


def machine(*given, **known):
    return compile.machine_of(scene(*given, **known))


x, y, z, theta, phi, psi, s = (symbol(n) for n in ("x", "y", "z", "theta", "phi", "psi", "s"))
dx, dy, dz, dtheta, dphi, dpsi, ds = (
    symbol(n + "'") for n in ("x", "y", "z", "theta", "phi", "psi", "s")
)
radius, length, omega, alpha = (symbol(n, positive=True) for n in ("R", "l", "w", "alpha"))
ends = {i: [symbol(f"{a}_{i}") for a in "xyz"] for i in (1, 2)}
sphere = x**2 + y**2 + z**2 - radius**2
rod = sum((b - a) ** 2 for a, b in zip(ends[1], ends[2], strict=True)) - length**2
rolling = (dx - radius * dphi * sp.cos(theta), dy - radius * dphi * sp.sin(theta))
HOLONOMIC, RATES, GAP = "holonomic", "nonholonomic", "unilateral"

# (coordinates, constraints, parameters, initial values)
LECTURE = {
    4: ("x y", {"incline": (HOLONOMIC, y - x * sp.tan(alpha))}, {"alpha": R(1, 2)}, {"x": 1}),
    5: ("x y z", {"sphere": (HOLONOMIC, sphere)}, {"R": 1}, {"x": R(1, 2), "y": R(1, 2)}),
    6: (
        "x_1 y_1 z_1 x_2 y_2 z_2",
        {"rod": (HOLONOMIC, rod)},
        {"l": 2},
        {"x_1": 0, "y_1": 0, "z_1": 0, "x_2": 1, "y_2": 1},
    ),
    7: ("x y z", {"outside": (GAP, sphere)}, {"R": 1}, {"z": 1}),
    8: (
        "x y z",
        {"hoop": (HOLONOMIC, x**2 + z**2 - radius**2), "plane": (HOLONOMIC, y)},
        {"R": 1},
        {"x": R(3, 5)},
    ),
    9: (
        "x y z",
        {"sphere": (HOLONOMIC, sphere), "turning": (HOLONOMIC, y - x * sp.tan(omega * TIME))},
        {"R": 1, "w": R(1, 3)},
        {"x": R(3, 5)},
    ),
    10: ("x y theta phi", {"rolling": (RATES, *rolling)}, {"R": R(1, 2)}, {}),
}


@cache
def lecture(row):
    coordinates, constraints, parameters, initial = LECTURE[row]
    known = {n: sp.sympify(v) for n, v in initial.items()}
    return machine(coordinates, constraints, parameters, initial=known)


def four_bar(crank, coupler, rocker, ground, **known):
    """Absolute angles a, b, c of three links; the loop closes at the fourth joint."""
    a, b, c = (symbol(n) for n in "abc")
    loop = (
        crank * sp.cos(a) + coupler * sp.cos(b) - rocker * sp.cos(c) - ground,
        crank * sp.sin(a) + coupler * sp.sin(b) - rocker * sp.sin(c),
    )
    return machine("a b c", {"loop": (HOLONOMIC, *loop)}, free="a", **known)


def degrees(value):
    return value * sp.pi / 180


def bricard():
    """Six revolute joints in a closed ring of unit links with twists of +-90 degrees.

    Bricard's trihedral mechanism in Denavit-Hartenberg angles: 6 coordinates and 6 rows (three of
    position, three of orientation), of which only 5 are independent; one degree of freedom.
    """
    angles = [symbol(f"q{i}") for i in range(1, 7)]
    links = [_link(q, 1 if i % 2 == 0 else -1) for i, q in enumerate(angles)]
    # half of the ring from either side:  T1 T2 T3 = (T4 T5 T6)^-1
    left, right = links[0] * links[1] * links[2], links[3] * links[4] * links[5]
    turn, shift = right[:3, :3].T, -right[:3, :3].T * right[:3, 3]
    back = turn.row_join(shift)
    entries = [(0, 3), (1, 3), (2, 3), (0, 1), (0, 2), (1, 2)]
    rows = {f"c{k}": (HOLONOMIC, left[i] - back[i]) for k, i in enumerate(entries, 1)}
    guess = {f"q{i}": sp.pi / 2 * (1 if i % 2 else -1) for i in range(1, 7)}
    return machine(" ".join(str(q) for q in angles), rows, free="q1", guess=guess)


def _link(angle, twist):
    """Rz(angle) Tx(1) Rx(twist * 90 deg)."""
    c, s = sp.cos(angle), sp.sin(angle)
    return sp.Matrix([[c, 0, s * twist, c], [s, 0, -c * twist, s], [0, twist, 0, 0], [0, 0, 0, 1]])


# consistent positions of Andrews' squeezer mechanism (Bari test set for initial value problems)
SQUEEZER = {
    "beta": "-0.0617138900142764496358948458001",
    "Theta": "0",
    "gamma": "0.455279819163070380255912382449",
    "Phi": "0.222668390165885884674473185609",
    "delta": "0.487364979543842550225598953530",
    "Omega": "-0.222668390165885884674473185609",
    "epsilon": "1.23054744454982119249735015568",
}


def squeezer():
    """Andrews' squeezer mechanism: seven bodies in three loops, lengths of millimetres."""
    beta, big, gamma, tilt, delta, swing, epsilon = (symbol(n) for n in SQUEEZER)
    end = (
        R(7, 1000) * sp.cos(beta) - R(28, 1000) * sp.cos(beta + big),
        R(7, 1000) * sp.sin(beta) - R(28, 1000) * sp.sin(beta + big),
    )
    fixed = (R(-6934, 100000), R(-227, 100000))
    loops = (
        (
            end[0] - R(35, 1000) * sp.sin(gamma) + R(3635, 100000),
            end[1] + R(35, 1000) * sp.cos(gamma) - R(3273, 100000),
        ),
        (
            end[0] - R(2, 100) * sp.sin(tilt + delta) - R(4, 100) * sp.cos(delta) - fixed[0],
            end[1] + R(2, 100) * sp.cos(tilt + delta) - R(4, 100) * sp.sin(delta) - fixed[1],
        ),
        (
            end[0] - R(2, 100) * sp.cos(swing + epsilon) - R(4, 100) * sp.sin(epsilon) - fixed[0],
            end[1] - R(2, 100) * sp.sin(swing + epsilon) + R(4, 100) * sp.cos(epsilon) - fixed[1],
        ),
    )
    guess = {n: sp.Rational(v).limit_denominator(20) for n, v in SQUEEZER.items() if n != "Theta"}
    rows = {f"loop{i}": (HOLONOMIC, *loop) for i, loop in enumerate(loops, 1)}
    known = {"initial": {"Theta": sp.Integer(0)}, "guess": guess}
    return machine(" ".join(SQUEEZER), rows, free="Theta", **known)
