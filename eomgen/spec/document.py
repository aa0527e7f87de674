"""Node tree -> Model: one call for each key, then what only the whole file can tell."""

import re
from collections.abc import Mapping as Map
from dataclasses import replace
from hashlib import sha256
from pathlib import PurePath
from typing import Any

import sympy as sp

from eomgen.dimension import Dimension
from eomgen.model import Drive, Force, Model
from eomgen.spec import (
    claims,
    constants,
    constraints,
    cycles,
    dimensions,
    loads,
    motion,
    movers,
    names,
    places,
    quaternions,
    roles,
)
from eomgen.spec.formula import NAME
from eomgen.spec.language import LANGUAGE
from eomgen.spec.ledger import Ledger, Mistake
from eomgen.spec.reader import Entry, Mapping, Point, Scalar, decode, lines_of, read_tree
from eomgen.spec.scope import Scene
from eomgen.spec.structure import conform, is_missing


def read(text: str | bytes, file: str) -> Model:
    """The model of a spec; raises `SpecError` with every fault of the file."""
    ledger = Ledger(file, ())
    decoded = ledger.attempt(decode, text)
    ledger.close()
    assert decoded is not None
    ledger.lines = lines_of(decoded)
    node = ledger.attempt(read_tree, decoded, ledger)
    root = conform(node, LANGUAGE, ledger) if node is not None else None
    if not isinstance(root, Mapping) or root.get("space") is None:
        ledger.close()  # without a space nothing is known of any vector
    assert isinstance(root, Mapping)
    assert isinstance(node, Mapping)
    found = _model(node, root, ledger)
    ledger.close()
    digest = sha256(text if isinstance(text, bytes) else text.encode()).hexdigest()
    return replace(found, name=_identifier(file, found.title), digest=digest)


def _model(whole: Mapping, root: Mapping, ledger: Ledger) -> Model:
    """The model as far as the file is right; what is wrong is in the ledger.

    Names come from the whole file, so that a wrong entry is one fault and not one for each use.
    """
    space = root.get("space")
    scene = Scene(ledger, space.text if isinstance(space, Scalar) else "plane")
    scene.names = names.declare(whole, ledger)
    scene.complete = names.are_complete(whole)
    known = Model("", _title(root), scene.space, (sp.S.Zero,) * scene.size)
    known = replace(
        known,
        parameters=constants.parameters(_entries(root, "parameters", scene), scene),
        coordinates=motion.coordinates(_entries(root, "coordinates", scene), scene),
        inputs=motion.inputs(_entries(root, "inputs", scene), scene),
        prescribed=motion.prescribed(_entries(root, "prescribed", scene), scene),
        speeds=motion.speeds(_entries(root, "speeds", scene), scene),
    )
    pushes = loads.each(root.get("forces"), "force", loads.force, scene)
    known = replace(
        known,
        speeds=quaternions.speeds(scene, known.coordinates, known.speeds),
        quaternions=quaternions.found(scene),
    )
    known = replace(
        known,
        gravity=_gravity(whole, root, scene),
        points=places.points(_entries(root, "points", scene), scene),
        bodies=places.bodies(_entries(root, "bodies", scene), scene),
        springs=loads.each(root.get("springs"), "spring", loads.spring, scene),
        dampers=loads.each(root.get("dampers"), "damper", loads.damper, scene),
        forces=tuple(p for p in pushes if isinstance(p, Force)),
        drives=tuple(p for p in pushes if isinstance(p, Drive)),
        moments=loads.each(root.get("moments"), "moment", loads.moment, scene),
        energy=loads.energy(root.get("energy"), scene),
    )
    moving = movers.movers(known.points, known.bodies, scene)
    known = replace(
        known,
        constraints=constraints.constraints(root.get("constraints"), moving, scene),
        initial=claims.initial(_table(root, "initial"), scene),
        guess=claims.guess(_table(root, "initial"), scene),
        range=claims.ranges(_table(root, "range"), scene),
        outputs=claims.outputs(_table(root, "outputs"), scene),
        simulation=claims.simulation(root.get("simulate"), scene),
        expect=claims.expectation(root.get("expect"), scene),
        with_units=scene.units_seen,
    )
    ledger.attempt(cycles.check, known.points, known.bodies, scene)
    roles.check(whole, root, scene)
    return _with_dimensions(known, scene) if scene.units_seen else _without_dimensions(known)


def _with_dimensions(known: Model, scene: Scene) -> Model:
    """The model after the dimension check, with the dimensions that follow from its formulas."""
    found = dimensions.check(scene)
    stated = {name: k.dimension for name, k in scene.names.items()}
    return _described(known, {name: d or found.get(name) for name, d in stated.items()})


def _without_dimensions(known: Model) -> Model:
    """The model of a file without units: a bare number may be anything."""
    return _described(known, {})


def _described(known: Model, found: Map[str, Dimension | None]) -> Model:
    """The model with each name's dimension in its description."""

    def described(records: tuple[Any, ...]) -> tuple[Any, ...]:
        return tuple(_with(dimension(r), r) for r in records)

    def dimension(record: Any) -> Dimension | None:
        # the rate of a coordinate that serves as a speed has no name of its own in the file
        own = record.description.dimension if found else None
        return found.get(record.name, own)

    return replace(
        known,
        parameters=described(known.parameters),
        coordinates=described(known.coordinates),
        speeds=described(known.speeds),
        prescribed=described(known.prescribed),
        inputs=described(known.inputs),
        outputs=described(known.outputs),
    )


def _with(dimension: Dimension | None, record: Any) -> Any:
    if record.description.dimension == dimension:
        return record
    return replace(record, description=replace(record.description, dimension=dimension))


def _table(root: Mapping, section: str) -> tuple[Entry, ...]:
    table = root.get(section)
    return table.entries if isinstance(table, Mapping) else ()


def _entries(root: Mapping, section: str, scene: Scene) -> tuple[Entry, ...]:
    """The entries whose names could be declared."""
    return tuple(
        entry
        for entry in _table(root, section)
        if entry.key.text in scene.names and scene.names[entry.key.text].spot is entry.key
    )


def _title(root: Mapping) -> dict[str, str]:
    system = root.get("system")
    if isinstance(system, Scalar):
        return {"en": system.text}
    return {e.key.text: e.value.text for e in _table(root, "system") if isinstance(e.value, Scalar)}


def _gravity(whole: Mapping, root: Mapping, scene: Scene) -> tuple[sp.Expr, ...]:
    node = root.get("gravity")
    zeros = (sp.S.Zero,) * scene.size
    if node is not None:
        return scene.ledger.attempt(loads.gravity, node, scene) or zeros
    if root.get("bodies") is not None and is_missing("gravity", whole, LANGUAGE.keys):
        message = "missing key 'gravity': there are bodies"
        hint = "there is no default; write 'gravity: 0' for none"
        scene.ledger.note(Mistake(Point(root.line, root.column), "E110", message, hint))
    return zeros


def _identifier(file: str, title: Map[str, str]) -> str:
    """A name for generated code: the file's stem, or the title where there is no file."""
    stem = PurePath(file).stem
    word = stem if re.search("[A-Za-z]", stem) else next(iter(title.values()), "").lower()
    name = re.sub("[^A-Za-z0-9_]+", "_", word).strip("_")
    if not re.search("[A-Za-z]", name):
        return "model"
    return name if NAME.fullmatch(name) else f"model_{name}"
