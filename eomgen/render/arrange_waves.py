"""The shortest spelling of a trigonometric polynomial: by angle sums, or in sines and cosines.

cos(a-b) stays as it is, but 1/2 - 1/2 cos 2a is spelled sin^2 a. Measured are the powers left in
denominators, then the number of terms, then the degree; on a tie sines and cosines of single
angles win (sin a cos a, not 1/2 sin 2a).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache, lru_cache
from itertools import product
from math import comb, gcd, lcm

from eomgen.algebra.normal import Number, Wave, exact

Ripple = tuple[bool, Wave]  # True: sine
Spelling = dict[tuple[tuple[Ripple, int], ...], Number]  # powers of ripples -> coefficient
Waves = Mapping[Ripple, Number]  # the empty wave is 1
Exponents = tuple[tuple[int, int], ...]  # (of cosine, of sine) for each angle
Polynomial = dict[Exponents, Number]

LARGEST = 400  # monomials that a spelling in sines and cosines may pass through


def shortest(waves: Waves, below: Mapping[Ripple, int], phases: frozenset[int]) -> Spelling:
    """The shortest spelling of waves / product of below.

    below: powers of the denominators; phases: angles that are numbers, which are kept in sums.
    """
    if len(waves) == 1 and not below:
        ((ripple, c),) = waves.items()
        return _single(ripple, c)
    ordered = sorted(waves)
    scale = _content(waves, ordered[0])
    unit = tuple((ripple, exact(waves[ripple] / scale)) for ripple in ordered)
    found = _shortest(unit, tuple(sorted(below.items())), phases)
    return {powers: c * scale for powers, c in found.items()}


def _content(waves: Waves, first: Ripple) -> Fraction:
    """What leaves whole numbers without a common divisor, the first of them positive."""
    values = waves.values()
    size = Fraction(gcd(*(c.numerator for c in values)), lcm(*(c.denominator for c in values)))
    return -size if waves[first] < 0 else size


@lru_cache(maxsize=4096)
def _shortest(
    waves: tuple[tuple[Ripple, Number], ...],
    below: tuple[tuple[Ripple, int], ...],
    phases: frozenset[int],
) -> Spelling:
    """The same for waves in order, with whole coefficients: they come again and again."""
    spellings = [_divided(s, dict(below)) for s in _candidates(dict(waves), dict(below), phases)]
    return min(spellings, key=_measure)


def _single(ripple: Ripple, c: Number) -> Spelling:
    sine, wave = ripple
    if not wave:
        return {(): c}
    if sine and len(wave) == 1 and wave[0][1] == 2:
        half = ((wave[0][0], 1),)
        return {(((True, half), 1), ((False, half), 1)): 2 * c}
    return {((ripple, 1),): c}


def _candidates(
    waves: Waves, below: Mapping[Ripple, int], phases: frozenset[int]
) -> Iterator[Spelling]:
    """Spellings of the whole, the preferred first, then angle sums, then support by support."""
    angles = sorted({angle for _, wave in waves for angle, _ in wave})
    units = {angle: _unit(waves, angle) for angle in angles}
    if not phases.intersection(angles) and _bound(waves, units) <= LARGEST:
        expanded = _expanded(waves, units)
        for choice in _choices(len(angles)):
            yield _spelled(_eliminated(expanded, choice), units)
    yield {(((ripple, 1),) if ripple[1] else ()): c for ripple, c in waves.items()}
    supports = {tuple(angle for angle, _ in wave) for _, wave in waves} - {()}
    if len(supports) > 1 and not below:
        yield from _by_support(waves, sorted(supports), phases)


def _by_support(
    waves: Waves, supports: list[tuple[int, ...]], phases: frozenset[int]
) -> Iterator[Spelling]:
    """Each set of angles by itself, the constant going with one of them or with none."""
    for host in (None, *supports):
        parts: dict[tuple[int, ...], dict[Ripple, Number]] = {}
        for (sine, wave), c in waves.items():
            support = tuple(angle for angle, _ in wave) or host or ()
            parts.setdefault(support, {})[sine, wave] = c
        spelling: Spelling = {}
        for part in parts.values():
            for powers, c in shortest(part, {}, phases).items():
                spelling[powers] = spelling.get(powers, 0) + c
        yield {powers: c for powers, c in spelling.items() if c}


def _unit(waves: Waves, angle: int) -> Fraction:
    """The largest 1/n of which every factor of the angle is a multiple."""
    factors = [Fraction(f) for _, wave in waves for a, f in wave if a == angle]
    return Fraction(1, lcm(*(f.denominator for f in factors)))


def _bound(waves: Waves, units: Mapping[int, Fraction]) -> int:
    """At least the number of monomials of the expansion."""
    bound = 0
    for _, wave in waves:
        count = 1
        for angle, factor in wave:
            count *= abs(int(factor / units[angle])) + 1
        bound += count
    return bound


def _choices(count: int) -> Iterator[tuple[bool, ...]]:
    """For each angle whether sin^2 (True) or cos^2 is eliminated; all mixtures of a few angles."""
    yield from (
        product((True, False), repeat=count)
        if count <= 3
        else (
            (True,) * count,
            (False,) * count,
        )
    )


@cache
def _harmonic(n: int) -> tuple[dict[tuple[int, int], int], dict[tuple[int, int], int]]:
    """(cos n a, sin n a) by de Moivre: the real and imaginary part of (cos a + i sin a)^n."""
    sign = -1 if n < 0 else 1
    n = abs(n)
    real = {(n - k, k): comb(n, k) * (-1) ** (k // 2) for k in range(0, n + 1, 2)}
    imaginary = {(n - k, k): sign * comb(n, k) * (-1) ** (k // 2) for k in range(1, n + 1, 2)}
    return real, imaginary


def _expanded(waves: Waves, units: Mapping[int, Fraction]) -> Polynomial:
    """The polynomial in cosines and sines of the unit angles."""
    result: Polynomial = {}
    for (sine, wave), c in waves.items():
        factors = dict(wave)
        parts: tuple[Polynomial, Polynomial] = {(): c}, {}
        for angle, unit in units.items():
            parts = _turned(parts, int(Fraction(factors.get(angle, 0)) / unit))
        for exponents, value in parts[sine].items():
            result[exponents] = result.get(exponents, 0) + value
    return result


def _turned(parts: tuple[Polynomial, Polynomial], n: int) -> tuple[Polynomial, Polynomial]:
    """parts * (cos n a + i sin n a), with the exponents of the new angle appended."""
    real, imaginary = parts
    cosine, sine = _harmonic(n)
    above: Polynomial = {}
    below: Polynomial = {}
    for left, right, target, sign in (
        (real, cosine, above, 1), (imaginary, sine, above, -1),
        (real, sine, below, 1), (imaginary, cosine, below, 1),
    ):  # fmt: skip
        for exponents, c in left.items():
            for pair, factor in right.items():
                key = (*exponents, pair)
                target[key] = target.get(key, 0) + sign * c * factor
    return above, below


def _eliminated(polynomial: Polynomial, choice: tuple[bool, ...]) -> Polynomial:
    """The polynomial with sin^2 = 1 - cos^2, or the other way round, angle by angle."""
    for place, sine in enumerate(choice):
        result: Polynomial = {}
        for exponents, c in polynomial.items():
            for pair, factor in _without_square(exponents[place], sine):
                key = (*exponents[:place], pair, *exponents[place + 1 :])
                result[key] = result.get(key, 0) + c * factor
        polynomial = result
    return {exponents: c for exponents, c in polynomial.items() if c}


@cache
def _without_square(pair: tuple[int, int], sine: bool) -> tuple[tuple[tuple[int, int], int], ...]:
    """Terms of cos^m sin^n in which one of the two has an exponent of at most 1."""
    cosines, sines = pair
    half, odd = divmod(sines if sine else cosines, 2)
    rest = cosines if sine else sines
    return tuple(
        ((rest + 2 * k, odd) if sine else (odd, rest + 2 * k), comb(half, k) * (-1) ** k)
        for k in range(half + 1)
    )


def _spelled(polynomial: Polynomial, units: Mapping[int, Fraction]) -> Spelling:
    """The polynomial with its ripples by name, sine before cosine."""
    waves = [((angle, _whole(unit)),) for angle, unit in units.items()]
    return {
        tuple(
            ((sine, wave), exponent)
            for wave, (cosines, sines) in zip(waves, exponents, strict=True)
            for sine, exponent in ((True, sines), (False, cosines))
            if exponent
        ): c
        for exponents, c in polynomial.items()
    }


def _whole(unit: Fraction) -> int | Fraction:
    return 1 if unit == 1 else unit


def _divided(spelling: Spelling, below: Mapping[Ripple, int]) -> Spelling:
    """The spelling over its denominators, cancelled term by term."""
    if not below:
        return spelling
    result: Spelling = {}
    for powers, c in spelling.items():
        exponents = dict(powers)
        for ripple, exponent in below.items():
            exponents[ripple] = exponents.get(ripple, 0) - exponent
        key = tuple(sorted(((r, e) for r, e in exponents.items() if e), key=_sine_first))
        result[key] = result.get(key, 0) + c
    return {powers: c for powers, c in result.items() if c}


def _sine_first(power: tuple[Ripple, int]) -> tuple[Wave, bool]:
    (sine, wave), _ = power
    return wave, not sine


def _measure(spelling: Spelling) -> tuple[int, int, Number]:
    """(powers in denominators, number of terms, degree with a common factor counted once)."""
    negative = sum(-e for powers in spelling for _, e in powers if e < 0)
    degrees = [{r: _degree(r) * abs(e) for r, e in powers} for powers in spelling]
    shared = sum(
        min(d.get(ripple, 0) for d in degrees) for ripple in (degrees[0] if degrees else ())
    )
    degree = sum(sum(d.values()) for d in degrees)
    return negative, len(spelling), degree - shared * (len(spelling) - 1)


@cache
def _degree(ripple: Ripple) -> Fraction:
    """The degree in sines and cosines of single angles."""
    return sum((abs(Fraction(f)) for _, f in ripple[1]), Fraction(0))
