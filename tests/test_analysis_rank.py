"""Degrees of freedom: the lecture's counts, redundancy, singular positions, displacements."""

import itertools
import math

import pytest
import sympy as sp
from linkages import (
    HOLONOMIC,
    LECTURE,
    RATES,
    R,
    bricard,
    degrees,
    dphi,
    dx,
    dy,
    four_bar,
    lecture,
    machine,
    radius,
    rolling,
    squeezer,
    x,
    y,
    z,
)

from eomgen.algebra.closed import to_sympy
from eomgen.analysis import admissible, elimination, linkage, rank, virtual
from eomgen.analysis.linkage import PRECISE
from eomgen.errors import UsageError

# row -> (n, rank of holonomic rows, rank of all rows)
COUNTS = {4: (2, 1, 1), 5: (3, 1, 1), 6: (6, 1, 1), 7: (3, 0, 0), 8: (3, 2, 2), 9: (3, 2, 2)}
COUNTS[10] = (4, 0, 2)


@pytest.mark.parametrize("row", LECTURE)
def test_the_lecture_counts(row) -> None:
    found = rank.freedom(lecture(row))
    assert (found.coordinates, found.rank_holonomic, found.rank) == COUNTS[row]
    assert found.warnings == ()
    assert len(found.basis.independent) == found.degrees_of_freedom
    assert found.states >= 5


def test_the_lecture_insists_on_both_numbers() -> None:
    found = rank.freedom(lecture(10))
    assert (found.degrees_of_freedom, found.minimal_coordinates) == (2, 4)
    assert rank.freedom(lecture(5)).degrees_of_freedom == 2
    assert rank.freedom(lecture(6)).degrees_of_freedom == 5


@pytest.mark.parametrize("row", [r for r in LECTURE if r != 7])
def test_basis_vectors_are_virtual_displacements(row) -> None:
    """J delta q = 0 at frozen time, and each vector moves its own independent coordinate only."""
    rows = linkage.of(lecture(row))
    states = [s.state for s in admissible.draw(lecture(row))]
    basis = virtual.basis(rows, states, range(len(rows.rows)))
    names = [c.name for c in rows.model.coordinates]
    for own, vector in zip(basis.independent, basis.vectors, strict=True):
        for entries in linkage.jacobian(rows, states[0]):
            assert abs(sum(a * b for a, b in zip(entries, vector, strict=True))) < 1e-40
        moved = dict(zip(names, vector, strict=True))
        assert [moved[n] for n in basis.independent] == [int(n == own) for n in basis.independent]


@pytest.mark.parametrize("row", [r for r in LECTURE if r != 7])
def test_formulas_of_the_basis_have_its_numbers(row) -> None:
    rows = linkage.of(lecture(row))
    states = [s.state for s in admissible.draw(lecture(row))]
    basis = virtual.basis(rows, states, range(len(rows.rows)))
    state, names = states[0], [c.name for c in rows.model.coordinates]
    values = dict(zip((c.symbol for c in rows.model.coordinates), state.coordinates, strict=True))
    values |= dict(zip((p.symbol for p in rows.model.parameters), state.parameters, strict=True))
    values[sp.Symbol("t", real=True)] = state.time
    coordinates = {c.name: c for c in rows.model.coordinates}
    deltas = [virtual.symbol(coordinates[n]) for n in basis.independent]
    assert basis.formulas
    for (name, form), (k, vector) in itertools.product(basis.formulas, enumerate(basis.vectors)):
        chosen = {d: sp.Integer(int(i == k)) for i, d in enumerate(deltas)}
        exact = {s: sp.Float(str(v), 50) for s, v in values.items()}
        found = to_sympy(form).subs({**chosen, **exact}).evalf(40)
        assert abs(float(found) - float(vector[names.index(name)])) < 1e-14


def test_free_coordinates_are_the_independent_ones() -> None:
    for name in ("x", "y", "z"):
        scene = machine("x y z", {"c": (HOLONOMIC, x + y**2 + sp.sin(z) - 1)}, free=name)
        other = rank.freedom(scene).basis
        assert name in other.independent
        assert len(other.independent) == 2


def test_redundant_rows_are_dropped_and_named() -> None:
    rows = {
        "c1": (HOLONOMIC, x + y - 1),
        "c2": (HOLONOMIC, y - z**2),
        "c3": (HOLONOMIC, x + 2 * y - z**2 - 1),
    }
    found = rank.freedom(machine("x y z", rows))
    assert found.degrees_of_freedom == 1
    assert found.dropped == ("c3",)
    assert found.warnings == (
        "W-RANK: constraint c3 depends on c1, c2 (rank 2 of 3); dropped. "
        "Reaction forces of c1, c2, c3 are not unique.",
    )


def test_only_the_rows_that_are_needed_are_named() -> None:
    rows = {"c1": (HOLONOMIC, x - y), "c2": (HOLONOMIC, z - y), "c3": (RATES, 2 * dx - 2 * dy)}
    (dependency,) = rank.freedom(machine("x y z", rows)).dependencies
    assert (dependency.row, dependency.on) == ("c3", ("c1",))


def test_a_rate_row_is_dropped_before_a_position_row() -> None:
    rows = {"rate": (RATES, dx - dy), "position": (HOLONOMIC, x - y)}
    assert rank.freedom(machine("x y", rows)).dropped == ("rate",)


def test_too_many_rows_are_an_error_that_names_them() -> None:
    rows = {n: (HOLONOMIC, r) for n, r in {"a": x - 1, "b": y, "c": x + y - 1}.items()}
    with pytest.raises(UsageError, match=r"3 constraints \(a, b, c\) hold 2 coordinates"):
        rank.freedom(machine("x y", rows))


def test_a_squared_row_binds_no_rate() -> None:
    with pytest.raises(UsageError, match="constraint c has no gradient"):
        rank.freedom(machine("x y", {"c": (HOLONOMIC, (x - y) ** 2)}, initial={"x": R(1, 2)}))


def test_a_driven_mechanism_has_no_freedom_and_is_no_error() -> None:
    scene = machine("x y", {"c": (HOLONOMIC, x - sp.Symbol("t", real=True)), "d": (HOLONOMIC, y)})
    assert rank.freedom(scene).degrees_of_freedom == 0


def test_the_parallelogram_is_singular_when_flat() -> None:
    scene = four_bar(1, 2, 1, 2, initial={"a": degrees(60)}, guess={"c": degrees(60)})
    found = rank.freedom(scene)
    assert found.degrees_of_freedom == 1
    places = [[round(v / math.pi, 5) % 2 for _, v in s.coordinates] for s in found.singularities]
    assert sorted(places) == [[0, 0, 0], [1, 0, 1]]
    assert found.warnings[0].startswith("W-SING: constraint loop.x loses rank near a = ")


@pytest.mark.parametrize("change", [R(1, 1000), -R(1, 1000)])
def test_nearly_a_parallelogram_is_not_singular(change) -> None:
    scene = four_bar(1, 2, 1 + change, 2, initial={"a": degrees(60)}, guess={"c": degrees(60)})
    assert rank.freedom(scene).singularities == ()


def test_a_singular_position_outside_the_range_is_not_reported() -> None:
    limits = {"a": (degrees(30), degrees(90))}
    known = {"initial": {"a": degrees(60)}, "guess": {"c": degrees(60)}}
    assert rank.freedom(four_bar(1, 2, 1, 2, range=limits, **known)).singularities == ()
    limits = {"a": (degrees(-30), degrees(90))}
    (found,) = rank.freedom(four_bar(1, 2, 1, 2, range=limits, **known)).singularities
    assert [abs(v) < 1e-5 for _, v in found.coordinates] == [True] * 3


def test_hidden_relations_lower_the_number_of_coordinates() -> None:
    scene = machine("x phi", {"rolling": (RATES, dx - radius * dphi)}, {"R": 1})
    found = rank.freedom(scene, hidden=1)
    assert (found.degrees_of_freedom, found.minimal_coordinates) == (1, 1)


def test_dependence_survives_fifty_digits_of_conditioning() -> None:
    """A row that differs by 1e-20 is independent, one by 1e-40 is not."""
    near, nearer = (
        [[PRECISE.number(v) for v in row] for row in ([1, 2], [2, 4 + PRECISE.number(10) ** -k])]
        for k in (20, 40)
    )
    assert elimination.rank(near) == 2
    assert elimination.dependencies(near) == {}
    assert elimination.rank(nearer) == 1
    assert elimination.dependencies(nearer) == {1: (0,)}


def test_rank_and_dependence_agree_on_random_matrices() -> None:
    import random

    chance = random.Random(5)
    for _ in range(40):
        rows, columns, true = (chance.randint(1, 5) for _ in range(3))
        left = [[chance.randint(-3, 3) for _ in range(true)] for _ in range(rows)]
        right = [[chance.randint(-3, 3) for _ in range(columns)] for _ in range(true)]
        product = [
            [
                sum(a * b for a, b in zip(row, column, strict=True))
                for column in zip(*right, strict=True)
            ]
            for row in left
        ]
        matrix = [[PRECISE.number(v) for v in row] for row in product]
        exact = sp.Matrix(product).rank()
        assert elimination.rank(matrix) == exact
        assert len(matrix) - len(elimination.dependencies(matrix)) == exact


def test_solved_is_a_solution() -> None:
    matrix = [[PRECISE.number(v) for v in row] for row in ([0, 2, 1], [3, 0, 1], [1, 1, 0])]
    right = [[PRECISE.number(v)] for v in (1, 2, 3)]
    found = elimination.solved(matrix, right)
    for row, (b,) in zip(matrix, right, strict=True):
        assert abs(sum(a * v for a, (v,) in zip(row, found, strict=True)) - b) < 1e-45
    with pytest.raises(ZeroDivisionError):
        elimination.solved([matrix[0], matrix[0]], right[:2])


def test_rolling_leaves_heading_and_spin() -> None:
    scene = machine("x y theta phi", {"r": (RATES, *rolling)}, {"R": 1}, free="theta phi")
    assert rank.freedom(scene).basis.independent == ("theta", "phi")


def test_bricards_mechanism_moves_because_a_row_is_redundant() -> None:
    found = rank.freedom(bricard())
    assert (found.coordinates, len(found.rows), found.rank) == (6, 6, 5)
    assert found.degrees_of_freedom == 1
    assert found.dropped == ("c6",)
    # positions that satisfy the other five rows only are no singular positions of the mechanism
    (warning,) = found.warnings
    assert warning.startswith("W-RANK: constraint c6 depends on c1, ")


def test_the_squeezer_has_one_degree_of_freedom() -> None:
    found = rank.freedom(squeezer())
    assert (found.rank, found.degrees_of_freedom, found.dropped) == (6, 1, ())
    assert found.basis.independent == ("Theta",)


def test_a_row_that_depends_at_one_state_only_is_kept() -> None:
    one, two = (
        [[PRECISE.number(v) for v in row] for row in rows]
        for rows in ([[1, 0], [0, 1]], [[1, 0], [1, 0]])
    )
    assert rank.dependencies([two, one, two]) == {}
    assert rank.dependencies([two, two]) == {1: (0,)}
