"""What an ideal joint transmits, in closed form: the directions in which it does no work.

The twist (v, w) of a body against its parent is  sum of T_j q_j'.  A force F at the joint's point
with a moment M is a reaction where  F . v_j + M w_j = 0  for every coordinate.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

import sympy as sp

from eomgen.algebra import elimination, functions, normal
from eomgen.algebra.arithmetic import FLOAT
from eomgen.algebra.closed import Evaluation
from eomgen.algebra.normal import Form
from eomgen.mechanics import newton_euler
from eomgen.mechanics.free_bodies_loads import varied
from eomgen.mechanics.kinematics import Kinematics
from eomgen.mechanics.newton_euler_tree import Joint
from eomgen.mechanics.vectors import Vector, cross, dot, scale, subtract
from eomgen.model import AXES

Closed = Kinematics[Form]

TRIALS = 20  # random states at which a rank is looked for
IRREGULAR = (ValueError, ZeroDivisionError, OverflowError)


@dataclass(frozen=True)
class Hinge:
    """A joint in closed form; its wrenches act at `place`, forces first, then moments."""

    joint: Joint
    place: Vector[Form]  # a particle's: where it is
    turns: bool  # whether moments of the body count
    parent_turns: bool
    twists: Mapping[int, Vector[Form]]  # coordinate -> (v_j, w_j) against the parent, if not zero


@dataclass(frozen=True)
class Share:
    """One unknown of a joint.

    letter: S along a line to what it hangs on, N across its motion, F along it, M a moment,
    X, Y, Z along an axis.
    """

    letter: str
    force: Vector[Form]  # per unit of the unknown, world axes
    moment: Form  # about the joint's place; in a plane


def hinge(kinematics: Closed, joint: Joint, turning: frozenset[str]) -> Hinge:
    """The joint of a body; `turning`: bodies whose moments count."""
    turns = joint.body in turning
    place = newton_euler.about(kinematics, joint) if turns else kinematics.position(joint.body)
    relative = _motion_at(kinematics, joint.body, place, turns)
    parent_turns = joint.parent in turning
    if joint.parent is not None:
        below = _motion_at(kinematics, joint.parent, place, parent_turns)
        still = kinematics.algebra.number(0)
        below += (still,) * (len(relative) - len(below))
        relative = subtract(relative, below[: len(relative)])
    return Hinge(joint, place, turns, parent_turns, _partials(kinematics, relative))


def _motion_at(kinematics: Closed, body: str, place: Vector[Form], turns: bool) -> Vector[Form]:
    """The velocity of a body's point at `place`, then its angular velocity; a particle's own."""
    velocity = kinematics.velocity(body)
    if not turns:
        return velocity
    (w,) = kinematics.angular_velocity(body)
    arm = subtract(place, kinematics.position(body))
    return (velocity[0] - w * arm[1], velocity[1] + w * arm[0], w)


def _partials(kinematics: Closed, motion: Vector[Form]) -> dict[int, Vector[Form]]:
    """Those columns of the twist that are not zero."""
    algebra, one = kinematics.algebra, kinematics.algebra.number(1)
    columns = (tuple(algebra.along(c, {u: one}) for c in motion) for u in varied(kinematics))
    return {
        j: column for j, column in enumerate(columns) if not all(algebra.is_zero(c) for c in column)
    }


class _Random(dict[sp.Symbol, float]):
    """A value for every symbol, the same for the same trial."""

    def __init__(self, trial: int) -> None:
        super().__init__()
        self.trial = trial

    def __missing__(self, symbol: sp.Symbol) -> float:
        value = random.Random(f"{self.trial} {symbol.name}").uniform(0.3, 1.4)
        return self.setdefault(symbol, value)


def independent(columns: Sequence[Vector[Form]]) -> tuple[int, ...]:
    """Which of the vectors are a basis of their span at almost every state."""
    best: tuple[int, ...] = ()
    for trial in range(TRIALS):
        evaluation = Evaluation(
            _Random(trial), lambda c: float(c), lambda name, *a: FLOAT.functions[name](*a)
        )
        with suppress(*IRREGULAR):
            rows = [[float(evaluation.of(c)) for c in column] for column in columns]
            found = tuple(sorted(elimination.order_of(rows).rows))
            best = max(best, found, key=len)
    return best


def shares(kinematics: Closed, held: Hinge) -> tuple[Share, ...] | None:
    """The unknowns of a joint; None where they have no basis that a person would choose."""
    columns = list(held.twists.values())
    basis = [columns[i] for i in independent(columns)] if columns else []
    if held.turns:
        return _of_body(kinematics, basis)
    return _of_particle(kinematics, held, basis)


def _of_particle(
    kinematics: Closed, held: Hinge, basis: Sequence[Vector[Form]]
) -> tuple[Share, ...] | None:
    size, zero = kinematics.dimensions, kinematics.algebra.number(0)
    if len(basis) == size:
        return ()
    if not basis:
        return _along_axes(kinematics)
    if len(basis) < size - 1:
        return None
    line = _line(kinematics, held, basis)
    if line is not None:
        return (Share("S", line, zero),)
    across = turned(basis[0]) if size == 2 else cross(*basis)
    return (Share("N", upward(kinematics, unit(across)), zero),)


def _of_body(kinematics: Closed, basis: Sequence[Vector[Form]]) -> tuple[Share, ...]:
    """The unknowns of a body in a plane: three less the freedom of its joint."""
    zero, one = kinematics.algebra.number(0), kinematics.algebra.number(1)
    none = (zero, zero)
    if not basis:
        return (*_along_axes(kinematics), Share("M", none, one))
    if len(basis) == 1:
        return _of_one_freedom(kinematics, basis[0])
    if len(basis) == 3:
        return ()
    x, y, moment = cross(*basis)
    if all(normal.is_zero(c) for c in (x, y)):
        return (Share("M", none, one),)
    along = upward(kinematics, unit((x, y)))
    # the moment keeps its ratio to the force
    first, second = (along[0], x) if not normal.is_zero(x) else (along[1], y)
    return (Share("N", along, moment * first / second),)


def _of_one_freedom(kinematics: Closed, twist: Vector[Form]) -> tuple[Share, ...]:
    """A pin has X and Y, a slide N and M, what rolls N and F through its instant centre."""
    zero, one = kinematics.algebra.number(0), kinematics.algebra.number(1)
    *velocity, w = twist
    if all(normal.is_zero(v) for v in velocity):
        return _along_axes(kinematics)
    length = root_free(dot(velocity, velocity))
    if normal.is_zero(w):
        return (
            Share("N", upward(kinematics, unit(turned(velocity))), zero),
            Share("M", (zero, zero), one),
        )
    if length is None:
        pairs = [(s.letter, s.force) for s in _along_axes(kinematics)]
    else:
        along = scale(one / length, velocity)
        pairs = [("N", upward(kinematics, turned(along))), ("F", along)]
    # F . v + M w = 0
    return tuple(Share(a, f, -(dot(f, velocity) / w)) for a, f in pairs)


def _along_axes(kinematics: Closed) -> tuple[Share, ...]:
    zero, size = kinematics.algebra.number(0), range(kinematics.dimensions)
    rows = (tuple(kinematics.algebra.number(int(i == j)) for j in size) for i in size)
    return tuple(Share(axis.upper(), row, zero) for axis, row in zip(AXES, rows, strict=False))


def _line(kinematics: Closed, held: Hinge, basis: Sequence[Vector[Form]]) -> Vector[Form] | None:
    """The unit vector to what a particle hangs on, if its motion is across that line."""
    own = kinematics.position(held.joint.body)
    arm = tuple(-c for c in own)  # to the world's origin
    if held.joint.point is not None and held.joint.point != held.joint.body:
        reach = subtract(kinematics.position(held.joint.point), own)
        arm = arm if held.joint.parent is None and _vanishes(reach) else reach
    elif held.joint.parent is not None:
        return None
    if all(normal.is_zero(a) for a in arm) or root_free(dot(arm, arm)) is None:
        return None
    if not all(normal.is_zero(dot(arm, t)) for t in basis):
        return None
    return unit(arm)


def turned(vector: Sequence[Form]) -> Vector[Form]:
    """A vector of a plane turned counterclockwise."""
    return (-vector[1], vector[0])


def upward(kinematics: Closed, vector: Vector[Form]) -> Vector[Form]:
    """The vector or its opposite: against gravity, or along an axis, as far as signs tell."""
    fall = dot(vector, kinematics.vector(kinematics.model.gravity))
    rise = next((-fall, *vector)[i] for i, f in enumerate((fall, *vector)) if f.terms)
    first = next(iter(rise.terms.values()))
    return vector if first > 0 else tuple(-c for c in vector)


def unit(vector: Vector[Form]) -> Vector[Form]:
    """The vector over its length."""
    square = dot(vector, vector)
    length = root_free(square) or functions.sqrt(square)
    return tuple(c / length for c in vector)


def root_free(square: Form) -> Form | None:
    """A root of a form that is one term with even powers, up to its sign."""
    if len(square.terms) != 1:
        return None
    (((monomial, wave, _), c),) = square.terms.items()
    number = Fraction(c)
    above, below = isqrt(max(number.numerator, 0)), isqrt(number.denominator)
    exact = Fraction(above, below) ** 2 == number
    if wave or not exact or any(e % 2 for _, e in monomial):
        return None
    halves = tuple((a, e // 2) for a, e in monomial)
    return normal.scaled(Form(square.ring, {(halves, (), False): 1}), Fraction(above, below))


def dual(kinematics: Closed, held: Hinge, coordinate: int) -> Share | None:
    """The wrench that works on this coordinate of the joint and on no other; None if not plain.

    A force on what moves the joint's place, else a moment.
    """
    size, zero = kinematics.dimensions, kinematics.algebra.number(0)
    own = held.twists.get(coordinate)
    if own is None:
        return None
    others = [t for j, t in held.twists.items() if j != coordinate]
    velocity, moving = own[:size], [t[:size] for t in others if not _vanishes(t[:size])]
    if not _vanishes(velocity):
        force = _dual_force(velocity, moving)
        return None if force is None else Share("", force, zero)
    if any(not _vanishes(t[size:]) for t in others):
        return None
    return Share("", (zero,) * size, kinematics.algebra.number(1) / own[size])


def _vanishes(vector: Sequence[Form]) -> bool:
    return all(normal.is_zero(c) for c in vector)


def _dual_force(velocity: Vector[Form], others: Sequence[Vector[Form]]) -> Vector[Form] | None:
    """F with F . v = 1 and F . v_other = 0."""
    if all(normal.is_zero(dot(velocity, o)) for o in others):
        return scale(normal.inverse(dot(velocity, velocity)), velocity)
    if len(velocity) != 2 or len(others) != 1:
        return None
    across = turned(others[0])
    work = dot(velocity, across)
    return None if normal.is_zero(work) else tuple(c / work for c in across)
