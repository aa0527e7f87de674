"""Expressions that the tests of the graph, the assembler and the interpreter share."""

import operator
import random
from functools import reduce

from eomgen.algebra import elementary as g
from eomgen.algebra.graph import Graph, Node
from eomgen.program import OPERATORS

# one expression for each operator on two leaves; the leaves are in (0.2, 0.8)
OPERANDS = {1: lambda x, y: (x * y - y / 7,), 2: lambda x, y: (x * x - y / 5, y + x / 3)}


def example(name: str, x: Node, y: Node) -> Node:
    if name == "pi":
        return x.graph.pi() * x / 4
    if name in ("sqrt", "log", "power"):  # these need a positive operand
        x, y = x + 2, y + 2
    return g.BUILD[name](*OPERANDS[OPERATORS[name]](x, y))


def coverage(x: Node, y: Node) -> Node:
    """One expression that uses every operator of the program."""
    graph = x.graph
    terms = [graph.number(k + 1) * example(name, x, y) for k, name in enumerate(OPERATORS)]
    return reduce(operator.add, [*terms, g.exp(-(x * y)), (-x) / (y + 3) * (-y - x)])


def uniform(seed: int, count: int = 1) -> list[list[float]]:
    source = random.Random(seed)
    return [[source.uniform(0.2, 0.8), source.uniform(0.2, 0.8)] for _ in range(count)]


def state_leaves() -> tuple[Graph, Node, Node]:
    graph = Graph()
    return graph, graph.read("state", 0), graph.read("state", 1)
