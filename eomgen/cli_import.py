"""The command `import`: a robot of another program as a spec."""

from decimal import Decimal
from pathlib import Path
from typing import Any

import click

from eomgen import files
from eomgen.cli_common import epilog, format_option, reporting
from eomgen.errors import UsageError

NEAR = "1e-9"  # rad
FARTHEST = Decimal("0.01")  # rad


@click.command(
    "import",
    epilog=epilog(
        "eomgen import robot.urdf -o robot.yaml",
        "eomgen import quadruped.urdf --floating-base -o quadruped.yaml",
    ),
)
@click.argument("robot", type=str)
@click.option("-o", "--output", default="-", show_default=True, help="Spec; - is stdout.")
@click.option("--floating-base", is_flag=True, help="The first link moves freely.")
@click.option("--euler-angles", is_flag=True, help="Free links turn by angles, no quaternion.")
@click.option(
    "--round-angles", is_flag=True, help="Angles of the file become multiples of pi/12 where near."
)
@click.option(
    "--within", metavar="RAD", help=f"With --round-angles: how near that is.  [default: {NEAR}]"
)
@click.option("--mend-inertias", is_flag=True, help="Raise moments of inertia no body can have.")
@click.option("--force", is_flag=True, help="Overwrite the spec.")
@format_option
def import_robot(robot: str, output: str, force: bool, format_: str, **wishes: Any) -> None:
    """Write the spec of ROBOT, a URDF file; what has no meaning in it is named.

    Links become bodies on frames, joints coordinates with a motor and a damper. A joint that
    follows another (mimic) has the formula for its coordinate.
    """
    from eomgen import urdf
    from eomgen.urdf.wishes import Wishes

    with reporting(format_, files.shown(robot)):
        within = _within(wishes["round_angles"], wishes["within"])
        wanted = Wishes(
            wishes["floating_base"], wishes["euler_angles"], wishes["mend_inertias"], within
        )
        made = urdf.imported(files.read(robot), files.shown(robot), wanted)
    for note in made.notes:
        click.echo(f"{files.shown(robot)}:{note.line}:{note.column}: note: {note.text}", err=True)
    if output == files.STANDARD:
        click.echo(made.text, nl=False)
        return
    for path in _write(Path(output), made.text, force):
        click.echo(str(path))


def _within(round_angles: bool, within: str | None) -> Decimal | None:
    """The tolerance [rad] if angles are rounded."""
    from eomgen.spec.ledger import Mistake
    from eomgen.spec.reader import Point
    from eomgen.urdf.numbers import number

    if not round_angles:
        if within is not None:
            raise UsageError("--within goes with --round-angles; give both")
        return None
    try:
        value = number(within or NEAR, Point(1, 1))
    except Mistake as mistake:
        raise UsageError(f"--within: {mistake}") from mistake
    if not 0 <= value <= FARTHEST:
        raise UsageError(f"--within is {within}; give 0 to {FARTHEST} [rad]")
    return value


def _write(path: Path, text: str, force: bool) -> list[Path]:
    """Write a spec, and the schema that its first line names unless it is there."""
    from eomgen import shelf

    if path.exists() and not force:
        raise UsageError(f"{path} exists already and is left as it is; choose another, or --force")
    return files.put({path: text} | shelf.schema_in(path.parent))
