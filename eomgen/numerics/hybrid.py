"""Runs of scenes with contacts: events are located, impacts applied, modes changed.

Between events a mode is integrated by DOP853. An event is where one of the mode's watched values
falls to zero: bracketed on the dense output, then found by Brent's method on steps that end there,
so that its error is that of the integration.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from importlib import import_module

import numpy as np

from eomgen.errors import CheckError
from eomgen.numerics import contact_modes
from eomgen.numerics.adaptive import (
    Dense,
    Problem,
    Stepper,
    Tolerances,
    table,
    work_of,
)
from eomgen.numerics.contact_modes import FORCE, GAP, RESERVE, SPEED, Mode, Scene
from eomgen.numerics.records import Array, Event, Rows

METHOD = "dop853"
SAMPLES = 12  # of a step, where the sign of an event is looked at
ROUNDING = {GAP: 2e-15, SPEED: 1e-13, FORCE: 1e-13, RESERVE: 1e-13}  # of a value's scale
STANDING = 1e-13  # of the time: it did not pass
FORCES = (FORCE, RESERVE)
MOST_CHANGES = 50  # of the mode while the time stands still
ACCUMULATED = 2e-6  # of the run: impacts that will have ended so soon are taken to have ended
SHORTEST = 2e-7  # of the run: a flight so short is rounding as much as motion


@dataclass
class _Impacts:
    """Times of the impacts of each contact, to see them accumulate (Zeno)."""

    span: float  # of the run [s]
    times: dict[str, list[float]] = field(default_factory=dict)

    def end(self, contact: str, t: float) -> float | None:
        """When the impacts of a contact will have ended, if that is now for all that matters.

        Intervals that shrink by the factor r end after the last one times r / (1 - r).
        """
        known = self.times.setdefault(contact, [])
        known.append(t)
        if len(known) < 4:
            return None
        first, second, third = (float(d) for d in np.diff(known[-4:]))
        is_shrinking = third < second < first
        left = third * third / (second - third) if is_shrinking else float("inf")
        if third < SHORTEST * self.span or left < ACCUMULATED * self.span:
            return t + left if is_shrinking else t
        return None


@dataclass(frozen=True)
class _Leg:
    """A piece of one mode: from, to, the state in between and at its end, what ended it."""

    start: float
    end: float
    dense: Dense
    state: Array
    ended: str  # the contact whose event it was; empty if none


def pieces(scene: Scene, outputs: Array, state: Array, limits: Tolerances) -> Iterator[Rows]:
    """The rows at the output times, the first one the start, with the events up to there.

    Raises:
        CheckError: an impact is not described, no mode holds, or the solver gives up.
        UsageError: SciPy is not installed.
    """
    impacts, t, done, total = _Impacts(scene.span), float(outputs[0]), 1, 0.0
    first = state.reshape(1, -1)
    mode, state, rows = _entered(scene, impacts, t, state)
    yield replace(rows, times=outputs[:1], states=first, works=np.zeros(1), mode=mode.name)
    total -= rows.lost
    stood, before = 0, mode
    while t < outputs[-1]:
        since = t
        for leg in _legs(scene, mode, (t, float(outputs[-1])), state, limits):
            until = int(np.searchsorted(outputs, leg.end, side="right"))
            flow = scene.flow(mode)
            times = outputs[done:until]
            states = [scene.projected(mode, s, leg.dense(s)) for s in times]
            works = [total + work_of(flow, leg.start, s, leg.dense) for s in times]
            total += work_of(flow, leg.start, leg.end, leg.dense)
            yield Rows(times, table(states, len(state)), np.array(works), 1, mode=mode.name)
            t, state, done = leg.end, leg.state, until
        if t >= outputs[-1]:
            return
        stood = _stood(stood, t - since, (t, before.name, mode.name))
        before = mode
        mode, state, rows = _entered(scene, impacts, t, state)
        if mode.name != before.name:
            rows = replace(rows, events=(*rows.events, Event(t, leg.ended, f"mode {mode.name}")))
        total -= rows.lost
        yield _only(rows, len(state))


def _stood(before: int, passed: float, at: tuple[float, str, str]) -> int:
    """How often the mode has changed while the time stood still.

    Raises:
        CheckError: it changes without end.
    """
    t, first, second = at
    if before >= MOST_CHANGES:
        raise CheckError(
            f"the modes of the contacts change without end at t = {t:.9g} s, between {first} and "
            f"{second}"
        )
    return before + 1 if passed <= STANDING * max(1.0, abs(t)) else 0


def _only(rows: Rows, size: int) -> Rows:
    return replace(rows, states=table([], size))


def _entered(scene: Scene, impacts: _Impacts, t: float, state: Array) -> tuple[Mode, Array, Rows]:
    """The mode from here on, after impacts; these with the energy that they took."""
    after, events = contact_modes.hit(scene, t, state)
    for event in events:
        end = impacts.end(event.contact, t)
        if end is not None:
            what = f"impacts accumulate at t = {end:.9g} s: the contact is closed from here"
            events = (*events, Event(t, event.contact, what))
            after = contact_modes.resting(scene, event.contact, t, after)
            impacts.times[event.contact].clear()
    mode, after = contact_modes.choose(scene, t, after)
    flow = scene.flow(mode)
    lost = float(flow(t, state)[0] - flow(t, after)[0]) if events else 0.0
    none = np.zeros(0)
    return mode, after, Rows(none, none, none, 0, 0, {}, events, lost)


def _legs(
    scene: Scene, mode: Mode, span: tuple[float, float], state: Array, limits: Tolerances
) -> Iterator[_Leg]:
    """Steps of a mode until something ends it, or to the end."""
    given = Problem(scene.slope(mode), project=lambda t, y: (scene.projected(mode, t, y), 0))
    least = _least(scene, mode, span[0], state)
    stepper = Stepper(METHOD, given, span, state, limits)
    while not stepper.is_finished:
        start, end, dense, _ = stepper.advance()
        exact = _exact(scene, mode, (start, state), limits)
        found = _earliest(scene, mode, (start, end, dense), exact, least)
        if found is not None:
            t, contact = found
            yield _Leg(start, t, dense, scene.projected(mode, t, exact(t)), contact)
            return
        state = np.array(stepper.solver.y)
        yield _Leg(start, end, dense, state, "")


def _least(scene: Scene, mode: Mode, t: float, state: Array) -> Array:
    """What each watched value must fall below: zero, less what may be rounding."""
    values = np.abs(scene.watched(mode, t, state))
    place, speed = contact_modes.scales(state)
    forces = [v for v, (q, _) in zip(values, mode.events, strict=True) if q in FORCES]
    scale = dict.fromkeys(FORCES, max(forces, default=0.0)) | {GAP: place, SPEED: speed}
    return np.array([-ROUNDING[quantity] * scale[quantity] for quantity, _ in mode.events])


def _exact(
    scene: Scene, mode: Mode, start: tuple[float, Array], limits: Tolerances
) -> Callable[[float], Array]:
    """The state at a time of a step, by steps of its own that end there."""
    since, state = start

    def at(t: float) -> Array:
        if t <= since:
            return state
        stepper = Stepper(METHOD, Problem(scene.slope(mode)), (since, t), state, limits)
        while not stepper.is_finished:
            stepper.advance()
        return np.array(stepper.solver.y)

    return at


def _earliest(
    scene: Scene,
    mode: Mode,
    step: tuple[float, float, Dense],
    exact: Callable[[float], Array],
    least: Array,
) -> tuple[float, str] | None:
    """The first event of a step: its time and contact."""
    start, end, dense = step
    times = np.linspace(start, end, SAMPLES + 1)
    values = np.array([scene.watched(mode, t, dense(t)) for t in times]) - least
    best: tuple[float, str] | None = None
    for i, (_, contact) in enumerate(mode.events):
        below = np.flatnonzero(values[1:, i] < 0)
        if not below.size:
            continue

        def value(t: float, i: int = i) -> float:
            return float(scene.watched(mode, t, exact(t))[i] - least[i])

        root = _root(value, float(times[below[0]]), float(times[below[0] + 1]))
        if best is None or root < best[0]:
            best = (root, contact)
    return best


def _root(value: Callable[[float], float], low: float, high: float) -> float:
    """Where a value falls to zero, to the last digits of the time."""
    brentq = import_module("scipy.optimize").brentq
    if not value(low) > 0:
        return low
    if not value(high) < 0:  # the dense output was below zero by its own error
        return high
    return float(brentq(value, low, high, xtol=1e-14 * max(1.0, abs(high)), rtol=1e-15))
