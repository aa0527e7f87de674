"""Wrong and hostile spec files with every fault that they must be refused with."""

from typing import NamedTuple

BASE = """eom: 1
system: Test
space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 1 m, g: 9.81 m/s^2}
coordinates: {phi: rad}
points:
  P: l*[sin(phi), -cos(phi)]
bodies:
  bob: {mass: m, at: P}
"""
LINE = """eom: 1
system: Test
space: line
gravity: 0
coordinates: {x: }
bodies: {b: {mass: 1, at: x}}
"""
SOLID = (
    BASE.replace("plane", "solid")
    .replace("[0, -g]", "[0, 0, -g]")
    .replace("-cos(phi)]", "-cos(phi), 0]")
)
P = "l*[sin(phi), -cos(phi)]"


class Bad(NamedTuple):
    """A file and its faults as `line:column code`, all of them, in order."""

    name: str
    text: str | bytes
    faults: str


def changed(old, new):
    """The plane pendulum with one piece replaced."""
    assert old in BASE
    return BASE.replace(old, new, 1)


def solid(old, new):
    """The same in solid space."""
    assert old in SOLID
    return SOLID.replace(old, new, 1)


def extended(text):
    """The plane pendulum with more lines below."""
    return BASE + text + "\n"


BAD = (
    Bad("empty", "", "1:1 E107"),
    Bad("blank", "  \n\n", "1:1 E107"),
    Bad("only a comment", "# nothing\n", "1:1 E107"),
    Bad("binary", bytes(range(256)), "3:115 E101"),
    Bad("not UTF-8", BASE.replace("Test", "Tést").encode("latin-1"), "2:10 E101"),
    Bad("UTF-16", BASE.encode("utf-16"), "1:1 E101"),
    Bad("NUL", changed("Test", "Te\0st"), "2:11 E101"),
    Bad("escape character", changed("Test", "\x1b[31mTest"), "2:9 E101"),
    Bad("ten megabytes", "a: b\n" * 2_000_000, "1:1 E102"),
    Bad("100000 open brackets", "[" * 100_000, "1:41 E108"),
    Bad("100000 open braces", "{a: " * 50_000, "1:161 E108"),
    Bad("deep blocks", "\n".join(" " * i + "a:" for i in range(200)), "41:41 E108"),
    Bad("100000 dashes", "- " * 60_000, "1:81 E108"),
    Bad("too many values", "[" + "a," * 60_000 + "]", "1:40000 E108"),
    Bad("alias bomb", "a: &a [x, x]\nb: &b [*a, *a]\nc: [*b, *b]\n", "1:4 E106"),
    Bad("alias", extended("initial: {phi: *x}"), "11:16 E106"),
    Bad("merge key", changed("system: Test", "<<: {system: Test}"), "2:1 E106"),
    Bad(
        "python tag",
        changed("system: Test", "system: !!python/object/apply:os.system [ls]"),
        "2:9 E106",
    ),
    Bad("string tag", changed("Test", "!!str Test"), "2:9 E106"),
    Bad("second document", BASE + "---\neom: 1\n", "11:1 E107"),
    Bad("tab", changed("  P:", "\tP:"), "8:1 E103"),
    Bad("unclosed brace", changed("{phi: rad}", "{phi: rad"), "7:7 E103"),
    Bad("unclosed quote", changed("Test", '"Test'), "2:9 E103"),
    Bad("duplicate key", changed("space: plane", "space: plane\nspace: solid"), "4:1 E105"),
    Bad("duplicate parameter", changed("l: 1 m", "l: 1 m, m: 3 kg"), "5:31 E105"),
    Bad("a list as key", changed("{phi: rad}", "{[phi]: rad}"), "6:15 E109"),
    Bad("a list at the top", "- eom: 1\n", "1:1 E109"),
    Bad("a text at the top", "hello\n", "1:1 E109"),
    Bad("unknown key", extended("colour: red"), "11:1 E104"),
    Bad("misspelt key", changed("gravity:", "gravty:"), "4:1 E104"),
    Bad("misspelt key of a body", changed("{mass: m", "{mas: m"), "10:9 E104"),
    Bad("missing eom", changed("eom: 1\n", ""), "1:1 E110"),
    Bad("wrong eom", changed("eom: 1", "eom: 2"), "1:6 E111"),
    Bad("missing space", changed("space: plane\n", ""), "1:1 E110"),
    Bad("wrong space", changed("plane", "plan"), "3:8 E111"),
    Bad("missing system", changed("system: Test\n", ""), "1:1 E110"),
    Bad("missing gravity", changed("gravity: [0, -g]\n", ""), "1:1 E110"),
    Bad("missing coordinates", changed("coordinates: {phi: rad}\n", ""), "1:1 E110"),
    Bad(
        "list of parameters", changed("{m: 2 kg, l: 1 m, g: 9.81 m/s^2}", "[m, l, g]"), "5:13 E109"
    ),
    Bad("bodies as text", changed("bodies:\n  bob: {mass: m, at: P}", "bodies: bob"), "9:9 E109"),
    Bad("body without place", changed(", at: P", ""), "10:3 E112"),
    Bad("body without mass", changed("mass: m, ", ""), "10:8 E110"),
    Bad("body placed twice", changed("at: P", "at: P, rod: [P, P]"), "10:3 E112"),
    Bad("empty formula", changed("at: P", "at: "), "10:18 E109"),
    Bad("positive maybe", changed("m: 2 kg", "m: {value: 2 kg, positive: yes}"), "5:41 E111"),
    Bad("dof in words", extended("expect: {dof: one}"), "11:15 E111"),
    Bad("range of one", extended("range: {phi: [1]}"), "11:14 E109"),
    Bad("import", changed("at: P", 'at: \'[__import__("os").system("ls"), 0]\''), "10:35 E201"),
    Bad("attribute", changed("mass: m", "mass: m.__class__"), "10:16 E201"),
    Bad("power tower", changed("mass: m", "mass: m*2**9**9**9"), "10:23 E202"),
    Bad("power chain", changed("mass: m", "mass: m*((2^64)^64)^64"), "10:18 E202"),
    Bad("huge exponent", changed("l: 1 m", "l: 1e999999999 m"), "5:26 E202"),
    Bad("31 digits", changed("l: 1 m", "l: -1." + "2" * 30 + " m"), "5:26 E202"),
    Bad("31 digits in a formula", changed("P: l*", "P: 1." + "2" * 30 + "*l*"), "8:6 E202"),
    Bad(
        "LaTeX that is no name",
        changed("{phi: rad}", r"{phi: {unit: rad, latex: '\input{x}'}}"),
        "6:40 E516",
    ),
    Bad("LaTeX of a parameter", changed("m: 2 kg", "m: {value: 2 kg, latex: m_}"), "5:38 E516"),
    Bad("400 digits", changed("l: 1 m", "l: " + "9" * 400 + " m"), "5:26 E202"),
    Bad("1e400", changed("mass: m", "mass: m*1e400"), "10:17 E202"),
    Bad("long formula", changed("mass: m", "mass: " + "m+" * 1500 + "m"), "10:15 E202"),
    Bad("many tokens", changed("mass: m", "mass: " + "m+" * 400 + "m"), "10:515 E202"),
    Bad("deep brackets", changed("mass: m", "mass: " + "(" * 60 + "m" + ")" * 60), "10:66 E202"),
    Bad("signs", changed("mass: m", "mass: " + "-" * 400 + "m"), "10:67 E202"),
    Bad("deep power", changed("mass: m", "mass: m" + "^1" * 100), "10:117 E202"),
    Bad(".nan", changed("l: 1 m", "l: .nan"), "5:26 E201"),
    Bad(".inf", changed("l: 1 m", "l: .inf"), "5:26 E201"),
    Bad("nan", changed("mass: m", "mass: nan"), "10:15 E301"),
    Bad("oo", changed("mass: m", "mass: oo"), "10:15 E301"),
    Bad("zoo", changed("mass: m", "mass: m/(l-l)"), "10:18 E203"),
    Bad("one over zero", changed("l: 1 m", "l: 1/0"), "5:26 E203"),
    Bad("log of zero", changed("mass: m", "mass: m*log(0)"), "10:17 E203"),
    Bad("root of minus one", changed("mass: m", "mass: m*sqrt(-1)"), "10:17 E203"),
    Bad("asin of two", changed("mass: m", "mass: m*asin(2)"), "10:17 E203"),
    Bad("unclosed vector", changed(P, "l*[sin(phi), -cos(phi)"), "8:28 E201"),
    Bad("unclosed call", changed(P, "l*[sin(phi, -cos(phi)]"), "8:27 E201"),
    Bad("comma in flow", changed("mass: m", "mass: max(m, m)"), "10:20 E201, 10:22 E104"),
    Bad("missing operator", changed(P, "2 l*[sin(phi), -cos(phi)]"), "8:8 E201"),
    Bad("unknown function", changed("sin(phi)", "sine(phi)"), "8:9 E204"),
    Bad("function without argument", changed("sin(phi)", "sin"), "8:9 E204"),
    Bad("two arguments", changed("sin(phi)", "sin(phi, 1)"), "8:9 E204"),
    Bad("third derivative", extended("outputs: {j: phi'''}"), "11:14 E204"),
    Bad("derivative of a sum", extended("outputs: {j: der(phi + 1)}"), "11:14 E204"),
    Bad("minus sign of print", changed("-cos", "−cos"), "8:19 E201"),
    Bad("question mark", changed(P, "l*[?, 1]"), "8:9 E201"),
    Bad("equation as formula", changed("mass: m", "mass: m = 2"), "10:17 E205"),
    Bad("claim without equation", extended("expect: {equations: [phi'']}"), "11:27 E205"),
    Bad("inequality as claim", extended("expect: {equations: [phi'' >= 0]}"), "11:22 E205"),
    Bad("unknown name", changed("sin(phi)", "sin(phy)"), "8:13 E301"),
    Bad("unknown parameter", changed("mass: m", "mass: mm"), "10:15 E301"),
    Bad("I is no unit", changed("mass: m", "mass: m*I"), "10:17 E301"),
    Bad("lambda", changed("mass: m", "mass: m*lambda"), "10:17 E301"),
    Bad("rate in a position", changed("sin(phi)", "sin(phi')"), "8:13 E302"),
    Bad("rate of a parameter", changed("mass: m", "mass: m'"), "10:15 E302"),
    Bad("coordinate in a mass", changed("mass: m", "mass: m*cos(phi)"), "10:21 E302"),
    Bad(
        "input in a position",
        changed("P: l*[sin(phi)", "P: F*[sin(phi)") + "inputs: {F: m}\n",
        "8:6 E302",
    ),
    Bad(
        "acceleration in a force",
        extended("forces: [{on: P, force: [m*l*phi'', 0]}]"),
        "11:30 E302",
    ),
    Bad("time in a parameter", changed("l: 1 m", "l: 1*t"), "5:28 E302"),
    Bad("name twice", extended("inputs: {m: N}"), "11:10 E303"),
    Bad("name t", changed("{phi: rad}", "{phi: rad, t: m}"), "6:25 E304"),
    Bad("name sin", changed("l: 1 m", "l: 1 m, sin: 2"), "5:31 E304"),
    Bad("name pi", changed("l: 1 m", "l: 1 m, pi: 3"), "5:31 E304"),
    Bad("name with dash", changed("l: 1 m", "l: 1 m, a-b: 2"), "5:31 E304"),
    Bad("name with prime", changed("l: 1 m", "l: 1 m, a': 2"), "5:31 E304"),
    Bad("output takes a name", extended("outputs: {m: phi}"), "11:11 E303"),
    Bad("cyclic parameters", changed("l: 1 m", "l: 1 m, a: b*2, b: a/2"), "5:34 E305"),
    Bad("parameter of itself", changed("l: 1 m", "l: 1 m, a: a + 1"), "5:34 E305"),
    Bad("force on nothing", extended("forces: [{on: Q, force: [1, 0]}]"), "11:15 E301"),
    Bad("moment on a point", extended("moments: [{on: P, moment: 0}]"), "11:16 E306"),
    Bad(
        "spring to a parameter",
        extended("springs: [{between: [P, m], stiffness: 1, free_length: 0}]"),
        "11:25 E306",
    ),
    Bad("force from itself", extended("forces: [{on: P, from: P, force: [0, 0]}]"), "11:24 E507"),
    Bad("unknown unit", changed("2 kg", "2 kgg"), "5:19 E401"),
    Bad("unit of nothing", changed("2 kg", "2 kg*"), "5:22 E402"),
    Bad("unit power", changed("2 kg", "2 kg^99"), "5:21 E402"),
    Bad("unit bomb", changed("2 kg", "2 m**9**9**9"), "5:23 E402"),
    Bad("unit import", changed("2 kg", '2 __import__("os")'), "5:30 E201"),
    Bad("ambiguous unit", changed("m/s^2", "m/s s"), "5:43 E402"),
    Bad("celsius", changed("2 kg", "2 degC"), "5:19 E402"),
    Bad("mass in metres", changed("2 kg", "2 m"), "10:15 E404"),
    Bad("length without unit", changed("l: 1 m", "l: 1"), "8:6 E404"),
    Bad("sum of kilograms and metres", changed("mass: m", "mass: m + l"), "10:19 E403"),
    Bad("sine of a length", changed("sin(phi)", "sin(l)"), "8:13 E404"),
    Bad("derived unit", changed("l: 1 m", "l: 1 m, J: {value: m*l, unit: kg*m^2}"), "5:42 E404"),
    Bad(
        "lecture's last slide",
        changed("l: 1 m", "l: 1 m, c: 2 N*m*s")
        + "expect: {equations: [l*phi'' + g*sin(phi) = -c*phi']}\n",
        "11:46 E403",
    ),
    Bad("gravity without unit", changed("9.81 m/s^2", "9.81"), "4:10 E404"),
    Bad(
        "stiffness of a torsion spring",
        extended("springs: [{along: phi, stiffness: m*g/l}]"),
        "11:35 E404",
    ),
    Bad("initial without unit", extended("initial: {phi': 2}"), "11:17 E404"),
    Bad("prefix at a coordinate", changed("{phi: rad}", "{phi: rad, s: mm}"), "6:28 E405"),
    Bad("degrees at a coordinate", changed("{phi: rad}", "{phi: deg}"), "6:20 E405"),
    Bad("unit twice", changed("m: 2 kg", "m: {value: 2 kg, unit: g}"), "5:37 E406"),
    Bad("power with a unit", changed("mass: m", "mass: m*2^l"), "10:19 E404"),
    Bad("short vector", changed("[0, -g]", "[-g]"), "4:10 E501"),
    Bad("long vector", changed(P, "l*[sin(phi), -cos(phi), 0]"), "8:8 E501"),
    Bad("scalar place", changed("at: P", "at: l"), "10:22 E502"),
    Bad("vector mass", changed("mass: m", "mass: '[m, m]'"), "10:16 E502"),
    Bad("place as a mass", changed("mass: m", "mass: m*P"), "10:17 E302"),
    Bad("product of vectors", changed("at: P", "at: P*P"), "10:22 E502"),
    Bad("over a vector", changed("at: P", "at: l/P"), "10:22 E502"),
    Bad("sine of a vector", extended("outputs: {a: 'sin([1, 2])'}"), "11:19 E502"),
    Bad("point of itself", changed(P, "P + [l, 0]"), "8:3 E503"),
    Bad("cyclic points", changed(P, "Q + [l, 0]\n  Q: P - [l, 0]"), "8:3 E503"),
    Bad(
        "cyclic frames",
        extended("  one: {mass: m, frame: {on: two}}\n  two: {mass: m, frame: {on: one}}"),
        "11:3 E503",
    ),
    Bad("frame on itself", extended("  one: {mass: m, frame: {on: one}}"), "11:3 E503"),
    Bad("point on its own body", changed(P, "{on: bob, at: [l, 0]}"), "8:3 E503"),
    Bad("negative mass", changed("2 kg", "-2 kg"), "10:15 E504"),
    Bad(
        "negative inertia",
        changed("mass: m, at: P", "mass: m, at: P, inertia: -m*l^2"),
        "10:34 E504",
    ),
    Bad(
        "negative positive",
        changed("m: 2 kg", "m: {value: -2 kg, positive: true}"),
        "5:25 E508, 10:15 E504",
    ),
    Bad(
        "tensor in the plane",
        changed("mass: m, at: P", "mass: m, at: P, inertia: [1, 2, 3]"),
        "10:34 E501",
    ),
    Bad("turn in the plane", changed("at: P", "at: P, turn: [[z, phi]]"), "10:31 E507"),
    Bad("angle with a rod", changed("at: P", "rod: [P, P], angle: phi"), "10:23 E507, 10:31 E112"),
    Bad("rod of one point", changed("at: P", "rod: [P, P]"), "10:23 E507"),
    Bad("spring without law", extended("springs: [{along: phi}]"), "11:11 E112"),
    Bad(
        "spring with two laws",
        extended("springs: [{along: phi, stiffness: 0, law: 0*s}]"),
        "11:11 E112",
    ),
    Bad(
        "spring without free length",
        extended("springs: [{between: [P, bob], stiffness: 1 }]"),
        "11:11 E110, 11:42 E404",
    ),
    Bad("misspelt stiffness", extended("springs: [{along: phi, stifness: 0}]"), "11:24 E104"),
    Bad("spring nowhere", extended("springs: [{stiffness: 0}]"), "11:11 E112"),
    Bad("quadratic speed", extended("speeds: {u: phi'^2}"), "11:13 E506"),
    Bad("speed without rate", extended("speeds: {u: phi}"), "11:13 E506"),
    Bad("too many speeds", extended("speeds: {u: phi', w: 2*phi'}"), "11:10 E506"),
    Bad("initial of nothing", extended("initial: {psi: 1 rad}"), "11:11 E301"),
    Bad(
        "initial needs a value",
        changed("l: 1 m", "l: 1 m, a: ") + "initial: {phi: a}\n",
        "11:16 E203",
    ),
    Bad("range backwards", extended("range: {phi: [1 rad, -1 rad]}"), "11:14 E509"),
    Bad("solid: angle", solid("at: P", "at: P, angle: phi"), "10:32 E507"),
    Bad("solid: axis", solid("at: P", "at: P, turn: [[w, phi]]"), "10:33 E507"),
    Bad("solid: zero axis", solid("at: P", "at: P, turn: [[[0, 0, 0], phi]]"), "10:33 E507"),
    Bad("solid: triangle", solid("at: P", "at: P, inertia: [m*l^2, m*l^2, 3*m*l^2]"), "10:34 E505"),
    Bad(
        "solid: not symmetric",
        solid("at: P", "at: P, inertia: [[m*l^2, m*l^2, 0],[0,m*l^2,0],[0,0,m*l^2]]"),
        "10:34 E505",
    ),
    Bad("solid: two inertias", solid("at: P", "at: P, inertia: [m*l^2, m*l^2]"), "10:34 E501"),
    Bad("line: inertia", LINE.replace("at: x", "at: x, inertia: 1"), "6:30 E507"),
    Bad("line: moment", LINE + "moments: [{on: b, moment: 1}]\n", "7:11 E507"),
    Bad(
        "several at once",
        changed("m: 2 kg", "m: 2 kgg").replace("sin(phi)", "sin(phy)")
        + "springs: [{along: phi, stifness: 1}]\n",
        "5:19 E401, 8:13 E301, 11:24 E104",
    ),
    Bad(
        "no space, three components",
        changed("plane", "room").replace("[0, -g]", "[0, 0, -g]"),
        "3:8 E111",
    ),
    Bad("percent directive", "%YAML 9.0\n---\n" + BASE, "1:1 E103"),
    Bad("quoted nan", changed("mass: m", "mass: 'nan*m'"), "10:16 E301"),
    Bad("Infinity", changed("l: 1 m", "l: Infinity"), "5:26 E301"),
    Bad("boolean as mass", changed("mass: m", "mass: true"), "10:15 E301"),
    Bad("null mass", changed("mass: m", "mass: ~"), "10:15 E201"),
    Bad("key of digits", changed("l: 1 m", "l: 1 m, 1: 2"), "5:31 E304"),
    Bad("question key", BASE + "? [a]\n: b\n", "11:3 E109"),
    Bad("control in a name", changed("l: 1 m", "l: 1 m, a\u200bb: 2"), "5:31 E304"),
    Bad("Cyrillic name", changed("l: 1 m", "l: 1 m, \u0430: 2"), "5:31 E304"),
    Bad("lone surrogate", changed("Test", "T\ud800"), "2:10 E101"),
    Bad("long name", changed("l: 1 m", "l: 1 m, " + "a" * 61 + ": 2"), "5:31 E304"),
    Bad("long key", extended("k" * 1000 + ": 1"), "11:1 E104"),
    Bad("hostile name", changed("l: 1 m", "l: 1 m, '__import__(\"os\")': 2"), "5:32 E304"),
    Bad("dunder", changed("mass: m", "mass: m*__class__"), "10:17 E301"),
    Bad("string literal", changed("mass: m", "mass: \"'a'*m\""), "10:16 E201"),
    Bad("index", changed("mass: m", "mass: 'm[0]'"), "10:17 E201"),
    Bad("lambda call", changed("mass: m", "mass: 'lambda: m'"), "10:22 E201"),
    Bad("semicolon", changed("mass: m", "mass: 'm; m'"), "10:17 E201"),
    Bad("too many arguments", changed("mass: m", "mass: 'max(m,m,m,m,m,m,m,m,m)'"), "10:16 E204"),
    Bad("der of a parameter", extended("outputs: {a: der(m)}"), "11:14 E302"),
    Bad("prescribed by a coordinate", extended("prescribed: {w: phi*t}"), "11:17 E302"),
    Bad(
        "energy with an input",
        extended("inputs: {F: N}\nenergy: {potential: F*l*phi}"),
        "12:21 E302",
    ),
    Bad("energy in newtons", extended("energy: {kinetic: m*g}"), "11:19 E404"),
    Bad("dissipation in joules", extended("energy: {dissipation: m*g*l}"), "11:23 E404"),
    Bad("force in watts", extended("forces: [{on: P, force: [m*g*l*phi', 0]}]"), "11:25 E404"),
    Bad(
        "moment in newtons",
        extended("  rod: {mass: m, at: P, angle: phi}\nmoments: [{on: rod, moment: m*g}]"),
        "12:29 E404",
    ),
    Bad("angle in metres", changed("at: P", "at: P, angle: l"), "10:32 E404"),
    Bad(
        "damper with a law and damping",
        extended("dampers: [{along: phi, damping: 0, law: 0}]"),
        "11:11 E112",
    ),
    Bad("spring law in v", extended("springs: [{along: phi, law: m*g*l*v}]"), "11:35 E301"),
    Bad("force in no body", extended("forces: [{on: P, force: [0, 0], in: P}]"), "11:37 E306"),
    Bad(
        "expected equilibrium of nothing", extended("expect: {equilibrium: {psi: 0}}"), "11:24 E301"
    ),
    Bad(
        "expected equation of nothing",
        extended("expect: {equations: {psi: phi'' = 0}}"),
        "11:22 E301",
    ),
    Bad("kinetic energy in newtons", extended("expect: {kinetic: m*g}"), "11:19 E404"),
    Bad("unknown point on body", changed(P, "{on: rod, at: [l, 0]}"), "8:11 E301"),
    Bad("unknown frame", extended("  two: {mass: m, frame: {on: three}}"), "11:30 E301"),
    Bad("com without frame", changed("at: P", "at: P, com: [l, 0]"), "10:25 E112"),
    Bad(
        "moving mass centre",
        extended("  two: {mass: m, frame: {angle: phi}, com: [l*phi, 0]}"),
        "11:47 E302",
    ),
    Bad("unit that overflows", changed("2 kg", "2 " + "k" * 90), "5:18 E402"),
    Bad("missing output", extended("outputs: {a: {about: nothing}}"), "11:14 E110"),
    Bad("wrong role", changed("phi: rad", "phi: {role: bound}"), "6:27 E111"),
    Bad("units that bomb", changed("2 kg", "2 (((((((((m)))))))))"), "5:19 E201"),
    Bad(
        "values that explode",
        changed("l: 1 m", "l: 1 m, a: 2, b: a^64, c: b^64, d: c^64"),
        "5:49 E202",
    ),
    Bad("a value that divides by zero", changed("l: 1 m", "l: 1 m, a: 0, b: 1/a"), "5:42 E203"),
    Bad("dof too large", extended("expect: {dof: 9999999999999}"), "11:15 E111"),
    Bad("body called world", extended("  world: {mass: m, at: P}"), "11:3 E304"),
    Bad("number tower", changed("mass: m", "mass: ((3*m)^64)^64"), "10:15 E202"),
    Bad("hanging exponential", changed("mass: m", "mass: m*cos(exp(exp(50)))"), "10:21 E202"),
    Bad(
        "spring along a constant", extended("springs: [{along: l, stiffness: 1 N/m}]"), "11:19 E510"
    ),
    Bad("quantity as a mass", changed("mass: m", "mass: 2 kg"), "10:15 E407"),
    Bad(
        "quantity as a stiffness",
        changed("bodies:", "springs: [{along: phi, stiffness: 2 N}]\nbodies:"),
        "9:35 E407",
    ),
    Bad("two units without product", changed("mass: m", "mass: 2 m"), "10:17 E201"),
    Bad("speed over a rate", extended("speeds: {u: l^2/phi'}"), "11:13 E506"),
    Bad("product of rates", extended("speeds: {u: phi'*phi'}"), "11:13 E506"),
    Bad("sine of a rate", extended("speeds: {u: sin(phi')}"), "11:13 E506, 11:17 E404"),
)
