"""Scenes of particles on massless links, as spec text, and such as are nearly that."""


def _spec(title, *lines, space="plane", gravity="[0.3, -9.81]"):
    head = ["eom: 1", f"system: {title}", f"space: {space}", f"gravity: {gravity}"]
    return "\n".join([*head, *lines]) + "\n"


def cart(count, *more, masses=True):
    """A cart with a chain of unlike pendulums; masses and lengths are parameters."""
    pendulums = range(1, count + 1)
    return _spec(
        f"Cart with {count} pendulums",
        "parameters:",
        *(f"  m{i}: {1.1 + i % 7 / 10:.1f}" for i in range(count + 1) if masses),
        *(f"  l{i}: {0.35 + i % 5 / 10:.2f}" for i in pendulums),
        "coordinates: {s: 1, " + ", ".join(f"q{i}: 1" for i in pendulums) + "}",
        "inputs: {F: 1}",
        "points:",
        "  P0: [s, 0]",
        *(f"  P{i}: P{i - 1} + l{i}*[sin(q{i}), -cos(q{i})]" for i in pendulums),
        "bodies:",
        *(f"  B{i}: {{mass: m{i}, at: P{i}}}" for i in range(count + 1)),
        "forces:",
        "  - {on: B0, force: [F, 0]}",
        *more,
    )


LOADED = cart(
    3,
    "  - {on: B2, force: [0.4, F*q1]}",
    "springs:",
    "  - {along: q2 - q1, stiffness: 3}",
    "  - {between: [B0, B3], stiffness: 2, free_length: 0.4}",
    "dampers:",
    "  - {along: q3 - q2, damping: 0.5}",
    "  - {between: [B1, B3], damping: 0.2}",
)
BRANCHED = _spec(
    "Branching chains under a beam that falls freely",
    "parameters: {m: 1.3, a: 0.4, b: 0.7, k: 2}",
    "coordinates: {x: 1, y: 1, q1: 1, q2: 1, q3: 1, q4: 1, q5: 1, r: 1, p: 1}",
    "prescribed: {w: 0.1*sin(2*t)}",
    "points:",
    "  O: [x, y + x/2]",
    "  end: O + [a, w]",
    "  P1: O + a*[sin(q1), -cos(q1)]",
    "  P2: P1 + b*[sin(2*q2), -cos(2*q2)]",
    "  P3: P1 + [a*sin(q3) + b*cos(q3), b*sin(q3) - a*cos(q3)]",
    "  P4: P1 + b*[cos(q4), sin(q4)]",
    "  P5: end + b*[cos(q5 + t), sin(q5 + t)]",
    "  P6: P4 + r*[sin(p), -cos(p)]",
    "  knob: P4 + [0.1, 2*w]",
    "bodies:",
    "  o: {mass: m, at: O}",
    "  e: {mass: m/3, at: end}",
    *(f"  b{i}: {{mass: m*{i}/4, at: P{i}}}" for i in range(1, 7)),
    "  weight: {mass: 0.2, at: knob}",
    "springs:",
    "  - {between: [b2, b5], stiffness: k, free_length: 0.3}",
    "  - {between: [P4, b6], stiffness: k, free_length: 0.2}",
).replace("[x, y + x/2]", "[x, y]")
SLIDING = _spec(
    "Sliders on sliders, shaken",
    "parameters: {m: 1.3, l: 0.4, M: 3}",
    "coordinates: {s: 1, x: 1, q: 1, z: 1}",
    "prescribed: {w: 0.1*sin(2*t)}",
    "inputs: {F: 1}",
    "points:",
    "  A: [w + 3*s/5, 4*s/5]",
    "  B: A + [x, t^2]",
    "  C: B + l*[sin(q), -cos(q)]",
    "  D: C + [12*z/13, 5*z/13]",
    "bodies:",
    *(
        f"  {n}: {{mass: {mass}, at: {n.upper()}}}"
        for n, mass in zip("abcd", ("M", "m", "2*m", "m"), strict=True)
    ),
    "forces: [{on: d, from: a, force: [F, -F/2]}]",
)
SPHERICAL = _spec(
    "Spherical pendulums under a table, a rail and a fixed point",
    "parameters: {m: 1.2, l: 0.5}",
    "coordinates: {x: 1, y: 1, z: 1, a: 1, b: 1, c: 1, d: 1, e: 1, f: 1, g: 1, h: 1}",
    "range: {a: [0.5, 2], c: [0.5, 2], e: [0.5, 2], g: [0.5, 2]}",
    "inputs: {F: 1}",
    "points:",
    "  O: [x, y, 0.3*t]",
    "  A: O + l*[sin(a)*cos(b), sin(a)*sin(b), -cos(a)]",
    "  B: A + 2*l*[cos(c), sin(c)*cos(d), sin(c)*sin(d)]",
    "  R: [2*z/3, 1 - z/3, 2*z/3]",
    "  C: R + l*[sin(e)*cos(f), sin(e)*sin(f), -cos(e)]",
    "  E: l*[sin(g)*cos(h), sin(g)*sin(h), -cos(g)]",
    "bodies:",
    *(f"  b{n}: {{mass: {k}*m, at: {n}}}" for k, n in enumerate("OABRCE", start=1)),
    "springs: [{between: [bB, bC], stiffness: 2, free_length: 0.1}]",
    "dampers: [{between: [bA, bE], damping: 0.3}]",
    "forces: [{on: bB, force: [F, 0.2, -F]}]",
    space="solid",
    gravity="[0.1, -0.2, -9.7]",
)
SCENES = {
    **{f"cart_{n}": cart(n) for n in (1, 2, 4, 8)},
    "loaded": LOADED,
    "branched": BRANCHED,
    "sliding": SLIDING,
    "spherical": SPHERICAL,
}


def line(at, *more, space="plane", mass="m", gravity="[0, -9.81]"):
    """A cart and one particle under it, or what stands for it."""
    return _spec(
        "Nearly",
        "parameters: {m: 1, l: 1, M: 1, none: 0}",
        "coordinates: {s: 1, q: 1}",
        f"points: {{A: {'[s, 0]' if space == 'plane' else '[s, 0, 0]'}, B: '{at}'}}",
        f"bodies: {{a: {{mass: M, at: A}}, b: {{mass: {mass}, at: B}}}}",
        *more,
        space=space,
        gravity=gravity,
    )


STRANGERS = {
    "a link that changes its length with the angle": line("A + q*[sin(q), -cos(q)]"),
    "a particle on a curve": line("A + [q, q^2]"),
    "a link that leaves two directions out": line(
        "A + l*[sin(q), 0, -cos(q)]", space="solid", gravity="[0, 0, -9.81]"
    ),
    "a coordinate of two places": line("A + l*[sin(q), -cos(q)]").replace(
        "bodies: {", "bodies: {c: {mass: m, at: 'B + l*[cos(q), sin(q)]'}, "
    ),
    "a body that turns": line("A + l*[sin(q), -cos(q)]").replace(
        "b: {mass: m, at: B}", "b: {mass: m, inertia: 1, at: B, angle: q}"
    ),
    "a rod with a mass": line("A + l*[sin(q), -cos(q)]").replace(
        "b: {mass: m, at: B}", "b: {rod: [A, B], mass: m}"
    ),
    "a parameter that makes a mass zero": line("A + l*[sin(q), -cos(q)]", mass="2*none"),
    "directions that are not at right angles": _spec(
        "Oblique",
        "coordinates: {x: 1, y: 1}",
        "bodies: {a: {mass: 1, at: [x + y, y]}}",
    ),
}
