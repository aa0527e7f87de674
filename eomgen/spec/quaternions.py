"""Coordinates declared as `quaternion`: four numbers, and the angular velocity as speeds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import sympy as sp

from eomgen.dimension import NONE, TIME
from eomgen.model import Coordinate, Description, Quaternion, Speed, quaternion_rates
from eomgen.spec.formulas import constant, description, text_of
from eomgen.spec.ledger import Mistake, suggestion
from eomgen.spec.reader import Entry, Mapping, Node, Scalar, Sequence
from eomgen.spec.scope import Known, Scene, Wanted

WORD = "quaternion"  # in the place of a unit
PARTS = ("0", "1", "2", "3")  # the scalar part first
AXES = ("x", "y", "z")
NEARLY = sp.Rational(1, 10**6)  # how far from 1 the length of given values may be


def is_quaternion(value: Node) -> bool:
    """Whether the value of a coordinate says that it is a quaternion."""
    unit = value.get("unit") if isinstance(value, Mapping) else value
    return text_of(unit) == WORD


def symbols(name: str) -> Quaternion:
    """The symbols of a quaternion `e`: e_0 ... e_3 and omega_e_x, omega_e_y, omega_e_z."""
    parts = [sp.Symbol(f"{name}_{part}", real=True) for part in PARTS]
    rates = [sp.Symbol(f"{name}_{part}'", real=True) for part in PARTS]
    speeds = [sp.Symbol(f"omega_{name}_{axis}", real=True) for axis in AXES]
    return Quaternion(
        name,
        (parts[0], parts[1], parts[2], parts[3]),
        (rates[0], rates[1], rates[2], rates[3]),
        (speeds[0], speeds[1], speeds[2]),
    )


def spin(parts: tuple[sp.Symbol, ...], rates: tuple[sp.Symbol, ...]) -> tuple[sp.Expr, ...]:
    """w = 2 (e0 v' - e0' v - v x v'): the vector part of 2 e* e', in the axes after the turn."""
    e, v, de, dv = parts[0], parts[1:], rates[0], rates[1:]
    return tuple(
        2 * (e * dv[i] - de * v[i] - v[i - 2] * dv[i - 1] + v[i - 1] * dv[i - 2]) for i in range(3)
    )


def declared(key: Scalar) -> Iterator[tuple[Scalar, Known]]:
    """The names that a quaternion brings, each at the place of its key."""
    own = symbols(key.text)
    yield key, Known("quaternion", (), None, key)
    for symbol in own.symbols:  # their rates stand in no formula: the speeds are for that
        yield replace(key, text=symbol.name), Known("coordinate", (symbol,), NONE)
    for speed, rate in zip(own.speeds, own.accelerations, strict=True):
        yield replace(key, text=speed.name), Known("speed", (speed, rate), NONE / TIME)


def coordinates(entry: Entry, scene: Scene) -> Iterator[Coordinate]:
    """The four coordinates of a quaternion."""
    about = description(entry.value).about
    for symbol in symbols(entry.key.text).symbols:
        rate, acceleration = (sp.Symbol(symbol.name + p, real=True) for p in ("'", "''"))
        said = Description("1", NONE, None, about)
        yield Coordinate(symbol.name, symbol, rate, acceleration, said)


def names(scene: Scene) -> list[str]:
    """The quaternions of a scene, in the order of the file."""
    return [name for name, known in scene.names.items() if known.kind == WORD]


def found(scene: Scene) -> tuple[Quaternion, ...]:
    """The quaternions of a scene."""
    return tuple(symbols(name) for name in names(scene))


def speeds(
    scene: Scene, coordinates: tuple[Coordinate, ...], given: tuple[Speed, ...]
) -> tuple[Speed, ...]:
    """All speeds of a scene with quaternions: rates where none are given, angular velocities.

    A scene without quaternions keeps the speeds that are given, or none.
    """
    quaternions = found(scene)
    if not quaternions:
        return given
    parts = {symbol for q in quaternions for symbol in q.symbols}
    plain = tuple(_rate_of(c) for c in coordinates if c.symbol not in parts)
    return (*(given or plain), *(s for q in quaternions for s in _spin_of(q)))


def _rate_of(coordinate: Coordinate) -> Speed:
    """The speed q' of a coordinate that is no part of a quaternion."""
    said = coordinate.description
    dimension = None if said.dimension is None else said.dimension / TIME
    return Speed(
        coordinate.rate.name,
        coordinate.rate,
        coordinate.acceleration,
        coordinate.rate,
        Description("", dimension, None, f"rate of {coordinate.name}"),
    )


def _spin_of(quaternion: Quaternion) -> Iterator[Speed]:
    formulas = spin(quaternion.symbols, quaternion.rates)
    moving = zip(AXES, quaternion.speeds, quaternion.accelerations, formulas, strict=True)
    for axis, symbol, rate, formula in moving:
        latex = rf"\omega_{{{quaternion.name},{axis}}}"
        about = f"angular velocity about the turned {axis} axis"
        said = Description("rad/s", NONE / TIME, latex, about)
        yield Speed(symbol.name, symbol, rate, formula, said)


def turn(node: Mapping, scene: Scene) -> Quaternion:
    """The quaternion that `{quaternion: e}` names; raises `Mistake` where it is none."""
    name = node.get("quaternion")
    assert isinstance(name, Scalar)
    if name.text not in names(scene):
        hint = suggestion(name.text, names(scene)) or f"declare '{name.text}: quaternion'"
        raise Mistake(name, "E515", f"'{name.text}' is no coordinate of kind quaternion", hint)
    return symbols(name.text)


def initial(entry: Entry, scene: Scene) -> dict[str, sp.Expr]:
    """The values of `e: [1, 0, 0, 0]`, divided by their length.

    Raises:
        Mistake: the name is no quaternion, or the length is not 1 within `NEARLY`.
    """
    key, value = entry.key, entry.value
    assert isinstance(value, Sequence)
    if key.text not in names(scene):
        raise Mistake(key, "E515", f"'{key.text}' is no quaternion, it has one value")
    wanted = Wanted("initial value", f"a part of '{key.text}'", NONE)
    values = [constant(item, scene, wanted) for item in value.items if isinstance(item, Scalar)]
    length = sp.sqrt(sum(v**2 for v in values))
    if abs(length - 1) > NEARLY:
        message = f"the quaternion '{key.text}' has length {float(length):.6g}, not 1"
        raise Mistake(key, "E515", message, "divide it by its length")
    pairs = zip(symbols(key.text).symbols, values, strict=True)
    return {symbol.name: v / length for symbol, v in pairs}


def with_rates(scene: Scene, values: dict[str, sp.Expr]) -> dict[str, sp.Expr]:
    """The values with e' = e w / 2 where the angular velocity of a quaternion is given."""
    result = dict(values)
    for own in found(scene):
        spins = [result.pop(s.name, None) for s in own.speeds]
        parts = [values.get(s.name) for s in own.symbols]
        if None not in parts and None not in spins:
            rates = quaternion_rates(parts, spins)
            result |= {r.name: rate for r, rate in zip(own.rates, rates, strict=True)}
    return result
