"""Numbers: three engines and 50 digits agree at random states, on every shipped spec."""

import json
from functools import cache

import mpmath
import pytest
from studies import NAMES, model, study

from eomgen import evaluate, states
from eomgen.checks import samples
from eomgen.errors import CheckError, UsageError
from eomgen.states import State

STATES = 5


@cache
def random_states(name: str) -> tuple[State, ...]:
    scene = model(name)
    drawn = samples.draw(scene, STATES, seed=7)
    count = len(scene.coordinates)
    entries = []
    for i in range(STATES):
        moving = [column[i] for column in drawn.state]
        speeds = dict(zip([s.name for s in scene.speeds], moving[count:], strict=False))
        rates = dict(zip([c.name for c in scene.coordinates], moving[count:], strict=True))
        entries.append(
            {
                "t": drawn.time[i],
                "coordinates": dict(
                    zip([c.name for c in scene.coordinates], moving[:count], strict=True)
                ),
                **({"speeds": speeds} if speeds else {"rates": rates}),
                "inputs": {n.name: v[i] for n, v in zip(scene.inputs, drawn.inputs, strict=True)},
            }
        )
    return states.read(json.dumps(entries), scene, needs_time=True)


@cache
def results(name: str, using: str, digits: int) -> list[evaluate.Result]:
    found = study(name)
    return evaluate.evaluate(found.machine, found.program, random_states(name), using, digits)


def largest_error(exact: evaluate.Result, found: evaluate.Result) -> float:
    """The worst error, relative to the largest value of the same group."""
    worst = 0.0
    for group, values in exact.items():
        wanted = {name: mpmath.mpf(v) for name, v in values.items()}
        size = max((abs(v) for v in wanted.values()), default=mpmath.mpf(1)) or mpmath.mpf(1)
        for name, value in wanted.items():
            worst = max(worst, float(abs(mpmath.mpf(found[group][name]) - value) / size))
    return worst


@pytest.mark.parametrize("using", ["interpreter", "python", "c"])
@pytest.mark.parametrize("name", NAMES)
def test_engines_agree_with_50_digits(name: str, using: str) -> None:
    with mpmath.workdps(60):
        pairs = zip(results(name, "interpreter", 50), results(name, using, 17), strict=True)
        assert max(largest_error(exact, found) for exact, found in pairs) < 1e-12


def test_50_digits_are_50_digits() -> None:
    with mpmath.workdps(120):
        fifty, hundred = (results("heavy_top", "interpreter", d) for d in (50, 100))
        error = max(largest_error(a, b) for a, b in zip(hundred, fifty, strict=True))
    assert 0 < error < 1e-48
    assert len(fifty[0]["energy"]["kinetic"].replace(".", "").lstrip("0")) == 50


def test_an_engine_in_double_refuses_more_digits() -> None:
    with pytest.raises(UsageError, match="use the interpreter"):
        results("slider_pendulum", "c", 30)


def test_fewer_digits_are_rounded() -> None:
    (first, *_) = results("slider_pendulum", "python", 3)
    assert len(f"{first['energy']['kinetic']!r}".replace(".", "").strip("0-")) <= 3


@pytest.mark.parametrize("using", ["interpreter", "python", "c"])
def test_a_singular_mass_matrix_is_an_error_everywhere(using: str) -> None:
    found = study("slider_pendulum")
    text = '{"inputs": {"F": 0}, "parameters": {"m_A": 0, "m_B": 0}, "rates": {"s": 0, "phi": 0}}'
    state = states.read(text, found.model, needs_time=False)
    with pytest.raises(CheckError, match="state 1: .*singular"):
        evaluate.evaluate(found.machine, found.program, state, using, 17)


def test_time_is_needed_only_where_it_matters() -> None:
    assert evaluate.depends_on_time(study("kapitza_pendulum").program)
    assert not evaluate.depends_on_time(study("slider_pendulum").program)


def test_random_states_are_random() -> None:
    assert len(set(random_states("skew_arm"))) == STATES
