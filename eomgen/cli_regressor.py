"""The command `regressor`: which inertial parameters motions and forces can tell apart."""

from __future__ import annotations

import json

import click

from eomgen import files
from eomgen.cli_common import (
    epilog,
    format_option,
    formulation_option,
    reporting,
    spec_argument,
)
from eomgen.wanted import Wanted


@click.command(
    epilog=epilog("eomgen regressor arm.yaml", "eomgen regressor arm.yaml --format json")
)
@spec_argument
@formulation_option
@format_option
def regressor(spec: str, formulation: str, format_: str) -> None:
    """Find the base parameters of SPEC: the identifiable combinations of inertial parameters."""
    from eomgen.functions import base, sheet
    from eomgen.functions.motion import Motion
    from eomgen.study import machine_of

    with reporting(format_, files.shown(spec)):
        text = files.read(spec)
        found = base.of(Motion(machine_of(text, files.shown(spec), Wanted(formulation))))
    if format_ == "json":
        click.echo(json.dumps(sheet.as_json(found), indent=2, ensure_ascii=False))
        return
    click.echo(sheet.text(found))
