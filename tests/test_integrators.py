"""Tableaus satisfy the order conditions they claim, exactly; the table of methods is as stated."""

from fractions import Fraction
from math import prod

import pytest
import sympy as sp

from eomgen.errors import UsageError
from eomgen.integrators import methods
from eomgen.integrators.methods import METHODS
from eomgen.integrators.tableaus import DOPRI5, RK4, ROS2, Tableau
from eomgen.numerics import adaptive
from eomgen.wanted import INTEGRATORS

EXPLICIT = {"rk4": RK4, "dopri5": DOPRI5}


def forests(size, largest=None):
    """Multisets of rooted trees with `size` nodes in all; a tree is the tuple of its branches."""
    if size == 0:
        yield ()
        return
    for first in range(min(size, largest or size), 0, -1):
        for tree in trees(first):
            for rest in forests(size - first, first):
                if not rest or (len(nodes(rest[0])), rest[0]) <= (len(nodes(tree)), tree):
                    yield (tree, *rest)


def trees(size):
    yield from forests(size - 1)


def nodes(tree):
    return [tree, *(n for branch in tree for n in nodes(branch))]


def density(tree):
    """gamma(tree): the number of nodes times the densities of the branches."""
    return len(nodes(tree)) * prod(map(density, tree))


def weights(tableau, tree):
    """For each stage the product over the branches of sum a_ij (their weights)."""
    stages = range(len(tableau.b))
    below = [weights(tableau, branch) for branch in tree]
    inner = [
        [sum((a * w[j] for j, a in enumerate(tableau.a[i])), Fraction(0)) for i in stages]
        for w in below
    ]
    return [prod((column[i] for column in inner), start=Fraction(1)) for i in stages]


def defect(tableau, tree):
    total = sum(b * w for b, w in zip(tableau.b, weights(tableau, tree), strict=True))
    return total - Fraction(1, density(tree))


def test_there_are_as_many_trees_as_cayley_counted():
    assert [len(set(trees(n))) for n in range(1, 7)] == [1, 1, 2, 4, 9, 20]
    assert [len(list(trees(n))) for n in range(1, 7)] == [1, 1, 2, 4, 9, 20]


@pytest.mark.parametrize("name", EXPLICIT)
def test_every_order_condition_holds_up_to_the_order_and_not_beyond(name):
    tableau = EXPLICIT[name]
    for size in range(1, tableau.order + 1):
        assert all(defect(tableau, tree) == 0 for tree in trees(size))
    assert any(defect(tableau, tree) != 0 for tree in trees(tableau.order + 1))


def test_a_wrong_coefficient_is_seen():
    with pytest.raises(AssertionError):
        Tableau(1, ((), (Fraction(1, 2),)), (Fraction(0), Fraction(1)), (Fraction(0), Fraction(1)))
    with pytest.raises(AssertionError):
        Tableau(1, ((),), (Fraction(1, 2),), (Fraction(0),))


def test_rosenbrock_has_order_2_for_any_jacobian_and_decays_at_infinity():
    z, gamma, jacobian = sp.symbols("z gamma jacobian")
    # y' = z y with h = 1 and any number in the place of its Jacobian
    w = 1 - gamma * jacobian
    first = z / w
    second = (z * (1 + first) - 2 * first) / w
    y = 1 + sp.Rational(3, 2) * first + second / 2
    size = sp.Symbol("size")
    scaled = y.subs({z: size * z, jacobian: size * jacobian})
    series = sp.series(scaled, size, 0, 3).removeO()
    assert sp.expand(series - (1 + size * z + size**2 * z**2 / 2)) == 0
    exact = y.subs({jacobian: z, gamma: 1 - 1 / sp.sqrt(2)})
    assert sp.limit(exact, z, -sp.oo) == 0
    assert pytest.approx(1 - 2**-0.5, abs=1e-15) == ROS2.gamma
    # A-stable: on the imaginary axis |R| <= 1
    values = [complex(exact.subs(z, sp.I * x).evalf()) for x in (0.1, 1, 10, 1000)]
    assert all(abs(v) <= 1 for v in values)


def test_methods_are_chosen_once_in_the_order_of_the_table():
    found = methods.chosen(("rk4", "semi-euler", "rk4"))
    assert [m.name for m in found] == ["semi-euler", "rk4"]
    assert methods.chosen(("all",)) == tuple(METHODS.values())
    with pytest.raises(UsageError, match="no integrator 'euler'; there are semi-euler, "):
        methods.chosen(("euler",))


def test_the_command_line_and_the_language_list_every_integrator():
    assert (*METHODS, *adaptive.NAMES) == INTEGRATORS
