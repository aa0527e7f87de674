"""Identities that every scene obeys, and the textbook results that the specs claim."""

import json
from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
import sympy as sp
from scenes import (
    EXTRA,
    FILES,
    FREE,
    LINKED,
    SHIPPED,
    admissible_of,
    derivation_of,
    each,
    machine_of,
    model_of,
    program_of,
    samples_of,
    study_of,
    text_of,
)
from scipy.integrate import solve_ivp

from eomgen import evaluate_linked, interpreter, states
from eomgen.algebra import ldl, normal
from eomgen.algebra.arithmetic import evaluate, mpmath_arithmetic
from eomgen.algebra.assemble import assemble
from eomgen.checks import agreement, dimensions, expectations, power
from eomgen.checks.evaluation import singly
from eomgen.errors import CheckError
from eomgen.evaluate import speeds_of
from eomgen.interpreter import FLOAT, NUMPY
from eomgen.mechanics import speeds
from eomgen.mechanics.vectors import compose, cross, subtract, transform, transpose
from eomgen.model import TIME, Claim

HALF = Fraction(1, 2)
MPMATH = mpmath_arithmetic(50)
every = each(FILES)  # as if nothing were linked, where it makes sense
unlinked = pytest.mark.parametrize("name", [*FREE, *EXTRA])
linked = each(LINKED)

# T is a quadratic form of the rates only where nothing moves by itself
DRIVEN = {
    "bead_on_hoop", "foucault_pendulum", "kapitza_pendulum", "rotating_table", "two_link_arm",
    "watt_governor", "drifting_speeds", "energies_only", "spatial_tree",
}  # fmt: skip
WITH_SPEEDS = {n for n in FILES if model_of(n).speeds}
MASSLESS = {"massless_coupler"}  # its loop decides what has no inertia
scleronomic = pytest.mark.parametrize("name", [n for n in FILES if n not in DRIVEN | WITH_SPEEDS])


def numbers(name, nodes):
    """Values of graph nodes at the samples: (len(nodes), count)."""
    drawn = samples_of(name)
    states = singly(machine_of(name), drawn, FLOAT, drawn.count)
    return np.array([at.nodes(nodes) for at, _ in states], float).T


def matrices(name, rows):
    """Values of a matrix of nodes at the samples: (count, rows, columns)."""
    flat = numbers(name, [entry for row in rows for entry in row])
    return np.moveaxis(flat.reshape(len(rows), len(rows[0]), -1), -1, 0)


# --- the specs as pages


@pytest.mark.parametrize("name", FREE)
def test_a_shipped_spec_is_complete(name):
    model = model_of(name)
    assert text_of(name).splitlines()[0] == ("# yaml-language-server: $schema=./eomgen.schema.json")
    assert list(model.title) == ["en", "es"]
    assert model.with_units
    assert all(p.value is not None or p.formula is not None for p in model.parameters)
    state = [s.name for c in model.coordinates for s in (c.symbol, c.rate)]
    assert sorted(model.initial) == sorted(state)
    assert model.expect.dof == len(speeds.symbols(model))


# --- two derivations, one motion


@every
def test_both_derivations_agree(name):
    found = agreement.compare(derivation_of(name), machine_of(name), samples_of(name))
    assert found.error < 1e-11
    assert found.states == samples_of(name).count


@unlinked
def test_power_in_is_the_rate_of_the_energy(name):
    assert power.balance(machine_of(name), samples_of(name)) < 1e-11


@linked
def test_power_in_and_that_of_the_constraints_is_the_rate_of_the_energy(name):
    """An identity of M q'' + h = Q + J' lambda: it holds off the constraints too."""
    for drawn in (samples_of(name), admissible_of(name)):
        assert power.balance(study_of(name).machine, drawn) < 1e-11


@unlinked
def test_the_claims_of_the_spec_hold(name):
    claimed = expectations.check(machine_of(name), samples_of(name))
    assert claimed == expectations.count(machine_of(name)) > 0


@linked
def test_the_claims_of_a_linked_spec_hold(name):
    found = study_of(name)
    claimed = expectations.check(found.machine, admissible_of(name), found.freedom)
    assert claimed == expectations.count(found.machine) > 0


@every
def test_terms_of_the_derived_equations_have_one_dimension(name):
    assert (dimensions.check(derivation_of(name)) > 0) == model_of(name).with_units


def falsified(claim, model):
    """The claim with the last of its terms that move doubled; of a linked scene, plus one.

    There a claim may be that each of its terms is zero.
    """
    moving = {s for c in model.coordinates for s in (c.symbol, c.rate, c.acceleration)}
    moving |= {s for speed in model.speeds for s in (speed.symbol, speed.rate)}
    terms = [t for t in expectations.summands(claim.residual) if t.free_symbols & moving]
    return Claim(claim.residual + terms[-1] + int(bool(model.constraints)), claim.text)


def grown(claim, model):
    """The claim times the time, which nothing constant but zero survives."""
    return Claim(claim.residual * (1 + TIME), claim.text)


def displaced(position, model):
    return {name: value + sp.Rational(1, 10) for name, value in position.items()}


WRONG = {
    "equations": falsified,
    "conserved": grown,
    "equilibria": displaced,
    "kinetic": falsified,
    "potential": falsified,
}


def wrong_expectations(model):
    """The expectation with one claim made false, once for each claim."""
    expect = model.expect
    yield replace(expect, dof=expect.dof + 1)
    for key, change in WRONG.items():
        claims = getattr(expect, key)
        if isinstance(claims, Claim):
            yield replace(expect, **{key: change(claims, model)})
            continue
        for i, claim in enumerate(claims or ()):
            changed = (*claims[:i], change(claim, model), *claims[i + 1 :])
            yield replace(expect, **{key: changed})


def claiming(machine, expect):
    """The machine with other claims."""
    model = replace(machine.model, expect=expect)
    return replace(machine, kinematics=replace(machine.kinematics, model=model))


@pytest.mark.parametrize("name", FREE)
def test_every_claim_is_refused_when_it_is_made_false(name):
    machine = machine_of(name)
    for wrong in wrong_expectations(machine.model):
        with pytest.raises(CheckError, match="^expect: "):
            expectations.check(claiming(machine, wrong), samples_of(name))


@linked
def test_every_claim_of_a_linked_spec_is_refused_when_it_is_made_false(name):
    found = study_of(name)
    for wrong in wrong_expectations(found.model):
        with pytest.raises(CheckError, match="^expect: "):
            expectations.check(claiming(found.machine, wrong), admissible_of(name), found.freedom)


# --- the mass matrix


@each([n for n in FILES if n not in MASSLESS])
def test_mass_matrix_is_positive_definite(name):
    found = matrices(name, machine_of(name).equations.mass_matrix)
    size = np.sqrt(np.einsum("nii->ni", found))
    scaled = found / size[:, :, None] / size[:, None, :]
    assert np.linalg.eigvalsh(scaled).min() > 1e-6


@every
def test_mass_matrix_in_closed_form_is_symmetric(name):
    matrix = derivation_of(name).matrix.mass_matrix
    for i, row in enumerate(matrix):
        for j in range(i):
            assert normal.is_zero(row[j] - matrix[j][i])


@scleronomic
def test_kinetic_energy_is_half_the_quadratic_form_of_the_mass_matrix(name):
    machine = machine_of(name)
    (kinetic,) = numbers(name, machine.energy[:1])
    rates = numbers(name, machine.rates)
    found = matrices(name, machine.equations.mass_matrix)
    assert np.einsum("in,nij,jn->n", rates, found, rates) / 2 == pytest.approx(kinetic, rel=1e-11)


def christoffel(machine):
    """C_ij = 1/2 sum_k (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) q'_k, as graph nodes."""
    algebra, matrix = machine.kinematics.algebra, machine.equations.mass_matrix
    one, coordinates = algebra.number(1), machine.model.coordinates
    size = range(len(coordinates))
    slope = [
        [[algebra.along(matrix[i][j], {c.symbol: one}) for c in coordinates] for j in size]
        for i in size
    ]
    return [
        [
            sum((slope[i][j][k] + slope[i][k][j] - slope[j][k][i]) * machine.rates[k] for k in size)
            * HALF
            for j in size
        ]
        for i in size
    ]


@scleronomic
def test_bias_is_christoffel_times_the_rates_and_mdot_minus_2c_is_skew(name):
    machine = machine_of(name)
    c = matrices(name, christoffel(machine))
    rate = machine.kinematics.rate
    mdot = matrices(name, [[rate(e) for e in row] for row in machine.equations.mass_matrix])
    rates, bias = numbers(name, machine.rates), numbers(name, machine.equations.bias)
    terms = np.einsum("nij,jn->nij", c, rates)
    size = np.abs(matrices(name, machine.equations.mass_matrix)).max() * np.abs(rates).max() ** 2
    assert np.abs(terms.sum(axis=2) - bias.T).max() < 1e-13 * size
    skew = mdot - 2 * c
    assert np.abs(skew + skew.transpose(0, 2, 1)).max() < 1e-13 * size


# --- forward and inverse dynamics


@unlinked
def test_inverse_after_forward_dynamics_gives_the_applied_forces(name):
    """M u' + h = Q with the u' of the program, through its own interpreter."""
    program, arguments = program_of(name), samples_of(name).arguments()
    arguments = {k: [np.array(v) for v in columns] for k, columns in arguments.items()}
    count, n = samples_of(name).count, len(program.speeds)

    def run(function):
        found = interpreter.run(program.function(function), arguments, NUMPY)
        return np.array([np.broadcast_to(v, count) for v in found])

    matrix = run("mass_matrix").reshape(n, n, count)
    terms = matrix * run("accelerations")
    bias, forces = run("bias"), run("generalized_forces")
    size = np.abs(terms).sum(axis=1) + np.abs(bias) + np.abs(forces)
    assert np.abs(terms.sum(axis=1) + bias - forces).max() / size.max() < 1e-11


@pytest.mark.parametrize("name", [n for n in FILES if n not in {"long_chain", *MASSLESS}])
def test_forward_after_inverse_dynamics_is_the_identity(name):
    """The solution of M x = M a is a, in 50 digits."""
    machine = machine_of(name)
    matrix, graph = machine.equations.mass_matrix, machine.kinematics.algebra.graph
    wanted = [graph.symbol(f"a{i}") for i in range(len(matrix))]
    (solution,), _ = ldl.solve(matrix, transform(matrix, wanted))
    for at, accelerations in singly(machine, samples_of(name), MPMATH, 3):
        given = [MPMATH.number(a) for a in accelerations]
        leaves = at.leaves | dict(zip(wanted, given, strict=True))
        found = evaluate(solution, leaves, MPMATH)
        assert max(abs(a - b) for a, b in zip(found, given, strict=True)) < 1e-40


# --- what is conserved


@cache
def initial_state(name):
    model = evaluate_linked.consistent(study_of(name).links) if name in LINKED else model_of(name)
    given = {"inputs": {i.name: "0.3" for i in model.inputs}, **OTHER_START.get(name, {})}
    (state,) = states.read(json.dumps(given), model, needs_time=False)
    return state, [float(v) for v in (*state.coordinates, *speeds_of(state, model))]


# [s]; 2 s for what neither spins nor is stiff nor comes to a singular position
DURATION = {
    "heavy_top": 0.2,
    "gyroscope": 0.1,
    "flyball_governor": 0.01,
    "parallelogram": 0.2,
    "slider_crank_equal": 0.2,
}
OTHER_START = {"mass_leaving_sphere": {"rates": {"y": "0.3"}}}  # the spec's moves in a plane


def along(name, function, t, y):
    """Results of a function at one state of the motion."""
    given, _ = initial_state(name)
    arguments = {"time": [t], "state": list(y), "inputs": [float(v) for v in given.inputs]}
    arguments["parameters"] = [float(v) for v in given.parameters]
    return interpreter.run(function, arguments, FLOAT)


@cache
def motion(name):
    """The motion from the initial state: (times, states)."""
    wanted = "multiplier" if name in LINKED else "auto"
    derivative = program_of(name, wanted).function("state_derivative")
    path = solve_ivp(
        lambda t, y: along(name, derivative, t, y),
        (0, DURATION.get(name, 2.0)),
        initial_state(name)[1],
        method="DOP853",
        rtol=1e-11,
        atol=1e-12,
    )
    assert path.success
    assert np.ptp(path.y, axis=1).max() > 1e-3  # it does move
    return path.t, path.y.T


def history(name, nodes):
    """Values of graph nodes on the motion: (len(nodes), steps)."""
    function = assemble("history", "", (len(nodes),), nodes)
    return np.array([along(name, function, t, y) for t, y in zip(*motion(name), strict=True)]).T


@pytest.mark.parametrize("name", [n for n in SHIPPED if model_of(n).expect.conserved])
def test_what_the_textbook_calls_conserved_stays_constant_on_the_motion(name):
    machine = machine_of(name)
    for claim in machine.model.expect.conserved:
        terms = [machine.kinematics.algebra.of(t) for t in expectations.summands(claim.residual)]
        found = history(name, terms)
        size = np.abs(found).sum(axis=0).max()
        assert np.ptp(found.sum(axis=0)) < 1e-8 * size, claim.text


CYCLIC = {
    "slider_pendulum_free": {"s"},
    "spherical_pendulum": {"phi"},
    "central_force": {"phi"},
    "heavy_top": {"phi", "psi"},
    "gyroscope": {"psi"},  # the torque inside does not act on it
    "particle_cartesian": set(),
    "disc_pendulum": set(),
}


@pytest.mark.parametrize("name", CYCLIC)
def test_momentum_of_a_cyclic_coordinate_is_constant(name):
    """DL/dq = 0 and Q = 0 exactly; dL/dq' does not change on the motion."""
    machine, rows = machine_of(name), derivation_of(name).rows
    free = {r.name for r in rows if not (r.slope.terms or r.force.terms or r.dissipation.terms)}
    assert free == CYCLIC[name]
    algebra = machine.kinematics.algebra
    rates = [c.rate for c in machine.model.coordinates if c.name in free]
    momenta = [algebra.along(machine.energy[0], {r: algebra.number(1)}) for r in rates]
    if momenta:
        found = history(name, momenta)
        assert (np.ptp(found, axis=1) < 1e-9 * np.abs(found).max()).all()


# --- kinematics against finite differences

STEP = MPMATH.number(10) ** -12  # the error of a central difference is of order 1e-24


def moved(machine, at, step):
    """The leaves a short time later on the motion with these speeds."""
    algebra = machine.kinematics.algebra
    leaves = dict(at.leaves)
    leaves[algebra.of(TIME)] += step
    for coordinate, rate in zip(machine.model.coordinates, at.nodes(machine.rates), strict=True):
        leaves[algebra.of(coordinate.symbol)] += step * rate
    return leaves


def differences(machine, at, nodes):
    """Time derivatives of nodes that depend on time and coordinates."""
    before, after = (evaluate(nodes, moved(machine, at, step), MPMATH) for step in (-STEP, STEP))
    return [(b - a) / (2 * STEP) for a, b in zip(before, after, strict=True)]


def assert_derivatives(name, values, rates):
    """The second nodes are the time derivatives of the first."""
    for at, _ in singly(machine_of(name), samples_of(name), MPMATH, 3):
        found, stated = differences(machine_of(name), at, values), at.nodes(rates)
        scale = 1 + max(abs(v) for v in stated)
        assert max(abs(a - b) for a, b in zip(found, stated, strict=True)) / scale < 1e-15


with_places = pytest.mark.parametrize("name", [n for n in FILES if model_of(n).bodies])


@with_places
def test_velocity_is_the_derivative_of_position(name):
    kinematics = machine_of(name).kinematics
    places = [p.name for p in kinematics.model.points] + [b.name for b in kinematics.model.bodies]
    positions = [c for place in places for c in kinematics.position(place)]
    assert_derivatives(name, positions, [c for p in places for c in kinematics.velocity(p)])


TURNING = [n for n in FILES if any(b.frame.turns for b in model_of(n).bodies)]
turning = pytest.mark.parametrize("name", TURNING)


def tilde(w, zero):
    """[w x], the matrix whose product with r is w x r; in the plane for the one component."""
    if len(w) == 1:
        return ((zero, -w[0]), (w[0], zero))
    return ((zero, -w[2], w[1]), (w[2], zero, -w[0]), (-w[1], w[0], zero))


@turning
def test_angular_velocity_is_vee_of_the_rotation_and_its_derivative(name):
    """R' = R [w x], with w in body axes."""
    kinematics = machine_of(name).kinematics
    zero = kinematics.algebra.number(0)
    axes, rates = [], []
    for body in kinematics.model.bodies:
        if body.frame.turns:
            rotation = kinematics.axes(body.name)
            spin = tilde(kinematics.angular_velocity(body.name), zero)
            axes += [e for row in rotation for e in row]
            rates += [e for row in compose(rotation, spin) for e in row]
    assert_derivatives(name, axes, rates)


@turning
def test_axes_are_orthonormal(name):
    kinematics = machine_of(name).kinematics
    for body in kinematics.model.bodies:
        rotation = kinematics.axes(body.name)
        found = matrices(name, compose(transpose(rotation), rotation))
        assert np.abs(found - np.eye(len(rotation))).max() < 1e-14
        assert np.linalg.det(matrices(name, rotation)) == pytest.approx(1)


def test_a_rod_in_space_turns_without_spin():
    """D' = w x d for d along the rod, and w . d = 0."""
    kinematics = machine_of("spatial_rod").kinematics
    along = subtract(kinematics.position("B"), kinematics.position("A"))
    moving = subtract(kinematics.velocity("B"), kinematics.velocity("A"))
    spin = kinematics.angular_velocity("rod")
    crossed = cross(spin, along)
    d, change, w, turned = (numbers("spatial_rod", v) for v in (along, moving, spin, crossed))
    assert turned == pytest.approx(change, abs=1e-13)
    assert (w * d).sum(axis=0) == pytest.approx(0, abs=1e-13)


# --- two ways to say the same


def test_a_spring_by_law_is_the_spring_by_energy():
    by_law, by_energy = (
        derivation_of(n).matrix for n in ("duffing_oscillator", "duffing_by_energy")
    )
    assert by_law.bias == by_energy.bias
    assert by_law.mass_matrix == by_energy.mass_matrix
    assert by_law.generalized_forces == by_energy.generalized_forces


def test_the_extra_scenes_reach_what_the_specs_leave_out():
    assert len(model_of("long_chain").coordinates) > 12
    assert not model_of("unitless").with_units
    assert set(speeds.names(model_of("drifting_speeds"))) == {"u", "v", "r"}
    assert EXTRA.keys().isdisjoint(SHIPPED)
