"""Work in a child process that is ended when its time is over."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

BENCHMARKS = Path(__file__).parents[1]


def output_within(seconds: float, command: list[str], folder: str | None = None) -> str | None:
    """What a command prints; None where it does not end in time.

    Raises:
        RuntimeError: it ends with an error, whose text is given.
    """
    path = [str(BENCHMARKS), str(BENCHMARKS.parent), os.environ.get("PYTHONPATH", "")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path)}
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            env=environment,
            timeout=seconds,
            check=False,
            cwd=folder,
        )
    except subprocess.TimeoutExpired:
        return None
    if done.returncode:
        raise RuntimeError(done.stderr[-2000:])
    return done.stdout
