"""Files of the user: read whole, written whole, never lost."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

from eomgen.errors import UsageError

MARK = "eomgen"  # in the first lines of everything that we generate
MARK_LINES = 5
STANDARD = "-"
LARGEST = 16_000_000  # bytes; the spec reader has its own, smaller limit


def read(path: str) -> bytes:
    """The bytes of a file, or of standard input for `-`.

    Raises:
        UsageError: the file cannot be read.
    """
    try:
        if path == STANDARD:
            return sys.stdin.buffer.read(LARGEST)
        with Path(path).open("rb") as stream:
            return stream.read(LARGEST)
    except OSError as error:
        remedy = "give a file, or - for standard input"
        raise UsageError(f"{path}: {error.strerror}; {remedy}") from error


def shown(path: str) -> str:
    """The name of an input in messages."""
    return "<stdin>" if path == STANDARD else path


def write_all(folder: Path, files: Mapping[str, str], *, force: bool = False) -> list[Path]:
    """Write all files or none; what eomgen did not make is not overwritten.

    Raises:
        UsageError: a file that we did not generate is in the way, or the folder is not writable.
    """
    paths = {folder / name: text for name, text in files.items()}
    foreign = [p for p in paths if not force and _is_foreign(p, paths[p])]
    if foreign:
        listed = ", ".join(str(p) for p in foreign)
        raise UsageError(
            f"{listed}: not made by eomgen and in the way; choose another folder, or --force"
        )
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for path, text in paths.items():
            write(path, text)
    except OSError as error:
        raise UsageError(f"{folder}: {error.strerror or error}; choose another folder") from error
    return list(paths)


def _is_foreign(path: Path, text: str) -> bool:
    if not path.exists():
        return False
    if not path.is_file():
        return True
    old = path.read_bytes()
    if old == text.encode():
        return False
    head = old.splitlines()[:MARK_LINES]
    return not any(MARK.encode() in line for line in head)


def write(path: Path, text: str) -> None:
    """Write a file in one step: a reader sees the old text or the new one."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(text.encode())
        Path(temporary).chmod(0o666 & ~_umask())
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
