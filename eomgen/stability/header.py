"""Findings as comments and numbers of a C header."""

from __future__ import annotations

from collections.abc import Iterator
from math import floor, isfinite, log10

from eomgen.render.code_context import Constant, Remarks
from eomgen.stability.make import LOSES
from eomgen.stability.records import Findings
from eomgen.stability.words import step

DIGITS = 2  # of a step, rounded down


def remarks(found: Findings) -> Remarks:
    """What a person reads, and what a program can test its step against."""
    return Remarks(tuple(_lines(found)), tuple(_constants(found)))


def _lines(found: Findings) -> Iterator[str]:
    named = ", ".join(f"{name} = {value:.6g}" for name, value in found.inputs)
    yield f"formulation {found.formulation}{f', inputs {named}' if named else ''}"
    yield f"looked at {'; '.join(found.looked)}"
    for s in found.spectra:
        yield f"{s.fastest.place}: fastest {s.fastest}, slowest {s.slowest}"
    for x in found.limits:
        yield (
            f"{x.method}: largest step [s] {step(x.predicted)} by eigenvalues ({x.place}), "
            f"{step(x.measured)} by this code there, {step(x.run)} in a run from the start"
        )
    yield from (*found.warnings, *found.notes)
    yield from (f"not known: {line}" for line in found.omitted)


def _constants(found: Findings) -> Iterator[Constant]:
    for x in found.limits:
        if isfinite(x.safe):
            about = "s, the smallest of all that is known"
            yield Constant(f"MAX_STEP_{_spelled(x.method)}", rounded_down(x.safe), about)
    if found.fastest is not None:
        yield Constant("FASTEST_MODE", f"{found.fastest.rate:.3e}", "1/s, anywhere")
        yield Constant("FASTEST_DAMPING", f"{found.fastest.damping_ratio:.3e}", "its damping ratio")
        slowest = min((s.slowest.rate for s in found.spectra), default=found.fastest.rate)
        yield Constant("SLOWEST_MODE", f"{slowest:.3e}", "1/s, at the start and at rest")
    stiff = any(s.stiff for s in found.spectra)
    yield Constant("STIFF", str(int(stiff)), "1 where damping limits explicit steps", truth=True)
    worst = max((c.value for c in found.conditions), default=float("inf"))
    if isfinite(worst):
        yield Constant("CONDITION", f"{worst:.3e}", "of what is divided by, the largest")
    single = next(r for r in found.rounding if r.real == "float")
    is_safe = single.error <= LOSES and isfinite(worst)
    yield Constant("SAFE_FLOAT", str(int(is_safe)), f"1 where float is off by < {LOSES:g}", True)
    for name, least in single.floors.items():
        about = "s, below it float rounds more than it gains"
        yield Constant(f"FLOAT_MIN_STEP_{_spelled(name)}", f"{least:.1e}", about)


def _spelled(method: str) -> str:
    return method.replace("-", "_").upper()


def rounded_down(value: float) -> str:
    """A positive number with `DIGITS` digits, none of them rounded up; zero as it is."""
    if value <= 0:
        return "0.0"
    power = floor(log10(value)) - DIGITS + 1
    return f"{floor(value / 10.0**power * (1 + 1e-12)) * 10.0**power:.{DIGITS - 1}e}"
