"""Other forms of sums, roots and arcs: the same values, and digits that the plain form loses."""

import random

import pytest
from cancelling import CASES, applied, error, exactly, plainly, program, written
from scenes import program_of

from eomgen import interpreter
from eomgen.algebra import decimals
from eomgen.algebra import elementary as g
from eomgen.algebra.cancellation import RULES
from eomgen.algebra.graph import Graph
from eomgen.algebra.signs import Signs
from eomgen.algebra.terms import Products, built, summands, total
from eomgen.render.code_context import coded
from eomgen.render.lowered import lower, operations

FAR = [(0.3, 0.4), (0.45, 1.7), (0.2, 0.9)]  # inside of every root and arc
TOO_MUCH = 100.0  # epsilons of float


@pytest.mark.parametrize("name", CASES)
def test_the_other_form_is_an_identity(name, monkeypatch):
    of = program(CASES[name])
    made = (written(of), written(of, {"a"}), written(of, {"a", "b"}), plainly(of, monkeypatch))
    for state in (*FAR, *CASES[name].near):
        if name.startswith("acos(("):
            state = (state[0] + 2.5, state[1]) if state in FAR else state
        truth = exactly(of, state)
        for other in made:
            assert abs(exactly(other, state) - truth) <= 1e-48 * (abs(truth) + 1)


@pytest.mark.parametrize("name", CASES)
def test_the_plain_operators_are_gone(name):
    assert not CASES[name].gone & applied(written(program(CASES[name]))).keys()


@pytest.mark.parametrize("name", CASES)
def test_digits_are_kept_that_the_plain_form_loses(name, monkeypatch):
    case = CASES[name]
    of = program(case)
    plain, made = plainly(of, monkeypatch), written(of)
    assert max(error(made, state) for state in case.near) < case.kept
    if not case.gone >= {"sin", "cos"}:  # these lose little, but are computed for nothing
        assert max(error(plain, state) for state in case.near) > 2 * case.kept


def test_every_rule_has_a_case():
    assert len(RULES) == 5
    assert all(rule.pattern and rule.rewrite and rule.reason for rule in RULES)


def applied_of(of, name):
    return operations(lower(of.function(name)))


# what must stay as it is


def node(build):
    graph = Graph()
    x, y = graph.read("state", 0), graph.read("state", 1)
    a, b = graph.read("parameters", 0), graph.read("parameters", 1)
    return build(x, y, a, b)


class Plain:
    """A case without a form that is better."""

    near = ()
    gone = frozenset()

    def __init__(self, build):
        self.build = build


STAYS = {
    "no cancellation": lambda x, y, a, b: g.sqrt(x * x + y * y) + a,
    "two free coordinates": lambda x, y, a, b: g.sqrt(x * x + y * y) - a,
    "a length of unknown sign": lambda x, y, a, b: g.sqrt(1 + x * x) - y,
    "a length that may be negative": lambda x, y, a, b: g.sqrt(x * x + y * y) - y,
    "other angles": lambda x, y, a, b: b * g.sin(x) ** 2 + b * g.cos(y) ** 2,
    "other factors": lambda x, y, a, b: b * g.sin(x) ** 2 + a * g.cos(x) ** 2,
    "other numbers": lambda x, y, a, b: 2 * g.sin(x) ** 2 + 3 * g.cos(x) ** 2,
    "a difference of squares": lambda x, y, a, b: g.cos(x) ** 2 - g.sin(x) ** 2,
    "half": lambda x, y, a, b: y - y * g.cos(x) / 2,
    "no ratio": lambda x, y, a, b: g.acos(x) + g.asin(y),
}


@pytest.mark.parametrize("name", STAYS)
def test_what_has_no_better_form_stays(name, monkeypatch):
    of = program(Plain(STAYS[name]))
    assert written(of) == plainly(of, monkeypatch)


def test_a_rotation_about_a_skew_axis_needs_no_further_sine(monkeypatch):
    turned = Plain(lambda x, y, a, b: (b * a) * (1 - g.cos(x)) + a * g.sin(x))
    assert written(program(turned)) == plainly(program(turned), monkeypatch)
    alone = Plain(lambda x, y, a, b: (b * a) * (1 - g.cos(x)) * y + a * g.sin(y))
    assert "cos" not in applied(written(program(alone)))
    arm = coded(program_of("skew_arm")).program
    assert applied_of(arm, "accelerations")["sin"] == 2


def test_a_denominator_of_unknown_sign_is_taken_as_it_is(monkeypatch):
    of = program(CASES["acos(x/y)"])
    for state in ((0.3, -0.4), (-0.3, -0.4), (-0.3, 0.4)):
        assert abs(exactly(written(of), state) - exactly(of, state)) < 1e-48
    of = program(CASES["asin(x/y)"])
    for state in ((0.3, -0.4), (-0.3, -0.4), (-0.3, 0.4)):
        assert abs(exactly(written(of), state) - exactly(of, state)) < 1e-48


def test_roots_at_zero_stay_zero():
    """A form that is 0/0 where the plain one is 0 would stop a scene at rest."""
    of = program(Plain(lambda x, y, a, b: g.sqrt(x * x + y * y) - g.sqrt(x * x)))
    assert exactly(written(of), (0, 0)) == 0


# shipped scenes


SCENES = ("elastic_pendulum", "skew_arm", "double_pendulum", "satellite", "rolling_disc_tilting",
          "snakeboard", "slider_crank", "watt_governor", "sprung_pair")  # fmt: skip


@pytest.mark.parametrize("name", SCENES)
def test_shipped_scenes_keep_their_values_and_cost_no_more(name, monkeypatch):
    of = program_of(name)
    made, plain = coded(of).program, plainly(of, monkeypatch)
    chance = random.Random(name)
    number = decimals.arithmetic(50)
    given = {
        "time": [chance.random()],
        "state": [chance.uniform(0.2, 1) for _ in (*of.coordinates, *of.speeds)],
        "inputs": [chance.random() for _ in of.inputs],
        "parameters": [chance.uniform(1, 2) for _ in of.parameters],
    }
    with number.quiet():
        exact = {b: [decimals.exactly(v) for v in values] for b, values in given.items()}
        for function in of.functions:
            results = [interpreter.call(p, function.name, exact, number) for p in (of, made)]
            size = max((abs(v) for v in results[0]), default=0) + 1
            for a, b in zip(*results, strict=True):
                assert abs(a - b) <= decimals.exactly(1e-40) * size
    counts = [sum(sum(applied_of(p, f.name).values()) for f in p.functions) for p in (made, plain)]
    assert counts[0] <= counts[1]


def test_a_polar_spring_is_measured_without_a_root(monkeypatch):
    of = program_of("elastic_pendulum")
    made, plain = coded(of).program, plainly(of, monkeypatch)
    assert applied_of(plain, "accelerations")["sqrt"] == 1
    assert applied_of(made, "accelerations")["sqrt"] == 0


# the pieces


def test_products_are_found_in_any_order():
    products = Products()
    a = node(lambda x, y, a, b: (x * y) * (a / b) * 3)
    x, y, p, q = (node_of(a.graph, i) for i in range(4))
    found = products.of(a)
    assert found.number == 3
    assert found.powers == {x: 1, y: 1, p: 1, q: -1}
    assert found.is_same(products.of(3 * (p * (y * (x / q)))))
    assert products.of(built(a, found)).is_same(found)
    assert products.of(x / x).powers == {}
    assert products.of(-(x * x) / 2).square().powers == {x: 4}


def node_of(graph, i):
    return graph.read(*(("state", i) if i < 2 else ("parameters", i - 2)))


def test_sums_are_their_terms():
    a = node(lambda x, y, a, b: x - (y - a * b) + 2)
    assert total(a, summands(a)) is a or len(summands(a)) == 4
    assert [t.operator for t in summands(a)].count("negate") == 1


def test_signs_are_known_from_the_form():
    x, y, a, b = (node(lambda *v, i=i: v[i]) for i in range(4))
    graph = x.graph
    x, y, a, b = (node_of(graph, i) for i in range(4))
    signs = Signs(frozenset((a,)))
    for sure in (a, a * a, a + x * x, g.sqrt(a + 1), g.exp(x), a / 2, g.absolute(a)):
        assert signs.is_positive(sure)
    for open_ in (x, b, x * x, g.sqrt(x), a - b, a + x, a * b, -a, graph.zero, g.absolute(x)):
        assert not signs.is_positive(open_)
    for least in (x * x, g.sqrt(x), g.absolute(x), a):
        assert signs.is_not_negative(least)
    assert not signs.is_not_negative(x)
