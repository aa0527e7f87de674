"""A study -> its findings: modes, largest steps, conditioning, warnings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from importlib.util import find_spec

import numpy as np

from eomgen import compile_steps, stepping
from eomgen.chart import reference
from eomgen.chart.variants import Variant
from eomgen.errors import CheckError, UsageError
from eomgen.integrators.methods import METHODS, Method, chosen
from eomgen.numerics.records import Array
from eomgen.simulate_method import eigenvalues, stiff
from eomgen.simulate_setup import Setup, inputs_of, setup, start_of, touching_of
from eomgen.stability import conditions, measured, places, theory
from eomgen.stability.places import Looked
from eomgen.stability.records import (
    REST,
    START,
    Condition,
    Findings,
    Limit,
    Mode,
    Place,
    Rounding,
    Spectrum,
    Wish,
)
from eomgen.study import Study

ACCURACY = 1e-4
BY = "rk4"  # the method of the line I-STEP
PROBED = 3000.0  # radians; a longer run costs more than the answer is worth
LOSES = 1e-4  # relative error of accelerations in float that is worth a warning


def findings(study: Study, wish: Wish) -> Findings:
    """Everything that is known of fixed steps of a scene.

    Raises:
        UsageError: the scene has no plain motion, a method is not for it, a start is missing.
        CheckError: the state cannot be moved to the constraints.
    """
    made = _setup(study, wish)
    looked = places.look(made)
    if not looked.places:
        raise UsageError("the motion has no value at the start nor elsewhere; give another --state")
    methods = made.steps.methods
    spectra = [s for p in looked.places if p.kind in (START, REST) for s in _spectrum(p, wish)]
    values = np.concatenate([theory.rounded(p.matrix) for p in looked.places])
    conditioned = conditions.of(made, looked.places)
    mode = _lasting(looked, wish.horizon)
    accurate = _accurate(mode, wish.horizon)
    rounding = conditions.rounding(conditioned, methods, 0.0 if mode is None else mode.rate)
    limits = tuple(_limit(made, method, looked) for method in methods)
    fastest = _fastest(looked.places)
    return Findings(
        title=made.steps.program.title,
        name=made.steps.name,
        formulation="minimal" if study.links is None else study.links.chosen.name,
        horizon=wish.horizon,
        looked=looked.words,
        inputs=_inputs(made),
        spectra=tuple(spectra),
        fastest=fastest,
        limits=limits,
        accurate=accurate,
        conditions=conditioned,
        rounding=rounding,
        warnings=tuple(_warnings(made, stiff(values, wish.horizon), conditioned, rounding)),
        notes=tuple(_notes(made, wish, (fastest, mode, accurate), limits)),
        omitted=(*looked.omitted, *_omitted(made, wish)),
    )


def _setup(study: Study, wish: Wish) -> Setup:
    if study.model.guides:
        raise UsageError(
            "friction on two-sided constraints: the motion is that of a mode, stick or slip, so "
            "fixed steps have no largest one; `evaluate` and the generated code tell the modes"
        )
    scene = stepping.scene_of(study)
    methods = chosen(wish.integrators) if wish.integrators else _offered(scene)
    start = start_of(study, wish.state, inputs_of(wish.inputs))
    return setup(study, tuple(m.name for m in methods), start)


def _offered(scene: compile_steps.Scene) -> tuple[Method, ...]:
    return tuple(m for m in METHODS.values() if compile_steps.offers(scene, m))


def _inputs(made: Setup) -> tuple[tuple[str, float], ...]:
    names = [i.name for i in made.steps.program.inputs]
    return tuple(zip(names, made.start.given.inputs, strict=True))


def _modes(place: Place) -> list[Mode]:
    """Every mode that is no motion of constant rate, one of each conjugate pair, fastest first."""
    values = [complex(v) for v in theory.rounded(place.matrix) if v != 0 and v.imag >= 0]
    return [Mode(place.name, v) for v in sorted(values, key=lambda v: (-abs(v), -v.real))]


def _spectrum(place: Place, wish: Wish) -> Iterator[Spectrum]:
    modes = _modes(place)
    if modes:
        values = np.array([m.value for m in modes])
        yield Spectrum(modes[0], modes[-1], bool(stiff(values, wish.horizon).size))


def _fastest(looked: Iterable[Place]) -> Mode | None:
    firsts = [modes[0] for modes in map(_modes, looked) if modes]
    return max(firsts, key=lambda m: m.rate, default=None)


def _lasting(looked: Looked, horizon: float) -> Mode | None:
    """The fastest mode that is to be resolved: one that does not die at once, nor grows."""
    found = []
    for place in looked.places:
        modes = _modes(place)
        dying = stiff(np.array([m.value for m in modes]), horizon)
        found += [m for m in modes if m.value not in dying and m.value.real <= 0]
    return max(found, key=lambda m: m.rate, default=None)


def _accurate(mode: Mode | None, horizon: float) -> float | None:
    if mode is None:
        return None
    return theory.accurate_step(METHODS[BY], mode.value, horizon, ACCURACY)


def _limit(made: Setup, method: Method, looked: Looked) -> Limit:
    """The smallest prediction of all places, of equals at rest; by the C there, and in a run."""
    found = [(_predicted(method, p), p) for p in looked.places]
    predicted, place = min(found, key=lambda pair: (pair[0], pair[1].kind != REST))
    if not made.is_compiled:
        return Limit(method.name, predicted, place.name, None, None)
    seen = measured.largest_step(made, method, place, predicted)
    starts = [p for p in looked.of(START) if p is not place]
    runs = [measured.largest_step(made, method, p, predicted) for p in starts]
    return Limit(method.name, predicted, place.name, seen, runs[0] if runs else seen)


def _predicted(method: Method, place: Place) -> float:
    """The largest step for ever at rest; in motion, for as long as a run of `measured` is."""
    return theory.largest_step(method, place.motion, 0.0 if place.at_rest else measured.WEAK)


def _warnings(
    made: Setup, fast: Array, found: Sequence[Condition], rounding: Sequence[Rounding]
) -> Iterator[str]:
    study = made.study
    yield from study.report.warnings
    if study.links is not None:
        yield from study.links.scene.report.freedom.warnings
        for name, obstacle in study.links.scene.made.items():
            if isinstance(obstacle, UsageError) and "W-" in str(obstacle):
                yield _coded(name, str(obstacle))
    if said := conditions.singular_mass(made):
        yield said
    if fast.size:
        rate = float(np.max(np.abs(fast)))
        yield (
            f"W-STIFF: a mode decays with {rate:.4g}/s, much faster than the run is long: "
            "explicit steps are limited by it; use rosenbrock2"
        )
    for one in rounding:
        if one.real == "float" and one.error > LOSES:
            worst = max(found, key=lambda c: c.value)
            yield (
                f"W-F32: cond({worst.matrix}) {worst.value:.2g} at {worst.place} -> float error "
                f"about {one.error:.0e}; use absolute angles or double"
            )


def _coded(name: str, obstacle: str) -> str:
    """'minimal: W-DEAD: words' with the code in front."""
    words = obstacle.removeprefix(f"{name}: ")
    code, _, rest = words.partition(": ")
    return f"{code}: {name}: {rest}" if code.startswith("W-") else f"{name}: {words}"


Modes = tuple[Mode | None, Mode | None, float | None]  # fastest, to be resolved, step for it


def _notes(made: Setup, wish: Wish, modes: Modes, limits: Sequence[Limit]) -> Iterator[str]:
    fastest, lasting, accurate = modes
    bound = next((x.predicted for x in limits if x.method == BY), None)
    if fastest is not None and bound is not None:
        said = f"I-STEP: fastest mode {fastest}: {BY} h <= {bound:.3g} s is stable"
        if lasting is not None and accurate is not None:
            said += f", <= {accurate:.2g} s for {ACCURACY:g} of {lasting.rate:.3g} rad/s "
            said += f"over {wish.horizon:g} s"
        yield said
    yield from _chaos(made, wish)


def _chaos(made: Setup, wish: Wish) -> Iterator[str]:
    """I-CHAOS, of two runs that start 1e-8 apart."""
    if find_spec("scipy") is None or touching_of(made.study) is not None:
        return
    radians = _fastest_rate(made, wish.horizon) * wish.horizon
    if radians > PROBED:
        yield f"no word on chaos: {radians:.3g} radians of the fastest mode; shorten --horizon"
        return
    variant = Variant("", made, made.steps.methods, {"f64": made.engine})
    try:
        _, said = reference.trusted_horizon(variant, wish.horizon, ACCURACY)
    except CheckError:
        yield f"no word on chaos: the motion from the start does not last {wish.horizon:g} s"
        return
    yield said or f"no chaos seen over {wish.horizon:g} s from the start"


def _fastest_rate(made: Setup, horizon: float) -> float:
    """Of the modes at the start that last; zero where there are none."""
    values = eigenvalues(made)
    lasting = values[~np.isin(values, stiff(values, horizon))]
    return float(np.max(np.abs(lasting), initial=0.0))


def _omitted(made: Setup, wish: Wish) -> Iterator[str]:
    scene = stepping.scene_of(made.study)
    for method in METHODS.values():
        if not wish.integrators and not compile_steps.offers(scene, method):
            yield f"{method.name}: {compile_steps.refusal(scene, method)}"
    if not made.is_compiled:
        yield "the column 'by the C': there is no C compiler"
    if find_spec("scipy") is None:
        yield "chaos: SciPy is not installed; pip install 'eomgen[simulate]'"
    if touching_of(made.study) is not None:
        yield (
            "contacts: this is the motion while no contact touches; impacts, sticking and sliding "
            "have no largest step, and fixed steps do not locate them: eomgen simulate does"
        )
    if not made.steps.has("mass_matrix"):
        yield "the condition of M: M of so many coordinates is not written"
