"""The own sine and cosine: within 2 units of the last place in their range, right beyond."""

from functools import cache

import mpmath
import numpy as np
import pytest
from programs import TIME, mul, n, op, program
from tools import tool

from eomgen.numerics.compiled import build
from eomgen.program import Function, Read, Variable
from eomgen.render.code_context import Code, Style
from eomgen.render.targets import TARGETS, render
from eomgen.render.templating import environment

X, Y = Read("state", 0), Read("state", 1)
RANGE = {"double": 1e5, "float": 1e4}
KIND = {"double": np.float64, "float": np.float32}
WIDE = {"double": np.longdouble, "float": np.float64}  # more digits than the type
DIGITS = {"double": 53, "float": 24}
MOST = 2.0  # units of the last place


def waves():
    """A pair, and a sine and a cosine alone."""
    alone = (mul(op("sin", X), n(1)), op("cos", Y))
    functions = (
        Function("outputs", "a pair", (2,), (), (op("sin", X), op("cos", X))),
        Function("energy", "two", (2,), (), alone),
        Function("bias", "of time", (1,), (), (op("sin", TIME),)),
    )
    return program("waves", functions, coordinates=(Variable("x"),), speeds=(Variable("y"),))


@cache
def compiled(real, fast=True):
    tool("cc")
    code = Code(waves(), Style(fast_trig=fast, batch=True))
    return build(render(code, TARGETS["c"], environment()), waves(), real)


def angles(real, count):
    """Dense near zero, random over the range, and the numbers around multiples of pi/2."""
    rng, most, kind = np.random.default_rng(5), RANGE[real], KIND[real]
    quarters = np.arange(-int(most / 1.6), int(most / 1.6))
    near = (quarters.astype(WIDE[real]) * (WIDE[real](np.pi) / 2)).astype(kind)
    if real == "double":
        near = (quarters * PI_HALF).astype(kind)
    parts = [
        np.linspace(-7, 7, count // 4),
        rng.uniform(-most, most, count // 2),
        near,
        np.nextafter(near, kind(np.inf)),
        np.nextafter(near, kind(-np.inf)),
        10.0 ** rng.uniform(-30, 5, count // 8),
        np.array([0.0, most, -most, 5e-324]),
    ]
    found = np.concatenate(parts).astype(kind)
    return found[np.abs(found) <= most]


PI_HALF = np.longdouble("1.57079632679489661923132169163975144209858")


def units(found, exact, real):
    """Errors in units of the last place of the exact value."""
    _, exponent = np.frexp(exact)
    return np.abs(found - exact) / np.ldexp(np.ones_like(exact), exponent - DIGITS[real])


def pair(library, x):
    both, status = library.batch(
        "outputs", 0.0, np.array([x, x]), np.zeros((0, x.size)), model=library.model(())
    )
    assert status == 0
    return both


@pytest.mark.parametrize("count", [40_000, pytest.param(4_000_000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("real", ["double", "float"])
def test_the_error_over_the_whole_range(real, count):
    x = angles(real, count)
    found = pair(compiled(real), x).astype(WIDE[real])
    wide = x.astype(WIDE[real])
    for got, exact in zip(found, (np.sin(wide), np.cos(wide)), strict=True):
        assert units(got, exact, real)[exact != 0].max() <= MOST
        assert (got[exact == 0] == 0).all()


@pytest.mark.parametrize("real", ["double", "float"])
def test_the_error_against_60_digits(real):
    """The same with an oracle of its own: mpmath, at the hardest angles."""
    x = angles(real, 400)
    x = x[:: max(1, x.size // 3000)]
    found = pair(compiled(real), x)
    with mpmath.workdps(60):
        for column, angle in zip(found.T, x, strict=True):
            for got, wave in zip(column, (mpmath.sin, mpmath.cos), strict=True):
                exact = wave(mpmath.mpf(float(angle)))
                if exact:
                    unit = mpmath.ldexp(1, mpmath.frexp(exact)[1] - DIGITS[real])
                    assert abs(mpmath.mpf(float(got)) - exact) <= MOST * unit


@pytest.mark.parametrize("real", ["double", "float"])
def test_one_state_and_many_are_the_same(real):
    library, x = compiled(real), angles(real, 64)[:40]
    many = pair(library, x)
    for k, angle in enumerate(x):
        alone = library.call("outputs", 0.0, [angle, 0.0], [], [])
        np.testing.assert_array_equal(alone, many[:, k])


@pytest.mark.parametrize("real", ["double", "float"])
def test_beyond_the_range_the_library_takes_over(real):
    library, standard = compiled(real), compiled(real, fast=False)
    most = RANGE[real]
    far = np.array([np.nextafter(KIND[real](most), KIND[real](np.inf)), 3 * most, 1e20, -1e30])
    for x in far:
        alone = library.call("outputs", 0.0, [x, 0.0], [], [])
        np.testing.assert_array_equal(alone, standard.call("outputs", 0.0, [x, 0.0], [], []))
    np.testing.assert_array_equal(pair(library, far), pair(standard, far))
    for x in (np.inf, np.nan):
        assert np.isnan(library.call("outputs", 0.0, [x, 0.0], [], [])).all()


@pytest.mark.parametrize("real", ["double", "float"])
def test_a_wave_alone_is_that_of_the_pair(real):
    library = compiled(real)
    for x, y in ((0.3, -2.0), (1e3, 77.0), (2 * RANGE[real], 1.0)):
        sine, cosine = library.call("energy", 0.0, [x, y], [], [])
        assert sine == library.call("outputs", 0.0, [x, 0.0], [], [])[0]
        assert cosine == library.call("outputs", 0.0, [y, 0.0], [], [])[1]
        assert library.call("bias", x, [0.0, 0.0], [], []) == [sine]
    x = np.array([0.3, 2 * RANGE[real], 0.1])
    states, model = np.array([x, x[::-1]]), library.model(())
    found, status = library.batch("energy", 0.0, states, np.zeros((0, 3)), model=model)
    assert status == 0
    np.testing.assert_array_equal(found[0], pair(library, x)[0])
    np.testing.assert_array_equal(found[1], pair(library, x[::-1])[1])


def test_fast_mathematics_is_refused():
    files = render(Code(waves(), Style(fast_trig=True)), TARGETS["c"], environment())
    assert "#ifdef __FAST_MATH__\n#error" in files["waves.c"]
