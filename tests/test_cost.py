"""What values cost: operations, each shared one once, and the longest chain among them."""

from functools import reduce

from eomgen.algebra import cost, ldl
from eomgen.algebra.elementary import function
from eomgen.algebra.graph import Graph

sin, cos = function("sin"), function("cos")


def leaves(count):
    graph = Graph()
    return [graph.symbol(f"x{i}") for i in range(count)]


def test_a_sum_in_a_row_and_as_a_tree_cost_the_same_but_wait_differently():
    x = leaves(8)
    row = reduce(lambda a, b: a + b, x)
    tree = ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]))
    assert cost.of([row]) == cost.Cost(7, 28)
    assert cost.of([tree]) == cost.Cost(7, 12)
    assert cost.of([tree]).total < cost.of([row]).total


def test_what_is_shared_counts_once():
    x, y = leaves(2)
    product = x * y
    assert cost.operations([product + x, product - y]) == 3


def test_what_is_prepared_costs_nothing_and_is_there_at_once():
    x, p = leaves(2)
    value = (1 / (p * p)) * x
    assert cost.of([value], p.leaves) == cost.Cost(1, 4)
    assert cost.of([value]) == cost.Cost(5 + 1 + 1, 4 + 13 + 4)
    assert cost.of([p * p], p.leaves) == cost.Cost(0, 0)


def test_a_sine_with_its_cosine_is_one_pair_and_all_wait_for_it_alike():
    (x,) = leaves(1)
    assert cost.of([sin(x) * cos(x)]) == cost.Cost(21, 4)


def test_a_sign_costs_nothing():
    x, y = leaves(2)
    assert cost.of([-(x * y)]) == cost.of([x * y])


def test_a_system_in_a_loop_counts_its_size_and_its_right_sides():
    graph = Graph()
    matrix = [[graph.symbol(f"a{i}{k}") for k in range(4)] for i in range(4)]
    rights = [[graph.symbol(f"b{c}{i}") for i in range(4)] for c in range(3)]
    found = ldl.solve_in_loop(matrix, *rights)
    assert cost.operations([v for column in found for v in column]) == 4**3 // 3 + 2 * 4**2 * 3
    single = ldl.solve_in_loop(matrix, rights[0])
    assert cost.of(single[0]) == cost.Cost(4**3 // 3 + 2 * 4**2, 4 * (13 + 16))


def test_every_operator_of_the_language_has_a_weight_and_a_latency():
    assert cost.WEIGHTS.keys() == cost.CYCLES.keys()
