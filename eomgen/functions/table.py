"""The table of functions that are there when asked for, and the choice of some by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches

from eomgen.algebra.assemble import assemble
from eomgen.algebra.graph import Node
from eomgen.algebra.jacobian import Rows, jacobian
from eomgen.compile import FUNCTIONS, Machine
from eomgen.errors import UsageError
from eomgen.functions import base, places, sensitivity
from eomgen.functions.motion import Motion
from eomgen.program import IN_MOTION, Function, Program
from eomgen.render.names import identifier

STANDARD = "standard"  # stands for what `generate` writes when it is asked for nothing
Build = Callable[[Motion], Function]
BuildAt = Callable[[Motion, str], Function]


@dataclass(frozen=True)
class Row:
    """A function that can be asked for."""

    about: str
    build: Build


@dataclass(frozen=True)
class RowAt:
    """One for each named point or body, asked for as `name:POINT`."""

    about: str
    build: BuildAt


def select(program: Program, machine: Machine, names: Sequence[str]) -> Program:
    """The program with these functions, in this order, each once.

    names: standard functions of the program, rows of `ROWS`, rows of `ROWS_AT` with a place behind
    a colon, or `STANDARD`.

    Raises:
        UsageError: a function or a place is unknown, or the scene has no such function.
    """
    motion = Motion(machine)
    own = {f.name: f for f in program.functions}
    chosen: dict[str, Function] = {}
    for name in names:
        for function in own.values() if name == STANDARD else [_function(motion, own, name)]:
            chosen.setdefault(function.name, function)
    return replace(program, functions=tuple(chosen.values()))


def _function(motion: Motion, own: dict[str, Function], name: str) -> Function:
    if name in own:
        return own[name]
    if name in ROWS:
        return ROWS[name].build(motion)
    kind, colon, place = name.partition(":")
    if kind in ROWS_AT and colon:
        return ROWS_AT[kind].build(motion, place)
    known = list(dict.fromkeys([STANDARD, *own, *ROWS, *(f"{k}:POINT" for k in ROWS_AT)]))
    near = get_close_matches(name, known, 1, 0.6)
    hint = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(known)}"
    raise UsageError(f"--functions: unknown function {name[:60]!r}; {hint}")


def _in_motion(function: Function) -> Function:
    """The function with accelerations among its arguments."""
    return replace(function, arguments=IN_MOTION)


def _flat(rows: Rows) -> list[Node]:
    return [entry for row in rows for entry in row]


def _mass_matrix(motion: Motion) -> Function:
    return FUNCTIONS["mass_matrix"](motion.machine)


def _inverse_dynamics(motion: Motion) -> Function:
    results = motion.inverse_dynamics
    about = (
        "M u' + h - Q: the generalized forces that these accelerations need beside all that is "
        "applied" + ("; those of the constraints are among them" if motion.machine.kept else "")
    )
    pivots = motion.machine.pivots
    return _in_motion(assemble("inverse_dynamics", about, (motion.size,), results, pivots))


def _inverse_dynamics_jacobian(motion: Motion) -> Function:
    variables = (*motion.state, *motion.accelerations)
    rows = jacobian(motion.inverse_dynamics, variables)
    about = "d (M u' + h - Q) / d (q, u, u'), one row for each speed"
    shape, pivots = (motion.size, len(variables)), motion.machine.pivots
    return _in_motion(assemble("inverse_dynamics_jacobian", about, shape, _flat(rows), pivots))


def _sensitivity(motion: Motion, name: str, variables: Sequence[Node], words: str) -> Function:
    """The Jacobian of the state derivative with respect to some arguments."""
    if not variables:
        raise UsageError(f"--functions: {name}: the spec has no {words}")
    rows, pivots = sensitivity.state_derivative(motion, variables)
    about = f"d (q', u') / d {words}, one row for each component of the state"
    shape = (len(motion.state), len(variables))
    return assemble(name, about, shape, _flat(rows), pivots)


def _state_jacobian(motion: Motion) -> Function:
    return _sensitivity(motion, "state_jacobian", motion.state, "(q, u)")


def _input_jacobian(motion: Motion) -> Function:
    return _sensitivity(motion, "input_jacobian", motion.inputs, "inputs")


def _parameter_jacobian(motion: Motion) -> Function:
    return _sensitivity(motion, "parameter_jacobian", motion.parameters, "parameters")


def _time_jacobian(motion: Motion) -> Function:
    rows, pivots = sensitivity.state_derivative(motion, motion.argument("time", 1))
    about = "d (q', u') / d t at a constant state"
    return assemble("time_jacobian", about, (len(motion.state),), _flat(rows), pivots)


def _regressor(motion: Motion) -> Function:
    found = motion.inertial
    about = f"Y of M u' + h - Q = Y theta + rest; theta: {_listed(p.name for p in found)}"
    return _columns("regressor", about, motion, range(len(found)))


def _base_regressor(motion: Motion) -> Function:
    found = base.of(motion)
    names = _listed(found.name(p) for p in found.base)
    about = f"columns of the regressor that are independent; theta_b: {names}"
    return _columns("base_regressor", about, motion, [p.kept for p in found.base])


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "nothing"


def _columns(name: str, about: str, motion: Motion, chosen: Sequence[int]) -> Function:
    entries = [motion.inertial[j].column[i] for i in range(motion.size) for j in chosen]
    shape, pivots = (motion.size, len(chosen)), motion.machine.pivots
    return _in_motion(assemble(name, about, shape, entries, pivots))


def _regressor_rest(motion: Motion) -> Function:
    about = "rest of M u' + h - Q = Y theta + rest: loads that are no weights, energies as formulas"
    pivots = motion.machine.pivots
    return _in_motion(assemble("regressor_rest", about, (motion.size,), motion.rest, pivots))


def _inertial_parameters(motion: Motion) -> Function:
    found = motion.inertial
    about = f"theta of the regressor by the parameters: {_listed(p.name for p in found)}"
    values = [p.value for p in found]
    return assemble("inertial_parameters", about, (len(found),), values)


def _position(motion: Motion, name: str) -> Function:
    values = places.position(motion, name)
    about = f"position of {name} [m], world axes"
    return _at(motion, f"position_of_{name}", about, (len(values),), values)


def _velocity(motion: Motion, name: str) -> Function:
    values = places.velocity(motion, name)
    about = places.about_velocity(motion, name)
    return _at(motion, f"velocity_of_{name}", about, (len(values),), values)


def _jacobian(motion: Motion, name: str) -> Function:
    rows = places.point_jacobian(motion, name)
    about = f"d / d u of the {places.about_velocity(motion, name)}"
    shape = (len(rows), motion.size)
    return _at(motion, f"jacobian_of_{name}", about, shape, _flat(rows))


def _at(
    motion: Motion, name: str, about: str, shape: tuple[int, ...], results: Sequence[Node]
) -> Function:
    """A function of a place, whose name may hold Greek letters."""
    return assemble(identifier(name), about, shape, results, motion.machine.pivots)


ROWS: dict[str, Row] = {
    "mass_matrix": Row("M of M u' + h = Q, which large scenes are not given", _mass_matrix),
    "inverse_dynamics": Row("generalized forces that chosen accelerations need", _inverse_dynamics),
    "inverse_dynamics_jacobian": Row("its derivatives by q, u, u'", _inverse_dynamics_jacobian),
    "state_jacobian": Row("derivatives of the state derivative by (q, u)", _state_jacobian),
    "input_jacobian": Row("... by the inputs", _input_jacobian),
    "parameter_jacobian": Row("... by the parameters", _parameter_jacobian),
    "time_jacobian": Row("... by the time, at a constant state", _time_jacobian),
    "regressor": Row("Y of inverse_dynamics = Y theta + regressor_rest", _regressor),
    "regressor_rest": Row("what no inertial parameter multiplies", _regressor_rest),
    "inertial_parameters": Row("theta, by the parameters of the spec", _inertial_parameters),
    "base_regressor": Row("the independent columns of Y", _base_regressor),
}
ROWS_AT: dict[str, RowAt] = {
    "position_of": RowAt("where a point or a body's mass centre is", _position),
    "velocity_of": RowAt("its velocity, and a body's angular velocity", _velocity),
    "jacobian_of": RowAt("derivatives of that velocity by the speeds", _jacobian),
}


def listing() -> str:
    """Every function that can be asked for, a line each."""
    lines = {name: row.about for name, row in ROWS.items()}
    lines |= {f"{name}:POINT": row.about for name, row in ROWS_AT.items()}
    lines[STANDARD] = "what is written without --functions; each of these by its name too"
    return "\n".join(f"{name:<26} {about}" for name, about in lines.items())
