"""Numbers from a program: by its interpreter, by the C that we ship, or by the Python."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import prod
from typing import Any, TypeVar

import sympy as sp

from eomgen import interpreter
from eomgen.compile import Machine
from eomgen.errors import CheckError, UsageError
from eomgen.mechanics import speeds
from eomgen.model import TIME, Model
from eomgen.program import Apply, Assign, Expression, Function, Program, Read
from eomgen.states import State

DOUBLE_DIGITS = 17
GUARD_DIGITS = 15
MOST_DIGITS = 10_000

Call = Callable[[str, State], list[Any]]
Result = dict[str, Any]


@dataclass(frozen=True)
class Engine:
    """Something that computes a function of the program at a state."""

    call: Call
    shown: Callable[[Any], Any]  # a result as JSON has it


def engine(name: str, source: Program, model: Model, digits: int) -> Engine:
    """The engine of that name.

    Raises:
        UsageError: more digits are asked for than the engine has.
    """
    if digits > DOUBLE_DIGITS and name != "interpreter":
        raise UsageError(
            f"{name} computes in double, about {DOUBLE_DIGITS} digits; use the interpreter for more"
        )
    if digits > DOUBLE_DIGITS:
        return _precise(source, model, digits)
    return Engine(ENGINES[name](source, model), lambda value: _rounded(float(value), digits))


def _rounded(value: float, digits: int) -> float:
    if value != value or abs(value) == float("inf"):
        raise CheckError("a result is not finite at this state")
    return value if digits == DOUBLE_DIGITS else float(f"{value:.{digits}g}")


def _precise(source: Program, model: Model, digits: int) -> Engine:
    """The interpreter over mpmath; results are decimal strings."""
    import mpmath

    working = digits + GUARD_DIGITS
    arithmetic = interpreter.mpmath_arithmetic(working)

    def convert(value: sp.Expr) -> Any:
        return arithmetic.number(mpmath.mpmathify(str(sp.N(value, working + 5))))

    def call(name: str, state: State) -> list[Any]:
        with mpmath.workdps(working + 5):
            given = arguments(state, model, convert)
        return interpreter.run(source.function(name), given, arithmetic)

    return Engine(call, lambda value: mpmath.nstr(value, digits, strip_zeros=False))


def arguments(
    state: State, model: Model, convert: Callable[[sp.Expr], Any]
) -> dict[str, list[Any]]:
    """The arguments of a program's functions by name."""
    return {
        "time": [convert(state.time)],
        "state": [convert(v) for v in (*state.coordinates, *speeds_of(state, model))],
        "accelerations": [convert(v) for v in state.accelerations or ()],
        "inputs": [convert(v) for v in state.inputs],
        "parameters": [convert(v) for v in state.parameters],
    }


def speeds_of(state: State, model: Model) -> tuple[sp.Expr, ...]:
    """The speeds of a state: given, or the rates, or the spec's formulas of the rates."""
    if state.speeds is not None:
        return state.speeds
    assert state.rates is not None
    if not model.speeds:
        return state.rates
    values: dict[sp.Symbol, sp.Expr] = {TIME: state.time}
    coordinates = zip(model.coordinates, state.coordinates, state.rates, strict=True)
    for coordinate, position, rate in coordinates:
        values |= {coordinate.symbol: position, coordinate.rate: rate}
    free = [p for p in model.parameters if p.formula is None]
    values |= {p.symbol: v for p, v in zip(free, state.parameters, strict=True)}
    return tuple(speeds.spelled_out(model, s.formula).xreplace(values) for s in model.speeds)


def _interpreter(source: Program, model: Model) -> Call:
    def call(name: str, state: State) -> list[Any]:
        return interpreter.run(
            source.function(name), arguments(state, model, float), interpreter.FLOAT
        )

    return call


def _compiled(source: Program, model: Model) -> Call:
    from eomgen.numerics import compiled
    from eomgen.render.code_context import coded
    from eomgen.render.targets import TARGETS, render
    from eomgen.render.templating import environment

    library = compiled.build(render(coded(source), TARGETS["c"], environment()), source)

    def call(name: str, state: State) -> list[Any]:
        a = arguments(state, model, float)
        taken = source.function(name).arguments[1:]
        result = library.call(name, a["time"][0], *(a[argument] for argument in taken))
        return list(result.ravel())

    return call


def _python(source: Program, model: Model) -> Call:
    from eomgen.numerics import compiled
    from eomgen.render.code_context import coded
    from eomgen.render.targets import TARGETS, render
    from eomgen.render.templating import environment

    (text,) = render(coded(source), TARGETS["python"], environment()).values()
    module = compiled.load_python(text, source.name)

    def call(name: str, state: State) -> list[Any]:
        import numpy

        a = arguments(state, model, float)
        names = [p.name for p in source.parameters]
        parameters = dict(zip(names, a["parameters"], strict=True))
        taken = source.function(name).arguments
        given = [a[argument] for argument in taken if argument not in ("time", "parameters")]
        try:
            result = getattr(module, name)(a["time"][0], *given, parameters)
        except numpy.linalg.LinAlgError as error:
            raise CheckError(f"{name}: {error}") from error
        return list(numpy.ravel(result))

    return call


ENGINES: dict[str, Callable[[Program, Model], Call]] = {
    "interpreter": _interpreter,
    "c": _compiled,
    "python": _python,
}


def depends_on_time(source: Program) -> bool:
    """Whether any function reads the time."""
    return any(_reads_time(f) for f in source.functions)


def _reads_time(function: Function) -> bool:
    waiting: list[Expression] = [*function.results]
    for statement in function.statements:
        if isinstance(statement, Assign):
            waiting.append(statement.expression)
        else:
            waiting += [getattr(statement, "scale", None) or Read("state", 0)]
            waiting += [*getattr(statement, "matrix", ()), *getattr(statement, "right", ())]
    while waiting:
        expression = waiting.pop()
        if isinstance(expression, Apply):
            waiting += expression.operands
        elif isinstance(expression, Read) and expression.argument == "time":
            return True
    return False


def evaluate(
    machine: Machine, source: Program, states: Sequence[State], using: str, digits: int
) -> list[Result]:
    """Accelerations, energies, generalized forces and outputs at every state, ready for JSON.

    Raises:
        CheckError: the mass matrix is singular or a formula undefined at a state.
        UsageError: the engine cannot do what is asked.
    """
    model = machine.model
    chosen = engine(using, source, model, digits)
    return at_each(states, lambda state: named_results(chosen, source, model, state))


def functions(
    model: Model, source: Program, states: Sequence[State], using: str, digits: int
) -> list[Result]:
    """The results of every function of the program at every state: nested lists of its shape.

    Raises:
        CheckError: the mass matrix is singular or a formula undefined at a state.
        UsageError: accelerations are missing, or the engine cannot do what is asked.
    """
    chosen = engine(using, source, model, digits)

    def results(state: State) -> Result:
        _need_accelerations(source, state)
        called = ((f, chosen.call(f.name, state)) for f in source.functions)
        return {f.name: _nested([chosen.shown(v) for v in found], f.shape) for f, found in called}

    return at_each(states, results)


def _need_accelerations(source: Program, state: State) -> None:
    """Refuse a state without accelerations that a function takes, or with some that none takes."""
    moving = [f.name for f in source.functions if "accelerations" in f.arguments]
    if moving and state.accelerations is None:
        raise UsageError(f'{moving[0]} needs "accelerations" in the state, one for each speed')
    if not moving and state.accelerations is not None:
        raise UsageError('"accelerations" of a state: no function here takes them; leave them out')


Found = TypeVar("Found")


def at_each(states: Sequence[State], results: Callable[[State], Found]) -> list[Found]:
    """The results at every state; an error says at which."""
    found = []
    for number, state in enumerate(states, 1):
        try:
            found.append(results(state))
        except CheckError as error:
            raise CheckError(f"state {number}: {error}") from error
    return found


def _nested(values: Sequence[Any], shape: Sequence[int]) -> list[Any]:
    """Row-major values as lists in lists."""
    if len(shape) == 1:
        return list(values)
    step = prod(shape[1:])
    return [_nested(values[i * step : (i + 1) * step], shape[1:]) for i in range(shape[0])]


def named_results(chosen: Engine, source: Program, model: Model, state: State) -> Result:
    """Accelerations, energies, generalized forces and outputs by name, ready for JSON."""

    def named(function: str, names: Sequence[str]) -> dict[str, Any]:
        values = chosen.call(function, state)
        return {n: chosen.shown(v) for n, v in zip(names, values, strict=True)}

    _need_accelerations(source, state)
    coordinates = [c.name for c in model.coordinates]
    accelerations = "coordinate_accelerations" if model.speeds else "accelerations"
    wanted = {
        "accelerations": (accelerations, coordinates),
        "energy": ("energy", ("kinetic", "potential")),
        "generalized_forces": ("generalized_forces", speeds.names(model)),
        "outputs": ("outputs", [o.name for o in source.outputs]),
    }
    if model.speeds:
        wanted["speed_derivatives"] = ("accelerations", speeds.names(model))
    # where friction decides the motion each mode has accelerations of its own
    there = {f.name for f in source.functions}
    return {name: named(*how) for name, how in wanted.items() if how[0] in there}
