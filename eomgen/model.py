"""What is there: bodies, coordinates, loads, as frozen records that know no files.

Formulas are small SymPy expressions over the symbols of the records below, exact (0.1 is 1/10) and
in SI units. The time is `TIME`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import sympy as sp

from eomgen.dimension import Dimension

TIME = sp.Symbol("t", real=True)
AXES = ("x", "y", "z")
SPACES = {"line": 1, "plane": 2, "solid": 3}  # number of components of a vector


@dataclass(frozen=True)
class Description:
    """What a person is told of a name: the author's unit and words, LaTeX where it was given."""

    unit: str = ""
    dimension: Dimension | None = None  # None: the spec states no unit for it
    latex: str | None = None
    about: str = ""


@dataclass(frozen=True)
class Parameter:
    """A constant; `value` is exact and in SI units; a derived one has a `formula` instead."""

    name: str
    symbol: sp.Symbol
    description: Description = Description()
    value: sp.Expr | None = None
    formula: sp.Expr | None = None
    positive: bool = False


@dataclass(frozen=True)
class Coordinate:
    """A generalized coordinate q with the symbols of q' and q''."""

    name: str
    symbol: sp.Symbol
    rate: sp.Symbol
    acceleration: sp.Symbol
    description: Description = Description()
    role: str = "free"  # or "linked"
    positive: bool = False


@dataclass(frozen=True)
class Speed:
    """A quasi-velocity u = formula, linear in the rates; `rate` is the symbol of u'."""

    name: str
    symbol: sp.Symbol
    rate: sp.Symbol
    formula: sp.Expr
    description: Description = Description()


@dataclass(frozen=True)
class Prescribed:
    """A known function of time, with the symbols of its first two derivatives."""

    name: str
    symbol: sp.Symbol
    rate: sp.Symbol
    acceleration: sp.Symbol
    formula: sp.Expr
    description: Description = Description()


@dataclass(frozen=True)
class Input:
    """Unknown when the equations are derived: an argument of the generated code."""

    name: str
    symbol: sp.Symbol
    description: Description = Description()


@dataclass(frozen=True)
class Place:
    """A position: sum(coefficient * named point) + components in the axes of `on`.

    Without named points the components count from the origin of `on`; `on=None` is the world.
    A body's name among the points means its mass centre.
    """

    components: tuple[sp.Expr, ...]
    points: tuple[tuple[sp.Expr, str], ...] = ()
    on: str | None = None


@dataclass(frozen=True)
class Turn:
    """A rotation by `angle` about `axis` (3 components, any nonzero length), body-fixed."""

    axis: tuple[sp.Expr, sp.Expr, sp.Expr]
    angle: sp.Expr

    @property
    def formulas(self) -> tuple[sp.Expr, ...]:
        """What turns."""
        return (self.angle,)


@dataclass(frozen=True)
class Quaternion:
    """A turn by a unit quaternion; `speeds`: its angular velocity in the axes after the turn.

    symbols: four coordinates, the scalar part first, whose squares add up to one.
    """

    name: str
    symbols: tuple[sp.Symbol, sp.Symbol, sp.Symbol, sp.Symbol]
    rates: tuple[sp.Symbol, sp.Symbol, sp.Symbol, sp.Symbol]
    speeds: tuple[sp.Symbol, sp.Symbol, sp.Symbol]

    @property
    def formulas(self) -> tuple[sp.Expr, ...]:
        """What turns."""
        return self.symbols

    @property
    def accelerations(self) -> tuple[sp.Symbol, ...]:
        """The derivatives of the speeds."""
        return tuple(sp.Symbol(f"{s.name}'", real=True) for s in self.speeds)


def quaternion_rates(parts: Sequence[Any], spin: Sequence[Any]) -> tuple[Any, ...]:
    """e' = e (0, w) / 2 with the angular velocity w in the axes after the turn; any scalars."""
    (e, x, y, z), (a, b, c), half = parts, spin, Fraction(1, 2)
    return (
        -((x * a + y * b + z * c) * half),
        (e * a + (y * c - z * b)) * half,
        (e * b + (z * a - x * c)) * half,
        (e * c + (x * b - y * a)) * half,
    )


@dataclass(frozen=True)
class Frame:
    """Axes of a body: `turns` from left to right after the axes of `origin.on` (or the world).

    A rod's x axis points `along` its two named points instead and its origin is the first.
    """

    origin: Place
    turns: tuple[Turn | Quaternion, ...] = ()
    along: tuple[str, str] | None = None


@dataclass(frozen=True)
class Point:
    """A named place."""

    name: str
    place: Place


@dataclass(frozen=True)
class Body:
    """A particle (no inertia), a rigid body, or a uniform rod (`frame.along`).

    inertia: about the mass centre in body axes: () for a particle or a rod, one scalar in a plane,
    the nine entries of the symmetric tensor, row by row, in solid space.
    """

    name: str
    mass: sp.Expr
    frame: Frame
    com: Place  # the mass centre
    inertia: tuple[sp.Expr, ...] = ()
    description: Description = Description()


@dataclass(frozen=True)
class Spring:
    """Between two points (elongation = distance - free length) or along a scalar formula.

    Exactly one of `stiffness`, `energy`, `law` is given; the last two are formulas in `elongation`.
    """

    name: str
    between: tuple[str, str] | None
    along: sp.Expr | None
    free_length: sp.Expr
    elongation: sp.Symbol
    stiffness: sp.Expr | None = None
    energy: sp.Expr | None = None
    law: sp.Expr | None = None  # pulls when positive


@dataclass(frozen=True)
class Damper:
    """As a spring, in the rate of the elongation: `damping`, or `law` in `elongation_rate`."""

    name: str
    between: tuple[str, str] | None
    along: sp.Expr | None
    elongation_rate: sp.Symbol
    damping: sp.Expr | None = None
    law: sp.Expr | None = None


@dataclass(frozen=True)
class Force:
    """Acts on a point (a body's name: its mass centre); `source` takes the reaction."""

    name: str
    on: str
    components: tuple[sp.Expr, ...]
    source: str | None = None
    axes: str | None = None  # a body's axes; None: the world's


@dataclass(frozen=True)
class Drive:
    """A force along a scalar formula, which it increases; a moment where the formula is an angle.

    It works on the rate of `along` and on nothing else: a motor in a joint, with its reaction.
    """

    name: str
    along: sp.Expr
    force: sp.Expr


@dataclass(frozen=True)
class Moment:
    """Acts on a body: one scalar in a plane, three components in solid space."""

    name: str
    on: str
    components: tuple[sp.Expr, ...]
    source: str | None = None
    axes: str | None = None


@dataclass(frozen=True)
class Constraint:
    """A relation between coordinates, or one-sided: `kind` as the author wrote it.

    holonomic: every residual(q, t) = 0, or the two `points` coincide. nonholonomic: every
    residual(q, q', t) = 0, linear in the rates. unilateral: the one residual(q, t), the gap, >= 0.
    """

    name: str
    kind: str  # holonomic, nonholonomic, unilateral
    residuals: tuple[sp.Expr, ...]  # () where points are set equal
    text: str  # as it was written
    points: tuple[str, str] | None = None
    reaction: str | None = None  # name under which the constraint force is asked for
    restitution: sp.Expr | None = None  # of a unilateral one, between 0 and 1
    friction: sp.Expr | None = None  # Coulomb's coefficient, not negative
    description: Description = Description()

    @property
    def rubs(self) -> bool:
        """Whether there is friction; a coefficient that is written 0 is none."""
        return self.friction is not None and self.friction != 0


@dataclass(frozen=True)
class Energy:
    """Terms that the author gives as formulas, or the whole model."""

    kinetic: sp.Expr = sp.S.Zero
    potential: sp.Expr = sp.S.Zero
    dissipation: sp.Expr = sp.S.Zero


@dataclass(frozen=True)
class Claim:
    """An equation of the author, as left side minus right side, and the text it was written in."""

    residual: sp.Expr
    text: str


@dataclass(frozen=True)
class Expectation:
    """The author's own claims; each is checked, none is used.

    equations hold on every motion; kinetic and potential are formulas (potential up to a
    constant); conserved have time derivative zero; equilibria are maps coordinate -> value.
    """

    dof: int | None = None
    equations: tuple[Claim, ...] = ()
    equilibria: tuple[Mapping[str, sp.Expr], ...] = ()
    conserved: tuple[Claim, ...] = ()
    kinetic: Claim | None = None
    potential: Claim | None = None


@dataclass(frozen=True)
class Output:
    """A named formula; it may hold coordinates, rates, accelerations, inputs and time."""

    name: str
    formula: sp.Expr
    description: Description = Description()


@dataclass(frozen=True)
class Simulation:
    """How the author wants the scene to be run; None where nothing is said."""

    method: str | None = None
    step: sp.Expr | None = None  # s
    formulation: str | None = None


@dataclass(frozen=True)
class Model:
    """One mechanical system."""

    name: str
    title: Mapping[str, str]  # language -> text
    space: str
    gravity: tuple[sp.Expr, ...]
    parameters: tuple[Parameter, ...] = ()
    coordinates: tuple[Coordinate, ...] = ()
    speeds: tuple[Speed, ...] = ()  # with quaternions: the rates of the other coordinates too
    quaternions: tuple[Quaternion, ...] = ()
    prescribed: tuple[Prescribed, ...] = ()
    inputs: tuple[Input, ...] = ()
    points: tuple[Point, ...] = ()
    bodies: tuple[Body, ...] = ()
    springs: tuple[Spring, ...] = ()
    dampers: tuple[Damper, ...] = ()
    forces: tuple[Force, ...] = ()
    drives: tuple[Drive, ...] = ()
    moments: tuple[Moment, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    energy: Energy = Energy()
    initial: Mapping[str, sp.Expr] = field(default_factory=dict)  # "q" and "q'" -> SI value
    guess: Mapping[str, sp.Expr] = field(default_factory=dict)  # for dependent coordinates
    range: Mapping[str, tuple[sp.Expr, sp.Expr]] = field(default_factory=dict)
    outputs: tuple[Output, ...] = ()
    expect: Expectation = Expectation()
    simulation: Simulation = Simulation()
    with_units: bool = False  # the spec states units, so every formula is dimension-checked
    digest: str = ""  # sha256 of the spec's text

    @property
    def guides(self) -> tuple[Constraint, ...]:
        """Two-sided constraints with friction: the motion is that of a mode, stick or slip."""
        return tuple(c for c in self.constraints if c.rubs and c.kind != "unilateral")
