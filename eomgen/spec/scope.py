"""What a formula may hold where it stands: one table of uses, one of names."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp

from eomgen import model
from eomgen.dimension import Dimension
from eomgen.spec.ledger import CONSEQUENCE, Ledger, Mistake, suggestion
from eomgen.spec.reader import Scalar
from eomgen.spec.syntax import Name, Relation, Tree

PRIMES = ("", "'", "''")

FIXED = frozenset({"parameter"})
TIMED = FIXED | {"time", "prescribed"}
PLACED = TIMED | {"coordinate"}
MOVING = PLACED | {"coordinate'", "prescribed'", "prescribed''", "speed"}
DRIVEN = MOVING | {"input"}
EVERYTHING = DRIVEN | {"coordinate''", "speed'"}

USES: dict[str, frozenset[str]] = {  # what a formula describes -> what may stand in it
    "parameter": FIXED,
    "prescribed motion": FIXED | {"time"},
    "speed": MOVING - {"speed"},
    "gravity": TIMED,
    "position": PLACED | {"point", "body"},
    "offset": PLACED,
    "mass centre": FIXED,
    "axis": FIXED,
    "turn": PLACED,
    "mass": FIXED,
    "inertia": FIXED,
    "stiffness": TIMED,
    "free length": TIMED,
    "elongation": PLACED,
    "spring law": TIMED | {"local"},
    "damping": DRIVEN,
    "damper law": DRIVEN | {"local"},
    "force": DRIVEN,
    "moment": DRIVEN,
    "kinetic energy": MOVING,
    "potential energy": PLACED,
    "dissipation": MOVING,
    "initial value": FIXED,
    "range": FIXED,
    "equilibrium": FIXED | {"input"},
    "holonomic constraint": PLACED,
    "nonholonomic constraint": PLACED | {"coordinate'", "prescribed'", "speed"},
    "unilateral constraint": PLACED,
    "equation of places": frozenset({"point", "body"}),
    "restitution": FIXED,
    "friction": FIXED,
    "output": EVERYTHING,
    "claim": EVERYTHING,
}

BETWEEN_RATES = "write 'nonholonomic' for a relation between rates"
OF_POSITIONS = "a gap is a formula of positions; it is differentiated for you"
KNOWN_MOTION = "a motion that is known beforehand stands under 'prescribed'"
INSTEAD = {  # use and what stands in it -> remedy
    ("holonomic constraint", "coordinate'"): BETWEEN_RATES,
    ("holonomic constraint", "speed"): BETWEEN_RATES,
    ("holonomic constraint", "input"): KNOWN_MOTION,
    ("nonholonomic constraint", "coordinate''"): "a constraint holds no accelerations",
    ("nonholonomic constraint", "input"): KNOWN_MOTION,
    ("unilateral constraint", "coordinate'"): OF_POSITIONS,
    ("unilateral constraint", "input"): KNOWN_MOTION,
    ("equation of places", "coordinate"): "name two points or bodies, or write a scalar equation",
}


@dataclass(frozen=True)
class Known:
    """What a name stands for: expressions of its value, rate and acceleration, as far as it has."""

    kind: str
    expressions: tuple[sp.Expr, ...]
    dimension: Dimension | None = None
    spot: Scalar | None = None


@dataclass(frozen=True)
class Local:
    """A name of one formula only: `s` or `v`, whose dimension is that of trees to powers."""

    name: str
    symbol: sp.Symbol
    dimension: Dimension
    by: tuple[tuple[Tree, int], ...] = ()


@dataclass(frozen=True)
class Wanted:
    """What a formula is for: `what` names it, `use` says what may stand in it.

    Its dimension must be `dimension` * product(tree_i ^ power_i); None: only its terms must agree.
    """

    use: str
    what: str
    dimension: Dimension | None = None
    by: tuple[tuple[Tree, int], ...] = ()
    local: Local | None = None


@dataclass(frozen=True)
class Statement:
    """A formula whose dimensions are to be checked."""

    tree: Tree | Relation
    wanted: Wanted


@dataclass
class Scene:
    """What the formulas of one file are read against, and what is still to be checked."""

    ledger: Ledger
    space: str
    names: dict[str, Known] = field(default_factory=dict)
    statements: list[Statement] = field(default_factory=list)
    values: dict[str, Known] = field(default_factory=dict)  # of the parameters that have one
    units_seen: bool = False
    complete: bool = True  # False: names are missing because a whole section is wrong

    @property
    def size(self) -> int:
        """The number of components of a vector."""
        return model.SPACES[self.space]


def resolve(name: Name, scene: Scene, use: str, local: Local | None = None) -> Known:
    """What the name stands for; raises `Mistake` where it is unknown or out of place."""
    if local is not None and name.name == local.name and name.order == 0:
        return Known("local", (local.symbol,), local.dimension)
    known = scene.names.get(name.name)
    if known is None:
        raise Mistake(
            name.span,
            "E301" if scene.complete else CONSEQUENCE,
            f"unknown name '{name.name}'",
            suggestion(name.name, usable(scene.names, use)),
        )
    kind = known.kind + PRIMES[name.order]
    if known.expressions and name.order >= len(known.expressions):
        raise Mistake(
            name.span, "E302", f"'{name.span.text}': {article(known.kind)} has no such rate"
        )
    if kind not in USES[use] and known.kind != "constant":
        what = WORDS.get(kind, WORDS[known.kind])
        message = f"'{name.span.text}' is {what} and may not stand in {article(use)}"
        raise Mistake(name.span, "E302", message, INSTEAD.get((use, kind), ""))
    return known


def usable(names: Mapping[str, Known], use: str) -> list[str]:
    """The names whose value may stand there."""
    return [n for n, known in names.items() if known.kind in USES[use]]


UNCOUNTED = (
    *("gravity", "dissipation", "damping", "stiffness", "kinetic energy", "time"),
    *("restitution", "friction"),
)


def article(noun: str) -> str:
    """`an input`, `a force`."""
    if noun in UNCOUNTED:
        return noun
    return f"an {noun}" if noun[0] in "aeio" else f"a {noun}"


WORDS = {
    "parameter": "a parameter",
    "time": "the time",
    "prescribed": "a prescribed motion",
    "prescribed'": "the rate of a prescribed motion",
    "prescribed''": "the acceleration of a prescribed motion",
    "coordinate": "a coordinate",
    "coordinate'": "a rate",
    "coordinate''": "an acceleration",
    "speed": "a speed",
    "speed'": "the rate of a speed",
    "quaternion": "a quaternion",
    "input": "an input",
    "point": "a point",
    "body": "a body",
    "output": "an output",
    "reaction": "a reaction",
}
