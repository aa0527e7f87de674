"""Programs written by hand, as fixtures of the code targets."""

import random
from fractions import Fraction

import sympy as sp

from eomgen.program import (
    IN_MOTION,
    OPERATORS,
    Apply,
    Assign,
    Function,
    Number,
    Program,
    Read,
    RequirePositive,
    Solve,
    Value,
    Variable,
)

TIME = Read("time", 0)
TOO_LARGE_TO_UNROLL = 14


def n(value, denominator=1):
    return Number(Fraction(value, denominator))


def op(operator, *operands):
    return Apply(operator, operands)


def add(a, b):
    return op("add", a, b)


def sub(a, b):
    return op("subtract", a, b)


def mul(a, b):
    return op("multiply", a, b)


def div(a, b):
    return op("divide", a, b)


def program(name, functions, **parts):
    """A program with empty tables where `parts` gives none."""
    tables = dict.fromkeys(("coordinates", "speeds", "inputs", "parameters", "outputs"), ())
    return Program(name, "A */ \"title\" \\ of\nour own /* ??/", "0" * 64, "0.1.0",
                   **(tables | parts), functions=functions)  # fmt: skip


def slider_pendulum():
    """System 11 of the lecture with a force: every standard function, LDL' unrolled."""
    s, phi, ds, dphi = (Read("state", i) for i in range(4))
    force = Read("inputs", 0)
    m_a, m_b, length, k, g = (Read("parameters", i) for i in range(5))
    m12 = mul(mul(m_b, length), op("cos", phi))
    m22 = mul(m_b, op("power", length, n(2)))
    h = op("negate", mul(mul(mul(m_b, length), op("power", dphi, n(2))), op("sin", phi)))
    q_s = sub(force, mul(k, s))
    q_phi = op("negate", mul(mul(mul(m_b, g), length), op("sin", phi)))
    common = (Assign("a", m12), Assign("d", m22))
    a, d = Value("a"), Value("d")
    solved = (
        *common,
        RequirePositive(d, d),
        Assign("r", sub(q_s, h)),
        Assign("factor", div(a, d)),
        Assign("pivot", sub(add(m_a, m_b), mul(Value("factor"), a))),
        RequirePositive(Value("pivot"), add(m_a, m_b)),
        Assign("b", q_phi),
        Assign("x", div(sub(Value("r"), mul(Value("factor"), Value("b"))), Value("pivot"))),
        Assign("y", div(sub(Value("b"), mul(a, Value("x"))), d)),
    )
    x, y = Value("x"), Value("y")
    speed = op("power", ds, n(2))
    bob = add(
        add(speed, mul(mul(n(2), mul(length, op("cos", phi))), mul(ds, dphi))),
        op("power", mul(length, dphi), n(2)),
    )
    kinetic = mul(n(1, 2), add(mul(m_a, speed), mul(m_b, bob)))
    potential = sub(
        mul(mul(n(1, 2), k), op("power", s, n(2))), mul(mul(mul(m_b, g), length), op("cos", phi))
    )
    functions = (
        Function("mass_matrix", "M", (2, 2), common, (add(m_a, m_b), a, a, d)),
        Function("bias", "h", (2,), (), (h, n(0))),
        Function("generalized_forces", "Q", (2,), (), (q_s, q_phi)),
        Function("accelerations", "u' = M^-1 (Q - h)", (2,), solved, (x, y)),
        Function("state_derivative", "(q', u')", (4,), solved, (ds, dphi, x, y)),
        Function("energy", "kinetic and potential energy [J]", (2,), (), (kinetic, potential)),
        Function("outputs", "outputs", (1,), (), (add(s, mul(length, op("sin", phi))),)),
    )
    return program(
        "slider_pendulum",
        functions,
        coordinates=(
            Variable("s", "m", "slider", sp.Rational(1, 10)),
            Variable("phi", "", "angle", sp.pi / 3),
        ),
        speeds=(Variable("s'", "m s^-1", "", sp.S.Zero), Variable("phi'", "s^-1", "", sp.S.Zero)),
        inputs=(Variable("F", "kg m s^-2", "push"),),
        parameters=(
            Variable("m_A", "kg", "slider */ mass", sp.Integer(2)),
            Variable("m_B", "kg", "bob mass", sp.Rational(1, 2)),
            Variable("l", "m", "rod length", sp.Rational(4, 5)),
            Variable("k", "kg s^-2", "", sp.Integer(120)),
            Variable("g", "m s^-2", "", sp.Rational(981, 100)),
        ),
        outputs=(Variable("x_B", "m", "bob"),),
    )  # fmt: skip


def operators():
    """Every operator of the language, each result one of them, and trees of awkward shape."""
    x, y = Read("state", 0), Read("state", 1)
    results = tuple(op(o, *(x, y)[:count]) for o, count in OPERATORS.items() if o != "power")
    whole = tuple(map(n, (0, 1, 2, 3, 7, 10, -1, -4, 200)))
    exponents = (*whole, n(1, 2), n(-3, 2), n(1, 3), x)
    powers = tuple(op("power", add(y, n(3)), e) for e in exponents)
    awkward = (
        sub(x, sub(y, n(3))),
        sub(sub(x, y), n(3)),
        div(x, div(y, n(3))),
        div(x, mul(y, n(3))),
        div(div(x, y), n(3)),
        mul(x, add(y, TIME)),
        sub(x, op("negate", y)),
        sub(x, n(-1, 3)),
        op("negate", op("negate", x)),
        op("negate", add(x, y)),
        op("negate", mul(x, y)),
        mul(op("negate", x), n(-7)),
        mul(n(-7), op("negate", n(-1, 10))),
        add(n(10**30), n(1, 10**30)),
        n(2, 3),
    )
    both = results + powers + awkward
    function = Function("outputs", "every operator", (len(both),), (), both)
    return program(
        "operators",
        (function,),
        coordinates=(Variable("x"),),
        speeds=(Variable("x'"),),
        outputs=tuple(Variable(f"o{i}") for i in range(len(both))),
    )


AWKWARD_NAMES = (
    "I", "lambda", "double", "y0", "gamma", "class", "p", "result", "state", "inputs", "in", "np",
    "R", "REAL", "SIN", "linux", "l", "O", "parameters", "x'", "x_dot", "_y", "None", "NAN", "sin",
)  # fmt: skip


def awkward_names(name, as_parameters):
    """Names that one target or the other reserves, as parameters or as coordinates and inputs."""
    plain = tuple(f"c{i}" for i in range(len(AWKWARD_NAMES)))
    moving, constant = (plain, AWKWARD_NAMES) if as_parameters else (AWKWARD_NAMES, plain)
    reads = [Read("parameters", i) for i in range(len(constant))]
    reads += [Read("state", i) for i in range(20)]
    reads += [Read("inputs", i) for i in range(len(moving) - 20)]
    total, statements = n(1), []
    for i, read in enumerate(reads):
        value = AWKWARD_NAMES[i] if i < len(AWKWARD_NAMES) else f"v{i}"
        statements.append(Assign(value, add(mul(total, n(1, 3)), read)))
        total = Value(value)
    named = [Variable(label, "m") for label in moving]
    return program(
        name,
        (Function("outputs", "a sum", (1,), tuple(statements), (add(total, TIME),)),),
        coordinates=tuple(named[:10]),
        speeds=tuple(named[10:20]),
        inputs=tuple(named[20:]),
        parameters=tuple(Variable(a, "m", "", sp.Integer(i - 3)) for i, a in enumerate(constant)),
    )


def open_parameters():
    """Two parameters without a value among four, and no initial state."""
    a, b, c, d = (Read("parameters", i) for i in range(4))
    results = (mul(sub(a, b), sub(c, d)), Read("state", 1))
    return program(
        "open-parameters",
        (Function("bias", "of open parameters", (2,), (), results),),
        coordinates=(Variable("q"),),
        speeds=(Variable("q'"),),
        parameters=(Variable("a", "", "", sp.Integer(1)), Variable("b"),
                    Variable("c", "", "", sp.pi), Variable("lambda")),
    )  # fmt: skip


def chain(size=TOO_LARGE_TO_UNROLL):
    """size masses on springs with a full mass matrix m + diagonal, solved in a loop."""
    mass, q = Read("parameters", 0), [Read("state", i) for i in range(size)]
    matrix = tuple(
        add(n(j + 1, 2 * i + 3), add(mass, op("power", op("sin", q[i]), n(2))))
        if i == j else op("divide", op("cos", sub(q[i], q[j])), n(3 + i + j))
        for i in range(size) for j in range(i + 1)
    )  # fmt: skip
    right = tuple(sub(TIME, op("sin", x)) for x in q)
    names = tuple(f"u{i}" for i in range(size))
    statements = (Solve(names, matrix, right),)
    some = tuple(Value(name) for name in names[1:])  # the first is not read
    columns = (*right, *(mul(x, x) for x in q))
    both = tuple(f"w{i}" for i in range(2 * size))
    functions = (
        Function("accelerations", "u'", (size - 1,), statements, some),
        Function(
            "columns",
            "two right sides",
            (2, size),
            (Solve(both, matrix, columns),),
            tuple(Value(name) for name in both),
        ),
        Function("nothing", "no results", (0,), (), ()),
    )
    return program(
        "chain",
        functions,
        coordinates=tuple(Variable(f"q{i}") for i in range(size)),
        speeds=tuple(Variable(f"q{i}'") for i in range(size)),
        parameters=(Variable("m", "kg", "", sp.Integer(5)),),
    )


def in_motion():
    """A function of chosen accelerations, and one that takes them without reading them."""
    q, u, a, force = (Read(*r) for r in (("state", 0), ("state", 1), ("accelerations", 0),
                                         ("inputs", 0)))  # fmt: skip
    mass = Read("parameters", 0)
    needed = sub(add(mul(mass, a), mul(op("sin", q), u)), force)
    return program(
        "in_motion",
        (
            Function("inverse_dynamics", "tau", (1,), (), (needed,), IN_MOTION),
            Function("inverse_dynamics_jacobian", "constant", (1,), (), (mass,), IN_MOTION),
        ),
        coordinates=(Variable("q"),),
        speeds=(Variable("q'"),),
        inputs=(Variable("F"),),
        parameters=(Variable("m", "kg", "", sp.Integer(5)),),
    )


def limbs(count=4):
    """Masses on springs that hang on one point, alike but for their numbers: pivots in lanes."""
    q, u = ([Read("state", start + i) for i in range(count)] for start in (0, count))
    k, m = ([Read("parameters", start + i) for i in range(count)] for start in (0, count))
    inertias = [add(mul(m[i], op("cos", q[i])), mul(q[i], q[i])) for i in range(count)]
    forces = [sub(mul(mul(k[i], q[i]), u[i]), div(op("sin", q[i]), k[i])) for i in range(count)]
    total = Value("f0")
    for i in range(1, count):
        total = add(total, Value(f"f{i}"))
    statements = (
        *(Assign(f"m{i}", inertias[i]) for i in range(count)),
        *(RequirePositive(Value(f"m{i}"), add(m[i], mul(k[i], q[i]))) for i in range(count)),
        *(Assign(f"f{i}", forces[i]) for i in range(count)),
        Assign("total", total),
    )
    share = mul(Value("total"), Read("parameters", 2 * count))
    moved = [div(sub(Value(f"f{i}"), share), Value(f"m{i}")) for i in range(count)]
    swung = [mul(sub(moved[i], u[i]), add(op("sqrt", mul(q[i], m[i])), u[i])) for i in range(count)]
    return program(
        "limbs",
        (Function("accelerations", "u'", (count + 1,), statements, (*swung, Value("total"))),),
        coordinates=tuple(Variable(f"q{i}") for i in range(count)),
        speeds=tuple(Variable(f"q{i}'") for i in range(count)),
        parameters=tuple(
            Variable(f"{name}{i}", "", "", sp.Rational(i + start, 7))
            for name, start in (("k", 2), ("m", 9))
            for i in range(count)
        )
        + (Variable("g", "", "", sp.Rational(3)),),
    )


PROGRAMS = {
    p.name: p
    for p in (
        slider_pendulum(),
        operators(),
        awkward_names("int", as_parameters=True),
        awkward_names("lambda", as_parameters=False),
        open_parameters(),
        chain(),
        in_motion(),
        limbs(),
    )
}


def arguments(program, seed, function=None):
    """A random t, state, inputs, parameters at which every fixture is defined.

    A function in motion has accelerations behind the state.
    """
    rng = random.Random(f"{program.name} {seed}")

    def draw(variables):
        return [rng.uniform(0.1, 0.9) for _ in variables]

    state = draw(program.coordinates + program.speeds)
    parameters = [rng.uniform(1, 3) for _ in program.parameters]
    rest = (draw(program.inputs), parameters)
    if function is not None and function.arguments == IN_MOTION:
        rest = (draw(program.speeds), *rest)
    return rng.random(), state, *rest
