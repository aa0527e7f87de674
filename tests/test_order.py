"""The order of values: each after what it is made of, those that all others wait for first."""

import random

from hung import cart

from eomgen import compile
from eomgen.algebra.elementary import function
from eomgen.algebra.graph import Graph
from eomgen.algebra.order import by_critical_path
from eomgen.algebra.walk import below
from eomgen.spec import read

sin, cos = function("sin"), function("cos")


def is_ordered(nodes, given=()):
    seen = set(given)
    for node in nodes:
        if node not in seen and not set(node.operands) <= seen:
            return False
        seen.add(node)
    return True


def chain(graph, count):
    """A value that waits for all sines, the first sine last."""
    x = [graph.symbol(f"x{i}") for i in range(count)]
    waves = [sin(a) for a in x]
    total = waves[-1]
    for wave in reversed(waves[:-1]):
        total = (total * total + wave) / wave
    return total, waves


def test_a_chain_starts_with_what_it_waits_for_first():
    graph = Graph()
    total, waves = chain(graph, 8)
    nodes = below([total])
    order = by_critical_path(nodes, ())
    assert sorted(n.id for n in order) == [n.id for n in nodes]
    assert is_ordered(order)
    assert [n for n in order if n.operator == "sin"] == waves[::-1]
    # and does not compute all sines before the chain begins
    assert order.index(total.operands[0]) > order.index(waves[0])
    assert next(i for i, n in enumerate(order) if n.operator == "divide") < order.index(waves[0])


def test_what_never_waits_keeps_its_order():
    graph = Graph()
    x = [graph.symbol(f"x{i}") for i in range(40)]
    nodes = below([a * b + a for a in x for b in x])
    assert by_critical_path(nodes, ()) == nodes


def test_what_is_given_is_not_waited_for():
    graph = Graph()
    total, waves = chain(graph, 4)
    (half,) = (a for a in total.operands[0].operands if a.operator == "multiply")
    nodes = below([total], lambda n: n is half)
    order = by_critical_path(nodes, {half})
    assert is_ordered(order, {half})
    assert waves[-1] not in order


def test_random_graphs_stay_in_an_order_that_can_be_computed_and_it_is_always_the_same():
    for seed in range(20):
        chance, graph = random.Random(seed), Graph()
        values = [graph.symbol(f"x{i}") for i in range(5)]
        for _ in range(60):
            a, b = chance.choice(values[-8:]), chance.choice(values)
            values.append(chance.choice([a + b, a * b, a - 2 * b, sin(a), cos(b), a / (b * b + 1)]))
        nodes = below(values)
        order = by_critical_path(nodes, ())
        assert is_ordered(order)
        assert len(order) == len(nodes)
        assert order == by_critical_path(nodes, ())


def test_code_of_a_cart_begins_with_its_last_pendulum():
    machine = compile.machine_of(read(cart(8), "cart.yaml"))
    statements = str(compile.FUNCTIONS["accelerations"](machine).statements)
    waves = [
        statements.index(f"operator='sin', operands=(Read(argument='state', index={i})")
        for i in range(1, 9)
    ]
    assert waves[:6] == sorted(waves[:6], reverse=True)  # the last two are needed at once
    assert max(waves[6:]) < waves[5]
    assert statements.index("'divide'") < waves[0]
