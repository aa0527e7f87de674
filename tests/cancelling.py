"""Expressions that lose digits where they are written plainly, and the states where they do.

Shared with benchmarks/precision.py. The leaves are components x, y of the state and parameters
a = 1/2, b = 3.
"""

from dataclasses import dataclass
from math import pi

import mpmath
import numpy as np
import sympy as sp

from eomgen.algebra import cancellation, half_angles, specialise
from eomgen.algebra import elementary as g
from eomgen.algebra.arithmetic import mpmath_arithmetic
from eomgen.algebra.assemble import assemble
from eomgen.algebra.graph import Graph
from eomgen.interpreter import call
from eomgen.precision.engines import arrays_of
from eomgen.program import Program, Variable
from eomgen.render.lowered import lower, operations

A, B = sp.Rational(1, 2), sp.Integer(3)
DIGITS = mpmath_arithmetic(60)
EPSILON = 2.0**-23
NONE = frozenset()


@dataclass(frozen=True)
class Case:
    """build(x, y, a, b) is the plain node; near: states (x, y); gone: operators that must go."""

    build: object
    near: tuple
    gone: frozenset = NONE
    kept: float = 8.0  # epsilons of float that the other form may lose


CASES = {
    "1 - cos(x)": Case(lambda x, y, a, b: 1 - g.cos(x), ((1e-3, 0), (1e-4, 0)), {"cos"}),
    "cos(x) - 1": Case(lambda x, y, a, b: y * (g.cos(x) - 1), ((1e-3, 2),), {"cos"}),
    "b a - b a cos(x)": Case(lambda x, y, a, b: b * a - a * (b * g.cos(x)), ((1e-3, 0),), {"cos"}),
    "1 + cos(x)": Case(lambda x, y, a, b: 1 + g.cos(x), ((pi - 1e-3, 0),), {"add"}, 600.0),
    "b - b cos(x)^2": Case(lambda x, y, a, b: b - b * g.cos(x) ** 2, ((1e-3, 0),), {"cos"}),
    "y - y sin(x)^2": Case(
        lambda x, y, a, b: y - y * g.sin(x) ** 2, ((pi / 2 - 1e-3, 2),), {"subtract"}, 600.0
    ),
    "b (a sin(x) y)^2 + b (a cos(x) y)^2": Case(
        lambda x, y, a, b: b * (a * g.sin(x) * y) ** 2 + b * (a * (g.cos(x) * y)) ** 2,
        ((0.3, 2),),
        {"sin", "cos", "add"},
    ),
    "y + b sin(x)^2 + b cos(x)^2": Case(
        lambda x, y, a, b: y + b * g.sin(x) ** 2 + b * g.cos(x) ** 2, ((0.3, 2),), {"sin", "cos"}
    ),
    "sin(x) (cos(x) y) - cos(x) (sin(x) y)": Case(
        lambda x, y, a, b: g.sin(x) * (g.cos(x) * y) - g.cos(x) * (g.sin(x) * y),
        ((0.27, 1.69), (0.19, 0.06)),
        {"subtract"},
    ),
    "sqrt(1 + x) - 1": Case(lambda x, y, a, b: g.sqrt(1 + x) - 1, ((1e-5, 0), (-1e-4, 0))),
    "a - sqrt(a^2 - x^2)": Case(lambda x, y, a, b: b * (a - g.sqrt(a * a - x * x)), ((1e-3, 0),)),
    "b (sqrt((a + x)^2 + y^2) - a)": Case(
        lambda x, y, a, b: b * (g.sqrt((a + x) ** 2 + y * y) - a), ((1e-4, 1e-4), (-1e-5, 0))
    ),
    "b (sqrt((x - a)^2 + y^2) - a)": Case(
        lambda x, y, a, b: b * (g.sqrt((x - a) ** 2 + y * y) - a), ((1e-4, 1e-4),)
    ),
    "sqrt(4 + x^2) - sqrt(4 + y^2)": Case(
        lambda x, y, a, b: g.sqrt(4 + x * x) - g.sqrt(4 + y * y), ((1e-2, 2e-2),)
    ),
    "sqrt((x cos(y))^2 + (x sin(y))^2) - a": Case(
        lambda x, y, a, b: g.sqrt((x * g.cos(y)) ** 2 + (x * g.sin(y)) ** 2) - a,
        ((0.50001, 0.7),),
        {"sqrt", "sin", "cos"},
    ),
    "sqrt(a^2 - x^2)": Case(lambda x, y, a, b: g.sqrt(a * a - x * x), ((0.49999, 0),)),
    "acos(x/y)": Case(
        lambda x, y, a, b: g.acos(x / y), ((0.299999, 0.3), (1.1, 1.10003)), {"acos"}
    ),
    "asin(x/y)": Case(lambda x, y, a, b: g.asin(x / y), ((1.1, 1.10003),), {"asin"}, 4.0),
    "acos((a^2 + b^2 - x^2)/(2 a b))": Case(
        lambda x, y, a, b: g.acos((a * a + b * b - x * x) / (2 * a * b)),
        ((2.50011, 0), (2.5003, 0), (3.49999, 0)),
        {"acos"},
    ),
}


def program(case):
    """The plain expression as a function `f` of a program."""
    graph = Graph()
    leaves = [graph.read("state", i) for i in range(2)]
    leaves += [graph.read("parameters", i) for i in range(2)]
    function = assemble("f", "", (1,), [case.build(*leaves)])
    parameters = (Variable("a", value=A), Variable("b", value=B))
    states = (Variable("x"), Variable("y"))
    return Program("case", "", "", "", states, (), (), parameters, (), (function,))


def written(of, folded=()):
    """The program as it is shipped."""
    return specialise.specialised(of, folded)


def plainly(of, monkeypatch):
    """The same without the rules."""
    with monkeypatch.context() as patch:
        patch.setattr(cancellation, "builders", lambda inner, fixed, positive: inner)
        patch.setattr(half_angles, "replaced", lambda nodes, build, products: None)
        return written(of)


def value(of, state, arithmetic, convert=float):
    """What `f` is at a state."""
    values = {"a": convert(0.5), "b": convert(3)}
    given = [values[p.name] for p in of.parameters]
    arguments = {"state": [convert(v) for v in state], "parameters": given}
    return call(of, "f", arguments, arithmetic)[0]


def exactly(of, state):
    """The same in many digits."""
    return value(of, state, DIGITS, lambda v: DIGITS.number(float(v)))


def in_float(state):
    """The state as float has it."""
    return [float(np.float32(v)) for v in state]


def error(of, state):
    """The relative error of `f` in float, in units of its epsilon, at a state of float."""
    at = in_float(state)
    truth = exactly(of, at)
    with arrays_of("float").quiet():
        found = float(value(of, at, arrays_of("float"), lambda v: np.asarray(v, np.float32)))
    if found == truth == 0:
        return 0.0
    return float(abs(mpmath.mpf(found) - truth) / max(abs(truth), mpmath.mpf(10) ** -40)) / EPSILON


def applied(of):
    """How often each operator is applied in `f`."""
    return operations(lower(of.function("f")))


def count(of):
    """All of them."""
    return sum(applied(of).values())
