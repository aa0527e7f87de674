"""Templates: where ours are, how a user's folder overrides them, whose mistake an error is."""

import re
import traceback
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import jinja2
from jinja2.sandbox import ImmutableSandboxedEnvironment

from eomgen import __version__
from eomgen.cache_folder import root
from eomgen.errors import UsageError
from eomgen.render.lines import named, rows, short_statements, statements, wrap

SUFFIX = ".j2"


def shipped(folder: str) -> Path:
    """Our `templates` or `specs`: inside the installed package, or beside it in a checkout."""
    package = Path(__file__).parents[1]
    installed = package / folder
    return installed if installed.is_dir() else package.parent / folder


class _Compiled(jinja2.FileSystemBytecodeCache):
    """Compiled templates in the user's cache; where that cannot be written they are made again."""

    def dump_bytecode(self, bucket: jinja2.bccache.Bucket) -> None:
        """Keep a template."""
        with suppress(OSError):
            super().dump_bytecode(bucket)


def _compiled() -> _Compiled | None:
    """The cache of this version; None where there can be no folder for it."""
    folder = root() / f"templates-{__version__}-{jinja2.__version__}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return _Compiled(str(folder))


class _Sandbox(ImmutableSandboxedEnvironment):
    """Templates see text and numbers: a SymPy object would take text to `eval`."""

    def is_safe_attribute(self, obj: object, attr: str, value: object) -> bool:
        """Whether a template may read `obj.attr`."""
        if type(obj).__module__.startswith("eomgen.render."):  # a record of text and numbers
            return not attr.startswith("_")
        return not type(obj).__module__.startswith("sympy") and super().is_safe_attribute(
            obj, attr, value
        )


def one_line(text: str) -> str:
    """`text` with every run of white space as one space."""
    return " ".join(text.split())


def c_comment(text: str) -> str:
    """`text` for the inside of a C comment: it can neither end it nor start another."""
    return re.sub(r"\*(?=/)|/(?=\*)|\?(?=\?)", r"\g<0> ", one_line(text))


def c_string(text: str) -> str:
    """`text` as a C string literal."""
    safe = one_line(text).replace("\\", "\\\\").replace('"', '\\"')
    without_trigraphs = re.sub(r"\?(?=\?)", '?""', safe)
    return f'"{without_trigraphs}"'


def python_string(text: str) -> str:
    """`text` as a Python string literal in double quotes."""
    safe = one_line(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{safe}"'


def docstring(text: str) -> str:
    """`text` for the inside of a Python docstring."""
    return one_line(text).replace("\\", "\\\\").replace('"', '\\"')


FILTERS = {
    "wrap": wrap,
    "rows": rows,
    "named": named,
    "statements": statements,
    "short_statements": short_statements,
    "one_line": one_line,
    "c_comment": c_comment,
    "c_string": c_string,
    "python_string": python_string,
    "docstring": docstring,
}


class _Folder(jinja2.FileSystemLoader):
    """A user's templates."""

    def get_source(self, environment: jinja2.Environment, template: str) -> Any:
        """The text, its file and whether that has changed. Raises UsageError if it is no text."""
        try:
            return super().get_source(environment, template)
        except UnicodeDecodeError as error:
            place = Path(self.searchpath[0], template)
            raise UsageError(
                f"{place}: byte {error.start + 1} is not UTF-8; save the file as UTF-8"
            ) from error


def environment(user_folder: Path | None = None) -> jinja2.Environment:
    """Our templates, behind those of `user_folder`; ours also under the prefix `builtin/`."""
    if user_folder is not None and not user_folder.is_dir():
        raise UsageError(f"{user_folder}: no such folder of templates")
    return _made(user_folder) if user_folder else _shipped()


@cache
def _shipped() -> jinja2.Environment:
    """Our templates alone, which are compiled once."""
    return _made(None)


def _made(user_folder: Path | None) -> jinja2.Environment:
    ours = jinja2.FileSystemLoader(shipped("templates"))
    folders = [_Folder(user_folder)] if user_folder else []
    made = _Sandbox(
        loader=jinja2.ChoiceLoader([jinja2.PrefixLoader({"builtin": ours}), *folders, ours]),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
        bytecode_cache=_compiled(),
    )
    made.filters.update(FILTERS)
    return made


def fill(templates: jinja2.Environment, template: str, context: dict[str, Any]) -> str:
    """The text of `template`. Raises UsageError where a user's template is wrong."""
    try:
        return templates.get_template(template).render(context)
    except UsageError:
        raise
    except Exception as error:  # of any kind: a template can divide by zero
        place = _place_of_user(error)
        if place is None:
            raise
        raise UsageError(f"{place}: {error} ({type(error).__name__})") from error


def _place_of_user(error: Exception) -> str | None:
    """`file:line` of the template at fault, or None where the mistake is ours."""
    if isinstance(error, jinja2.TemplateSyntaxError):
        file, line = error.filename or "", error.lineno
    else:
        frames = [
            f for f in traceback.extract_tb(error.__traceback__) if f.filename.endswith(SUFFIX)
        ]
        if not frames:
            return None
        file, line = frames[-1].filename, frames[-1].lineno or 1
    ours = shipped("templates").resolve()
    return None if Path(file).resolve().is_relative_to(ours) else f"{file}:{line}"
