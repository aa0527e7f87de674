"""Rows of a run as a table: named columns with units, and CSV that reads back equal."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from eomgen.numerics.records import Array, Rows
from eomgen.program import Variable
from eomgen.simulate_setup import Setup

ENERGIES = (Variable("kinetic", "J"), Variable("potential", "J"))


@dataclass(frozen=True)
class Column:
    """A quantity over time; `kind`: time, coordinate, speed, output or energy."""

    name: str
    unit: str
    kind: str

    @property
    def heading(self) -> str:
        """The name with the unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


def columns(setup: Setup) -> tuple[Column, ...]:
    """Time, all coordinates, speeds, the outputs of the spec, energies."""
    program = setup.steps.program
    return (
        Column("t", "s", "time"),
        *(Column(v.name, v.unit, "coordinate") for v in program.coordinates),
        *(Column(v.name, v.unit, "speed") for v in program.speeds),
        *_dependent(setup),
        *(Column(v.name, v.unit, "output") for v in program.outputs),
        *(Column(v.name, v.unit, "energy") for v in ENERGIES),
    )


def _dependent(setup: Setup) -> Iterator[Column]:
    """Coordinates that were eliminated."""
    if not setup.steps.has("all_coordinates"):
        return
    known = {v.name for v in setup.steps.program.coordinates}
    for coordinate in setup.study.model.coordinates:
        if coordinate.name not in known:
            yield Column(coordinate.name, coordinate.description.unit, "coordinate")


def values(setup: Setup, found: Rows) -> Array:
    """The rows of the table, a column for each of `columns`."""
    engine = setup.engine
    parts = [found.times[:, None], found.states]
    if setup.steps.has("all_coordinates"):
        program = {v.name for v in setup.steps.program.coordinates}
        names = [c.name for c in setup.study.model.coordinates]
        chosen = [i for i, name in enumerate(names) if name not in program]
        parts.append(engine.sweep("all_coordinates", found.times, found.states)[:, chosen])
    of_mode = f"outputs_{found.mode}"
    for name in (of_mode if setup.steps.has(of_mode) else "outputs", "energy"):
        parts.append(engine.sweep(name, found.times, found.states))
    return np.hstack(parts)


def csv_head(setup: Setup) -> str:
    """The first line."""
    return ",".join(_quoted(c.heading) for c in columns(setup)) + "\n"


def _quoted(text: str) -> str:
    """A field as RFC 4180 has it."""
    doubled = text.replace(chr(34), 2 * chr(34))
    return f'"{doubled}"' if set(text) & set(',"\n') else text


def csv_rows(table: Array) -> str:
    """Lines of numbers, each the shortest that reads back equal."""
    return "".join(",".join(map(repr, row)) + "\n" for row in table.tolist())


def state_words(setup: Setup, state: Array) -> str:
    """The state by name."""
    program = setup.steps.program
    pairs = zip((*program.coordinates, *program.speeds), state, strict=True)
    return ", ".join(f"{v.name} = {x:.6g}" for v, x in pairs)
