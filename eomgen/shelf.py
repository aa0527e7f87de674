"""What ships beside the code: example specs, templates, the schema of the language."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path

from eomgen import files
from eomgen.errors import UsageError
from eomgen.render.templating import SUFFIX, shipped

SCHEMA_FILE = "eomgen.schema.json"
STEM = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
TITLE = re.compile(r'^system: (?:\{en: (?:"([^"]*)"|([^",}]*))|"?([^"{\n]*))', re.MULTILINE)


def schema_text() -> str:
    """The JSON Schema of the language."""
    from eomgen.spec.schema import schema

    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def _specs() -> dict[str, Path]:
    return {p.stem: p for p in sorted(shipped("specs").glob("*.yaml"))}


def examples() -> dict[str, str]:
    """Shipped specs by name, with their titles."""
    return {stem: _title(path) for stem, path in _specs().items()}


def _title(path: Path) -> str:
    """The English title, read from the line of the key `system` (our own files)."""
    text = path.read_text(encoding="utf-8")
    found = TITLE.search(text)
    assert found, f"{path} has no title"
    return next(part for part in found.groups() if part)


def start(name: str, like: str) -> list[Path]:
    """Write NAME.yaml after an example, and the schema beside it if it is not there.

    Raises:
        UsageError: NAME is no name, the file exists, or there is no such example.
    """
    if not STEM.fullmatch(name):
        raise UsageError(f"{name!r} is not a name; use letters, digits and _, no suffix")
    path = Path(f"{name}.yaml")
    _must_be_new([path])
    text = _chosen([like], _specs(), "example")[like].read_text(encoding="utf-8")
    return files.put({path: text} | schema_in(Path()))


def schema_in(folder: Path) -> dict[Path, str]:
    """The schema that the first line of every example names, unless it is there."""
    path = folder / SCHEMA_FILE
    return {} if path.exists() else {path: schema_text()}


def copy_examples(names: Iterable[str], folder: Path) -> list[Path]:
    """Copy example specs into a folder, and the schema; all if none is named.

    Raises:
        UsageError: there is no such example, or a file is in the way.
    """
    chosen = _chosen(names, _specs(), "example")
    made = {folder / p.name: p.read_text(encoding="utf-8") for p in chosen.values()}
    _must_be_new(made)
    return files.put(made | schema_in(folder))


def templates() -> list[str]:
    """Names of our templates."""
    root = shipped("templates")
    return sorted(p.relative_to(root).as_posix() for p in root.rglob(f"*{SUFFIX}"))


def eject_templates(names: Iterable[str], folder: Path) -> list[Path]:
    """Copy templates into a folder, which `--templates` then takes; all if none is named.

    Raises:
        UsageError: there is no such template, or a file is in the way.
    """
    root = shipped("templates")
    chosen = _chosen(names, {name: root / name for name in templates()}, "template")
    made = {folder / name: p.read_text(encoding="utf-8") for name, p in chosen.items()}
    _must_be_new(made)
    return files.put(made)


def _chosen(names: Iterable[str], known: dict[str, Path], what: str) -> dict[str, Path]:
    listed = list(names) or list(known)
    for name in listed:
        if name not in known:
            near = get_close_matches(name, known, 1, 0.5)
            hint = f"did you mean {near[0]!r}?" if near else f"see `eomgen {what}s list`"
            raise UsageError(f"there is no {what} {name!r}; {hint}")
    return {name: known[name] for name in listed}


def _must_be_new(paths: Iterable[Path]) -> None:
    there = [str(p) for p in paths if p.exists()]
    if there:
        raise UsageError(f"{', '.join(there)}: exists already and is left as it is")
