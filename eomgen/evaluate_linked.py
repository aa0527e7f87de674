"""Numbers of linked scenes: multipliers, reactions and residuals beside the rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from eomgen import compile_watch, interpreter, reactions
from eomgen.algebra.arithmetic import evaluate as node_values
from eomgen.algebra.arithmetic import mpmath_arithmetic
from eomgen.compile_contacts import Touching
from eomgen.errors import CheckError
from eomgen.evaluate import (
    GUARD_DIGITS,
    Engine,
    Result,
    arguments,
    at_each,
    engine,
    named_results,
)
from eomgen.evaluate_contacts import contacts
from eomgen.model import Model
from eomgen.program import Program
from eomgen.states import State
from eomgen.study_linked import LinkedStudy

WORKING = 50 + GUARD_DIGITS
PRECISE = mpmath_arithmetic(WORKING)
ON_CONSTRAINT = 1e-9  # SI; what a residual may be
NEWTON_STEPS = 25


def consistent(study: LinkedStudy) -> Model:
    """The model with its admissible initial state as values for missing entries."""
    initial = {name: _number(value) for name, value in study.scene.decided().items()}
    return replace(study.scene.model, initial=initial)


def _number(value: Any) -> sp.Expr:
    return sp.Float(str(value), WORKING)


def _given(study: LinkedStudy, state: State) -> dict[str, list[Any]]:
    """The arguments of the program in `WORKING` digits."""
    return arguments(state, study.scene.model, lambda v: PRECISE.number(str(sp.N(v, WORKING))))


def evaluate(
    study: LinkedStudy,
    source: Program,
    states: Sequence[State],
    how: tuple[str, int],
    *,
    project: bool,
) -> list[Result]:
    """Accelerations, energies, forces, multipliers, reactions, residuals at every state.

    how: (engine, digits).

    Raises:
        CheckError: a state is off the constraints and `project` is not set, or it is singular.
    """
    using, digits = how
    chosen = engine(using, source, study.scene.model, digits)
    there = placed(study, source, states, project=project)
    return at_each(there, lambda state: _result(study, source, chosen, state))


def placed(
    study: LinkedStudy, source: Program, states: Sequence[State], *, project: bool
) -> list[State]:
    """The states, each on the constraints: as it is, or projected if that is wanted.

    Raises:
        CheckError: a state is off the constraints and `project` is not set.
    """
    return at_each(states, lambda state: _placed(study, source, state, project))


def _result(study: LinkedStudy, source: Program, chosen: Engine, state: State) -> Result:
    result = named_results(chosen, source, study.scene.model, state)
    if any(f.name == "watch" for f in source.functions):
        watched = compile_watch.names(study.machine, None)
        bits = compile_watch.mask(watched, chosen.call("watch", state))
        result["status"] = {"bits": bits, "words": list(compile_watch.words(bits))}
    if study.scene.touches:
        result["contacts"] = contacts(chosen, Touching(study.machine), state)
    if not study.machine.kept:
        return result
    result |= _motion_and_forces(study, chosen, state, result.get("contacts"))
    result["residuals"] = {
        "position": _residuals(study, chosen, state, "constraint_residuals"),
        "rate": _residuals(study, chosen, state, "constraint_rates"),
    }
    return result


def _motion_and_forces(
    study: LinkedStudy, chosen: Engine, state: State, modes: Result | None
) -> Result:
    """Multipliers and reactions; beside a rough guide all that moves is that of the one mode.

    Nothing where no mode holds, or several do.
    """
    shown: Result = {}
    function = "multipliers"
    if study.scene.model.guides:
        assert modes is not None
        if len(modes["holds"]) != 1:
            return {}
        (name,) = modes["holds"]
        function = f"multipliers_{name}"
        mode = modes["modes"][name]
        shown = {k: mode[k] for k in ("accelerations", "outputs") if k in mode}
    multipliers = dict(zip(_kept(study), chosen.call(function, state), strict=True))
    shown["multipliers"] = {name: chosen.shown(v) for name, v in multipliers.items()}
    shown["reactions"] = _reactions(study, multipliers, state, chosen)
    return shown


def _kept(study: LinkedStudy) -> list[str]:
    return [r.name for r in study.machine.schur.rows]


def _residuals(study: LinkedStudy, chosen: Engine, state: State, name: str) -> dict[str, Any]:
    rows = study.machine.rows
    if name == "constraint_residuals":
        rows = tuple(r for r in rows if r.is_holonomic)
    values = chosen.call(name, state)
    return {r.name: chosen.shown(v) for r, v in zip(rows, values, strict=True)}


def _reactions(
    study: LinkedStudy, multipliers: dict[str, Any], state: State, chosen: Engine
) -> dict[str, Any]:
    """Named constraint forces; their factors are computed in the digits of the multipliers."""
    given = _given(study, state)
    # factors hold no rates and no inputs
    held = [n for n in study.scene.links.leaves if n.datum.index < len(given[n.datum.argument])]
    leaves = {n: given[n.datum.argument][n.datum.index] for n in held}

    def factor(node: Any) -> Any:
        (value,) = node_values([node], leaves, PRECISE)
        return value if not isinstance(next(iter(multipliers.values())), float) else float(value)

    found = reactions.values(reactions.of(study.scene), multipliers, factor)
    return {
        name: {k: v if k == "on" else chosen.shown(v) for k, v in parts.items()}
        for name, parts in found.items()
    }


def _placed(study: LinkedStudy, source: Program, state: State, project: bool) -> State:
    """The state itself where it is admissible, else its projection if that is wanted.

    Raises:
        CheckError: it is off the constraints by more than `ON_CONSTRAINT`.
    """
    if not study.machine.kept:
        return state
    worst = max(_off(study, source, state), key=lambda pair: pair[1], default=("", 0.0))
    if worst[1] <= ON_CONSTRAINT:
        return state
    if not project:
        raise CheckError(
            f"the state is off the constraints: {worst[0]} has the residual {worst[1]:.3g}; "
            "mend the state, or let --project move it to the nearest admissible one"
        )
    return _projected(study, source, state)


def _off(study: LinkedStudy, source: Program, state: State) -> list[tuple[str, float]]:
    """Each row with the sizes of its residuals."""
    given = _given(study, state)
    holonomic = [r.name for r in study.machine.rows if r.is_holonomic]
    everything = [r.name for r in study.machine.rows]
    pairs = []
    for name, rows in (("constraint_residuals", holonomic), ("constraint_rates", everything)):
        values = interpreter.run(source.function(name), given, PRECISE)
        pairs += [(row, float(abs(v))) for row, v in zip(rows, values, strict=True)]
    return pairs


def _projected(study: LinkedStudy, source: Program, state: State) -> State:
    """The nearest admissible state in the metric of the mass matrix.

    Raises:
        CheckError: Newton's method does not reach the constraints from there.
    """

    def step(name: str, at: State) -> tuple[sp.Expr, ...]:
        values = interpreter.run(source.function(name), _given(study, at), PRECISE)
        return tuple(_number(v) for v in values)

    for _ in range(NEWTON_STEPS):
        state = replace(state, coordinates=step("project_positions", state))
    moved = step("project_rates", state)
    has_speeds = bool(study.scene.model.speeds)
    state = replace(state, rates=None, speeds=moved) if has_speeds else replace(state, rates=moved)
    if max(size for _, size in _off(study, source, state)) > ON_CONSTRAINT:
        raise CheckError("the state cannot be projected: Newton's method does not converge")
    return state
