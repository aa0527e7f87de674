"""What the user wants: notes, and of a linked scene a formulation and stabilised rows."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from eomgen.errors import UsageError

FORMULATIONS = ("minimal", "nullspace", "multiplier")
NAMES = ("auto", *FORMULATIONS)
INTEGRATORS = (  # of fixed steps, in generated code, then adaptive
    "semi-euler", "semi-euler-damped", "verlet", "rk4", "dopri5", "rosenbrock2", "midpoint",
    "dop853", "lsoda", "radau", "cvode",
)  # fmt: skip
LARGEST = Fraction(1, 5)  # alpha * h: above, Baumgarte's terms cost the integrator its order


METHODS = ("newton", "dalembert", "lagrange", "lagrange1", "kane")


@dataclass(frozen=True)
class Wanted:
    """A formulation of `NAMES`; baumgarte: alpha [1/s], zero for none.

    notes: people will read the closed form; else a scene too large for one needs none.
    method: one of `METHODS`, which is shown and compared with the others; None: as ever.
    functions: the only functions that will be read of the program; (): all.
    """

    formulation: str = "auto"
    baumgarte: Fraction = Fraction(0)
    notes: bool = False
    method: str | None = None
    functions: tuple[str, ...] = ()


AUTO = Wanted()


def wanted(formulation: str, baumgarte: str | None, step: str | None) -> Wanted:
    """The record of what the command line was given, alpha capped at 0.2/h for the step h [s].

    Raises:
        UsageError: a number is no positive decimal, the step is missing, or alpha is too large.
    """
    if baumgarte is None and step is None:
        return Wanted(formulation)
    if baumgarte is None or step is None:
        raise UsageError("--baumgarte ALPHA needs --step H, the step it will be integrated with")
    if formulation not in ("auto", "multiplier"):
        raise UsageError(f"--baumgarte stabilises multipliers, not the formulation {formulation}")
    alpha, h = _positive(baumgarte, "--baumgarte"), _positive(step, "--step")
    if alpha * h > LARGEST:
        raise UsageError(
            f"--baumgarte {baumgarte}: at most {float(LARGEST / h):g} for the step {step} "
            "(0.2/h): larger values lower the order of the integrator"
        )
    return Wanted("multiplier", alpha)


def _positive(text: str, what: str) -> Fraction:
    try:
        value = Fraction(text)
    except (ValueError, ZeroDivisionError):
        value = Fraction(0)
    if value <= 0 or "/" in text or len(text) > 40:
        raise UsageError(f"{what}: {text[:40]!r} is not a positive decimal number")
    return value
