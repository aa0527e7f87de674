"""The closed form: a canonical normal form that decides whether an expression is zero.

A `Form` is a sum of terms  coefficient * monomial * wave.  A monomial is a product of whole powers
of atoms (symbols and kernels), a wave is 1, cos(a) or sin(a) with `a` a rational combination of
angles. Products of waves become waves of sums and differences at once,

    cos a cos b = (cos(a-b) + cos(a+b)) / 2,   and so on,

so sin^2 + cos^2 = 1 and every addition theorem hold by construction: waves of different angles are
linearly independent (Fourier), hence two equal polynomials have the same terms.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from math import lcm
from typing import Any

from eomgen.errors import UsageError

Monomial = tuple[tuple[int, int], ...]  # (atom, exponent), atoms ascending
Wave = tuple[tuple[int, "int | Fraction"], ...]  # (angle, factor), angles ascending
Key = tuple[Monomial, Wave, bool]  # True: sine; the empty wave is 1
Number = int | Fraction
Terms = dict[Key, Number]

ONE: Key = ((), (), False)
MOST_PRODUCTS = 400_000  # of terms, in one ring: some ten seconds


class TooLarge(UsageError):
    """The closed form has outgrown what a person could read and a machine should wait for."""

    def __init__(self) -> None:
        super().__init__(
            f"the closed form of this scene takes more than {MOST_PRODUCTS} products of terms; "
            "use fewer coordinates, angles counted from fixed axes, or lower powers"
        )


def exact(value: Number) -> Number:
    """The same number, as an int where it is one (ints are ten times faster)."""
    return value.numerator if type(value) is Fraction and value.denominator == 1 else value


@dataclass(frozen=True)
class Kernel:
    """A function that the ring does not look into, on canonical arguments.

    `base` stands for a sum that occurs with negative powers only: base(p)^-1 is 1/p.
    """

    function: str
    arguments: tuple[Form, ...]


Atom = Any  # sp.Symbol, sp.pi or Kernel; SymPy has no types


@dataclass
class Ring:
    """Atoms and angles in the order in which they were first seen; caches of products."""

    atoms: list[Atom] = field(default_factory=list)
    angles: list[Key] = field(default_factory=list)  # an angle is a term without its coefficient
    index: dict[Any, int] = field(default_factory=dict)
    angle_index: dict[Key, int] = field(default_factory=dict)
    monomials: dict[tuple[Monomial, Monomial], Monomial] = field(default_factory=dict)
    waves: dict[tuple[Wave, Wave], tuple[tuple[Wave, int], tuple[Wave, int]]] = field(
        default_factory=dict
    )
    squares: dict[int, Form] = field(default_factory=dict)  # kernels whose square is known
    products: int = 0  # of terms, so far

    def atom(self, what: Atom) -> int:
        """The number of an atom, new or known."""
        if what not in self.index:
            self.index[what] = len(self.atoms)
            self.atoms.append(what)
        return self.index[what]

    def angle(self, key: Key) -> int:
        """The number of an angle, new or known."""
        if key not in self.angle_index:
            self.angle_index[key] = len(self.angles)
            self.angles.append(key)
        return self.angle_index[key]

    def product(self, left: Monomial, right: Monomial) -> Monomial:
        """The product of two monomials."""
        if not left or not right:
            return left or right
        known = self.monomials.get((left, right))
        if known is None:
            known = self.monomials[left, right] = _merge(left, right)
        return known

    def beat(self, left: Wave, right: Wave) -> tuple[tuple[Wave, int], tuple[Wave, int]]:
        """(left + right, left - right), each with a positive leading factor and the sign taken."""
        known = self.waves.get((left, right))
        if known is None:
            negative = tuple((angle, -factor) for angle, factor in right)
            known = (oriented(_merge(left, right)), oriented(_merge(left, negative)))
            self.waves[left, right] = known
        return known


def _merge(left: tuple[Any, ...], right: tuple[Any, ...]) -> tuple[Any, ...]:
    """Sum of two sparse vectors of (index, value)."""
    total = dict(left)
    for index, value in right:
        total[index] = total.get(index, 0) + value
    return tuple(sorted((i, exact(v)) for i, v in total.items() if v))


def oriented(wave: Wave) -> tuple[Wave, int]:
    """The wave with a positive leading factor, and +1 or -1."""
    if wave and wave[0][1] < 0:
        return tuple((angle, -factor) for angle, factor in wave), -1
    return wave, 1


class Form:
    """A closed form; immutable, with `terms` of one `ring`."""

    __slots__ = ("_hash", "ring", "terms")

    def __init__(self, ring: Ring, terms: Terms) -> None:
        self.ring = ring
        self.terms = terms
        self._hash: int | None = None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Form) and self.terms == other.terms

    def __hash__(self) -> int:
        if self._hash is None:
            self._hash = hash(frozenset(self.terms.items()))
        return self._hash

    def _coerced(self, other: Form | Number) -> Form:
        return other if isinstance(other, Form) else number(self.ring, other)

    def __add__(self, other: Form | Number) -> Form:
        return total(self.ring, (self, self._coerced(other)))

    __radd__ = __add__

    def __neg__(self) -> Form:
        return Form(self.ring, {key: -c for key, c in self.terms.items()})

    def __sub__(self, other: Form | Number) -> Form:
        return self + -self._coerced(other)

    def __rsub__(self, other: Form | Number) -> Form:
        return -self + other

    def __mul__(self, other: Form | Number) -> Form:
        if not isinstance(other, Form):
            return scaled(self, other)
        return multiply(self, other)

    __rmul__ = __mul__

    def __truediv__(self, other: Form | Number) -> Form:
        return self * inverse(self._coerced(other))

    def __pow__(self, power: int) -> Form:
        if power < 0:
            return inverse(self) ** -power
        result = number(self.ring, 1)
        for _ in range(power):
            result = result * self
        return result


def number(ring: Ring, value: Number) -> Form:
    """A constant."""
    return Form(ring, {ONE: exact(value)} if value else {})


def scaled(form: Form, factor: Number) -> Form:
    """Factor * form."""
    if not factor:
        return Form(form.ring, {})
    return Form(form.ring, {key: exact(c * factor) for key, c in form.terms.items()})


def of_atom(ring: Ring, what: Atom, exponent: int = 1) -> Form:
    """atom^exponent."""
    return Form(ring, {(((ring.atom(what), exponent),), (), False): 1})


def total(ring: Ring, forms: Iterable[Form]) -> Form:
    """The sum."""
    terms: Terms = {}
    for form in forms:
        for key, c in form.terms.items():
            terms[key] = terms.get(key, 0) + c
    return Form(ring, {key: exact(c) for key, c in terms.items() if c})


def multiply(left: Form, right: Form) -> Form:
    """The product, reduced."""
    ring = left.ring
    ring.products += len(left.terms) * len(right.terms)
    if ring.products > MOST_PRODUCTS:
        raise TooLarge
    # whole numbers over one denominator: sums of fractions would take most of the time
    (first, d1), (second, d2) = _whole(left), _whole(right)
    terms: dict[Key, int] = {}
    for place, ((m1, w1, s1), c1) in enumerate(first):
        if left is right:  # a square: every mixed product once, doubled
            second = [(k, 2 * c) for k, c in first[:place]] + first[place : place + 1]
        for (m2, w2, s2), c2 in second:
            monomial = ring.product(m1, m2)
            if w1 and w2:
                _collect_beat(terms, ring, monomial, ((w1, s1), (w2, s2)), c1 * c2)
            else:
                key = (monomial, w1 or w2, s1 or s2)
                terms[key] = terms.get(key, 0) + 2 * c1 * c2
    result = Form(ring, {key: _over(c, 2 * d1 * d2) for key, c in terms.items() if c})
    return reduced(result) if ring.squares else result


def _whole(form: Form) -> tuple[list[tuple[Key, int]], int]:
    """Terms with whole coefficients, and the denominator of them all."""
    denominator = lcm(*(c.denominator for c in form.terms.values()))
    pairs = form.terms.items()
    return [(key, c.numerator * (denominator // c.denominator)) for key, c in pairs], denominator


def _over(numerator: int, denominator: int) -> Number:
    """The quotient, a whole number where it is one."""
    whole, rest = divmod(numerator, denominator)
    return Fraction(numerator, denominator) if rest else whole


def _collect_beat(
    terms: dict[Key, int],
    ring: Ring,
    monomial: Monomial,
    waves: tuple[tuple[Wave, bool], tuple[Wave, bool]],
    c: int,
) -> None:
    """Add 2 c * monomial * wave * wave as waves of the sum and of the difference of the angles."""
    (w1, s1), (w2, s2) = waves
    (up, up_sign), (down, down_sign) = ring.beat(w1, w2)
    sine = s1 != s2
    # 2 sin a sin b = cos(a-b) - cos(a+b);  2 cos a sin b = sin(a+b) - sin(a-b)
    up_c = -c if s1 and s2 else c
    down_c = -c if s2 and not s1 else c
    if sine:
        up_c, down_c = up_c * up_sign, down_c * down_sign
    if up or not sine:
        key = (monomial, up, sine and bool(up))
        terms[key] = terms.get(key, 0) + up_c
    if down or not sine:
        key = (monomial, down, sine and bool(down))
        terms[key] = terms.get(key, 0) + down_c


def reduced(form: Form) -> Form:
    """The form with every known square replaced: sqrt(p)^2 is p, abs(p)^2 is p^2."""
    ring = form.ring
    heavy = {k: None for k in form.terms if any(e > 1 and a in ring.squares for a, e in k[0])}
    if not heavy:
        return form
    groups: dict[tuple[int, int], Terms] = {}  # (atom, exponent of its square) -> the rest
    for key in heavy:
        atom, exponent = next((a, e) for a, e in key[0] if e > 1 and a in ring.squares)
        rest = tuple((a, e if a != atom else e % 2) for a, e in key[0] if a != atom or e % 2)
        group, lighter = groups.setdefault((atom, exponent // 2), {}), (rest, *key[1:])
        group[lighter] = group.get(lighter, 0) + form.terms[key]
    light = Form(ring, {k: c for k, c in form.terms.items() if k not in heavy})
    parts = [
        Form(ring, terms) * ring.squares[atom] ** exponent
        for (atom, exponent), terms in groups.items()
    ]
    return total(ring, [light, *parts])


def split_content(form: Form) -> tuple[Form, Form]:
    """(monomial, rest) with form = monomial * rest: common powers and the leading coefficient."""
    keys = sorted(form.terms)
    shared = dict(keys[0][0])
    for key in keys[1:]:
        powers = dict(key[0])
        shared = {a: min(e, powers.get(a, 0)) for a, e in shared.items()}
        shared |= {a: e for a, e in powers.items() if e < 0 and a not in shared}
    monomial = tuple(sorted((a, e) for a, e in shared.items() if e))
    content = Form(form.ring, {(monomial, (), False): form.terms[keys[0]]})
    return content, multiply(form, _monomial_inverse(content))


def _monomial_inverse(form: Form) -> Form:
    (((monomial, _, _), c),) = form.terms.items()
    return Form(
        form.ring, {(tuple((a, -e) for a, e in monomial), (), False): exact(Fraction(1) / c)}
    )


def inverse(form: Form) -> Form:
    """1/form. A single power inverts term by term; a sum becomes the kernel `base` to the -1.

    Raises:
        ZeroDivisionError: the form is zero.
    """
    if not form.terms:
        raise ZeroDivisionError("division by a formula that is identically zero")
    content, rest = split_content(form)
    result = _monomial_inverse(content)
    if rest.terms == {ONE: 1}:
        return result
    return result * of_atom(form.ring, Kernel("base", (rest,)), -1)


def atoms_of(form: Form) -> list[int]:
    """Atoms that occur in monomials and in angles, each once, in the order of the ring."""
    seen: set[int] = set()
    for monomial, wave, _ in form.terms:
        seen.update(a for a, _ in monomial)
        for angle, _ in wave:
            key = form.ring.angles[angle]
            seen.update(atoms_of(Form(form.ring, {key: 1})))
    return sorted(seen)


def is_zero(form: Form) -> bool:
    """Decided: denominators are cleared and roots squared away before terms are compared."""
    while form.terms:
        ring = form.ring
        negative = sorted(
            {a for m, _, _ in form.terms for a, e in m if e < 0 and _clearable(ring, a)}
        )
        if not negative:
            return False
        form = cleared(form, negative[-1])
    return True


def _clearable(ring: Ring, atom: int) -> bool:
    what = ring.atoms[atom]
    return isinstance(what, Kernel) and (what.function == "base" or atom in ring.squares)


def cleared(form: Form, atom: int) -> Form:
    """Form * kernel^k without negative powers of that kernel."""
    ring = form.ring
    what = ring.atoms[atom]
    assert isinstance(what, Kernel)
    lowest = min(dict(m).get(atom, 0) for m, _, _ in form.terms)
    root = of_atom(ring, what)
    value = what.arguments[0] if what.function == "base" else root
    groups: dict[int, Terms] = {}
    for (m, w, s), c in form.terms.items():
        exponent = dict(m).get(atom, 0) - lowest
        rest = tuple(p for p in m if p[0] != atom)
        groups.setdefault(exponent, {})[rest, w, s] = c
    return total(ring, (Form(ring, terms) * value**e for e, terms in groups.items()))


def linear_parts(form: Form, atoms: Iterable[int]) -> tuple[dict[int, Form], Form]:
    """(coefficient of each atom, rest) of a form that is linear in the atoms."""
    parts: dict[int, Terms] = {atom: {} for atom in atoms}
    rest: Terms = {}
    for (monomial, wave, sine), c in form.terms.items():
        atom = next((a for a, _ in monomial if a in parts), None)
        if atom is None:
            rest[monomial, wave, sine] = c
        else:
            parts[atom][tuple(p for p in monomial if p[0] != atom), wave, sine] = c
    return {a: Form(form.ring, terms) for a, terms in parts.items()}, Form(form.ring, rest)
