"""The bits of a status word: each is set where something goes wrong, and nowhere else."""

from functools import cache

import numpy as np
import pytest
from scenes import LINKED, each, study_of, text_of

from eomgen import compile_watch
from eomgen.answers import Question, answers
from eomgen.compile_watch import BRANCH, FINITE, GIMBAL, OFF, PIVOT, WATCHES
from eomgen.evaluate import ENGINES
from eomgen.formulation import choose
from eomgen.interpreter import FLOAT, run
from eomgen.study import of_text
from eomgen.study_linked import program
from eomgen.wanted import Wanted

CRANK = text_of("slider_crank")
FREE = """\
eom: 1
system: A body turned by angles about skew axes, held on a plane
space: solid
gravity: [0, 0, -g]
parameters: {m: 2 kg, g: 9.81 m/s^2, I1: 0.5 kg*m^2, I2: 0.7 kg*m^2, I3: 0.6 kg*m^2,
   I12: 0.05 kg*m^2, I13: -0.04 kg*m^2, I23: 0.03 kg*m^2}
coordinates: {x: m, y: m, z: m, a: rad, b: rad, c: rad}
bodies:
  block:
    {mass: m, at: "[x, y, z]", turn: [[z, a], [[1, 2, 0], b], [x, c]],
     inertia: [[I1, I12, I13], [I12, I2, I23], [I13, I23, I3]]}
constraints: {plane: {holonomic: z = 0.2*x, reaction: press}}
initial: {x: 0.1 m, y: 0, z: 0.02 m, a: 0.1, b: 0.2, c: 0.3,
  x': 0, y': 0, z': 0, a': 0, b': 0, c': 0}
"""


@cache
def watched(text, wanted):
    study = of_text(text, "watched.yaml", Wanted(wanted))
    chosen = study.links.chosen
    return study, compile_watch.names(chosen.machine, chosen.block)


def bits(text, wanted, moved=()):
    """The mask at the initial state with some entries moved; Names of the bits that are set."""
    study, names = watched(text, wanted)
    made = study.program
    state = [float(v.value) for v in (*made.coordinates, *made.speeds)]
    for place, value in moved:
        state[place] = value
    given = {
        "time": [0.0],
        "state": state,
        "inputs": [0.0] * len(made.inputs),
        "parameters": [float(p.value) for p in made.parameters],
    }
    values = run(made.function("watch"), given, FLOAT)
    mask = compile_watch.mask(names, values)
    return {name for name, watch in WATCHES.items() if mask & watch.bit}


@each(LINKED)
def test_no_bit_is_set_at_the_start_of_a_shipped_scene(name):
    links = study_of(name).links
    for wanted in ("multiplier", links.chosen.name):
        chosen = choose(links.scene, Wanted(wanted))
        made = program(links.scene, chosen)
        if any(f.name == "watch" for f in made.functions):
            values = [v.value for v in (*made.coordinates, *made.speeds)]
            if None in values:
                continue
            given = {
                "time": [0.0],
                "state": [float(v) for v in values],
                "inputs": [0.0] * len(made.inputs),
                "parameters": [float(p.value) for p in made.parameters],
            }
            found = run(made.function("watch"), given, FLOAT)
            names = compile_watch.names(chosen.machine, chosen.block)
            assert compile_watch.mask(names, found) == 0


@pytest.mark.parametrize("wanted", ["multiplier", "nullspace"])
def test_off_the_constraints(wanted):
    assert bits(CRANK, wanted) == set()
    # psi, 1e-5 rad beside its value
    start = float(watched(CRANK, wanted)[0].program.coordinates[1].value)
    assert bits(CRANK, wanted, [(1, start + 1e-5)]) == {OFF}
    assert bits(CRANK, wanted, [(1, start + 1e-8)]) == set()


def test_the_branch_of_the_null_space():
    """With psi beyond a right angle the rod points back: the determinant has changed its sign."""
    assert BRANCH in bits(CRANK, "nullspace", [(1, 2.5)])
    assert BRANCH not in bits(CRANK, "multiplier", [(1, 2.5)])


def test_the_pivot_of_the_null_space():
    found = bits(CRANK, "nullspace", [(1, np.pi / 2 - 1e-6)])
    assert PIVOT in found
    assert PIVOT not in bits(CRANK, "nullspace", [(1, np.pi / 2 - 1e-2)])


def test_an_acceleration_that_is_not_finite():
    size = len(watched(CRANK, "multiplier")[0].program.coordinates)
    assert FINITE in bits(CRANK, "multiplier", [(size, 1e200)])


@pytest.mark.parametrize("step", [0.04, -0.04, 0.2])
def test_angles_near_their_singular_position(step):
    """About z, the skew axis (1, 2, 0) and x: det = a . R(b, q) (b x c) = -2 cos(q)/sqrt(5)."""
    found = bits(FREE, "multiplier", [(4, np.pi / 2 + step)])
    assert (GIMBAL in found) == (abs(2 * np.sin(step) / np.sqrt(5)) < 0.05)


def test_a_value_that_is_not_a_number_sets_its_bit():
    assert compile_watch.mask([FINITE, OFF], [float("nan"), 1.0]) == WATCHES[FINITE].bit


def test_every_bit_is_its_own_and_has_words():
    found = [w.bit for w in WATCHES.values()]
    assert found == [2, 4, 8, 16, 32]
    assert compile_watch.words(sum(found)) == tuple(w.words for w in WATCHES.values())
    assert compile_watch.words(0) == ()


@pytest.mark.parametrize("using", ENGINES)
def test_the_command_line_has_the_words(using):
    study = watched(FREE, "multiplier")[0]
    near = '{"coordinates": {"b": "1.5607963267948966"}}'
    (found,) = answers(study, near, Question(using=using))
    assert found["status"] == {"bits": 32, "words": [WATCHES[GIMBAL].words]}
    (found,) = answers(study, "{}", Question(using=using))
    assert found["status"] == {"bits": 0, "words": []}
