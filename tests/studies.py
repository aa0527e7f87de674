"""Studies of shipped specs and of spec texts, for tests."""

from scenes import FREE, model_of, study_of

NAMES = FREE
model = model_of
study = study_of


PENDULUM = """\
eom: 1
system: Pendulum
space: plane
gravity: [0, -g]
parameters: {m: 2 kg, l: 0.5 m, g: 9.81 m/s^2, d: 0.1 N*m*s}
coordinates: {phi: rad}
inputs: {tau: N*m}
bodies:
  bob: {mass: m, at: "l*[sin(phi), -cos(phi)]", angle: phi}
dampers: [{along: phi, damping: d}]
moments: [{on: bob, moment: tau}]
"""
