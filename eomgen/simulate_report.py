"""The words at the end of a run, and whether it is to be trusted."""

from __future__ import annotations

from collections.abc import Iterator

from eomgen.numerics.compiled import compiler
from eomgen.numerics.records import words
from eomgen.simulate import BOTH, Verdict
from eomgen.simulate_method import Choice
from eomgen.simulate_setup import Setup
from eomgen.simulate_table import state_words

ENERGY_TOLERANCE = 1e-4  # of the largest kinetic energy and the span of the potential
MOST_EVENTS = 12  # shown at the head of the list; then the last ones
LAST_EVENTS = 3
NAMES = {"constraint_residuals": "position", "constraint_rates": "rate"}


def beginning(setup: Setup, choice: Choice) -> Iterator[str]:
    """What is going to be done, and why."""
    if choice.is_fixed:
        yield f"{choice.method}, step {choice.step:.9g} s ({choice.why})"
    else:
        yield f"{choice.method}, rtol {choice.limits.rtol:.3g} ({choice.why})"
    if not setup.is_compiled:
        yield "no C compiler: the generated Python runs, some hundred times slower"
    if setup.start.moved > 1e-12:
        yield f"the state was moved to the constraints, by {setup.start.moved:.3g} at most"


def ending(setup: Setup, verdict: Verdict, seconds: float) -> Iterator[str]:
    """What was done, and how well energy and constraints were kept."""
    by = f"C compiled by {compiler()[0]}" if setup.is_compiled else "Python"
    yield f"t = {verdict.time:.9g} s after {verdict.steps} steps, {seconds:.2g} s, {by}"
    yield from _events(verdict)
    yield _energy(setup, verdict)
    found = [f"{NAMES[n]} {verdict.residuals[n]:.2g}" for n in BOTH if n in verdict.residuals]
    if found:
        yield f"constraints: largest residual of {', of '.join(found)} (SI)"
    for bit, (count, first) in sorted(verdict.tally.items()):
        yield f"{count} step{'s' if count > 1 else ''}, first step {first}: {words(bit)}"


def _events(verdict: Verdict) -> Iterator[str]:
    lines = [f"  {e.time:.10g} s  {e.contact}: {e.what}" for e in verdict.events]
    if not lines:
        return
    yield f"events: {len(lines)}"
    left_out = len(lines) - MOST_EVENTS - LAST_EVENTS
    if left_out <= 0:
        yield from lines
        return
    yield from lines[:MOST_EVENTS]
    yield f"  ... {left_out} more ..."
    yield from lines[-LAST_EVENTS:]


def _energy(setup: Setup, verdict: Verdict) -> str:
    if setup.flow is None:
        return (
            "energy: not balanced, constraints that move do work that this formulation does not "
            "know; --formulation multiplier balances it"
        )
    parts = [f"energy: worst error {verdict.relative_energy_error:.2g}"]
    parts.append(f"of {verdict.energy_scale:.4g} J")
    done = verdict.work + verdict.lost
    if not setup.is_conserved and done:
        parts.append(f"after work of {done:.4g} J")
    if verdict.lost:
        parts.append(f"and {verdict.lost:.4g} J lost in impacts")
    return " ".join(parts)


def faults(setup: Setup, verdict: Verdict, tolerance: float) -> Iterator[str]:
    """Why the run is not to be trusted; nothing where it is."""
    if verdict.stopped:
        yield (
            f"stopped after t = {verdict.time:.9g} s: {words(verdict.stopped)}; the last row: "
            f"{state_words(setup, verdict.state)}"
        )
    if setup.flow is not None and not verdict.relative_energy_error <= tolerance:
        yield (
            f"W-ENERGY: the energy is off by {verdict.relative_energy_error:.2g} of its scale, "
            f"more than {tolerance:g}: the motion is not that of the equations; take a smaller "
            "step or rtol, another method or formulation, or say --energy-tolerance"
        )
