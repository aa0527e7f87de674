import random
from fractions import Fraction

import pytest

from eomgen.algebra import ldl
from eomgen.algebra.arithmetic import EXACT, FLOAT, evaluate
from eomgen.algebra.graph import Graph
from eomgen.algebra.walk import below


def random_spd(size, seed):
    """B B' + 1 of a random B, exact."""
    source = random.Random(seed)
    b = [
        [Fraction(source.randint(-5, 5), source.randint(1, 4)) for _ in range(size)]
        for _ in range(size)
    ]
    return [
        [sum(b[i][k] * b[j][k] for k in range(size)) + (i == j) for j in range(size)]
        for i in range(size)
    ]


def leaves_of(graph, size):
    entries = {
        (i, j): graph.read("parameters", i * size + j) for i in range(size) for j in range(i + 1)
    }
    return [[entries[max(i, j), min(i, j)] for j in range(size)] for i in range(size)]


@pytest.mark.parametrize("size", range(1, 7))
@pytest.mark.parametrize("solve", ["unrolled", "loop"])
def test_solutions_are_exact(size, solve):
    graph = Graph()
    matrix = leaves_of(graph, size)
    right = [graph.read("inputs", i) for i in range(size)]
    if solve == "loop":
        (x,), pivots = ldl.solve_in_loop(matrix, right), ()
    else:
        (x, _), pivots = ldl.solve(matrix, right, right[::-1])
        assert len(pivots) == size
    numbers = random_spd(size, size)
    b = [Fraction(i * i - 3, 7) for i in range(size)]
    values = dict(zip(right, b, strict=True))
    values |= {matrix[i][j]: numbers[i][j] for i in range(size) for j in range(i + 1)}
    solution = evaluate(x, values, EXACT)
    assert [sum(a * s for a, s in zip(row, solution, strict=True)) for row in numbers] == b
    diagonal = [numbers[i][i] for i in reversed(range(size))]
    found = evaluate([node for pair in pivots for node in pair], values, EXACT)
    assert found[1::2] == diagonal[: len(pivots)]
    assert all(pivot > 0 for pivot in found[::2])


def test_several_right_hand_sides_share_the_factors():
    graph = Graph()
    matrix = leaves_of(graph, 5)
    rights = [[graph.read("inputs", 5 * k + i) for i in range(5)] for k in range(2)]
    ldl.solve(matrix, rights[0])
    before = len(graph.nodes)
    ldl.solve(matrix, *rights)
    # a solve alone: 20 products and differences, 5 scalings; no reciprocal is made again
    assert len(graph.nodes) - before <= 45


PARENTS = [-1, 0, 1, 1, 0, 4, 4, 2]  # a tree, numbered from root to leaf


def ancestors(row):
    return [] if row < 0 else [row, *ancestors(PARENTS[row])]


def test_nothing_fills_in_on_a_tree():
    graph = Graph()
    size = len(PARENTS)
    full = leaves_of(graph, size)
    matrix = [
        [full[i][j] if min(i, j) in ancestors(max(i, j)) else graph.zero for j in range(size)]
        for i in range(size)
    ]
    factors = ldl.factor(matrix, lambda row, pivot, scale: None)
    for i, row in enumerate(factors.lower):
        for j, entry in enumerate(row):
            assert (entry is graph.zero) == (j not in ancestors(i))
    made = below([a for row in factors.lower for a in row] + list(factors.reciprocals))
    # eliminating row k with d ancestors: d scalings and d (d + 1) / 2 multiply-subtracts
    depths = [len(ancestors(row)) - 1 for row in range(size)]
    counts = [sum(a.operator == name for a in made) for name in ("divide", "subtract")]
    assert counts == [size, sum(d * (d + 1) // 2 for d in depths)]
    assert sum(a.operator == "multiply" for a in made) == sum(d * (d + 3) // 2 for d in depths)


def test_a_pivot_that_is_zero_as_it_stands_is_refused():
    graph = Graph()
    m = graph.read("parameters", 0)
    with pytest.raises(ldl.SingularMassMatrix, match="its pivot in row 1 is 0, not positive"):
        ldl.solve([[m, m], [m, m]], [m, m])
    with pytest.raises(ldl.SingularMassMatrix, match="row 2"):
        ldl.solve([[m, graph.zero], [graph.zero, graph.zero]], [m, m])


def test_numeric_pivots_need_no_check():
    graph = Graph()
    two = graph.number(2)
    (x,), pivots = ldl.solve([[two, graph.one], [graph.one, two]], [graph.one, graph.zero])
    assert x == [graph.number(Fraction(2, 3)), graph.number(Fraction(-1, 3))]
    assert pivots == ()


def test_the_loop_refuses_a_singular_matrix():
    graph = Graph()
    a, b = graph.read("state", 0), graph.read("state", 1)
    (x,) = ldl.solve_in_loop([[a, b], [b, a]], [a, b])
    assert evaluate(x, {a: 2.0, b: 1.0}, FLOAT) == [1.0, 0.0]
    with pytest.raises(ldl.SingularMassMatrix, match="row 1"):
        evaluate(x, {a: 2.0, b: 2.0}, FLOAT)
    with pytest.raises(ldl.SingularMassMatrix, match="row 2"):
        evaluate(x, {a: float("nan"), b: 2.0}, FLOAT)
    assert ldl.solve_in_loop([], []) == [[]]


def test_the_loop_solves_for_several_right_hand_sides_at_once():
    graph = Graph()
    matrix = leaves_of(graph, 4)
    rights = [[graph.read("inputs", 4 * k + i) for i in range(4)] for k in range(3)]
    together, numbers = ldl.solve_in_loop(matrix, *rights), random_spd(4, 9)
    values = {a: Fraction(3 * i - 10, 7) for i, a in enumerate(sum(rights, []))}
    values |= {matrix[i][j]: numbers[i][j] for i in range(4) for j in range(i + 1)}
    alone = [ldl.solve_in_loop(matrix, right)[0] for right in rights]
    assert [evaluate(x, values, EXACT) for x in together] == [
        evaluate(x, values, EXACT) for x in alone
    ]
    assert len({node.operands[0] for x in together for node in x}) == 1
