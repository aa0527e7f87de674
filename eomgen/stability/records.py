"""What the stability of a scene is: where it was looked at, and what was found."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from eomgen.numerics.records import Array
from eomgen.stability.theory import Linear

START, REST, RANGE = "start", "rest", "range"  # kinds of places
UNDAMPED = 1e-6  # a damping ratio below it is rounding


@dataclass(frozen=True)
class Wish:
    """What the user said; `integrators` empty: all that the scene offers."""

    state: str = "{}"
    inputs: tuple[str, ...] = ()
    integrators: tuple[str, ...] = ()
    horizon: float = 10.0  # s: stiffness, accuracy and chaos are matters of the length of a run


@dataclass(frozen=True)
class Place:
    """A state (n,) with the linearised motion y' = f + A (y - state)."""

    name: str
    kind: str
    time: float
    state: Array
    motion: Linear
    at_rest: bool  # f = 0

    @property
    def matrix(self) -> Array:
        """A (n, n)."""
        return self.motion.matrix


@dataclass(frozen=True)
class Mode:
    """A motion e^(lambda t) at a place."""

    place: str
    value: complex  # lambda [1/s]

    @property
    def rate(self) -> float:
        """|lambda| [1/s]."""
        return abs(self.value)

    @property
    def damping_ratio(self) -> float:
        """-Re lambda / |lambda|: 0 undamped, 1 a decay, negative where it grows by itself."""
        return -self.value.real / abs(self.value)

    def __str__(self) -> str:
        """In a few words."""
        ratio = self.damping_ratio
        if abs(self.value.imag) < UNDAMPED * self.rate:
            return f"{self.rate:.4g}/s ({'decays' if ratio > 0 else 'grows'})"
        damping = "undamped" if abs(ratio) < UNDAMPED else f"damping ratio {ratio:.3g}"
        return f"{self.rate:.4g} rad/s ({damping})"


@dataclass(frozen=True)
class Spectrum:
    """The fastest and the slowest mode of a place that is no motion of constant rate."""

    fastest: Mode
    slowest: Mode
    stiff: bool  # some mode decays at least `DAMPED` and a thousand times faster than the run


@dataclass(frozen=True)
class Limit:
    """The largest stable step [s] of a method; infinite: none; None: it could not be measured.

    predicted: the smallest by the eigenvalues of all places; measured: of the C at that place;
    run: of the C in a run from the start.
    """

    method: str
    predicted: float
    place: str
    measured: float | None
    run: float | None

    @property
    def ratio(self) -> float | None:
        """Measured over predicted, where both are numbers."""
        return _over(self.measured, self.predicted)

    @property
    def run_ratio(self) -> float | None:
        """That of the run over predicted, where both are numbers."""
        return _over(self.run, self.predicted)

    @property
    def safe(self) -> float:
        """The smallest of all that is known."""
        return min(v for v in (self.predicted, self.measured, self.run) if v is not None)


def _over(found: float | None, predicted: float) -> float | None:
    return found / predicted if found is not None and 0 < predicted < inf > found else None


@dataclass(frozen=True)
class Rounding:
    """What a number type costs: the error of accelerations, and the step below which it rules."""

    real: str
    error: float  # relative
    floors: dict[str, float]  # method -> step [s]; none where nothing oscillates


@dataclass(frozen=True)
class Condition:
    """The largest condition number of a matrix that the motion divides by, and where."""

    matrix: str
    value: float
    place: str


@dataclass(frozen=True)
class Findings:
    """Everything that is printed."""

    title: str
    name: str
    formulation: str
    horizon: float
    looked: tuple[str, ...]  # at what, in words
    inputs: tuple[tuple[str, float], ...]
    spectra: tuple[Spectrum, ...]  # of the start and of equilibria
    fastest: Mode | None  # anywhere
    limits: tuple[Limit, ...]  # of each method
    accurate: float | None  # step of rk4 for `ACCURACY` of the fastest mode that lasts
    conditions: tuple[Condition, ...]
    rounding: tuple[Rounding, ...]
    warnings: tuple[str, ...]  # W-...
    notes: tuple[str, ...]  # I-...
    omitted: tuple[str, ...]  # what is not reported, and why
