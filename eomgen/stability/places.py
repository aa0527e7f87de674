"""The states that are looked at: the start, equilibria, and the declared range."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from eomgen.analysis import equilibrium
from eomgen.analysis.equilibrium_records import Equilibrium
from eomgen.checks import samples
from eomgen.dimension import NONE
from eomgen.errors import EomgenError, UsageError
from eomgen.evaluate import depends_on_time
from eomgen.mechanics import machine
from eomgen.model import Coordinate, Model
from eomgen.numerics.records import Array, Stopped
from eomgen.simulate_setup import Setup, Start, start_of
from eomgen.stability.records import RANGE, REST, START, Place
from eomgen.stability.theory import Linear
from eomgen.states import exact
from eomgen.study import Study

SAMPLES = 32
MOST_EQUILIBRIA = 3
RESTING = 1e-7  # of the size of A: f is zero
THE_START = "the start"


@dataclass(frozen=True)
class Looked:
    """The places, what they are in words, and what could not be looked at."""

    places: tuple[Place, ...]
    words: tuple[str, ...]
    omitted: tuple[str, ...]

    def of(self, kind: str) -> tuple[Place, ...]:
        """The places of a kind."""
        return tuple(p for p in self.places if p.kind == kind)


def look(setup: Setup) -> Looked:
    """Every place of a scene at which its linearised motion has a value."""
    parts = [_at_start(setup), _at_rest(setup), _in_range(setup)]
    return Looked(
        tuple(p for part in parts for p in part.places),
        tuple(w for part in parts for w in part.words),
        tuple(o for part in parts for o in part.omitted),
    )


def _at_start(setup: Setup) -> Looked:
    place = _place(setup, (THE_START, START), setup.start)
    if place is None:
        return Looked((), (), ("the start: the linearised motion has no value there",))
    return Looked((place,), (THE_START,), ())


def _place(setup: Setup, named: tuple[str, str], start: Start) -> Place | None:
    """A place, or None where the motion has no value."""
    names = ("state_derivative", "state_jacobian", "damping_jacobian")
    known = [n for n in names if setup.steps.has(n)]
    try:
        found = [setup.engine.function(n)(start.time, start.state) for n in known]
    except Stopped:
        return None
    if not all(np.all(np.isfinite(f)) for f in found):
        return None
    slope, matrix, *damping = (np.asarray(f, float) for f in found)
    motion = Linear(matrix, len(setup.steps.program.coordinates), *damping)
    is_still = bool(np.max(np.abs(slope)) <= RESTING * (1 + np.max(np.abs(matrix))))
    at_rest = is_still and not _is_driven(setup)
    return Place(*named, start.time, np.asarray(start.state, float), motion, at_rest)


def _is_driven(setup: Setup) -> bool:
    """Whether the motion reads the time: what is still now need not stay so."""
    program = setup.steps.program
    return depends_on_time(replace(program, functions=(program.function("state_derivative"),)))


def _at_rest(setup: Setup) -> Looked:
    study, start = setup.study, setup.start
    if _is_driven(setup):
        return Looked((), (), ("equilibria: the motion depends on the time, so none stays one",))
    try:
        found = _equilibria(study, start)
    except EomgenError as error:
        return Looked((), (), (f"equilibria: {str(error).splitlines()[0]}",))
    places: list[Place] = []
    for one in found:
        name = f"equilibrium {len(places) + 1} ({one.stability.verdict})"
        place = _placed(setup, (name, REST), _resting(study, one))
        if place is not None and place.at_rest and len(places) < MOST_EQUILIBRIA:
            places.append(place)
    if not places:
        return Looked((), (), ("equilibria: none was found that is one of the motion",))
    words = f"{len(places)} equilibri{'um' if len(places) == 1 else 'a'}"
    return Looked(tuple(places), (words,), ())


def _equilibria(study: Study, start: Start) -> list[Equilibrium]:
    """Equilibria without contacts, those that are stable first.

    Raises:
        EomgenError: the scene has no statics.
    """
    model, given = study.model, start.given
    if model.quaternions:
        raise UsageError("not looked for: statics needs turns by angles, not by a quaternion")
    inputs = {i.name: _exact(v) for i, v in zip(model.inputs, given.inputs, strict=True)}
    found = equilibrium.solve(model, inputs, _exact(start.time), _parameters(model, start))
    free = [e for e in found.found if not e.contacts]
    return sorted(free, key=lambda e: e.stability.verdict != "stable")


def _parameters(model: Model, start: Start) -> dict[str, object]:
    names = [p.name for p in machine.free_parameters(model)]
    return {n: _exact(v) for n, v in zip(names, start.given.parameters, strict=True)}


def _exact(value: float) -> object:
    return exact(repr(float(value)))


def _resting(study: Study, one: Equilibrium) -> dict[str, dict[str, object]]:
    names = [c.name for c in study.model.coordinates]
    return {
        "coordinates": {n: str(one.coordinates[n]) for n in names},
        "rates": dict.fromkeys(names, 0),
    }


def _placed(
    setup: Setup, named: tuple[str, str], entry: Mapping[str, Mapping[str, object]]
) -> Place | None:
    """The place of coordinates and rates under the inputs of the start; None: there is none."""
    study, start = setup.study, setup.start
    inputs = zip(study.model.inputs, start.given.inputs, strict=True)
    parameters = zip(machine.free_parameters(study.model), start.given.parameters, strict=True)
    text = json.dumps({
        "t": start.time,
        **entry,
        "inputs": {i.name: v for i, v in inputs},
        "parameters": {p.name: v for p, v in parameters},
    })  # fmt: skip
    try:
        found = start_of(study, text, {})
    except EomgenError:
        return None
    return _place(setup, named, found)


def _in_range(setup: Setup) -> Looked:
    if setup.study.links is not None:
        return _admissible(setup)
    return _sampled(setup)


def _admissible(setup: Setup) -> Looked:
    """The admissible states of the analysis, where the author declares a range."""
    links = setup.study.links
    assert links is not None
    if not setup.study.model.range:
        return Looked((), (), ("other states: the spec declares no `range`",))
    names = [c.name for c in setup.study.model.coordinates]
    entries = [
        {
            "coordinates": {n: float(v) for n, v in zip(names, s.state.coordinates, strict=True)},
            "rates": {n: float(v) for n, v in zip(names, s.state.rates, strict=True)},
        }
        for s in links.scene.report.states
    ]
    places = [
        _placed(setup, (f"state {k} in the range", RANGE), entry)
        for k, entry in enumerate(entries, 1)
    ]
    kept = tuple(p for p in places if p is not None)
    return Looked(kept, (f"{len(kept)} admissible states in the range",) if kept else (), ())


def regions(model: Model, start: Start) -> tuple[tuple[Coordinate, float, float], ...]:
    """(coordinate, low, high) of what varies: declared ranges, and angles over a full turn.

    Coordinates of quaternions, and lengths without a range, do not vary.
    """
    names = [p.symbol for p in machine.free_parameters(model)]
    given = dict(zip(names, start.given.parameters, strict=True))
    quaternions = {s for q in model.quaternions for s in q.symbols}
    found = []
    for c in model.coordinates:
        if c.name in model.range:
            low, high = (float(samples.number(model, v, given)) for v in model.range[c.name])
            found.append((c, low, high))
        elif is_angle(c) and c.symbol not in quaternions:
            found.append((c, -pi, pi))
    return tuple(found)


def is_angle(c: Coordinate) -> bool:
    """Whether the author gives it a unit of an angle: it may turn round and round."""
    return c.description.dimension == NONE and bool(c.description.unit)


def _sampled(setup: Setup) -> Looked:
    """Random positions in the regions, with the speeds of the start."""
    areas = regions(setup.study.model, setup.start)
    if not areas:
        return Looked((), (), ("other states: no coordinate has a `range`, and none is an angle",))
    places = []
    for k, state in enumerate(drawn(setup, areas, SAMPLES), 1):
        start = replace(setup.start, state=state)
        places.append(_place(setup, (f"sampled state {k}", RANGE), start))
    kept = tuple(p for p in places if p is not None)
    model = setup.study.model
    where = ", ".join(
        f"{c.name} in its range" if c.name in model.range else f"{c.name} over a full turn"
        for c, _, _ in areas
    )
    return Looked(kept, (f"{len(kept)} states with {where}",) if kept else (), ())


def drawn(
    setup: Setup, areas: tuple[tuple[Coordinate, float, float], ...], count: int
) -> Iterator[Array]:
    """States of the program, the same for the same spec."""
    chance = random.Random(f"stability {setup.study.model.name}")
    index = {c.name: i for i, c in enumerate(setup.steps.program.coordinates)}
    for _ in range(count):
        state = setup.start.state.copy()
        for c, low, high in areas:
            state[index[c.name]] = chance.uniform(low, high)
        yield state
