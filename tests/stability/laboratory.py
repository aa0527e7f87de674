"""Scenes and methods of the stability suite, run with the C that we ship."""

from dataclasses import replace
from fractions import Fraction as F
from functools import cache

import numpy as np
from scenes import SHIPPED
from small_scenes import oscillator
from tools import tool

from eomgen import compile_flow, compile_steps, stepping, study
from eomgen.formulation import Linked, choose
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

OSCILLATOR = oscillator()

DOUBLE_PENDULUM = """\
eom: 1
system: Double pendulum
space: plane
gravity: [0, -g]
parameters: {m: 1 kg, l: 1 m, g: 9.81 m/s^2}
coordinates: {a: rad, b: rad}
points: {A: "l*[sin(a), -cos(a)]", B: "A + l*[sin(b), -cos(b)]"}
bodies:
  upper: {mass: m, at: A}
  lower: {mass: m, at: B}
initial: {a: 0.3 rad, b: 0.3 rad, a': 0 rad/s, b': 0 rad/s}
"""

# four uniform bars; `lengths`: crank, coupler, rocker, ground
FOUR_BAR = """\
eom: 1
system: Four-bar linkage
space: plane
gravity: [0, -g]
parameters: {{a: {} m, b: {} m, c: {} m, e: {} m, m: 1 kg, g: 9.81 m/s^2}}
coordinates:
  q1: {{unit: rad, role: free}}
  q2: {{unit: rad, role: linked}}
  q3: {{unit: rad, role: linked}}
points:
  A: [0, 0]
  D: [e, 0]
  B: A + a*[cos(q1), sin(q1)]
  C: B + b*[cos(q2), sin(q2)]
  Cr: D + c*[cos(q3), sin(q3)]
bodies:
  crank: {{rod: [A, B], mass: m}}
  coupler: {{rod: [B, C], mass: m}}
  rocker: {{rod: [D, Cr], mass: m}}
constraints:
  loop: {{holonomic: C = Cr, reaction: pin}}
initial: {}
"""
CRANK_ROCKER = FOUR_BAR.format(
    "0.4", "1", "0.9", "1",
    "{q1: 0.5 rad, q1': 0 rad/s, "
    "guess: {q2: 40 deg, q3: 80 deg, q2': 0 rad/s, q3': 0 rad/s}}",
)  # fmt: skip
TURNING = "{q1: 90 deg, q1': -1 rad/s, guess: {q2: 0 deg, q3: 90 deg, q2': 0 rad/s, q3': -1 rad/s}}"
PARALLELOGRAM = FOUR_BAR.format("1", "1", "1", "1", TURNING)


@cache
def studied(text):
    """The study of a spec text or of a shipped spec."""
    source = SHIPPED[text].read_text(encoding="utf-8") if text in SHIPPED else text
    return study.of_text(source, "scene.yaml")


def derived(text, formulation="auto", baumgarte=F(0)):
    """The study in a formulation, the analysis made once."""
    found = studied(text)
    if found.links is None:
        return found
    chosen = choose(found.links.scene, Wanted(formulation, baumgarte))
    links = replace(found.links, chosen=chosen)
    return replace(found, links=links, program=links.program())


def insisted(text, formulation):
    """The study in a formulation that is refused for singular positions: as if there were none."""
    found = studied(text)
    scene = found.links.scene
    freedom = replace(scene.report.freedom, singularities=())
    blind = Linked(scene.machine, replace(scene.report, freedom=freedom))
    links = replace(found.links, chosen=choose(blind, Wanted(formulation)))
    return replace(found, links=links, program=links.program())


@cache
def stepped(text, formulation="auto", baumgarte=F(0), **how):
    """Every method over a scene, as `with_steps`."""
    return with_steps(derived(text, formulation, baumgarte), **how)


@cache
def insisting(text, formulation):
    """Every method over a scene in a formulation that it is refused."""
    return with_steps(insisted(text, formulation))


def with_steps(found, *, bare=False, compensated=False):
    """Every method, Verlet too where it is not symplectic; bare: not projected."""
    scene = stepping.scene_of(found)
    methods = [m for m in METHODS.values() if compile_steps.offers(scene, m)]
    extra = (*compile_steps.functions(scene, methods), *compile_flow.functions(scene.machine))
    program = stepping.extended(found.program, extra)
    if bare:
        kept = tuple(f for f in program.functions if f.name not in PROJECTIONS)
        program = replace(program, functions=kept)
    has_rates = all(s.name.endswith("'") for s in program.speeds)
    offered = {m.kind for m in methods} | ({"verlet"} if has_rates else set())
    wanted = [m for m in EVERY.values() if m.kind in offered]
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
        float(values.get(v.name, v.value))
        for v in (*steps.program.coordinates, *steps.program.speeds)
    ])  # fmt: skip


def run(scene, method, state, step, count, every=None):  # noqa: PLR0913, PLR0917
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
