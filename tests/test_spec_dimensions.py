import pytest
from bad_specs import BASE

from eomgen import spec
from eomgen.dimension import ENERGY, FORCE, LENGTH, MASS, NONE, TIME
from eomgen.errors import SpecError
from eomgen.spec.units import POWER

UNITLESS = BASE.replace(" kg", "").replace("1 m,", "1,").replace(" m/s^2", "")


def codes(text):
    try:
        spec.read(text, "x.yaml")
    except SpecError as error:
        return [fault.code for fault in error.faults]
    return []


def dimension_of(text, section, name):
    found = getattr(spec.read(text, "x.yaml"), section)
    return next(r for r in found if r.name == name).description.dimension


def output(formula):
    return BASE + f'outputs: {{a: "{formula}"}}\n'


@pytest.mark.parametrize(
    ("formula", "dimension"),
    [
        ("m", MASS),
        ("phi", NONE),
        ("l*phi'", LENGTH / TIME),
        ("l*phi''", LENGTH / TIME**2),
        ("der(der(phi))", NONE / TIME**2),
        ("m*g*l*(1 - cos(phi))", ENERGY),
        ("sqrt(g/l)*t", NONE),
        ("(g/l)^(1/2)", NONE / TIME),
        ("l^(2^2)/l^3", LENGTH),
        ("2^phi", NONE),
        ("abs(l) + 0", LENGTH),
        ("0 - max(m*g, 0, m*l/t^2)", FORCE),
        ("atan2(l, g*t^2)", NONE),
        ("sign(m*g)*m*g*l*phi'", POWER),
        ("pi*l", LENGTH),
    ],
)
def test_dimension_follows_from_the_formula(formula, dimension):
    assert dimension_of(output(formula), "outputs", "a") == dimension


@pytest.mark.parametrize(
    "formula",
    [
        "m + l",
        "m + 1",
        "l - phi",
        "sin(l)",
        "exp(t)",
        "2^l",
        "l^phi",
        "max(m, l)",
        "atan2(m, l)",
        "l*phi' + l*phi''",
        "sqrt(m + l)",
        "m*(l + g)/(l + g)",
        "(m*g + m*l)^0",
    ],
)
def test_terms_that_disagree_are_refused(formula):
    assert codes(output(formula)) in (["E403"], ["E404"], ["E403", "E403"])


def test_zero_fits_anything():
    assert not codes(output("m*g + 0"))
    assert not codes(BASE.replace("[0, -g]", "0"))
    assert codes(BASE.replace("[0, -g]", "[0, 1]")) == ["E404"]


def test_dimension_of_a_parameter_without_unit_is_inferred():
    text = BASE.replace("m: 2 kg", "m: {about: mass}, a: {about: x}, b: {about: y}")
    text += "outputs: {f: m*g + a*phi', h: a + b*l}\n"
    assert dimension_of(text, "parameters", "m") == MASS
    assert dimension_of(text, "parameters", "a") == FORCE * TIME
    assert dimension_of(text, "parameters", "b") == FORCE * TIME / LENGTH
    assert codes(text.replace("a + b*l", "a + m*g")) == ["E403"]


def test_dimension_that_nothing_forces_stays_unknown():
    text = BASE.replace("m: 2 kg", "m: 2 kg, a: {about: x}, b: {about: y}")
    text += "outputs: {f: a*b*m}\n"
    assert dimension_of(text, "parameters", "a") is None


def test_without_units_nothing_is_checked():
    assert not codes(UNITLESS + "outputs: {a: m + l*phi'}\n")
    assert not codes(UNITLESS + "initial: {phi: 20 deg}\n")
    model = spec.read(UNITLESS, "x.yaml")
    assert not model.with_units
    assert all(p.description.dimension is None for p in model.parameters)


def test_one_unit_switches_the_check_on():
    assert codes(UNITLESS.replace("m: 2", "m: 2 kg"))


@pytest.mark.parametrize(
    ("line", "allowed"),
    [
        ("springs: [{along: phi, stiffness: kt}]", True),
        ("springs: [{along: phi, stiffness: kt, free_length: 20 deg}]", True),
        ("springs: [{along: phi, stiffness: kx}]", False),
        ("springs: [{along: l*phi, stiffness: kx, free_length: l}]", True),
        ("springs: [{along: l*phi, stiffness: kx, free_length: 1}]", False),
        ("springs: [{along: l*phi, law: 'm*g*s/l'}]", True),
        ("springs: [{along: l*phi, law: 'm*g*s'}]", False),
        ("springs: [{along: phi, energy: 'm*g*l*s^2'}]", True),
        ("springs: [{along: phi, energy: 'm*g*s^2'}]", False),
        ("dampers: [{along: phi, damping: ct}]", True),
        ("dampers: [{along: phi, damping: cx}]", False),
        ("dampers: [{along: l*phi, law: 'm*v^2/l'}]", True),
        ("dampers: [{along: l*phi, law: 'm*v'}]", False),
        ("energy: {dissipation: m*l^2*phi'^2*sqrt(g/l)}", True),
        ("energy: {dissipation: m*l^2*phi'^2}", False),
        ("initial: {phi: 20 deg, phi': 3 rpm}", True),
        ("initial: {phi: 2 m}", False),
        ("initial: {phi': 0}", True),
        ("range: {phi: [-1 rad, 90 deg]}", True),
        ("range: {phi: [0, 2 s]}", False),
        ("prescribed: {w: l*sin(t/(2*t))}", True),
        ("prescribed: {w: l*sin(t)}", False),
        ("speeds: {u: {formula: l*phi', unit: m/s}}", True),
        ("speeds: {u: {formula: l*phi', unit: m}}", False),
        ("expect: {equations: [l*phi'' + g*sin(phi) = 0]}", True),
        ("expect: {equations: [l*phi'' = -g*sin(phi)/l]}", False),
        ("expect: {equilibrium: {phi: 180 deg}}", True),
        ("expect: {equilibrium: {phi: l}}", False),
        ("expect: {conserved: m*l^2*phi'^2/2 - m*g*l*cos(phi)}", True),
        ("expect: {conserved: m*l^2*phi'^2/2 - m*g*cos(phi)}", False),
    ],
)
def test_every_key_has_its_dimension(line, allowed):
    constants = "kt: 2 N*m/rad, kx: 2 N/m, ct: 2 N*m*s, cx: 2 N*s/m"
    found = codes(BASE.replace("l: 1 m", f"{constants}, l: 1 m") + line + "\n")
    assert found == [] if allowed else found in (["E403"], ["E404"])


def test_long_chains_are_inferred_in_one_go():
    names = [f"a{i}" for i in range(400)]
    chain = ", ".join(f"{a}: {b}*2" for a, b in zip(names, names[1:], strict=False))
    text = BASE.replace("l: 1 m", f"{chain}, a399: 3 m, l: 1 m")
    assert dimension_of(text, "parameters", "a0") == LENGTH
