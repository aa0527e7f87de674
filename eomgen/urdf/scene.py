"""The sections of a spec, level frames, as records of finished text."""

from __future__ import annotations

from dataclasses import dataclass, field

AXES = "xyz"
NOWHERE = ("0", "0", "0")
Turn = str  # such as [z, q]
Vector = tuple[str, ...]  # three formulas


@dataclass(frozen=True)
class Frame:
    """Axes on a body, or on the world: displaced, then turned."""

    on: str | None = None
    at: Vector = NOWHERE
    turns: tuple[Turn, ...] = ()


@dataclass(frozen=True)
class Body:
    """A body of the spec; mass "0" for a mere frame."""

    name: str
    frame: Frame
    mass: str = "0"
    com: Vector = NOWHERE
    inertia: tuple[str, ...] = ()


@dataclass(frozen=True)
class Coordinate:
    """A coordinate with its unit, its range and where it begins; `speeds` if not its rate."""

    name: str
    unit: str
    range: tuple[str, str] | None = None
    start: str = "0"
    speeds: tuple[str, ...] = ()


@dataclass(frozen=True)
class Along:
    """A damper or a motor: what it acts along, and its damping or force."""

    name: str
    along: str
    strength: str


@dataclass
class Scene:
    """The sections of a spec; parameters stand in groups, one for each link."""

    parameters: dict[str, dict[str, str]] = field(default_factory=dict)
    coordinates: list[Coordinate] = field(default_factory=list)
    inputs: dict[str, str] = field(default_factory=dict)
    bodies: list[Body] = field(default_factory=list)
    points: dict[str, Frame] = field(default_factory=dict)
    dampers: list[Along] = field(default_factory=list)
    forces: list[Along] = field(default_factory=list)


def turn(axis: str, angle: str) -> Turn:
    """A turn about an axis."""
    return f"[{axis}, {angle}]"


def plus(left: str, right: str) -> str:
    """The sum of two formulas."""
    if "0" in (left, right):
        return right if left == "0" else left
    return f"{left} - {right[1:]}" if right.startswith("-") else f"{left} + {right}"


def times(factor: str, formula: str) -> str:
    """The product of a number or name and a formula."""
    if "0" in (factor, formula):
        return "0"
    guarded = f"({formula})" if " " in formula or formula.startswith("-") else formula
    if factor in ("1", "-1"):
        return formula if factor == "1" else f"-{guarded}"
    return f"{factor}*{guarded}"
