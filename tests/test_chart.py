"""Speed against accuracy: the rules, the runs, the files, and that the recommendation holds."""

import csv
import io
import json
from dataclasses import replace

import numpy as np
import pytest
from scenes import SHIPPED, study_of, text_of
from tools import tool

from eomgen import charting, study
from eomgen.chart import draw, front, make, page, reference, runs, tables, variants
from eomgen.chart.records import Chart, Combination, Errors, Point, Reference, Sweep
from eomgen.errors import CheckError, UsageError
from eomgen.simulate_method import Choice
from eomgen.spec import read

NAN = float("nan")


def point(cost, error, **more):
    more = {"step": 0.01, "status": "ok", "name": "rk4", "precision": "f64"} | more
    step, status, name, precision = (more.pop(k) for k in ("step", "status", "name", "precision"))
    given = {"formulation": "minimal", "order": 4, "states": 4, "projects": False} | more
    run = Combination(integrator=name, precision=precision, step=step, **given)
    return Point(run, status, Errors(error, error / 2, NAN, 0.0, 0.0), cost)


def chart_of(points, **sweep):
    return Chart("T", "t", "0", Sweep(**sweep), 10.0, Reference(("a", "b"), 1e-12), tuple(points),
                 (), {})  # fmt: skip


def test_the_front_has_margins_for_noise():
    a, b = point(1.0, 1e-3), point(2.0, 1e-5)
    beaten = point(2.5, 1e-3)
    near = point(1.05, 1.1e-3)  # neither 10 % dearer nor 20 % worse: as good as a
    failed = point(0.1, 1e-9, status="energy")
    assert front.front([beaten, failed, b, near, a]) == (a, near, b)


def test_what_is_recommended_has_a_margin_and_a_neighbour_that_did_not_fail():
    good, larger = point(2.0, 4e-5, step=0.01), point(1.0, 3e-4, step=0.02)
    assert front.recommended(chart_of([good, larger])) == good
    assert front.recommended(chart_of([good, larger], target=6e-5)) is None  # margin of two
    lucky = [good, replace(larger, status="nan")]
    assert front.recommended(chart_of(lucky)) is None
    assert front.recommended(chart_of([good])) is None  # nothing is known of a larger step


def test_of_equal_costs_the_simplest_is_recommended():
    steps = [0.01, 0.02]
    projected = [point(1.0, 1e-6, step=h, states=6, projects=True) for h in steps]
    plain = [point(1.08, 1e-6, step=h, name="dopri5", states=2) for h in steps]
    assert front.recommended(chart_of([*projected, *plain])) in plain


def test_the_budget_counts_microseconds_of_a_step():
    found = [replace(point(1.0, 1e-6, step=h), seconds=1e-3) for h in (0.01, 0.02)]
    assert front.recommended(chart_of(found, budget=11.0)) is not None
    assert front.recommended(chart_of(found, budget=9.0)) is None


def test_the_sentence_says_what_the_chart_shows():
    points = [
        replace(point(2.0, 4e-5, step=0.005), seconds=7e-5),
        replace(point(1.0, 3e-4, step=0.01), seconds=4e-5),
        point(1.0, 1e-3, step=0.01, precision="f32"),
        *(replace(point(3.0, 2e-5, step=h, name="dopri5"), seconds=7.7e-5) for h in (0.01, 0.02)),
    ]
    said = front.sentence(chart_of(points))
    assert said == (
        "For error <= 0.0001 over 10 s: minimal + rk4, h = 5 ms, double: 0.07 ms per simulated "
        "second, error 4e-05 (margin 2.5x). Best float: minimal + rk4, h = 10 ms misses (1e-03). "
        "Next: minimal + dopri5 +10 % time. Not resolved below 1e-12 (reference)."
    )
    assert "none of these runs" in front.sentence(chart_of(points, target=1e-9))


@pytest.fixture(scope="module")
def pendulums():
    tool("cc")
    sweep = Sweep(horizon=4.0, precisions=("f64",), seconds=20.0)
    return make.chart(study_of("double_pendulum"), sweep, "{}", {})


ORDERS = {"semi-euler": 1, "rk4": 4, "dopri5": 5, "rosenbrock2": 2, "midpoint": 2}


@pytest.mark.parametrize("name", ORDERS)
def test_errors_fall_with_the_order_of_the_method(name, pendulums):
    found = [p for p in pendulums.good if p.run.integrator == name and p.resolved]
    found = sorted(found, key=lambda p: p.run.step)[:4]
    steps, errors = [p.run.step for p in found], [p.errors.judged for p in found]
    slope = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert slope == pytest.approx(ORDERS[name], abs=0.5)


def test_the_reference_is_known_better_than_what_it_judges(pendulums):
    assert pendulums.reference.error < 1e-9
    assert all(p.resolved == (p.errors.judged > 10 * pendulums.reference.error)
               for p in pendulums.good)  # fmt: skip


def test_operations_are_exact_and_seconds_were_measured(pendulums):
    by_method = {p.run.integrator: p.operations * p.run.step for p in pendulums.points}
    assert by_method["dopri5"] / by_method["rk4"] == pytest.approx(6 / 4, rel=0.1)
    assert all(p.seconds and p.median >= p.seconds for p in pendulums.good)


def test_the_files_say_the_same(pendulums):
    found = json.loads(tables.as_json(pendulums))
    assert found["schema"] == 1
    assert found["spec"] == study_of("double_pendulum").model.digest
    rows = list(csv.DictReader(io.StringIO(tables.as_csv(pendulums))))
    assert len(rows) == len(found["runs"]) == len(pendulums.points)
    for row, run in zip(rows, found["runs"], strict=True):
        assert row["status"] == run["status"]
        assert (float(row["positions"]) if row["positions"] else None) == run["positions"]
    best = front.recommended(pendulums)
    assert found["recommended"]["step"] == best.run.step
    assert front.sentence(pendulums) in tables.as_markdown(pendulums)


@pytest.mark.slow
def test_the_page_draws_itself(pendulums, tmp_path):
    from commandline import run

    latex = tool("pdflatex")
    for name, text in charting.texts(pendulums).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    run(latex, "-interaction=nonstopmode", "-halt-on-error", "chart.tex", folder=tmp_path)
    assert (tmp_path / "chart.pdf").stat().st_size > 10_000
    log = (tmp_path / "chart.log").read_text(encoding="utf-8", errors="replace")
    assert "Warning" not in log
    assert "Overfull" not in log
    assert "Output written on chart.pdf (1 page" in log


def test_the_page_draws_no_line_without_points():
    """A panel names the lines that it has; the legend names all, whatever the panels show."""
    exact, rough = point(1.0, 1e-3), point(2.0, 1e-4, name="dopri5")
    rough = replace(rough, errors=replace(rough.errors, constraint=1e-9))
    found = page.context(chart_of([exact, rough]))
    lines = {p["column"]: p["series"] for p in found["panels"]}
    both = ["minimal-rk4-f64", "minimal-dopri5-f64"]
    assert lines == {"positions": both, "rates": both, "constraint": both[1:]}
    assert [one["key"] for one in found["series"]] == both


def test_failures_stand_beside_the_runs_that_succeed():
    pyplot = pytest.importorskip("matplotlib.pyplot")
    good = [point(10.0**k, 10.0**-k, formulation=name) for k in range(4) for name in draw.COLOURS]
    failed = [replace(p, status="energy") for p in good]
    figure = draw.figure(pyplot, chart_of(good + failed))
    (lost, reached) = [], []
    for line in figure.axes[0].lines:
        across = line.get_transform().transform(line.get_xydata())[:, 0]
        if line.get_marker() in ("x", draw.MARKERS["rk4"]):
            (lost if line.get_marker() == "x" else reached).extend(across)
    pyplot.close(figure)
    assert (len(lost), len(reached) >= len(good)) == (len(failed), True)
    assert min(lost) > max(reached)


def test_outputs_have_errors_of_their_own(pendulums):
    """Where the outputs are the coordinates, the two errors are the same."""
    tool("cc")
    sweep = Sweep(horizon=2.0, precisions=("f64", "f32"), integrators=("rk4",), seconds=10.0)
    text = text_of("double_pendulum") + "outputs: {one: phi_1, other: phi_2}\n"
    found = make.chart(study.of_text(text, "s.yaml"), sweep, "{}", {})
    assert {p.run.precision for p in found.good} == {"f64", "f32"}
    assert all(p.errors.outputs == p.errors.positions > 0 for p in found.good)
    assert ",outputs,energy," in tables.as_csv(found)
    assert "outputs" in charting.texts(found)["chart.tex"]
    assert all(run["outputs"] is None for run in json.loads(tables.as_json(pendulums))["runs"])


def test_the_pictures_are_the_same_each_time(pendulums):
    one, other = draw.drawn(pendulums), draw.drawn(pendulums)
    assert one == other
    assert one["svg"].startswith(b"<?xml")
    assert one["png"].startswith(b"\x89PNG")


def test_formulations_of_a_linked_scene_are_charted_against_each_other():
    tool("cc")
    sweep = Sweep(horizon=1.0, precisions=("f64",), integrators=("rk4",), seconds=20.0)
    found = make.chart(study_of("four_bar"), sweep, "{}", {"tau": "0"})
    assert {p.run.formulation for p in found.good} == {"minimal", "nullspace", "multiplier"}
    assert "minimal, dop853" in found.reference.about[0]
    assert "multiplier, dopri5" in found.reference.about[1]
    assert found.reference.error < 1e-9
    assert {p.run.projects for p in found.points if p.run.formulation == "minimal"} == {False}
    assert max(p.errors.constraint for p in found.good) < 1e-4


def test_chaos_cuts_the_horizon():
    tool("cc")
    study = study_of("double_pendulum")
    state = json.dumps({"coordinates": {c.name: 2.5 for c in study.model.coordinates}})
    (only,) = variants.of(study, state, {}, ())
    horizon, said = reference.trusted_horizon(only, 60.0, 1e-4)
    assert 1.0 < horizon < 60.0
    assert said.startswith("I-CHAOS: lambda = ")
    calm, nothing = reference.trusted_horizon(variants.of(study, "{}", {}, ())[0], 5.0, 1e-4)
    assert (calm, nothing) == (5.0, "")


def test_steps_meet_the_output_times():
    for step in (1e-4, 0.0123, 0.05, 0.1, 0.7):
        grid, stride = runs._grid(0.0, 10.0, step)
        assert grid.step <= step * 1.001
        assert grid.count * grid.step == pytest.approx(10.0, rel=1e-12)
        assert (reference.OUTPUTS // stride) * grid.every == grid.count


SPECS = ("double_pendulum", "slider_pendulum", "four_bar", "flyball_governor")


def table_of(said):
    """Column -> values of a CSV on standard output, names without units."""
    assert said.code == 0, said.errors
    head, *rows = csv.reader(io.StringIO(said.output))
    columns = zip(*[[float(v) for v in row] for row in rows], strict=True)
    return dict(zip([n.split(" [")[0] for n in head], map(np.array, columns), strict=True))


@pytest.mark.slow
@pytest.mark.parametrize("name", SPECS)
def test_the_recommendation_holds(name, tmp_path, call):
    """Run again as recommended, by the command line, and compare with an adaptive method."""
    tool("cc")
    spec = tmp_path / f"{name}.yaml"
    spec.write_text(text_of(name), encoding="utf-8")
    inputs = {"four_bar": ("--input", "tau=0"), "slider_pendulum": ("--input", "F=0")}.get(name, ())
    end = "2" if name == "flyball_governor" else "10"
    words = ("--horizon", end, "--precisions", "f64", "--out", tmp_path / "out", "--apply")
    said = call("chart", spec, *inputs, *words)
    assert said.code == 0, said.errors
    best = json.loads((tmp_path / "out" / "chart.json").read_text(encoding="utf-8"))["recommended"]
    wish = (*inputs, "--t-end", end, "--output-step", repr(best["step"]))
    again = call("simulate", spec, *wish)
    assert f"{best['integrator']}, step " in again.errors
    method = "radau" if name == "flyball_governor" else "dop853"
    exact = table_of(call("simulate", spec, *wish, "--method", method, "--rtol", "1e-10"))
    found = table_of(again)
    np.testing.assert_allclose(found["t"], exact["t"], rtol=1e-9, atol=1e-12)
    for coordinate in study_of(name).model.coordinates:
        values = exact[coordinate.name]
        scale = max(np.abs(values).max(), reference.THRESHOLD)
        assert np.abs(found[coordinate.name] - values).max() < 1e-4 * scale


def test_apply_writes_one_line_and_keeps_the_rest(tmp_path):
    spec = tmp_path / "s.yaml"
    spec.write_text("# mine\n" + text_of("double_pendulum").rstrip("\n"), encoding="utf-8")
    good = [point(2.0, 1e-6, step=0.01), point(1.0, 1e-3, step=0.02)]
    charting.apply(chart_of(good), spec)
    text = spec.read_text(encoding="utf-8")
    assert text.startswith("# mine\n")
    assert text.endswith("\nsimulate: {method: rk4, step: 0.01 s, formulation: minimal}\n")
    charting.apply(chart_of([point(2.0, 1e-6, step=h, name="dopri5") for h in (0.01, 0.02)]), spec)
    assert spec.read_text(encoding="utf-8").count("simulate:") == 1
    found = read(spec.read_text(encoding="utf-8"), "s.yaml").simulation
    assert (found.method, float(found.step), found.formulation) == ("dopri5", 0.01, "minimal")


def test_apply_leaves_what_the_author_wrote(tmp_path):
    spec = tmp_path / "s.yaml"
    text = text_of("double_pendulum") + "simulate: {method: lsoda}\n"
    spec.write_text(text, encoding="utf-8")
    good = [point(2.0, 1e-6, step=h) for h in (0.01, 0.02)]
    with pytest.raises(UsageError, match="of its own"):
        charting.apply(chart_of(good), spec)
    with pytest.raises(CheckError, match="nothing was written"):
        charting.apply(chart_of([]), spec)
    assert spec.read_text(encoding="utf-8") == text


WRONG = {
    ("--steps", "1e-4:1e-2:8"): "the largest comes first",
    ("--steps", "banana"): "is not LARGEST:SMALLEST:COUNT",
    ("--steps", "1e-2:1e-4:4000"): "at most",
    ("--steps", "nan:1e-4:4"): "the largest comes first",
    ("--target-error", "-1"): "is not a positive number",
    ("--horizon", "inf"): "is not a positive number",
    ("--precisions", "f16"): "none of f64, f32",
    ("--precisions", ""): "name f64, f32 or both",
    ("--integrators", "euler"): "there is no integrator 'euler'",
    ("--formulations", "multiplier"): "has no formulation 'multiplier'",
    ("--input", "F"): "write NAME=VALUE",
}


@pytest.mark.parametrize("words", WRONG, ids=" ".join)
def test_wrong_wishes_are_refused(words, call, tmp_path):
    said = call("chart", SHIPPED["double_pendulum"], *words, "--out", tmp_path / "out")
    assert said.code == 2
    assert WRONG[words] in " ".join(said.errors.split())
    assert not (tmp_path / "out").exists()


def test_what_lies_in_the_way_is_kept(call, tmp_path):
    tool("cc")
    (tmp_path / "chart.csv").write_text("mine", encoding="utf-8")
    words = ("--horizon", "1", "--integrators", "rk4", "--precisions", "f64", "--seconds", "5")
    said = call("chart", SHIPPED["simple_pendulum"], *words, "--out", tmp_path)
    assert said.code == 2
    assert "in the way" in said.errors
    assert (tmp_path / "chart.csv").read_text(encoding="utf-8") == "mine"


def test_contacts_have_no_chart():
    with pytest.raises(UsageError, match="eomgen simulate runs it"):
        variants.of(study_of("bouncing_ball"), "{}", {}, ())


def test_the_start_of_the_reference_is_the_start_of_the_runs():
    (only,) = variants.of(study_of("simple_pendulum"), "{}", {}, ())
    times = reference.output_times(0.0, 1.0)
    motion = reference.motion_of(only, Choice("dop853", "", limits=reference.TIGHT), times)
    places, rates = only.places(times[:1], only.setup.start.state[None, :])
    np.testing.assert_array_equal(motion.places[0], places[0])
    np.testing.assert_array_equal(motion.rates[0], rates[0])


def test_variants_is_told_what_was_asked_for():
    found = variants.of(study_of("four_bar"), "{}", {"tau": "0"}, ("nullspace",))
    assert [v.name for v in found] == ["nullspace"]
