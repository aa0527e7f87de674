"""eomgen chart: speed against accuracy of every way to integrate a scene."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import click

from eomgen import files
from eomgen.cli_common import (
    decoded,
    epilog,
    format_option,
    integrators_option,
    listed,
    positive,
    reporting,
    spec_argument,
    studied,
)
from eomgen.errors import UsageError

MOST_STEPS = 40


def _steps(
    context: click.Context, option: click.Parameter, value: str | None
) -> tuple[float, float, int] | None:
    """LARGEST:SMALLEST:COUNT."""
    if value is None:
        return None
    try:
        high, low, count = value.split(":")
        found = float(high), float(low), int(count)
    except ValueError:
        raise click.BadParameter(
            f"{value!r} is not LARGEST:SMALLEST:COUNT, such as 2e-2:1e-4:8", context, option
        ) from None
    if not math.inf > found[0] > found[1] > 0 or not 1 < found[2] <= MOST_STEPS:
        raise click.BadParameter(
            f"{value!r}: the largest comes first, both are positive, at most {MOST_STEPS} steps",
            context,
            option,
        )
    return found


@click.command(
    epilog=epilog(
        "eomgen chart four_bar.yaml --input tau=0 --out charts",
        "eomgen chart double_pendulum.yaml --target-error 1e-6 --integrators rk4,dopri5 --apply",
    )
)
@spec_argument
@positive(
    "--target-error", default=1e-4, show_default=True,
    help="Of positions and rates, relative, at every output time.",
)  # fmt: skip
@positive("--budget-us", help="CPU time of a step that you can spend [us].")
@positive("--horizon", default=10.0, show_default=True, help="Length of the runs [s].")
@click.option("--formulations", callback=listed, help="Such as minimal,nullspace.  [default: all]")
@integrators_option
@click.option("--precisions", default="f64,f32", show_default=True, callback=listed)
@click.option("--steps", callback=_steps, help="LARGEST:SMALLEST:COUNT [s].  [default: by modes]")
@positive(
    "--seconds", default=40.0, show_default=True,
    help="For runs and timing; what takes too long is left out.",
)  # fmt: skip
@click.option("--state", help="JSON file with the start; - is stdin.  [default: `initial`]")
@click.option("--input", "inputs", multiple=True, metavar="NAME=VALUE", help="Repeatable.")
@click.option("--out", default="chart", show_default=True, help="Folder.")
@click.option("--force", is_flag=True, help="Overwrite files that eomgen did not make.")
@click.option("--apply", is_flag=True, help="Write the recommendation into SPEC, for simulate.")
@format_option
def chart(spec: str, format_: str, **wishes: Any) -> None:
    """Run SPEC with every formulation, integrator, step and precision; recommend one.

    Writes chart.json, chart.csv, chart.md, chart.tex and, where matplotlib is installed, chart.svg
    and chart.png.
    """
    _checked(spec, wishes)
    study = studied(spec, format_)
    with reporting(format_, files.shown(spec)):
        from eomgen import charting

        text = "{}" if wishes["state"] is None else decoded(wishes["state"])
        made = charting.made(study, charting.sweep(wishes), text, wishes["inputs"])
        for path in charting.write(made, Path(wishes["out"]), force=wishes["force"]):
            click.echo(str(path))
        for line in charting.words(made):
            click.echo(line)
        if wishes["apply"]:
            click.echo(charting.apply(made, Path(spec)))


def _checked(spec: str, wishes: dict[str, Any]) -> None:
    """Raises UsageError where options contradict each other."""
    if spec == wishes["state"] == files.STANDARD:
        raise UsageError("the spec and the state cannot both come from standard input")
    if wishes["apply"] and spec == files.STANDARD:
        raise UsageError("--apply writes into the spec: name its file")
    for name in wishes["precisions"]:
        if name not in ("f64", "f32"):
            raise UsageError(f"--precisions: {name!r} is none of f64, f32")
    if not wishes["precisions"]:
        raise UsageError("--precisions: name f64, f32 or both")
