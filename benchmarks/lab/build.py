"""Sources to shared libraries, each built once: the same text and command is the same file."""

from __future__ import annotations

import hashlib
import platform
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

SHARED = ("-shared", "-fPIC")
NATIVE = ("-O3", "-march=native", "-fno-math-errno")
COMPILERS: dict[str, tuple[str, ...]] = {
    "gcc -O3 native": ("gcc", *NATIVE),
    "gcc -O2": ("gcc", "-O2", "-fno-math-errno"),
    "clang -O3 native": ("clang", *NATIVE),
}
AVX2 = {  # where `native` may be wider
    f"{name} AVX2": (name, *NATIVE, "-mno-avx512f")
    for name in ("gcc", "clang")
    if platform.machine() == "x86_64"
}


def present(compilers: Mapping[str, tuple[str, ...]] = COMPILERS) -> dict[str, tuple[str, ...]]:
    """The compilers that are installed."""
    return {name: c for name, c in compilers.items() if shutil.which(c[0])}


@dataclass(frozen=True)
class Source:
    """Files by name; `main` is compiled, the others are included or compiled as `units`."""

    files: Mapping[str, str]
    main: str
    units: tuple[str, ...] = ()
    flags: tuple[str, ...] = ()  # after the compiler's own: includes, defines
    libraries: tuple[str, ...] = ("-lm",)


class Failed(Exception):
    """A compiler's own words."""


def library(source: Source, compiler: Sequence[str], folder: Path) -> Path:
    """The shared library; raises Failed where the compiler does, also after ten minutes."""
    command = [*compiler, *SHARED, *source.flags]
    text = repr((command, sorted(source.files.items()), source.main, source.libraries))
    home = folder / hashlib.sha256(text.encode()).hexdigest()[:16]
    made = home / "run.so"
    if made.exists():
        return made
    home.mkdir(parents=True, exist_ok=True)
    for name, content in source.files.items():
        (home / name).write_text(content, encoding="utf-8")
    units = [str(home / name) for name in (source.main, *source.units)]
    _run([*command, f"-I{home}", *units, "-o", str(made), *source.libraries])
    return made


def _run(command: list[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
    if done.returncode:
        raise Failed(done.stderr.strip()[:2000])
