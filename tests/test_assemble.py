import random
from collections import Counter
from fractions import Fraction

import pytest
from graph_cases import coverage, state_leaves

from eomgen import interpreter
from eomgen.algebra import elementary as g
from eomgen.algebra import ldl
from eomgen.algebra.arithmetic import EXACT, FLOAT, evaluate
from eomgen.algebra.assemble import LARGEST_EXPRESSION, assemble
from eomgen.algebra.graph import Graph
from eomgen.program import (
    OPERATORS,
    Apply,
    Assign,
    Number,
    Read,
    RequirePositive,
    Solve,
    Value,
)


def one(*results, pivots=()):
    return assemble("f", "a test", (len(results),), results, pivots)


def expressions(function):
    """All expressions, with their parts."""
    found = []
    for statement in function.statements:
        match statement:
            case Assign(_, expression) | RequirePositive(_, expression):
                found.append(expression)
            case Solve(_, matrix, right):
                found += [*matrix, *right]
    return found + list(function.results)


def parts(expression):
    inner = expression.operands if isinstance(expression, Apply) else ()
    return [expression, *(p for operand in inner for p in parts(operand))]


def operators(expression):
    return sum(isinstance(p, Apply) and p.operator != "pi" for p in parts(expression))


def spatial_chain(graph, joints):
    """Recursive sums and products of rotations: an expression as deep and shared as an arm's."""
    entries = [graph.read("state", i) for i in range(2 * joints)]
    force = [graph.read("parameters", i) for i in range(3)]
    v = [graph.zero, graph.zero, graph.one]
    for q, u in zip(entries[:joints], entries[joints:], strict=True):
        s, c = g.sin(q), g.cos(q)
        v = [c * v[0] - s * v[1] + u * v[2], s * v[0] + c * v[1], v[2] - u * force[0] / force[1]]
        v = [v[1], v[2] + force[2] * v[0], v[0] / (2 + c * v[1])]
    return v


def random_arguments(seed):
    source = random.Random(seed)
    names = {"state": 20, "parameters": 10, "inputs": 5, "time": 1}
    return {name: [source.uniform(0.2, 0.8) for _ in range(n)] for name, n in names.items()}


def values(graph, arguments):
    return {
        a: arguments[a.datum.argument][a.datum.index] for a in graph.nodes if a.operator == "read"
    }


def assert_well_formed(function):
    """Names in order, each assigned before it is read, read at least once, lines not too long."""
    known = set()
    reads = Counter()
    for statement in function.statements:
        match statement:
            case Assign(name, expression):
                used, made = [expression], (name,)
            case RequirePositive(value, scale):
                used, made = [value, scale], ()
            case Solve(names, matrix, right):
                used, made = [*matrix, *right], names
        for part in (p for a in used for p in parts(a)):
            if isinstance(part, Value):
                assert part.name in known
                reads[part.name] += 1
        assert all(name == f"v{len(known) + i}" for i, name in enumerate(made))
        known |= set(made)
    for result in function.results:
        reads.update(p.name for p in parts(result) if isinstance(p, Value))
    solved = {name for s in function.statements if isinstance(s, Solve) for name in s.names}
    assert set(reads) | solved == known
    assert all(operators(e) <= LARGEST_EXPRESSION for e in expressions(function))


@pytest.mark.parametrize("joints", [1, 3, 10])
def test_interpreting_equals_direct_evaluation(joints):
    graph = Graph()
    nodes = spatial_chain(graph, joints)
    function = one(*nodes)
    assert_well_formed(function)
    arguments = random_arguments(joints)
    direct = evaluate(nodes, values(graph, arguments), FLOAT)
    assert interpreter.run(function, arguments, FLOAT) == direct


def test_every_operator_comes_through():
    graph, x, y = state_leaves()
    node = coverage(x, y)
    function = one(node)
    assert_well_formed(function)
    seen = {p.operator for e in expressions(function) for p in parts(e) if isinstance(p, Apply)}
    assert seen == {*OPERATORS}
    arguments = random_arguments(5)
    assert interpreter.run(function, arguments, FLOAT) == evaluate(
        [node], values(graph, arguments), FLOAT
    )


def test_a_value_used_once_is_inlined_and_one_used_twice_is_named():
    _, x, y = state_leaves()
    function = one((x + y) * x)
    assert function.statements == ()
    product, total = Read("state", 0), Apply("add", (Read("state", 0), Read("state", 1)))
    assert function.results == (Apply("multiply", (product, total)),)
    assert one(g.exp(x + y), x + y).statements == (Assign("v0", total),)
    assert one((x + y) ** 2).results == (Apply("multiply", (Value("v0"), Value("v0"))),)


def test_leaves_and_numbers_are_results_without_statements():
    graph, x, _ = state_leaves()
    function = one(graph.zero, x, graph.number(Fraction(1, 3)), x)
    assert function.statements == ()
    read = Read("state", 0)
    assert function.results == (Number(Fraction(0)), read, Number(Fraction(1, 3)), read)


def test_dead_values_are_never_written():
    _, x, y = state_leaves()
    dead = g.exp(x) * g.exp(x) + y
    live = x * y + g.sin(x)
    assert dead is not live
    function = one(live)
    assert all(
        p.operator != "exp" for e in expressions(function) for p in parts(e) if isinstance(p, Apply)
    )


def test_signs_and_quotients_are_written_naturally():
    _, x, y = state_leaves()
    a, b = Read("state", 0), Read("state", 1)
    function = one(x + (-1) * y, -x, x / y, 1 / y, -x * y - x)
    divide = Apply("divide", (a, b))
    assert function.results[:4] == (
        Apply("subtract", (a, b)),
        Apply("negate", (a,)),
        divide,
        Apply("divide", (Number(Fraction(1)), b)),
    )
    product = Apply("multiply", (a, b))
    assert function.results[4] == Apply("negate", (Apply("add", (a, product)),))


def test_sine_and_cosine_of_one_angle_stand_together():
    _, x, y = state_leaves()
    sine = g.sin(x)
    between = g.exp(y) * g.exp(y) * sine
    node = between + g.exp(sine) + g.cos(y)
    function = one(node + g.cos(x) + g.sin(y))
    order = [s.expression for s in function.statements if isinstance(s, Assign)]
    waves = [(i, e) for i, e in enumerate(order) if getattr(e, "operator", "") in ("sin", "cos")]
    assert [i for i, _ in waves] == [waves[0][0], waves[0][0] + 1, waves[2][0], waves[2][0] + 1]
    assert waves[0][1].operands == waves[1][1].operands != waves[2][1].operands
    assert_well_formed(function)


def two_masses(graph):
    a, b, c = (graph.read("parameters", i) for i in range(3))
    right = [graph.read("inputs", i) for i in range(2)]
    return [[a + c, b], [b, c * a]], right


def test_a_pivot_is_checked_before_it_divides():
    graph = Graph()
    matrix, right = two_masses(graph)
    (x,), pivots = ldl.solve(matrix, right)
    function = one(*x, pivots=pivots)
    assert_well_formed(function)
    checked = set()
    for before, statement in zip(function.statements, function.statements[1:], strict=False):
        if isinstance(statement, RequirePositive):
            assert before == Assign(statement.value.name, before.expression)
            checked.add(statement.value)
        elif isinstance(statement, Assign):
            for part in parts(statement.expression):
                if isinstance(part, Apply) and part.operator == "divide":
                    assert part.operands[1] in checked
    assert len(checked) == 2
    arguments = {"parameters": [Fraction(2), Fraction(1), Fraction(3)], "inputs": [1, 2]}
    assert interpreter.run(function, arguments, EXACT) == [Fraction(4, 29), Fraction(9, 29)]


def test_a_pivot_may_be_a_leaf_and_older_than_its_scale():
    graph, m, y = state_leaves()
    older = one(y / m, pivots=((m, m + y),))
    first, check = older.statements
    assert first == Assign("v0", Read("state", 0))
    assert check == RequirePositive(Value("v0"), Apply("add", (Value("v0"), Read("state", 1))))
    assert older.results == (Apply("divide", (Read("state", 1), Value("v0"))),)


def test_pivots_that_no_result_needs_are_not_checked():
    graph = Graph()
    matrix, right = two_masses(graph)
    _, pivots = ldl.solve(matrix, right)
    assert one(right[0], pivots=pivots).statements == ()


@pytest.mark.parametrize("size", [1, 3, 14])
def test_a_system_in_a_loop_equals_the_unrolled_one(size):
    graph = Graph()
    q = [graph.read("state", i) for i in range(size)]
    matrix = [[g.cos(a) * g.cos(b) + (5 if a is b else 0) for b in q] for a in q]
    right = [g.sin(a) + graph.read("inputs", 0) for a in q]
    (loop,) = ldl.solve_in_loop(matrix, right)
    (unrolled,), pivots = ldl.solve(matrix, right)
    outputs = [loop[0] * loop[-1] + q[0], *loop]
    function = one(*outputs)
    assert_well_formed(function)
    (solve,) = [s for s in function.statements if isinstance(s, Solve)]
    assert len(solve.names) == len(solve.right) == solve.size == size
    assert len(solve.matrix) == size * (size + 1) // 2
    arguments = random_arguments(size)
    found = interpreter.run(function, arguments, FLOAT)
    assert found == evaluate(outputs, values(graph, arguments), FLOAT)
    assert found[1:] == pytest.approx(
        interpreter.run(one(*unrolled, pivots=pivots), arguments, FLOAT), rel=1e-13
    )


def test_mistakes_of_ours_are_named():
    graph, x, _ = state_leaves()
    with pytest.raises(ValueError, match="f has 1 results, its shape is \\(2, 2\\)"):
        assemble("f", "", (2, 2), [x])
    with pytest.raises(ValueError, match="cannot read the free symbol z"):
        one(graph.symbol("z"))
