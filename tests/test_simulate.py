"""`eomgen simulate` as a user runs it: rows, words, drawings, mistakes."""

import csv
import json
import os
import random
import re
import signal
import subprocess
import sys
import time
from io import StringIO
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from commandline import eomgen
from scenes import LINKED, SHIPPED, study_of, text_of
from scipy.integrate import solve_ivp
from scipy.special import ellipk
from tools import library, tool

from eomgen.cache_folder import VARIABLE, root
from eomgen.numerics import adaptive, cache
from eomgen.simulate_method import rounded_down


def table(text):
    rows = list(csv.reader(StringIO(text)))
    return rows[0], np.array(rows[1:], float)


def simulate(call, name, *words, code=0):
    tool("cc")
    said = call("simulate", SHIPPED[name], *words)
    assert said.code == code, said.errors
    return said


def test_rows_are_named_with_units_and_read_back_equal(call):
    said = simulate(call, "simple_pendulum", "--t-end", 2, "--output-step", 0.5)
    head, rows = table(said.output)
    assert head == ["t [s]", "phi [rad]", "phi' [rad/s]", "kinetic [J]", "potential [J]"]
    assert rows[:, 0].tolist() == [0, 0.5, 1, 1.5, 2]
    assert rows[0, 1] == pytest.approx(np.pi / 3, abs=1e-15)
    written = said.output.splitlines()[3].split(",")
    assert written == [repr(float(w)) for w in written]


def test_the_period_of_a_pendulum_is_the_elliptic_integral(call):
    period = 4 * np.sqrt(1 / 9.81) * ellipk(np.sin(np.pi / 6) ** 2)
    said = simulate(call, "simple_pendulum", "--t-end", repr(float(period)), "--rtol", "1e-11")
    _, rows = table(said.output)
    np.testing.assert_allclose(rows[-1, 1:3], [np.pi / 3, 0], atol=1e-8)


METHODS = {
    "dop853": (), "lsoda": (), "radau": (), "cvode": (), "auto": (),
    "rk4": ("--step", 0.001), "dopri5": ("--step", 0.001), "rosenbrock2": ("--step", 0.0002),
    "midpoint": ("--step", 0.0002), "semi-euler": ("--step", 0.00005),
    "semi-euler-damped": ("--step", 0.00005),
}  # fmt: skip
LOOSE = {"rosenbrock2": 1e-5, "midpoint": 1e-5, "semi-euler": 3e-3, "semi-euler-damped": 3e-3}


QUICK = ("dop853", "cvode")
MARKED = [pytest.param(m, marks=() if m in QUICK else pytest.mark.slow) for m in METHODS]


@pytest.mark.parametrize("method", MARKED)
def test_every_method_comes_to_the_same_end(call, method):
    """Skew axes, full inertia, a damper and two inputs; the reference is SciPy on the Python."""
    if method == "cvode":
        library("sksundae")
    inputs = ("--input", "tau_1=0.5", "--input", "tau_2=-0.25")
    words = ("--t-end", 1, "--method", method, *METHODS[method], *inputs)
    said = simulate(call, "skew_arm", *words, "--output-step", 0.1, "--energy-tolerance", 0.1)
    _, rows = table(said.output)
    assert rows[:, 0] == pytest.approx(np.linspace(0, 1, 11), abs=1e-12)
    np.testing.assert_allclose(rows[-1, 1:5], reference(), rtol=0, atol=LOOSE.get(method, 1e-6))
    assert "energy: worst error" in said.errors
    assert "after work of" in said.errors


def reference():
    from eomgen.numerics.engine_python import EnginePython
    from eomgen.numerics.records import Arguments
    from eomgen.stepping import of

    steps = of(study_of("skew_arm"), ())
    parameters = tuple(float(p.value) for p in steps.program.parameters)
    slope = EnginePython(steps, Arguments((0.5, -0.25), parameters)).function("state_derivative")
    variables = (*steps.program.coordinates, *steps.program.speeds)
    start = [float(v.value) for v in variables]
    return solve_ivp(slope, (0, 1), start, "DOP853", rtol=1e-11, atol=1e-12).y[:, -1]


@pytest.mark.slow
def test_every_formulation_of_a_linked_scene_moves_alike(call):
    ends = []
    for formulation in ("minimal", "nullspace", "multiplier"):
        words = ("--t-end", 1, "--input", "tau=0.1", "--output-step", 0.25, "--rtol", "1e-10")
        said = simulate(call, "four_bar", *words, "--formulation", formulation)
        head, rows = table(said.output)
        found = rows[-1, [head.index(f"{q} [rad]") for q in ("q1", "q2", "q3")]]
        residual = 0.2 * np.exp(1j * found[0]) + 0.5 * np.exp(1j * found[1])
        assert abs(residual - 0.45 - 0.4 * np.exp(1j * found[2])) < 1e-12
        ends.append(found)
    assert abs(ends[0][0] - np.pi / 3) > 1  # it has moved
    np.testing.assert_allclose(ends[1:], [ends[0]] * 2, rtol=0, atol=1e-9)


@pytest.mark.slow
def test_a_stiff_scene_is_seen_and_a_smooth_one_too(call):
    stiff = text_of("quarter_car").replace("c_s: {value: 1200 N*s/m", "c_s: {value: 12000 kN*s/m")
    Path("stiff.yaml").write_text(stiff)
    said = call("simulate", "stiff.yaml", "--t-end", 1)
    assert said.errors.startswith("radau, rtol 1e-08 (stiff: a mode decays with ")
    assert said.code == 0
    said = simulate(call, "quarter_car", "--t-end", 1)
    assert said.errors.startswith("dop853, rtol 1e-08 (smooth and not stiff: fastest mode 7")
    # an unstable place has eigenvalues +-3.5/s, and nothing there is stiff
    said = simulate(call, "double_pendulum", "--t-end", 400, "--output-step", 100)
    assert said.errors.startswith("dop853, rtol 1e-08 (smooth and not stiff: fastest mode 3.48")
    said = simulate(call, "sprung_pair", "--t-end", 20000, "--energy-tolerance", 1)
    assert said.errors.startswith("verlet, step ")


def test_the_step_of_a_fixed_method_is_chosen_and_told(call):
    said = simulate(call, "double_pendulum", "--method", "rk4", "--t-end", 1)
    assert re.match(
        r"rk4, step 0\.01 s \(it was asked for; step 0\.01 s for the mode of", said.errors
    )
    assert [rounded_down(v) for v in (0.0149, 0.02, 0.99, 5.1, 1e-3)] == [0.01, 0.02, 0.5, 5, 1e-3]


def test_a_step_alone_means_rk4_and_a_rest_is_a_shorter_step(call):
    said = simulate(call, "simple_pendulum", "--step", 0.003, "--t-end", 0.1)
    assert said.errors.startswith("rk4, step 0.003 s (a step was given)")
    _, rows = table(said.output)
    assert rows[-1, 0] == pytest.approx(0.1, abs=1e-15)
    assert np.diff(rows[:, 0])[:-1] == pytest.approx(0.003)


def test_a_run_that_loses_its_energy_is_a_failure(call):
    words = ("--method", "semi-euler", "--step", 0.01, "--t-end", 20)
    said = simulate(call, "double_pendulum", *words, code=1)
    assert "W-ENERGY: the energy is off by" in said.errors
    simulate(call, "double_pendulum", *words, "--energy-tolerance", 10)


@pytest.mark.parametrize("name", ["kapitza_pendulum", "bead_on_turning_hoop"])
def test_what_depends_on_the_time_is_in_the_balance(call, name):
    """A pivot that shakes and a hoop that is turned do work, which is no error of the energy."""
    said = simulate(call, name, "--t-end", 1)
    found = re.search(r"energy: worst error (\S+) of \S+ J after work of (\S+) J", said.errors)
    assert float(found[1]) < 1e-6
    assert abs(float(found[2])) > 1e-4


def test_a_run_that_cannot_go_on_says_where_and_keeps_its_rows(call):
    words = ("--method", "rk4", "--step", 0.05, "--t-end", 100)
    text = text_of("spring_mass_chain").replace("k_1: 100 N/m", "k_1: 1e7 N/m")
    Path("wild.yaml").write_text(text)
    said = call("simulate", "wild.yaml", "--input", "F=0", *words)
    assert said.code == 1
    assert re.search(
        r"stopped after t = [\d.]+ s: the state is no longer finite.*x_1 = ", said.errors
    )
    assert len(table(said.output)[1]) > 2


def test_the_state_file_gives_start_inputs_and_parameters(call):
    state = {"t": 1, "coordinates": {"s": 0.2, "phi": 0}, "rates": {"s": 0, "phi": 0},
             "parameters": {"k": 0}, "inputs": {}}  # fmt: skip
    Path("state.json").write_text(json.dumps(state))
    name = "slider_spring_pendulum"
    said = simulate(call, name, "--state", "state.json", "--t-end", 1)
    _, rows = table(said.output)
    assert rows[0, :3].tolist() == [1, 0.2, 0]
    assert rows[-1, 0] == 2
    assert rows[-1, 1] == pytest.approx(0.2, abs=1e-12)  # no spring: it stays


def test_a_state_off_the_constraints_is_moved_and_it_is_told(call):
    state = {"coordinates": {"q1": 1, "q2": 0.4, "q3": 1.3}, "rates": {"q1": 0, "q2": 0, "q3": 0}}
    Path("state.json").write_text(json.dumps(state))
    said = simulate(call, "four_bar", "--state", "state.json", "--input", "tau=0", "--t-end", 0.1)
    assert "the state was moved to the constraints, by 0." in said.errors
    assert re.search(r"largest residual of position \S+e-1[567]", said.errors)


@pytest.mark.slow
def test_the_speeds_of_a_spec_are_integrated(call):
    inputs = [w for m in "xyz" for w in ("--input", f"M_{m}=0")]
    head, rows = table(simulate(call, "satellite", *inputs, "--t-end", 5).output)
    assert head[1:7] == ["psi [rad]", "theta [rad]", "phi [rad]", "p [1/s]", "q [1/s]", "r [1/s]"]
    spin = rows[:, 4:7] * [28, 35, 40]
    assert np.ptp(np.linalg.norm(spin, axis=1)) < 1e-8  # angular momentum


def test_without_a_compiler_the_python_runs_and_says_so(call, monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)
    for method in (("--method", "dop853"), ("--method", "rk4", "--step", 0.01)):
        said = call("simulate", SHIPPED["double_pendulum"], "--t-end", 0.5, *method)
        assert said.code == 0, said.errors
        assert "no C compiler: the generated Python runs" in said.errors
    assert len(table(said.output)[1]) == 51


@pytest.mark.slow
def test_without_scipy_a_fixed_step_runs_and_says_so(call, monkeypatch):
    for module in ("scipy", "scipy.integrate"):
        monkeypatch.setitem(sys.modules, module, None)
    monkeypatch.setattr("eomgen.simulate_method.find_spec", lambda name: None)
    said = simulate(call, "double_pendulum", "--t-end", 0.5)
    assert said.errors.startswith("rk4, step 0.01 s (smooth and not stiff")
    assert "SciPy is not installed" in said.errors
    said = simulate(call, "double_pendulum", "--method", "dop853", code=2)
    assert "dop853 needs SciPy: pip install 'eomgen[simulate]'" in said.errors


def test_files_are_written_and_never_overwritten(call):
    words = ("--t-end", 1, "-o", "d.csv", "--plot", "p.svg", "--animate", "a.html")
    said = simulate(call, "simple_pendulum", *words)
    assert said.output == ""
    before = {f: Path(f).read_bytes() for f in ("d.csv", "p.svg", "a.html")}
    for option, file in (("-o", "d.csv"), ("--plot", "p.svg"), ("--animate", "a.html")):
        said = simulate(call, "simple_pendulum", "--t-end", 1, option, file, code=2)
        assert f"{file}: is in the way; choose another file, or --force" in said.errors
    simulate(call, "simple_pendulum", *words, "--force")
    assert {f: Path(f).read_bytes() for f in before} == before  # and the same bytes


SWING = """eom: 1
system: Oscillator of one second
space: line
gravity: 0
parameters: {m: 1 kg, k: 39.47841760435743 N/m}
coordinates: {x: m}
bodies: {b: {mass: m, at: x}}
springs: [{along: x, stiffness: k}]
initial: {x: 1 m, x': 0 m/s}
"""


@pytest.mark.parametrize(
    ("words", "times"),
    [
        (("--t-end", 1, "--output-step", 5), [0, 1]),
        (("--t-end", 3, "--output-step", 1), [0, 1, 2, 3]),
        (("--t-end", 2.5, "--output-step", 1), [0, 1, 2, 2.5]),
        (("--t-end", 3, "--output-step", 1, "--step", 0.001), [0, 1, 2, 3]),
        (("--t-end", 2.5, "--output-step", 1, "--step", 0.001), [0, 1, 2, 2.5]),
        (("--t-end", 2.5004, "--output-step", 1, "--step", 0.001), [0, 1, 2, 2.5004]),
        (("--t-end", 2, "--output-step", 5, "--step", 0.001), [0, 2]),
    ],
)
def test_rows_a_period_apart_do_not_hide_the_energy(call, words, times):
    said = call("simulate", "-", *words, stdin=SWING)
    assert (said.code, "W-ENERGY" in said.errors) == (0, False), said.errors
    rows = list(csv.reader(StringIO(said.output)))[1:]
    assert [float(row[0]) for row in rows] == pytest.approx(times, abs=1e-12)


def test_power_of_rounding_alone_is_not_halved_for():
    """A force that moves a bead on a turning wire does no work on Jacobi's energy, to rounding."""
    chance, seen = random.Random(1), []

    def flow(t, state):
        seen.append(t)
        return np.array([3.0, 1e-17 * chance.uniform(-1, 1)])

    assert abs(adaptive.work_of(flow, 0.0, 0.1, lambda t: np.zeros(2))) < 1e-17
    assert len(seen) == 12  # the whole and its halves


def test_one_result_is_not_written_over_another(call):
    words = ("--t-end", 1, "-o", "d.csv", "--plot", "./d.csv", "--force")
    said = simulate(call, "simple_pendulum", *words, code=2)
    assert "d.csv: is asked for twice; give each result its own file" in said.errors
    assert not Path("d.csv").exists()


def test_an_input_that_a_scene_has_not_is_said_so(call):
    said = simulate(call, "simple_pendulum", "--input", "F=1", code=2)
    assert "inputs: unknown name 'F'; there are none" in said.errors


@pytest.mark.slow
def test_a_plot_has_a_panel_for_each_unit(call):
    simulate(call, "quarter_car", "--t-end", 1, "--plot", "p.svg")
    root = ElementTree.parse("p.svg").getroot()
    words = ["".join(t.itertext()) for t in root.iter("{http://www.w3.org/2000/svg}text")]
    assert [w for w in words if w.startswith("[")] == ["[m]", "[m/s^2]", "[N]"]
    assert {"Quarter-car suspension", "t [s]", "z_s", "travel", "comfort"} <= set(words)
    simulate(call, "quarter_car", "--t-end", 1, "--plot", "q.svg", "--show", "z_u'")
    assert "comfort" not in Path("q.svg").read_text()


@pytest.mark.slow
def test_an_animation_is_one_file_with_the_places_of_everything(call):
    inputs = ("--input", "tau_1=0", "--input", "tau_2=0")
    simulate(call, "skew_arm", *inputs, "--t-end", 1, "--animate", "a.html")
    text = Path("a.html").read_text()
    assert not re.search(r"(src|href)=", text)
    data = json.loads(re.search(r"^const data = (.*);$", text, re.M)[1])
    frames = np.array(data["frames"]).reshape(len(data["times"]), -1, 3)
    places = np.array(data["low"]) + data["unit"] * frames
    (upper, fore) = data["sketch"]["bodies"]
    # radii of gyration do not change, and no arm either
    for body in (upper, fore):
        for tip in body["tips"]:
            lengths = np.linalg.norm(places[:, tip] - places[:, body["at"]], axis=1)
            assert np.ptp(lengths) < 2e-3 * lengths.max()
    assert len(data["sketch"]["arms"]) >= 3


def test_the_script_of_an_animation_draws_every_frame(call):
    node = tool("node")
    simulate(call, "quarter_car", "--t-end", 1, "--animate", "a.html")
    script = re.search(r"<script>(.*)</script>", Path("a.html").read_text(), re.S)[1]
    Path("page.js").write_text(STAGE + script + ACT)
    done = subprocess.run([node, "page.js"], capture_output=True, text=True, check=True)
    calls, shown = done.stdout.split("|")
    assert int(calls) > 1000
    assert shown.strip() == "t = 0.50 s"


STAGE = """
let calls = 0, frame = null;
const pen = new Proxy({}, {get: () => (...a) => {
  if (a.some(v => typeof v === "number" && !Number.isFinite(v))) throw new Error("not finite");
  calls++;
}, set: () => true});
const parts = {c: {width: 1720, height: 1100, getContext: () => pen}, slide: {}, play: {},
               time: {}, speed: {value: "1"}};
const document = {getElementById: id => parts[id]};
const requestAnimationFrame = f => { frame = f; };
{
"""
ACT = """
}
frame(0);
for (let t = 0; t <= 500; t += 20) frame(t);
console.log(calls + "|" + parts.time.textContent);
"""


@pytest.mark.slow
def test_a_name_of_the_spec_cannot_leave_its_page(call):
    title = "</script><b>&amp; 'x'"
    text = text_of("simple_pendulum").replace("en: Simple pendulum", f'en: "{title}"')
    Path("evil.yaml").write_text(text)
    said = call("simulate", "evil.yaml", "--t-end", 0.1, "--plot", "p.svg", "--animate", "a.html")
    assert said.code == 0, said.errors
    assert Path("a.html").read_text().count("</script>") == 1
    ElementTree.parse("p.svg")


USAGE = {
    ("--t-end", "0"): "0.0 is not a positive number",
    ("--t-end", "-1"): "-1.0 is not a positive number",
    ("--t-end", "nan"): "nan is not a positive number",
    ("--t-end", "inf"): "inf is not a positive number",
    ("--t-end", "ten"): "'ten' is not a valid float",
    ("--step", "-0.1"): "-0.1 is not a positive number",
    ("--step", "1e-300"): "steps are too many: at most 1e+09",
    ("--step", "nan"): "nan is not a positive number",
    ("--rtol", "0"): "0.0 is not a positive number",
    ("--output-step", "1e-12"): "rows are too many: at most 1e+07",
    ("--step", "0.01", "--output-step", "0.015"): "is no multiple of the step 0.01; give 0.02",
    ("--method", "euler"): "'euler' is not one of",
    ("--method", "verlet"): "E-SYM: verlet is not symplectic for this model (M depends on phi_1)",
    ("--method", "dop853", "--step", "0.1"): "--step: dop853 finds its own",
    ("--method", "rk4", "--rtol", "1e-6"): "--rtol and --atol: rk4 has a fixed step",
    ("--state", "missing.json"): "cannot be read: No such file or directory",
    ("--state", "list.json"): "a run starts from one state, the file has 2",
    ("--state", "broken.json"): "the state file is not JSON",
    ("--state", "half.json"): "coordinates: unknown name 'phi'; did you mean",
    ("--state", "nan.json"): "coordinates phi_1: 'NaN' is not a finite decimal number",
    ("--input", "F=1"): "inputs: unknown name 'F'",
    ("--input", "F"): "--input 'F': write NAME=VALUE",
    ("--input", "a=1", "--input", "a=2"): "--input: a is given twice",
    ("--show", "psi"): "--show psi: there is no such column; there are t, phi_1",
    ("-o", "no/such/folder.csv"): "no/such/folder.csv: cannot be written",
    ("-o", "."): ".: is a folder; give a file",
    ("--formulation", "nullspace"): None,
}  # fmt: skip


@pytest.mark.parametrize("words", USAGE, ids=" ".join)
def test_a_wrong_call_is_explained(call, words):
    state = {"coordinates": {"phi_1": 0, "phi_2": 0}, "rates": {"phi_1": 0, "phi_2": 0}}
    Path("list.json").write_text(json.dumps([state, state]))
    Path("broken.json").write_text("{")
    Path("half.json").write_text(json.dumps({"coordinates": {"phi": 0}}))
    Path("nan.json").write_text('{"coordinates": {"phi_1": NaN}}')
    reason = USAGE[words]
    said = call("simulate", SHIPPED["double_pendulum"], *words)
    if reason is None:  # nothing is linked: every formulation is the same
        assert said.code == 0
        return
    assert said.code == 2, said.errors
    assert said.output == ""
    assert reason in said.errors


def test_missing_inputs_and_state_are_asked_for(call):
    said = call("simulate", SHIPPED["four_bar"])
    assert said.code == 2
    assert "inputs: tau is missing, and the spec has no value for it" in said.errors
    assert "--input tau=0" in said.errors
    text = re.sub(r"initial: .*\n", "", text_of("simple_pendulum"))
    Path("open.yaml").write_text(text)
    said = call("simulate", "open.yaml")
    assert said.code == 2
    assert "coordinates: phi is missing" in said.errors
    assert "give the state with --state FILE" in said.errors


def test_methods_that_remember_are_refused_where_constraints_must_be_kept(call):
    said = call("simulate", SHIPPED["four_bar"], "--method", "lsoda", "--input", "tau=0")
    assert said.code == 2
    assert (
        "lsoda remembers earlier steps, so it cannot be brought back to constraints" in said.errors
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", SHIPPED)
def test_every_shipped_spec_runs_and_keeps_its_energy(call, name):
    names = [i.name for i in study_of(name).model.inputs]
    inputs = [w for n in names for w in ("--input", f"{n}=0")]
    model = study_of(name).model
    animate = ("--animate", "a.html") if model.bodies or model.points else ()
    said = call("simulate", SHIPPED[name], "--t-end", 0.05 if name == "andrews_squeezer" else 2,
                "-o", "d.csv", "--plot", "p.svg", *animate, *inputs)  # fmt: skip
    if "has no value for it" in said.errors:
        pytest.skip("the spec leaves its initial state open")
    assert said.code == 0, said.errors
    assert "energy: worst error" in said.errors or name in LINKED


@pytest.mark.slow
def test_an_interrupted_run_keeps_what_it_wrote(tmp_path):
    tool("cc")
    words = eomgen("simulate", SHIPPED["double_pendulum"], "--method", "dop853", "--t-end", "1e5")
    process = subprocess.Popen(
        [*map(str, words), "-o", "d.csv", "--output-step", "0.01"], cwd=tmp_path,
        stderr=subprocess.PIPE, text=True, env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    file, since = tmp_path / "d.csv", time.monotonic()
    while not (file.exists() and file.stat().st_size > 20_000):
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() - since < 100
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert re.search(r"interrupted: what was computed up to here is written \(\d+ rows\)", said)
    assert "energy: worst error" in said
    rows = table(file.read_text())[1]
    assert len(rows) > 100
    assert f"({len(rows)} rows)" in said


def test_a_library_is_compiled_once_and_by_one(tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path / "cache"))
    made = []

    def make(place):
        made.append(place)
        (place / "library").write_text("done")

    name = cache.key(["text", "-O2"])
    folder = cache.folder(name, make)
    assert cache.folder(name, make) == folder
    assert len(made) == 1
    assert (folder / "library").read_text() == "done"
    assert [p.name for p in (tmp_path / "cache").iterdir()] == [name]
    assert cache.key(["text", "-O3"]) != name

    def fail(place):
        (place / "half").write_text("")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        cache.folder(cache.key(["other"]), fail)
    assert [p.name for p in (tmp_path / "cache").iterdir()] == [name]

    def overtaken(place):  # another process finishes first
        other = root() / cache.key(["race"])
        other.mkdir()
        (other / "library").write_text("first")
        (place / "library").write_text("second")

    found = cache.folder(cache.key(["race"]), overtaken)
    assert (found / "library").read_text() == "first"


@pytest.mark.slow
def test_many_processes_compile_the_same_scene_at_once(tmp_path):
    tool("cc")
    words = eomgen("simulate", SHIPPED["simple_pendulum"], "--t-end", "0.1")
    environment = os.environ | {VARIABLE: str(tmp_path / "cache")}
    running = [
        subprocess.Popen(list(map(str, words)), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                         text=True, env=environment)
        for _ in range(3)
    ]  # fmt: skip
    said = [p.communicate(timeout=120) for p in running]
    assert [p.returncode for p in running] == [0, 0, 0]
    assert len({out for out, _ in said}) == 1
    compiled = [f for f in (tmp_path / "cache").iterdir() if not f.name.startswith("templates-")]
    assert len(compiled) == 1
