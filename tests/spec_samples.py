"""Right spec files that the tests of the way in read, mutate and compare."""

from eomgen.spec.ledger import Mistake
from eomgen.spec.reader import Scalar


def source(text):
    """A scalar of a file: its first."""
    return Scalar(text, 1, 1)


def outcome(function, argument):
    """The result and None, or None and the mistake."""
    try:
        return function(argument), None
    except Mistake as mistake:
        return None, mistake


SLIDER_PENDULUM = r"""eom: 1
system: {en: Slider with pendulum, es: Masa deslizante con péndulo}
space: plane
gravity: [0, -g]
parameters:
  m_A: {value: 2 kg, about: slider mass}
  m_B: {value: 0.5 kg, about: bob mass}
  l: {value: 0.8 m, about: rod length}
  k: 120 N/m
  c: 1.5 N*s/m
  d: {value: 0.02 N*m*s, latex: c'}
  g: 9.81 m/s^2
coordinates:
  s: {unit: m, about: slider displacement from the unstretched spring}
  phi: {unit: rad, latex: \varphi, about: rod angle from the downward vertical}
inputs:
  F: N
points:
  A: [s, 0]
  B: A + l*[sin(phi), -cos(phi)]
bodies:
  slider: {mass: m_A, at: A}
  bob: {mass: m_B, at: B}
springs:
  - {along: s, stiffness: k}
dampers:
  - {along: s, damping: c}
  - {along: phi, damping: d}
forces:
  - {on: A, force: [F, 0]}
initial: {s: 0.1 m, phi: 20 deg}
expect: {dof: 2}
"""

TWO_LINK_ARM = r"""eom: 1
system: Two-link arm on a shaken base
space: plane
gravity: [0, -g]
parameters:
  l1: 0.4 m
  s1: 0.18 m
  s2: 0.15 m
  m1: 3 kg
  m2: 2 kg
  J1: 0.05 kg*m^2
  J2: 0.03 kg*m^2
  g: 9.81 m/s^2
  A0: 5 mm
  Omega: 40 rad/s
prescribed: {w: A0*sin(Omega*t)}
coordinates: {q1: rad, q2: rad}
inputs: {tau1: N*m, tau2: N*m}
bodies:
  upper: {mass: m1, inertia: J1, frame: {at: [0, w], angle: q1}, com: [s1, 0]}
  fore: {mass: m2, inertia: J2, frame: {on: upper, at: [l1, 0], angle: q2}, com: [s2, 0]}
moments:
  - {on: upper, moment: tau1}
  - {on: fore, from: upper, moment: tau2}
"""

FOUR_BAR = r"""eom: 1
system: Four-bar linkage
space: plane
gravity: [0, -g]
parameters: {a: 0.20 m, b: 0.50 m, c: 0.40 m, e: 0.45 m, rho: 1.2 kg/m, g: 9.81 m/s^2}
coordinates:
  q1: {unit: rad, role: free}
  q2: {unit: rad, role: linked}
  q3: {unit: rad, role: linked}
inputs: {tau: N*m}
points:
  A: [0, 0]
  D: [e, 0]
  B: A + a*[cos(q1), sin(q1)]
  C: B + b*[cos(q2), sin(q2)]
  Cr: D + c*[cos(q3), sin(q3)]
bodies:
  crank: {rod: [A, B], mass: rho*a}      # uniform rod: angle and inertia follow
  coupler: {rod: [B, C], mass: rho*b}
  rocker: {rod: [D, Cr], mass: rho*c}
moments:
  - {on: crank, moment: tau}
constraints:
  loop: {holonomic: C = Cr, reaction: pin_C}
initial: {q1: 60 deg, q1': 2 rad/s, guess: {q2: 20 deg, q3: 80 deg}}
expect: {dof: 1}
"""

ROLLING_DISC = r"""eom: 1
system: {en: Upright rolling disc, es: Disco vertical rodando sin deslizar}
space: solid
gravity: [0, 0, -g]
parameters: {m: 2 kg, R: 0.3 m, g: 9.81 m/s^2, I_d: m*R^2/4, I_a: m*R^2/2}
coordinates:
  x: m
  y: m
  theta: {unit: rad, about: heading}
  phi: {unit: rad, latex: \varphi, about: roll angle}
bodies:
  disc:
    mass: m
    at: [x, y, R]
    turn: [[z, theta], [y, phi]]          # body-fixed, left to right
    inertia: [I_d, I_a, I_d]              # principal, mass centre, body axes
constraints:
  no_slip_x: {nonholonomic: x' - R*phi'*cos(theta) = 0}
  no_slip_y: {nonholonomic: y' - R*phi'*sin(theta) = 0}
expect: {dof: 2}
"""

ROPE = r"""eom: 1
system: Bob on a rope
space: plane
gravity: [0, -g]
parameters: {m: 1 kg, l: 1 m, g: 9.81 m/s^2, e: 0}
coordinates: {x: m, y: m}
bodies: {bob: {mass: m, at: [x, y]}}
constraints:
  taut: {unilateral: l - sqrt(x^2 + y^2) >= 0, restitution: e}
"""

FREE = {"slider_pendulum": SLIDER_PENDULUM, "two_link_arm": TWO_LINK_ARM}

# every key and form of constraints
LINKED = r"""eom: 1
system: Constraints of every kind
space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 1 m, g: 9.81 m/s^2, mu: 0.3, e: {about: restitution}, Omega: 3 rad/s}
prescribed: {w: l*sin(Omega*t)/5}
coordinates:
  x: {unit: m, role: linked}
  y: {unit: m, role: linked}
  phi: rad
  psi: {unit: rad, role: free}
points:
  A: [x, w]
  B: {on: beam, at: [l, 0]}
  C: l*[cos(psi), sin(psi)]
bodies:
  beam: {mass: m, at: A, angle: phi, inertia: m*l^2/12}
  bob: {mass: m, at: "[x, y]"}
constraints:
  loop: {holonomic: B = C, reaction: pin, latex: \Phi_1, about: the beam's end}
  track: {holonomic: "y = x*tan(Omega*t)", reaction: normal}
  spin: {nonholonomic: x' - w' - l*phi'*cos(psi) = 0}
  floor: {unilateral: y >= w - l, restitution: e, friction: mu/2}
  ceiling: {unilateral: y <= 3*l, restitution: 0.5, reaction: push}
initial: {psi: 30 deg, psi': 1 rad/s, guess: {x: 0.3 m, phi: 10 deg, y': 2 m/s}}
expect: {dof: 1}
"""

CONSTRAINED = {
    "four_bar": FOUR_BAR,
    "rolling_disc": ROLLING_DISC,
    "rope": ROPE,
    "linked": LINKED,
}

# every key of the language but constraints
EVERYTHING = r"""eom: 1
system: {en: Everything, es: Todo}
space: plane
gravity: [0, -g]
parameters:
  m: {value: 2, unit: kg, latex: m_1, about: a mass, positive: true}
  l: 1/2 m
  g: 9.81 m/s^2
  k: 120 N/m
  c: 1.5 Nm*s
  J: m*l^2/12
  h: {unit: m}
  rate: 30 rpm
  lambda: 3
coordinates:
  s: m
  phi: {unit: rad, latex: \varphi, about: an angle}
  r: {unit: m, positive: true}
speeds: {u1: s', u2: {formula: "phi' - w'/l", unit: rad/s}, u3: "r' + s'*cos(phi)"}
prescribed: {w: l*sin(rate*t)/9}
inputs: {F: N, tau: {unit: N*m, about: a motor}}
points:
  Q: (A + B)/2 - [0, w]
  A: [s, 0]
  B: A + l*[sin(phi), -cos(phi)]
  T: {on: plate, at: [l/2, h]}
bodies:
  ball: {mass: m, at: B}
  plate: {mass: 2*m, at: A, angle: phi, inertia: J}
  rod: {rod: [A, B], mass: m/lambda}
  arm: {mass: m, inertia: J, frame: {on: plate, at: [l, 0], angle: 2*phi}, com: [l/2, 0]}
springs:
  - {along: s, stiffness: k}
  - {between: [A, Q], stiffness: k, free_length: l}
  - {along: phi, law: c*rate*sin(s)}
  - {between: [A, ball], energy: k*s^4/l^2, free_length: 0}
dampers:
  slow: {along: phi, damping: c}
  fast: {between: [A, T], law: c/l^2*abs(v)*v/(l*rate)}
forces:
  - {on: B, from: A, force: [F, -m*g*tanh(s'/(l*rate))], in: plate}
  - {on: ball, force: "F*[1, 0] + m*[0, g]/2"}
moments:
  - {on: plate, from: rod, moment: tau}
energy: {kinetic: m*r'^2/2, potential: m*g*r, dissipation: c*phi'^2/2}
initial: {s: 10 cm, phi: -20 deg, r: l/2, phi': 1 rpm}
range: {phi: [-pi/2, 90 deg], s: [-1 m, 1 m]}
outputs: {power: F*s', lift: {formula: m*(phi''*l + g), unit: N, latex: F_L}, speed: u2*l}
simulate: {method: rk4, step: 1 ms, formulation: minimal}
expect:
  dof: 3
  equations: {s: "m*s'' + k*s = F", phi: "0 = 0*phi''"}
  equilibrium: [{phi: 0}, {phi: 180 deg, s: F/k}]
  conserved: [m*r'^2/2 + m*g*r]
  kinetic: m*r'^2/2
  potential: m*g*r
"""
