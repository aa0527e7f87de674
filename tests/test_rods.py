"""Tensions of rods as unknowns: the same accelerations in 50 digits, and where there is no way."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hung import LOADED, SCENES, SPHERICAL, STRANGERS, cart
from scenes import FREE, model_of

from eomgen import compile, study
from eomgen.algebra import ldl
from eomgen.algebra.arithmetic import FLOAT, NUMPY, evaluate, mpmath_arithmetic
from eomgen.algebra.ldl import SingularMassMatrix
from eomgen.algebra.specialise import specialised, with_values
from eomgen.algebra.walk import below
from eomgen.checks import samples
from eomgen.errors import CheckError
from eomgen.interpreter import run
from eomgen.mechanics import virtual_work
from eomgen.mechanics.recursive import engine, loads, rods
from eomgen.mechanics.recursive.formulas import Clock
from eomgen.mechanics.recursive.short import Short, common_factor
from eomgen.spec import read

DIGITS, STATES = 50, 3
PRECISE = mpmath_arithmetic(DIGITS)
RODS = "tensions of rods"


@cache
def machine_of(name):
    return compile.machine_of(read(SCENES[name], f"{name}.yaml"))


def by_rods(machine):
    tree = machine.tree
    return rods.solve(machine.kinematics, tree, loads.of(machine.kinematics, tree))


def precisely(machine, nodes):
    """The values of nodes at each of some random states, in 50 digits."""
    drawn = samples.draw(machine.model, STATES, seed=5).arguments()
    for k in range(STATES):
        leaves = {
            n: PRECISE.number(drawn[n.datum.argument][n.datum.index][k]) for n in machine.leaves
        }
        yield evaluate(nodes, leaves, PRECISE)


def residual(machine, accelerations):
    """How far M q'' = Q - h is from true, relative to its terms; by d'Alembert's principle."""
    wanted = virtual_work.derive(machine.kinematics)
    worst, size = 0, len(accelerations)
    entries = [e for row in wanted.mass_matrix for e in row]
    nodes = [*accelerations, *wanted.generalized_forces, *wanted.bias, *entries]
    for values in precisely(machine, nodes):
        second, force, bias = (values[k * size : (k + 1) * size] for k in range(3))
        for i in range(size):
            row = values[(3 + i) * size : (4 + i) * size]
            terms = [m * a for m, a in zip(row, second, strict=True)] + [bias[i], -force[i]]
            worst = max(worst, abs(sum(terms)) / sum(abs(t) for t in terms))
    return worst


@pytest.mark.parametrize("name", SCENES)
def test_the_accelerations_solve_the_equations_of_virtual_work(name):
    machine = machine_of(name)
    solution = by_rods(machine)
    assert solution is not None
    assert residual(machine, solution[0]) < 1e-44


@pytest.mark.parametrize("name", SCENES)
def test_every_pivot_is_positive(name):
    machine = machine_of(name)
    flat = [node for pair in by_rods(machine)[1] for node in pair]
    assert flat
    for values in precisely(machine, flat):
        assert all(p > 1e-6 * s > 0 for p, s in zip(values[::2], values[1::2], strict=True))


@pytest.mark.parametrize("name", [n for n in FREE if n not in ("foucault_pendulum", "satellite")])
def test_of_the_shipped_scenes_the_hung_ones_are_solved_too(name):
    machine = compile.machine_of(model_of(name))
    if isinstance(machine.tree, Exception) or (solution := by_rods(machine)) is None:
        return
    assert residual(machine, solution[0]) < 1e-42


def test_which_shipped_scenes_have_only_particles():
    for name in (
        "cart_three_pendulums",
        "spherical_pendulum",
        "elastic_pendulum",
        "double_pendulum",
    ):
        assert by_rods(compile.machine_of(model_of(name))) is not None
    for name in ("two_link_arm", "furuta_pendulum", "skew_arm"):
        machine = compile.machine_of(model_of(name))
        assert isinstance(machine.tree, Exception) or by_rods(machine) is None


@pytest.mark.parametrize("name", STRANGERS)
def test_anything_else_is_left_to_the_other_methods(name):
    machine = compile.machine_of(read(STRANGERS[name], "stranger.yaml"))
    assert by_rods(machine) is None
    assert machine.engine.method != RODS


@pytest.mark.parametrize("count", [2, 4, 8])
def test_a_cart_with_pendulums_is_solved_for_its_tensions(count):
    chosen = machine_of(f"cart_{count}").engine
    assert chosen.method == RODS
    assert chosen.said.startswith(f"{RODS}, {chosen.cost.operations} operations, longest chain ")
    assert not chosen.lumped


def test_each_pendulum_more_takes_the_same_few_operations():
    costs = [machine_of(f"cart_{n}").engine.cost for n in (2, 4, 8)]
    assert costs[2].operations - costs[1].operations == 2 * (
        costs[1].operations - costs[0].operations
    )
    assert (costs[2].operations - costs[1].operations) / 4 <= 48  # 20 of them sine and cosine
    assert (costs[2].cycles - costs[1].cycles) / 4 <= 33


def test_the_method_is_taken_in_a_chain_of_a_hundred():
    machine = compile.machine_of(read(cart(100), "cart_100.yaml"))
    assert machine.engine.method == RODS
    assert len(compile.FUNCTIONS["accelerations"](machine).statements) < 2500


def test_many_chains_under_one_cart_are_not_coupled_each_with_each():
    text = cart(30)
    for i in range(2, 31):
        text = text.replace(f"P{i}: P{i - 1} +", f"P{i}: P0 +")
    machine = compile.machine_of(read(text, "star.yaml"))
    assert engine.METHODS[RODS].least(machine.tree) == 900
    assert machine.engine.method == "articulated bodies"


def test_a_sign_of_the_tensions_that_is_wrong_is_seen_by_the_checks(monkeypatch):
    whole = rods._pulled

    def wrong(*given, **named):
        return [(factor, -value) for factor, value in whole(*given, **named)]

    monkeypatch.setattr(rods, "_pulled", wrong)
    with pytest.raises(CheckError):
        study.of_text(cart(8), "cart.yaml")


@pytest.mark.parametrize("text", [cart(8), LOADED, SPHERICAL], ids=["cart", "loaded", "spherical"])
def test_the_scene_passes_every_check_of_the_command_line(text):
    report = study.of_text(text, "scene.yaml").report
    assert report.power < 1e-9


@pytest.mark.parametrize("folded", [False, True])
def test_specialised_code_gives_the_same(folded):
    machine = machine_of("cart_4")
    program = compile.program(machine)
    quick = specialised(program, with_values(program) if folded else ())
    drawn = samples.draw(machine.model, 4, seed=2).arguments()
    values = [p.value for p in program.parameters]
    drawn["parameters"] = [[float(v)] * 4 for v in values]
    found = []
    for each in (program, quick):
        given = {**drawn, "parameters": [] if each is quick and folded else drawn["parameters"]}
        arrays = {k: [np.array(v) for v in columns] for k, columns in given.items()}
        if each.prepare is not None:
            arrays["constants"] = run(each.prepare, arrays, NUMPY)
        function = next(f for f in each.functions if f.name == "accelerations")
        found.append(np.array(run(function, arrays, NUMPY)))
    assert np.max(np.abs(found[0] - found[1])) < 1e-11 * np.max(np.abs(found[0]))


def test_constants_are_prepared():
    """Nothing but the masses' and lengths' own combinations is left to be computed once."""
    quick = specialised(compile.program(machine_of("cart_4")))
    (function,) = (f for f in quick.functions if f.name == "accelerations")
    divisions = str(function.statements).count("'divide'")
    assert divisions == 3  # one for each tension but the last, whose pivot is constant


@pytest.mark.parametrize("zero", ["m0", "m2", "m4", "l3"])
@pytest.mark.parametrize("arithmetic", [FLOAT, NUMPY], ids=["float", "numpy"])
def test_a_mass_or_a_length_that_is_zero_when_it_runs_is_a_singular_status(zero, arithmetic):
    machine = machine_of("cart_4")
    function = compile.FUNCTIONS["accelerations"](machine)
    names = [p.name for p in compile.program(machine).parameters]
    parameters = [0.0 if name == zero else 0.7 for name in names]
    state = [0.1, 0.2, 0.3, 0.4, 0.5] + [0.6] * 5
    given = {"time": [0], "state": state, "inputs": [1], "parameters": parameters}
    numbers = {k: [arithmetic.number(v) for v in column] for k, column in given.items()}
    with arithmetic.quiet(), pytest.raises(SingularMassMatrix):
        run(function, numbers, arithmetic)


def test_a_state_that_is_no_number_is_no_result():
    machine = machine_of("cart_2")
    function = compile.FUNCTIONS["accelerations"](machine)
    given = {"time": [0], "state": [0, 0.1, np.nan, 0, 0, 0], "inputs": [1], "parameters": [1] * 5}
    numbers = {k: [np.array(float(v)) for v in column] for k, column in given.items()}
    with NUMPY.quiet(), pytest.raises(SingularMassMatrix):
        run(function, numbers, NUMPY)


def test_a_pole_of_a_spherical_pendulum_is_a_singular_state():
    machine = compile.machine_of(model_of("spherical_pendulum"))
    function = compile.FUNCTIONS["accelerations"](machine)
    size = len(compile.program(machine).parameters)
    given = {"time": [0], "state": [0, 1, 0, 0], "inputs": [], "parameters": [1] * size}
    numbers = {k: [np.array(float(v)) for v in column] for k, column in given.items()}
    with NUMPY.quiet(), pytest.raises(SingularMassMatrix):
        run(function, numbers, NUMPY)


def test_a_mass_that_is_no_positive_number_is_refused_where_it_is_made():
    machine = machine_of("cart_1")
    tree, graph = machine.tree, machine.kinematics.algebra.number(0).graph
    bodies = [
        None if p.body is None else replace(p.body, mass=graph.number(-2)) for p in tree.places
    ]
    places = tuple(replace(p, body=body) for p, body in zip(tree.places, bodies, strict=True))
    heavy = replace(tree, places=places)
    with pytest.raises(SingularMassMatrix):
        rods.solve(machine.kinematics, heavy, loads.of(machine.kinematics, heavy))


def test_other_functions_are_those_of_the_recursion():
    machine = machine_of("branched")
    wanted = virtual_work.derive(machine.kinematics)
    pairs = [
        *zip(machine.bias, wanted.bias, strict=True),
        *zip(machine.generalized_forces, wanted.generalized_forces, strict=True),
    ]
    for values in precisely(machine, [node for pair in pairs for node in pair]):
        size = max(map(abs, values))
        assert (
            max(abs(a - b) for a, b in zip(values[::2], values[1::2], strict=True)) < 1e-45 * size
        )


def short_of(machine):
    return Short(machine.kinematics.algebra, Clock(machine.kinematics).constant_bits)


def test_a_factor_is_taken_out_of_a_vector():
    graph = machine_of("cart_2").kinematics.algebra.number(0).graph
    x, y, z = (graph.symbol(n) for n in ("x", "y", "z"))
    assert common_factor([x * y, -(x * z)]) == (x, (y, -z))
    assert common_factor([2 * x * y, graph.zero, 2 * x]) == (2 * x, (y, graph.zero, graph.one))
    assert common_factor([2 * x, 3 * x]) == (x, (2 * graph.one, 3 * graph.one))
    assert common_factor([x * x, x * x]) == (x * x, (graph.one, graph.one))


def test_a_constant_is_found_where_the_graph_does_not_fold():
    machine = machine_of("cart_2")
    algebra, short = machine.kinematics.algebra, short_of(machine)
    a, b = (algebra.of(s.symbol) for s in machine.model.coordinates[1:3])
    length = algebra.of(machine.model.parameters[-1].symbol)
    sine, cosine = (lambda x: algebra.apply("sin", x)), (lambda x: algebra.apply("cos", x))
    parts = [length * cosine(b) * sine(a), length * sine(b) * sine(a), length * cosine(a)]
    square = short.of(parts[0] * parts[0] + parts[1] * parts[1] + parts[2] * parts[2])
    assert square is length * length
    assert short.of(sine(a) * cosine(a) - cosine(a) * sine(a)) is short.zero
    wave = sine(a) * cosine(b) + cosine(a) * sine(b)
    assert short.of(wave) is wave  # not the sine of the sum: that would be one sine more
    assert sine(a + b) not in below([short.of(wave)])


def test_it_is_not_chance_that_decides(monkeypatch):
    """A square that varies by 1e-30 of itself is no constant."""
    text = SCENES["cart_1"].replace("-cos(q1)]", "-cos(q1) + q1/10^30]")
    assert by_rods(compile.machine_of(read(text, "nearly.yaml"))) is None


def test_the_system_is_tridiagonal_for_a_chain(monkeypatch):
    seen = []
    whole = ldl.factor

    def looking(rows, check):
        seen.append(
            [
                [i - k for k, e in enumerate(row) if e is not e.graph.zero]
                for i, row in enumerate(rows)
            ]
        )
        return whole(rows, check)

    monkeypatch.setattr(ldl, "factor", looking)
    by_rods(machine_of("cart_8"))
    assert seen == [[[0]] + [[1, 0]] * 7]
    assert engine.METHODS[RODS].least(machine_of("cart_8").tree) == 8
