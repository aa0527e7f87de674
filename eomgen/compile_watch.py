"""What to look at while a program runs: values that are positive while all is well, and words.

Bit k of a status word stands for `WATCHES[k]`: it is set where the value is not positive, which is
so for NaN too. A pivot that is not positive ends every function with the status `singular` before.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import log10

from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.algebra.assemble import assemble
from eomgen.algebra.elementary import BUILD, absolute
from eomgen.algebra.graph import Node
from eomgen.algebra.ldl import Pivots
from eomgen.compile import Machine
from eomgen.mechanics import rotation
from eomgen.mechanics.vectors import cross, dot, transform
from eomgen.model import Body, Turn
from eomgen.program import Function

FINITE, OFF, BRANCH, PIVOT, GIMBAL = "finite", "on_constraints", "branch", "pivot", "gimbal"
LARGEST_RESIDUAL = Fraction(1, 10**6)  # SI
LEAST_PIVOT = Fraction(1, 10**4)  # of its size at the start
LEAST_COSINE = Fraction(1, 20)  # of the pitch, or what stands for it about skew axes


@dataclass(frozen=True)
class Watch:
    """One bit of the status word, after the 1 of `singular`."""

    bit: int
    words: str  # what is the matter where it is set, and the remedy


WATCHES = {
    FINITE: Watch(2, "an acceleration is not finite: shorten the step, or leave this state"),
    OFF: Watch(4, "the state is off the constraints by more than 1e-6: project it"),
    BRANCH: Watch(
        8, "the dependent coordinates have changed their branch, or a dead point was passed: use "
        "nullspace or multiplier"
    ),
    PIVOT: Watch(
        16, "the dependent speeds hardly follow from the others any more (a pivot is below 1e-4 of "
        "its first size): "
        "choose others by `role: free`, or use multiplier"
    ),
    GIMBAL: Watch(
        32, "the angles of a body are near their singular position (cosine below 0.05): use a "
        "quaternion"
    ),
}  # fmt: skip


@dataclass(frozen=True)
class Block:
    """What solved for the dependent speeds, by numbers of the initial state."""

    determinant: Node  # positive there
    pivots: tuple[tuple[Node, Fraction], ...]  # squares, with their sizes there


def function(m: Machine, block: Block | None) -> Function | None:
    """`watch`: a value for each bit that the scene has; None where it has none but `finite`."""
    values = dict(_values(m, block))
    if values.keys() <= {FINITE}:
        return None
    listed = ", ".join(f"{name} ({WATCHES[name].bit})" for name in values)
    about = f"positive while all is well, with the bits of a status word otherwise: {listed}"
    return assemble("watch", about, (len(values),), list(values.values()), _pivots(m))


def _pivots(m: Machine) -> Pivots:
    return m.pivots if m.model.guides else m.solution[1]


def names(m: Machine, block: Block | None) -> tuple[str, ...]:
    """What the values of `watch` stand for."""
    return tuple(dict(_values(m, block)))


def mask(watched: Sequence[str], values: Sequence[float]) -> int:
    """The bits of the values that are not positive."""
    pairs = zip(watched, values, strict=True)
    return sum(WATCHES[name].bit for name, value in pairs if not value > 0)


def words(bits: int) -> tuple[str, ...]:
    """The sentences of a status word."""
    return tuple(w.words for w in WATCHES.values() if bits & w.bit)


def _values(m: Machine, block: Block | None) -> Iterator[tuple[str, Node]]:
    one = m.kinematics.algebra.number(1)
    if not m.model.guides:
        yield FINITE, one / sum((absolute(a) for a in m.solution[0]), one)
    residuals = [r.residual for r in m.rows if r.residual is not None]
    if residuals:
        yield OFF, LARGEST_RESIDUAL**2 - dot(residuals, residuals)
    if block is not None and block.pivots:
        yield BRANCH, block.determinant
        yield PIVOT, _least([p - LEAST_PIVOT**2 * size for p, size in block.pivots])
    singular = [v for body in m.model.bodies for v in _gimbals(m, body)]
    if singular:
        yield GIMBAL, _least([v * v - LEAST_COSINE**2 for v in singular])


def _least(values: Sequence[Node]) -> Node:
    first, *others = values
    for value in others:
        first = BUILD["min"](first, value)
    return first


def _gimbals(m: Machine, body: Body) -> Iterator[Node]:
    """det = a . R(b, q) (b x c) of three turns in a row about a, b, c, q the middle angle."""
    algebra, turns = m.kinematics.algebra, body.frame.turns
    for three in zip(turns, turns[1:], turns[2:], strict=False):
        found = [t for t in three if isinstance(t, Turn) and not t.angle.is_number]
        if len(found) == len(three):
            a, b, c = (rotation.unit(algebra, t.axis) for t in found)
            turned = rotation.about(algebra, b, algebra.of(found[1].angle))
            value = dot(a, transform(turned, cross(b, c)))
            if value.operator != "number":
                yield value


def block(determinant: Node, pivots: Pivots, leaves: Mapping[Node, float]) -> Block:
    """What is watched of a block whose numbers at the initial state are those of the leaves."""
    value, *squares = evaluate([determinant, *(p for p, _ in pivots)], leaves, FLOAT)
    sizes = (Fraction(10) ** round(log10(square)) for square in squares)
    pairs = tuple((p, size) for (p, _), size in zip(pivots, sizes, strict=True))
    return Block(determinant if value > 0 else -determinant, pairs)
