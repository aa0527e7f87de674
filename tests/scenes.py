"""Models of shipped specs and of spec texts, for tests."""

from functools import cache
from pathlib import Path

from eomgen.model import Model
from eomgen.spec import read
from eomgen.study import Study, of_model

SPECS = Path(__file__).parents[1] / "specs"
NAMES = sorted(path.stem for path in SPECS.glob("*.yaml"))


@cache
def model(name: str) -> Model:
    path = SPECS / f"{name}.yaml"
    return read(path.read_bytes(), path.name)


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
