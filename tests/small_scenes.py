"""Texts of small scenes that several test files study."""

FREE_BODY = """\
eom: 1
system: Free body by yaw, pitch and roll
space: solid
gravity: 0
parameters: {m: 1 kg, J: 1 kg*m^2}
coordinates: {yaw: rad, pitch: rad, roll: rad}
bodies:
  ball:
    mass: m
    frame: {turn: [[z, yaw], [y, pitch], [x, roll]]}
    com: [0, 0, 0]
    inertia: [J, J, J]
initial: {yaw: 0 rad, pitch: 0 rad, roll: 0 rad, yaw': 0 rad/s, pitch': 1 rad/s, roll': 0 rad/s}
"""


def oscillator(stiffness="1", damping="0"):
    """A mass of 1 on a spring and a damper, released at 1."""
    return f"""\
eom: 1
system: Oscillator
space: line
gravity: 0
parameters: {{m: 1, k: {stiffness}, c: {damping}}}
coordinates: {{x: 1}}
bodies:
  mass: {{mass: m, at: "[x]"}}
springs: [{{along: x, stiffness: k}}]
dampers: [{{along: x, damping: c}}]
initial: {{x: 1, x': 0}}
"""
