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

from eomgen.numerics import contact_modes
from eomgen.numerics.adaptive import (
    Dense,
    Problem,
    Stepper,
    Tolerances,
    table,
    work_of,
)
from eomgen.numerics.contact_modes import NEARLY, Mode, Scene
from eomgen.numerics.records import Array, Event, Rows

METHOD = "dop853"
SAMPLES = 12  # of a step, where the sign of an event is looked at
HALVINGS = 60
ACCUMULATED = 1e-6  # seconds: impacts that end so soon are taken to have ended


@dataclass
class _Impacts:
    """Times of the impacts of each contact, to see them accumulate (Zeno)."""

    times: dict[str, list[float]] = field(default_factory=dict)

    def end(self, contact: str, t: float) -> float:
        """When the impacts of a contact will have ended, infinite where they do not.

        Intervals that shrink by the factor r end after the last one times r / (1 - r).
        """
        known = self.times.setdefault(contact, [])
        known.append(t)
        if len(known) < 4:
            return float("inf")
        first, second, third = np.diff(known[-4:])
        if not third < second < first:
            return float("inf")
        return float(t + third * third / (second - third))


@dataclass(frozen=True)
class _Leg:
    """A piece of one mode: from, to, the state in between and at its end, what ended it."""

    start: float
    end: float
    dense: Dense
    state: Array
    ended: str  # the contact whose event it was; empty if none


def pieces(scene: Scene, outputs: Array, state: Array, limits: Tolerances) -> Iterator[Rows]:
    """The rows at outputs[1:] with the events up to there; the run starts at outputs[0].

    Raises:
        CheckError: an impact is not described, no mode holds, or the solver gives up.
        UsageError: SciPy is not installed.
    """
    impacts, t, done, total = _Impacts(), float(outputs[0]), 1, 0.0
    mode, state, rows = _entered(scene, impacts, t, state)
    yield _only(rows, len(state))
    total -= rows.lost
    while t < outputs[-1]:
        for leg in _legs(scene, mode, (t, float(outputs[-1])), state, limits):
            until = int(np.searchsorted(outputs, leg.end, side="right"))
            flow = scene.flow(mode)
            times = outputs[done:until]
            states = [scene.projected(mode, s, leg.dense(s)) for s in times]
            works = [total + work_of(flow, leg.start, s, leg.dense) for s in times]
            total += work_of(flow, leg.start, leg.end, leg.dense)
            yield Rows(times, table(states, len(state)), np.array(works), 1)
            t, state, done = leg.end, leg.state, until
        if t >= outputs[-1]:
            return
        before = mode
        mode, state, rows = _entered(scene, impacts, t, state)
        if mode.name != before.name:
            rows = replace(rows, events=(*rows.events, Event(t, leg.ended, f"mode {mode.name}")))
        total -= rows.lost
        yield _only(rows, len(state))


def _only(rows: Rows, size: int) -> Rows:
    return replace(rows, states=table([], size))


def _entered(scene: Scene, impacts: _Impacts, t: float, state: Array) -> tuple[Mode, Array, Rows]:
    """The mode from here on, after impacts; these with the energy that they took."""
    after, events = contact_modes.hit(scene, t, state)
    for event in events:
        end = impacts.end(event.contact, t)
        if end - t < ACCUMULATED:
            what = f"impacts accumulate at t = {end:.9g} s: the contact is closed from here"
            events = (*events, Event(t, event.contact, what))
            after = _closed(scene, event.contact, t, after)
            impacts.times[event.contact].clear()
    mode, after = contact_modes.choose(scene, t, after)
    flow = scene.flow(mode)
    lost = float(flow(t, state)[0] - flow(t, after)[0]) if events else 0.0
    none = np.zeros(0)
    return mode, after, Rows(none, none, none, 0, 0, {}, events, lost)


def _closed(scene: Scene, contact: str, t: float, state: Array) -> Array:
    """The state with a contact at rest."""
    alone = next(m for m in scene.modes if m.closed == (contact,))
    return scene.projected(alone, t, state)


def _legs(
    scene: Scene, mode: Mode, span: tuple[float, float], state: Array, limits: Tolerances
) -> Iterator[_Leg]:
    """Steps of a mode until something ends it, or to the end."""
    given = Problem(scene.slope(mode), project=lambda t, y: (scene.projected(mode, t, y), 0))
    stepper = Stepper(METHOD, given, span, state, limits)
    is_first = True
    while not stepper.is_finished:
        start, end, dense, _ = stepper.advance()
        exact = _exact(scene, mode, (start, state), limits)
        found = _earliest(scene, mode, (start, end, dense), exact, is_first)
        if found is not None:
            t, contact = found
            yield _Leg(start, t, dense, scene.projected(mode, t, exact(t)), contact)
            return
        state, is_first = np.array(stepper.solver.y), False
        yield _Leg(start, end, dense, state, "")


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
    is_first: bool,
) -> tuple[float, str] | None:
    """The first event of a step: its time and contact."""
    start, end, dense = step
    times = np.linspace(start, end, SAMPLES + 1)
    values = [scene.watched(mode, t, dense(t)) for t in times]
    best: tuple[float, str] | None = None
    for i, (quantity, contact) in enumerate(mode.events):
        series = [float(v[i]) for v in values]
        below = next((k for k, v in enumerate(series) if k and v < 0), None)
        if below is None:
            continue

        def value(t: float, i: int = i) -> float:
            return float(scene.watched(mode, t, exact(t))[i])

        low = float(times[below - 1])
        if is_first and below == 1:
            low = _positive(value, (start, float(times[1])), NEARLY[quantity])
        root = _root(value, low, float(times[below]))
        if best is None or root < best[0]:
            best = (root, contact)
    return best


def _positive(value: Callable[[float], float], span: tuple[float, float], nearly: float) -> float:
    """A time after the start at which a value that starts near zero is positive, or the start."""
    start, end = span
    if value(start) > nearly:
        return start
    for k in range(1, HALVINGS):
        t = start + (end - start) * 0.5**k
        if value(t) > 0:
            return t
    return start


def _root(value: Callable[[float], float], low: float, high: float) -> float:
    """Where a value falls to zero, to the last digits of the time."""
    brentq = import_module("scipy.optimize").brentq
    if not value(low) > 0:
        return low
    if not value(high) < 0:  # the dense output was below zero by its own error
        return high
    return float(brentq(value, low, high, xtol=1e-14 * max(1.0, abs(high)), rtol=1e-15))
