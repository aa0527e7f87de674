"""A study -> what a simulation runs: program, engine, start, contacts."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from eomgen import compile_flow, compile_steps, evaluate_linked, states, stepping
from eomgen.checks import separable
from eomgen.compile_contacts import Touching
from eomgen.errors import UsageError
from eomgen.evaluate import speeds_of
from eomgen.integrators.methods import METHODS
from eomgen.integrators.steps import Steps
from eomgen.mechanics.contacts_modes import spelled
from eomgen.model import Model
from eomgen.numerics import compiled, contact_modes
from eomgen.numerics.engine_c import EngineC
from eomgen.numerics.engine_python import EnginePython
from eomgen.numerics.records import Arguments, Array, Engine
from eomgen.program import Function
from eomgen.states import State
from eomgen.study import Study


@dataclass(frozen=True)
class Start:
    """Where a run begins: the time, the state of the program, and how far it was moved."""

    time: float
    state: Array
    given: Arguments
    moved: float = 0.0  # to the constraints, the largest component


@dataclass(frozen=True)
class Setup:
    """Everything that a run needs."""

    study: Study
    steps: Steps
    engine: Engine
    start: Start
    flow: str | None  # the function of energy and power; None: it cannot be balanced
    is_conserved: bool
    is_compiled: bool


def setup(
    study: Study, methods: tuple[str, ...], start: Start, extra: tuple[Function, ...] = ()
) -> Setup:
    """The engine of a study with the steps of these methods (those that are not of C have none).

    Raises:
        UsageError: the method is not for this scene, or the compiler fails.
    """
    steps = stepping.of(study, tuple(m for m in methods if m in METHODS))
    flow = _flow(study)
    more = (*flow, *_moving(study), *extra)
    steps = replace(steps, program=stepping.extended(steps.program, more))
    engine, is_compiled = _engine(steps, start.given)
    return Setup(
        study=study,
        steps=steps,
        engine=engine,
        start=start,
        flow="energy_flow" if flow else None,
        is_conserved=bool(flow) and compile_flow.is_conserved(study.compiled),
        is_compiled=is_compiled,
    )


def _engine(steps: Steps, given: Arguments) -> tuple[Engine, bool]:
    """The C, or the Python where there is no compiler."""
    try:
        compiled.compiler()
    except UsageError:
        return EnginePython(steps, given), False
    return EngineC(steps, given), True


def touching_of(study: Study) -> Touching | None:
    """The contacts of a scene: one-sided constraints and friction."""
    if study.links is None:
        return None
    found = Touching(study.machine)
    return found if found.contacts else None


def _flow(study: Study) -> tuple[Function, ...]:
    """Energy and power; none where constraints do work that the reduced equations do not know."""
    machine = study.compiled
    if machine is not study.machine and _moves(study):
        return ()
    return compile_flow.functions(machine, touching_of(study))


def _moves(study: Study) -> bool:
    """Whether a constraint depends on the time."""
    time = study.machine.kinematics.algebra.number(0).graph.read("time", 0)
    return any(row.rate.leaves & time.leaves for row in study.machine.rows)


def _moving(study: Study) -> Iterator[Function]:
    """What the methods call: of a scene with contacts the projections of its modes."""
    touching = touching_of(study)
    if touching is None:
        yield compile_steps.state_jacobian(study.compiled)
        return
    yield from compile_flow.projections(touching)
    if study.model.guides:
        yield compile_flow.frictionless(study.machine)


def contact_scene(made: Setup, span: float) -> contact_modes.Scene | None:
    """The modes of a scene with contacts."""
    touching = touching_of(made.study)
    if touching is None:
        return None
    known = {f.name for f in made.steps.program.functions}
    names = [c.name for c in touching.one_sided]
    impacts = {name: f"impact_{spelled(name)}" for name in names}
    return contact_modes.Scene(
        engine=made.engine,
        modes=tuple(
            contact_modes.Mode(
                m.name,
                {contact: state.name for contact, state in m.states},
                tuple(_event(text) for text in m.events),
            )
            for m in touching.modes
        ),
        one_sided=tuple(names),
        impacts={name: f for name, f in impacts.items() if f in known},
        span=span,
        **({"unresisted": compile_flow.FRICTIONLESS} if made.study.model.guides else {}),
    )


def _event(text: str) -> tuple[str, str]:
    quantity, _, contact = text.partition(" of ")
    return quantity, contact


def is_separable(study: Study) -> bool:
    """Whether Verlet's method is symplectic."""
    return not separable.obstacle(study.compiled)


def inputs_of(texts: Sequence[str]) -> dict[str, str]:
    """The values of `--input NAME=VALUE`, as they were written.

    Raises:
        UsageError: a text has another form, or a name comes twice.
    """
    found: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name.strip():
            raise UsageError(f"--input {text!r}: write NAME=VALUE")
        if name.strip() in found:
            raise UsageError(f"--input: {name.strip()} is given twice")
        found[name.strip()] = value.strip()
    return found


def start_of(study: Study, text: str, inputs: Mapping[str, str]) -> Start:
    """The start that a state file and inputs give, on the constraints.

    Raises:
        UsageError: something is missing or no number.
        CheckError: the state cannot be moved to the constraints.
    """
    found = _read(study, _with_inputs(text, inputs))
    moved, state = 0.0, found
    if study.links is not None and study.machine.kept:
        source = study.links.full_program()
        state = evaluate_linked.placed(study.links, source, [found], project=True)[0]
        moved = _distance(found, state)
    numbers = _named(study, state)
    program = study.program
    given = Arguments(
        tuple(float(v) for v in state.inputs), tuple(float(v) for v in state.parameters)
    )
    values = [numbers[v.name] for v in (*program.coordinates, *program.speeds)]
    return Start(float(state.time), np.array(values), given, moved)


def _read(study: Study, text: str) -> State:
    model = study.model if study.links is None else evaluate_linked.consistent(study.links)
    try:
        found = states.read(text, model, needs_time=False)
    except UsageError as error:
        raise UsageError(f"{error}{_remedy(model)}") from error
    if len(found) != 1:
        raise UsageError(f"a run starts from one state, the file has {len(found)}")
    return found[0]


def _remedy(model: Model) -> str:
    names = ", ".join(f"--input {i.name}=0" for i in model.inputs)
    inputs = f", inputs with {names}" if names else ""
    return (
        "\ngive the state with --state FILE (of `simulate`, `stability` and `chart`) or `initial` "
        f"in the spec{inputs}, parameters a value in either"
    )


def _with_inputs(text: str, inputs: Mapping[str, str]) -> str:
    """The state file with these inputs in the place of its own."""
    if not inputs:
        return text
    try:
        entry: Any = json.loads(text, parse_float=str, parse_int=str, parse_constant=str)
    except (json.JSONDecodeError, RecursionError) as error:
        raise UsageError(f"the state file is not JSON: {error}") from error
    if not isinstance(entry, dict) or not isinstance(entry.get("inputs", {}), dict):
        raise UsageError("the state file is not one object with an object of inputs")
    return json.dumps(entry | {"inputs": {**entry.get("inputs", {}), **inputs}})


def _distance(before: State, after: State) -> float:
    pairs = [*zip(before.coordinates, after.coordinates, strict=True)]
    if before.rates is not None and after.rates is not None:
        pairs += zip(before.rates, after.rates, strict=True)
    return max((abs(float(a - b)) for a, b in pairs), default=0.0)


def _named(study: Study, state: State) -> dict[str, float]:
    """Coordinates, rates and speeds by name."""
    model = study.model
    places = {c.name: float(v) for c, v in zip(model.coordinates, state.coordinates, strict=True)}
    if state.rates is not None:
        pairs = zip(model.coordinates, state.rates, strict=True)
        places |= {c.rate.name: float(v) for c, v in pairs}
    if model.speeds:
        pairs_of_speeds = zip(model.speeds, speeds_of(state, model), strict=True)
        places |= {s.name: float(v) for s, v in pairs_of_speeds}
    return places
