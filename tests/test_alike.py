"""Limbs that are alike are computed side by side, and nothing else changes."""

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from programs import arguments
from tools import tool

from eomgen import compile as compiling
from eomgen.algebra.alike import rows_of
from eomgen.algebra.graph import Graph
from eomgen.algebra.specialise_alike import side_by_side
from eomgen.algebra.unroll import unrolled
from eomgen.errors import CheckError
from eomgen.interpreter import FLOAT, call
from eomgen.numerics.compiled import build
from eomgen.program import Alike
from eomgen.render.code_context import Style, coded
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment
from eomgen.spec import read

AXES = ("[1, 2, 2]", "[2, -1, 2]")
SHORT = 20  # statements of a function that is not tried
FUNCTIONS = ("state_derivative", "accelerations", "mass_matrix", "bias", "energy")


def crawler(legs=4, other_axis=False):
    """A body that slides and turns, with legs of two links about skew axes, full inertias."""
    lines = [
        "eom: 1",
        "system: crawler",
        "space: solid",
        "gravity: [0, 0, -g]",
        "parameters:",
        "  g: 9.81 m/s^2",
        "  m: 5 kg",
        "  I_z: 0.3 kg*m^2",
        *(line for leg in range(legs) for part in "ab" for line in _parameters(leg, part)),
        "coordinates:",
        "  x: m",
        "  phi: rad",
        *(f"  {part}{leg}: rad" for leg in range(legs) for part in "ab"),
        "inputs:",
        *(f"  T{leg}: N*m" for leg in range(legs)),
        "bodies:",
        "  trunk:",
        "    mass: m",
        "    inertia: [I_z, I_z, I_z, 0, I_z/9, 0]",
        "    frame: {at: [x, 0, 0], turn: [[[2, 3, 6], phi]]}",
        *(line for leg in range(legs) for line in _leg(leg, other_axis and leg == 1)),
        "moments:",
        *(
            f"  M{leg}: {{on: A{leg}, from: trunk, in: A{leg}, moment: [0, T{leg}, 0]}}"
            for leg in range(legs)
        ),
    ]
    return "\n".join(lines) + "\n"


def _parameters(leg, part):
    key = f"{part}{leg}"
    k = Fraction(leg + 3 * (part == "b"), 100)
    yield f"  m_{key}: {float(2 - 10 * k)} kg"
    for axis, size in zip("xyz", (0.3, 0.1, -0.05), strict=True):
        yield f"  r_{key}_{axis}: {size + float(k)} m"
        yield f"  c_{key}_{axis}: {size / 2 - float(k)} m"
    # the last one is zero in the third leg, negative and positive in others
    moments = (0.05, 0.06, 0.04, 0.01, -0.005, 0.002 - float(k) / 10)
    for axes, size in zip(("xx", "yy", "zz", "xy", "xz", "yz"), moments, strict=True):
        yield f"  I_{key}_{axes}: {round(size, 6)} kg*m^2"


def _leg(leg, is_other):
    on, axes = "trunk", ("[1, 0, 0]", AXES[1]) if is_other else AXES
    for part, axis in zip("ab", axes, strict=True):
        key = f"{part}{leg}"
        name = f"{part.upper()}{leg}"
        at = ", ".join(f"r_{key}_{c}" for c in "xyz")
        yield f"  {name}:"
        yield f"    mass: m_{key}"
        moments = ", ".join(f"I_{key}_{e}" for e in ("xx", "yy", "zz", "xy", "xz", "yz"))
        yield f"    inertia: [{moments}]"
        yield f"    frame: {{on: {on}, at: [{at}], turn: [[{axis}, {key}]]}}"
        yield f"    com: [{', '.join(f'c_{key}_{c}' for c in 'xyz')}]"
        on = name


@cache
def built(fold, **shape):
    """A crawler in C as it is shipped, with loops."""
    tool("cc")
    code = coded(program(**shape), Style(fold=fold, longest=SHORT))
    return build(render(code, TARGETS["c"], environment()), code.program)


@cache
def program(**shape):
    """The program of a crawler."""
    made = compiling.program(compiling.machine_of(read(crawler(**shape), "crawler.yaml")))
    return replace(made, functions=tuple(f for f in made.functions if f.name in FUNCTIONS))


def names(of):
    return frozenset(p.name for p in of.parameters)


def loops(function):
    return [s for s in function.statements if isinstance(s, Alike)]


def drawn(of, seed):
    """A state and inputs at random; the parameters of the spec, or none where they are folded."""
    t, state, inputs, _ = arguments(of, seed)
    values = [float(p.value) for p in of.parameters]
    return {"time": [t], "state": state, "inputs": inputs, "parameters": values}


def same(first, second):
    first, second = np.array(first, float), np.array(second, float)
    return np.abs(first - second).max() <= 1e-12 * np.abs(first).max()


@pytest.mark.parametrize("fold", [False, True])
@pytest.mark.parametrize(
    ("shape", "lanes"),
    [
        ({"legs": 2}, 2),
        ({"legs": 4}, 4),
        ({"legs": 4, "other_axis": True}, 3),
        pytest.param({"legs": 8}, 8, marks=pytest.mark.slow),
    ],
)
def test_loops_compute_what_the_plain_program_does(shape, lanes, fold):
    plain = program(**shape)
    made = side_by_side(plain, names(plain) if fold else (), SHORT)
    (loop, *_) = loops(made.function("accelerations"))
    assert loop.lanes == lanes
    for seed in range(3):
        given = drawn(plain, seed)
        folded = given | ({"parameters": []} if fold else {})
        for function in plain.functions:
            expected = call(plain, function.name, given, FLOAT)
            assert same(expected, call(made, function.name, folded, FLOAT))


@pytest.mark.slow
def test_legs_take_as_many_statements_as_one():
    few, many = (side_by_side(program(legs=n), (), SHORT) for n in (4, 8))
    four, eight = (len(loops(made.function("accelerations"))[0].statements) for made in (few, many))
    assert four == eight
    written_out = unrolled(few.function("accelerations"))
    assert not loops(written_out)
    assert len(written_out.statements) > 3 * four


@pytest.mark.parametrize("shape", [{"legs": 1}, {"legs": 2, "other_axis": True}])
def test_legs_that_have_no_like_stay_apart(shape):
    made = side_by_side(program(**shape), (), SHORT)
    assert not loops(made.function("accelerations"))


def test_short_functions_are_not_tried():
    assert not any(loops(f) for f in side_by_side(program(), (), 10**6).functions)


def test_some_folded_parameters_leave_the_plain_program():
    made = side_by_side(program(), {"g"}, SHORT)
    assert not any(loops(f) for f in made.functions)
    assert "g" not in names(made)


@pytest.mark.parametrize("fold", [False, True])
def test_compiled_loops_equal_the_interpreter(fold):
    plain, compiled = program(), built(fold)
    assert loops(compiled.program.function("accelerations"))
    given = drawn(plain, 5)
    kept = [] if fold else given["parameters"]
    for function in plain.functions:
        found = compiled.call(function.name, 0.3, given["state"], given["inputs"], kept)
        expected = call(plain, function.name, given | {"time": [0.3]}, FLOAT)
        assert same(expected, np.ravel(found))


def test_python_writes_loops_out():
    code = coded(program(), Style(longest=SHORT))
    (text,) = render(code, TARGETS["python"], environment()).values()
    space = {}
    exec(compile(text, "crawler", "exec"), space)
    given = drawn(program(), 6)
    found = space["accelerations"](0.0, given["state"], given["inputs"], {})
    assert same(call(program(), "accelerations", given, FLOAT), found)


def test_constants_of_the_legs_are_arrays_of_the_model():
    text = render(coded(program(), Style(longest=SHORT)), TARGETS["c"], environment())
    assert "crawler_real c0[4];" in text["crawler.h"]
    assert "m->c0[lane]" in text["crawler.c"]
    assert "for (int lane = 0; lane < 4; lane++) {" in text["crawler.c"]


@pytest.mark.parametrize("leg", range(4))
def test_a_leg_without_inertia_is_singular(leg):
    plain, compiled = program(), built(False)
    given = drawn(plain, 7)
    gone = ("m_b{0}", *(f"I_b{{0}}_{axes}" for axes in ("xx", "yy", "zz", "xy", "xz", "yz")))
    empty = {name.format(leg) for name in gone}
    values = [0.0 if p.name in empty else float(p.value) for p in plain.parameters]
    with pytest.raises(CheckError, match="singular"):
        compiled.call("accelerations", 0.0, given["state"], given["inputs"], values)


def test_rows_are_exact():
    """Sums over lanes, values of all lanes, values that several share: in rational numbers."""
    graph = Graph()
    q = [graph.read("state", i) for i in range(5)]
    legs = [(q[4] + a) * (a - 3) for a in q[:4]]
    total = legs[0] + legs[1] + legs[2] + legs[3]
    results = [*((leg + 1) / (total + q[4]) * leg for leg in legs), total]
    rows = rows_of(results, (), lambda node: not node.leaves)
    assert rows is not None
    assert {rows.phases[n] for n in legs} == {1}
    assert rows.phases[total] == 2
    assert {rows.phases[r] for r in results[:4]} == {3}


def test_terms_in_another_order_are_alike():
    graph = Graph()
    q = [graph.read("state", i) for i in range(8)]
    first = [q[2 * i] * q[2 * i] + q[2 * i + 1] for i in range(4)]
    swapped = [*first[:3], q[7] + q[6] * q[6] * 1]
    results = [a * (a + 2) for a in swapped]
    rows = rows_of(results, (), lambda node: not node.leaves)
    assert rows is not None
    assert set(first) <= rows.home.keys()
