"""eomgen stability: the largest steps that fixed-step methods bear, and what else may go wrong."""

from __future__ import annotations

from typing import Any

import click

from eomgen import files
from eomgen.cli_common import (
    decoded,
    epilog,
    format_option,
    formulation_option,
    integrators_option,
    positive,
    reporting,
    spec_argument,
    studied,
)
from eomgen.errors import UsageError
from eomgen.wanted import Wanted


@click.command(
    epilog=epilog(
        "eomgen stability double_pendulum.yaml",
        "eomgen stability four_bar.yaml --input tau=0.1 --integrators rk4,semi-euler",
    )
)
@spec_argument
@click.option("--state", help="JSON file with the start; - is stdin.  [default: `initial`]")
@click.option(
    "--input", "inputs", multiple=True, metavar="NAME=VALUE", help="Constant, repeatable."
)
@integrators_option
@positive("--horizon", default=10.0, show_default=True, help="Length of a run [s].")
@formulation_option
@format_option
def stability(spec: str, format_: str, formulation: str, **wishes: Any) -> None:
    """Find what fixed steps of SPEC can be: by eigenvalues, and by bisection with the C.

    Looks at the start, at equilibria and at states in the declared range. Says the fastest and
    slowest mode, stiffness, singular positions, the condition of M, what float costs, chaos.
    """
    if spec == wishes["state"] == files.STANDARD:
        raise UsageError("the spec and the state cannot both come from standard input")
    study = studied(spec, format_, Wanted(formulation))
    with reporting(format_, files.shown(spec)):
        from eomgen.stability import make, words
        from eomgen.stability.records import Wish

        state = "{}" if wishes["state"] is None else decoded(wishes["state"])
        wish = Wish(state, wishes["inputs"], wishes["integrators"], wishes["horizon"])
        found = make.findings(study, wish)
    click.echo(words.as_json(found) if format_ == "json" else words.text(found), nl=False)
