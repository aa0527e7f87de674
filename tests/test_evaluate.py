"""Numbers: three engines and 50 digits agree at random states, on every shipped spec."""

import json
from collections.abc import Iterator
from functools import cache
from typing import Any

import mpmath
import pytest
from scenes import LINKED, each
from studies import NAMES, model, study

from eomgen import evaluate, states
from eomgen.algebra.arithmetic import evaluate as node_values
from eomgen.algebra.arithmetic import mpmath_arithmetic
from eomgen.answers import Question, answers
from eomgen.checks import samples
from eomgen.errors import CheckError, UsageError
from eomgen.mechanics import machine
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
        rates = dict(zip([c.name for c in scene.coordinates], moving[count:], strict=False))
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


# linked scenes: by the program with multipliers, at random states on the constraints


def admissible_states(name: str) -> str:
    """A state file in 60 digits, with random inputs."""
    found = study(name).links
    assert found is not None
    scene = found.scene.model
    drawn = samples.draw(scene, STATES, seed=7)

    def text(names: list[str], values: tuple[Any, ...]) -> dict[str, str]:
        return {n: mpmath.nstr(v, 60) for n, v in zip(names, values, strict=True)}

    coordinates = [c.name for c in scene.coordinates]
    parameters = [p.name for p in machine.free_parameters(scene)]
    entries = [
        {
            "t": mpmath.nstr(at.state.time, 60),
            "coordinates": text(coordinates, at.state.coordinates),
            "rates": text(coordinates, at.state.rates),
            "inputs": {n.name: v[i] for n, v in zip(scene.inputs, drawn.inputs, strict=True)},
            "parameters": text(parameters, at.state.parameters),
        }
        for i, at in enumerate(found.scene.report.states)
    ]
    assert len(entries) == STATES
    return json.dumps(entries)


@cache
def linked_results(name: str, using: str, digits: int) -> list[evaluate.Result]:
    with mpmath.workdps(80):
        text = admissible_states(name)
    return answers(study(name), text, Question(using, digits))


def leaves(values: dict[str, Any], path: tuple[str, ...] = ()) -> Iterator[tuple[Any, Any]]:
    """The numbers of nested groups, each with its path; words are passed over."""
    for name, value in values.items():
        if name in ("holds", "because", "words"):
            continue
        if isinstance(value, list):
            value = {str(place): v for place, v in enumerate(value)}
        if isinstance(value, dict):
            yield from leaves(value, (*path, name))
        elif not isinstance(value, bool) and name not in ("on", "meaning", "must_be", "words"):
            yield (*path, name), mpmath.mpf(value)


def largest_linked_error(exact: evaluate.Result, found: evaluate.Result) -> float:
    """The worst error, relative to the largest value of its group; of residuals in SI."""
    worst = 0.0
    for group, values in exact.items():
        wanted, got = dict(leaves(values)), dict(leaves(found[group]))
        assert wanted.keys() == got.keys()
        size = max(map(abs, wanted.values()), default=0) or 1
        size = 1 if group == "residuals" else size
        worst = max([worst, *(float(abs(got[p] - v) / size) for p, v in wanted.items())])
    return worst


@pytest.mark.parametrize(
    "using", ["interpreter", "python", pytest.param("c", marks=pytest.mark.slow)]
)
@each(LINKED)
def test_engines_agree_with_50_digits_on_the_constraints(name: str, using: str) -> None:
    exact, found = linked_results(name, "interpreter", 50), linked_results(name, using, 17)
    assert all(a.keys() == b.keys() for a, b in zip(exact, found, strict=True))
    with mpmath.workdps(60):
        pairs = zip(exact, found, strict=True)
        assert max(largest_linked_error(a, b) for a, b in pairs) < 1e-12


@each(LINKED)
def test_residuals_vanish_and_gaps_are_open_at_admissible_states(name: str) -> None:
    for result in linked_results(name, "interpreter", 50):
        with mpmath.workdps(60):
            residuals = dict(leaves(result.get("residuals", {})))
            assert all(abs(v) < 1e-40 for v in residuals.values())
            gaps = dict(leaves(result.get("contacts", {}).get("gaps", {})))
            assert all(v > -1e-40 for v in gaps.values())
        assert residuals or gaps


@each(LINKED)
def test_accelerations_keep_to_the_constraints(name: str) -> None:
    """J q'' + gamma = 0 for every row, those that were dropped too, from the graph in 50 digits."""
    found = study(name)
    assert found.links is not None
    drawn = samples.draw(found.model, STATES, seed=7)
    arithmetic = mpmath_arithmetic(50)
    for i, result in enumerate(linked_results(name, "interpreter", 50)):
        state = found.links.scene.report.states[i].state
        given = {
            "time": [state.time],
            "state": [*state.coordinates, *state.rates],
            "inputs": [arithmetic.number(v[i]) for v in drawn.inputs],
            "parameters": list(state.parameters),
        }
        links = found.links.scene.links  # over q', whatever speeds are declared
        values = {n: given[n.datum.argument][n.datum.index] for n in links.leaves}
        accelerations = [arithmetic.number(v) for v in result["accelerations"].values()]
        for row in links.rows:
            *slopes, gamma = node_values([*row.jacobian, row.gamma], values, arithmetic)
            terms = [s * a for s, a in zip(slopes, accelerations, strict=True)]
            size = sum(map(abs, terms)) + abs(gamma) + 1
            assert abs(sum(terms) + gamma) < 1e-40 * size


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
