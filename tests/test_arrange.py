"""What is displayed equals the closed form, and is written as a textbook writes it."""

import random
from fractions import Fraction

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import FILES, derivation_of

from eomgen.algebra import normal
from eomgen.algebra.closed import ClosedForm, Evaluation
from eomgen.mechanics.equations import Equation, multiplier_name, virtual_name
from eomgen.model import Coordinate, Input, Model, Parameter, Prescribed
from eomgen.render import arrange, arrange_equation, tree
from eomgen.render.arrange_equation import LOADED, RIGHT
from eomgen.render.text import text

HOW = {
    "kinetic": arrange.kinetic,
    "potential": arrange.potential,
    "dissipation": arrange.dissipation,
    "motion": arrange.motion,
    "loads": arrange.loads,
    "work": arrange.work,
}


def symbol(name):
    return sp.Symbol(name, real=True)


def coordinate(name, **known):
    places = [symbol(name + dots) for dots in ("", "'", "''")]
    return Coordinate(name, *places, **known)


def model(parameters, coordinates, inputs="", positive=(), **known):
    return Model(
        "scene",
        {"en": "Scene"},
        "plane",
        (),
        parameters=tuple(Parameter(p, symbol(p), value=known.get(p)) for p in parameters.split()),
        coordinates=tuple(coordinate(c, positive=c in positive) for c in coordinates.split()),
        inputs=tuple(Input(i, symbol(i)) for i in inputs.split()),
        range=known.get("ranges", {}),
    )


class Names(dict):
    """Symbols by name; a trailing q is a prime: sq is s'."""

    def __missing__(self, name):
        plain = name.rstrip("q")
        spelling = plain + "'" * (len(name) - len(plain)) if plain else name
        return {"sin": sp.sin, "cos": sp.cos, "sqrt": sp.sqrt, "half": sp.Rational(1, 2)}.get(
            name, symbol(prefixed(plain) or spelling)
        )


def prefixed(plain):
    """Ds is delta s, Lc is the multiplier of the row c."""
    named = {"D": virtual_name, "L": multiplier_name}.get(plain[:1])
    return named(plain[1:]) if named else ""


def expression(formula):
    """A SymPy expression of this test's own text: s'' is sqq, delta s is Ds, a multiplier Lc."""
    return sp.sympify(eval(formula, {"__builtins__": {}}, Names()))  # noqa: S307


SLIDER = model("m_A m_B g l k l_0 c d h", "s phi x y", "F")
SHOWN = [
    # T, as the lecture prints it
    (
        "kinetic",
        "(m_A + m_B)*sq**2/2 + m_B*l**2*phiq**2/2 + m_B*l*sq*phiq*cos(phi)",
        "½ (m_A + m_B) s′² + ½ m_B l² φ′² + m_B l s′ φ′ cos φ",
    ),
    ("kinetic", "3*m_A*sq**2/4 + m_B*sq**2/2", "½ (3/2 m_A + m_B) s′²"),
    (
        "kinetic",
        "m_B*((sq + l*phiq*cos(phi))**2 + (l*phiq*sin(phi))**2)/2",
        "½ m_B (s′² + l² φ′² + 2 l s′ φ′ cos φ)",
    ),
    ("kinetic", "m_A*(xq**2 + x**2*yq**2)/2", "½ m_A (x′² + x² y′²)"),
    ("kinetic", "m_A*xq**2/2 + m_B*(xq + yq*cos(phi))**2/2", "½ m_A x′² + ½ m_B (x′ + y′ cos φ)²"),
    # V: squares are recognised, gravity is not collected over two bodies
    ("potential", "k*(s - l_0)**2/2 - m_B*g*l*cos(phi)", "½ k (s − l_0)² − m_B g l cos φ"),
    ("potential", "k*(sqrt(x**2 + y**2) - l_0)**2/2", "½ k (√(x² + y²) − l_0)²"),
    ("potential", "k*(s - x)**4/4", "¼ k (s − x)⁴"),
    ("potential", "m_A*g*l*cos(s) + m_B*g*l*cos(s) + m_B*g*h*cos(phi)",
     "(m_A + m_B) g l cos s + m_B g h cos φ"),
    ("potential", "m_A*g*(l*cos(s) + h*cos(phi))", "m_A g (l cos s + h cos φ)"),
    ("dissipation", "c*(xq - yq)**2/2", "½ c (x′ − y′)²"),
    # trigonometric polynomials in the shortest of their spellings
    ("motion", "l*sin(phi)**2", "l sin² φ"),
    ("motion", "l*cos(phi)**2", "l cos² φ"),
    ("motion", "l*sin(phi)*cos(phi)", "l sin φ cos φ"),
    ("motion", "l*cos(2*phi)", "l cos(2 φ)"),
    ("motion", "cos(s)*cos(phi) + sin(s)*sin(phi)", "cos(s − φ)"),
    ("motion", "cos(s)*cos(phi)", "cos s cos φ"),
    ("motion", "sin(phi - s)", "−sin(s − φ)"),
    ("motion", "sin(phi)/cos(phi)", "tan φ"),
    ("motion", "(1 - cos(phi)**2)/sin(phi)", "sin φ"),
    ("motion", "(sin(s)**2 + cos(s - phi))", "sin² s + cos(s − φ)"),
    # order of factors and of terms
    ("motion", "sin(phi)*l + s", "s + l sin φ"),
    ("motion", "-l*cos(phi) + h", "h − l cos φ"),
    ("motion", "cos(phi)*phiqq*l*m_B", "m_B l φ″ cos φ"),
    ("motion", "sqq*(m_A + m_B) + m_B*l*cos(phi)*phiqq", "(m_A + m_B) s″ + m_B l φ″ cos φ"),
    ("motion", "(m_A + m_B*l*sin(phi)**2)*phiqq", "(m_A + m_B l sin² φ) φ″"),
    # what springs and dampers do
    ("loads", "-k*s + k*l_0 - c*sq + F", "F − c s′ − k (s − l_0)"),
    ("loads", "-k*s + k*x", "k (x − s)"),
    ("loads", "-k*x*(1 - l_0/sqrt(x**2 + y**2))", "−k x (1 − l_0/√(x² + y²))"),
    ("loads", "-c*(x*xq + y*yq)/sqrt(x**2 + y**2)", "−c (x x′ + y y′)/√(x² + y²)"),
    (
        "loads",
        "k*(s - x)*(1 - l_0/sqrt((s - x)**2 + y**2))",
        "k (s − x) (1 − l_0/√((s − x)² + y²))",
    ),
    ("work", "(F - c*sq)*Ds - d*phiq*Dphi", "(F − c s′) δs − d φ′ δφ"),
    ("work", "0*s", "0"),
]  # fmt: skip


@pytest.mark.parametrize(("how", "formula", "shown"), SHOWN)
def test_a_formula_is_written_as_a_textbook_writes_it(how, formula, shown):
    form = ClosedForm().of(expression(formula))
    assert text(HOW[how](arrange.of_model(SLIDER), form)) == shown


# --- equations of motion, term for term


def row(name, algebra, **parts):
    given = {part: algebra.of(expression(formula)) for part, formula in parts.items()}
    return Equation(
        name, *(given.get(part, algebra.number(0)) for part in ("inertia", *LOADED, *RIGHT))
    )


POLAR = model("m", "R theta", "F_R F_theta", positive=("R",))
PLANE = model("m", "x y", "F_x F_y")
PENDULUM = model("m l g c", "phi", "tau")
EQUATIONS = [
    (
        SLIDER,
        "s",
        {
            "inertia": "(m_A + m_B)*sqq + m_B*l*phiqq*cos(phi) - m_B*l*phiq**2*sin(phi)",
            "elastic": "k*s",
        },
        "(m_A + m_B) s″ + m_B l φ″ cos φ − m_B l φ′² sin φ + k s = 0",
        "1",
    ),
    (
        SLIDER,
        "phi",
        {
            "inertia": "m_B*l**2*phiqq + m_B*l*sqq*cos(phi)",
            "gravity": "m_B*g*l*sin(phi)",
        },
        "l φ″ + s″ cos φ + g sin φ = 0",
        "m_B l",
    ),
    (
        SLIDER,
        "s",
        {
            "inertia": "(3*m_A*half + m_B)*sqq + m_B*l*phiqq*cos(phi) - m_B*l*phiq**2*sin(phi)",
            "elastic": "k*(s - l_0)",
            "applied": "-c*sq",
        },
        "(3/2 m_A + m_B) s″ + m_B l φ″ cos φ − m_B l φ′² sin φ + k (s − l_0) = −c s′",
        "1",
    ),
    (
        SLIDER,
        "phi",
        {
            "inertia": "m_B*l**2*phiqq + m_B*l*sqq*cos(phi)",
            "gravity": "m_B*g*l*sin(phi)",
            "applied": "-d*phiq",
        },
        "l φ″ + s″ cos φ + g sin φ = −d φ′/(m_B l)",
        "m_B l",
    ),
    (POLAR, "R", {"inertia": "m*Rqq - m*R*thetaq**2", "applied": "F_R"},
     "m (R″ − R θ′²) = F_R", "1"),
    (POLAR, "theta", {"inertia": "m*R**2*thetaqq + 2*m*R*Rq*thetaq", "applied": "R*F_theta"},
     "m (R θ″ + 2 R′ θ′) = F_θ", "R"),
    (PLANE, "x", {"inertia": "m*xqq", "applied": "F_x"}, "m x″ = F_x", "1"),
    (PLANE, "y", {"inertia": "m*yqq", "applied": "F_y"}, "m y″ = F_y", "1"),
    # an input keeps everything, friction is divided, a number common to all terms goes
    (PENDULUM, "phi", {"inertia": "m*l**2*phiqq", "gravity": "m*g*l*sin(phi)", "applied": "tau"},
     "m l² φ″ + m g l sin φ = τ".replace("g l", "l g"), "1"),
    (PENDULUM, "phi", {"inertia": "m*l**2*phiqq", "damping": "c*phiq", "gravity": "m*g*l*sin(phi)"},
     "l φ″ + c φ′/(m l) + g sin φ = 0", "m l"),
    (PENDULUM, "phi", {"inertia": "2*l*phiqq", "gravity": "4*g*sin(phi)"},
     "l φ″ + 2 g sin φ = 0", "2"),
    (PENDULUM, "phi", {"inertia": "-l*phiqq", "gravity": "g*sin(phi)"},
     "l φ″ − g sin φ = 0", "1"),
    # constraint forces: the multiplier in front, nothing divided that they do not share
    (PLANE, "x", {"inertia": "m*xqq", "reaction": "2*Lc*x"}, "m x″ = 2 λ c x", "1"),
    (PLANE, "x", {"inertia": "m*xqq", "applied": "F_x", "reaction": "-Lb + Lc*(x - y)"},
     "m x″ = F_x − λ b + λ c (x − y)", "1"),
    (PENDULUM, "phi", {"inertia": "m*l**2*phiqq", "gravity": "m*g*l*sin(phi)",
                       "reaction": "l*Lc*sin(phi) + 2*Lb*l"},
     "m (l φ″ + g sin φ) = 2 λ b + λ c sin φ", "l"),
]  # fmt: skip


@pytest.mark.parametrize(("scene", "name", "parts", "shown", "divisor"), EQUATIONS)
def test_an_equation_is_printed_as_the_lecture_prints_it(scene, name, parts, shown, divisor):
    found = arrange_equation.equation(arrange.of_model(scene), row(name, ClosedForm(), **parts))
    assert f"{text(found.left)} = {text(found.right)}" == shown
    assert text(found.divisor) == divisor


def test_nothing_that_may_vanish_is_divided_out():
    parts = {"inertia": "m*x*yqq", "gravity": "m*x*g"}
    plain = arrange.of_model(model("m g", "x y"))
    ranged = arrange.of_model(model("m g", "x y", ranges={"x": (sp.Integer(1), sp.Integer(2))}))
    zero = arrange.of_model(model("m g", "x y", m=sp.S.Zero))
    divisors = [
        text(arrange_equation.equation(arranger, row("y", ClosedForm(), **parts)).divisor)
        for arranger in (plain, ranged, zero)
    ]
    assert divisors == ["m", "m x", "1"]


# --- identities


def values_of(form, seed):
    """Random values of every symbol of a ring, by name and by symbol."""
    draw = random.Random(seed)
    symbols = [a for a in form.ring.atoms if isinstance(a, sp.Symbol) and a is not sp.pi]
    return {s: draw.uniform(0.5, 1.5) for s in symbols}


def assert_equal(shown, form, seed=1):
    """The tree's number is the form's, both at the same random point."""
    values = values_of(form, seed)
    exact = Evaluation(values, float, lambda name, *a: (
        3.141592653589793 if name == "pi" else tree.NUMERIC[name](*a)
    )).of(form)  # fmt: skip
    named = {s.name: v for s, v in values.items()} | {"pi": 3.141592653589793}
    scale = sum(abs(float(c)) for c in form.terms.values()) + 1
    assert tree.value(shown, named) == pytest.approx(exact, rel=1e-9, abs=1e-9 * scale)


def forms_of(derivation):
    """(how, form) of everything that a page shows."""
    yield "kinetic", derivation.kinetic_energy
    yield "potential", derivation.potential_energy
    yield "dissipation", derivation.dissipation_function
    for kind in ("kinetic", "potential", "dissipation"):
        for share in getattr(derivation, kind):
            yield kind, share.value
    for share in derivation.virtual_work:
        yield "work", share.value
    for step in derivation.rows:
        for part in (step.momentum, step.momentum_rate, step.slope, step.dissipation):
            yield "motion", part
        yield "loads", step.force
    for place in derivation.places:
        for part in place.position + place.velocity:
            yield "motion", part
    for entry in (m for line in derivation.matrix.mass_matrix for m in line):
        yield "motion", entry
    for rate in derivation.rates:
        yield "motion", rate
    yield from forms_of_constraints(derivation)


def forms_of_constraints(derivation):
    """The same of the cards and of the matrix form of a linked scene."""
    for link in derivation.constraints:
        yield "work", link.virtual
        for part in (link.rate, link.gamma, *link.jacobian):
            yield "motion", part


@pytest.mark.parametrize("name", FILES)
def test_what_is_displayed_equals_the_closed_form(name):
    derivation = derivation_of(name)
    arranger = arrange.of_model(derivation.model)
    for how, form in forms_of(derivation):
        assert_equal(HOW[how](arranger, form), form)


@pytest.mark.parametrize("name", FILES)
def test_an_equation_times_its_divisor_is_the_equation(name):
    derivation = derivation_of(name)
    arranger = arrange.of_model(derivation.model)
    for equation in derivation.equations:
        found = arrange_equation.equation(arranger, equation)
        left = normal.total(
            equation.inertia.ring, [equation.inertia, *(getattr(equation, p) for p in LOADED)]
        )
        right = [part for name in RIGHT if (part := getattr(equation, name))]
        residual = left - normal.total(equation.inertia.ring, right)
        shown = tree.product(
            Fraction(1),
            (found.divisor, tree.Sum((found.left, tree.negated(found.right)))),
        )
        values = {s.name: v for s, v in values_of(residual, 2).items()}
        values["pi"] = 3.141592653589793
        sign = 1 if tree.value(shown, values) * number_of(residual, 2) >= 0 else -1
        assert_equal(shown if sign > 0 else tree.negated(shown), residual, 2)


def number_of(form, seed):
    values = values_of(form, seed)
    return Evaluation(values, float, lambda name, *a: (
        3.141592653589793 if name == "pi" else tree.NUMERIC[name](*a)
    )).of(form)  # fmt: skip


ATOMS = [symbol(n) for n in ("m", "l", "s", "phi", "s'", "phi'", "s''", "phi''")]
ANGLES = [symbol("phi"), symbol("s")]


@st.composite
def terms(draw):
    """A random term: a rational number, powers, a few sines and cosines."""
    number = sp.Rational(draw(st.integers(-6, 6)), draw(st.integers(1, 4)))
    powers = [draw(st.sampled_from(ATOMS)) ** draw(st.integers(-1, 2)) for _ in range(3)]
    waves = [
        draw(st.sampled_from([sp.sin, sp.cos]))(
            sum(draw(st.integers(-2, 2)) * a for a in ANGLES) + sp.pi * draw(st.integers(0, 1)) / 3
        )
        for _ in range(draw(st.integers(0, 3)))
    ]
    return sp.Mul(number, *powers, *waves, evaluate=True)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.lists(terms(), min_size=1, max_size=6), st.sampled_from(list(HOW)))
def test_any_closed_form_is_displayed_truly(parts, how):
    form = ClosedForm().of(sp.Add(*parts))
    scene = model("m l", "s phi")
    assert_equal(HOW[how](arrange.of_model(scene), form), form)


def test_the_order_is_that_of_declaration_not_of_arrival():
    """The same sum is displayed alike, however the ring met its atoms."""
    formulas = ["m_B*l*phiqq*cos(phi)", "(m_A + m_B)*sqq", "k*s", "-m_B*l*phiq**2*sin(phi)"]
    shown = set()
    for turn in range(len(formulas)):
        algebra = ClosedForm()
        turned = formulas[turn:] + formulas[:turn]
        form = normal.total(algebra.ring, [algebra.of(expression(f)) for f in turned])
        shown.add(text(arrange.motion(arrange.of_model(SLIDER), form)))
    assert shown == {"(m_A + m_B) s″ + m_B l φ″ cos φ − m_B l φ′² sin φ + k s"}


def test_a_prescribed_motion_stands_behind_the_coordinates():
    w = Prescribed("w", symbol("w"), symbol("w'"), symbol("w''"), sp.sin(sp.Symbol("t", real=True)))
    scene = Model("scene", {}, "line", (), coordinates=(coordinate("x"),), prescribed=(w,))
    form = ClosedForm().of(expression("wqq + xqq + w - x"))
    assert text(arrange.motion(arrange.of_model(scene), form)) == "x″ + w″ + w − x"
