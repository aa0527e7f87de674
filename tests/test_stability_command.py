"""eomgen stability: predicted and measured agree, and what is wrong with a scene is said."""

import json
import re

import numpy as np
import pytest
from commandline import run
from scenes import SHIPPED, study_of
from small_scenes import FREE_BODY, oscillator
from test_render_code_c import WARNINGS
from tools import tool

from eomgen import study
from eomgen.errors import UsageError
from eomgen.numerics import compiled
from eomgen.stability import header, make, words
from eomgen.stability.conditions import condition
from eomgen.stability.records import Wish

ARM = ("tau_1=0", "tau_2=0")


def found_of(text, **wish):
    tool("cc")
    return make.findings(study.of_text(text, "scene.yaml"), Wish(**wish))


def limits(found):
    return {x.method: x for x in found.limits}


def test_an_oscillator_has_the_limits_of_the_books():
    """omega = 2, zeta = 1/2."""
    found = found_of(oscillator("4", "2"))
    mode = found.fastest
    assert (mode.rate, mode.damping_ratio) == pytest.approx((2, 0.5))
    known = limits(found)
    root = np.sqrt(1.25)
    assert known["semi-euler"].predicted == pytest.approx(root - 0.5, rel=1e-5)
    assert known["semi-euler-damped"].predicted == pytest.approx(root + 0.5, rel=1e-5)
    # |R(z)| = 1 of RK4 on the ray of 60 degrees
    z = known["rk4"].predicted * 2 * np.exp(2j * np.pi / 3)
    assert abs(1 + z + z**2 / 2 + z**3 / 6 + z**4 / 24) == pytest.approx(1, abs=1e-6)
    for name in ("semi-euler", "semi-euler-damped", "rk4", "dopri5"):
        assert known[name].ratio == pytest.approx(1, abs=3e-3)
        assert known[name].run_ratio == pytest.approx(1, abs=3e-2)
    for name in ("rosenbrock2", "midpoint"):
        assert (known[name].predicted, known[name].measured) == (np.inf, np.inf)
        assert known[name].ratio is None


@pytest.fixture(scope="module")
def arm():
    tool("cc")
    return make.findings(study_of("skew_arm"), Wish(inputs=ARM))


@pytest.mark.slow
def test_a_spatial_arm_bears_what_its_eigenvalues_say(arm):
    """Skew axes, full inertia: the C at rest, and a run from the start."""
    for x in arm.limits:
        if np.isfinite(x.predicted):
            assert x.place == "equilibrium 1 (stable)"
            assert x.ratio == pytest.approx(1, abs=3e-3)
            assert x.run_ratio == pytest.approx(1, abs=0.1)
    assert {x.method for x in arm.limits} >= {"semi-euler-damped", "rk4", "midpoint"}
    assert "verlet: E-SYM" in "".join(arm.omitted)


@pytest.mark.slow
def test_modes_of_the_arm_are_those_of_its_differences(arm):
    """The slowest and the fastest eigenvalue at the start, by differences of the Python module."""
    from eomgen.numerics.engine_python import EnginePython
    from eomgen.simulate_setup import start_of
    from eomgen.stepping import of

    scene = study_of("skew_arm")
    began = start_of(scene, "{}", {"tau_1": "0", "tau_2": "0"})
    slope = EnginePython(of(scene, ()), began.given).function("state_derivative")
    size = 1e-6
    columns = [
        (slope(0.0, began.state + d) - slope(0.0, began.state - d)) / (2 * size)
        for d in size * np.eye(4)
    ]
    sizes = np.sort(np.abs(np.linalg.eigvals(np.array(columns).T)))
    spectrum = next(s for s in arm.spectra if s.fastest.place == "the start")
    assert spectrum.fastest.rate == pytest.approx(sizes[-1], rel=1e-6)
    assert spectrum.slowest.rate == pytest.approx(sizes[0], rel=1e-6)


@pytest.mark.slow
def test_the_page_and_the_json_say_the_same(call, arm):
    given = [w for name in ARM for w in ("--input", name)]
    said = call("stability", SHIPPED["skew_arm"], *given)
    assert said.code == 0
    assert said.output == words.text(arm)
    rows = {line.split()[0]: line.split() for line in said.output.splitlines() if line[:2] == "  "}
    data = json.loads(call("stability", SHIPPED["skew_arm"], *given, "--format", "json").output)
    for limit in data["largest_steps"]:
        shown = rows[limit["method"]][1]
        is_none = limit["predicted"] == "none"
        assert shown == ("none" if is_none else f"{limit['predicted']:.4g}")
    assert data["formulation"] == "minimal"
    assert re.search(r"I-STEP: fastest mode .* rad/s .*: rk4 h <= 0.281 s is stable", said.output)


@pytest.mark.slow
def test_stiffness_needs_damping_and_a_long_run():
    """Two-part rule: |Re| >= 0.3 |lambda| and |lambda| T > 1000."""
    slow = oscillator("4", "400")
    fast = oscillator("1000000", "2")  # hardly damped
    for text, horizon, is_stiff in ((slow, 10.0, True), (slow, 1.0, False), (fast, 10.0, False)):
        found = found_of(text, integrators=("rk4",), horizon=horizon)
        assert any("W-STIFF" in w for w in found.warnings) == is_stiff


def test_the_step_for_an_accuracy_is_the_phase_error_of_rk4():
    """(h omega)^4 omega T / 120 = 1e-4, which the line I-STEP says of the undamped mode."""
    found = found_of(oscillator("4", "0"))
    assert found.accurate == pytest.approx((120e-4 / 20) ** 0.25 / 2, rel=0.02)


SPHERICAL = """\
eom: 1
system: Particle on a sphere
space: solid
gravity: [0, 0, -g]
parameters: {m: 1 kg, l: 1 m, g: 9.81 m/s^2}
coordinates: {theta: rad, phi: rad}
points: {P: "l*[sin(theta)*cos(phi), sin(theta)*sin(phi), -cos(theta)]"}
bodies:
  bob: {mass: m, at: P}
initial: {theta: 1 rad, phi: 0 rad, theta': 0 rad/s, phi': 1 rad/s}
"""


@pytest.mark.slow
def test_a_position_without_inertia_is_found_in_the_range():
    found = found_of(SPHERICAL, integrators=("rk4",))
    (line,) = [w for w in found.warnings if "W-MASS" in w]
    assert re.search(r"near theta = (0|-?180) deg:", line)  # phi does not matter
    away = SPHERICAL + "range: {theta: [20 deg, 160 deg]}\n"
    assert not any("W-MASS" in w for w in found_of(away, integrators=("rk4",)).warnings)


@pytest.mark.slow
def test_singular_constraints_and_dead_points_are_named():
    tool("cc")
    found = make.findings(study_of("parallelogram"), Wish(integrators=("rk4",)))
    assert any("W-SING" in w and "q1 = 0, q2 = 0, q3 = 0" in w for w in found.warnings)
    assert any(w.startswith("W-DEAD: minimal: ") for w in found.warnings)
    assert limits(found)["rk4"].ratio == pytest.approx(1, abs=3e-3)
    assert {c.matrix for c in found.conditions} == {"M", "J M^-1 J'"}


HEAVY_END = """\
eom: 1
system: A light rod that carries a heavy one
space: plane
gravity: [0, -g]
parameters: {m: 1 kg, n: 1e6 kg, l: 1 m, g: 9.81 m/s^2}
coordinates: {a: rad, b: rad}
points: {A: "l*[sin(a), -cos(a)]", B: "A + l*[sin(a + b), -cos(a + b)]"}
bodies:
  upper: {mass: m, at: A}
  lower: {mass: n, at: B}
initial: {a: 0.3 rad, b: 0.3 rad, a': 0 rad/s, b': 0 rad/s}
"""


@pytest.mark.slow
def test_what_float_loses_is_said_with_the_condition_of_m():
    found = found_of(HEAVY_END, integrators=("rk4",))
    (cond,) = found.conditions
    single = next(r for r in found.rounding if r.real == "float")
    assert single.error == pytest.approx(cond.value * 2**-23 / 10)
    assert any("W-F32" in w for w in found.warnings)
    assert cond.value > 1e5
    light = found_of(HEAVY_END.replace("n: 1e6 kg", "n: 1 kg"), integrators=("rk4",))
    assert not any("W-F32" in w for w in light.warnings)


def test_a_condition_number_does_not_depend_on_units():
    matrix = np.array([[2.0, 1.0], [1.0, 3.0]])
    units = np.diag([1e-3, 1e4])
    assert condition(units @ matrix @ units) == pytest.approx(condition(matrix))
    assert condition(np.diag([1.0, 1e-9])) == 1
    assert condition(np.array([[1.0, 2.0], [2.0, 1.0]])) == np.inf


@pytest.mark.slow
def test_chaos_is_seen_where_neighbours_part(call, tmp_path):
    state = tmp_path / "far.json"
    state.write_text('{"coordinates": {"phi_1": 2.0, "phi_2": 2.5}}')
    wish = ("stability", SHIPPED["double_pendulum"], "--integrators", "rk4", "--horizon", "20")
    assert "I-CHAOS: lambda =" in call(*wish, "--state", state).output
    state.write_text('{"coordinates": {"phi_1": 0.1, "phi_2": 0.1}}')
    assert "no chaos seen" in call(*wish, "--state", state).output


@pytest.mark.slow
def test_contacts_are_left_out_with_words():
    tool("cc")
    found = make.findings(study_of("bouncing_ball"), Wish())
    assert any(line.startswith("contacts: this is the motion while no") for line in found.omitted)


def test_what_is_shaken_has_no_equilibria():
    """At rest at t = 0 only: a bisection that takes it for rest finds steps of no meaning."""
    text = oscillator("4", "0").replace("coordinates:", "prescribed: {w: sin(3*t)}\ncoordinates:")
    driven = text.replace('at: "[x]"', 'at: "[x + w]"')
    still, shaken = (found_of(t, integrators=("rk4",)) for t in (text, driven))
    assert any("equilibri" in word for word in still.looked)
    assert shaken.looked == ("the start",)
    assert any("depends on the time" in line for line in shaken.omitted)


@pytest.mark.slow
def test_gimbals_are_named():
    found = found_of(FREE_BODY, integrators=("rk4",))
    assert any("W-GIMBAL" in w for w in found.warnings)
    assert any("W-MASS" in w and "pitch = " in w for w in found.warnings)


@pytest.mark.parametrize(
    ("spec", "options", "reason"),
    [
        ("bead_on_rough_wire", [], "the motion is that of a mode, stick or slip"),
        ("four_bar", [], "--input tau=0"),
        ("four_bar", ["--input", "tau"], "write NAME=VALUE"),
        ("double_pendulum", ["--integrators", "verlet"], "E-SYM: verlet is not symplectic"),
        ("double_pendulum", ["--integrators", "semi-euler-damped"], "E-DAMP: "),
        ("double_pendulum", ["--integrators", "euler"], "there is no integrator 'euler'"),
        ("double_pendulum", ["--horizon", "-1"], "is not a positive number"),
        ("double_pendulum", ["--state", "no.json"], "cannot be read"),
    ],
)
def test_what_cannot_be_is_refused(spec, options, reason, call):
    said = call("stability", SHIPPED[spec], *options)
    assert (said.code, said.output) == (2, "")
    assert reason in said.errors


def test_spec_and_state_cannot_both_be_standard_input(call):
    assert call("stability", "-", "--state", "-", stdin="").code == 2


def test_without_a_compiler_the_prediction_is_left(monkeypatch):
    def missing():
        raise UsageError("no C compiler")

    monkeypatch.setattr(compiled, "compiler", missing)
    found = make.findings(
        study.of_text(oscillator("4", "2"), "scene.yaml"), Wish(integrators=("rk4",))
    )
    assert limits(found)["rk4"].measured is None
    assert any("no C compiler" in line for line in found.omitted)
    assert " -  " in words.text(found)


def written(name, folder, *more):
    run_words = ("generate", SHIPPED[name], "-t", "c", "--with-stability", *more, "-o", folder)
    return run_words, folder / f"{name}.h"


@pytest.mark.slow
@pytest.mark.parametrize("real", ["double", "float"])
def test_the_header_compiles_in_c_and_cpp_and_its_numbers_are_those_of_the_command(
    call, arm, tmp_path, real
):
    given = [w for name in ARM for w in ("--input", name)]
    command, path = written("skew_arm", tmp_path, *given)
    assert call(*command).code == 0
    text = path.read_text()
    names = re.findall(r"^#define (SKEW_ARM_[A-Z0-9_]+) \S", text, re.M)
    assert {"SKEW_ARM_MAX_STEP_RK4", "SKEW_ARM_FASTEST_MODE", "SKEW_ARM_CONDITION",
            "SKEW_ARM_SAFE_FLOAT"} <= {*names}  # fmt: skip
    prints = "\n".join(f'    printf("{n} %.9g\\n", (double){n});' for n in names)
    main = tmp_path / "main.c"
    main.write_text(
        f'#include <stdio.h>\n#include "skew_arm.h"\nint main(void)\n{{\n{prints}\n'
        "    return 0;\n}\n"
    )
    define = ["-DSKEW_ARM_FLOAT"] if real == "float" else []
    run(tool("g++"), "-Wall", "-Wextra", "-Werror", *define, "-x", "c++", main, "-fsyntax-only")
    run(tool("cc"), *WARNINGS, *define, main, "-o", tmp_path / "main")
    shown = dict(line.split() for line in run(tmp_path / "main").splitlines())
    rk4 = limits(arm)["rk4"]
    assert 0.9 * rk4.safe < float(shown["SKEW_ARM_MAX_STEP_RK4"]) <= rk4.safe
    assert float(shown["SKEW_ARM_FASTEST_MODE"]) == pytest.approx(arm.fastest.rate, rel=1e-3)
    assert shown["SKEW_ARM_SAFE_FLOAT"] == "1"
    assert "SKEW_ARM_MAX_STEP_MIDPOINT" not in shown  # it has no limit


def test_a_step_is_rounded_down():
    assert header.rounded_down(0.2811) == "2.8e-01"
    assert header.rounded_down(0.28) == "2.8e-01"
    assert header.rounded_down(9.999e-4) == "9.9e-04"
    assert header.rounded_down(0.0) == "0.0"


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["-t", "python", "--with-stability"], "--with-stability is about C"),
        (["-t", "c", "--input", "tau=1"], "--input is a value for --with-stability"),
        (["-t", "c", "--with-stability"], "--input tau=0"),
    ],
)
def test_what_the_header_cannot_have_is_refused(options, reason, call, tmp_path):
    said = call("generate", SHIPPED["four_bar"], "-o", tmp_path / "out", *options)
    assert said.code == 2
    assert reason in said.errors
    assert not (tmp_path / "out").exists()
