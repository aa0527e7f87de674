"""The command line: reads files, calls, writes files; no mathematics.

What a command needs is imported when it runs, so that help answers at once.
"""

from __future__ import annotations

import errno
import gc
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any, NoReturn

import click

from eomgen import __version__, files
from eomgen.cli_chart import chart
from eomgen.cli_common import (
    code_options,
    code_style,
    compensated_option,
    complain,
    decoded,
    derived,
    epilog,
    format_option,
    formulation_option,
    functions_option,
    integrator_option,
    language_option,
    list_functions_option,
    method_option,
    print_files,
    reporting,
    spec_argument,
    stability_inputs,
    studied,
    templates_option,
    with_stability_option,
)
from eomgen.cli_import import import_robot
from eomgen.cli_precision import measured
from eomgen.cli_regressor import regressor
from eomgen.cli_simulate import simulate
from eomgen.cli_stability import stability
from eomgen.errors import EomgenError, UsageError
from eomgen.wanted import Wanted, wanted

COLLECT_RARELY = 1_000_000  # a command lives for a second; looking for circles would take a tenth
FULL = (errno.ENOSPC, errno.EDQUOT)
SETTINGS = {"help_option_names": ["-h", "--help"], "max_content_width": 100}
NOTES = frozenset(("latex", "text"))  # targets that show the closed form
TARGET_NAMES = ("latex", "c", "python", "text")

EXAMPLES = """\b
Examples:
  eomgen derive specs/slider_pendulum.yaml
  eomgen generate specs/slider_pendulum.yaml -o out
  eomgen check specs/*.yaml
  eomgen new my_system

\b
Exit codes: 0 done, 1 a check failed, 2 wrong input."""


@click.group(context_settings=SETTINGS, epilog=EXAMPLES)
@click.version_option(__version__, prog_name="eomgen")
def commands() -> None:
    """Equations of motion from one text file: lecture notes, C and Python, proven to agree."""


@commands.command(epilog=epilog("eomgen derive pendulum.yaml --steps", "eomgen derive - <p.yaml"))
@spec_argument
@click.option("--steps", is_flag=True, help="Show every partial derivative.")
@language_option
@templates_option
@formulation_option
@method_option
@format_option
def derive(spec: str, format_: str, formulation: str, **wishes: Any) -> None:
    """Show the equations of motion of SPEC in the terminal."""
    from eomgen.outputs import Wish, rendered

    wish = Wish(("text",), wishes["language"], wishes["templates"], wishes["steps"])
    choice = Wanted(formulation, notes=True, method=wishes["method"])
    (text,) = rendered(studied(spec, format_, choice), wish).values()
    click.echo(text, nl=False)


@commands.command(
    epilog=epilog("eomgen generate arm.yaml -o out", "eomgen generate arm.yaml -t python -o -")
)
@spec_argument
@click.option("-o", "--output", default=".", show_default=True, help="Folder; - is stdout.")
@click.option(
    "-t",
    "--target",
    "targets",
    multiple=True,
    type=click.Choice(TARGET_NAMES),
    help="What to write, repeatable.  [default: latex, c and python]",
)
@click.option(
    "--steps/--no-steps",
    default=True,
    show_default=True,
    help="Partial derivatives in the text; the LaTeX notes always show them.",
)
@click.option("--force", is_flag=True, help="Overwrite files that eomgen did not make.")
@language_option
@templates_option
@formulation_option
@method_option
@click.option("--baumgarte", metavar="ALPHA", help="Stabilise multipliers [1/s], only if asked.")
@click.option("--step", metavar="H", help="The step [s] that caps ALPHA at 0.2/H.")
@code_options
@integrator_option
@compensated_option
@with_stability_option
@click.option("--input", "inputs", multiple=True, metavar="NAME=VALUE", help="With stability.")
@functions_option
@list_functions_option
@format_option
def generate(output: str, spec: str, format_: str, force: bool, **wishes: Any) -> None:
    """Write lecture notes, C and Python for SPEC."""
    from eomgen.outputs import Wish, rendered

    targets = wishes["targets"] or ("latex", "c", "python")
    if wishes["compensated"] and not wishes["integrators"]:
        raise UsageError("--compensated is how integrators add: say --integrator too")
    targets += ("c-steps",) if wishes["integrators"] else ()
    with reporting(format_, files.shown(spec)):
        choice = _derivation(targets, wishes)
        stable = stability_inputs(targets, wishes)
        style = code_style(targets, wishes)
    study = studied(spec, format_, choice)
    wish = Wish(
        targets,
        wishes["language"],
        wishes["templates"],
        wishes["steps"],
        tuple(wishes["functions"]),
        wishes["integrators"],
        wishes["compensated"],
        style,
        stable,
    )
    made = rendered(study, wish)
    if output == files.STANDARD:
        print_files(made)
        return
    for path in files.write_all(Path(output), made, force=force):
        click.echo(str(path))


def _derivation(targets: tuple[str, ...], wishes: dict[str, Any]) -> Wanted:
    """What `generate` asks of the study."""
    choice = wanted(wishes["formulation"], wishes["baumgarte"], wishes["step"])
    notes = not NOTES.isdisjoint(targets)
    if wishes["method"] and not notes:
        raise UsageError("--method is how the notes derive: add -t latex or -t text")
    needs_all = wishes["integrators"] or wishes["with_stability"]
    only = () if needs_all else tuple(wishes["functions"])
    return replace(choice, notes=notes, method=wishes["method"], functions=only)


@commands.command(epilog=epilog("eomgen check specs/*.yaml", "eomgen check a.yaml --precision"))
@click.argument("specs", nargs=-1, required=True)
@click.option("--precision", is_flag=True, help="Measure the code in float and double.")
@format_option
def check(specs: tuple[str, ...], precision: bool, format_: str) -> None:
    """Check SPECS: language, names, units, degrees of freedom, claims, and the proof."""
    from eomgen.outputs import summary

    worst = 0
    for spec in specs:
        try:
            study = derived(spec)
            said = summary(files.shown(spec), study, format_)
            click.echo(measured(study, said, format_) if precision else said)
        except EomgenError as error:
            complain(error, format_, files.shown(spec), err=format_ != "json")
            worst = max(worst, error.exit_code)
    sys.exit(worst)


@commands.command(
    epilog=epilog("eomgen evaluate arm.yaml --state state.json --digits 50 --using interpreter")
)
@spec_argument
@click.option("--state", default=None, help="JSON file of states; - is stdin.")
@click.option("--digits", type=click.IntRange(1, 10_000), default=17, show_default=True)
@click.option(
    "--using",
    type=click.Choice(["interpreter", "c", "python"]),
    default="interpreter",
    show_default=True,
    help="What computes.",
)
@click.option("--project", is_flag=True, help="Move states to the nearest admissible ones.")
@click.option("--joints", is_flag=True, help="Add the forces between components (Newton-Euler).")
@functions_option
@list_functions_option
@format_option
def evaluate(spec: str, state: str | None, format_: str, **wishes: Any) -> None:
    """Compute accelerations, energies, forces and outputs of SPEC at given states, as JSON.

    Without --state the spec's initial values are the state. With --functions the results of these
    functions are shown instead, row by row.
    """
    import json

    from eomgen.answers import Question, answers

    if spec == state == files.STANDARD:
        raise UsageError("the spec and the state cannot both come from standard input")
    study = studied(spec, format_)
    with reporting(format_, files.shown(spec if state is None else state)):
        text = "{}" if state is None else decoded(state)
        results = answers(study, text, Question(**wishes))
    click.echo(json.dumps(results, indent=2, ensure_ascii=False))


@commands.command(
    epilog=epilog(
        "eomgen statics four_bar.yaml --input tau=0.2",
        "eomgen statics four_bar.yaml -t latex -o out",
        "eomgen statics truss.yaml --format json",
    )
)
@spec_argument
@click.option("--input", "inputs", multiple=True, metavar="NAME=VALUE", help="Zero if not given.")
@click.option("--parameter", "parameters", multiple=True, metavar="NAME=VALUE")
@click.option("--time", default="0", show_default=True, help="When prescribed motions stand still.")
@click.option(
    "-t",
    "--target",
    type=click.Choice(["text", "latex"]),
    help="What to write.  [default: text; with --format json, JSON]",
)
@click.option("-o", "--output", default="-", show_default=True, help="Folder; - is stdout.")
@click.option("--force", is_flag=True, help="Overwrite files that eomgen did not make.")
@language_option
@templates_option
@format_option
def statics(spec: str, format_: str, output: str, force: bool, **wishes: Any) -> None:
    """Find the equilibria of SPEC by virtual work, their stability, loads and reactions."""
    from eomgen import rest

    is_json = format_ == "json" and wishes["target"] is None
    if is_json and output != files.STANDARD:
        raise UsageError("JSON goes to standard output; with --output, say --target text or latex")
    load = rest.Load(wishes["inputs"], wishes["parameters"], wishes["time"])
    sheet = rest.Sheet(wishes["target"] or "text", wishes["language"], wishes["templates"])
    text = files.read(spec)
    with reporting(format_, files.shown(spec)):
        answer = rest.solved(text, files.shown(spec), load)
    if is_json:
        click.echo(rest.as_json(answer))
        return
    made = rest.rendered(answer, sheet)
    if output == files.STANDARD:
        print_files(made)
        return
    for path in files.write_all(Path(output), made, force=force):
        click.echo(str(path))


commands.add_command(regressor)


@commands.command(epilog=epilog("eomgen new my_system", "eomgen new crane --like furuta_pendulum"))
@click.argument("name")
@click.option("--like", default="slider_pendulum", show_default=True, help="Example to start from.")
def new(name: str, like: str) -> None:
    """Start the spec NAME.yaml from an example, with the schema that editors complete from."""
    from eomgen import shelf

    for path in shelf.start(name, like):
        click.echo(str(path))


@commands.command(epilog=epilog("eomgen examples", "eomgen examples copy furuta_pendulum"))
@click.argument("action", type=click.Choice(["list", "copy"]), default="list")
@click.argument("names", nargs=-1)
@click.option("-o", "--output", type=click.Path(path_type=Path), default=Path(), help="Folder.")
def examples(action: str, names: tuple[str, ...], output: Path) -> None:
    """List the shipped specs, or copy some (all without NAMES)."""
    from eomgen import shelf

    if action == "list":
        _takes_no_names(names)
        for stem, title in shelf.examples().items():
            click.echo(f"{stem:<28} {title}")
        return
    for path in shelf.copy_examples(names, output):
        click.echo(str(path))


def _takes_no_names(names: tuple[str, ...]) -> None:
    if names:
        raise click.UsageError(f"list takes no names: {' '.join(names)}")


@commands.command(epilog=epilog("eomgen schema > eomgen.schema.json"))
def schema() -> None:
    """Print the JSON Schema of the language, for editors."""
    from eomgen import shelf

    click.echo(shelf.schema_text(), nl=False)


@commands.command(epilog=epilog("eomgen templates", "eomgen templates eject c/model.c.j2 -o mine"))
@click.argument("action", type=click.Choice(["list", "eject"]), default="list")
@click.argument("names", nargs=-1)
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), default=Path("templates"), help="Folder."
)
def templates(action: str, names: tuple[str, ...], output: Path) -> None:
    """List the templates, or copy some (all without NAMES) as a start for --templates."""
    from eomgen import shelf

    if action == "list":
        _takes_no_names(names)
        for name in shelf.templates():
            click.echo(name)
        return
    for path in shelf.eject_templates(names, output):
        click.echo(str(path))


commands.add_command(import_robot)
commands.add_command(simulate)
commands.add_command(chart)
commands.add_command(stability)


def main() -> NoReturn:
    """The program: a user's mistake is shown in words, a defect of ours with its traceback."""
    gc.set_threshold(COLLECT_RARELY)
    try:
        commands(prog_name="eomgen")
    except EomgenError as error:
        click.echo(f"eomgen: {error}", err=True)
        sys.exit(error.exit_code)
    except OSError as error:
        if error.errno not in FULL:
            raise
        _leave_unwritten(error)
    sys.exit(0)


def _leave_unwritten(error: OSError) -> NoReturn:
    """End where the disk takes no more; what is left in the stream is not tried again."""
    click.echo(f"eomgen: cannot be written: {error.strerror}; make room", err=True)
    sys.stdout = None
    sys.exit(UsageError.exit_code)


if __name__ == "__main__":
    main()
