"""The code that we ship, run: generated C through a compiler, generated Python imported."""

import ctypes
import importlib.util
import os
import shlex
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

import numpy as np

from eomgen.errors import CheckError, UsageError
from eomgen.numerics import cache
from eomgen.program import Function, Program
from eomgen.render.names import prefix

COMPILERS = ("cc", "gcc", "clang")
OPTIONS = ("-std=c99", "-O2", "-fPIC", "-shared", "-ffp-contract=off")
REALS = {"double": ctypes.c_double, "float": ctypes.c_float}
SINGULAR = 1  # the status of every generated header


@dataclass(frozen=True)
class Compiled:
    """A loaded library of the C of `program`."""

    library: ctypes.CDLL
    program: Program
    real: str

    def call(
        self, function: str, t: float, state: Sequence[float], *rest: Sequence[float]
    ) -> np.ndarray[Any, np.dtype[Any]]:
        """The results of a function at one state; `rest`: what it takes beside, in order.

        Raises CheckError where the mass matrix is singular.
        """
        called = self.program.function(function)
        sizes = _sizes(self.program, called)
        kind = REALS[self.real]
        given = [_vector(v, n, kind) for v, n in zip((state, *rest), sizes, strict=True)]
        result = np.zeros(called.shape, kind)
        symbol = self.library[f"{prefix(self.program.name)}_{function}"]
        symbol.argtypes = [kind, *[ctypes.POINTER(kind)] * (len(given) + 1)]
        status = symbol(kind(t), *(_pointer(a, kind) for a in (*given, result)))
        if status == SINGULAR:
            raise CheckError(f"{function}: the mass matrix is singular at this state")
        return result

    def model(self, parameters: Sequence[float]) -> Any:
        """A prepared model: the memory of the struct that the functions `prepared_` read."""
        kind = REALS[self.real]
        prepared = self.program.prepare
        constants = len(prepared.results) if prepared else 0
        # a program without parameters has an int in their place
        memory = (kind * (len(parameters) + constants + 1))()
        given = _vector(parameters, len(self.program.parameters), kind)
        self.library[f"{prefix(self.program.name)}_prepare"](_pointer(given, kind), memory)
        return memory

    def each(
        self, function: str, times: np.ndarray[Any, np.dtype[Any]], *rows: Any, model: Any
    ) -> np.ndarray[Any, np.dtype[Any]]:
        """The results (N, size) at many states, NaN where one fails; rows: (N, n) each, as `call`.

        `model` is a prepared one.
        """
        kind = REALS[self.real]
        given = [np.ascontiguousarray(r, kind) for r in rows]
        results = np.full((len(times), len(self.program.function(function).results)), np.nan, kind)
        symbol = self.library[f"{prefix(self.program.name)}_prepared_{function}"]
        symbol.argtypes = [kind, *[ctypes.c_void_p] * (len(given) + 2)]
        places = [(a.ctypes.data, a.strides[0]) for a in (*given, results)]
        for k, time in enumerate(times):
            *taken, result = (start + k * stride for start, stride in places)
            if symbol(time, *taken, model, result) == SINGULAR:
                results[k] = np.nan
        return results

    def batch(
        self, function: str, t: float, *columns: np.ndarray[Any, np.dtype[Any]], model: Any
    ) -> tuple[np.ndarray[Any, np.dtype[Any]], int]:
        """The results at many states, a column each, and the worst status.

        columns: states, accelerations where they are taken, and inputs, (n, N); results
        (size, N), NaN in the column of a state that fails. The code was written for a batch.
        """
        kind = REALS[self.real]
        given = [np.ascontiguousarray(c, kind) for c in columns]
        count = given[0].shape[1]
        result = np.zeros((int(np.prod(self.program.function(function).shape)), count), kind)
        symbol = self.library[f"{prefix(self.program.name)}_batch_{function}"]
        symbol.argtypes = [ctypes.c_size_t, kind, *[ctypes.c_void_p] * (len(given) + 2)]
        arrays = [_pointer(a, kind) for a in given]
        status = symbol(count, kind(t), *arrays, model, _pointer(result, kind))
        return result, status


def _sizes(program: Program, function: Function) -> list[int]:
    """The lengths of what a function takes behind the time."""
    lengths = {
        "state": len(program.coordinates) + len(program.speeds),
        "accelerations": len(program.speeds),
        "inputs": len(program.inputs),
        "parameters": len(program.parameters),
    }
    return [lengths[argument] for argument in function.arguments[1:]]


def _vector(values: Sequence[float], size: int, kind: Any) -> np.ndarray[Any, np.dtype[Any]]:
    array = np.array(values, kind)
    if array.shape != (size,):
        raise ValueError(f"{size} numbers are needed, there are {array.shape}")
    return array


def _pointer(array: np.ndarray[Any, np.dtype[Any]], kind: Any) -> Any:
    return array.ctypes.data_as(ctypes.POINTER(kind))


def compiler() -> list[str]:
    """The command of a C compiler: $CC, or the first of `COMPILERS` on the path."""
    chosen = os.environ.get("CC")
    if chosen:
        return shlex.split(chosen)
    for name in COMPILERS:
        if found := shutil.which(name):
            return [found]
    raise UsageError(
        f"no C compiler: none of {', '.join(COMPILERS)} is on the path; "
        "install one or name yours in the environment variable CC"
    )


def build(
    files: Mapping[str, str], program: Program, real: str = "double", folder: Path | None = None
) -> Compiled:
    """The C files of a program, compiled and loaded; `folder` keeps them, else they go."""
    if folder is not None:
        return _build(files, program, real, folder)
    with TemporaryDirectory(prefix="eomgen-", ignore_cleanup_errors=True) as temporary:
        return _build(files, program, real, Path(temporary))


def _build(files: Mapping[str, str], program: Program, real: str, folder: Path) -> Compiled:
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    sources = [str(folder / name) for name in files if name.endswith(".c")]
    library = folder / f"{prefix(program.name)}_{real}.so"
    define = [f"-D{prefix(program.name).upper()}_FLOAT"] if real == "float" else []
    command = [*compiler(), *OPTIONS, *define, *sources, "-o", str(library), "-lm"]
    _compile(command)
    return Compiled(ctypes.CDLL(str(library)), program, real)


def build_cached(files: Mapping[str, str], program: Program, real: str = "double") -> Compiled:
    """As `build`, but a library that was built before from the same text is loaded again."""
    key = cache.key([*files.items(), *compiler(), *OPTIONS, real])
    library = f"{prefix(program.name)}_{real}.so"
    folder = cache.folder(key, lambda place: _build(files, program, real, place))
    return Compiled(ctypes.CDLL(str(folder / library)), program, real)


def _compile(command: list[str]) -> None:
    """Run the compiler; its own words are the error."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise UsageError(f"the C compiler {command[0]!r} does not start: {error}") from error
    if done.returncode:
        raise UsageError(f"the C compiler {command[0]!r} failed:\n{done.stderr.strip()}")


def load_python(text: str, name: str) -> ModuleType:
    """A generated Python module, imported from a file of its own."""
    with TemporaryDirectory(prefix="eomgen-") as temporary:
        file = Path(temporary) / f"{name}.py"
        file.write_text(text, encoding="utf-8")
        spec = importlib.util.spec_from_file_location(name, file)
        if spec is None or spec.loader is None:
            raise ImportError(f"no loader for {file}")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    return module
