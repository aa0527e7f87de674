"""Shipped specs with constraints, each with multipliers and its admissible states, for tests."""

from functools import cache, cached_property

import numpy as np
from scenes import machine_of

from eomgen import compile, compile_contacts, formulation
from eomgen.algebra.arithmetic import FLOAT, evaluate
from eomgen.analysis import admissible, cards
from eomgen.checks import links
from eomgen.interpreter import run
from eomgen.mechanics import machine
from eomgen.program import Read
from eomgen.spec import read

STATES = 6


class Scene:
    """A scene with a multiplier for every independent row, at its admissible states."""

    def __init__(self, plain):
        self.model = plain.model
        self.report = cards.report(plain)
        self.linked = formulation.linked(plain, self.report)
        self.machine, self.links = self.linked.machine, self.linked.links
        self.names = [c.name for c in self.model.coordinates]
        self.basis = self.report.freedom.basis

    @cached_property
    def states(self):
        return [a.state for a in admissible.draw(self.machine, STATES, seed=11)]

    def numbers(self, nodes, state, arithmetic=FLOAT):
        """Values of nodes over all coordinates and rates."""
        columns = (*state.coordinates, *links.speeds_of(self.linked, state))
        return values(self.machine, nodes, state, columns, arithmetic)

    def accelerations(self, state, arithmetic=FLOAT):
        return np.array(self.numbers(self.machine.accelerations, state, arithmetic))

    def multipliers(self, state, arithmetic=FLOAT):
        found = self.numbers(self.machine.linked.multipliers, state, arithmetic)
        return dict(zip((r.name for r in self.machine.schur.rows), found, strict=True))

    def at(self, time=0.0, **known):
        """The admissible state nearest to these values; those of rates end with `_t`."""
        given = {n.removesuffix("_t") + "'" * n.endswith("_t"): v for n, v in known.items()}
        return admissible.positions(self.machine, {}, given, time).state

    def by_name(self, vector):
        return dict(zip(self.names, vector, strict=True))

    def parameter(self, name):
        symbols = {p.name: p.symbol for p in self.model.parameters}
        node = self.machine.kinematics.algebra.of(symbols[name])
        return self.numbers([node], self.report.initial.state)[0]

    def parameters(self, names):
        return [self.parameter(name) for name in names.split()]


def values(built, nodes, state, columns, arithmetic=FLOAT):
    """Values of a machine's nodes; `columns` are its own state; inputs are 0.3, 0.4, ..."""
    arguments = {"time": [state.time], "state": columns, "parameters": state.parameters}
    arguments["inputs"] = [0.3 + 0.1 * i for i in range(len(built.model.inputs))]
    bound = built.kinematics.algebra.bindings.values()
    leaves = {
        node: arithmetic.number(arguments[node.datum.argument][node.datum.index])
        for node in bound
        if isinstance(node.datum, Read)
    }
    return evaluate(nodes, leaves, arithmetic)


@cache
def scene(name):
    return Scene(machine_of(name))


def from_text(text):
    return Scene(compile.machine_of(read(text, "scene.yaml")))


class Touching:
    """The functions of a shipped spec with contacts."""

    def __init__(self, name):
        plain = machine_of(name)
        self.model = plain.model
        made = [compile.FUNCTIONS["accelerations"](plain), *compile_contacts.functions(plain)]
        self.functions = {f.name: f for f in made}
        self.parameters = [float(p.value) for p in machine.free_parameters(self.model)]

    def call(self, name, state):
        given = {"time": [0.0], "state": list(state), "inputs": [], "parameters": self.parameters}
        return np.array(run(self.functions[name], given, FLOAT))


@cache
def touching(name):
    return Touching(name)


def windows(count):
    """The N four-bar benchmark, A02: count + 1 uprights and count couplers."""
    names = [f"p{i}" for i in range(count + 1)] + [f"c{i}" for i in range(count)]
    points = [
        f"  A{i}: [{i}*l, 0]\n  B{i}: A{i} + l*[cos(p{i}), sin(p{i})]" for i in range(count + 1)
    ]
    points += [f"  E{i}: B{i} + l*[cos(c{i}), sin(c{i})]" for i in range(count)]
    rods = [f"  up{i}: {{rod: [A{i}, B{i}], mass: m}}" for i in range(count + 1)]
    rods += [f"  over{i}: {{rod: [B{i}, E{i}], mass: m}}" for i in range(count)]
    loops = [f"  loop{i}: {{holonomic: E{i} = B{i + 1}}}" for i in range(count)]
    return "\n".join(
        [
            "eom: 1\nsystem: A02\nspace: plane\ngravity: [0, -g]",
            "parameters: {m: 1 kg, l: 1 m, g: 9.81 m/s^2}\ncoordinates:",
            *(f"  {n}: {{unit: rad, role: {'linked' if n != 'p0' else 'free'}}}" for n in names),
            *("points:", *points, "bodies:", *rods, "constraints:", *loops),
            "initial: {p0: 90 deg, guess: {"
            + ", ".join(f"p{i}: 90 deg" for i in range(1, count + 1)),
            "}}\nrange: {p0: [20 deg, 160 deg], "
            + ", ".join(f"c{i}: [-0.01 deg, 0.01 deg]" for i in range(count))
            + "}\n",
        ]
    )
