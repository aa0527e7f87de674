"""Which mode a scene with contacts is in: closed contacts press, open ones part, friction holds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eomgen.errors import CheckError
from eomgen.numerics.records import Array, Engine, Event, Function, Stopped

GAP, FORCE, RESERVE, SPEED = "gap", "normal force", "friction reserve", "slip speed"
FLIGHT, STICK, SLIDE = "flight", "stick", "slip"
NEARLY = {GAP: 1e-8, SPEED: 1e-7, FORCE: 1e-6, RESERVE: 1e-6}  # of its scale: taken for zero
NOISE = {GAP: 1e-15, SPEED: 1e-14, FORCE: 1e-10, RESERVE: 1e-10}  # of its scale: rounding
MOST_IMPACTS = 100  # at one instant
BEGINNING = 10.0  # times what is nearly zero: the slip speed with which a slip in space begins
PROBE = 1e-6  # of the time of the run: how far ahead a mode is tried


@dataclass(frozen=True)
class Mode:
    """What every contact does, and what ends it: (quantity, contact) of each event."""

    name: str
    states: Mapping[str, str]  # contact -> flight, contact, stick, slip, ...
    events: tuple[tuple[str, str], ...]

    @property
    def closed(self) -> tuple[str, ...]:
        """Contacts that are closed."""
        return tuple(c for c, state in self.states.items() if state != FLIGHT)


@dataclass(frozen=True)
class Scene:
    """A scene with contacts over the functions of its program."""

    engine: Engine
    modes: tuple[Mode, ...]
    one_sided: tuple[str, ...]  # contacts that can open, in the order of the gaps
    impacts: Mapping[str, str]  # contact -> function of its impact
    span: float  # of the run [s]
    unresisted: str = "accelerations"  # the function of those without friction

    @cached_property
    def functions(self) -> dict[str, Function]:
        """Functions that were used."""
        return {}

    def call(self, name: str, t: float, state: Array) -> Array:
        """The results of a function of the program."""
        if name not in self.functions:
            self.functions[name] = self.engine.function(name)
        return self.functions[name](t, state)

    def slope(self, mode: Mode) -> Function:
        """(q', u') in a mode."""
        name = "accelerations" if mode.name == FLIGHT else f"accelerations_{mode.name}"
        return lambda t, y: np.concatenate([y[len(y) // 2 :], self.call(name, t, y)])

    def watched(self, mode: Mode, t: float, state: Array) -> Array:
        """What ends the mode where it falls to zero.

        A slip in space has a size and no sign: it ends where it is nearly zero.
        """
        values = self.call(f"events_{mode.name}", t, state)
        least = NEARLY[SPEED] * scales(state)[1]
        for i, (quantity, contact) in enumerate(mode.events):
            if quantity == SPEED and mode.states[contact] == SLIDE:
                values[i] -= least
        return values

    def flow(self, mode: Mode) -> Function:
        """Energy and power in a mode."""
        return lambda t, y: self.call(f"energy_flow_{mode.name}", t, y)

    def projected(self, mode: Mode, t: float, state: Array) -> Array:
        """The state with the gaps of closed contacts at zero, and their rates."""
        if not mode.closed:
            return state
        n = len(state) // 2
        place = self.call(f"project_positions_{mode.name}", t, state)
        state = np.concatenate([place, state[n:]])
        return np.concatenate([place, self.call(f"project_rates_{mode.name}", t, state)])


def scales(state: Array) -> tuple[float, float]:
    """What a place and a speed of this state are compared with."""
    n = len(state) // 2
    return 1 + float(np.max(np.abs(state[:n]))), 1 + float(np.max(np.abs(state[n:])))


def hit(scene: Scene, t: float, state: Array) -> tuple[Array, tuple[Event, ...]]:
    """The state after the impacts of every closed gap that closes further.

    Raises:
        CheckError: the spec does not say what an impact does.
    """
    if not scene.one_sided:
        return state, ()
    place, speed = scales(state)
    found: list[Event] = []
    n = len(state) // 2
    for _ in range(MOST_IMPACTS):
        gaps, rates = scene.call("gaps", t, state), scene.call("gap_rates", t, state)
        struck = (gaps <= NEARLY[GAP] * place) & (rates < -1e-9 * speed)
        if not struck.any():
            return state, tuple(found)
        i = int(np.argmin(np.where(struck, rates, np.inf)))
        contact = scene.one_sided[i]
        if contact not in scene.impacts:
            raise CheckError(
                f"{contact} is hit at t = {t:.9g} s with the gap rate {rates[i]:.6g}, and the spec "
                "does not say what an impact does: give it `restitution`"
            )
        state = np.concatenate([state[:n], scene.call(scene.impacts[contact], t, state)])
        # the event was found a little below zero, from where no flight begins
        state = np.concatenate([resting(scene, contact, t, state)[:n], state[n:]])
        found.append(Event(t, contact, f"impact at {-rates[i]:.6g}"))
    names = ", ".join(dict.fromkeys(event.contact for event in found))
    raise CheckError(
        f"impacts do not end at t = {t:.9g} s: {names} strike in turn; lower the restitution"
    )


def resting(scene: Scene, contact: str, t: float, state: Array) -> Array:
    """The state with one contact closed and at rest, the others as they are."""
    alone = next(m for m in scene.modes if m.closed == (contact,))
    return scene.projected(alone, t, state)


def choose(scene: Scene, t: float, state: Array) -> tuple[Mode, Array]:
    """The mode that holds from this state on, and the state on its contacts.

    Modes with more closed and sticking contacts are preferred: contacts open only where they pull.

    Raises:
        CheckError: none holds.
    """
    candidates = list(_candidates(scene, t, state))
    force = _force_scale(scene, candidates, t, state)
    for mode in candidates:
        try:
            start = _started(scene, mode, t, state)
            if _holds(scene, mode, (t, start), force):
                return mode, start
        except Stopped:
            continue
    raise CheckError(
        f"no mode of the contacts holds at t = {t:.9g} s: friction jams, or a wall was passed; "
        f"tried {', '.join(m.name for m in candidates) or 'none'}"
    )


def _candidates(scene: Scene, t: float, state: Array) -> Iterator[Mode]:
    """Modes whose closed contacts touch and whose slip has the right direction."""
    place, speed = scales(state)
    touching = set()
    if scene.one_sided:
        gaps, rates = scene.call("gaps", t, state), scene.call("gap_rates", t, state)
        rest = (np.abs(gaps) <= NEARLY[GAP] * place) & (np.abs(rates) <= NEARLY[GAP] * speed)
        touching = {c for c, still in zip(scene.one_sided, rest, strict=True) if still}
    slips = _slips(scene, t, state)
    ordered = sorted(
        scene.modes,
        key=lambda m: (-len(m.closed), -list(m.states.values()).count(STICK)),
    )
    for mode in ordered:
        opened = {c for c in mode.closed if c in scene.one_sided} - touching
        if not opened and all(
            _agrees(mode.states[c], slip, NEARLY[SPEED] * speed)
            for c, slip in slips.items()
            if c in mode.closed
        ):
            yield mode


def _slips(scene: Scene, t: float, state: Array) -> dict[str, float]:
    """The slip speed of every contact with friction, signed where its mode has a direction."""
    found: dict[str, float] = {}
    for mode in scene.modes:
        for i, (quantity, contact) in enumerate(mode.events):
            if quantity == SPEED and contact not in found and mode.states[contact] != "slip_minus":
                try:
                    found[contact] = float(scene.watched(mode, t, state)[i])
                except Stopped:
                    continue
    return found


def _agrees(what: str, slip: float, nearly: float) -> bool:
    """Whether a contact that slips so can be in this state."""
    if not abs(slip) > nearly:  # at rest, or not known
        return True
    return (
        what != STICK and (what != "slip_plus" or slip > 0) and (what != "slip_minus" or slip < 0)
    )


def _force_scale(scene: Scene, modes: list[Mode], t: float, state: Array) -> float:
    """The largest force that a mode watches."""
    largest = 0.0
    for mode in modes:
        try:
            values = scene.watched(mode, t, state)
        except Stopped:
            continue
        watched = zip(values, mode.events, strict=True)
        forces = [abs(v) for v, (quantity, _) in watched if quantity in (FORCE, RESERVE)]
        largest = max([largest, *(f for f in forces if np.isfinite(f))])
    return largest


def _started(scene: Scene, mode: Mode, t: float, state: Array) -> Array:
    """The state on the contacts of the mode; a slip in space that begins gets its direction."""
    start = scene.projected(mode, t, state)
    n, least = len(state) // 2, NEARLY[SPEED] * scales(state)[1]
    if all(slip > least for slip in _sliding(scene, mode, t, start)):
        return start
    # friction has no direction at rest: begin along what would move it without friction
    push = np.concatenate([0 * state[:n], scene.call(scene.unresisted, t, start)])
    moved = scene.projected(mode, t, start + least * push)
    slips = _sliding(scene, mode, t, moved)
    if not min(slips, default=0.0) > 0:
        return moved
    return scene.projected(mode, t, start + BEGINNING * least**2 / min(slips) * push)


def _sliding(scene: Scene, mode: Mode, t: float, state: Array) -> list[float]:
    """The slip speeds of the contacts that slide in space."""
    values = scene.call(f"events_{mode.name}", t, state)
    pairs = zip(values, mode.events, strict=True)
    return [v for v, (quantity, c) in pairs if quantity == SPEED and mode.states[c] == SLIDE]


def _ahead(scene: Scene) -> float:
    return min(max(PROBE * scene.span, 1e-9), 1e-5)


def _holds(scene: Scene, mode: Mode, at: tuple[float, Array], force: float) -> bool:
    """Whether everything that the mode watches is positive, or grows from zero."""
    t, state = at
    place, speed = scales(state)
    scale = {GAP: place, SPEED: speed, FORCE: force, RESERVE: force}
    before = scene.watched(mode, t, state)
    ahead = _ahead(scene)
    after = scene.watched(mode, t + ahead, _stepped(scene.slope(mode), t, ahead, state))
    leaving = _leaving(scene, t, state)
    for (quantity, contact), now, then in zip(mode.events, before, after, strict=True):
        if now > NEARLY[quantity] * scale[quantity] or (quantity == GAP and contact in leaving):
            continue
        if now < -NEARLY[quantity] * scale[quantity]:
            return False
        if not then - now >= -NOISE[quantity] * scale[quantity]:
            return False
    return True


def _leaving(scene: Scene, t: float, state: Array) -> set[str]:
    """Contacts whose gap opens."""
    if not scene.one_sided:
        return set()
    rates = scene.call("gap_rates", t, state)
    least = NEARLY[GAP] * scales(state)[1]
    return {c for c, rate in zip(scene.one_sided, rates, strict=True) if rate > least}


def _stepped(slope: Function, t: float, h: float, y: Array) -> Array:
    """One step of order 2: a gap that opens grows with h^2."""
    middle = y + h / 2 * slope(t, y)
    return y + h * slope(t + h / 2, middle)
