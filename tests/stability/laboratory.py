"""Scenes and methods of the stability suite, run with the C that we ship."""

from dataclasses import replace
from fractions import Fraction as F
from functools import cache

import numpy as np
from scenes import SHIPPED
from tools import tool

from eomgen import compile_flow, compile_steps, stepping, study
from eomgen.integrators.methods import METHODS, Method
from eomgen.integrators.steps import Steps
from eomgen.integrators.tableaus import Tableau
from eomgen.numerics import integrate
from eomgen.numerics.engine_c import EngineC
from eomgen.numerics.records import STOPPED, Arguments, Grid
from eomgen.wanted import Wanted

# for comparison only: coefficients of the C templates' explicit kind
EULER = Method("euler", 1, "explicit", "explicit Euler", Tableau(1, ((),), (F(1),), (F(0),)))
HEUN = Method(
    "heun", 2, "explicit", "Heun",
    Tableau(2, ((), (F(1),)), (F(1, 2), F(1, 2)), (F(0), F(1))),
)  # fmt: skip
RK3 = Method(
    "rk3", 3, "explicit", "Kutta's method of order 3",
    Tableau(3, ((), (F(1, 2),), (F(-1), F(2))), (F(1, 6), F(2, 3), F(1, 6)), (F(0), F(1, 2), F(1))),
)  # fmt: skip
EVERY = {m.name: m for m in (EULER, HEUN, RK3, *METHODS.values())}
PROJECTIONS = ("project_positions", "project_rates", "constraint_margin")

OSCILLATOR = """\
eom: 1
system: Oscillator
space: line
gravity: 0
parameters: {m: 1, k: 1, c: 0}
coordinates: {x: 1}
bodies:
  mass: {mass: m, at: "[x]"}
springs: [{along: x, stiffness: k}]
dampers: [{along: x, damping: c}]
initial: {x: 1, x': 0}
"""


@cache
def derived(text, formulation="auto", baumgarte=F(0)):
    """The study of a spec text or of a shipped spec."""
    source = SHIPPED[text].read_text(encoding="utf-8") if text in SHIPPED else text
    return study.of_text(source, "scene.yaml", Wanted(formulation, baumgarte))


@cache
def stepped(text, formulation="auto", baumgarte=F(0), *, bare=False, compensated=False):
    """Every method over a scene, Verlet too where it is not symplectic; bare: not projected."""
    found = derived(text, formulation, baumgarte)
    scene = stepping.scene_of(found)
    methods = [m for m in METHODS.values() if m.kind != "verlet"]
    extra = (*compile_steps.functions(scene, methods), *compile_flow.functions(scene.machine))
    program = stepping.extended(found.program, extra)
    if bare:
        kept = tuple(f for f in program.functions if f.name not in PROJECTIONS)
        program = replace(program, functions=kept)
    has_rates = all(s.name.endswith("'") for s in program.speeds)
    wanted = [m for m in EVERY.values() if has_rates or m.kind != "verlet"]
    return Steps(program, tuple(wanted), compensated)


def engine(steps, real="double", inputs=(), **parameters):
    """The compiled scene, with some parameters of another value than the spec's."""
    tool("cc")
    known = {p.name: p.value for p in steps.program.parameters}
    assert parameters.keys() <= known.keys()
    values = {n: v if n in parameters else float(v) for n, v in (known | parameters).items()}
    given = tuple(inputs) or (0.0,) * len(steps.program.inputs)
    return EngineC(steps, Arguments(given, tuple(values.values())), real)


def start(steps, **values):
    """The state of the spec's `initial`, with some values changed."""
    names = [v.name for v in (*steps.program.coordinates, *steps.program.speeds)]
    assert values.keys() <= set(names)
    return np.array([
        float(values[v.name] if v.name in values else v.value)
        for v in (*steps.program.coordinates, *steps.program.speeds)
    ])  # fmt: skip


def run(scene, method, state, step, count, every=None):  # noqa: PLR0913
    """Rows after `every` steps, the first the start; default: the end alone."""
    grid = Grid(0.0, step, count, every or count)
    return integrate.run(scene, EVERY[method], np.array(state, float), grid)


def failed(rows, limit=1e3):
    """Whether a run stopped, or left for far away."""
    return bool(rows.stopped & STOPPED) or not np.abs(rows.states).max() < limit


def amplitude(rows):
    """Of a linear oscillator with m = k = 1, at every row."""
    return np.hypot(rows.states[:, 0], rows.states[:, 1])


def energies(scene, rows):
    """Of every row [J]."""
    return scene.sweep("energy_flow", rows.times, rows.states)[:, 0]


def drift(scene, rows):
    """The largest energy error against the largest kinetic energy."""
    found = energies(scene, rows)
    kinetic = scene.sweep("energy", rows.times, rows.states)[:, 0]
    return float(np.abs(found - found[0]).max() / kinetic.max())


def residual(scene, rows, name="constraint_residuals"):
    """The largest residual at each row."""
    return np.abs(scene.sweep(name, rows.times, rows.states)).max(axis=1)
