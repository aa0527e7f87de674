"""Studies of shipped specs and of spec texts, for tests."""

from functools import cache

from scenes import SHIPPED, model_of

from eomgen.study import Study, of_model

NAMES = list(SHIPPED)
model = model_of


@cache
def study(name: str) -> Study:
    return of_model(model(name))


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
