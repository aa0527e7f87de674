"""The user's folder for what can be made again: compiled libraries and templates."""

from __future__ import annotations

import os
import sys
from pathlib import Path

VARIABLE = "EOMGEN_CACHE"


def root() -> Path:
    """The user's folder for what can be made again: $EOMGEN_CACHE, or the system's custom."""
    chosen = os.environ.get(VARIABLE)
    if chosen:
        return Path(chosen)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData/Local")) / "eomgen"
    if sys.platform == "darwin":
        return Path.home() / "Library/Caches/eomgen"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "eomgen"
