"""Which method a run takes and with which step, and why, in one line."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from math import floor, log10

import numpy as np

from eomgen.errors import UsageError
from eomgen.integrators.methods import METHODS
from eomgen.numerics import adaptive
from eomgen.numerics.records import Array, Stopped
from eomgen.simulate_setup import Setup, is_separable, touching_of
from eomgen.study import Study

AUTO = "auto"
NAMES = (AUTO, *METHODS, *adaptive.NAMES)
DAMPED = 0.3  # |Re| of the size of an eigenvalue: above, the mode decays rather than oscillates
STIFF = 1000.0  # |eigenvalue| times the run: above, stability and not accuracy limits the step
LONG = 1e5  # radians of the fastest mode: a symplectic method pays
FRACTION = 0.05  # of the time 1/omega of the fastest mode: the step of a fixed-step method
RTOL, RTOL_CONTACTS = 1e-8, 1e-10
SHARE = 1e-3  # of rtol: atol, in SI units
DIVISIONS = 1000  # of the run: the step where nothing oscillates


@dataclass(frozen=True)
class Wish:
    """What the user said of the method; None: not said."""

    method: str = AUTO
    step: float | None = None
    rtol: float | None = None
    atol: float | None = None


@dataclass(frozen=True)
class Choice:
    """The method, and why; fixed ones with a step [s], adaptive ones with tolerances."""

    method: str
    why: str
    step: float = 0.0
    limits: adaptive.Tolerances = adaptive.Tolerances(RTOL, RTOL * SHARE)

    @property
    def is_fixed(self) -> bool:
        """Whether the steps are ours."""
        return self.method in METHODS


def checked(wish: Wish, study: Study) -> Wish:
    """The wish itself.

    Raises:
        UsageError: it contradicts itself or the scene.
    """
    has_contacts = touching_of(study) is not None
    if wish.step is not None and wish.method in adaptive.NAMES:
        raise UsageError(
            f"--step: {wish.method} finds its own; give --rtol, or a fixed-step method"
        )
    if (wish.rtol or wish.atol) and wish.method in METHODS:
        raise UsageError(f"--rtol and --atol: {wish.method} has a fixed step; give --step")
    if has_contacts and wish.method not in (AUTO, "dop853"):
        raise UsageError(
            f"{wish.method}: a scene with contacts is run by dop853, which locates their events; "
            "leave --method out"
        )
    if has_contacts and wish.step is not None:
        raise UsageError(
            "--step: a scene with contacts is run by dop853, which finds its own steps"
        )
    if study.machine.kept and wish.method in ("lsoda", "cvode"):
        raise UsageError(
            f"{wish.method} remembers earlier steps, so it cannot be brought back to constraints; "
            "use dop853, radau or a fixed step, or --formulation minimal where there is one"
        )
    return wish


def wanted(wish: Wish, study: Study) -> str:
    """The method to compile for: what was said, a step alone means rk4."""
    return "rk4" if wish.method == AUTO and wish.step is not None else wish.method


def choose(wish: Wish, setup: Setup, span: float) -> Choice:
    """The method of a run over `span` seconds, after the table of the README.

    Raises:
        UsageError: what the choice needs is not installed.
    """
    has_contacts = touching_of(setup.study) is not None
    limits = _limits(wish, has_contacts)
    if has_contacts:
        return Choice("dop853", "contacts: their events are located", limits=limits)
    values = eigenvalues(setup)
    name = wanted(wish, setup.study)
    if name == AUTO:
        name, why = _automatic(setup, values, span)
    else:
        why = "it was asked for" if wish.method == name else "a step was given"
    if name not in METHODS:
        return Choice(name, why, limits=limits)
    if wish.step is not None:
        return Choice(name, why, wish.step)
    step, how = _step(values, span, name)
    return Choice(name, f"{why}; {how}", step)


def _limits(wish: Wish, contacts: bool) -> adaptive.Tolerances:
    rtol = wish.rtol or (RTOL_CONTACTS if contacts else RTOL)
    return adaptive.Tolerances(rtol, wish.atol or rtol * SHARE)


def eigenvalues(setup: Setup) -> Array:
    """Of the linearised equations at the start [1/s]; none where they have no value."""
    try:
        start = setup.start
        matrix = setup.engine.function("state_jacobian")(start.time, start.state)
    except Stopped:
        return np.zeros(0)
    return np.linalg.eigvals(matrix) if np.all(np.isfinite(matrix)) else np.zeros(0)


def stiff(values: Array, span: float) -> Array:
    """Those that decay much faster than the run is long, and that no growth as fast mirrors.

    Away from rest a scene without dampers has pairs +-lambda: nothing decays there for good.
    """
    sizes = np.abs(values)
    fast = (values.real <= -DAMPED * sizes) & (sizes * span > STIFF)
    growth = max(0.0, float(np.max(values.real, initial=0.0)))
    chosen: Array = values[fast & (-values.real > 2 * growth)]
    return chosen


def _automatic(setup: Setup, values: Array, span: float) -> tuple[str, str]:
    fastest = _fastest(values)
    damped = stiff(values, span)
    has_scipy = find_spec("scipy") is not None
    if damped.size:
        why = f"stiff: a mode decays with {_fastest(damped):.3g}/s"
        return ("radau", why) if has_scipy else ("rosenbrock2", f"{why}; SciPy is not installed")
    is_long = fastest * span > LONG
    if is_long and setup.is_conserved and setup.is_compiled and is_separable(setup.study):
        return "verlet", f"long and conservative, M constant, {fastest * span:.1e} radians"
    why = f"smooth and not stiff: fastest mode {fastest:.3g} rad/s"
    return ("dop853", why) if has_scipy else ("rk4", f"{why}; SciPy is not installed")


def _fastest(values: Array) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _step(values: Array, span: float, name: str) -> tuple[float, str]:
    """A step of 0.05/omega of the fastest mode that is to be resolved, rounded down."""
    ignored = stiff(values, span) if METHODS[name].kind == "rosenbrock" else np.zeros(0)
    left = np.array([v for v in values if v not in ignored])
    fastest = _fastest(left)
    if fastest * span < 1:
        return span / DIVISIONS, f"step {span / DIVISIONS:.6g} s, a thousandth of the run"
    step = rounded_down(min(FRACTION / fastest, span))
    return step, f"step {step:.6g} s for the mode of {fastest:.3g} rad/s"


def rounded_down(value: float) -> float:
    """1, 2 or 5 times a power of ten, not above the value."""
    power = floor(log10(value))
    digit = max(d for d in (1, 2, 5) if d * 10.0**power <= value * (1 + 1e-12))
    return float(f"{digit}e{power}")
