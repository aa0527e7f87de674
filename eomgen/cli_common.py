"""What the commands share: options, reading a spec, and how a mistake is shown."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eomgen import files
from eomgen.errors import EomgenError, SpecError, UsageError
from eomgen.wanted import AUTO, METHODS, NAMES, Wanted

if TYPE_CHECKING:
    from eomgen.render.code_context import Style
    from eomgen.study import Study

FORMATS = click.Choice(["text", "json", "github"])
LANGUAGES = click.Choice(["en", "es"])
Command = Callable[..., Any]


def epilog(*lines: str) -> str:
    """Examples under a command's help."""
    return "\b\nExamples:\n" + "\n".join(f"  {line}" for line in lines)


def _positive(context: click.Context, option: click.Parameter, value: float | None) -> float | None:
    """The number, which must be finite and above zero."""
    if value is not None and not 0 < value < math.inf:
        raise click.BadParameter(f"{value!r} is not a positive number", context, option)
    return value


def positive(*names: str, **more: Any) -> Callable[[Command], Command]:
    """An option whose value is a positive number."""
    return click.option(*names, type=float, callback=_positive, **more)


def listed(context: click.Context, option: click.Parameter, value: str | None) -> tuple[str, ...]:
    """Words between commas, each once."""
    del context, option
    return tuple(dict.fromkeys(w.strip() for w in (value or "").split(",") if w.strip()))


spec_argument = click.argument("spec", type=str)
language_option = click.option(
    "--lang", "language", type=LANGUAGES, default="en", show_default=True, help="Language of prose."
)
format_option = click.option(
    "--format", "format_", type=FORMATS, default="text", show_default=True, help="How faults look."
)
templates_option = click.option(
    "--templates", type=click.Path(path_type=Path), help="Folder of your own templates."
)


formulation_option = click.option(
    "--formulation",
    type=click.Choice(NAMES),
    default="auto",
    show_default=True,
    help="Equations of a scene with constraints.",
)
method_option = click.option(
    "--method",
    type=click.Choice(METHODS),
    help="Formalism that is shown, all that apply are compared.  [default: Lagrange's]",
)

integrator_option = click.option(
    "--integrator",
    "integrators",
    multiple=True,
    metavar="METHOD",
    help="A step function in C, repeatable: semi-euler, semi-euler-damped, verlet, rk4, "
    "dopri5, rosenbrock2, midpoint, all.",
)
integrators_option = click.option(
    "--integrators", callback=listed, help="Such as rk4,verlet.  [default: all]"
)
with_stability_option = click.option(
    "--with-stability",
    is_flag=True,
    help="Limits of fixed steps in the C header, as `eomgen stability` finds them.",
)


def stability_inputs(targets: Sequence[str], wishes: Mapping[str, Any]) -> tuple[str, ...] | None:
    """The inputs for which stability is written into the header; None: it is not.

    Raises:
        UsageError: it is asked for, but no C is written; inputs are given, but not asked for.
    """
    if wishes["inputs"] and not wishes["with_stability"]:
        raise UsageError("--input is a value for --with-stability; add it")
    if wishes["with_stability"] and "c" not in targets:
        raise UsageError("--with-stability is about C, which is not written; add -t c")
    return wishes["inputs"] if wishes["with_stability"] else None


compensated_option = click.option(
    "--compensated", is_flag=True, help="Integrators keep what rounding loses: for float."
)


def _split(context: click.Context, option: click.Parameter, texts: tuple[str, ...]) -> list[str]:
    """Names between commas, of all that was given."""
    return [name.strip() for text in texts for name in text.split(",")]


functions_option = click.option(
    "--functions",
    multiple=True,
    callback=_split,
    metavar="NAME,...",
    help="Only these functions, repeatable; --list-functions says which there are.",
)


def _list_functions(context: click.Context, option: click.Parameter, wanted: bool) -> None:
    if not wanted:
        return
    from eomgen.functions.table import listing

    click.echo(listing())
    context.exit()


list_functions_option = click.option(
    "--list-functions",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_list_functions,
    help="Show what --functions can name, and stop.",
)


C_OPTIONS = {
    "fast_trig": "Own sine and cosine in the C: at most 2 units of the last place, vectorisable.",
    "batch": "C functions for many states at once, as structure of arrays.",
}


def code_options(command: Any) -> Any:
    """The options of generated code."""
    fold = click.option(
        "--fold", is_flag=True, help="Parameters with a value become numbers in C and Python."
    )
    for name, about in C_OPTIONS.items():
        command = click.option(_spelled(name), is_flag=True, help=about)(command)
    return fold(command)


def _spelled(name: str) -> str:
    return "--" + name.replace("_", "-")


def code_style(targets: Sequence[str], wishes: Mapping[str, Any]) -> Style:
    """How code is written.

    Raises:
        UsageError: an option of C is given, but no C is written.
    """
    from eomgen.render.code_context import Style

    for name in C_OPTIONS:
        if wishes[name] and "c" not in targets:
            raise UsageError(f"{_spelled(name)} is about C, which is not written; add -t c")
    return Style(**{name: wishes[name] for name in ("fold", *C_OPTIONS)})


def print_files(made: dict[str, str]) -> None:
    """Several files on one stream are told apart by a line each."""
    for name, text in made.items():
        if len(made) > 1:
            click.echo(f"==> {name} <==")
        click.echo(text, nl=False)


def decoded(path: str) -> str:
    """The text of a file; - is standard input."""
    try:
        return files.read(path).decode()
    except UnicodeDecodeError as error:
        raise UsageError(f"not UTF-8 text (byte {error.start})") from error


def studied(spec: str, format_: str, choice: Wanted = AUTO) -> Study:
    """The study of a spec; its faults are shown as asked and end the command."""
    with reporting(format_, files.shown(spec)):
        return derived(spec, choice)


@contextmanager
def reporting(format_: str, source: str) -> Iterator[None]:
    """Mistakes in `source` are shown as asked and end the command."""
    try:
        yield
    except EomgenError as error:
        complain(error, format_, source)
        sys.exit(error.exit_code)


def derived(spec: str, choice: Wanted = AUTO) -> Study:
    """The study of a spec; its faults are raised."""
    text = files.read(spec)
    from eomgen import study

    return study.of_text(text, files.shown(spec), choice)


def complain(error: EomgenError, format_: str, source: str, *, err: bool = True) -> None:
    """The error in words: faults with their places, or one line for each mistake."""
    if isinstance(error, SpecError):
        from eomgen.spec.report import render

        click.echo(render(error.faults, format_), err=err)
        return
    from eomgen.outputs import complaint

    click.echo(complaint(error, format_, source), err=err)
