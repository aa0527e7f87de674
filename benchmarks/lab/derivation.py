"""From a scene to C text: everyone in processes of their own, as far as two minutes go."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import product

import numpy as np

from lab.derive_one import WHO
from lab.limits import output_within

SECONDS = 120
OURS = "ours, from the model"
SERIES = {
    "cart": (1, 2, 4, 8, 16, 25, 50, 100),
    "skew arm": (1, 2, 4, 7, 8, 16, 25, 50, 100),
    "arm": (7, 25, 50, 100),
    "walker": (30,),
    "masses": (25, 50, 100, 200, 500),
}
FITTED = 25  # exponents are fitted from here on


@dataclass(frozen=True)
class Took:
    """Processor seconds and statements; None where it did not end, or could not be done."""

    seconds: float | None
    statements: int = 0


Times = dict[tuple[str, str, int], Took]  # who, scene, count


SLOW = ("KanesMethod", "SymEngine")  # wait for their two minutes side by side
ROUNDS = 4  # of those whom we are near to, one at a time: the machine is not always as fast


def measured(missing: list[str]) -> Times:
    """Everyone on every series: the slow ones once, the others the least of some rounds."""
    slow = list(product(SERIES, SLOW))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = list(pool.map(lambda pair: _series(*pair), slow))
    missing += [line for _, said in runs for line in said]
    found = {key: took for times, _ in runs for key, took in times.items()}
    return found | near(missing)


def near(missing: list[str]) -> Times:
    """The least of the rounds of those whom we are near to."""
    pairs = [pair for pair in product(SERIES, WHO) if pair[1] not in SLOW]
    runs = [_series(*pair) for _ in range(ROUNDS) for pair in pairs]
    missing += dict.fromkeys(line for _, said in runs for line in said)
    found: Times = {}
    for key, took in (item for times, _ in runs for item in times.items()):
        found[key] = min(found.get(key, took), took, key=lambda t: t.seconds or float("inf"))
    return found


def _series(scene: str, who: str) -> tuple[Times, list[str]]:
    """One on one series, and what could not be done: who fails is not asked for a larger one."""
    found: Times = {}
    missing: list[str] = []
    for count in SERIES[scene]:
        found[who, scene, count] = took = _took(who, scene, count, missing)
        if took.seconds is None:
            break
    return found, missing


def _took(who: str, scene: str, count: int, missing: list[str]) -> Took:
    command = [sys.executable, "-m", "lab.derive_one", who, scene, str(count)]
    try:
        answer = output_within(SECONDS, command)
    except RuntimeError as error:
        missing.append(f"{who}, {scene} {count}: {str(error).strip().splitlines()[-1]}")
        return Took(None)
    if answer is None:
        missing.append(f"{who}, {scene} {count}: not within {SECONDS} s")
        return Took(None)
    seconds, statements = answer.split()
    return Took(float(seconds), int(statements))


def exponent(points: list[tuple[float, float]]) -> float | None:
    """The slope of the straight line through the logarithms; None with fewer than two points."""
    if len(points) < 2:
        return None
    x, y = np.log(np.array(points)).T
    return float(np.polyfit(x, y, 1)[0])


def slope(times: Times, who: str, scene: str, of: str) -> float | None:
    """The exponent of `seconds` or `statements` from `FITTED` to the largest size."""
    points = [
        (float(count), float(getattr(times[who, scene, count], of)))
        for count in SERIES[scene]
        if count >= FITTED and times.get((who, scene, count), Took(None)).seconds
    ]
    return exponent(points)


def table(times: Times) -> list[str]:
    """A Markdown table for each scene: seconds, and what the others take of ours."""
    return [line for scene in SERIES for line in _scene(times, scene)]


def _scene(times: Times, scene: str) -> Iterator[str]:
    counts = SERIES[scene]
    yield f"| {scene}, s | {' | '.join(f'n = {c}' for c in counts)} | exponent |"
    yield "|---" * (len(counts) + 2) + "|"
    for who in WHO:
        cells = [_cell(times, who, scene, c) for c in counts]
        fitted = slope(times, who, scene, "seconds")
        yield f"| {who} | {' | '.join(cells)} | {_number(fitted)} |"
    for who in WHO:
        if not who.startswith("ours"):
            cells = [_ratio(times, who, scene, c) for c in counts]
            yield f"| {who} / {OURS} | {' | '.join(cells)} | |"
    lengths = [str(times.get((OURS, scene, c), Took(None)).statements or "-") for c in counts]
    fitted = slope(times, OURS, scene, "statements")
    yield f"| statements of ours | {' | '.join(lengths)} | {_number(fitted)} |"
    yield ""


def _cell(times: Times, who: str, scene: str, count: int) -> str:
    took = times.get((who, scene, count), Took(None)).seconds
    return "-" if took is None else f"{took:.3g}"


def _ratio(times: Times, who: str, scene: str, count: int) -> str:
    one = times.get((who, scene, count), Took(None)).seconds
    ours = times.get((OURS, scene, count), Took(None)).seconds
    return "-" if one is None or ours is None else f"{one / ours:.2g}"


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"
