"""State files: JSON from the user -> exact arguments of a program."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from typing import Any

import sympy as sp

from eomgen.errors import UsageError
from eomgen.mechanics import machine, speeds
from eomgen.model import Model

KEYS = ("t", "coordinates", "rates", "speeds", "accelerations", "inputs", "parameters")
LONGEST_NUMBER = 400  # characters
LARGEST_EXPONENT = 4000
UNIT_TOLERANCE = sp.Rational(1, 10**9)  # of the square of a quaternion's length


@dataclass(frozen=True)
class State:
    """Exact values in the order of the program's arguments; `rates` of the coordinates."""

    time: sp.Expr
    coordinates: tuple[sp.Expr, ...]
    rates: tuple[sp.Expr, ...] | None  # None where the speeds are given instead
    speeds: tuple[sp.Expr, ...] | None
    inputs: tuple[sp.Expr, ...]
    parameters: tuple[sp.Expr, ...]
    accelerations: tuple[sp.Expr, ...] | None = None  # of the speeds, where they are given


def read(text: str, model: Model, *, needs_time: bool) -> tuple[State, ...]:
    """The states of a JSON text: one object or a list of them.

    Raises:
        UsageError: one line for everything wrong with the text.
    """
    found = _parsed(text)
    entries = found if isinstance(found, list) else [found]
    states: list[State | None] = []
    problems: list[str] = []
    for number, entry in enumerate(entries, 1):
        reader = _Reader(model, f"state {number}", problems)
        states.append(reader.state(entry, needs_time))
    if problems:
        raise UsageError("\n".join(problems))
    return tuple(s for s in states if s is not None)


def _parsed(text: str) -> Any:
    try:
        return json.loads(
            text,
            parse_float=_Decimal,
            parse_int=_Decimal,
            parse_constant=_Decimal,
            object_pairs_hook=_unique,
        )
    except (json.JSONDecodeError, RecursionError) as error:
        raise UsageError(f"the state file is not JSON: {error}") from error


class _Decimal(str):
    """A number of the JSON text, as it was written."""

    __slots__ = ()


def _unique(pairs: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """An object; a key that is given twice is an error."""
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise UsageError(f"the state file gives {key!r} twice in one object")
        found[key] = value
    return found


def exact(text: str) -> sp.Expr | None:
    """The rational number of a decimal text; None where it is not one."""
    if len(text) > LONGEST_NUMBER:
        return None
    try:
        value = Decimal(text.strip())
    except InvalidOperation:
        return None
    if not value.is_finite() or abs(value.adjusted()) > LARGEST_EXPONENT:
        return None
    fraction = Fraction(value)
    return sp.Rational(fraction.numerator, fraction.denominator)


@dataclass(frozen=True)
class _Reader:
    """Reads one state and notes everything that is wrong with it."""

    model: Model
    where: str
    problems: list[str]

    def wrong(self, message: str) -> None:
        """Note a mistake."""
        self.problems.append(f"{self.where}: {message}")

    def state(self, entry: Any, needs_time: bool) -> State | None:
        """The state, or None where something is wrong."""
        before = len(self.problems)
        if not isinstance(entry, Mapping) or isinstance(entry, str):
            self.wrong('is not an object such as {"coordinates": {...}, "rates": {...}}')
            return None
        self.known(entry, KEYS, "key")
        model, initial = self.model, self.model.initial
        rates, speeds = self.motion(entry)
        state = State(
            time=self.time(entry, needs_time),
            coordinates=self.values(
                entry, "coordinates", [c.name for c in model.coordinates], initial
            ),
            rates=rates,
            speeds=speeds,
            inputs=self.values(entry, "inputs", [i.name for i in model.inputs], {}),
            parameters=self.parameters(entry),
            accelerations=self.accelerations(entry),
        )
        self.quaternions(state)
        return state if len(self.problems) == before else None

    def quaternions(self, state: State) -> None:
        """Note every quaternion whose length is not 1."""
        if len(state.coordinates) < len(self.model.coordinates):
            return  # said already
        symbols = [c.symbol for c in self.model.coordinates]
        given = dict(zip(symbols, state.coordinates, strict=True))
        for q in self.model.quaternions:
            excess = sp.Abs(sum(given[s] ** 2 for s in q.symbols) - 1)
            if excess > UNIT_TOLERANCE:
                self.wrong(
                    f"the quaternion {q.name} is not of length 1 (its square is off by "
                    f"{float(excess):.1e}); divide it by its length"
                )

    def motion(
        self, entry: Mapping[str, Any]
    ) -> tuple[tuple[sp.Expr, ...] | None, tuple[sp.Expr, ...] | None]:
        """(rates, speeds): declared speeds may be given instead of rates, never both."""
        model = self.model
        if "speeds" in entry:
            if not model.speeds:
                self.wrong("the spec declares no speeds; give rates")
            if "rates" in entry:
                self.wrong("give rates or speeds, not both")
            return None, self.values(entry, "speeds", [s.name for s in model.speeds], {})
        initial = {
            c.name: model.initial[c.rate.name]
            for c in model.coordinates
            if c.rate.name in model.initial
        }
        return self.values(entry, "rates", [c.name for c in model.coordinates], initial), None

    def accelerations(self, entry: Mapping[str, Any]) -> tuple[sp.Expr, ...] | None:
        """The derivatives of the speeds, all or none; by coordinate where no speed is declared."""
        if "accelerations" not in entry:
            return None
        return self.values(entry, "accelerations", [*speeds.names(self.model)], {})

    def time(self, entry: Mapping[str, Any], needed: bool) -> sp.Expr:
        """The time; free to be left out where nothing depends on it."""
        if "t" in entry:
            return self.number(entry["t"], "t")
        if needed:
            self.wrong("t is missing, and the equations depend on the time")
        return sp.S.Zero

    def parameters(self, entry: Mapping[str, Any]) -> tuple[sp.Expr, ...]:
        """Values of the free parameters; a derived one cannot be set."""
        derived = [p.name for p in self.model.parameters if p.formula is not None]
        given = entry.get("parameters", {})
        for name in derived:
            if isinstance(given, Mapping) and name in given:
                self.wrong(f"parameter {name!r} follows from others by a formula; set those")
        free = machine.free_parameters(self.model)
        values = {p.name: p.value for p in free if p.value is not None}
        return self.values(entry, "parameters", [p.name for p in free], values, ignore=derived)

    def values(
        self,
        entry: Mapping[str, Any],
        key: str,
        names: list[str],
        defaults: Mapping[str, sp.Expr],
        ignore: Iterable[str] = (),
    ) -> tuple[sp.Expr, ...]:
        """One value for each name: the file's, else the spec's, else a mistake."""
        given = entry.get(key, {})
        if not isinstance(given, Mapping):
            self.wrong(f"{key} is not an object of names and numbers")
            return ()
        self.known(given, [*names, *ignore], key)
        result = []
        for name in names:
            if name in given:
                result.append(self.number(given[name], f"{key} {name}"))
            elif name in defaults:
                result.append(defaults[name])
            else:
                self.wrong(f"{key}: {name} is missing, and the spec has no value for it")
        return tuple(result)

    def known(self, given: Mapping[str, Any], names: Iterable[str], what: str) -> None:
        """Note every key that is not a known name."""
        listed = list(names)
        for name in given:
            if name not in listed:
                near = difflib.get_close_matches(name, listed, 1, 0.6)
                known = f"known: {', '.join(listed)}" if listed else "there are none"
                hint = f"did you mean {near[0]!r}?" if near else known
                self.wrong(f"{what}: unknown name {name!r}; {hint}")

    def number(self, value: Any, what: str) -> sp.Expr:
        """A JSON number or a decimal string, exactly."""
        found = exact(value) if isinstance(value, str) else None
        if found is None:
            self.wrong(f"{what}: {str(value)[:40]!r} is not a finite decimal number")
            return sp.S.Zero
        return found
