"""Forces along a formula: a motor in a joint is the moment between its bodies."""

import pytest
from scenes import SHIPPED

from eomgen import spec
from eomgen.compile import machine_of, program
from eomgen.errors import SpecError
from eomgen.interpreter import FLOAT, run

ARM = SHIPPED["skew_arm"].read_text(encoding="utf-8")
MOMENTS = ARM[ARM.index("moments:") : ARM.index("initial:")]
DRIVES = """forces:
  shoulder: {along: q_1, force: tau_1}
  elbow: {along: q_2, force: tau_2}
"""
STATE = {"state": [0.3, -1.1, 0.7, 2.0], "inputs": [1.5, -0.4]}


def forces_of(text):
    model = spec.read(text, "arm.yaml")
    compiled = program(machine_of(model))
    values = [float(p.value) for p in model.parameters]
    return run(compiled.function("generalized_forces"), STATE | {"parameters": values}, FLOAT)


def test_a_drive_in_a_joint_is_the_moment_between_its_bodies():
    assert forces_of(ARM.replace(MOMENTS, DRIVES)) == pytest.approx(forces_of(ARM), rel=1e-13)


def test_a_drive_along_a_sum_works_on_both_coordinates():
    both = DRIVES.replace("along: q_2,", "along: q_1/2 + 3*q_2,")
    with_both = forces_of(ARM.replace(MOMENTS, both))
    neither = forces_of(ARM.replace(MOMENTS, ""))
    gained = [a - b for a, b in zip(with_both, neither, strict=True)]
    assert gained == pytest.approx([1.5 - 0.2, -1.2], rel=1e-12)


@pytest.mark.parametrize(
    ("load", "said"),
    [
        ("{along: q_1, force: a_x}", "'a_x' is [m] but force 1 must be [kg m^2 s^-2]"),
        ("{along: a_x, force: tau_1}", "moves with no coordinate"),
        ("{along: q_1', force: tau_1}", "may not stand"),
        ("{along: q_1, force: [tau_1, 0, 0]}", "a scalar is needed"),
        ("{along: q_1, in: upper, force: tau_1}", "'in' does not go with 'along'"),
        ("{along: q_1, on: upper, force: tau_1}", "it has on and along"),
        ("{force: tau_1}", "it has none"),
    ],
)
def test_a_wrong_drive_is_refused(load, said):
    with pytest.raises(SpecError) as caught:
        spec.read(ARM + f"forces: [{load}]\n", "arm.yaml")
    (fault,) = caught.value.faults
    assert said in fault.message
