"""Wrong spec files with constraints, in the manner of `bad_specs`."""

from bad_specs import LINE, Bad, changed, extended
from spec_samples import FOUR_BAR, LINKED, ROLLING_DISC, ROPE


def constrained(relation):
    """The plane pendulum with one constraint, which begins in column 19 of line 11."""
    return extended(f"constraints: {{c: {{{relation}}}}}")


def linked(old, new):
    """The system with constraints of every kind, one piece replaced."""
    assert LINKED.count(old) == 1
    return LINKED.replace(old, new)


BAD_CONSTRAINTS = (
    # shape
    Bad("constraints as text", extended("constraints: phi = 0"), "11:14 E109"),
    Bad("misspelt constraints", linked("constraints:", "constrains:"), "19:1 E104"),
    Bad("constraint as text", extended("constraints: {c: phi = 0}"), "11:18 E109"),
    Bad("constraint without kind", constrained("about: nothing"), "11:18 E112"),
    Bad("empty constraint", constrained(""), "11:18 E112"),
    Bad("two kinds", constrained("holonomic: phi = 0, unilateral: phi >= 0"), "11:18 E112"),
    Bad("misspelt kind", constrained("holonomc: phi = 1, restitution: 1"), "11:19 E104"),
    Bad("misspelt option", constrained("unilateral: phi >= 0, restituton: 1"), "11:41 E104"),
    Bad("relation without value", constrained("holonomic: "), "11:19 E109"),
    Bad("relation as a list", constrained("holonomic: [phi = 0]"), "11:30 E109"),
    Bad("constraint called t", extended("constraints: {t: {holonomic: phi = 1}}"), "11:15 E304"),
    Bad("constraint with dash", extended("constraints: {a-b: {holonomic: phi = 1}}"), "11:15 E304"),
    Bad("constraint twice", linked("  track:", "  loop:"), "21:3 E105"),
    Bad("faulty entry of a list", extended("constraints: [{holonomic: phi}]"), "11:30 E205"),
    # signs
    Bad("constraint without sign", constrained("holonomic: phi - 1"), "11:37 E205"),
    Bad("holonomic inequality", constrained("holonomic: phi >= 0"), "11:30 E205"),
    Bad("nonholonomic inequality", constrained("nonholonomic: phi' <= 0"), "11:33 E205"),
    Bad("unilateral equation", constrained("unilateral: phi = 0"), "11:31 E205"),
    Bad("strict inequality", constrained("unilateral: phi > 0"), "11:35 E201"),
    Bad("two signs", constrained("unilateral: 0 <= phi <= 1"), "11:40 E205"),
    Bad("double equals", constrained("holonomic: phi == 0"), "11:35 E205"),
    Bad("sign of print", constrained("unilateral: phi \u2265 0"), "11:35 E201"),
    Bad("nothing on the right", constrained("'holonomic': 'phi ='"), "11:38 E201"),
    # what stands in them
    Bad("rate in a holonomic one", constrained("holonomic: phi' = phi"), "11:30 E302"),
    Bad(
        "rate of a prescribed motion in a holonomic one",
        linked("y = x*tan", "y = w'/Omega + x*tan"),
        "21:27 E302",
    ),
    Bad(
        "acceleration in a nonholonomic one", constrained("nonholonomic: l*phi'' = g"), "11:35 E302"
    ),
    Bad("prescribed acceleration", linked("x' - w' -", "x' - w''/Omega -"), "22:29 E302"),
    Bad("rate in a gap", constrained("unilateral: phi' >= 0"), "11:31 E302"),
    Bad(
        "input in a holonomic one",
        constrained("holonomic: phi = u") + "inputs: {u: rad}\n",
        "11:36 E302",
    ),
    Bad(
        "input in a nonholonomic one",
        constrained("nonholonomic: l*phi' = u") + "inputs: {u: m/s}\n",
        "11:42 E302",
    ),
    Bad("input in a gap", constrained("unilateral: l*phi >= u") + "inputs: {u: m}\n", "11:40 E302"),
    Bad("unknown name in a constraint", constrained("holonomic: phy = 0"), "11:30 E301"),
    Bad("unknown point in a constraint", constrained("holonomic: P = bop"), "11:34 E301"),
    Bad("a reaction in a constraint", linked("y >= w - l,", "y >= w - pin,"), "23:32 E302"),
    Bad(
        "a constraint's name in a formula",
        linked("spin: {", "spin: {about: a, ").replace("friction: mu/2", "friction: spin"),
        "23:61 E301",
    ),
    Bad("vector equation", constrained('holonomic: "P = [l, 0]"'), "11:35 E502"),
    Bad("affine equation of points", linked("B = C", '"B = C + [l, 0]"'), "20:26 E502"),
    Bad("vectors without points", constrained('holonomic: "[l*phi, 0] = [l, 0]"'), "11:31 E502"),
    Bad("point equal to a coordinate", constrained("holonomic: P = phi"), "11:34 E302"),
    Bad("point equal to itself", constrained("holonomic: P = P"), "11:30 E507"),
    Bad("rate of a point", constrained("holonomic: P' = bob"), "11:30 E302"),
    Bad("point in a nonholonomic one", constrained("nonholonomic: P = bob"), "11:33 E302"),
    Bad("points in a gap", constrained("unilateral: P >= bob"), "11:31 E302"),
    Bad("vector in a gap", constrained('unilateral: "[l*phi, 0] >= 0"'), "11:32 E502"),
    Bad("component of a point", constrained('holonomic: "P[1] = 0"'), "11:32 E201"),
    Bad("line: place and number", LINE + "constraints: {c: {holonomic: b = 1}}\n", "7:34 E502"),
    # nothing is constrained
    Bad("constant constraint", constrained("holonomic: l = 1 "), "11:30 E510, 11:34 E403"),
    Bad("constraint between parameters", constrained("holonomic: m*g = g*m"), "11:30 E510"),
    Bad("time alone", constrained("holonomic: t*sqrt(g/l) = 1"), "11:30 E510"),
    Bad("coordinate that drops out", constrained("holonomic: phi + 1 = phi"), "11:30 E510"),
    Bad("gap of constants", constrained("unilateral: l >= 0"), "11:31 E510"),
    Bad("gap of a prescribed motion", linked("y >= w - l", "w >= -l"), "23:23 E510"),
    Bad("places that do not move", FOUR_BAR.replace("C = Cr", "A = D"), "24:21 E510"),
    Bad("no rate", constrained("nonholonomic: phi = 0"), "11:33 E511"),
    Bad(
        "rate that drops out",
        constrained("nonholonomic: phi' + phi = phi'"),
        "11:33 E511, 11:40 E403",
    ),
    Bad("prescribed rate alone", linked("x' - w' - l*phi'*cos(psi)", "w' + 0*x'"), "22:24 E511"),
    # not linear
    Bad("square of a rate", constrained("nonholonomic: phi'^2 = g/l"), "11:33 E511"),
    Bad(
        "product of two rates",
        ROLLING_DISC.replace("x' - R*phi'*cos(theta)", "x' - R*phi'*theta'*t"),
        "18:29 E511",
    ),
    Bad(
        "sine of a rate in a constraint", constrained("nonholonomic: sin(t*phi') = 0"), "11:33 E511"
    ),
    Bad(
        "speed of given size",
        ROLLING_DISC.replace("x' - R*phi'*cos(theta)", "sqrt(x'^2 + y'^2) - R*phi'"),
        "18:29 E511",
    ),
    Bad("absolute rate", constrained("nonholonomic: abs(phi') = 0"), "11:33 E511"),
    Bad(
        "greatest rate",
        ROLLING_DISC.replace("x' - R*phi'*cos(theta) = 0", "\"max(x', y') = 0\""),
        "18:30 E511",
    ),
    Bad(
        "quotient of rates",
        ROLLING_DISC.replace("x' - R*phi'*cos(theta)", "x'/y' - cos(theta)"),
        "18:29 E511",
    ),
    # dimensions
    Bad("metres and radians", constrained("holonomic: l*phi = 1"), "11:38 E403"),
    Bad(
        "metres and square metres",
        ROPE.replace("l - sqrt(x^2 + y^2)", "l - (x^2 + y^2)"),
        "9:27 E403",
    ),
    Bad("a missing radius", ROLLING_DISC.replace("x' - R*phi'*cos", "x' - phi'*cos"), "18:34 E403"),
    Bad("sine of a length in a constraint", constrained("holonomic: sin(l) = phi"), "11:34 E404"),
    Bad("restitution in metres", ROPE.replace("restitution: e", "restitution: l"), "9:61 E404"),
    Bad("friction in newtons", linked("friction: mu/2", "friction: m*g"), "23:61 E404"),
    # options
    Bad(
        "restitution of a holonomic one",
        constrained("holonomic: phi = 1, restitution: 1"),
        "11:39 E112",
    ),
    Bad(
        "friction of a nonholonomic one",
        constrained("nonholonomic: phi' = 0, friction: 1"),
        "11:43 E112",
    ),
    Bad(
        "restitution above one",
        constrained("unilateral: phi >= 0, restitution: 1.01"),
        "11:54 E512",
    ),
    Bad(
        "negative restitution", constrained("unilateral: phi >= 0, restitution: -0.1"), "11:54 E512"
    ),
    Bad("restitution by a parameter above one", ROPE.replace("e: 0", "e: 11/10"), "9:61 E512"),
    Bad("negative friction", linked("mu: 0.3", "mu: -0.3"), "23:61 E512"),
    Bad(
        "restitution of the state", ROPE.replace("restitution: e", "restitution: x/l"), "9:61 E302"
    ),
    Bad("friction of time", linked("friction: mu/2", "friction: Omega*t"), "23:67 E302"),
    Bad("reaction with dash", constrained("holonomic: phi = 1, reaction: a-b"), "11:49 E304"),
    Bad("reaction called sin", constrained("holonomic: phi = 1, reaction: sin"), "11:49 E304"),
    Bad(
        "reaction of a parameter's name",
        constrained("holonomic: phi = 1, reaction: m"),
        "11:49 E303",
    ),
    Bad("reaction twice", linked("reaction: normal", "reaction: pin"), "21:54 E303"),
    Bad("reaction as a list", linked("reaction: normal", "reaction: [normal, pin]"), "21:54 E109"),
    Bad("output of a reaction's name", LINKED + "outputs: {pin: x}\n", "27:11 E303"),
    Bad("output of a reaction", LINKED + "outputs: {a: pin*l}\n", "27:14 E302"),
    Bad("rate of a reaction", LINKED + "outputs: {a: pin'}\n", "27:14 E302"),
    Bad(
        "claim of a reaction",
        LINKED.replace("dof: 1", "dof: 1, equations: [normal = 0]"),
        "26:30 E302",
    ),
    # beside them
    Bad(
        "linked without constraints",
        changed("phi: rad", "phi: {unit: rad, role: linked}"),
        "6:38 E513",
    ),
    Bad(
        "linked beside a rolling disc",
        ROLLING_DISC.replace("about: heading", "role: linked"),
        "9:28 E513",
    ),
    Bad("linked beside a rope", ROPE.replace("y: m}", "y: {unit: m, role: linked}}"), "6:40 E513"),
    Bad("free and none linked", FOUR_BAR.replace(", role: linked", ""), "7:25 E513"),
    Bad("all free", FOUR_BAR.replace("linked", "free"), "7:25 E513"),
    Bad(
        "guess without constraints",
        extended("initial: {phi': 1 rad/s, guess: {phi: 1}}"),
        "11:26 E513",
    ),
    Bad(
        "guess beside an empty map",
        extended("constraints: {}\ninitial: {guess: {phi: 1}}"),
        "12:11 E513",
    ),
    Bad("initial and guess", FOUR_BAR.replace("guess: {", "guess: {q1: 1, "), "25:45 E514"),
    Bad(
        "rate as initial and guess",
        FOUR_BAR.replace("guess: {", "guess: {q1': 1 rad/s, "),
        "25:45 E514",
    ),
    Bad(
        "guess as a number",
        FOUR_BAR.replace("guess: {q2: 20 deg, q3: 80 deg}", "guess: 20 deg"),
        "25:44 E109",
    ),
    Bad("guess of nothing", linked("phi: 10 deg", "phy: 10 deg"), "25:57 E301"),
    Bad("guess of an acceleration", linked("phi: 10 deg", "phi'': 10 deg"), "25:57 E301"),
    Bad("guess in metres", linked("phi: 10 deg", "phi: 10 m"), "25:62 E404"),
    Bad("guess by a coordinate", linked("phi: 10 deg", "phi: psi/2"), "25:62 E302"),
    Bad("guess without value", linked("x: 0.3 m,", "x: e*l,"), "25:50 E203"),
    Bad(
        "negative guess",
        linked("x: {unit: m, role", "x: {unit: m, positive: true, role").replace(
            "x: 0.3 m", "x: -0.3 m"
        ),
        "25:50 E508",
    ),
    Bad("guess in an initial map", linked("guess: {x", "gues: {x"), "25:39 E104"),
    Bad(
        "speeds beside a gap",
        ROPE + "speeds: {a: x', b: y'}\n",
        "10:1 E602",
    ),
    Bad(
        "speeds and a faulty constraint",
        constrained("holonomic: phi, friction: 1") + "speeds: {u: phi'}\n",
        "11:33 E205, 12:1 E602",
    ),
    # hostile
    Bad("power tower in a constraint", constrained("holonomic: phi**9**9**9 = 0"), "11:38 E202"),
    Bad("no name of ours", constrained("holonomic: '__import__(\"os\") = phi'"), "11:42 E201"),
    Bad("long constraint", constrained("holonomic: " + "phi + " * 1000 + "phi = 0"), "11:30 E202"),
    Bad(
        "overflowing restitution",
        constrained("unilateral: phi >= 0, restitution: 1e300*1e300"),
        "11:60 E202",
    ),
)
