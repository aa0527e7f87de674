"""State files: exact numbers in, every mistake named."""

import json

import pytest
import sympy as sp
from studies import PENDULUM, model

from eomgen import states
from eomgen.errors import UsageError
from eomgen.spec import read

SCENE = read(PENDULUM, "pendulum.yaml")
FULL = {"coordinates": {"phi": "0.1"}, "rates": {"phi": 2}, "inputs": {"tau": 0}}


def test_numbers_are_exact() -> None:
    (state,) = states.read(json.dumps(FULL), SCENE, needs_time=False)
    assert state.coordinates == (sp.Rational(1, 10),)
    assert state.rates == (2,)
    assert state.parameters == (2, sp.Rational(1, 2), sp.Rational(981, 100), sp.Rational(1, 10))


def test_json_decimals_are_read_as_written() -> None:
    text = '{"coordinates": {"phi": 0.1}, "rates": {"phi": 1e-3}, "inputs": {"tau": -0.30}}'
    (state,) = states.read(text, SCENE, needs_time=False)
    assert state.coordinates == (sp.Rational(1, 10),)
    assert state.rates == (sp.Rational(1, 1000),)
    assert state.inputs == (sp.Rational(-3, 10),)


def test_what_is_missing_comes_from_the_spec() -> None:
    (state,) = states.read('{"inputs": {"F": 0}}', model("slider_pendulum"), needs_time=False)
    assert state.coordinates == (sp.Rational(1, 10), sp.pi / 9)


def test_a_list_is_several_states() -> None:
    assert len(states.read(json.dumps([FULL, FULL]), SCENE, needs_time=False)) == 2


def changed(**entries: object) -> str:
    return json.dumps({**FULL, **entries})


BAD = [
    ("", "not JSON"),
    ("{", "not JSON"),
    ("[" * 100_000, "not JSON"),
    ("null", "is not an object"),
    ("[1]", "is not an object"),
    ('"phi"', "is not an object"),
    ('{"coordinates": {"phi": 1}, "coordinates": {"phi": 2}}', "twice"),
    (changed(coordinate={}), "unknown name 'coordinate'; did you mean 'coordinates'?"),
    (changed(coordinates={"ph": 1}), "unknown name 'ph'; did you mean 'phi'?"),
    (changed(coordinates={}), "phi is missing, and the spec has no value"),
    (changed(coordinates=[1]), "is not an object of names"),
    (changed(coordinates={"phi": None}), "is not a finite decimal number"),
    (changed(coordinates={"phi": True}), "is not a finite decimal number"),
    (changed(coordinates={"phi": float("nan")}), "is not a finite decimal number"),
    (changed(coordinates={"phi": float("inf")}), "is not a finite decimal number"),
    (changed(coordinates={"phi": "1e999999999"}), "is not a finite decimal number"),
    (changed(coordinates={"phi": "9" * 10_000}), "is not a finite decimal number"),
    (changed(coordinates={"phi": "__import__('os')"}), "is not a finite decimal number"),
    (changed(coordinates={"phi": "2**9**9"}), "is not a finite decimal number"),
    (changed(rates={}), "rates: phi is missing"),
    (changed(inputs={}), "tau is missing"),
    (changed(inputs={"tau": 0, "F": 1}), "unknown name 'F'"),
    (changed(parameters={"mass": 1}), "unknown name 'mass'"),
    (changed(speeds={"u": 1}), "declares no speeds"),
]


@pytest.mark.parametrize(("text", "words"), BAD, ids=range(len(BAD)))
def test_mistakes_are_named(text: str, words: str) -> None:
    with pytest.raises(UsageError) as caught:
        states.read(text, SCENE, needs_time=False)
    assert words in str(caught.value)


def test_all_mistakes_of_a_file_at_once() -> None:
    with pytest.raises(UsageError) as caught:
        states.read('[{"x": 1}, {"coordinates": {"phi": "a"}}]', SCENE, needs_time=True)
    assert str(caught.value).count("\n") >= 6
    assert "state 2: t is missing" in str(caught.value)


def test_a_derived_parameter_cannot_be_set() -> None:
    scene = read(PENDULUM.replace("{m: 2 kg", "{w0: sqrt(g/l), m: 2 kg"), "pendulum.yaml")
    with pytest.raises(UsageError, match="follows from others"):
        states.read(changed(parameters={"w0": 1}), scene, needs_time=False)


def test_speeds_may_be_given_instead_of_rates() -> None:
    scene = model("rigid_body")
    names = {s.name: "0.5" for s in scene.speeds}
    (state,) = states.read(json.dumps({"speeds": names}), scene, needs_time=False)
    assert state.rates is None
    assert state.speeds == (sp.Rational(1, 2),) * len(scene.speeds)
