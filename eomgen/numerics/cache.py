"""Folders that are made once: compiled libraries in the user's cache, by what they are made of."""

from __future__ import annotations

import hashlib
import os
import platform
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

from eomgen import __version__
from eomgen.cache_folder import root

MOST = 64  # folders; the ones used longest ago go first


def key(parts: Iterable[object]) -> str:
    """A name for what is made of these parts by this version on this kind of machine."""
    whole = [__version__, platform.machine(), sys.platform, *map(repr, parts)]
    return hashlib.sha256("\0".join(whole).encode()).hexdigest()[:32]


def folder(name: str, make: Callable[[Path], object]) -> Path:
    """The folder of that name; `make` fills a new one, which others see complete or not at all.

    Two processes may make it at the same time: the first to finish wins, both are the same.
    """
    place = root() / name
    if place.is_dir():
        os.utime(place)
        return place
    root().mkdir(parents=True, exist_ok=True)
    temporary = Path(tempfile.mkdtemp(dir=root(), prefix=".new-"))
    try:
        make(temporary)
        _moved(temporary, place)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
    _forget_old()
    return place


def _moved(temporary: Path, place: Path) -> None:
    try:
        temporary.rename(place)
    except OSError:
        if not place.is_dir():  # nobody else made it meanwhile
            raise


def _forget_old() -> None:
    """At most `MOST` folders stay."""
    places = sorted(root().glob("[0-9a-f]*"), key=_age, reverse=True)
    for place in places[MOST:]:
        shutil.rmtree(place, ignore_errors=True)


def _age(place: Path) -> float:
    try:
        return place.stat().st_mtime
    except FileNotFoundError:  # another process took it away
        return 0.0
