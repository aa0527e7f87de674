"""Every shipped spec with constraints: all formulations agree, and give the published values."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import sympy as sp
from scenes import SHIPPED, machine_of, model_of, text_of
from scipy.integrate import solve_ivp

from eomgen import compile, compile_contacts
from eomgen.algebra.arithmetic import FLOAT, evaluate, mpmath_arithmetic
from eomgen.analysis import admissible, cards
from eomgen.interpreter import run
from eomgen.mechanics import constraints, lagrange, machine, minimal, minimal_graph, nullspace
from eomgen.program import Read
from eomgen.spec import read

MPMATH = mpmath_arithmetic(50)
STATES = 6
LINKED = [name for name in SHIPPED if model_of(name).constraints]
BILATERAL = [n for n in LINKED if any(c.kind != "unilateral" for c in model_of(n).constraints)]
# nonholonomic rows eliminate no coordinate; these leave one that has no closed form
HOLONOMIC = [n for n in BILATERAL if all(c.kind == "holonomic" for c in model_of(n).constraints)]
WITHOUT_CLOSED_FORM = {"bead_on_fixed_hoop", "bricard", "dumbbell"}
MINIMAL = [n for n in HOLONOMIC if n not in WITHOUT_CLOSED_FORM]
bilateral = pytest.mark.parametrize("name", BILATERAL)


class Scene:
    """A scene with a multiplier for every independent row, at its admissible states."""

    def __init__(self, plain):
        self.model = plain.model
        self.report = cards.report(plain)
        dropped = self.report.freedom.dropped
        kept = tuple(row.name for row in plain.rows if row.name not in dropped)
        self.machine = replace(plain, kept=kept)
        self.names = [c.name for c in self.model.coordinates]
        self.basis = self.report.freedom.basis

    @cache
    def states(self, count=STATES, seed=11):
        return [a.state for a in admissible.draw(self.machine, count, seed)]

    def numbers(self, nodes, state, arithmetic=FLOAT, inputs=None):
        """Values of nodes over all coordinates and rates."""
        return values(self.machine, nodes, state, (*state.coordinates, *state.rates), arithmetic)

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


# --- the specs as pages


@pytest.mark.parametrize("name", LINKED)
def test_a_linked_spec_is_complete(name):
    model = model_of(name)
    assert text_of(name).splitlines()[0] == "# yaml-language-server: $schema=./eomgen.schema.json"
    assert list(model.title) == ["en", "es"]
    assert model.with_units
    assert all(p.value is not None or p.formula is not None for p in model.parameters)
    state = [s.name for c in model.coordinates for s in (c.symbol, c.rate)]
    assert sorted([*model.initial, *model.guess]) == sorted(state)
    assert model.expect.dof == scene(name).report.freedom.degrees_of_freedom


@bilateral
def test_the_known_initial_values_stay(name):
    assert scene(name).report.initial.distance < 1e-20


@bilateral
def test_what_the_author_calls_free_is_independent(name):
    free = tuple(c.name for c in model_of(name).coordinates if c.role == "free")
    if len(free) < len(model_of(name).coordinates):
        assert scene(name).basis.independent == free


# --- one motion, whatever the formulation


def relative(found, reference):
    return np.max(np.abs(found - reference)) / (np.max(np.abs(reference)) + 1e-300)


@bilateral
def test_multipliers_solve_the_full_system(name):
    """M q'' + h = Q + J' lambda and J q'' + gamma = 0 with every row, dense, by least squares."""
    found = scene(name)
    equations, rows = found.machine.equations, found.machine.rows
    n, m = len(found.names), len(rows)
    for state in found.states():
        inertia = found.numbers([e for row in equations.mass_matrix for e in row], state)
        jacobian = np.reshape(found.numbers([e for r in rows for e in r.jacobian], state), (m, n))
        right = found.numbers(equations.generalized_forces, state)
        right = np.subtract(right, found.numbers(equations.bias, state))
        gamma = np.array(found.numbers([r.gamma for r in rows], state))
        matrix = np.block([[np.reshape(inertia, (n, n)), -jacobian.T], [jacobian, np.zeros((m, m))]])
        # rows of one size, for the tolerance of the least squares
        size = np.abs(matrix).max(axis=1)
        dense = np.linalg.lstsq(
            matrix / size[:, None], np.concatenate([right, -gamma]) / size, rcond=1e-12
        )[0]
        assert relative(found.accelerations(state), dense[:n]) < 1e-9


@bilateral
def test_the_null_space_moves_alike(name):
    found = scene(name)
    for state in found.states():
        rates = [r for n, r in zip(found.names, state.rates, strict=True) if n in found.basis.independent]
        at = {
            "time": [float(state.time)],
            "state": [float(v) for v in (*state.coordinates, *rates)],
            "parameters": [float(p) for p in state.parameters],
        }
        kept, independent = found.machine.kept, found.basis.independent
        reduced = nullspace.derive(found.model, independent, kept, at)
        built = compile.Machine(reduced.kinematics, (), reduced.pivots)
        moved = values(built, built.accelerations, state, (*state.coordinates, *rates))
        assert relative(np.array(moved), found.accelerations(state)) < 1e-10


@cache
def eliminations(name):
    found = scene(name)
    kinematics = lagrange.closed_kinematics(found.model)
    rows = [r for r in constraints.rows(kinematics) if r.name in found.machine.kept]
    residuals = [minimal.Residual((r.name,), r.residual) for r in rows]
    dependent = [c for c in found.model.coordinates if c.name in found.basis.dependent]
    symbols = [c.symbol for c in found.model.coordinates]
    return minimal.eliminations(kinematics.algebra, residuals, dependent, symbols)


@pytest.mark.parametrize("name", HOLONOMIC)
def test_which_specs_have_a_closed_form(name):
    assert (eliminations(name) is not None) == (name in MINIMAL)


@pytest.mark.parametrize("name", MINIMAL)
def test_the_minimal_coordinates_move_alike(name):
    found = scene(name)
    free = [i for i, n in enumerate(found.names) if n in found.basis.independent]
    bindings = found.machine.kinematics.algebra.bindings
    for state in found.states():
        known = dict(zip(bindings, found.numbers(list(bindings.values()), state), strict=True))
        chosen = minimal_graph.choose(eliminations(name), known)
        built = compile.Machine(minimal_graph.kinematics(found.model, chosen))
        columns = [(*state.coordinates, *state.rates)[i + k] for k in (0, len(found.names)) for i in free]
        moved = values(built, built.accelerations, state, columns)
        reference = found.accelerations(state)
        size = np.abs(reference).max()
        assert np.max(np.abs(moved - reference[free])) / size < 1e-10
