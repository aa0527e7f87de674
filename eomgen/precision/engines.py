"""What computes in float and double: the C that we ship; without a compiler its own statements."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from eomgen import interpreter
from eomgen.algebra.arithmetic import NUMPY, Arithmetic
from eomgen.errors import UsageError
from eomgen.numerics import compiled
from eomgen.precision.records import EPSILONS, Array, Sampled
from eomgen.program import Program

KINDS: dict[str, Any] = {"float": np.float32, "double": np.float64}
Measured = Callable[[str], Array]  # name of a function -> results (number of results, N)


def arrays_of(kind: str) -> Arithmetic:
    """Arrays of `float` or `double`, every operation rounded to it; nothing is refused."""
    dtype = KINDS[kind]

    def number(value: Any) -> Any:
        return np.asarray(value if isinstance(value, np.ndarray) else float(value), dtype)

    functions = {**NUMPY.functions, "pi": lambda: dtype(np.pi)}
    tolerance = dtype(100 * EPSILONS[kind])
    return replace(
        NUMPY,
        number=number,
        functions=functions,
        tolerance=tolerance,
        holds=lambda condition: True,
    )


def engines(
    shipped: Program, files: Mapping[str, str], sampled: Sampled
) -> tuple[str, dict[str, Measured]]:
    """(what computes, in words; by precision the results of a function, NaN where it has none)."""
    try:
        name = Path(compiled.compiler()[0]).name
    except UsageError:
        return "the interpreter in NumPy, as there is no C compiler", {
            kind: _interpreted(shipped, sampled, kind) for kind in KINDS
        }
    return f"C by {name}", {
        kind: _compiled(shipped, compiled.build_cached(files, shipped, kind), sampled)
        for kind in KINDS
    }


def _compiled(shipped: Program, library: compiled.Compiled, sampled: Sampled) -> Measured:
    """A function of the compiled C, state by state."""
    model = library.model(list(sampled.parameters))

    def results(name: str) -> Array:
        at = (sampled.state.T, sampled.inputs.T)
        return library.each(name, sampled.time, *at, model=model).T.astype(float)

    return results


def _interpreted(shipped: Program, sampled: Sampled, kind: str) -> Measured:
    """The same by the statements of the program."""
    arithmetic = arrays_of(kind)

    def results(name: str) -> Array:
        with arithmetic.quiet():
            found = interpreter.call(shipped, name, sampled.columns(), arithmetic)
        shape = (sampled.count,)
        return np.array([np.broadcast_to(v, shape) for v in found], float).reshape(
            len(found), sampled.count
        )

    return results
