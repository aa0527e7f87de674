"""eomgen simulate: run a spec, write its rows, say what the run was worth."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from typing import IO, TYPE_CHECKING, Any

import click

from eomgen import files
from eomgen.cli_common import (
    decoded,
    epilog,
    format_option,
    formulation_option,
    positive,
    reporting,
    spec_argument,
    studied,
)
from eomgen.errors import CheckError, UsageError
from eomgen.wanted import INTEGRATORS, Wanted

if TYPE_CHECKING:
    from eomgen.simulate_run import Job

METHODS = ("auto", *INTEGRATORS)
INTERRUPTED = 130  # as a shell says it of SIGINT
PATIENCE = 1.0  # seconds before a bar is shown


FILE = click.Path(dir_okay=False, path_type=Path)


@click.command(
    epilog=epilog(
        "eomgen simulate pendulum.yaml --t-end 20 -o data.csv --plot pendulum.svg",
        "eomgen simulate four_bar.yaml --method rk4 --step 1e-3 --input tau=0.1",
        "eomgen simulate bouncing_ball.yaml --animate ball.html",
    )
)
@spec_argument
@positive("--t-end", default=10.0, show_default=True, help="Length [s].")
@click.option("--method", type=click.Choice(METHODS), default="auto", show_default=True)
@positive("--step", help="Step of a fixed-step method [s].")
@positive("--rtol", help="Relative tolerance of an adaptive method.")
@positive("--atol", help="Absolute one, SI.  [default: a thousandth of rtol]")
@positive("--output-step", help="Time between rows [s].  [default: about 400]")
@click.option("--state", help="JSON file with the start; - is stdin.  [default: `initial`]")
@click.option(
    "--input", "inputs", multiple=True, metavar="NAME=VALUE", help="Constant, repeatable."
)
@click.option("-o", "--output", help="CSV file; - is stdout.  [default: -, unless drawn]")
@click.option("--plot", type=FILE, help="SVG file: coordinates and outputs over time.")
@click.option("--show", multiple=True, metavar="NAME", help="What to plot instead, repeatable.")
@click.option("--animate", type=FILE, help="HTML file: the bodies in motion.")
@positive("--energy-tolerance", help="Relative; above it the run is a failure.")
@click.option("--force", is_flag=True, help="Overwrite files that exist.")
@formulation_option
@format_option
def simulate(spec: str, format_: str, formulation: str, **wishes: Any) -> None:
    """Run SPEC in time: the C that `generate` writes, compiled and cached.

    The end says how well energy and constraints were kept; a run whose energy is off is a failure.
    """
    if spec == wishes["state"] == files.STANDARD:
        raise UsageError("the spec and the state cannot both come from standard input")
    study = studied(spec, format_, Wanted(formulation))
    with reporting(format_, files.shown(spec)):
        from eomgen import simulate_run

        state = "{}" if wishes["state"] is None else decoded(wishes["state"])
        job = simulate_run.job(study, simulate_run.Request(state=state, **_request(wishes)))
        with _sink(_output(wishes), wishes) as stream:
            code = _run(job, stream)
    sys.exit(code)


def _request(wishes: dict[str, Any]) -> dict[str, Any]:
    """The wishes that the run knows."""
    other = {"output", "force", "state"}
    return {name: value for name, value in wishes.items() if name not in other}


def _output(wishes: dict[str, Any]) -> str | None:
    """Where rows go: to standard output where nothing else was asked for."""
    if wishes["output"] is None and not wishes["plot"] and not wishes["animate"]:
        return files.STANDARD
    output: str | None = wishes["output"]
    return output


@contextmanager
def _sink(output: str | None, wishes: dict[str, Any]) -> Iterator[IO[str] | None]:
    """An open file for the rows.

    Raises:
        UsageError: a file is in the way, or cannot be written.
    """
    given = (output, wishes["plot"], wishes["animate"])
    paths = [Path(path) for path in given if path not in (None, files.STANDARD)]
    for path in paths:
        _must_be_free(path, wishes["force"])
    _must_differ(paths)
    if output is None or output == files.STANDARD:
        yield None if output is None else sys.stdout
        return
    with _opened(output) as stream:
        yield stream


def _must_be_free(path: Path, force: bool) -> None:
    """Raise UsageError where a file would be lost; a device or pipe is none."""
    if path.is_dir():
        raise UsageError(f"{path}: is a folder; give a file")
    if path.is_file() and not force:
        raise UsageError(f"{path}: is in the way; choose another file, or --force")


def _must_differ(paths: list[Path]) -> None:
    """Raise UsageError where one result would be written over another."""
    places = [path.resolve() for path in paths]
    for path, place in zip(paths, places, strict=True):
        if places.count(place) > 1:
            raise UsageError(f"{path}: is asked for twice; give each result its own file")


def _opened(path: str) -> IO[str]:
    try:
        return Path(path).open("w", encoding="utf-8", newline="")
    except OSError as error:
        raise UsageError(f"{path}: cannot be written: {error.strerror}") from error


def _run(job: Job, stream: IO[str] | None) -> int:
    """The exit code of the run; its words go to standard error."""
    for line in job.beginning():
        click.echo(line, err=True)
    interrupted, faults = False, []
    try:
        with _interruptible() as asked:
            interrupted = _follow(job, stream, asked)
    except CheckError as error:
        faults.append(str(error))
    if interrupted:
        told = f"interrupted: what was computed up to here is written ({job.rows} rows)"
        click.echo(told, err=True)
    for line in job.ending():
        click.echo(line, err=True)
    faults += job.faults()
    for line in faults:
        click.echo(line, err=True)
    for path, text in job.drawings().items():
        files.put({path: text})
    return INTERRUPTED if interrupted else int(bool(faults))


@contextmanager
def _interruptible() -> Iterator[Event]:
    """Set by a first Ctrl-C, so that a row is written before the end; a second one ends at once."""
    asked = Event()

    def ask(number: int, frame: object) -> None:
        asked.set()
        signal.signal(signal.SIGINT, signal.default_int_handler)

    before = signal.signal(signal.SIGINT, ask)
    try:
        yield asked
    finally:
        signal.signal(signal.SIGINT, before)


def _follow(job: Job, stream: IO[str] | None, asked: Event) -> bool:
    """Write the rows as they come, a bar where a person waits; whether it was interrupted."""
    if stream is not None:
        stream.write(job.head())
    started, bar = time.monotonic(), None
    try:
        for share, text in job.parts():
            if stream is not None and text:
                stream.write(text)
                stream.flush()
            if asked.is_set():
                return True
            if bar is None and sys.stderr.isatty() and time.monotonic() - started > PATIENCE:
                bar = click.progressbar(length=1000, file=sys.stderr, label="t")
                bar.__enter__()
            if bar is not None:
                bar.update(int(1000 * share) - bar.pos)
    finally:
        if bar is not None:
            bar.render_finish()
    return False
